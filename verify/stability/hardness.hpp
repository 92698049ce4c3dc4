#pragma once

/// \file
/// Queries that are hard in one way, by a measured amount, and mild in every other.
///
/// Of each sort half of the queries collide and half do not, and what decides it is known by
/// construction. A scene is built of integers in a frame of its own, where its *size*, about the
/// longest side of its triangle or edge, is 2^50 (or less, where something in it is larger):
///
/// - vertex_face: at all times the triangle lies in a plane of constant z, with one side along x. The
///   vertex goes down towards it, over its interior or beside that side.
/// - edge_edge: each edge lies in a plane of constant z at all times, edge b along x. Edge a goes down
///   towards it, across its interior, or with one end beside it.
///
/// While points move, their x drift independently, so the motion is not rigid and the determinant is a
/// cubic. Contact can be only where the two planes meet, at a time that a linear equation gives.
///
/// The matrix (1 2 2; 2 1 −2; 2 −2 1) up to signs is three times a rotation, and integers up to
/// 1.6·2^50 stay below 2^53 under it: coordinates with full significands, along no axis, and exact.
/// So all distances are exactly three times those of the frame. A power of two and an exact symmetry
/// end the making.
///
/// Four kinds of hardness are about what people type and exporters print instead: scenes of short decimals
/// (verify/fuzz/everyday.hpp), whose collisions are contacts exactly at t=0 or t=1, and whose misses are
/// as near as they come. They are of size 1/10, or of that times the level's factor.
///
/// With a separation, contact is to be at that distance, but for scenes of decimals; the size is at least 16 times as much. What
/// is irrational is then rounded to the grid of the frame, so each query is judged as it is made, and
/// made anew, sixteen times at most, until it has the verdict that it should have.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "exact/query.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::stability {

/// What the number of a level is.
enum class LevelUnit : std::uint8_t {
  power_of_two,  ///< the exponent
  digits,        ///< decimal digits
  percent
};

/// A way to be hard.
struct Hardness {
  /// Unique, kebab-case.
  std::string_view name;
  /// The meaning of a level's number, in few words.
  std::string_view measure;
  /// A description of its queries.
  std::string_view reason;
  /// In order.
  std::array<int, 11> levels;
  LevelUnit unit = LevelUnit::power_of_two;
};

/// All of them, always in the same order.
[[nodiscard]] std::span<const Hardness> hardnesses();

/// The hardness of that name.
/// \throws std::invalid_argument, with the names there are, if there is none.
[[nodiscard]] const Hardness& hardness_from_name(std::string_view name);

/// "2^-20", "6 digits" or "30 %".
[[nodiscard]] std::string level_text(const Hardness& hardness, int level);

/// The power of two, the number of digits, or the percentage.
[[nodiscard]] double level_value(const Hardness& hardness, int level);

/// Are there hard queries about this separation? About contact, and distances up to 2^14.
[[nodiscard]] bool has_hard_queries(const Separation& separation);

/// Minimum separation in the queries of a level where `separation` was asked for: that, times the
/// level's factor where the level scales the coordinates.
[[nodiscard]] Separation separation_at(const Hardness& hardness, int level,
                                       const Separation& separation);

/// Which queries to make.
struct HardSort {
  const Hardness* hardness = nullptr;  ///< not null
  int level = 0;                       ///< one of the hardness's
  Kind kind = Kind::vertex_face;
  Separation separation = {};  ///< as asked for, before separation_at()
};

/// A query and the verdict of the certified solver on it.
struct HardQuery {
  Query query{};
  bool collides = false;
};

/// Query number `index`: a function of the arguments and nothing else, the same on every machine.
/// Even numbers collide and odd ones do not, but for the last bits of what is about a separation.
/// \throws std::invalid_argument if the level is none of the hardness's, or there are no hard
/// queries about the separation.
[[nodiscard]] HardQuery make_hard_query(const HardSort& sort, std::uint64_t seed,
                                        std::uint64_t index);

/// The queries 0 to count−1 as a stream, labelled with the verdicts of the certified solver. Its name
/// is hardness and level, "distance 2^-20"; its recorded separation is that of separation_at().
[[nodiscard]] std::unique_ptr<data::QuerySource> open_hard_queries(const HardSort& sort,
                                                                   std::uint64_t seed,
                                                                   std::uint64_t count);

}  // namespace touchstone::verify::stability
