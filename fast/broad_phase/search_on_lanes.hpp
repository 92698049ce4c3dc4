#pragma once

/// \file
/// The search for pairs in two trees of boxes (box_tree.hpp), as a template for sixteen
/// lanes, with a box in each lane. Only the kernels include this file, one per instruction set
/// (search_*.cpp).
///
/// A group of sixteen primitives traverses the other tree as one, with the box around all of them:
/// at a node, this box is compared with the boxes of the node's sixteen children. At a group of
/// primitives, each of the own primitives that is not apart from that group's box is compared with
/// the sixteen there. Every comparison is therefore of one box with sixteen. The result depends
/// only on comparisons, and pairs come in the same order from all instruction sets.
///
/// Within one tree a group is compared with itself and later groups. Nodes before it are skipped:
/// the first and the last group of a node follow from its index.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/broad_phase/division_on_lanes.hpp"
#include "fast/broad_phase/search.hpp"

namespace touchstone::fast::search {

/// `Lanes` is a type of the file of one instruction set, in an anonymous namespace. It has
/// - Value and Mask: a float and a truth value in each of sixteen lanes, with the operations of the
///   certified solver's lanes (fast/certified/stages/lanes.hpp);
/// - load_words(from): sixteen numbers of 32 bits at an address aligned to 64;
/// - write(to, words, bits): writes the words that the bits select, one after the other. It may
///   write sixteen;
/// - append<is_ordered>(to, number, numbers, bits): writes the pairs of a number with those of the
///   sixteen numbers that the bits select, if is_ordered the smaller one first, and returns the
///   end. It may write sixteen pairs.
template <class Lanes, std::size_t instants, bool of_edges>
class Search {
 public:
  Search(const SearchInput<instants>& input, PairBuffer& pairs)
      : some_(*input.some),
        all_(*input.all),
        rules_(input.rules),
        pairs_(pairs),
        within_(input.some == input.all) {}

  void run(std::size_t first, std::size_t end) {
    for (std::size_t group = first; group < end; ++group) {
      set_own(group);
      walk(group);
    }
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Boxes = BoxGroup<instants>;

  // ---- The group that searches ----

  /// A box of a group.
  struct Place {
    const Boxes* group;
    std::size_t lane;
  };

  void set_own(std::size_t group) {
    const BoxLevel<instants>&boxes = some_.levels()[0], &parents = some_.levels()[1];
    own_ = &boxes.groups[group];
    own_lanes_ = boxes.lanes(group);
    around_ = {&parents.groups[group / group_size], group % group_size};
    if (rules_.some_bodies != nullptr) {
      own_body_ = rules_.some_bodies->bodies(1, group / group_size)[group % group_size];
    }
    if (rules_.certainty == Certainty::unless_close) set_inner();
  }

  /// Sets the open boxes: if a box overlaps one of them, the exact boxes overlap.
  void set_inner() {
    for (std::size_t instant = 0; instant < instants; ++instant) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t lane = 0; lane < group_size; ++lane) {
          inner_.lower[instant][axis][lane] = float_after(own_->lower[instant][axis][lane]);
          inner_.upper[instant][axis][lane] = float_before(own_->upper[instant][axis][lane]);
        }
      }
    }
  }

  // ---- Comparing ----

  struct Loaded {
    std::array<std::array<Value, 3>, instants> lower;
    std::array<std::array<Value, 3>, instants> upper;
  };

  static Loaded load(const Boxes& boxes) {
    Loaded result;
    for (std::size_t instant = 0; instant < instants; ++instant) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[instant][axis] = Value::load(boxes.lower[instant][axis].data());
        result.upper[instant][axis] = Value::load(boxes.upper[instant][axis].data());
      }
    }
    return result;
  }

  /// The boxes, of sixteen, that are not apart from one box of a group: on no axis are they apart
  /// at all instants, in the same order.
  static unsigned not_apart(const Loaded& boxes, const Boxes& group, std::size_t lane) {
    Mask apart = Mask::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto lower = [&](std::size_t i) { return Value(group.lower[i][axis][lane]); };
      const auto upper = [&](std::size_t i) { return Value(group.upper[i][axis][lane]); };
      Mask above = lower(0) > boxes.upper[0][axis];
      Mask below = boxes.lower[0][axis] > upper(0);
      if constexpr (instants == 2) {
        above = above & (lower(1) > boxes.upper[1][axis]);
        below = below & (boxes.lower[1][axis] > upper(1));
      }
      apart = apart | above | below;
    }
    return ~apart.bits();
  }

  // ---- The walk ----

  struct Node {
    std::size_t level;
    std::size_t number;
  };

  void walk(std::size_t group) {
    static constexpr std::size_t most_levels = 8;
    std::array<Node, most_levels * group_size> waiting;
    std::size_t count = 0;
    waiting[count++] = {all_.levels().size() - 1, 0};
    while (count > 0) {
      const Node node = waiting[--count];
      const BoxLevel<instants>& level = all_.levels()[node.level];
      const Boxes& boxes = level.groups[node.number];
      unsigned within_reach =
          not_apart(load(boxes), *around_.group, around_.lane) & level.lanes(node.number);
      if (within_) within_reach &= from_group_on(group, node);
      if (rules_.all_bodies != nullptr) within_reach = that_meet(node, within_reach);
      if (node.level == 1) {
        for (; within_reach != 0; within_reach &= within_reach - 1) {
          const auto lane = static_cast<std::size_t>(__builtin_ctz(within_reach));
          meet(group, node.number * group_size + lane, {&boxes, lane});
        }
        continue;
      }
      // The last child goes to the stack first, and is visited last.
      while (within_reach != 0) {
        const auto lane = static_cast<std::size_t>(31 - __builtin_clz(within_reach));
        within_reach ^= 1U << lane;
        waiting[count++] = {node.level - 1, node.number * group_size + lane};
      }
    }
  }

  /// The children of a node that contain that group of level 0 or a later one.
  static unsigned from_group_on(std::size_t group, const Node& node) {
    // The index of the group's ancestor among the boxes of the node's level.
    const std::size_t place = group >> (4 * (node.level - 1));
    return place / group_size == node.number ? ~0U << (place % group_size) : ~0U;
  }

  /// The children of a node whose bodies meet that of the own group.
  unsigned that_meet(const Node& node, unsigned children) const {
    if (own_body_ == BodyTree::mixed) return children;
    const IndexLanes& bodies = rules_.all_bodies->bodies(node.level, node.number);
    for (unsigned rest = children; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
      const bool meets =
          bodies[lane] == BodyTree::mixed || rules_.questions->bodies_meet(own_body_, bodies[lane]);
      if (!meets) children &= ~(1U << lane);
    }
    return children;
  }

  /// Compares the own primitives with those of another group, which has that box.
  void meet(std::size_t group, std::size_t other, const Place& box) {
    unsigned rows = not_apart(load(*own_), *box.group, box.lane) & own_lanes_;
    if (rows == 0) return;
    const BoxLevel<instants>& boxes = all_.levels()[0];
    const GroupMembers &own = some_.members()[group], &others = all_.members()[other];
    const Loaded loaded = load(boxes.groups[other]);
    const unsigned lanes = boxes.lanes(other);
    const bool is_self = within_ && group == other;
    for (; rows != 0; rows &= rows - 1) {
      const auto row = static_cast<std::size_t>(__builtin_ctz(rows));
      unsigned overlapping = not_apart(loaded, *own_, row) & lanes;
      if (is_self) overlapping &= ~0U << (row + 1);
      if (overlapping == 0) continue;
      if (!rules_.keeps_neighbours) overlapping &= ~sharing(own, row, others);
      if (overlapping == 0) continue;
      if (rules_.all_bodies != nullptr) overlapping = that_meet({group, row}, other, overlapping);
      if (rules_.certainty != Certainty::all)
        overlapping = confirmed(own, row, others, loaded, overlapping);
      append(own.numbers[row], others.numbers, overlapping);
    }
  }

  /// The primitives, of sixteen, that share a vertex with a primitive.
  static unsigned sharing(const GroupMembers& own, std::size_t row, const GroupMembers& others) {
    Mask result = Mask::none();
    for (std::size_t i = 0; i < (of_edges ? 2U : 1U); ++i) {
      for (std::size_t k = 0; k < (of_edges ? 2U : 3U); ++k) {
        result = result | Mask::equal(others.vertices[k].data(), own.vertices[i][row]);
      }
    }
    return result.bits();
  }

  static Primitive primitive(const GroupMembers& group, std::size_t lane) {
    return {group.vertices[0][lane], group.vertices[1][lane], group.vertices[2][lane]};
  }

  /// A primitive of a group.
  struct Row {
    std::size_t group;
    std::size_t lane;
  };

  /// The primitives of another group that meet an own primitive.
  unsigned that_meet(const Row& row, std::size_t other, unsigned overlapping) const {
    const std::int32_t body = rules_.some_bodies->bodies(0, row.group)[row.lane];
    const IndexLanes& bodies = rules_.all_bodies->bodies(0, other);
    for (unsigned rest = overlapping; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
      const bool is_mixed = body == BodyTree::mixed || bodies[lane] == BodyTree::mixed;
      const bool meets = is_mixed ? rules_.questions->primitives_meet(
                                        primitive(some_.members()[row.group], row.lane),
                                        primitive(all_.members()[other], lane))
                                  : rules_.questions->bodies_meet(body, bodies[lane]);
      if (!meets) overlapping &= ~(1U << lane);
    }
    return overlapping;
  }

  /// The hits that are certain or confirmed.
  unsigned confirmed(const GroupMembers& own, std::size_t row, const GroupMembers& others,
                     const Loaded& boxes, unsigned overlapping) const {
    const unsigned sure =
        rules_.certainty == Certainty::unless_close ? not_apart(boxes, inner_, row) : 0U;
    unsigned result = overlapping & sure;
    for (unsigned rest = overlapping & ~sure; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
      if (rules_.questions->confirms(primitive(own, row), primitive(others, lane))) {
        result |= 1U << lane;
      }
    }
    return result;
  }

  void append(std::int32_t number, const IndexLanes& numbers, unsigned overlapping) {
    if (pairs_.count + group_size > PairBuffer::capacity) pairs_.flush();
    IndexPair* const to = pairs_.pairs.data() + pairs_.count;
    const IndexPair* const end =
        within_ ? Lanes::template append<true>(to, number, numbers.data(), overlapping)
                : Lanes::template append<false>(to, number, numbers.data(), overlapping);
    pairs_.count = static_cast<std::size_t>(end - pairs_.pairs.data());
  }

  Boxes inner_;
  const Boxes* own_ = nullptr;
  Place around_{};

  const BoxTree<instants>& some_;
  const BoxTree<instants>& all_;
  const PairRules& rules_;
  PairBuffer& pairs_;
  unsigned own_lanes_ = 0;
  std::int32_t own_body_ = BodyTree::mixed;
  const bool within_;
};

template <class Lanes, std::size_t instants>
void find(const SearchInput<instants>& input, std::size_t first, std::size_t end,
          PairBuffer& pairs) {
  if (input.all->levels().empty()) return;
  if (input.rules.of_edges) {
    Search<Lanes, instants, true>(input, pairs).run(first, end);
  } else {
    Search<Lanes, instants, false>(input, pairs).run(first, end);
  }
}

}  // namespace touchstone::fast::search

namespace touchstone::fast {

template <class Lanes>
constexpr SearchKernel search_kernel_on(InstructionSet instructions) {
  return {.instructions = instructions,
          .find_swept = search::find<Lanes, 1>,
          .find_at_ends = search::find<Lanes, 2>,
          .divide = division::divide<Lanes>};
}

}  // namespace touchstone::fast
