#pragma once

/// \file
/// The first contact of any motion with integer coordinates of any size, for the cases that
/// contact_decision.hpp does not decide.

#include <cstdint>
#include <optional>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"

namespace touchstone::fast::exact_stage {

/// A contact with its time.
struct Impact {
  /// Doubles: lower < time ≤ upper, or both 0 if the time is 0.
  BitInterval time;
  /// Approximate parameters of the contact; possibly outside of their domain, by rounding.
  double u = 0.0, v = 0.0;
};

/// The first contact not later than the double in [0,1] with these bits, between neighbouring
/// doubles; empty if there is none.
[[nodiscard]] std::optional<Impact> first_impact(const Motion<BigInteger>& motion,
                                                 std::uint64_t latest);

}  // namespace touchstone::fast::exact_stage
