#pragma once

/// \file
/// Families of growing difficulty: queries that are difficult in one respect, by a measured amount
/// that their level says, and easy in all others.
///
/// Scenes on straight lines consist of integers in a frame in which their *size*, about the longest
/// side of the triangle or edge, is 2^50 or less. The triangle stays in the plane z=0, edge b on
/// the axis x. The vertex, or edge a, which stays parallel to the plane, goes down to it; it stops
/// short of the other primitive, passes beside it, or collides. The x of all points drift
/// independently, so the motion is not rigid and the determinant is a cubic, but they are in
/// contact only when the two planes coincide, at the root of a linear equation.
///
/// The matrix (1 2 2; 2 1 −2; 2 −2 1) up to signs is three times a rotation, and integers up to
/// 1.6·2^50 stay below 2^53 under it: coordinates with full significands, along no axis, and exact.
/// So all distances are exactly three times those of the frame. Finally a power of two and an exact
/// symmetry are applied: the size is about 3.
///
/// On curves the vertex is over the inside of the triangle, or edge a over b, at the height
/// ±(64 (t−a/8)² + g): for g > 0 the distance is never less than g, and is g at t = a/8; for g < 0
/// one goes through the other. The whole is moved along a parabola, and turned by the matrix. All
/// numbers are multiples of 2^-38 below 2^13, so each step is exact.
///
/// Contacts at t=1 are so by equality: there a vertex of one primitive has the coordinates of a
/// vertex of the other.

#include <cstdint>
#include <span>
#include <string_view>

#include "touchstone/any_kind.hpp"
#include "verify/data/query_group.hpp"

namespace touchstone::verify::generate {

/// The levels of each family are 1 to this.
inline constexpr int greatest_level = 12;

/// A family of growing difficulty.
struct LevelFamily {
  std::string_view name;     ///< unique, kebab-case
  std::string_view meaning;  ///< of level L
};

/// All of them, always in the same order. Half of the queries of the first four collide, those of
/// even numbers; the others are contacts at t=1 or earlier.
[[nodiscard]] std::span<const LevelFamily> level_families();

/// The family of that name. \throws std::invalid_argument, listing the names, if there is none.
[[nodiscard]] const LevelFamily& level_family(std::string_view name);

/// Queries of a level: a function of the arguments alone, the same on every machine. The group has
/// the family's name. \pre 1 ≤ level ≤ greatest_level
[[nodiscard]] data::QueryGroup level_group(const LevelFamily& family, ContactKind kind, int level,
                                           std::uint64_t seed, std::uint64_t count);

}  // namespace touchstone::verify::generate
