#pragma once

/// \file
/// The sort of a query, for the steering: what the judge and the solver made of it, coarsely.

#include <cstdint>

#include "exact/query.hpp"
#include "fast/certified.hpp"
#include "fast/method.hpp"

namespace touchstone::verify {

/// Two queries have the same signature if these agree: the kind; the stage and verdict of the
/// judge; the verdict of the answer; to a factor of four the time of impact, its distance from 1,
/// how far toi_lower is below it, and the tolerance of the answer; whether the contact is at t = 1
/// or on the boundary of (u,v); how many coordinates are 0, by fours; and to a factor of 2^256 the
/// greatest coordinate. (But for accidents of hashing.)
[[nodiscard]] std::uint64_t signature(Kind kind, const Query& query,
                                      const fast::CertifiedResult& judged,
                                      const fast::Answer& answer);

}  // namespace touchstone::verify
