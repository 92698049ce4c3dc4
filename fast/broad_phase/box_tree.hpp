#pragma once

/// \file
/// A hierarchy of boxes in float, sixteen side by side, over groups of primitives
/// (fast/broad_phase/primitive_groups.hpp).
///
/// Level 0 has the boxes of the primitives, a group of sixteen at a time; level 1 the boxes around
/// these groups, sixteen at a time, and so on up to the one group of the root. A group's children
/// are sixteen consecutive groups of the level below, so no pointers are needed.
///
/// **Boxes at instants.** With one instant, a box is the swept one: around all places of a
/// primitive from beginning to end. Two primitives whose boxes are apart do not collide. With two
/// instants, there is a box at the beginning and one at the end. If two primitives are apart on an
/// axis at both, in the same order, they do not collide either: the points of both move on straight
/// lines at constant speed, so on that axis the difference of any two of them is a convex
/// combination of its values at the beginning and the end. If swept boxes are apart, so are the
/// boxes at both ends. Two instants therefore exclude at least as much as one. The same holds for
/// groups, because their boxes contain those of the primitives.
///
/// Bounds of boxes are minima and maxima of rounded coordinates, which equal the rounded minima and
/// maxima. The floating-point environment must be the default one.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/platform/large_array.hpp"

namespace touchstone::fast {

/// A number for each box of a group.
using FloatLanes = std::array<float, group_size>;

/// A box at each instant.
template <std::size_t instants>
struct LaneBox {
  std::array<std::array<float, 3>, instants> lower;
  std::array<std::array<float, 3>, instants> upper;
};

/// Sixteen boxes side by side.
template <std::size_t instants>
struct alignas(64) BoxGroup {
  std::array<std::array<FloatLanes, 3>, instants> lower;
  std::array<std::array<FloatLanes, 3>, instants> upper;

  [[nodiscard]] LaneBox<instants> box(std::size_t lane) const {
    LaneBox<instants> result;
    for (std::size_t instant = 0; instant < instants; ++instant) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[instant][axis] = lower[instant][axis][lane];
        result.upper[instant][axis] = upper[instant][axis][lane];
      }
    }
    return result;
  }
};

/// The groups of a level, and the number of their boxes: all groups except the last have sixteen.
/// Further lanes of the last are unused.
template <std::size_t instants>
struct BoxLevel {
  const BoxGroup<instants>* groups;
  std::size_t boxes;

  [[nodiscard]] std::size_t size() const { return (boxes + group_size - 1) / group_size; }
  /// Bit i is set if lane i of that group is a box of the level.
  [[nodiscard]] unsigned lanes(std::size_t group) const {
    const std::size_t rest = boxes - group * group_size;
    return rest < group_size ? (1U << rest) - 1U : 0xFFFFU;
  }
};

template <std::size_t instants>
class BoxTree {
 public:
  /// Allocates the boxes of these groups, which must outlive the tree; `fit` sets them.
  explicit BoxTree(const PrimitiveGroups& primitives);

  /// Sets the boxes. Uses the threads of the caller's task arena.
  void fit(const FloatBounds& bounds);

  [[nodiscard]] std::span<const GroupMembers> members() const { return members_; }
  /// Empty without primitives; otherwise at least two levels, the last one with one group.
  [[nodiscard]] std::span<const BoxLevel<instants>> levels() const { return levels_; }

 private:
  [[nodiscard]] BoxGroup<instants>* groups_of(std::size_t level);

  std::span<const GroupMembers> members_;
  LargeArray<BoxGroup<instants>> groups_;
  std::vector<BoxLevel<instants>> levels_;
};

extern template class BoxTree<1>;
extern template class BoxTree<2>;

}  // namespace touchstone::fast
