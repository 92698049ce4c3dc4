#include "fast/certified/fixed_point_vertices.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {
namespace {

/// Vertices per task.
constexpr std::size_t vertices_of_task = 4096;

/// x and y, z and 0 of a vertex.
using DoublePair = double __attribute__((vector_size(16)));
using Position = std::array<DoublePair, 2>;
using WholeRow = std::int32_t __attribute__((vector_size(16)));

Position position_of(const std::array<double, 4>& x) {
  return {DoublePair{x[0], x[1]}, DoublePair{x[2], 0.0}};
}

DoublePair greatest(const DoublePair& a, const DoublePair& b) { return a > b ? a : b; }

/// The greatest difference of a coordinate from that of the origin; infinity if one overflows.
double extent(const Motion& vertices, const Position& origin) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, vertices.size(), vertices_of_task), 0.0,
      [&](const tbb::blocked_range<std::size_t>& range, double known) {
        const StrictFloatingPoint of_task;
        DoublePair above{known, known}, below = above;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          for (const auto* x : {&vertices[i].start, &vertices[i].end}) {
            const Position position = position_of(*x);
            for (std::size_t pair = 0; pair < 2; ++pair) {
              above = greatest(above, position[pair] - origin[pair]);
              below = greatest(below, origin[pair] - position[pair]);
            }
          }
        }
        const DoublePair both = greatest(above, below);
        return std::max(both[0], both[1]);
      },
      [](double a, double b) { return std::max(a, b); });
}

/// The positions of vertices as whole numbers.
class Rounding {
 public:
  Rounding(const Position& origin, double h, double end)
      : origin_(origin), per_h_(1.0 / h), end_(end) {}

  [[nodiscard]] FixedPointVertex operator()(const MovingVertex& vertex) const {
    return {.start = whole(position_of(vertex.start)),
            .end = whole(end_ == 1.0 ? position_of(vertex.end) : at_end(vertex))};
  }

 private:
  [[nodiscard]] Position at_end(const MovingVertex& vertex) const {
    std::array<double, 4> result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = filters::Position::evaluate<double>({vertex.start[axis], vertex.end[axis]},
                                                         {1.0 - end_, end_});
    }
    return position_of(result);
  }

  /// The sum with 1.5 · 2^52 has the nearest whole number in its lowest bits.
  [[nodiscard]] std::array<std::int32_t, 4> whole(const Position& x) const {
    const DoublePair low = (x[0] - origin_[0]) * per_h_ + 0x1.8p52;
    const DoublePair high = (x[1] - origin_[1]) * per_h_ + 0x1.8p52;
    const WholeRow row = __builtin_shufflevector(std::bit_cast<WholeRow>(low),
                                                 std::bit_cast<WholeRow>(high), 0, 2, 4, 6);
    return std::bit_cast<std::array<std::int32_t, 4>>(row);
  }

  Position origin_;
  double per_h_;
  double end_;
};

}  // namespace

float FixedPointVertices::distance_for(double other) const {
  constexpr double greatest_distance = 0x1p29;
  const double in_units = 1.001 + (other + 2.0 * error) / unit;
  // Written so that NaN fails too.
  if (!(in_units <= greatest_distance)) return std::numeric_limits<float>::infinity();
  return static_cast<float>(in_units * (1.0 + 0x1p-20));
}

FixedPointVertices fixed_point_vertices(const Motion& vertices, double end, double distance) {
  // Limits within which nothing overflows or underflows, here and in the certified solver's stages.
  constexpr double greatest_coordinate = 0x1p98, least_extent = 0x1p-900;
  const StrictFloatingPoint strict;
  FixedPointVertices result;
  if (vertices.size() == 0) return result;
  const Position origin = position_of(vertices[0].start);
  const double size = extent(vertices, origin);
  const auto& [x, y, z, unused] = vertices[0].start;
  const double magnitude = std::max({std::abs(x), std::abs(y), std::abs(z)}) + size;
  if (!(magnitude <= greatest_coordinate && size >= least_extent)) return result;
  const double h = std::ldexp(1.0, std::ilogb(size) + 1 - 29);
  result.unit = h;
  result.error = end == 1.0 ? 0.0 : filters::position_double(2.0 * magnitude);
  result.distance = result.distance_for(distance);
  if (result.distance == std::numeric_limits<float>::infinity()) return result;
  result.vertices = LargeArray<FixedPointVertex>(vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), vertices_of_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const StrictFloatingPoint of_task;
                      const Rounding round(origin, h, end);
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        result.vertices[i] = round(vertices[i]);
                      }
                    });
  return result;
}

}  // namespace touchstone::fast
