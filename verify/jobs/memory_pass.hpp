#pragma once

/// \file
/// Reading queries and nothing else: the time that no solver of an array of queries can beat.

#include <cstdint>
#include <span>

#include "exact/query.hpp"

namespace touchstone::verify::jobs {

/// Reads every coordinate once, in this thread, as fast as the processor can, and returns the
/// exclusive or of their bit patterns, so that no compiler can leave out the reading.
[[nodiscard]] std::uint64_t memory_pass(std::span<const Query> queries);

}  // namespace touchstone::verify::jobs
