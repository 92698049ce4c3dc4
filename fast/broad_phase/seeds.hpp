#pragma once

/// \file
/// Primitives on their way into groups (primitive_groups.hpp): their centres and numbers, in arrays, which are
/// divided in two again and again.

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {

/// Where arrays of centres and numbers are. All have room for a multiple of sixteen.
struct Seeds {
  std::array<float*, 3> centres;  ///< all x, all y, all z
  std::int32_t* numbers;

  /// The same arrays from a place on.
  [[nodiscard]] Seeds from(std::size_t place) const {
    return {{centres[0] + place, centres[1] + place, centres[2] + place}, numbers + place};
  }
};

/// Some seeds, and room for as many. \pre `capacity` is the least multiple of sixteen that is not below
/// `count`; both have room for so many.
struct SeedPart {
  Seeds seeds;
  Seeds room;
  std::size_t count;
  std::size_t capacity;

  /// The parts that remain when the seeds from `rank` on, a multiple of sixteen, have gone to the
  /// room's beginning: the first ones, and those.
  [[nodiscard]] SeedPart first(std::size_t rank) const {
    return {seeds, room.from(capacity - rank), rank, rank};
  }
  [[nodiscard]] SeedPart others(std::size_t rank) const {
    return {room, seeds.from(rank), count - rank, capacity - rank};
  }
};

}  // namespace touchstone::fast
