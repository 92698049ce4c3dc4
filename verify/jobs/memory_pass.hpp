#pragma once

/// \file
/// A pass that only reads the input: a lower bound of every solver's time.

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>

namespace touchstone::verify::jobs {

/// Reads every byte once, in this thread, as fast as the processor can, and returns the exclusive
/// or of the words of eight bytes (the last one filled up with zeros), so that the compiler cannot
/// remove the reading.
[[nodiscard]] std::uint64_t memory_pass(std::span<const std::byte> bytes);

/// The same for an array of queries, vertices, edges …
template <std::ranges::contiguous_range Array>
[[nodiscard]] std::uint64_t memory_pass(const Array& array) {
  return memory_pass(std::as_bytes(std::span(array)));
}

}  // namespace touchstone::verify::jobs
