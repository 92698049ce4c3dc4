#pragma once

/// \file
/// The plainness of a query: the measure by which queries with the same fault are preferred.
///
/// A finding is more convincing if it looks like a query that a person wrote: proper triangles and
/// edges, and few different numbers of few digits. The measure is a tuple of natural numbers in
/// lexicographic order, the same on every machine; less is plainer:
///
/// 1. `shape`: general, coplanar or collapsed, so that a simpler query is no more degenerate.
/// 2. `digits`: for each different magnitude of coordinates and weights, without 0, one more than
///    the digits of its shortest decimal, zeros up to the point included.
/// 3. `marks`: 1 for each coordinate or weight that is not 0, for each sign, and for each number
///    that is not the same at the next control point. Fewer control points have fewer.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"

namespace touchstone::verify::fuzz {

using base::AnyQuery;

/// Coordinates of a point; a weight follows them on rational curves.
inline constexpr std::size_t point_axes = 3;

/// Distance of a number of a control point from the same number of the next one.
[[nodiscard]] inline std::size_t to_next_control(const AnyQuery& query) {
  return moving_points * query.shape().numbers_of_point();
}

/// Calls use(x) for each coordinate of an axis, or of all axes for an index beyond the last one,
/// in their order. Weights are none.
template <class Numbers, class Use>
void for_each_coordinate(Numbers& query, std::size_t axis, const Use& use) {
  const std::size_t first = axis < point_axes ? axis : 0;
  const std::size_t last = axis < point_axes ? axis + 1 : point_axes;
  const std::size_t size = query.shape().numbers_of_point();
  const auto numbers = query.numbers();
  for (std::size_t point = 0; point < numbers.size(); point += size) {
    for (std::size_t i = first; i < last; ++i) use(numbers[point + i]);
  }
}

/// True if all numbers are finite and all weights positive.
[[nodiscard]] bool is_valid(const AnyQuery& query);

/// The elements of a query, and the plane of its points.
enum class Shape : std::uint8_t {
  general,
  coplanar,   ///< the four points are always in one plane, to about 2^-20
  collapsed,  ///< at an end an edge or a triangle's height is shorter than 2^-10 of the query's
              ///< extent (the greatest difference of two coordinates on an axis), or of its side
};

[[nodiscard]] Shape shape_of(const AnyQuery& query);

/// "general", "coplanar" or "collapsed".
[[nodiscard]] std::string_view to_string(Shape shape);

/// The measure above. Two queries may be equally plain.
struct Plainness {
  Shape shape = Shape::general;
  std::uint64_t digits = 0;
  std::uint64_t marks = 0;

  friend auto operator<=>(const Plainness&, const Plainness&) = default;
};

/// \pre the query is valid
[[nodiscard]] Plainness plainness(const AnyQuery& query);

/// The binary exponent of the greatest coordinate in magnitude; 0 if all are 0.
[[nodiscard]] int size_exponent(const AnyQuery& query);

/// The occurring magnitudes of coordinates and weights without 0, in ascending order.
[[nodiscard]] std::vector<double> magnitudes(const AnyQuery& query);

/// The digits of the shortest decimal, zeros up to the point included. \pre it is finite and
/// positive
[[nodiscard]] std::uint64_t digits_of(double magnitude);

}  // namespace touchstone::verify::fuzz
