#pragma once

/// \file
/// A hierarchy of boxes in float, sixteen side by side, over groups of primitives
/// (fast/broad_phase/primitive_groups.hpp).
///
/// Level 0 has the boxes of the primitives, a group of sixteen at a time; level 1 the boxes around these groups,
/// sixteen at a time, and so on up to the one group of the root. A group's children are sixteen
/// in a row on the level below, so nothing points anywhere.
///
/// **Boxes at instants.** With one instant, a box is the swept one: around all places of a primitive
/// from beginning to end. Two primitives whose boxes are apart do not touch. With two instants, there
/// is a box at the beginning and one at the end. If two primitives are apart on an axis at both, the
/// same way round, they do not touch either: the points of both move on straight lines at constant
/// speed, so on that axis the difference of any two of them is a convex combination of its values at
/// the beginning and the end. Swept boxes that are apart are boxes apart at both ends, so two instants
/// exclude all that one does, and more. What holds of primitives holds of groups: their boxes are around them.
///
/// Bounds of boxes are minima and maxima of rounded coordinates, which is the same as their minimum and
/// maximum rounded. The floating-point environment must be the default one.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"

namespace touchstone::fast {

/// A number for each box of a group.
using FloatLanes = std::array<float, group_size>;

/// A box at each instant.
template <std::size_t instants>
struct LaneBox {
  std::array<std::array<float, 3>, instants> lower;
  std::array<std::array<float, 3>, instants> upper;
};

/// Sixteen of them side by side.
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

/// The groups of a level, and how many boxes they have: all but the last have sixteen. The other
/// lanes of the last have the box of no primitive.
template <std::size_t instants>
struct BoxLevel {
  const BoxGroup<instants>* groups;
  std::size_t boxes;

  [[nodiscard]] std::size_t size() const { return (boxes + group_size - 1) / group_size; }
  /// Bit i: is lane i of that group a box of the level?
  [[nodiscard]] unsigned lanes(std::size_t group) const {
    const std::size_t rest = boxes - group * group_size;
    return rest < group_size ? (1U << rest) - 1U : 0xFFFFU;
  }
};

template <std::size_t instants>
class BoxTree {
 public:
  /// Room for the boxes of these groups, which it refers to; `fit` sets them.
  explicit BoxTree(const PrimitiveGroups& primitives);

  /// Sets the boxes. Uses the threads of the task arena that it is called in.
  void fit(const FloatBounds& bounds);

  [[nodiscard]] std::span<const GroupMembers> members() const { return members_; }
  /// Of no primitives, none; else two at least, the last one of one group.
  [[nodiscard]] std::span<const BoxLevel<instants>> levels() const { return levels_; }

 private:
  [[nodiscard]] BoxGroup<instants>* groups_of(std::size_t level);

  std::span<const GroupMembers> members_;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  std::unique_ptr<BoxGroup<instants>[]> groups_;
  std::vector<BoxLevel<instants>> levels_;
};

extern template class BoxTree<1>;
extern template class BoxTree<2>;

}  // namespace touchstone::fast
