#include "fast/broad_phase/box_tree.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

/// Nodes of level 1 per task when boxes are fitted.
constexpr std::size_t nodes_of_task = 4;

/// A box at each instant, by rows.
template <std::size_t instants>
struct RowBox {
  std::array<FloatRow, instants> lower;
  std::array<FloatRow, instants> upper;

  /// The neutral element of `include`.
  static RowBox empty() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    RowBox result;
    result.lower.fill(FloatRow{infinity, infinity, infinity, infinity});
    result.upper.fill(FloatRow{-infinity, -infinity, -infinity, -infinity});
    return result;
  }

  void include(const RowBox& other) {
    for (std::size_t i = 0; i < instants; ++i) {
      lower[i] = least(lower[i], other.lower[i]);
      upper[i] = greatest(upper[i], other.upper[i]);
    }
  }
};

template <std::size_t instants>
RowBox<instants> box_of(const VertexBounds& vertex) {
  if constexpr (instants == 2) {
    return {.lower = vertex.lower, .upper = vertex.upper};
  } else {
    return {.lower = {least(vertex.lower[0], vertex.lower[1])},
            .upper = {greatest(vertex.upper[0], vertex.upper[1])}};
  }
}

/// The box of a group's primitive.
template <std::size_t instants>
RowBox<instants> box_of(const FloatBounds& bounds, const GroupMembers& members, std::size_t lane) {
  const auto corner = [&](std::size_t k) {
    return box_of<instants>(bounds[static_cast<std::size_t>(members.vertices[k][lane])]);
  };
  RowBox<instants> result = corner(0);
  result.include(corner(1));
  result.include(corner(2));
  return result;
}

/// Transposes four rows: they become four lanes of each of the first three columns.
void set_lanes(std::array<FloatLanes, 3>& to, std::size_t lane, const FloatRow& a,
               const FloatRow& b, const FloatRow& c, const FloatRow& d) {
  const FloatRow ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const FloatRow cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const FloatRow ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const FloatRow cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const std::array<FloatRow, 3> columns{__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
                                        __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7),
                                        __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::memcpy(&to[axis][lane], &columns[axis], sizeof(FloatRow));
  }
}

/// Sets the first `count` lanes of a group to box(lane), and returns the box around them. Further
/// lanes repeat the last.
template <std::size_t instants, class BoxOf>
RowBox<instants> fill(BoxGroup<instants>& group, std::size_t count, const BoxOf& box) {
  static constexpr std::size_t at_once = 4;
  RowBox<instants> around = RowBox<instants>::empty(), last = around;
  for (std::size_t lane = 0; lane < group_size; lane += at_once) {
    std::array<RowBox<instants>, at_once> boxes;
    for (std::size_t i = 0; i < at_once; ++i) {
      if (lane + i < count) last = box(lane + i);
      boxes[i] = last;
      around.include(last);
    }
    const auto& [a, b, c, d] = boxes;
    for (std::size_t i = 0; i < instants; ++i) {
      set_lanes(group.lower[i], lane, a.lower[i], b.lower[i], c.lower[i], d.lower[i]);
      set_lanes(group.upper[i], lane, a.upper[i], b.upper[i], c.upper[i], d.upper[i]);
    }
  }
  return around;
}

}  // namespace

template <std::size_t instants>
BoxTree<instants>::BoxTree(const PrimitiveGroups& primitives) : members_(primitives.members()) {
  if (members_.empty()) return;
  std::size_t groups = 0;
  for (std::size_t boxes = primitives.size();; boxes = levels_.back().size()) {
    levels_.push_back({.groups = nullptr, .boxes = boxes});
    groups += levels_.back().size();
    if (levels_.size() > 1 && levels_.back().size() == 1) break;
  }
  groups_ = LargeArray<BoxGroup<instants>>(groups);
  const BoxGroup<instants>* next = groups_.data();
  for (BoxLevel<instants>& level : levels_) {
    level.groups = next;
    next += level.size();
  }
}

template <std::size_t instants>
BoxGroup<instants>* BoxTree<instants>::groups_of(std::size_t level) {
  return groups_.data() + (levels_[level].groups - groups_.data());
}

template <std::size_t instants>
void BoxTree<instants>::fit(const FloatBounds& bounds) {
  if (levels_.empty()) return;
  const auto boxes_in = [this](std::size_t level, std::size_t group) {
    return std::min(levels_[level].boxes - group * group_size, group_size);
  };
  // One node of level 1 with the groups of primitives below it: the groups are close in memory, and
  // no two tasks write to one node.
  const auto fit_node = [&](std::size_t node) {
    return fill(groups_of(1)[node], boxes_in(1, node), [&](std::size_t child) {
      const std::size_t group = node * group_size + child;
      return fill(groups_of(0)[group], boxes_in(0, group), [&](std::size_t lane) {
        return box_of<instants>(bounds, members_[group], lane);
      });
    });
  };
  std::vector<RowBox<instants>> of_nodes(levels_[1].size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, of_nodes.size(), nodes_of_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const StrictFloatingPoint strict;
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        of_nodes[i] = fit_node(i);
                      }
                    });
  for (std::size_t level = 2; level < levels_.size(); ++level) {
    // A node's box is read before it is replaced by one of the level above.
    for (std::size_t group = 0; group < levels_[level].size(); ++group) {
      of_nodes[group] =
          fill(groups_of(level)[group], boxes_in(level, group),
               [&](std::size_t child) { return of_nodes[group * group_size + child]; });
    }
  }
}

template class BoxTree<1>;
template class BoxTree<2>;

}  // namespace touchstone::fast
