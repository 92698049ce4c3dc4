#pragma once

/// \file
/// The first contact for integer coordinates of at most 125 bits, in numbers of fixed size, without
/// allocation. Rare cases are left to the general decision.
///
/// *Search.* An interval without a root of an event has no first contact (theorem 2), nor has one
/// on which N_k and one of its bounds keep opposite signs (theorem 1). An interval with one root of
/// one event is decided at that root. Any other interval is split, between guesses of its roots or
/// at one. Most degenerate contacts are at such guesses, because their times are mostly fractions
/// of small numbers, and at a fraction every sign is the sign of an integer. Guesses come from
/// floating point and determine only the places of splits.
///
/// *At a root that is no small fraction* the signs come from the forms on the resulting enclosure;
/// for a form that changes its sign there, from its remainder by the event, or from a narrower
/// enclosure. Queries that are still open then are left to the general decision.
///
/// *Reason.* Without this decision, with the general one alone, `touchstone bench handcrafted
/// --method certified` takes 7 (vertex-face) and 8 times (edge-edge) as long (medians of three runs
/// of each program, 23 November 2026), because one query in 27 reaches this stage.
///
/// *Signs* are exact. Floating point with an error bound decides most of them
/// (floating_point_filter.hpp).

#include <cstdint>
#include <optional>

#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/fixed_integer.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"

namespace touchstone::fast::exact_stage {

/// The outcome of the decision.
struct FixedSizeAnswer {
  bool decided = false;
  std::optional<ExactImpact> impact;  ///< if decided: the first contact, if there is one
};

/// The first contact not later than the double in [0,1] of bits `latest`. Its enclosure is at most
/// `step` spacings of doubles wide. \pre the magnitudes of the coordinates of r, p, q and of the
/// corners are at most 2^61 or, with two limbs, 2^125; 1 ≤ step.
[[nodiscard]] FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<1>>& motion,
                                                      std::uint64_t latest, std::uint64_t step);
[[nodiscard]] FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<2>>& motion,
                                                      std::uint64_t latest, std::uint64_t step);

}  // namespace touchstone::fast::exact_stage
