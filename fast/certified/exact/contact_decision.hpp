#pragma once

/// \file
/// The first contact where coordinates are integers of at most 125 bits and things are as they
/// usually are, in numbers of fixed size and without allocation. What is unusual is handed on.
///
/// *Search.* An interval without a root of an event holds no first contact (theorem 2), nor does
/// one on which N_k and one of its bounds keep opposite signs (theorem 1). An interval with one root
/// of one event is decided at that root. Any other interval is split, between guesses of its roots
/// or at one: there most degenerate contacts are, because their times are mostly fractions of small
/// numbers, and at a fraction every sign is the sign of an integer. A guess comes from floating
/// point and decides nothing but where to look.
///
/// *At a root that is no small fraction* the signs come from the forms on the enclosure that is the
/// result anyway; where one changes its sign there, from its remainder by the event, or from a narrower
/// enclosure. What is still open then is handed on.
///
/// Why beside the general decision: without this one `touchstone bench handcrafted --method certified`
/// takes 7 (vertex-face) and 8 times (edge-edge) as long (medians of three runs a program, 23 November
/// 2026), since one query in 27 gets here.
///
/// *Signs* are exact. Floating point, with a bound, gives most of them (floating_point_filter.hpp).

#include <cstdint>
#include <optional>

#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/fixed_integer.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"

namespace touchstone::fast::exact_stage {

/// What the decision came to.
struct FixedSizeAnswer {
  bool decided = false;
  std::optional<Impact> impact;  ///< if decided: the first, if there is one
};

/// The first contact not later than the double in [0,1] of bits `latest`. Its enclosure is at most
/// `step` spacings of doubles wide. \pre the magnitudes of the coordinates of r, p, q and of the
/// corners are at most 2^61 or, with two limbs, 2^125; 1 ≤ step.
[[nodiscard]] FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<1>>& motion,
                                                      std::uint64_t latest, std::uint64_t step);
[[nodiscard]] FixedSizeAnswer fixed_size_first_impact(const Motion<FixedInteger<2>>& motion,
                                                      std::uint64_t latest, std::uint64_t step);

}  // namespace touchstone::fast::exact_stage
