#pragma once

/// \file
/// A moving mesh in the form that simulators use: the motion of its vertices in a step, edges and
/// faces as indices, and pairs of these. Pairs take an eighth of the memory of queries, and the
/// vertices stay in the cache. The functions are thread-safe, and so are const member functions.

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "touchstone/cell.hpp"
#include "touchstone/query.hpp"

namespace touchstone {

/// Point `point` (0..3) of a query at time `end` (0 or 1), as a vector that refers to the query's
/// memory.
[[nodiscard]] inline Eigen::Map<const Eigen::Vector3d> point_of(const Query& query, std::size_t end,
                                                                std::size_t point) {
  return Eigen::Map<const Eigen::Vector3d>(&query.coordinates[Query::index(end, point, 0)]);
}
[[nodiscard]] inline Eigen::Map<Eigen::Vector3d> point_of(Query& query, std::size_t end,
                                                          std::size_t point) {
  return Eigen::Map<Eigen::Vector3d>(&query.coordinates[Query::index(end, point, 0)]);
}

namespace fast {

/// The two vertices of an edge.
using Edge = std::array<std::int32_t, 2>;
/// The three vertices of a face.
using Face = std::array<std::int32_t, 3>;
/// The four vertices of a tetrahedron, in the order of touchstone/cell.hpp.
using Tetrahedron = std::array<std::int32_t, 4>;
/// The two indices of a pair. vertex_face: a vertex and a face; edge_edge: two edges.
using IndexPair = std::array<std::int32_t, 2>;

/// Elements from a matrix of integers, such as int32 or int64, in any storage order: tetrahedra
/// from n×4, faces from n×3, edges from n×2. An empty matrix of any shape has none.
/// \tparam Element Tetrahedron, Face or Edge
/// \throws std::invalid_argument for another number of columns; std::out_of_range naming the first
/// row with a number that is negative or above 2^31−1.
template <class Element, class Matrix>
[[nodiscard]] std::vector<Element> elements_from(const Eigen::DenseBase<Matrix>& matrix) {
  constexpr std::size_t count = std::tuple_size_v<Element>;
  if (matrix.size() == 0) return {};
  if (static_cast<std::size_t>(matrix.cols()) != count) {
    throw std::invalid_argument("elements: the matrix must have " + std::to_string(count) +
                                " columns");
  }
  const auto& values = matrix.derived().eval();
  std::vector<Element> result(static_cast<std::size_t>(values.rows()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto vertex = values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      if (std::cmp_less(vertex, 0) || !std::in_range<std::int32_t>(vertex)) {
        throw std::out_of_range("element " + std::to_string(i) + ": vertex " +
                                std::to_string(vertex) + " is not in [0, 2^31-1]");
      }
      result[i][k] = static_cast<std::int32_t>(vertex);
    }
  }
  return result;
}

/// The positions of a vertex at t=0 and t=1, in one cache line; of one on a curve, the least and
/// the greatest coordinates of its control points.
struct alignas(64) MovingVertex {
  std::array<double, 4> start;  ///< x, y, z and 0
  std::array<double, 4> end;    ///< x, y, z and 0
};

/// The motion of the vertices of a step: on straight lines, or all on Bézier curves of one degree
/// (touchstone/query.hpp).
class Motion {
 public:
  /// On straight lines. Copies two matrices of float or double in any storage order, a row for each
  /// vertex. This takes about as long as reading an equal number of candidates. \throws
  /// std::invalid_argument unless both are n×3.
  template <class Start, class End>
  Motion(const Eigen::MatrixBase<Start>& start, const Eigen::MatrixBase<End>& end)
      : vertices_(static_cast<std::size_t>(start.rows())) {
    if (start.cols() != 3 || end.cols() != 3 || start.rows() != end.rows()) {
      throw std::invalid_argument(
          "vertices: both matrices must have three columns and as many rows");
    }
    for (Eigen::Index i = 0; i < start.rows(); ++i) {
      MovingVertex& vertex = vertices_[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k < 3; ++k) {
        vertex.start[static_cast<std::size_t>(k)] = to_double(start(i, k));
        vertex.end[static_cast<std::size_t>(k)] = to_double(end(i, k));
      }
    }
  }

  /// The same from x, y, z of each vertex in turn, float or double.
  template <class Scalar>
  Motion(std::span<const Scalar> start, std::span<const Scalar> end)
      : Motion(rows(start), rows(end)) {}

  /// On curves, by their control points from t=0 to t=1: an array of shape (n, degree + 1, 3), or
  /// of rational curves (n, degree + 1, 4) with positive weights last. Those of degree 1 without
  /// weights are straight lines.
  /// \throws std::invalid_argument as require_degree, and unless they are those of whole vertices.
  Motion(std::size_t degree, bool is_rational, std::vector<double> control_points);

  [[nodiscard]] bool is_straight() const { return shape_.is_straight(); }
  /// The degree, and whether there are weights.
  [[nodiscard]] const QueryShape& shape() const { return shape_; }
  /// The control points of vertex i. \pre !is_straight()
  [[nodiscard]] std::span<const double> control_points(std::size_t i) const {
    const std::size_t size = shape_.numbers_of_query() / moving_points;
    return std::span(control_points_).subspan(i * size, size);
  }

  [[nodiscard]] std::size_t size() const { return vertices_.size(); }
  [[nodiscard]] const MovingVertex& operator[](std::size_t i) const { return vertices_[i]; }
  [[nodiscard]] const MovingVertex* data() const { return vertices_.data(); }

 private:
  template <class Scalar>
  static auto rows(std::span<const Scalar> coordinates) {
    if (coordinates.size() % 3 != 0) {
      throw std::invalid_argument("vertices: each must have three coordinates");
    }
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(coordinates.data(),
                                  static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  }

  QueryShape shape_ = {};
  std::vector<MovingVertex> vertices_;
  std::vector<double> control_points_;  ///< none of straight lines
};

/// The elements of a scene, by vertex numbers. A vertex that no element names is not part of the
/// scene.
struct Mesh {
  /// All edges: those of the faces and codimensional ones. By default the edges of the faces,
  /// numbered as by edges_of (touchstone/broad_phase.hpp). An edge from a vertex to itself collides
  /// like the vertex.
  std::vector<Edge> edges = {};
  std::vector<Face> faces = {};
  /// Vertices that are part of the scene in any case, with or without an edge or a face.
  std::vector<std::int32_t> points = {};
  /// Cells, whose volume is to stay positive. They do not collide, and intersections at rest do not
  /// depend on them; nor are their vertices part of the scene by this.
  std::vector<Tetrahedron> tetrahedra = {};
  /// Cells whose area in the plane of x and y is to stay positive, likewise; the vertices' third
  /// coordinates have no effect on it.
  std::vector<Face> plane_triangles = {};

 private:
  /// The result of visit(cells) of a kind.
  template <class Self, class Visit>
  static auto on_cells(Self& self, CellKind kind, const Visit& visit) {
    switch (kind) {
      case CellKind::tetrahedron:
        return visit(self.tetrahedra);
      case CellKind::plane_triangle:
        return visit(self.plane_triangles);
    }
    throw std::invalid_argument("mesh: there is no such kind of cells");
  }

 public:
  /// The vertices of all cells of a kind, one cell after the other, and the number of these cells.
  [[nodiscard]] std::span<const std::int32_t> corners_of(CellKind kind) const {
    return on_cells(*this, kind, [](const auto& cells) -> std::span<const std::int32_t> {
      if (cells.empty()) return {};
      return {cells.front().data(), cells.size() * cells.front().size()};
    });
  }
  [[nodiscard]] std::size_t count_of(CellKind kind) const {
    return corners_of(kind).size() / record_of(kind).point_count;
  }
  /// Appends cells, by their vertices as above.
  void add_cells(CellKind kind, std::span<const std::int32_t> corners) {
    on_cells(*this, kind, [&](auto& cells) {
      const std::size_t count = record_of(kind).point_count;
      for (std::size_t i = 0; i + count <= corners.size(); i += count) {
        std::ranges::copy(corners.subspan(i, count), cells.emplace_back().begin());
      }
    });
  }
};

/// Two groups, in either order, which may be the same, and the thickness of their pairs.
struct GroupSeparation {
  std::array<std::int32_t, 2> groups{};
  double distance = 0.0;  ///< in [0, 2^1000], in units of the coordinates

  friend bool operator==(const GroupSeparation&, const GroupSeparation&) = default;
};

/// Rules for the pairs that can collide: two primitives can if a vertex of one and a vertex of the
/// other are in groups that can collide. By default everything collides with everything. And the
/// thickness of pairs (touchstone/step.hpp), by default 0; intersections of a mesh at rest do not
/// depend on it.
struct CollisionGroups {
  /// The group of each vertex, from 0 on; empty: all are in group 0.
  std::vector<std::int32_t> of_vertices = {};
  /// Pairs of groups that cannot collide, in either order, each the group of a vertex. The same
  /// group twice: no collisions within it, for example within an obstacle. All other pairs can
  /// collide.
  std::vector<std::array<std::int32_t, 2>> apart = {};
  /// The radius of each group, from 0 on, up to the greatest group of a vertex or further; not
  /// negative, in units of the coordinates. Empty: all are 0. No sum is above 2^1000.
  std::vector<double> radii = {};
  /// Pairs of groups whose distance is in place of the sum of their radii, each once, and each the
  /// group of a vertex.
  std::vector<GroupSeparation> separations = {};
};

}  // namespace fast
}  // namespace touchstone
