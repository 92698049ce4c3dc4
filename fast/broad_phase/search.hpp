#pragma once

/// \file
/// The search for pairs of primitives whose boxes do not exclude a contact, one implementation for each
/// instruction set. (The algorithm: search_on_lanes.hpp.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/broad_phase/body_tree.hpp"
#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/seeds.hpp"
#include "fast/mesh.hpp"
#include "fast/platform/instruction_set.hpp"

namespace touchstone::fast {

/// What a search says of pairs that it finds.
enum class Certainty : std::uint8_t {
  /// No pair is sure: each is confirmed.
  none,
  /// A pair is sure if it is found with open boxes as well (float_bounds.hpp).
  unless_close,
  /// Every pair is.
  all,
};

/// What holds of one kind of pairs.
struct PairRules {
  /// Are both primitives edges? Else the first is a vertex.
  bool of_edges = false;
  Certainty certainty = Certainty::all;
  /// Asked about each pair that is not sure, with the primitives' numbers.
  bool (*confirms)(const void* context, const IndexPair& pair) = nullptr;
  /// The bodies of the primitives that search and of the others, if not all meet.
  const BodyTree* some_bodies = nullptr;
  const BodyTree* all_bodies = nullptr;
  /// With bodies: do two of them meet; and two primitives, one of which is mixed?
  bool (*bodies_meet)(const void* context, std::int32_t a, std::int32_t b) = nullptr;
  bool (*primitives_meet)(const void* context, const IndexPair& pair) = nullptr;
  const void* context = nullptr;
};

/// Pairs on their way out.
struct PairBuffer {
  static constexpr std::size_t capacity = 1024;

  std::size_t count = 0;
  /// Called with the pairs when the next ones may not fit.
  void (*take)(void* context, std::span<const IndexPair> pairs) = nullptr;
  void* context = nullptr;
  alignas(64) std::array<IndexPair, capacity> pairs;

  void flush() {
    if (count > 0) take(context, std::span(pairs).first(count));
    count = 0;
  }
};

/// Which groups of a tree are held against another tree.
template <std::size_t instants>
struct SearchInput {
  const BoxTree<instants>* some;
  /// The same tree for pairs within it: each is then found once, the smaller number first.
  const BoxTree<instants>* all;
  PairRules rules;
};

/// The functions of one instruction set. All sets find the same pairs in the same order.
struct SearchKernel {
  InstructionSet instructions;
  /// Appends the pairs of the groups `first` to `end` − 1 of `some` to the buffer; what is left in it at the
  /// end is not flushed.
  void (*find_swept)(const SearchInput<1>& input, std::size_t first, std::size_t end,
                     PairBuffer& pairs);
  void (*find_at_ends)(const SearchInput<2>& input, std::size_t first, std::size_t end,
                       PairBuffer& pairs);

  /// Divides seeds by their centres on the axis where these spread most: the `rank` least are the first
  /// of them then, and the others are where `room` was; both in their order. Which of equal ones are
  /// among the least depends on their order. \pre count > rank ≥ 16
  void (*divide)(const SeedPart& part, std::size_t rank);

  void find(const SearchInput<1>& input, std::size_t first, std::size_t end,
            PairBuffer& pairs) const {
    find_swept(input, first, end, pairs);
  }
  void find(const SearchInput<2>& input, std::size_t first, std::size_t end,
            PairBuffer& pairs) const {
    find_at_ends(input, first, end, pairs);
  }
};

/// Those that this processor can run, slowest first; scalar is always among them.
[[nodiscard]] std::span<const SearchKernel* const> search_kernels();

/// The fastest of search_kernels().
[[nodiscard]] const SearchKernel& best_search_kernel();

/// The kernel of an instruction set; nullptr if this processor cannot run it.
[[nodiscard]] const SearchKernel* find_search_kernel(InstructionSet instructions);

}  // namespace touchstone::fast
