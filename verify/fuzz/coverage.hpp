#pragma once

/// \file
/// The sort of a query, for the scheduler: what the judge and the solver made of it, coarsely.

#include <cstdint>

#include "exact/query.hpp"
#include "fast/certified.hpp"
#include "fast/method.hpp"

namespace touchstone::verify::fuzz {

/// Two queries have the same coverage key if these agree: the kind; the stage and verdict of the judge;
/// the verdict of the answer; to a factor of 256 the time of impact, or its distance from 1 if that is
/// less; to a factor of 4 how far toi_lower is below it, and the tolerance of the answer; whether the
/// contact is on the boundary of (u,v); how many coordinates are 0, by fours; and to a factor of 2^256
/// the greatest coordinate. (But for accidents of hashing.)
[[nodiscard]] std::uint64_t coverage_key(Kind kind, const Query& query,
                                         const fast::CertifiedResult& judged,
                                         const fast::Answer& answer);

}  // namespace touchstone::verify::fuzz
