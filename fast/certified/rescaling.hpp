#pragma once

/// \file
/// Queries of unusual size, in the floating-point stages of the certified solver.
///
/// The error bounds of these stages hold for coordinates of usual size: products of larger ones
/// might overflow, and of smaller ones underflow. The bounds are relative to the greatest
/// coordinate of all axes. A query of unusual size that these stages cannot decide is therefore
/// scaled and decided again, before the exact stage.
///
/// **Theorem.** Let the coordinates of a query be multiplied by powers of two, one for each axis,
/// without rounding. The scaled query has its contacts at the same times, with the same (u,v). With
/// a minimum separation this holds if the factors are equal and the distance is multiplied by the
/// same factor. Proof. F is linear in the coordinates of each axis, so it is 0 at the same (t,u,v).
/// With equal factors, norms are multiplied by the factor, too. ∎

#include <span>

#include "exact/query.hpp"
#include "fast/certified/kernel.hpp"

namespace touchstone::fast {

/// Moves queries of unusual size that the kernel decides after scaling from the output's undecided
/// queries to its other lists. \param queries The undecided queries, in their order.
void decide_rescaled(const KernelInput& block, const CertifiedKernel& kernel,
                     std::span<const Query> queries, KernelOutput& output);

}  // namespace touchstone::fast
