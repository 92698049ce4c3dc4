#pragma once

/// \file
/// A moving mesh in the form that simulators use: vertices at the start and at the end of a
/// step, edges and faces as indices, and pairs of these. Pairs take an eighth of the memory of
/// queries, and the vertices stay in the cache. The functions are thread-safe, and so are const
/// member functions.

#include <Eigen/Core>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

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
/// The four vertices of a tetrahedron, in the order of touchstone/element.hpp.
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

/// The positions of a vertex at t=0 and t=1, in one cache line.
struct alignas(64) MovingVertex {
  std::array<double, 4> start;  ///< x, y, z and 0
  std::array<double, 4> end;    ///< x, y, z and 0
};

/// The vertices of a step.
class MovingVertices {
 public:
  /// Copies two matrices of float or double in any storage order, a row for each vertex. This takes
  /// about as long as reading an equal number of candidates.
  /// \throws std::invalid_argument unless both are n×3.
  template <class Start, class End>
  MovingVertices(const Eigen::MatrixBase<Start>& start, const Eigen::MatrixBase<End>& end)
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

  [[nodiscard]] std::size_t size() const { return vertices_.size(); }
  [[nodiscard]] const MovingVertex& operator[](std::size_t i) const { return vertices_[i]; }
  [[nodiscard]] const MovingVertex* data() const { return vertices_.data(); }

 private:
  std::vector<MovingVertex> vertices_;
};

}  // namespace fast
}  // namespace touchstone
