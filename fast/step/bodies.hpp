#pragma once

/// \file
/// The collision groups of a scene (touchstone/step.hpp). The search calls a collision group a
/// body, because "group" means sixteen primitives there. Two bodies *meet* if they can collide.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "touchstone/step.hpp"

namespace touchstone::fast {

class Bodies {
 public:
  /// \throws std::invalid_argument unless each vertex has a group, or none has, or for a negative
  /// group, also in `apart`.
  Bodies(std::size_t vertices, const CollisionGroups& groups);

  /// True if all bodies meet all.
  [[nodiscard]] bool all_meet() const { return apart_.empty(); }
  /// The groups from which they were made; none if all meet all. Refers to this object.
  [[nodiscard]] CollisionGroups groups() const {
    return {.of_vertices = of_vertices_, .apart = apart_};
  }
  /// The body of each vertex; empty if all meet all.
  [[nodiscard]] std::span<const std::int32_t> of_vertices() const { return of_vertices_; }

  [[nodiscard]] bool meet(std::int32_t a, std::int32_t b) const;
  /// True if the body of some vertex of one primitive meets that of some vertex of the other.
  [[nodiscard]] bool meet(std::span<const std::int32_t> vertices,
                          std::span<const std::int32_t> others) const;

 private:
  std::vector<std::int32_t> of_vertices_;
  /// Pairs that do not meet, in order, the smaller body first.
  std::vector<std::array<std::int32_t, 2>> apart_;
};

}  // namespace touchstone::fast
