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
/// The sizes of all polynomials that the proof of one certificate looks at, halves included, summed.
inline constexpr std::uint64_t max_work_bits = std::uint64_t{1} << 28U;

/// Verifies the proof: of `no_collision` in [0,upper], of a `collision` in [lower,upper], or of a time of
/// impact there. \returns the sizes that max_work_bits bounds. `line` is set to the line of the part that is looked at.
/// \throws Rejected if it does not prove the claim, or not within the limits.
std::uint64_t verify(const Certificate& certificate, std::size_t& line);

}  // namespace touchstone::checker
