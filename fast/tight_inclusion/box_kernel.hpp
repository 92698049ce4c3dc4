#pragma once

/// \file
/// The inner loop of Tight-Inclusion: F at the eight corners of a box, and the box's properties.
///
/// F is affine in each of t, u and v, so over a box it stays within the bounding box of its eight
/// corner values ([wang2021], section 4.2). Both are computed on lanes, one for each corner, with
/// the steps of touchstone/filters/expressions.hpp in their order. So a lane has the same bits as
/// EdgeEdge::evaluate or VertexFace::evaluate for every instruction set.

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "fast/platform/instruction_set.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// A query in the layout of the kernel. A kernel in single precision takes floats alone.
struct BoxProblem {
  /// The coordinates on each axis of the four points at t=0, then at t=1.
  alignas(64) std::array<std::array<double, query_points>, 3> coordinates{};
  /// The error bound on each axis of F's computed values, in units of the coordinates; the fourth
  /// number fills the vector and is infinite.
  std::array<double, 4> filter{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  double separation = 0.0;
  ContactKind kind = ContactKind::vertex_face;

  static constexpr std::size_t greatest_curve_degree = 3;
  /// The degree of curves (curved_box_kernel.hpp), and for each axis the coordinates of the four
  /// points for each control point.
  std::size_t degree = 1;
  std::array<std::array<double, moving_points*(greatest_curve_degree + 1)>, 3> control{};
  /// The weights of rational curves in the same order; `control` then has the products of
  /// coordinates and weights.
  std::array<double, moving_points*(greatest_curve_degree + 1)> curve_weights{};
};

/// A box [t0,t1] × [u0,u1] × [v0,v1]. Its ends are dyadic numbers of at most BoxKernel::digits
/// fractional bits, so that they and their complements to 1 are exact.
struct Box {
  std::array<double, 6> ends;  ///< t0, t1, u0, u1, v0, v1
};

/// Properties of a box that follow from the corner values.
struct BoxTest {
  bool rejected;  ///< F stays away from the origin by more than separation and filter, on some axis
  bool inside;    ///< not rejected, and all corners within separation and filter, on all axes
  double width;   ///< the longest side of the bounding box of the corner values, if not rejected
};

/// The greatest magnitudes of a query.
struct Extent {
  std::array<double, 3> x_max;  ///< per axis over the eight points
  bool finite;                  ///< no coordinate is infinite or NaN
};

/// Corner values on one axis, in the order of (t,u,v) as binary digits.
using CornerValues = std::array<double, 8>;

/// The functions of one instruction set. All sets give the same bits, in each precision.
struct BoxKernel {
  InstructionSet instructions;
  int digits;  ///< of its arithmetic: 53, or 24 in single precision
  /// Sorts the query's coordinates by axis, rounded to its precision. Does not change filter and
  /// separation.
  Extent (*load)(const Query& query, BoxProblem& problem);
  BoxTest (*test)(const BoxProblem& problem, const Box& box);
  /// The corner values on an axis.
  CornerValues (*corners)(const BoxProblem& problem, const Box& box, std::size_t axis);
  /// The greatest changes of F along t, u and v over the unit box; null: those of the corner
  /// values.
  std::array<double, 3> (*changes)(const BoxProblem& problem) = nullptr;
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const BoxKernel* const> box_kernels();

}  // namespace touchstone::fast
