#pragma once

/// \file
/// Queries of unusual size, in the floating-point stages of the certified solver.
///
/// The bounds of these stages hold for coordinates of a usual size: products of larger ones might
/// overflow, and of smaller ones underflow. They are relative to the greatest coordinate of all
/// axes. A query of unusual size that they cannot decide is therefore scaled and solved again,
/// before any exact work.
///
/// **Theorem.** Let the coordinates of a query be multiplied by powers of two, one for each axis,
/// without rounding. It has a contact at the same times, with the same (u,v). With a minimum
/// separation this holds if the factors are equal and the distance is multiplied by them as well.
/// Proof. F is linear in the coordinates of each axis, so it is 0 at the same (t,u,v). A norm with
/// equal factors is multiplied by them too. ∎
/// The volume of a tetrahedron is multiplied by the factors, which keeps its sign and its zeros.

#include <span>

#include "fast/certified/kernel.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// Moves queries of unusual size that the kernel can decide from the undecided ones of the output
/// to other lists. \param queries the undecided ones, in their order
/// \param function the kernel's function that left them undecided
void decide_rescaled(const KernelInput& block, KernelFunction& function,
                     std::span<const Query> queries, KernelOutput& output);

/// The same of cells. \param queries the undecided ones, as tetrahedra
void invert_rescaled(const CellInput& block, CellFunction& function, std::span<const Query> queries,
                     CellOutput& output);

}  // namespace touchstone::fast
