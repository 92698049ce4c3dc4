#pragma once

/// \file
/// Which collision groups of a scene meet (fast/step.hpp). The search calls a group of vertices a
/// body, since it has groups of its own.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fast/step.hpp"

namespace touchstone::fast {

class Bodies {
 public:
  /// \throws std::invalid_argument unless there is a group for each vertex, or for none, and groups
  /// are not negative, also those that are apart.
  Bodies(std::size_t vertices, const CollisionGroups& groups);

  /// Do all meet all?
  [[nodiscard]] bool all_meet() const { return apart_.empty(); }
  /// The body of each vertex; not if all meet all.
  [[nodiscard]] std::span<const std::int32_t> of_vertices() const { return of_vertices_; }

  [[nodiscard]] bool meet(std::int32_t a, std::int32_t b) const;
  /// Does the body of a vertex of one primitive meet that of one of the other?
  [[nodiscard]] bool meet(std::span<const std::int32_t> vertices,
                          std::span<const std::int32_t> others) const;

 private:
  std::vector<std::int32_t> of_vertices_;
  /// Pairs that do not meet, the smaller one first, in order.
  std::vector<std::array<std::int32_t, 2>> apart_;
};

}  // namespace touchstone::fast
