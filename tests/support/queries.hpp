#pragma once

/// \file
/// Queries for tests: given point by point, or drawn at random from families with different
/// difficulties.
///
/// Random coordinates are hardly ever on a boundary, so most families force degeneracies: shared
/// points, points at rest, motion in a plane or on a line, contacts built to lie on an edge of a
/// primitive up to rounding.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <ios>
#include <limits>
#include <ostream>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::tests {

/// A query with its kind.
struct PosedQuery {
  ContactKind kind;
  Query query;
};

/// Prints the kind and the coordinates as hexadecimal doubles: enough to repeat the case.
inline std::ostream& operator<<(std::ostream& out, const PosedQuery& posed) {
  out << to_string(posed.kind) << std::hexfloat;
  for (const double x : posed.query.coordinates) out << ' ' << x;
  return out << std::defaultfloat;
}

/// A query on curves with its kind and separation.
struct PosedCurves {
  ContactKind kind;
  CurvedQuery query;
  Separation separation = {};
};

/// Vertices and edges, or pairs of vertices, with any numbers, none of which has an effect, in the
/// place of further points; and each as a vertex and a face that has shrunk.
struct ShrunkenFaces {
  QueryShape shape;
  std::vector<double> numbers = {}, numbers_of_faces = {};

  [[nodiscard]] Queries queries() const { return {shape, numbers}; }
  [[nodiscard]] Queries faces() const {
    return {{ContactKind::vertex_face, shape.degree, shape.is_rational}, numbers_of_faces};
  }
};

/// Of small integers, every other one on a line, so that many meet.
[[nodiscard]] inline ShrunkenFaces shrunken_faces(Random& random, const QueryShape& shape,
                                                  std::size_t count) {
  constexpr std::array effectless{std::numeric_limits<double>::quiet_NaN(),
                                  std::numeric_limits<double>::infinity(), -0x1p1023, 0.5};
  const std::size_t size = shape.numbers_of_point();
  const std::size_t points = shape.kind == ContactKind::vertex_edge ? 3 : 2;
  ShrunkenFaces result{shape};
  for (std::size_t i = 0; i < count * (shape.degree + 1); ++i) {
    const bool is_on_line = i / (shape.degree + 1) % 2 == 0;
    const auto drawn = [&](std::size_t point, std::size_t place) -> double {
      if (point >= points) return effectless.at(static_cast<std::size_t>(random.between(0, 3)));
      if (place == 3) return random.between(1, 2);
      return is_on_line && place > 0 ? 0.0 : random.between(-2, 2);
    };
    const std::size_t first = result.numbers.size();
    for (std::size_t k = 0; k < moving_points * size; ++k) {
      const std::size_t point = k / size, place = k % size;
      result.numbers.push_back(drawn(point, place));
      result.numbers_of_faces.push_back(
          result.numbers[first + (point < points ? point : 1) * size + place]);
    }
  }
  return result;
}

/// All shapes that such queries have in tests.
[[nodiscard]] inline std::vector<QueryShape> shrunken_shapes() {
  std::vector<QueryShape> shapes;
  for (const ContactKind kind : {ContactKind::vertex_edge, ContactKind::vertex_vertex}) {
    shapes.insert(shapes.end(), {{kind, 1, false}, {kind, 2, false}, {kind, 2, true}});
  }
  return shapes;
}

/// Prints the kind, and each point's control points and weights as hexadecimal doubles.
inline std::ostream& operator<<(std::ostream& out, const PosedCurves& posed) {
  const auto& [kind, query, separation] = posed;
  out << to_string(kind) << std::hexfloat;
  for (const Trajectory& curve : query) {
    out << "; control";
    for (const auto& point : curve.control) {
      for (const double x : point) out << ' ' << x;
    }
    if (!curve.weights.empty()) out << " weights";
    for (const double w : curve.weights) out << ' ' << w;
  }
  if (!is_zero(separation)) {
    out << "; separation " << separation.distance << ' ' << to_string(separation.norm);
  }
  return out << std::defaultfloat;
}

[[nodiscard]] inline PosedCurves to_curves(const PosedQuery& posed) {
  return {posed.kind, to_curved(posed.query)};
}

/// Four points, x, y, z each, in the order of Query.
using FourPoints = std::array<double, 3 * moving_points>;

/// The query with the points `start` at t=0 and `end` at t=1.
[[nodiscard]] inline Query moving(const FourPoints& start, const FourPoints& end) {
  Query query{};
  std::ranges::copy(end, std::ranges::copy(start, query.coordinates.begin()).out);
  return query;
}

[[nodiscard]] inline PosedQuery vertex_face(const FourPoints& start, const FourPoints& end) {
  return {ContactKind::vertex_face, moving(start, end)};
}

[[nodiscard]] inline PosedQuery edge_edge(const FourPoints& start, const FourPoints& end) {
  return {ContactKind::edge_edge, moving(start, end)};
}

/// The points of a vertex-face query at one time: the vertex (x,y,z), then the face.
[[nodiscard]] constexpr FourPoints with_vertex(double x, double y, double z,
                                               const std::array<double, 9>& face) {
  FourPoints points{x, y, z};
  std::ranges::copy(face, points.begin() + 3);
  return points;
}

/// A vertex that moves from height z0 to z1 over (x,y), and the triangle x, y ≥ 0, x + y ≤ 4 in the
/// plane z=0: contact at z0/(z0 − z1), u = x/4, v = y/4.
[[nodiscard]] inline PosedQuery over_triangle(double x, double y, double z0, double z1) {
  constexpr std::array<double, 9> face{0, 0, 0, 4, 0, 0, 0, 4, 0};
  return vertex_face(with_vertex(x, y, z0, face), with_vertex(x, y, z1, face));
}

/// The edge from (0,0,0) to (4,0,0), and one parallel to the y axis from (x,−y) to (x,4−y) that
/// moves from height z0 to z1: contact at z0/(z0 − z1), u = x/4, v = y/4.
[[nodiscard]] inline PosedQuery over_edge(double x, double y, double z0, double z1) {
  return edge_edge({0, 0, 0, 4, 0, 0, x, -y, z0, x, 4 - y, z0},
                   {0, 0, 0, 4, 0, 0, x, -y, z1, x, 4 - y, z1});
}

/// The triangle (0,0,0), (s,st,0), (0,0,1), which turns about the z axis, and a vertex at height
/// 1/4 that moves from (x0,y) to (x1,y): in the triangle's plane where t x = y; there u = x/s, v =
/// 1/4.
[[nodiscard]] inline PosedQuery turning_triangle(double s, double x0, double x1, double y) {
  return vertex_face({x0, y, 0.25, 0, 0, 0, s, 0, 0, 0, 0, 1},
                     {x1, y, 0.25, 0, 0, 0, s, s, 0, 0, 0, 1});
}

/// The triangle (0,0,0), (1,t,0), (t,0,1) with normal (t, −1, −t²), and a vertex that moves from
/// `start` to `end`: at (x,y,z) in its plane, v = z and u = x − t z.
[[nodiscard]] inline PosedQuery twisting_triangle(const std::array<double, 3>& start,
                                                  const std::array<double, 3>& end) {
  return vertex_face(with_vertex(start[0], start[1], start[2], {0, 0, 0, 1, 0, 0, 0, 0, 1}),
                     with_vertex(end[0], end[1], end[2], {0, 0, 0, 1, 1, 0, 1, 0, 1}));
}

/// The families of random queries.
enum class Family {
  /// Coordinates −1, 0, 1, with forced degeneracies.
  tiny_integers,
  /// Coordinates −2 … 2, with forced degeneracies.
  small_integers,
  /// Coordinates in (−2, 2) with 53 random bits: generic position.
  full_significands,
  /// As full_significands, but with one point moved so that there is contact up to rounding, half
  /// of the time on the boundary of a primitive.
  near_contact
};

inline constexpr std::array<Family, 4> all_families{
    Family::tiny_integers, Family::small_integers, Family::full_significands, Family::near_contact};

/// Makes point `to` the same moving point as `from`.
inline void share_point(Query& query, std::size_t from, std::size_t to) {
  for (const std::size_t end : {0U, 1U}) point_of(query, end, to) = point_of(query, end, from);
}

/// Moves all points in the plane in which the coordinate `axis` is 0.
inline void flatten(Query& query, std::size_t axis) {
  for (const std::size_t end : {0U, 1U}) {
    for (std::size_t point = 0; point < moving_points; ++point) query.at(end, point, axis) = 0.0;
  }
}

/// Moves all points by the vector of point 0, as far as the sums are exact.
inline void move_together(Query& query) {
  const Eigen::Vector3d step = point_of(query, 1, 0) - point_of(query, 0, 0);
  for (std::size_t point = 1; point < moving_points; ++point) {
    point_of(query, 1, point) = point_of(query, 0, point) + step;
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
      point_of(query, some(2), point) = point_of(query, 0, other);
      break;
    case 5:
      point_of(query, 1, point) = point_of(query, 0, point);
      break;
    case 6:
      move_together(query);
      break;
    default:
      break;
  }
}

/// A query of integer coordinates in [−bound, bound] (twice that for points that move together).
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
[[nodiscard]] inline Query near_contact_query(Random& random, ContactKind kind) {
  Query query = full_significand_query(random);
  const double t = random.uniform(0.125, 1.0);
  double u = random.uniform(0.0, 0.75);
  double v = kind == ContactKind::vertex_face ? random.uniform(0.0, 1.0 - u) : random.uniform();
  switch (random.between(0, 5)) {
    case 0:
      u = 0.0;
      break;
    case 1:
      v = 0.0;
      break;
    case 2:
      v = kind == ContactKind::vertex_face ? 1.0 - u : 1.0;
      break;
    default:
      break;
  }
  const auto at_t = [&](std::size_t point) -> Eigen::Vector3d {
    return (1.0 - t) * point_of(query, 0, point) + t * point_of(query, 1, point);
  };
  const Eigen::Vector3d a = at_t(1), b = at_t(2), c = at_t(3);
  const Eigen::Vector3d aim = kind == ContactKind::vertex_face
                                  ? Eigen::Vector3d((1.0 - u - v) * a + u * b + v * c)
                                  : Eigen::Vector3d(((1.0 - v) * b + v * c - u * a) / (1.0 - u));
  point_of(query, 1, 0) = (aim - (1.0 - t) * point_of(query, 0, 0)) / t;
  return query;
}

/// A random query of the family.
[[nodiscard]] inline PosedQuery random_query(Random& random, ContactKind kind, Family family) {
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
