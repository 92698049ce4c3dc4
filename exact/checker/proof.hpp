#pragma once

/// \file
/// The mathematics of the checker, in integers: the proof of a certificate's claim.

#include <cstddef>
#include <cstdint>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {

/// The greatest number of times that an interval is halved to prove a polynomial positive on it.
inline constexpr std::size_t max_bisections = 128;
/// The size of coordinates and times once they are integers.
inline constexpr std::size_t max_scaled_bits = 65'536;

/// Verifies the proof of the claim: no contact in [0,lower], one in [lower,upper], or both.
/// \param work_bits_left the rest of max_work_bits (checker.hpp), which the work reduces
/// \throws Rejection, with the line at fault, if the claim is not proved within the limits.
void verify(const Certificate& certificate, std::int64_t& work_bits_left);

}  // namespace touchstone::checker
