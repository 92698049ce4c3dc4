#pragma once

/// \file
/// The check of the distance claimed by a yes with a tolerance.
///
/// In general (touchstone/plugin.h), a yes with tolerance τ for the separation d in a norm claims
/// that the primitives come within d + τ of each other in that norm at some time.
///
/// **Claim of Tight-Inclusion,** which works in L∞ and leaves rounding errors out of its tolerance.
/// A yes with tolerance τ for the separation d means that the primitives come within τ + d + 2ε of
/// each other in L∞ at some time, ε being the greatest filter of an axis. Proof: the answer's box
/// of parameters was not dropped, so on each axis not all corner values are beyond d + ε on one
/// side; and either the box is at most τ wide, so that no corner value is beyond d + ε + τ, or all
/// are within d + ε. Computed values are within ε of F, so |F| ≤ τ + d + 2ε on each axis at every
/// corner, of which the one with the lowest parameters is in the domain. The width is the rounded
/// difference of two values, hence one spacing more than τ.

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::verify::judge {

/// The distance, in a norm and rounded up, within which the primitives come at some time according
/// to a yes. Infinite, hence not a valid separation, if the yes claims nothing: without a
/// tolerance, and with a filter for coordinates or separations beyond 2^1016, which Tight-Inclusion
/// scales down first.
/// \param filter that the method's tolerances do not include (fast::MethodInfo::filter), or null
/// \param separation the requested one
[[nodiscard]] Separation claimed_distance(fast::ErrorFilter filter, ContactKind kind,
                                          const Query& query, const fast::Answer& answer,
                                          const Separation& separation);

/// True if a quick test, in floating point with proved bounds, shows that the primitives are within
/// the distance in L∞ at time t. False is no information.
[[nodiscard]] bool is_seen_within(ContactKind kind, const Query& query, double t, double distance);

}  // namespace touchstone::verify::judge
