#include "fast/broad_phase/float_bounds.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
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

/// A number of doubles, rounded down and up.
struct FloatInterval {
  float lower;
  float upper;
};

FloatInterval around(double x) {
  const float below = rounded_down(x);
  return {below, static_cast<double>(below) == x ? below : float_after(below)};
}

/// The place at a time of a coordinate that moves from x to y.
FloatInterval around_position(double x, double y, double time) {
  const auto position = filters::Position::evaluate<double>({x, y}, {1.0 - time, time});
  const double error = filters::position_double(std::max(std::abs(x), std::abs(y)));
  return {rounded_down(position - 2.0 * error), rounded_up(position + 2.0 * error)};
}

}  // namespace

float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? float_before(nearest) : nearest;
}

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
  bool exact = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double start = scaled(vertex.start[axis], scale_);
    const double at_one = scaled(vertex.end[axis], scale_);
    const FloatInterval first = around(start);
    const FloatInterval last =
        end == 1.0 || start == at_one ? around(at_one) : around_position(start, at_one, end);
    bounds.lower[0][axis] = first.lower;
    bounds.upper[0][axis] = first.upper;
    bounds.lower[1][axis] = last.lower;
    bounds.upper[1][axis] = last.upper;
    exact &= first.lower == first.upper && last.lower == last.upper;
  }
  bounds.lower[0][3] = bounds.upper[0][3] = bounds.lower[1][3] = bounds.upper[1][3] = 0.0F;
  return exact;
}

}  // namespace touchstone::fast
