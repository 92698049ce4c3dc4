#pragma once

/// \file
/// Queries for tests: written down point by point, or drawn at random from families that each have
/// their own way of being difficult.
///
/// Random coordinates hardly ever touch a boundary, so most families force what chance avoids:
/// shared points, points at rest, motion in a plane or on a line, contacts built to lie on an edge
/// of a primitive up to rounding.

#include <algorithm>
#include <array>
#include <cstddef>
#include <ios>
#include <ostream>

#include "exact/query.hpp"
#include "tests/support/random.hpp"

namespace touchstone::tests {

/// A query with its kind.
struct PosedQuery {
  Kind kind;
  Query query;
};

/// Prints the kind and the coordinates as hexadecimal doubles: enough to repeat the case.
inline std::ostream& operator<<(std::ostream& out, const PosedQuery& posed) {
  out << to_string(posed.kind) << std::hexfloat;
  for (const double x : posed.query.coordinates) out << ' ' << x;
  return out << std::defaultfloat;
}

/// Four points, x, y, z each, in the order of Query.
using FourPoints = std::array<double, 3 * moving_points>;

/// The query whose points are at `start` at t=0 and at `end` at t=1.
[[nodiscard]] inline Query moving(const FourPoints& start, const FourPoints& end) {
  Query query{};
  const auto middle = std::ranges::copy(start, query.coordinates.begin()).out;
  std::ranges::copy(end, middle);
  return query;
}

[[nodiscard]] inline PosedQuery vertex_face(const FourPoints& start, const FourPoints& end) {
  return {Kind::vertex_face, moving(start, end)};
}

[[nodiscard]] inline PosedQuery edge_edge(const FourPoints& start, const FourPoints& end) {
  return {Kind::edge_edge, moving(start, end)};
}

/// The families of random queries.
enum class Family {
  /// Coordinates −1, 0, 1, with forced degeneracies.
  tiny_integers,
  /// Coordinates −2 … 2, with forced degeneracies.
  small_integers,
  /// Coordinates in (−2, 2) with 53 random bits: generic position.
  full_significands,
  /// As full_significands, then one point aimed so that the primitives touch up to rounding, half
  /// of the time on the boundary of a primitive: hits by a hair and misses by a hair.
  near_contact
};

inline constexpr std::array<Family, 4> all_families{
    Family::tiny_integers, Family::small_integers, Family::full_significands, Family::near_contact};

/// Does every coordinate of the family's queries have few bits, so that sums and midpoints of them
/// are exact?
[[nodiscard]] constexpr bool has_integer_coordinates(Family family) {
  return family == Family::tiny_integers || family == Family::small_integers;
}

/// Point `to` becomes the same moving point as `from`.
inline void share_point(Query& query, std::size_t from, std::size_t to) {
  for (const std::size_t end : {0U, 1U}) query.point(end, to) = query.point(end, from);
}

/// All points stay in the plane where the coordinate `axis` is 0.
inline void flatten(Query& query, std::size_t axis) {
  for (const std::size_t end : {0U, 1U}) {
    for (std::size_t point = 0; point < moving_points; ++point) query.at(end, point, axis) = 0.0;
  }
}

/// All points move by the same vector, that of point 0, as far as the sums are exact.
inline void move_together(Query& query) {
  const Eigen::Vector3d step = query.point(1, 0) - query.point(0, 0);
  for (std::size_t point = 1; point < moving_points; ++point) {
    query.point(1, point) = query.point(0, point) + step;
  }
}

/// Forces one random degeneracy, or none.
inline void degenerate(Random& random, Query& query) {
  const auto some = [&random](int count) {
    return static_cast<std::size_t>(random.between(0, count - 1));
  };
  const std::size_t axis = some(3), point = some(4), other = some(4);
  switch (random.between(0, 8)) {
    case 0:
    case 1:
      flatten(query, axis);
      break;
    case 2:
      flatten(query, axis);
      flatten(query, (axis + 1) % 3);
      break;
    case 3:
      share_point(query, point, other);
      break;
    case 4:
      query.point(some(2), point) = query.point(0, other);
      break;
    case 5:
      query.point(1, point) = query.point(0, point);
      break;
    case 6:
      move_together(query);
      break;
    default:
      break;
  }
}

/// Every coordinate an integer in [−bound, bound] (twice that for points that move together).
[[nodiscard]] inline Query integer_query(Random& random, int bound) {
  Query query{};
  for (double& x : query.coordinates) x = random.between(-bound, bound);
  degenerate(random, query);
  return query;
}

[[nodiscard]] inline Query full_significand_query(Random& random) {
  Query query{};
  for (double& x : query.coordinates) x = random.few_bit_double(53, -53, -52);
  return query;
}

/// Moves the end of point 0 so that F(t,u,v) = 0 up to rounding, for random t ≥ 1/8 and (u,v).
[[nodiscard]] inline Query near_contact_query(Random& random, Kind kind) {
  Query query = full_significand_query(random);
  const double t = random.uniform(0.125, 1.0);
  double u = random.uniform(0.0, 0.75);
  double v = kind == Kind::vertex_face ? random.uniform(0.0, 1.0 - u) : random.uniform();
  switch (random.between(0, 5)) {
    case 0:
      u = 0.0;
      break;
    case 1:
      v = 0.0;
      break;
    case 2:
      v = kind == Kind::vertex_face ? 1.0 - u : 1.0;
      break;
    default:
      break;
  }
  const auto at_t = [&](std::size_t point) -> Eigen::Vector3d {
    return (1.0 - t) * query.point(0, point) + t * query.point(1, point);
  };
  const Eigen::Vector3d a = at_t(1), b = at_t(2), c = at_t(3);
  const Eigen::Vector3d aim = kind == Kind::vertex_face
                                  ? Eigen::Vector3d((1.0 - u - v) * a + u * b + v * c)
                                  : Eigen::Vector3d(((1.0 - v) * b + v * c - u * a) / (1.0 - u));
  query.point(1, 0) = (aim - (1.0 - t) * query.point(0, 0)) / t;
  return query;
}

/// A random query of the family.
[[nodiscard]] inline PosedQuery random_query(Random& random, Kind kind, Family family) {
  switch (family) {
    case Family::tiny_integers:
      return {kind, integer_query(random, 1)};
    case Family::small_integers:
      return {kind, integer_query(random, 2)};
    case Family::full_significands:
      return {kind, full_significand_query(random)};
    default:
      return {kind, near_contact_query(random, kind)};
  }
}

}  // namespace touchstone::tests
