#pragma once

/// \file
/// A bounding volume hierarchy over the swept boxes of primitives, for the broad phase.
///
/// Primitives are split at the median of their centres, along the axis where these spread most,
/// until eight are left: a *group*. Splitting by rank and not by place makes every branch equally
/// deep, and memory proportional to the primitives, however large, small or clustered they are.
///
/// A node and all below it stand in a row, the node first, so that a search is a walk along the
/// nodes: on to the next one where the boxes overlap, behind the subtree where they do not. A walk
/// from the leaf of a group on meets the later groups, each once, and none of the nodes above the
/// leaf: all that stands behind a leaf covers later groups only.
///
/// Bounds of boxes are minima and maxima of coordinates: exact. Rounding can only change which
/// primitives form a group. The floating-point environment must be the default one.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fast/mesh.hpp"

namespace touchstone::fast {

/// An axis-aligned box, closed. As it is made, the empty one, which overlaps no other.
struct Box {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  std::array<double, 3> lower{infinity, infinity, infinity};
  std::array<double, 3> upper{-infinity, -infinity, -infinity};

  /// Becomes the smallest box around both.
  void include(const Box& other);
  /// Have they a point in common?
  [[nodiscard]] bool overlaps(const Box& other) const {
    // A difference has the sign of the comparison, and a minimum needs no branch, which a processor
    // could not foresee.
    double room = infinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double behind = other.upper[axis] - lower[axis];
      const double before = upper[axis] - other.lower[axis];
      room = std::min(room, std::min(behind, before));
    }
    return room >= 0.0;
  }

  friend bool operator==(const Box&, const Box&) = default;
};

/// The box with its bounds moved outwards by a distance ≥ 0, each rounded *inwards*, to the nearest
/// double that is not beyond the exact sum. It overlaps a box of doubles iff the exact one does:
/// a double is at most the sum iff it is at most the greatest double that is. The empty box stays
/// empty.
[[nodiscard]] Box widened(const Box& box, double distance);

/// The vertices of a primitive; the last one is repeated where there are fewer than three.
using Primitive = std::array<std::int32_t, 3>;

/// The box of all positions of a primitive's vertices at t=0 and at t=1.
[[nodiscard]] Box swept_box(const MovingVertices& vertices, const Primitive& primitive);

/// Have they a vertex in common?
[[nodiscard]] inline bool share_vertex(const Primitive& a, const Primitive& b) {
  bool result = false;
  for (const std::int32_t i : a) {
    for (const std::int32_t j : b) result |= i == j;
  }
  return result;
}

/// Up to eight primitives that are near each other, in ascending order, with their boxes side by
/// side. Lanes from `size` on have the empty box.
struct alignas(64) Group {
  static constexpr std::size_t capacity = 8;
  using Lanes = std::array<double, capacity>;

  std::array<Lanes, 3> lower;
  std::array<Lanes, 3> upper;
  std::array<std::int32_t, capacity> indices;
  std::array<Primitive, capacity> primitives;
  std::size_t size;

  [[nodiscard]] Box box(std::size_t lane) const;
  /// Bit i: does lane i overlap the box?
  [[nodiscard]] unsigned overlapping(const Box& box) const {
    const auto [x, y, z] = box.lower;
    const auto [end_x, end_y, end_z] = box.upper;
    // As Box::overlaps; compilers make vectors of this.
    Lanes room;
    for (std::size_t lane = 0; lane < capacity; ++lane) {
      const double room_x = std::min(upper[0][lane] - x, end_x - lower[0][lane]);
      const double room_y = std::min(upper[1][lane] - y, end_y - lower[1][lane]);
      const double room_z = std::min(upper[2][lane] - z, end_z - lower[2][lane]);
      const double room_xy = room_y < room_x ? room_y : room_x;
      room[lane] = room_z < room_xy ? room_z : room_xy;
    }
    unsigned result = 0;
    for (std::size_t lane = 0; lane < capacity; ++lane) {
      result |= static_cast<unsigned>(room[lane] >= 0.0) << lane;
    }
    return result;
  }
};

/// The hierarchy.
class BoxTree {
 public:
  struct Node {
    static constexpr std::uint32_t inner = std::numeric_limits<std::uint32_t>::max();

    Box box;
    std::uint32_t behind;  ///< the first node that is not below this one
    std::uint32_t group;   ///< of a leaf; else `inner`
  };

  /// Of the primitives' swept boxes. Uses the threads of the task arena that it is called in; the
  /// tree does not depend on them.
  /// \pre there are at most 2^31−1 primitives, their indices are in range and the coordinates of
  /// their vertices are finite.
  BoxTree(const MovingVertices& vertices, std::span<const Primitive> primitives);

  /// Each of eight primitives, but for the last.
  [[nodiscard]] std::span<const Group> groups() const { return groups_; }
  /// Twice as many as groups, less one; the root first.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// The node of a group.
  [[nodiscard]] std::uint32_t leaf(std::size_t group) const { return leaves_[group]; }

 private:
  std::vector<Group> groups_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaves_;
};

/// Calls use(leaf, group) for each group whose node box overlaps `box`, in ascending order, from node
/// `first` on.
template <class Use>
void for_each_overlapping(const BoxTree& tree, std::uint32_t first, const Box& box,
                          const Use& use) {
  const std::span<const BoxTree::Node> nodes = tree.nodes();
  for (std::uint32_t i = first; i < nodes.size();) {
    const BoxTree::Node& node = nodes[i];
    const bool overlaps = node.box.overlaps(box);
    if (overlaps && node.group != BoxTree::Node::inner) use(node, tree.groups()[node.group]);
    i = overlaps ? i + 1 : node.behind;
  }
}

}  // namespace touchstone::fast
