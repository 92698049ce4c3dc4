#include "fast/certified/fixed_point_vertices.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {
namespace {

/// Vertices per task.
constexpr std::size_t vertices_of_task = 4096;

/// x, y, z and an unused number of a vertex, in double.
using Row = std::array<double, 4>;

double greatest_magnitude(const Row& x) {
  return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
}

/// The greatest difference of a coordinate from that of the origin; infinity if one overflows.
double extent(const MovingVertices& vertices, const Row& origin) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, vertices.size(), vertices_of_task), 0.0,
      [&](const tbb::blocked_range<std::size_t>& range, double greatest) {
        const StrictFloatingPoint of_task;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          for (const auto* x : {&vertices[i].start, &vertices[i].end}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
              greatest = std::max(greatest, std::abs((*x)[axis] - origin[axis]));
            }
          }
        }
        return greatest;
      },
      [](double a, double b) { return std::max(a, b); });
}

/// The positions of vertices as whole numbers.
class Rounding {
 public:
  Rounding(const Row& origin, double h, double end) : origin_(origin), per_h_(1.0 / h), end_(end) {}

  [[nodiscard]] FixedPointVertex operator()(const MovingVertex& vertex) const {
    return {.start = whole(vertex.start), .end = whole(end_ == 1.0 ? vertex.end : at_end(vertex))};
  }

 private:
  [[nodiscard]] Row at_end(const MovingVertex& vertex) const {
    Row result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = filters::Position::evaluate<double>({vertex.start[axis], vertex.end[axis]},
                                                         {1.0 - end_, end_});
    }
    return result;
  }

  /// The sum with 1.5 · 2^52 has the nearest whole number in its lowest bits.
  [[nodiscard]] std::array<std::int32_t, 4> whole(const Row& x) const {
    std::array<std::int32_t, 4> result;
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const double shifted = (x[axis] - origin_[axis]) * per_h_ + 0x1.8p52;
      result[axis] = static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(shifted));
    }
    return result;
  }

  Row origin_;
  double per_h_;
  double end_;
};

}  // namespace

FixedPointVertices fixed_point_vertices(const MovingVertices& vertices, double end,
                                        double distance) {
  // Within them nothing overflows or underflows here, nor in the certified solver's stages.
  constexpr double greatest_coordinate = 0x1p98, least_extent = 0x1p-900;
  constexpr double greatest_distance = 0x1p29;
  const StrictFloatingPoint strict;
  FixedPointVertices result;
  if (vertices.size() == 0) return result;
  const Row& origin = vertices[0].start;
  const double size = extent(vertices, origin);
  const double magnitude = greatest_magnitude(origin) + size;
  if (!(magnitude <= greatest_coordinate && size >= least_extent)) return result;
  const double h = std::ldexp(1.0, std::ilogb(size) + 1 - 29);
  const double error = end == 1.0 ? 0.0 : filters::position_double(2.0 * magnitude);
  const double in_units = 1.001 + (distance + 2.0 * error) / h;
  if (!(in_units <= greatest_distance)) return result;
  result.distance = static_cast<float>(in_units * (1.0 + 0x1p-20));
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
