#pragma once

/// \file
/// The kernel as a template on the type of eight lanes; each box_kernel_*.cpp instantiates it for
/// one instruction set.
///
/// The eight lanes are two halves of four: the lower for t0, the upper for t1. In a half the lanes
/// are first the four points, then, for edge_edge, the points at (u0, u1) of the one edge and at
/// (v0, v1) of the other, and at last the corners in the order (u,v) = 00, 01, 10, 11. So no value
/// is computed twice, and lanes move within their half only.
///
/// `Lanes` has: twice(a, b, c, d) and twice(pointer) — the same four in both halves; halves(a, b) —
/// all of a half equal; eight(pointer); +, −, *; shuffled<a,b,c,d>() within halves; store(pointer);
/// are_finite(); and least(), greatest() of eight finite values. Such a type, and with it every
/// instance of these templates, must be local to its file: code for one instruction set may not be
/// what another file links.

#include "fast/tight_inclusion/box_kernel.hpp"
#include "filters/expressions.hpp"

namespace touchstone::fast {

/// The kernel's functions on `Lanes`.
template <class Lanes>
struct BoxKernelOnLanes {
  /// The weights of a box: the time's, and those of (u,v) in the layout of the kind.
  struct BoxWeights {
    Lanes early, late;
    Lanes first, second, third;
  };

  static BoxWeights edge_edge_weights(const Box& box) {
    return {Lanes::halves(1.0 - box.t0, 1.0 - box.t1), Lanes::halves(box.t0, box.t1),
            Lanes::twice(1.0 - box.u0, 1.0 - box.u1, 1.0 - box.v0, 1.0 - box.v1),
            Lanes::twice(box.u0, box.u1, box.v0, box.v1), Lanes::halves(0.0, 0.0)};
  }

  static BoxWeights vertex_face_weights(const Box& box) {
    const double w0 = 1.0 - box.u0, w1 = 1.0 - box.u1;
    return {Lanes::halves(1.0 - box.t0, 1.0 - box.t1), Lanes::halves(box.t0, box.t1),
            Lanes::twice(w0 - box.v0, w0 - box.v1, w1 - box.v0, w1 - box.v1),
            Lanes::twice(box.u0, box.u0, box.u1, box.u1),
            Lanes::twice(box.v0, box.v1, box.v0, box.v1)};
  }

  static Lanes points_at_times(const std::array<double, query_points>& x, const BoxWeights& w) {
    return filters::blend(Lanes::twice(&x[0]), Lanes::twice(&x[4]), w.early, w.late);
  }

  /// filters::EdgeEdge on lanes.
  static Lanes edge_edge_corners(const std::array<double, query_points>& x, const BoxWeights& w) {
    const Lanes points = points_at_times(x, w);
    const Lanes on_edges =
        filters::blend(points.template shuffled<0, 0, 2, 2>(),
                       points.template shuffled<1, 1, 3, 3>(), w.first, w.second);
    return on_edges.template shuffled<0, 0, 1, 1>() - on_edges.template shuffled<2, 3, 2, 3>();
  }

  /// filters::VertexFace on lanes.
  static Lanes vertex_face_corners(const std::array<double, query_points>& x, const BoxWeights& w) {
    const Lanes points = points_at_times(x, w);
    return points.template shuffled<0, 0, 0, 0>() -
           filters::blend(points.template shuffled<1, 1, 1, 1>(),
                          points.template shuffled<2, 2, 2, 2>(),
                          points.template shuffled<3, 3, 3, 3>(), w.first, w.second, w.third);
  }

  template <class CornersOnAxis>
  static BoxTest test_axes(const BoxProblem& problem, const CornersOnAxis& corners_on_axis) {
    BoxTest result{.rejected = false, .inside = true, .width = 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Lanes values = corners_on_axis(problem.coordinates[axis]);
      const double least = values.least(), greatest = values.greatest();
      const double filter = problem.filter[axis], d = problem.separation;
      // Rounding is monotone: these are the extremes of F − d and F + d over the corners too.
      if (least - d > filter || greatest + d < -filter) return {true, false, 0.0};
      result.inside = result.inside && greatest - d <= filter && least + d >= -filter;
      const double width = greatest - least;
      if (width > result.width) result.width = width;
    }
    return result;
  }

  static BoxTest test(const BoxProblem& problem, const Box& box) {
    if (problem.kind == Kind::edge_edge) {
      const BoxWeights w = edge_edge_weights(box);
      return test_axes(problem, [&](const auto& x) { return edge_edge_corners(x, w); });
    }
    const BoxWeights w = vertex_face_weights(box);
    return test_axes(problem, [&](const auto& x) { return vertex_face_corners(x, w); });
  }

  static CornerValues corners(const BoxProblem& problem, const Box& box, std::size_t axis) {
    CornerValues values;
    const auto& x = problem.coordinates[axis];
    const Lanes lanes = problem.kind == Kind::edge_edge
                            ? edge_edge_corners(x, edge_edge_weights(box))
                            : vertex_face_corners(x, vertex_face_weights(box));
    lanes.store(values.data());
    return values;
  }

  static Extent load(const Query& query, BoxProblem& problem) {
    Extent extent{.x_max = {}, .finite = true};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto& row = problem.coordinates[axis];
      for (std::size_t point = 0; point < query_points; ++point) {
        row[point] = query.coordinates[3 * point + axis];
      }
      const Lanes x = Lanes::eight(row.data());
      extent.finite = extent.finite && x.are_finite();
      const double least = x.least(), greatest = x.greatest();
      extent.x_max[axis] = greatest > -least ? greatest : -least;
    }
    return extent;
  }

  static constexpr BoxKernel kernel(InstructionSet instructions) {
    return {.instructions = instructions, .load = load, .test = test, .corners = corners};
  }
};

}  // namespace touchstone::fast
