#pragma once

/// \file
/// The certified solver for two primitives given by their points, as simulators call it.
///
/// Each function takes the points at t=0 and then, in the same order, at t=1. They move on straight
/// lines in between. A point is any vector of three floats or doubles (`Point`); floats are
/// converted to double exactly. An edge or a point takes the place of a face as a triangle without
/// an area: solve_vertex_edge uses (e0, e1, e0), solve_vertex_vertex (p1, p1, p1). The functions
/// are thread-safe.

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <stdexcept>

#include "touchstone/certified.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// Three coordinates, from an Eigen vector (or a row or column of a matrix) or from a pointer to x,
/// of floats or doubles. For use as a parameter.
struct Point {
  /// \throws std::invalid_argument unless there are three coefficients.
  template <class Derived>
  Point(const Eigen::DenseBase<Derived>& vector) {  // NOLINT(google-explicit-constructor)
    static_assert(Derived::SizeAtCompileTime == 3 || Derived::SizeAtCompileTime == Eigen::Dynamic,
                  "a point has three coordinates");
    if (vector.size() != 3) throw std::invalid_argument("a point must have three coordinates");
    const auto values = vector.derived().eval();
    for (std::size_t i = 0; i < 3; ++i) {
      coordinates[i] = to_double(values.coeff(static_cast<Eigen::Index>(i)));
    }
  }
  Point(const double* x) : coordinates{x[0], x[1], x[2]} {}  // NOLINT(google-explicit-constructor)
  Point(const float* x)                                      // NOLINT(google-explicit-constructor)
      : coordinates{to_double(x[0]), to_double(x[1]), to_double(x[2])} {}

  std::array<double, 3> coordinates;
};

/// Solves a point and a triangle. With yes, (u, v) is the point t0 + u (t1 − t0) + v (t2 − t0).
/// \throws std::invalid_argument for options out of range, as the other functions do.
[[nodiscard]] CertifiedResult solve_vertex_face(const Point& p_t0, const Point& t0_t0,
                                                const Point& t1_t0, const Point& t2_t0,
                                                const Point& p_t1, const Point& t0_t1,
                                                const Point& t1_t1, const Point& t2_t1,
                                                const CertifiedOptions& options = {});

/// Solves two edges. With yes, u is the parameter on the first one, from its first point, and v on
/// the second.
[[nodiscard]] CertifiedResult solve_edge_edge(const Point& ea0_t0, const Point& ea1_t0,
                                              const Point& eb0_t0, const Point& eb1_t0,
                                              const Point& ea0_t1, const Point& ea1_t1,
                                              const Point& eb0_t1, const Point& eb1_t1,
                                              const CertifiedOptions& options = {});

/// Solves a point and an edge. With yes, u is the parameter on the edge, and v is 0.
[[nodiscard]] CertifiedResult solve_vertex_edge(const Point& p_t0, const Point& e0_t0,
                                                const Point& e1_t0, const Point& p_t1,
                                                const Point& e0_t1, const Point& e1_t1,
                                                const CertifiedOptions& options = {});

/// Solves two points. With yes, u and v are 0.
[[nodiscard]] CertifiedResult solve_vertex_vertex(const Point& p0_t0, const Point& p1_t0,
                                                  const Point& p0_t1, const Point& p1_t1,
                                                  const CertifiedOptions& options = {});

}  // namespace touchstone::fast
