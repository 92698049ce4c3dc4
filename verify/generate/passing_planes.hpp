#pragma once

/// \file
/// Flat primitives that pass each other: contact only when their heights are equal.
///
/// All points of the first primitive have the height p(t) in z, all of the second the height q(t).
/// Every corner then has z = p − q, so F can vanish only where p(t) = q(t), and there iff the
/// primitives' projections to the x-y plane meet. A *plan* fixes the projections so that they meet
/// at all times, in a known way, or at no time.

#include <cstdint>

#include "touchstone/any_kind.hpp"
#include "verify/generate/coordinate_sampler.hpp"
#include "verify/generate/family_builder.hpp"

namespace touchstone::verify::generate {

/// The common place of the projections: inside both; the vertex on a side of the face (the end of
/// edge a inside edge b); the vertex on a vertex (end on end). The last two are on the silhouette
/// in x.
enum class Spot : std::uint8_t { interior, edge, corner };

/// The offset of the silhouette places: none, or the first primitive moved in x by one unit in the
/// last place, away from the second primitive or into it. The interior place has no offset.
enum class Offset : std::uint8_t { none, outside, inside };

/// Zones, in units, of every plan.
inline constexpr Zone right{2.0, 3.0};
inline constexpr Zone left{-3.0, -2.0};

/// Sets x and y of all points such that the projections meet at all times, or (Offset::outside)
/// that x separates them strictly at all times.
void draw_plan(ContactKind kind, Spot spot, Offset offset, Sampler& sampler, Query& query);

/// Sets z of all points.
void set_heights(ContactKind kind, const Line& first, const Line& second, Query& query);

/// The outcome for heights and plan. The heights differ at t=0, or meet there.
[[nodiscard]] KnownQuery level_outcome(Offset offset, const Line& first, const Line& second,
                                       const Query& query);

}  // namespace touchstone::verify::generate
