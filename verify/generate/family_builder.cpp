#include "verify/generate/family_builder.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "verify/generate/symmetry.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

template <class Function>
void for_each_point(Function&& function) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) function(end, point);
  }
}

void swap_points(Query& query, std::size_t a, std::size_t b) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::swap(query.at(end, a, axis), query.at(end, b, axis));
    }
  }
}

void swap_axes(Query& query, std::size_t a, std::size_t b) {
  for_each_point([&](std::size_t end, std::size_t point) {
    std::swap(query.at(end, point, a), query.at(end, point, b));
  });
}

void mirror_axis(Query& query, std::size_t axis) {
  for_each_point([&](std::size_t end, std::size_t point) {
    query.at(end, point, axis) = -query.at(end, point, axis);
  });
}

bool scales_exactly(const Query& query, std::size_t axis, int exponent) {
  bool exact = true;
  for_each_point([&](std::size_t end, std::size_t point) {
    const double value = query.at(end, point, axis);
    const double scaled = std::ldexp(value, exponent);
    exact = exact && std::isfinite(scaled) && std::ldexp(scaled, -exponent) == value;
  });
  return exact;
}

}  // namespace

KnownQuery collision(const Query& query, std::optional<Rational> toi) {
  return {.query = query, .collides = true, .toi = std::move(toi)};
}

KnownQuery no_collision(const Query& query) {
  return {.query = query, .collides = false, .toi = std::nullopt};
}

Rational corner_at(const Query& query, const Corner& corner, std::size_t axis, const Rational& t) {
  const auto difference = [&](std::size_t end) {
    return Rational(Rational(query.at(end, corner.plus, axis)) -
                    Rational(query.at(end, corner.minus, axis)));
  };
  const Rational start = difference(0);
  return {start + t * (difference(1) - start)};
}

bool uses_full_significands(const Query& query) {
  constexpr int bits = 45;
  std::set<double> magnitudes;
  std::set<int> exponents;
  for (const double coordinate : query.coordinates) {
    if (coordinate == 0) continue;
    magnitudes.insert(std::abs(coordinate));
    exponents.insert(std::ilogb(coordinate));
  }
  const auto is_full = [](double magnitude) {
    // A number of at most 44 bits is an integer when its leading bit stands for 2^43.
    const double shortened = std::ldexp(magnitude, bits - 2 - std::ilogb(magnitude));
    return shortened != std::floor(shortened);
  };
  const auto full = std::count_if(magnitudes.begin(), magnitudes.end(), is_full);
  return exponents.size() > 1 && 2 * static_cast<std::size_t>(full) > magnitudes.size();
}

void apply_random_symmetry(AnyKind kind, Random& random, Query& query) {
  if (kind.is_cell()) {
    query = image(draw_isometry(kind, random), query).value();
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    swap_axes(query, axis, static_cast<std::size_t>(random.between(static_cast<int>(axis), 2)));
    if (random.coin()) mirror_axis(query, axis);
  }
  if (kind == ContactKind::vertex_face) {
    for (std::size_t i = 0; i < 2; ++i) {
      swap_points(query, 1 + i,
                  1 + static_cast<std::size_t>(random.between(static_cast<int>(i), 2)));
    }
    return;
  }
  for (std::size_t edge = 0; edge < 2; ++edge) {
    if (random.coin()) swap_points(query, 2 * edge, 2 * edge + 1);
  }
  if (!random.coin()) return;
  swap_points(query, 0, 2);
  swap_points(query, 1, 3);
}

void scale_axes(const std::array<int, 3>& exponents, Query& query) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int wanted = exponents.at(axis);
    const int exponent = scales_exactly(query, axis, wanted) ? wanted : -wanted;
    for_each_point([&](std::size_t end, std::size_t point) {
      double& coordinate = query.at(end, point, axis);
      coordinate = std::ldexp(coordinate, exponent);
    });
  }
}

}  // namespace touchstone::verify::generate
