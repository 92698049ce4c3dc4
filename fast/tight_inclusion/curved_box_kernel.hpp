#pragma once

/// \file
/// The inner loop of Tight-Inclusion for points on curves of degree 2 or 3.
///
/// On [t0,t1] a curve is in the hull of its control points there, which the blossom gives
/// (touchstone/filters/expressions.hpp), and F is affine in u and v: over a box of (t,u,v) it stays
/// within the bounding box of the values at the control points and the four corners of (u,v). All
/// values have the bits of CurvedEdgeEdge::evaluate or CurvedVertexFace::evaluate.

#include <array>
#include <cstddef>

#include "fast/tight_inclusion/box_kernel.hpp"
#include "touchstone/curved_query.hpp"

namespace touchstone::fast {

/// Its `load` and `corners` are null: see load_curves.
[[nodiscard]] const BoxKernel& curved_box_kernel();

/// Sorts the control points of query i by axis. \pre degree 2 or 3, without weights.
[[nodiscard]] Extent load_curves(const CurvedQueries& queries, std::size_t i, BoxProblem& problem);

/// The error bound of a computed value of F − d, for each axis.
/// \param x_max the greatest coordinates of each axis, at most greatest_of_curves
[[nodiscard]] std::array<double, 3> filter_of_curves(Kind kind, std::size_t degree,
                                                     const std::array<double, 3>& x_max,
                                                     double separation);

inline constexpr double greatest_of_curves = 0x1p1000;

}  // namespace touchstone::fast
