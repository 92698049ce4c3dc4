#include "fast/broad_phase/float_bounds.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

#include "fast/platform/floating_point_state.hpp"
#include "filters/error_bounds.hpp"
#include "filters/expressions.hpp"

namespace touchstone::fast {
namespace {

namespace tbb = oneapi::tbb;

/// So many vertices are a task's.
constexpr std::size_t vertices_of_task = 4096;

/// `join` of work(first, end) of parts of the vertices, each run strictly.
template <class Value, class Work, class Join>
Value over_vertices(std::size_t count, const Value& identity, const Work& work, const Join& join) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, vertices_of_task), identity,
      [&](const tbb::blocked_range<std::size_t>& range, const Value& before) {
        const StrictFloatingPoint strict;
        return join(before, work(range.begin(), range.end()));
      },
      join);
}

double greatest_coordinate(const MovingVertices& vertices) {
  const auto of_part = [&](std::size_t first, std::size_t end) {
    double result = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      for (const std::array<double, 4>& place : {vertices[i].start, vertices[i].end}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          result = std::max(result, std::abs(place[axis]));
        }
      }
    }
    return result;
  };
  return over_vertices(vertices.size(), 0.0, of_part,
                       [](double a, double b) { return std::max(a, b); });
}

/// 1, or what brings that coordinate to between 1 and 2, or as near to it as a double can.
double scale_for(double greatest_coordinate) {
  constexpr int usual = 64, greatest_exponent = 1023;
  if (greatest_coordinate == 0.0) return 1.0;
  const int exponent = std::ilogb(greatest_coordinate);
  if (std::abs(exponent) <= usual) return 1.0;
  return std::ldexp(1.0, std::min(-exponent, greatest_exponent));
}

/// x times the scale; where that underflows, on the same side of zero.
double scaled(double x, double scale) {
  const double product = x * scale;
  if (product == 0.0 && x != 0.0) {
    return std::copysign(std::numeric_limits<double>::denorm_min(), x);
  }
  return product;
}

/// x, y, z and 0 of a vertex at a time.
using Place = std::array<double, 4>;

Place scaled(const Place& place, double scale) {
  Place result;
  for (std::size_t axis = 0; axis < 4; ++axis) result[axis] = scaled(place[axis], scale);
  return result;
}

struct RowBounds {
  FloatRow lower;
  FloatRow upper;
};

/// Rounded down and up, without a branch: no processor could foresee which way rounding goes.
RowBounds around(const Place& place) {
  using DoubleRow = double __attribute__((vector_size(32)));
  using WholeRow = std::int32_t __attribute__((vector_size(16)));
  DoubleRow exact;
  std::memcpy(&exact, place.data(), sizeof(exact));
  const FloatRow nearest = __builtin_convertvector(exact, FloatRow);
  const DoubleRow rounded = __builtin_convertvector(nearest, DoubleRow);
  // −1 where it is, 0 elsewhere.
  const auto is_above = __builtin_convertvector(rounded > exact, WholeRow);
  const auto is_below = __builtin_convertvector(rounded < exact, WholeRow);
  // As order_of and float_at.
  const auto turned = [](const WholeRow& row) { return row ^ ((row >> 31) & 0x7FFFFFFF); };
  const WholeRow order = turned(std::bit_cast<WholeRow>(nearest));
  return {std::bit_cast<FloatRow>(turned(order + is_above)),
          std::bit_cast<FloatRow>(turned(order - is_below))};
}

bool is_exact(const RowBounds& bounds) {
  const auto& [a, b] = bounds;
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Around the place at a time of a vertex that moves from one place to another.
RowBounds around_position(const Place& from, const Place& to, double time) {
  Place lower = from, upper = from;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = from[axis], y = to[axis];
    if (x == y) continue;
    const auto position = filters::Position::evaluate<double>({x, y}, {1.0 - time, time});
    const double error = filters::position_double(std::max(std::abs(x), std::abs(y)));
    lower[axis] = position - 2.0 * error;
    upper[axis] = position + 2.0 * error;
  }
  return {around(lower).lower, around(upper).upper};
}

}  // namespace

float rounded_down(double x) { return around({x, 0.0, 0.0, 0.0}).lower[0]; }

FloatBounds::FloatBounds(const MovingVertices& vertices, double end)
    // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
    : size_(vertices.size()), bounds_(std::make_unique_for_overwrite<VertexBounds[]>(size_)) {
  scale_ = scale_for(greatest_coordinate(vertices));
  exact_ = over_vertices(
      size_, true,
      [&](std::size_t first, std::size_t behind) {
        bool exact = true;
        for (std::size_t i = first; i < behind; ++i) exact &= set(bounds_[i], vertices[i], end);
        return exact;
      },
      std::logical_and<>());
}

float FloatBounds::scaled_up(double distance) const { return rounded_up(scaled(distance, scale_)); }

float FloatBounds::scaled_down(double distance) const {
  return std::min(rounded_down(scaled(distance, scale_)), std::numeric_limits<float>::max());
}

bool FloatBounds::set(VertexBounds& bounds, const MovingVertex& vertex, double end) const {
  const auto set_to = [&](const Place& start, const Place& at_one) {
    const RowBounds first = around(start);
    const RowBounds last = end == 1.0 ? around(at_one) : around_position(start, at_one, end);
    bounds.lower = {first.lower, last.lower};
    bounds.upper = {first.upper, last.upper};
    return is_exact(first) && is_exact(last);
  };
  if (scale_ == 1.0) return set_to(vertex.start, vertex.end);
  return set_to(scaled(vertex.start, scale_), scaled(vertex.end, scale_));
}

}  // namespace touchstone::fast
