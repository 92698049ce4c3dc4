#pragma once

/// \file
/// How plain a query is: the one measure by which queries that show the same fault are preferred.
///
/// Who reads a finding believes it sooner if it could be their own: numbers between 1e-3 and 1e3 of few
/// decimal digits, few different ones, triangles and edges that are some, at the scale where the fault
/// was met. The measure is a tuple of natural numbers in lexicographic order, less being plainer:
///
/// 1. `beyond`: by how much coordinates are not of everyday size, 2^-10 to 2^10. For each magnitude that
///    occurs, the binary orders of magnitude between.
/// 2. `degenerate`: elements that are collapsed, and coplanarity. See degeneracy().
/// 3. `drift`: by how many binary orders of magnitude, beyond three, the greatest coordinate is from the
///    original's; or from everyday size if the original's is not of it.
/// 4. `length`: what it takes to write it down. For each magnitude (0 apart) 8, 3 for each significant
///    digit of the shortest decimal that reads as this double, 1 for each empty place between these and
///    the point, and 2 if it is no integer. For each coordinate 2 unless it is 0, 1 for a sign, and 1
///    if it moves.
/// 5. `size`: the sum of the magnitudes, each as a number that orders doubles.
/// 6. `disorder`: pairs of points whose order the kind does not care for (the triangle's, an edge's),
///    the greater one first.
///
/// All of it is the same on every machine.

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/query.hpp"

namespace touchstone::verify::fuzz {

// A query's coordinates: coordinate_count numbers at t=0 and t=1 each, x, y and z of each point.
inline constexpr std::size_t point_axes = 3;
inline constexpr std::size_t motion_ends = 2;
inline constexpr std::size_t coordinate_count = point_axes * query_points;
/// Distance of a point's coordinate at t=0 from the one at t=1.
inline constexpr std::size_t to_other_end = point_axes * moving_points;

/// As above. Two queries may be equally plain.
struct Plainness {
  std::uint64_t beyond = 0;
  std::uint64_t degenerate = 0;
  std::uint64_t drift = 0;
  std::uint64_t length = 0;
  std::uint64_t size = 0;
  std::uint64_t disorder = 0;

  friend auto operator<=>(const Plainness&, const Plainness&) = default;

  /// Is it worse by any of the first four numbers, whatever the others are?
  [[nodiscard]] bool is_worse_somewhere(const Plainness& other) const;
};

/// \param original where the query comes from. \pre all coordinates are finite
[[nodiscard]] Plainness plainness(Kind kind, const Query& query, const Query& original);

/// At each end 1 for an edge that is shorter than 2^-10 of the query's extent, 1 for a triangle whose
/// height is less than 2^-10 of its longest side, or 2 if all its sides are so short; and 1 if the four
/// points are in one plane all the time, to about 2^-20. (The extent: the greatest difference of two
/// coordinates on an axis.) 0 to 5.
[[nodiscard]] std::uint64_t degeneracy(Kind kind, const Query& query);

/// The elements' part of degeneracy(): 0 to 4.
[[nodiscard]] std::uint64_t collapsed_elements(Kind kind, const Query& query);

/// Binary exponents of coordinates of everyday size.
inline constexpr int least_everyday = -10, greatest_everyday = 9;

/// The binary exponent of the greatest coordinate in magnitude; least_everyday if all are 0.
[[nodiscard]] int size_exponent(const Query& query);

/// The magnitudes that occur, 0 apart, least first.
[[nodiscard]] std::vector<double> magnitudes(const Query& query);

/// A positive number as the shortest decimal that reads as it: digits · 10^exponent, where the digits
/// do not end in 0.
struct Decimal {
  std::uint64_t digits = 0;
  int count = 0;  ///< of digits
  int exponent = 0;
};

/// \pre x is finite and positive
[[nodiscard]] Decimal shortest_decimal(double x);

/// 10^exponent. \pre 0 ≤ exponent ≤ 18
[[nodiscard]] std::int64_t power_of_ten(int exponent);

/// The double nearest to digits · 10^exponent.
[[nodiscard]] double from_decimal(std::uint64_t digits, int exponent);

/// The length of a magnitude by itself. \pre it is finite and positive
[[nodiscard]] std::uint64_t writing_length(double magnitude);

/// The pairs of points whose order does not matter.
using PointPair = std::array<std::size_t, 2>;
[[nodiscard]] std::span<const PointPair> exchangeable(Kind kind);

}  // namespace touchstone::verify::fuzz
