#pragma once

/// \file
/// The first contact of any motion with integer coordinates of any size: on curves, and for the
/// cases that contact_decision.hpp does not decide.

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/exact/polynomial.hpp"

namespace touchstone::fast::exact_stage {

/// A contact at an enclosed time. Rounding may put u and v outside of their domain.
[[nodiscard]] inline ExactImpact impact_at(const BitInterval& time, double u, double v) {
  return {std::bit_cast<double>(time.lower), std::bit_cast<double>(time.upper), u, v};
}

/// The bits of the time of an impact.
[[nodiscard]] inline BitInterval time_of(const ExactImpact& impact) {
  return {std::bit_cast<std::uint64_t>(impact.toi_lower),
          std::bit_cast<std::uint64_t>(impact.toi_upper)};
}

/// The first contact not later than the double in [0,1] with these bits, between neighbouring
/// doubles; empty if there is none.
[[nodiscard]] std::optional<ExactImpact> first_impact(const Motion<BigInteger>& motion,
                                                      std::uint64_t latest);

/// A motion, and polynomials that are positive on [0,1] and whose product divides D.
struct PolynomialMotion {
  MotionOf<Polynomial> motion;
  std::vector<Polynomial> factors;
};

/// The time of the first contact of any motion, enclosed likewise.
[[nodiscard]] std::optional<BitInterval> first_contact(const PolynomialMotion& motion,
                                                       std::uint64_t latest);

}  // namespace touchstone::fast::exact_stage
