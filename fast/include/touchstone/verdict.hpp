#pragma once

/// \file
/// The answer of a solver to "do they collide?". Constants alone, so every thread can use them.

#include <cstdint>
#include <limits>

namespace touchstone::fast {

enum class Verdict : std::uint8_t {
  no,
  yes,
  undecided,  ///< no decision; to be treated as a conservative yes
  error,      ///< a coordinate is NaN or infinite (touchstone/query.hpp has the rule)
};

/// The value of a number that an answer does not have: NaN.
inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace touchstone::fast
