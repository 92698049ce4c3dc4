#pragma once

/// \file
/// The plainness of a query: the measure by which queries with the same fault are preferred.
///
/// A finding is more convincing if it looks like a query of practice: numbers between 1e-3 and 1e3
/// with few decimal digits, few different ones, proper triangles and edges, and the scale at which
/// the fault was found. The measure is a tuple of natural numbers in lexicographic order; less is
/// plainer:
///
/// 1. `beyond`: the distance of coordinates from everyday size, 2^-10 to 2^10: for each occurring
///   magnitude, the binary orders of magnitude in between.
/// 2. `degenerate`: elements that are collapsed, and coplanarity. See degeneracy().
/// 3. `drift`: the binary orders of magnitude, beyond three, between the greatest coordinate and
///   the original's, or everyday size if the original's is outside.
/// 4. `length`: the cost of writing it down. For each magnitude (except 0) 8, 3 for each
///    significant digit of the shortest decimal of this double, 1 for each zero between these and
///    the point, and 2 if it is not an integer. For each coordinate 2 unless it is 0, 1 for a sign,
///    and 1 if it moves on. Weights are numbers as coordinates are, so fewer control points, and
///    none with weights, are shorter.
/// 5. `size`: the sum of the magnitudes, each as a number that orders doubles.
/// 6. `disorder`: pairs of points whose order is irrelevant (the triangle's, an edge's), with the
///   greater one first.
///
/// The measure is the same on every machine.

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
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

/// The measure above. Two queries may be equally plain.
struct Plainness {
  std::uint64_t beyond = 0;
  std::uint64_t degenerate = 0;
  std::uint64_t drift = 0;
  std::uint64_t length = 0;
  std::uint64_t size = 0;
  std::uint64_t disorder = 0;

  friend auto operator<=>(const Plainness&, const Plainness&) = default;

  /// True if it is worse in any of the first four numbers, regardless of the others.
  [[nodiscard]] bool is_worse_somewhere(const Plainness& other) const;
};

/// \param original the query from which it was derived. \pre both are valid
[[nodiscard]] Plainness plainness(const AnyQuery& query, const AnyQuery& original);

/// At each end 1 for an edge that is shorter than 2^-10 of the query's extent, 1 for a triangle
/// whose height is less than 2^-10 of its longest side, or 2 if all its sides are that short; and 1
/// if the four points are always in one plane, to about 2^-20. (The extent: the greatest difference
/// of two coordinates on an axis.) 0 to 5.
[[nodiscard]] std::uint64_t degeneracy(const AnyQuery& query);

/// The elements' part of degeneracy(): 0 to 4.
[[nodiscard]] std::uint64_t collapsed_elements(const AnyQuery& query);

/// Binary exponents of coordinates of everyday size.
inline constexpr int least_everyday = -10, greatest_everyday = 9;

/// The binary exponent of the greatest coordinate in magnitude; least_everyday if all are 0.
[[nodiscard]] int size_exponent(const AnyQuery& query);

/// The occurring magnitudes of coordinates and weights without 0, in ascending order.
[[nodiscard]] std::vector<double> magnitudes(const AnyQuery& query);

/// The length of one magnitude. \pre it is finite and positive
[[nodiscard]] std::uint64_t writing_length(double magnitude);

/// The pairs of points whose order is irrelevant.
using PointPair = std::array<std::size_t, 2>;
[[nodiscard]] std::span<const PointPair> exchangeable(Kind kind);

}  // namespace touchstone::verify::fuzz
