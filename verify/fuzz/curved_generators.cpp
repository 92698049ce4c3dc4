#include "verify/fuzz/curved_generators.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "verify/fuzz/plainness.hpp"
#include "verify/generate/draws.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::verify::fuzz {
namespace {

using base::AnyQuery;
using generate::Random;
using generate::draws::below;

/// Numbers of a control point of all four points without weights.
constexpr std::size_t control_size = 3 * moving_points;

/// The control points of the next higher degree, times it.
std::vector<double> raised(const std::vector<double>& control) {
  const std::size_t degree = control.size() / control_size;
  std::vector<double> result(control.size() + control_size);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t j = i / control_size;
    if (j > 0) result[i] += static_cast<double>(j) * control[i - control_size];
    if (j < degree) result[i] += static_cast<double>(degree - j) * control[i];
  }
  return result;
}

/// The query of these control points; on rational curves with the weight weight_of(j) at each.
template <class WeightOf>
AnyQuery with_weights(const AnyShape& shape, const std::vector<double>& control,
                      const WeightOf& weight_of) {
  if (!shape.is_rational) return {shape, control};
  std::vector<double> numbers;
  for (std::size_t i = 0; i < control.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) numbers.push_back(control[i + axis]);
    numbers.push_back(weight_of(i / control_size));
  }
  return {shape, std::move(numbers)};
}

/// Curves raised to the shape, on rational curves at another speed.
AnyQuery raised_to(const AnyShape& shape, std::vector<double> control, Random& random) {
  while (control.size() < (shape.degree + 1) * control_size) control = raised(control);
  const auto exponent = static_cast<int>(random.between(-3, 3));
  return with_weights(shape, control, [&](std::size_t j) {
    return std::ldexp(1.0, exponent * static_cast<int>(j));
  });
}

bool can_be_raised(const generate::Family& family, const AnyShape& shape) {
  if (!generate::supports(family, shape.kind)) return false;
  return family.is_rational ? shape.is_rational && family.degree == shape.degree
                            : family.degree <= shape.degree;
}

}  // namespace

AnyQuery at_other_speed(const AnyShape& shape, const Query& query, std::size_t turn) {
  std::vector<double> control;
  for (std::size_t j = 0; j <= shape.degree; ++j) {
    const auto* const end = query.coordinates.begin() + (j < turn ? 0 : control_size);
    control.insert(control.end(), end, end + control_size);
  }
  return with_weights(shape, control, [](std::size_t) { return 1.0; });
}

AnyQuery on_curves(const AnyShape& shape, const Query& query, Random& random) {
  AnyQuery result = raised_to(shape, {query.coordinates.begin(), query.coordinates.end()}, random);
  const std::size_t turn = 1 + below(random, shape.degree);
  if (random.coin() || !is_finite(result.numbers())) return at_other_speed(shape, query, turn);
  return result;
}

std::optional<AnyQuery> of_curved_family(const AnyShape& shape, Random& random) {
  std::vector<const generate::Family*> families;
  for (const generate::Family& family : generate::curved_families()) {
    if (can_be_raised(family, shape)) families.push_back(&family);
  }
  if (families.empty()) return std::nullopt;
  const generate::Family& family = *families[below(random, families.size())];
  const auto source = generate::open_family(family, shape.kind, random.bits(), 1);
  AnyQuery query = source->next().value().query;
  if (family.is_rational) return query;
  return raised_to(shape, {query.numbers().begin(), query.numbers().end()}, random);
}

AnyQuery of_numbers(const AnyShape& shape, const Separation& separation, Random& random) {
  const bool is_whole = random.coin();
  const std::size_t groups = may_weights_differ(shape, separation) ? 1 + below(random, 3) : 1;
  const std::size_t second = shape.kind == ContactKind::vertex_face ? 1 : 2;
  const auto whole = [&](std::int64_t least, std::int64_t greatest) {
    return static_cast<double>(random.between(least, greatest));
  };
  std::vector<double> numbers;
  for (std::size_t j = 0; j <= shape.degree; ++j) {
    std::array<double, moving_points> weights{};
    for (double& weight : weights) weight = is_whole ? whole(1, 3) : random.uniform(0.5, 2.0);
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (int axis = 0; axis < 3; ++axis) {
        numbers.push_back(is_whole ? whole(-8, 8) / 4.0 : random.uniform(-1.0, 1.0));
      }
      const std::array<std::size_t, 3> group{0, point >= second ? 1U : 0U, point};
      if (shape.is_rational) numbers.push_back(weights.at(group.at(groups - 1)));
    }
  }
  return {shape, std::move(numbers)};
}

bool may_weights_differ(const AnyShape& shape, const Separation& separation) {
  return is_zero(separation) || shape.degree == 1;
}

bool is_decided_soon(const AnyQuery& query, const Separation& separation) {
  constexpr int most = 64;
  if (query.shape().is_straight() || is_zero(separation)) return true;
  bool result = true;
  for_each_coordinate(query, point_axes, [&](double x) {
    result =
        result && (x == 0.0 || std::abs(std::ilogb(x) - std::ilogb(separation.distance)) <= most);
  });
  return result;
}

}  // namespace touchstone::verify::fuzz
