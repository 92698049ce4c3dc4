#pragma once

/// \file
/// Coverage key: a coarse class of the query by verdicts and times, for the scheduler.

#include <cstdint>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::fuzz {

/// Two queries have the same coverage key if these agree: the shape; the stage and verdict of the
/// judge; the verdict of the answer; to a factor of 256 the time of impact, or its distance from 1
/// if that is less; to a factor of 4 the distance of toi_lower below it, and the tolerance of the
/// answer; whether the contact is on the boundary of (u,v); the number of zero coordinates, in
/// steps of four; and to a factor of 2^256 the greatest coordinate. (Up to hash collisions.)
/// \param query one
[[nodiscard]] std::uint64_t coverage_key(const Queries& query, const fast::CertifiedResult& judged,
                                         const fast::Answer& answer);

}  // namespace touchstone::verify::fuzz
