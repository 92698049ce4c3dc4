#pragma once

/// \file
/// The collision groups of a scene (touchstone/step.hpp). The search calls a collision group a
/// body, because "group" means sixteen primitives there. Two bodies *meet* if they can collide. A
/// rule for vertices (StepOptions::can_collide) holds besides.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "touchstone/step.hpp"

namespace touchstone::fast {

class Bodies {
 public:
  /// \throws std::invalid_argument unless each vertex has a group, or none has, or for a negative
  /// group, also in `apart`.
  Bodies(std::size_t vertices, const CollisionGroups& groups,
         std::function<bool(std::int32_t, std::int32_t)> can_collide = nullptr);

  /// True if all primitives meet all.
  [[nodiscard]] bool all_meet() const { return apart_.empty() && !can_collide_; }
  /// The groups from which they were made; none if all meet all. Refers to this object.
  [[nodiscard]] CollisionGroups groups() const {
    return {.of_vertices = of_vertices_, .apart = apart_};
  }
  /// The body of each vertex; empty if all primitives meet all.
  [[nodiscard]] std::span<const std::int32_t> of_vertices() const { return of_vertices_; }
  /// True if the bodies of two primitives do not tell whether these meet.
  [[nodiscard]] bool has_rule_for_vertices() const { return static_cast<bool>(can_collide_); }
  /// The rule for vertices; empty if there is none.
  [[nodiscard]] const std::function<bool(std::int32_t, std::int32_t)>& can_collide() const {
    return can_collide_;
  }

  [[nodiscard]] bool meet(std::int32_t a, std::int32_t b) const;
  /// True if a vertex of one primitive and a vertex of the other can collide.
  [[nodiscard]] bool meet(std::span<const std::int32_t> vertices,
                          std::span<const std::int32_t> others) const;

 private:
  std::vector<std::int32_t> of_vertices_;
  /// Pairs that do not meet, in order, the smaller body first.
  std::vector<std::array<std::int32_t, 2>> apart_;
  std::function<bool(std::int32_t, std::int32_t)> can_collide_;
};

}  // namespace touchstone::fast
