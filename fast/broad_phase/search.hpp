#pragma once

/// \file
/// The search for pairs of primitives whose boxes do not exclude a contact, one implementation for
/// each instruction set. (The algorithm: search_on_lanes.hpp.)

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

/// Certainty of the pairs that a search finds.
enum class Certainty : std::uint8_t {
  /// No pair is certain: each is confirmed.
  none,
  /// A pair is certain if it is also found with open boxes (float_bounds.hpp).
  unless_close,
  /// Every pair is certain.
  all,
};

/// The rules for one kind of pairs.
struct PairRules {
  /// True if both primitives are edges; otherwise the first is a vertex.
  bool of_edges = false;
  Certainty certainty = Certainty::all;
  /// Confirms a pair that is not certain, by the primitives' numbers.
  bool (*confirms)(const void* context, const IndexPair& pair) = nullptr;
  /// The bodies of the searching and of the other primitives, unless all bodies meet.
  const BodyTree* some_bodies = nullptr;
  const BodyTree* all_bodies = nullptr;
  /// With bodies: true if two bodies meet; true if two primitives meet, one of which is mixed.
  bool (*bodies_meet)(const void* context, std::int32_t a, std::int32_t b) = nullptr;
  bool (*primitives_meet)(const void* context, const IndexPair& pair) = nullptr;
  const void* context = nullptr;
};

/// Buffer for the pairs found.
struct PairBuffer {
  static constexpr std::size_t capacity = 1024;

  std::size_t count = 0;
  /// Called with the pairs when the next ones might not fit.
  void (*take)(void* context, std::span<const IndexPair> pairs) = nullptr;
  void* context = nullptr;
  alignas(64) std::array<IndexPair, capacity> pairs;

  void flush() {
    if (count > 0) take(context, std::span(pairs).first(count));
    count = 0;
  }
};

/// The two trees of a search and its rules.
template <std::size_t instants>
struct SearchInput {
  const BoxTree<instants>* some;
  /// For pairs within one tree, the same tree; then each pair is found once, the smaller number
  /// first.
  const BoxTree<instants>* all;
  PairRules rules;
};

/// The functions of one instruction set. All sets find the same pairs in the same order.
struct SearchKernel {
  InstructionSet instructions;
  /// Appends the pairs of the groups `first` to `end` − 1 of `some` to the buffer; the last pairs
  /// remain in it.
  void (*find_swept)(const SearchInput<1>& input, std::size_t first, std::size_t end,
                     PairBuffer& pairs);
  void (*find_at_ends)(const SearchInput<2>& input, std::size_t first, std::size_t end,
                       PairBuffer& pairs);

  /// Divides seeds by their centres on the axis of greatest spread: the `rank` least ones come
  /// first in `seeds`, the others go to `scratch`; both keep their order. Among equal seeds the
  /// first ones count as less. \pre count > rank ≥ 16
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

/// The kernels that this processor can run, slowest first; scalar is always among them.
[[nodiscard]] std::span<const SearchKernel* const> search_kernels();

/// The fastest of search_kernels().
[[nodiscard]] const SearchKernel& best_search_kernel();

/// The kernel of an instruction set; nullptr if this processor cannot run it.
[[nodiscard]] const SearchKernel* find_search_kernel(InstructionSet instructions);

}  // namespace touchstone::fast
