#pragma once

/// \file
/// The kernel as a template on the type of eight lanes; each box_kernel_*.cpp instantiates it for
/// one instruction set.
///
/// The eight lanes are two halves of four: the lower for t0, the upper for t1. In a half the lanes
/// are first the four points, then, for edge_edge, the points at (u0, u1) of the one edge and at
/// (v0, v1) of the other, and at last the corners in the order (u,v) = 00, 01, 10, 11. Thus no
/// value is computed twice, and lanes move only within their half.
///
/// `Lanes` has: twice(a, b, c, d) and twice(pointer) — the same four in both halves; halves(a, b) —
/// all of a half equal; coordinate<axis>(pointer) — of eight points; +, −, *; shuffled<a,b,c,d>()
/// within halves; store(pointer); are_finite(); magnitude(), the greatest of eight finite values;
/// bounds(x, y, z), the bounding box of corner values; and `digits`, those of its arithmetic. Its
/// functions take and give doubles; lanes of float round them. Such a type, and hence every
/// instance of these templates, must be local to its file, so that no other file links code for its
/// instruction set.

#include "fast/tight_inclusion/box_kernel.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast {

/// The steps of filters::EdgeEdge and filters::VertexFace.
struct ConvexSteps {
  template <class Lanes>
  static Lanes blend(const Lanes& a, const Lanes& b, const Lanes& weight_a, const Lanes& weight_b) {
    return filters::blend(a, b, weight_a, weight_b);
  }
  template <class Lanes>
  static Lanes blend(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& weight_a,
                     const Lanes& weight_b, const Lanes& weight_c) {
    return filters::blend(a, b, c, weight_a, weight_b, weight_c);
  }
};

/// The kernel's functions on `Lanes`, in the order of operations of `Steps`.
template <class Lanes, class Steps = ConvexSteps>
struct BoxKernelOnLanes {
  /// The weights of a box: of the time, and of (u,v) in the layout of the kind; edge_edge has no
  /// third one.
  struct BoxWeights {
    Lanes early, late;
    Lanes first, second, third;
  };

  // Built from scalars instead of a vector load, because the ends of the box were just written one
  // by one.
  static BoxWeights edge_edge_weights(const Box& box) {
    const auto [t0, t1, u0, u1, v0, v1] = box.ends;
    return {Lanes::halves(1.0 - t0, 1.0 - t1), Lanes::halves(t0, t1),
            Lanes::twice(1.0 - u0, 1.0 - u1, 1.0 - v0, 1.0 - v1), Lanes::twice(u0, u1, v0, v1),
            Lanes::halves(0.0, 0.0)};
  }

  static BoxWeights vertex_face_weights(const Box& box) {
    const auto [t0, t1, u0, u1, v0, v1] = box.ends;
    const double w0 = 1.0 - u0, w1 = 1.0 - u1;
    return {Lanes::halves(1.0 - t0, 1.0 - t1), Lanes::halves(t0, t1),
            Lanes::twice(w0 - v0, w0 - v1, w1 - v0, w1 - v1), Lanes::twice(u0, u0, u1, u1),
            Lanes::twice(v0, v1, v0, v1)};
  }

  static Lanes points_at_times(const std::array<double, query_points>& x, const BoxWeights& w) {
    return Steps::blend(Lanes::twice(x.data()), Lanes::twice(x.data() + 4), w.early, w.late);
  }

  /// filters::EdgeEdge on lanes.
  static Lanes edge_edge_corners(const std::array<double, query_points>& x, const BoxWeights& w) {
    const Lanes points = points_at_times(x, w);
    const Lanes on_edges = Steps::blend(points.template shuffled<0, 0, 2, 2>(),
                                        points.template shuffled<1, 1, 3, 3>(), w.first, w.second);
    return on_edges.template shuffled<0, 0, 1, 1>() - on_edges.template shuffled<2, 3, 2, 3>();
  }

  /// filters::VertexFace on lanes.
  static Lanes vertex_face_corners(const std::array<double, query_points>& x, const BoxWeights& w) {
    const Lanes points = points_at_times(x, w);
    return points.template shuffled<0, 0, 0, 0>() -
           Steps::blend(points.template shuffled<1, 1, 1, 1>(),
                        points.template shuffled<2, 2, 2, 2>(),
                        points.template shuffled<3, 3, 3, 3>(), w.first, w.second, w.third);
  }

  template <class CornersOnAxis>
  static BoxTest test_axes(const BoxProblem& problem, const CornersOnAxis& corners_on_axis) {
    const auto& x = problem.coordinates;
    const auto bounds =
        Lanes::bounds(corners_on_axis(x[0]), corners_on_axis(x[1]), corners_on_axis(x[2]));
    // Rounding is monotone: the bounds ∓ d are the extremes of F ∓ d over the corners too.
    if (bounds.are_beyond(problem.filter.data(), problem.separation)) return {true, false, 0.0};
    return {.rejected = false,
            .inside = bounds.are_within(problem.filter.data(), problem.separation),
            .width = bounds.width()};
  }

  static BoxTest test(const BoxProblem& problem, const Box& box) {
    if (problem.kind == ContactKind::edge_edge) {
      const BoxWeights w = edge_edge_weights(box);
      return test_axes(problem, [&](const auto& x) { return edge_edge_corners(x, w); });
    }
    const BoxWeights w = vertex_face_weights(box);
    return test_axes(problem, [&](const auto& x) { return vertex_face_corners(x, w); });
  }

  static CornerValues corners(const BoxProblem& problem, const Box& box, std::size_t axis) {
    CornerValues values;
    const auto& x = problem.coordinates[axis];
    const Lanes lanes = problem.kind == ContactKind::edge_edge
                            ? edge_edge_corners(x, edge_edge_weights(box))
                            : vertex_face_corners(x, vertex_face_weights(box));
    lanes.store(values.data());
    return values;
  }

  template <std::size_t axis>
  static void load_axis(const Query& query, BoxProblem& problem, Extent& extent) {
    const Lanes x = Lanes::template coordinate<axis>(query.coordinates.data());
    x.store(problem.coordinates[axis].data());
    extent.finite = extent.finite && x.are_finite();
    extent.x_max[axis] = x.magnitude();
  }

  static Extent load(const Query& query, BoxProblem& problem) {
    Extent extent{.x_max = {}, .finite = true};
    load_axis<0>(query, problem, extent);
    load_axis<1>(query, problem, extent);
    load_axis<2>(query, problem, extent);
    return extent;
  }

  static constexpr BoxKernel kernel(InstructionSet instructions) {
    return {.instructions = instructions,
            .digits = Lanes::digits,
            .load = load,
            .test = test,
            .corners = corners};
  }
};

}  // namespace touchstone::fast
