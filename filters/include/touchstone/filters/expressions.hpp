#pragma once

/// \file
/// All floating-point expressions that the project filters, as templates on the scalar.
///
/// The same source runs in double, float and SIMD lanes, is evaluated in rationals and intervals by
/// tests, is recorded by the derivation of its error bound, and is printed as a Gappa script.
/// Therefore bound and code always have the same order of operations.
///
/// An expression is a struct with a static `evaluate` over two kinds of input:
/// - `Coordinates`: floating-point numbers of magnitude up to x_max; the bound is in terms of it;
/// - `Weights`: exact dyadic numbers of magnitude up to 1, in groups. A group is a point of a
///   polygon or segment in barycentric coordinates, such as (1−t, t) for t ∈ [0,1].
/// It uses +, − and * only, and no product of two terms that hold weights of one group.
///
/// Points move as (1−t) x(0) + t x(1) and are blended with weights that sum to one, in this order
/// of operations, because every step is a convex combination and no intermediate value exceeds the
/// coordinates. That makes the bounds four times smaller than those of the usual x(0) + t (x(1) −
/// x(0)), and the values at t=0 and t=1 exact.

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "touchstone/filters/strict_arithmetic.hpp"

namespace touchstone::filters {

// ---- Steps of the expressions, which SIMD code applies to whole lanes ---------------------------

/// (a, b) with weights that sum to one.
template <class Scalar>
[[nodiscard]] constexpr Scalar blend(const Scalar& a, const Scalar& b, const Scalar& weight_a,
                                     const Scalar& weight_b) {
  return a * weight_a + b * weight_b;
}

/// (a, b, c) with weights that sum to one.
template <class Scalar>
[[nodiscard]] constexpr Scalar blend(const Scalar& a, const Scalar& b, const Scalar& c,
                                     const Scalar& weight_a, const Scalar& weight_b,
                                     const Scalar& weight_c) {
  return blend(a, b, weight_a, weight_b) + c * weight_c;
}

/// (a, b) as a + (b − a) weight_b: exact where the weight is 0, but not where it is 1.
template <class Scalar>
[[nodiscard]] constexpr Scalar blend_from_first(const Scalar& a, const Scalar& b,
                                                const Scalar& weight_b) {
  return (b - a) * weight_b + a;
}

/// (a, b, c) likewise.
template <class Scalar>
[[nodiscard]] constexpr Scalar blend_from_first(const Scalar& a, const Scalar& b, const Scalar& c,
                                                const Scalar& weight_b, const Scalar& weight_c) {
  return (b - a) * weight_b + (c - a) * weight_c + a;
}

// ---- Groups of weights --------------------------------------------------------------------------

/// The vertices of a group's polygon, each with its weights.
template <std::size_t vertices, std::size_t weights>
using Group = std::array<std::array<int, weights>, vertices>;

/// (1−x, x) for x ∈ [0,1].
inline constexpr Group<2, 2> unit_segment{{{1, 0}, {0, 1}}};

/// (1−u−v, u, v) for (u,v) ∈ [0,1]²: the boxes of a subdivision reach beyond the triangle.
inline constexpr Group<4, 3> unit_square{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 1, 1}}};

/// The inputs of an expression: so many coordinates, and the weights of these groups.
template <std::size_t count, auto... groups>
struct ExpressionInputs {
  static constexpr std::size_t coordinates = count;
  static constexpr std::size_t weights = (std::size_t{0} + ... + groups.front().size());

  template <class Visitor>
  static constexpr void visit_groups([[maybe_unused]] const Visitor& visit) {
    (visit(groups), ...);
  }
};

// ---- The position of a point at a time ----------------------------------------------------------

/// One coordinate of a moving point. Coordinates: at t=0 and at t=1. Weights: (1−t, t).
struct Position : ExpressionInputs<2, unit_segment> {
  static constexpr std::string_view name = "position";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return blend(x[0], x[1], w[0], w[1]);
  }
};

// ---- One axis of F (touchstone/query.hpp) in the order of the solvers of fast/ -----------------------

/// F of edge_edge on one axis. Coordinates: ea0, ea1, eb0, eb1 at t=0, then at t=1. Weights:
/// (1−t, t), (1−u, u), (1−v, v).
struct EdgeEdge : ExpressionInputs<8, unit_segment, unit_segment, unit_segment> {
  static constexpr std::string_view name = "edge_edge";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend(x[i], x[4 + i], w[0], w[1]); };
    return blend(at_time(0), at_time(1), w[2], w[3]) - blend(at_time(2), at_time(3), w[4], w[5]);
  }
};

/// F of vertex_face on one axis. Coordinates: v, f0, f1, f2 at t=0, then at t=1. Weights: (1−t, t),
/// (1−u−v, u, v).
struct VertexFace : ExpressionInputs<8, unit_segment, unit_square> {
  static constexpr std::string_view name = "vertex_face";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend(x[i], x[4 + i], w[0], w[1]); };
    return at_time(0) - blend(at_time(1), at_time(2), at_time(3), w[2], w[3], w[4]);
  }
};

// ---- The same in the order of operations of the public Tight-Inclusion -------------------------

/// F of edge_edge on one axis as the public Tight-Inclusion computes it, relative to the first
/// point. Inputs as EdgeEdge.
struct ReleasedEdgeEdge : EdgeEdge {
  static constexpr std::string_view name = "released_edge_edge";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend_from_first(x[i], x[4 + i], w[1]); };
    return blend_from_first(at_time(0), at_time(1), w[3]) -
           blend_from_first(at_time(2), at_time(3), w[5]);
  }
};

/// F of vertex_face likewise. Inputs as VertexFace.
struct ReleasedVertexFace : VertexFace {
  static constexpr std::string_view name = "released_vertex_face";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend_from_first(x[i], x[4 + i], w[1]); };
    return at_time(0) - blend_from_first(at_time(1), at_time(2), at_time(3), w[3], w[4]);
  }
};

// ---- The same in the order of operations of [wang2021] (docs/theory.md, section 4.10) ----------

/// F of edge_edge on one axis in the paper's order. Inputs as EdgeEdge.
struct PaperEdgeEdge : EdgeEdge {
  static constexpr std::string_view name = "paper_edge_edge";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend(x[i], x[4 + i], w[0], w[1]); };
    const Scalar ea0 = at_time(0), eb0 = at_time(2);
    return ((at_time(1) - ea0) * w[3] + ea0) - ((at_time(3) - eb0) * w[5] + eb0);
  }
};

/// F of vertex_face on one axis in the paper's order. Inputs as VertexFace.
struct PaperVertexFace : VertexFace {
  static constexpr std::string_view name = "paper_vertex_face";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend(x[i], x[4 + i], w[0], w[1]); };
    const Scalar f0 = at_time(1);
    const Scalar on_edge = (at_time(2) - f0) * w[3] + f0;
    return at_time(0) - (on_edge + (at_time(3) - f0) * w[4]);
  }
};

// ---- One axis of F on Bézier curves -------------------------------------------------------------

/// A coordinate of a Bézier curve by its blossom: its control values b_0 … b_degree, from `first`
/// on in steps of `stride`, blended with the weights (1−s, s) of each level. With all s = t it is
/// the position at t; with k of them t1 and the others t0, control value k of the piece [t0,t1].
template <std::size_t degree, std::size_t stride, class Scalar, std::size_t coordinates,
          std::size_t weights>
[[nodiscard]] constexpr Scalar blossom(const std::array<Scalar, coordinates>& x,
                                       const std::array<Scalar, weights>& w, std::size_t first) {
  if constexpr (degree == 0) {
    return x[first];
  } else {
    return blend(blossom<degree - 1, stride>(x, w, first),
                 blossom<degree - 1, stride>(x, w, first + stride), w[2 * degree - 2],
                 w[2 * degree - 1]);
  }
}

/// The same for the four points of a query, whose control values alternate.
template <std::size_t degree, class Scalar, std::size_t coordinates, std::size_t weights>
[[nodiscard]] constexpr std::array<Scalar, 4> points_on_curves(
    const std::array<Scalar, coordinates>& x, const std::array<Scalar, weights>& w) {
  return {blossom<degree, 4>(x, w, 0), blossom<degree, 4>(x, w, 1), blossom<degree, 4>(x, w, 2),
          blossom<degree, 4>(x, w, 3)};
}

/// F of edge_edge on one axis. Coordinates: ea0, ea1, eb0, eb1 for each control point. Weights:
/// (1−s, s) of each level, (1−u, u), (1−v, v).
template <std::size_t degree>
struct CurvedEdgeEdge {
  static constexpr std::size_t coordinates = 4 * (degree + 1);
  static constexpr std::size_t weights = 2 * degree + 4;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    for (std::size_t i = 0; i < degree + 2; ++i) visit(unit_segment);
  }

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return from_points<Scalar>(
        points_on_curves<degree>(x, w),
        {w[2 * degree], w[2 * degree + 1], w[2 * degree + 2], w[2 * degree + 3]});
  }

  /// F from the four points at the time. Weights: (1−u, u), (1−v, v).
  template <class Scalar>
  [[nodiscard]] static constexpr Scalar from_points(const std::array<Scalar, 4>& p,
                                                    const std::array<Scalar, 4>& w) {
    return blend(p[0], p[1], w[0], w[1]) - blend(p[2], p[3], w[2], w[3]);
  }
};

/// F of vertex_face likewise. Coordinates: v, f0, f1, f2 for each control point. Weights: (1−s, s)
/// of each level, (1−u−v, u, v).
template <std::size_t degree>
struct CurvedVertexFace {
  static constexpr std::size_t coordinates = 4 * (degree + 1);
  static constexpr std::size_t weights = 2 * degree + 3;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    for (std::size_t i = 0; i < degree; ++i) visit(unit_segment);
    visit(unit_square);
  }

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return from_points<Scalar>(points_on_curves<degree>(x, w),
                               {w[2 * degree], w[2 * degree + 1], w[2 * degree + 2]});
  }

  /// F from the four points at the time. Weights: (1−u−v, u, v).
  template <class Scalar>
  [[nodiscard]] static constexpr Scalar from_points(const std::array<Scalar, 4>& p,
                                                    const std::array<Scalar, 3>& w) {
    return p[0] - blend(p[1], p[2], p[3], w[0], w[1], w[2]);
  }
};

// ---- With a minimum separation ------------------------------------------------------------------

/// F − d; F + d is its mirror image. The additional last coordinate is the separation d.
template <class Expression>
struct Separated {
  static constexpr std::size_t coordinates = Expression::coordinates + 1;
  static constexpr std::size_t weights = Expression::weights;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    Expression::visit_groups(visit);
  }

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return evaluate_points(x, w, std::make_index_sequence<Expression::coordinates>()) - x.back();
  }

 private:
  template <class Scalar, std::size_t... index>
  static constexpr Scalar evaluate_points(const std::array<Scalar, coordinates>& x,
                                          const std::array<Scalar, weights>& w,
                                          std::index_sequence<index...> /*points*/) {
    return Expression::evaluate(std::array<Scalar, Expression::coordinates>{x[index]...}, w);
  }
};

struct EdgeEdgeSeparated : Separated<EdgeEdge> {
  static constexpr std::string_view name = "edge_edge_separated";
};
struct VertexFaceSeparated : Separated<VertexFace> {
  static constexpr std::string_view name = "vertex_face_separated";
};
struct PaperEdgeEdgeSeparated : Separated<PaperEdgeEdge> {
  static constexpr std::string_view name = "paper_edge_edge_separated";
};
struct PaperVertexFaceSeparated : Separated<PaperVertexFace> {
  static constexpr std::string_view name = "paper_vertex_face_separated";
};

struct QuadraticEdgeEdgeSeparated : Separated<CurvedEdgeEdge<2>> {
  static constexpr std::string_view name = "quadratic_edge_edge_separated";
};
struct QuadraticVertexFaceSeparated : Separated<CurvedVertexFace<2>> {
  static constexpr std::string_view name = "quadratic_vertex_face_separated";
};
struct CubicEdgeEdgeSeparated : Separated<CurvedEdgeEdge<3>> {
  static constexpr std::string_view name = "cubic_edge_edge_separated";
};
struct CubicVertexFaceSeparated : Separated<CurvedVertexFace<3>> {
  static constexpr std::string_view name = "cubic_vertex_face_separated";
};

}  // namespace touchstone::filters
