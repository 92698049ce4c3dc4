#include "verify/fuzz/mutation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "verify/fuzz/draws.hpp"

namespace touchstone::verify::fuzz {
namespace {

using draws::below;
using draws::one_in;
using generate::Random;

/// Maps doubles to integers in the same order: ±0 to 0.
std::int64_t rank(double x) {
  const auto bits = std::bit_cast<std::int64_t>(std::abs(x));
  return std::signbit(x) ? -bits : bits;
}

double& some_coordinate(Query& query, Random& random) {
  return query.coordinates.at(below(random, query.coordinates.size()));
}

/// Another coordinate of the same axis, for equal coordinates.
double some_like(const Query& query, const double& coordinate, Random& random) {
  const auto index = static_cast<std::size_t>(&coordinate - query.coordinates.data());
  return query.coordinates.at(3 * below(random, query_points) + index % 3);
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

void change_coordinate(Query& query, Random& random) {
  double& x = some_coordinate(query, random);
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
      nudge(query, random);
  }
}

void change_points(Query& query, Random& random) {
  const std::size_t point = below(random, moving_points), other = below(random, moving_points);
  const std::size_t end = below(random, 2);
  switch (below(random, 4)) {
    case 0:
      query.point(0, point).swap(query.point(1, point));
      break;
    case 1:
      query.point(end, point) = Eigen::Vector3d(query.point(end, other));
      break;
    case 2:
      query.point(1 - end, point) = Eigen::Vector3d(query.point(end, point));
      break;
    default:
      query.point(end, point).swap(query.point(end, other));
  }
}

}  // namespace

double stepped(double x, std::int64_t steps) {
  static constexpr auto greatest = std::bit_cast<std::int64_t>(std::numeric_limits<double>::max());
  const std::int64_t target = std::clamp(rank(x) + steps, -greatest, greatest);
  const auto magnitude = std::bit_cast<double>(std::abs(target));
  return target < 0 ? -magnitude : magnitude;
}

void nudge(Query& query, Random& random) {
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    double& x = some_coordinate(query, random);
    const std::int64_t steps =
        one_in(random, 4) ? std::int64_t{1} << below(random, 40) : random.between(1, 4);
    x = stepped(x, random.coin() ? steps : -steps);
  }
}

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

Query mutated(const Query& query, Random& random) {
  Query result = query;
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    if (one_in(random, 4)) {
      change_points(result, random);
    } else {
      change_coordinate(result, random);
    }
  }
  return result;
}

}  // namespace touchstone::verify::fuzz
