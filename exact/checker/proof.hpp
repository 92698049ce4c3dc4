#pragma once

/// \file
/// Whether what a certificate says is a proof of its claim: the mathematics, in integers.

#include <cstddef>
#include <cstdint>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {

/// The greatest number of times that an interval is halved to prove a polynomial positive on it.
inline constexpr std::size_t max_bisections = 128;
/// The size of coordinates and times once they are integers.
inline constexpr std::size_t max_scaled_bits = 65'536;

/// Verifies the proof: of no contact in [0,lower], of one in [lower,upper], or of both, as is
/// claimed.
/// \param work_bits_left the sizes that max_work_bits (checker.hpp) bounds are taken from it
/// \throws Rejection, with the line of the part at fault, if it does not prove the claim, or not within the limits.
void verify(const Certificate& certificate, std::int64_t& work_bits_left);

}  // namespace touchstone::checker
