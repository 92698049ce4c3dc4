#pragma once

/// \file
/// The inner loop of Tight-Inclusion for points on curves of degree 2 or 3.
///
/// On [t0,t1] a curve is in the hull of its control points there, which the blossom gives
/// (touchstone/filters/expressions.hpp), and F is affine in u and v: over a box of (t,u,v) it stays
/// within the bounding box of the values at the control points and the four corners of (u,v). All
/// values have the bits of CurvedEdgeEdge::evaluate or CurvedVertexFace::evaluate.
///
/// **Rational curves.** The control points and weights of a piece are n_k / ω_k and ω_k > 0, where
/// the blossom gives n_k and ω_k; the curve is in the hull of the n_k / ω_k. Points have
/// denominators of their own, so the ranges of their coordinates are blended, not their control
/// points: over a box, F stays between the least and the greatest of these blends at the four
/// corners of (u,v). *Errors*, with u = 2^-53, K the degree and x the greatest coordinate: n_k is a
/// sum of terms whose magnitudes add up to at most x ω_k, each with at most 2 K + 1 roundings, and
/// ω_k of positive ones with 2 K; so a quotient has an error of at most (4 K + 5) u x. F is a
/// difference of two blends with at most 14 u x more. (16 K + 64) u times the greater of x and the
/// separation exceeds all this, and 2^-1000 underflow while weights are between 2^-30 and 2^30.

#include <array>
#include <cstddef>
#include <optional>

#include "fast/tight_inclusion/box_kernel.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The kernel for curves. Its `load` and `corners` are null: see load_curves.
[[nodiscard]] const BoxKernel& curved_box_kernel();
[[nodiscard]] const BoxKernel& rational_box_kernel();

/// Sorts the control points of query i by axis. Its extent is finite if the weights are positive,
/// too. \pre degree 2 or 3
[[nodiscard]] Extent load_curves(const Queries& queries, std::size_t i, BoxProblem& problem);

/// The error bound of a computed value of F − d, for each axis.
/// \param x_max the greatest coordinates of each axis, at most greatest_of_curves
[[nodiscard]] std::array<double, 3> filter_of_curves(ContactKind kind, std::size_t degree,
                                                     const std::array<double, 3>& x_max,
                                                     double separation);

inline constexpr double greatest_of_curves = 0x1p1000;

/// The same for rational curves. Nothing if coordinates are above 2^900, or weights not between
/// 2^-30 and 2^30.
[[nodiscard]] std::optional<std::array<double, 3>> filter_of_rational_curves(
    const BoxProblem& problem, const std::array<double, 3>& x_max, double separation);

}  // namespace touchstone::fast
