#include "verify/fuzz/mutation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "verify/generate/draws.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace draws = generate::draws;
using base::AnyQuery;
using draws::below;
using draws::one_in;
using generate::Random;

/// Maps doubles to integers in the same order: ±0 to 0.
std::int64_t rank(double x) {
  const auto bits = std::bit_cast<std::int64_t>(std::abs(x));
  return std::signbit(x) ? -bits : bits;
}

double& some_number(std::span<double> numbers, Random& random) {
  return numbers[below(random, numbers.size())];
}

/// Another coordinate of the same axis, for equal coordinates, or another weight.
double some_like(const AnyQuery& query, const double& number, Random& random) {
  const std::span<const double> all = query.numbers();
  const std::size_t size = query.shape().numbers_of_point();
  const auto index = static_cast<std::size_t>(&number - all.data());
  return all[size * below(random, all.size() / size) + index % size];
}

void nudge_numbers(std::span<double> numbers, Random& random) {
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    double& x = some_number(numbers, random);
    const std::int64_t steps =
        one_in(random, 4) ? std::int64_t{1} << below(random, 40) : random.between(1, 4);
    x = stepped(x, random.coin() ? steps : -steps);
  }
}

void flip_bit(double& x, Random& random) {
  const std::uint64_t bit = std::uint64_t{1} << below(random, 64);
  const auto flipped = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ bit);
  if (std::isfinite(flipped)) x = flipped;
}

/// Keeps the leading bits only.
void shorten(double& x, Random& random) {
  const std::uint64_t dropped = (std::uint64_t{1} << (28 + below(random, 25))) - 1;
  x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~dropped);
}

void rescale(double& x, Random& random) {
  const double scaled = std::ldexp(x, static_cast<int>(random.between(-8, 8)));
  if (std::isfinite(scaled)) x = scaled;
}

void change_number(AnyQuery& query, Random& random) {
  double& x = some_number(query.numbers(), random);
  switch (below(random, 7)) {
    case 0:
      flip_bit(x, random);
      break;
    case 1:
      x = some_like(query, x, random);
      break;
    case 2:
      x = -x;
      break;
    case 3:
      x = 0.0;
      break;
    case 4:
      shorten(x, random);
      break;
    case 5:
      rescale(x, random);
      break;
    default:
      nudge_numbers(query.numbers(), random);
  }
}

void change_points(AnyQuery& query, Random& random) {
  const std::size_t point = below(random, moving_points), other = below(random, moving_points);
  const std::size_t degree = query.shape().degree, control = below(random, degree + 1);
  const auto at = [&](std::size_t j, std::size_t index) {
    const std::size_t size = query.shape().numbers_of_point();
    return query.numbers().subspan((moving_points * j + index) * size, size);
  };
  switch (below(random, 4)) {
    case 0:
      std::ranges::swap_ranges(at(0, point), at(degree, point));
      break;
    case 1:
      std::ranges::transform(at(control, other), at(control, point).begin(), std::identity{});
      break;
    case 2:
      std::ranges::transform(at(control, point), at(degree - control, point).begin(),
                             std::identity{});
      break;
    default:
      std::ranges::swap_ranges(at(control, point), at(control, other));
  }
}

/// Restores weights that may not change, and those that are invalid or far from 1.
void restore_weights(AnyQuery& query, const AnyQuery& before, bool changes_weights) {
  constexpr double greatest = 0x1p40;
  if (!query.shape().is_rational) return;
  for (std::size_t i = 3; i < query.numbers().size(); i += 4) {
    double& weight = query.numbers()[i];
    const bool is_moderate = weight <= greatest && weight >= 1.0 / greatest;
    if (!changes_weights || !is_moderate) weight = before.numbers()[i];
  }
}

}  // namespace

double stepped(double x, std::int64_t steps) {
  static constexpr auto greatest = std::bit_cast<std::int64_t>(std::numeric_limits<double>::max());
  const std::int64_t target = std::clamp(rank(x) + steps, -greatest, greatest);
  const auto magnitude = std::bit_cast<double>(std::abs(target));
  return target < 0 ? -magnitude : magnitude;
}

void nudge(Query& query, Random& random) { nudge_numbers(query.coordinates, random); }

void overshoot(Kind kind, Query& query, Random& random) {
  const std::size_t end = below(random, 2);
  const std::size_t first_primitive = kind == Kind::vertex_face ? 1 : 2;
  const std::size_t count = random.coin() ? moving_points : first_primitive;
  const double part =
      std::ldexp(random.coin() ? 1.0 : -1.0, -static_cast<int>(random.between(20, 52)));
  Query moved = query;
  for (std::size_t point = 0; point < count; ++point) {
    moved.point(end, point) += part * (query.point(end, point) - query.point(1 - end, point));
  }
  if (is_finite(moved)) query = moved;
}

AnyQuery mutated(const AnyQuery& query, bool changes_weights, Random& random) {
  AnyQuery result = query;
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    if (one_in(random, 4)) {
      change_points(result, random);
    } else {
      change_number(result, random);
    }
  }
  restore_weights(result, query, changes_weights);
  return result;
}

}  // namespace touchstone::verify::fuzz
