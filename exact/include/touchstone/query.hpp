#pragma once

/// \file
/// The one definition of the problem that every module works on.
///
/// Four points move on straight lines from t=0 to t=1. For u, v in the domain of the kind,
///
///     vertex_face:  F(t,u,v) = v(t) − ((1−u−v) f0(t) + u f1(t) + v f2(t)),   u, v ≥ 0, u+v ≤ 1
///     edge_edge:    F(t,u,v) = ((1−u) ea0(t) + u ea1(t)) − ((1−v) eb0(t) + v eb1(t)),   u, v ∈
///     [0,1]
///
/// and x(t) = (1−t) x(0) + t x(1). A query *collides* iff F has a root with t ∈ [0,1] and (u,v) in
/// the closed domain: contact at t=0, at t=1 and on the boundary counts. Its *time of impact* (toi)
/// is the smallest t of a root. ([wang2021], section 3, equations 3 and 4; docs/theory.md,
/// section 1.)
///
/// For fixed t, F is affine in (u,v), so its image is the convex hull of its values at the vertices
/// of the domain: the *corners* w_i(t), three for vertex_face, four (a parallelogram, in cyclic
/// order) for edge_edge. Hence a query collides iff 0 ∈ conv{w_i(t)} for some t ∈ [0,1].
///
/// A vertex and an edge, or two vertices, are a vertex and a face that has shrunk to them: with the
/// missing vertices of the face equal to its first one, F has the same roots, at other (u,v).
///
/// Cells of a mesh, which invert instead, have kinds of their own (touchstone/cell.hpp).
///
/// **Coordinates that are not finite.** One rule for every function, in C++ and C. A function whose
/// results have verdicts answers `error` for a query with a coordinate that is NaN or infinite, or
/// with a weight that is not positive and finite, and decides the other queries
/// (touchstone::fast::Verdict). All other functions (the oracle, distances, lists of collisions,
/// scenes) throw std::domain_error, which names the vertex or query if there are several. A
/// caller's compiler options have no effect (is_finite).
///
/// All functions are thread-safe. The headers of the target touchstone::query, this one,
/// curved_query.hpp, cell.hpp and any_kind.hpp, are the only ones of exact/ that fast/ includes;
/// they need nothing but the standard library.

#include "touchstone/cxx20.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace touchstone {

/// The two primitives of a query, or of a pair of a mesh.
enum class ContactKind : std::uint8_t {
  vertex_face,    ///< v, f0, f1, f2
  edge_edge,      ///< ea0, ea1, eb0, eb1; of a mesh: the smaller number first
  vertex_edge,    ///< v, e0, e1; of a mesh: a codimensional point and a codimensional edge
  vertex_vertex,  ///< v, w; of a mesh: two codimensional points, the smaller number first
};

/// The kind of the query that decides one of this kind: vertex_face for all but edge_edge.
[[nodiscard]] constexpr ContactKind decided_as(ContactKind kind) {
  return kind == ContactKind::edge_edge ? kind : ContactKind::vertex_face;
}

/// Number of points that move, and number of points in a query (start and end of each).
inline constexpr std::size_t moving_points = 4;
inline constexpr std::size_t query_points = 2 * moving_points;

/// Eight points as 24 contiguous doubles, in the order of the public data: at t=0 then at t=1, the
/// points in the order of the kind, or those of a cell; x, y, z each. Points that the kind does not
/// have are there, too, and have no effect.
///
/// The layout is the file layout of a float64 array of shape (N, 8, 3), so such an array in memory
/// is a `std::span<const Query>` without a copy. The kind is not stored in it, because all queries
/// of a batch have the same kind.
struct Query {
  std::array<double, 3 * query_points> coordinates;

  /// Coordinate `axis` (0..2) of point `point` (0..3, in the order above) at time `end` (0 or 1).
  [[nodiscard]] double at(std::size_t end, std::size_t point, std::size_t axis) const {
    return coordinates[index(end, point, axis)];
  }
  [[nodiscard]] double& at(std::size_t end, std::size_t point, std::size_t axis) {
    return coordinates[index(end, point, axis)];
  }

  /// The place of a coordinate in `coordinates`.
  [[nodiscard]] static constexpr std::size_t index(std::size_t end, std::size_t point,
                                                   std::size_t axis) {
    return 3 * (moving_points * end + point) + axis;
  }

  friend bool operator==(const Query&, const Query&) = default;
};
static_assert(sizeof(Query) == 3 * query_points * sizeof(double));
static_assert(std::is_trivially_copyable_v<Query> && std::is_standard_layout_v<Query> &&
              std::is_aggregate_v<Query>);

/// The point whose place a point (0..3) has in the query that decides one of this kind: the missing
/// vertices of a face that has shrunk are its first one.
[[nodiscard]] constexpr std::size_t decided_point(ContactKind kind, std::size_t point) {
  const std::size_t first_missing = kind == ContactKind::vertex_edge     ? 3
                                    : kind == ContactKind::vertex_vertex ? 2
                                                                         : moving_points;
  return point < first_missing ? point : 1;
}

/// The query that decides one of this kind, of the kind decided_as(kind).
[[nodiscard]] inline Query decided_query(ContactKind kind, const Query& query) {
  Query result = query;
  for (std::size_t i = 0; i < query_points; ++i) {
    const std::size_t end = i / moving_points, point = i % moving_points;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.at(end, point, axis) = query.at(end, decided_point(kind, point), axis);
    }
  }
  return result;
}

/// The greatest degree of a curve.
inline constexpr std::size_t greatest_degree = 8;

/// \throws std::invalid_argument unless the degree of curves is from 1 to greatest_degree.
inline void require_degree(std::size_t degree) {
  if (degree > 0 && degree <= greatest_degree) return;
  throw std::invalid_argument("the degree of curves must be from 1 to " +
                              std::to_string(greatest_degree) + ", not " + std::to_string(degree) +
                              (degree == 0 ? "; repeat the control point of a point at rest" : ""));
}

/// The shape of queries or cells: their kind, and the Bézier curves that all points move on. A
/// point's position is x(t) = Σ_j B_j(t) b_j with the Bernstein polynomials B_j(t) = binomial(k, j)
/// (1−t)^(k−j) t^j of degree k, or, with positive weights w_j, Σ_j B_j(t) w_j b_j / Σ_j B_j(t) w_j.
/// A straight line is a curve of degree 1, the least there is.
template <class Kind>
struct Shape {
  Kind kind = {};
  std::size_t degree = 1;
  bool is_rational = false;  ///< Each control point has a weight.

  /// True if the points move on straight lines, as those of Query.
  [[nodiscard]] bool is_straight() const { return degree == 1 && !is_rational; }
  [[nodiscard]] std::size_t numbers_of_point() const { return is_rational ? 4 : 3; }
  [[nodiscard]] std::size_t numbers_of_query() const {
    return (degree + 1) * moving_points * numbers_of_point();
  }
  /// The same of a type of more kinds.
  template <class Other>
  requires(std::is_convertible_v<Kind, Other>) operator Shape<Other>()
      const {  // NOLINT(google-explicit-constructor)
    return {kind, degree, is_rational};
  }
  friend bool operator==(const Shape&, const Shape&) = default;
};

/// Queries or cells of one shape in an array, by reference.
///
/// Each has its control points from t=0 to t=1, and at each the four points in the order of Query:
/// an array of shape (size, degree + 1, 4, 3), or (size, degree + 1, 4, 4) with weights last. On
/// straight lines that is the layout of an array of Query.
template <class Kind>
struct Batch : Shape<Kind> {
  std::span<const double> numbers = {};

  Batch() = default;
  Batch(Kind kind_of_all, std::span<const Query> queries)
      : Shape<Kind>{.kind = kind_of_all},
        numbers(queries.empty() ? nullptr : queries.front().coordinates.data(),
                queries.size() * 3 * query_points) {}
  /// \throws std::invalid_argument as require_degree, and unless the numbers are those of whole
  /// queries.
  Batch(const Shape<Kind>& shape, std::span<const double> all) : Shape<Kind>(shape), numbers(all) {
    require_degree(this->degree);
    if (numbers.size() % this->numbers_of_query() != 0) {
      throw std::invalid_argument(
          "queries: " + std::to_string(numbers.size()) + " numbers are no multiple of " +
          std::to_string(this->numbers_of_query()) + ", the size of a query of degree " +
          std::to_string(this->degree));
    }
  }
  /// The same of a type of fewer kinds.
  template <class Other>
  requires(std::is_convertible_v<Other, Kind>)
      Batch(const Batch<Other>& other)  // NOLINT(google-explicit-constructor)
      : Batch(other.as(Kind(other.kind))) {}

  [[nodiscard]] std::size_t size() const { return numbers.size() / this->numbers_of_query(); }
  [[nodiscard]] bool empty() const { return numbers.empty(); }
  /// The numbers of query i.
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    return numbers.subspan(i * this->numbers_of_query(), this->numbers_of_query());
  }
  /// `count` queries from number `first` on.
  [[nodiscard]] Batch part(std::size_t first, std::size_t count) const {
    Batch some = *this;
    some.numbers =
        numbers.subspan(first * this->numbers_of_query(), count * this->numbers_of_query());
    return some;
  }
  /// The same queries as an array of Query. \pre is_straight()
  [[nodiscard]] std::span<const Query> straight() const {
    return {reinterpret_cast<const Query*>(numbers.data()), size()};
  }
  /// The same numbers as those of another kind.
  template <class Other>
  [[nodiscard]] Batch<Other> as(Other other) const {
    return {{other, this->degree, this->is_rational}, numbers};
  }
};

using QueryShape = Shape<ContactKind>;
using Queries = Batch<ContactKind>;

/// The queries that decide these: the same, or with numbers in `memory`.
[[nodiscard]] inline Queries decided_queries(const Queries& queries, std::vector<double>& memory) {
  if (decided_as(queries.kind) == queries.kind) return queries;
  const std::size_t size = queries.numbers_of_point();
  memory.resize(queries.numbers.size());
  for (std::size_t i = 0; i < memory.size(); ++i) {
    const std::size_t point = i / size % moving_points;
    memory[i] = queries.numbers[i - (point - decided_point(queries.kind, point)) * size];
  }
  QueryShape shape = queries;
  shape.kind = decided_as(queries.kind);
  return {shape, memory};
}

/// The same number in double, also for subnormal floats, which a conversion would lose if the
/// caller's floating-point state takes them for 0.
[[nodiscard]] constexpr double to_double(double x) { return x; }
[[nodiscard]] constexpr double to_double(float x) {
  constexpr std::uint32_t exponent = 0x7F80'0000, significand = 0x007F'FFFF;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  if ((bits & exponent) != 0) return static_cast<double>(x);
  const double magnitude = static_cast<double>(bits & significand) * 0x1p-149;
  return bits > significand ? -magnitude : magnitude;
}

/// The bits of infinity; those of a number that is not finite contain them.
inline constexpr std::uint64_t infinity_bits = 0x7FF0'0000'0000'0000;

/// True if all numbers, or all coordinates, are finite. The bits decide, because a caller's
/// compiler may take every number for finite (-ffast-math).
[[nodiscard]] inline bool is_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double x) {
    return (std::bit_cast<std::uint64_t>(x) & infinity_bits) != infinity_bits;
  });
}
[[nodiscard]] inline bool is_finite(const Query& query) { return is_finite(query.coordinates); }

/// The default of every `max_threads`: one thread for each core that the process may use. Results
/// never depend on the number of threads.
inline constexpr int all_cores = 0;

/// A corner of F: its value at the vertex (u,v) of the domain, where it is the difference of point
/// `plus` and point `minus` (0..3).
struct Corner {
  std::size_t plus;
  std::size_t minus;
  int u;
  int v;
};

inline constexpr std::array<Corner, 3> vertex_face_corners{
    {{0, 1, 0, 0}, {0, 2, 1, 0}, {0, 3, 0, 1}}};
inline constexpr std::array<Corner, 4> edge_edge_corners{
    {{0, 2, 0, 0}, {1, 2, 1, 0}, {1, 3, 1, 1}, {0, 3, 0, 1}}};

/// The corners of a kind: v−f0, v−f1, v−f2, or ea0−eb0, ea1−eb0, ea1−eb1, ea0−eb1 in cyclic order.
[[nodiscard]] constexpr std::span<const Corner> corners(ContactKind kind) {
  if (kind == ContactKind::edge_edge) return edge_edge_corners;
  return vertex_face_corners;
}

/// r = w_0, p = w_0 − w_1 and q = w_0 − w_last, so that F = r − u p − v q; each as a pair of points
/// whose difference it is.
[[nodiscard]] constexpr std::array<std::array<std::size_t, 2>, 3> affine_vectors(ContactKind kind) {
  if (kind == ContactKind::edge_edge) return {{{0, 2}, {0, 1}, {3, 2}}};
  return {{{0, 1}, {2, 1}, {3, 1}}};
}

/// Norm of a distance: the greatest absolute component of the difference (linf), or the Euclidean
/// norm (l2).
enum class Norm : std::uint8_t { linf, l2 };

/// Minimum separation. A query *collides at distance d* iff ‖F(t,u,v)‖ ≤ d for some t ∈ [0,1]
/// and (u,v) in the closed domain; its time of impact is the smallest such t. With d = 0 this is
/// the collision above, in either norm. ([wang2021], section 5: "minimum separation", in L∞.)
///
/// The default norm is l2, here and wherever none is named: in C++, C, Python and commands.
struct Separation {
  double distance = 0.0;  ///< d, finite and not negative, in units of the coordinates
  Norm norm = Norm::l2;

  friend bool operator==(const Separation&, const Separation&) = default;
};

/// True if the distance is 0, so that the norm does not matter. The bits decide, because a
/// floating-point environment may treat a subnormal distance as 0.
[[nodiscard]] inline bool is_zero(const Separation& separation) {
  return std::bit_cast<std::uint64_t>(separation.distance) << 1U == 0;
}

/// True if the distance is finite and not negative. The bits decide, as for is_finite.
[[nodiscard]] inline bool is_valid(const Separation& separation) {
  return std::bit_cast<std::uint64_t>(separation.distance) < infinity_bits || is_zero(separation);
}

/// "linf" or "l2".
[[nodiscard]] inline std::string_view to_string(Norm norm) {
  return norm == Norm::linf ? "linf" : "l2";
}

/// The inverse of to_string.
/// \throws std::invalid_argument for any other text.
[[nodiscard]] inline Norm norm_from_string(std::string_view text) {
  if (text == to_string(Norm::linf)) return Norm::linf;
  if (text == to_string(Norm::l2)) return Norm::l2;
  throw std::invalid_argument("norm must be linf or l2");
}

/// "vertex-face", "edge-edge", "vertex-edge" or "vertex-vertex", as data sets and the command line
/// spell them.
[[nodiscard]] constexpr std::string_view to_string(ContactKind kind) {
  switch (kind) {
    case ContactKind::vertex_face:
      return "vertex-face";
    case ContactKind::edge_edge:
      return "edge-edge";
    case ContactKind::vertex_edge:
      return "vertex-edge";
    default:
      return "vertex-vertex";
  }
}

}  // namespace touchstone
