#pragma once

/// \file
/// To which bodies the primitives of a tree belong: vertices that are in one collision group (fast/step.hpp) are a body.
///
/// A primitive is of the body that all of its vertices are of, or *mixed*; likewise a group of primitives, and a node. So a
/// search leaves out whole nodes of a body that does not meet its own.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fast/broad_phase/primitive_groups.hpp"

namespace touchstone::fast {

class BodyTree {
 public:
  static constexpr std::int32_t mixed = -1;

  /// Of these primitives; each vertex has a body, which is not negative.
  BodyTree(const PrimitiveGroups& primitives, std::span<const std::int32_t> of_vertices);

  /// As BoxTree::levels: the bodies of each group's lanes.
  [[nodiscard]] const IndexLanes& bodies(std::size_t level, std::size_t group) const {
    return levels_[level][group];
  }

 private:
  std::vector<std::vector<IndexLanes>> levels_;
};

}  // namespace touchstone::fast
