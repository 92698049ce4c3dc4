#pragma once

/// \file
/// Primitives during the construction of groups (primitive_groups.hpp): arrays of centres and
/// numbers, which are divided in two repeatedly.

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {

/// Pointers to arrays of centres and numbers. Their capacities are multiples of sixteen.
struct Seeds {
  std::array<float*, 3> centres;  ///< all x, all y, all z
  std::int32_t* numbers;

  /// The same arrays from an index on.
  [[nodiscard]] Seeds from(std::size_t place) const {
    return {{centres[0] + place, centres[1] + place, centres[2] + place}, numbers + place};
  }
};

/// A part of the seeds, and a buffer for as many. \pre `capacity` is the least multiple of sixteen
/// that is not below `count`; both have this capacity.
struct SeedPart {
  Seeds seeds;
  Seeds scratch;
  std::size_t count;
  std::size_t capacity;

  /// The two parts after the seeds from `rank` on, a multiple of sixteen, have been moved to the
  /// beginning of the second buffer.
  [[nodiscard]] SeedPart first(std::size_t rank) const {
    return {seeds, scratch.from(capacity - rank), rank, rank};
  }
  [[nodiscard]] SeedPart others(std::size_t rank) const {
    return {scratch, seeds.from(rank), count - rank, capacity - rank};
  }
};

}  // namespace touchstone::fast
