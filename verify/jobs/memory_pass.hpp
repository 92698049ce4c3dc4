#pragma once

/// \file
/// Reading the input and nothing else: the time that no solver can beat.

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>

namespace touchstone::verify::jobs {

/// Reads every byte once, in this thread, as fast as the processor can, and returns the exclusive or
/// of the words of eight bytes (the last one filled up with zeros), so that no compiler can leave out
/// the reading.
[[nodiscard]] std::uint64_t memory_pass(std::span<const std::byte> bytes);

/// Of an array of queries, vertices, edges …
template <std::ranges::contiguous_range Array>
[[nodiscard]] std::uint64_t memory_pass(const Array& array) {
  return memory_pass(std::as_bytes(std::span(array)));
}

}  // namespace touchstone::verify::jobs
