#pragma once

/// \file
/// What the error bounds of the certified solver's kernel are multiplied by in its mutants.

namespace touchstone::tests {

struct FilterFactors {
  double gap = 1.0;          ///< stage direction
  double determinant = 1.0;  ///< det, in double
  double orientation = 1.0;  ///< orientations
  double precise = 1.0;      ///< det in double-double, at the ends of an enclosure
};

/// Set by a mutant before its kernel runs. Not for several threads at once.
extern FilterFactors filter_factors;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace touchstone::tests
