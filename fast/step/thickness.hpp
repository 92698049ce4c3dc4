#pragma once

/// \file
/// The collision groups of a scene, and the thickness of their pairs (touchstone/step.hpp). The
/// search calls a collision group a body, because "group" means sixteen primitives there. Two
/// bodies *meet* if they can collide. A rule for vertices (StepOptions::can_collide) holds besides.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::fast {

class Bodies {
 public:
  /// \throws std::invalid_argument unless each vertex has a group, or none has; for a negative
  /// group; for a group in `apart` and `separations` that no vertex has; for missing radii, for
  /// radii and distances that are negative or too large, and for two groups with two separations.
  Bodies(std::size_t vertices, const CollisionGroups& groups,
         std::function<bool(std::int32_t, std::int32_t)> can_collide = nullptr);

  /// True if all primitives meet all.
  [[nodiscard]] bool all_meet() const { return apart_.empty() && !can_collide_; }
  /// The body of each vertex; may be empty if all primitives meet all.
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

  // ---- Thickness ----

  /// True if some bodies have a thickness.
  [[nodiscard]] bool has_thickness() const { return !radii_.empty() || !separations_.empty(); }
  /// The thickness of a pair of primitives with these vertices. \pre has_thickness()
  [[nodiscard]] double thickness(std::span<const std::int32_t> vertices,
                                 std::span<const std::int32_t> others) const;
  /// A bound of the thickness of all pairs, at most 2^1000.
  [[nodiscard]] double greatest_thickness() const;
  /// The reach of each vertex's body: those of two bodies are in sum not less than their thickness.
  /// Empty without thickness.
  [[nodiscard]] std::vector<double> reaches() const;

 private:
  void take_thickness(const CollisionGroups& groups);
  [[nodiscard]] std::int32_t body(std::int32_t vertex) const {
    return of_vertices_[static_cast<std::size_t>(vertex)];
  }
  [[nodiscard]] double radius(std::int32_t body) const {
    return radii_.empty() ? 0.0 : radii_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] double greatest_radius(std::span<const std::int32_t> vertices) const;
  [[nodiscard]] double thickness(std::int32_t a, std::int32_t b) const;

  std::vector<std::int32_t> of_vertices_;
  /// Pairs that do not meet, in order, the smaller body first.
  std::vector<std::array<std::int32_t, 2>> apart_;
  std::function<bool(std::int32_t, std::int32_t)> can_collide_;
  std::vector<double> radii_;                 ///< of the bodies; empty if all are 0
  std::vector<double> radii_of_vertices_;     ///< likewise
  std::vector<GroupSeparation> separations_;  ///< in order, the smaller body first
};

}  // namespace touchstone::fast
