#pragma once

/// \file
/// The bodies of a tree's primitives. The vertices of one collision group (touchstone/step.hpp) are
/// a body.
///
/// A primitive belongs to the common body of its vertices, or is *mixed*; likewise a group of
/// primitives, and a node. A search can therefore skip whole nodes of a body that does not meet its
/// own. Where bodies alone do not tell which primitives meet, each primitive counts as mixed, so
/// that the search asks about it (PairQuestions).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fast/broad_phase/primitive_groups.hpp"

namespace touchstone::fast {

class BodyTree {
 public:
  static constexpr std::int32_t mixed = -1;

  /// The tree of these primitives. \param of_vertices The body of each vertex, not negative.
  /// \param all_are_mixed True if each primitive counts as mixed, but not the groups of them.
  BodyTree(const PrimitiveGroups& primitives, std::span<const std::int32_t> of_vertices,
           bool all_are_mixed);

  /// The bodies of each group's lanes, as BoxTree::levels.
  [[nodiscard]] const IndexLanes& bodies(std::size_t level, std::size_t group) const {
    return levels_[level][group];
  }

 private:
  std::vector<std::vector<IndexLanes>> levels_;
};

}  // namespace touchstone::fast
