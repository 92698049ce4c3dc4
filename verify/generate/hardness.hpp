#pragma once

/// \file
/// Queries that are difficult in one respect, by a measured amount, and easy in all others.
///
/// Half of the queries of each class collide, as known by construction. A scene consists of
/// integers in a frame in which its *size*, about the longest side of its triangle or edge, is 2^50
/// (less, if another length is larger):
///
/// - vertex_face: at all times the triangle lies in a plane of constant z, with one side along x.
///   The vertex goes down towards it, over its interior or beside that side.
/// - edge_edge: each edge lies in a plane of constant z at all times, edge b along x. Edge a goes
///   down towards it, across its interior, or with one end beside it.
///
/// The x of moving points drift independently, so the motion is not rigid and the determinant is a
/// cubic. Contact is possible only when the two planes coincide, at the root of a linear equation.
///
/// The matrix (1 2 2; 2 1 −2; 2 −2 1) up to signs is three times a rotation, and integers up to
/// 1.6·2^50 stay below 2^53 under it: coordinates with full significands, along no axis, and exact.
/// So all distances are exactly three times those of the frame. Finally a power of two and an exact
/// symmetry are applied.
///
/// Four kinds of difficulty are about numbers as people type them and exporters print them: scenes
/// of short decimals (verify/generate/everyday.hpp), whose collisions are contacts exactly at t=0
/// or t=1, and whose other queries have the least possible clearance. They have size 1/10, times
/// the level's factor if it has one.
///
/// Three kinds are about curves, at distance 0 alone.
///
/// With a separation, contact is at that distance, except in scenes of decimals; the size is at
/// least 16 times as much. Irrational lengths are then rounded to the grid of the frame, so each
/// query is decided after its construction, and constructed again, at most sixteen times, until it
/// has the intended verdict.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/data/query_source.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

/// The meaning of a level's number.
enum class LevelUnit : std::uint8_t {
  power_of_two,  ///< the exponent
  digits,        ///< decimal digits
  percent,
  degree  ///< of curves
};

/// A kind of difficulty.
struct Hardness {
  /// Unique, kebab-case.
  std::string_view name;
  /// A short description of a level's number.
  std::string_view measure;
  /// A description of its queries.
  std::string_view reason;
  /// In order.
  std::vector<int> levels;
  LevelUnit unit = LevelUnit::power_of_two;
};

/// All kinds on straight lines, always in the same order.
[[nodiscard]] std::span<const Hardness> hardnesses();

/// All kinds on curves, always in the same order.
[[nodiscard]] std::span<const Hardness> curve_hardnesses();

/// These and those.
[[nodiscard]] std::span<const Hardness> all_hardnesses();

/// The kind of difficulty with that name, on straight lines or on curves.
/// \throws std::invalid_argument, listing the valid names, if there is none.
[[nodiscard]] const Hardness& hardness_from_name(std::string_view name);

/// "2^-20", "6 digits", "30 %" or "degree 3".
[[nodiscard]] std::string level_text(const Hardness& hardness, int level);

/// The power of two, the number of digits, the percentage, or the degree.
[[nodiscard]] double level_value(const Hardness& hardness, int level);

/// True if there are queries for this separation: for distances up to 2^14.
[[nodiscard]] bool has_hard_queries(const Separation& separation);

/// The minimum separation in the queries of a level for the requested `separation`: that, times the
/// level's factor if the level scales the coordinates.
[[nodiscard]] Separation separation_at(const Hardness& hardness, int level,
                                       const Separation& separation);

/// The queries to generate.
struct HardSort {
  const Hardness* hardness = nullptr;  ///< not null
  int level = 0;                       ///< one of the kind's levels
  Kind kind = Kind::vertex_face;
  Separation separation = {};  ///< as requested, before separation_at()
};

/// Query number `index`: a function of the arguments alone, the same on every machine. Even numbers
/// collide and odd ones do not, up to the last bits of queries about a separation. Its label is the
/// verdict of the certified solver, or on curves that of its construction.
/// \throws std::invalid_argument if the kind does not have the level, or there are no queries for
/// the separation: on curves, for any but 0.
[[nodiscard]] data::RecordedQuery make_hard_query(const HardSort& sort, std::uint64_t seed,
                                                  std::uint64_t index);

/// The queries 0 to count−1 as a stream. Its
/// name is kind and level, "distance 2^-20"; its recorded separation is that of separation_at().
[[nodiscard]] std::unique_ptr<data::QuerySource> open_hard_queries(const HardSort& sort,
                                                                   std::uint64_t seed,
                                                                   std::uint64_t count);

// Queries on curves that nearly touch, or just do, by a given amount.
//
// A vertex is over the inside of a triangle, or an edge over a crossing one, at the height
// ±(m (t−a/8)² q(t) + g), where q has Bernstein coefficients of 1 to 4. For g > 0 the distance is
// never less than g, and is g at t = a/8; for g = 0 they touch there alone; for −1/64 ≤ g < 0 one
// goes through the other, because the height has the other sign at the farther end, where
// m (t−a/8)² q ≥ 1/4. m is the odd number that makes the control values, which are quotients by
// binomials, binary fractions. A rotation is that of curved_families.hpp.
//
// The whole is moved along a curve, and turned by the matrix of hardness.hpp, which multiplies
// distances by 3. All numbers are multiples of 2^-38 below 2^13, so each step is exact.

/// Polynomial curves. \param gap g, a multiple of 2^-38 \pre 2 ≤ degree ≤ 8, −1/64 ≤ gap ≤ 1
[[nodiscard]] base::AnyQuery hard_curves(Kind kind, std::size_t degree, double gap, Random& random);

/// A rotation about an axis. \param gap by the radius, a multiple of 2^-36 \pre |gap| ≤ 1/64
[[nodiscard]] base::AnyQuery hard_rotation(Kind kind, double gap, Random& random);

}  // namespace touchstone::verify::generate
