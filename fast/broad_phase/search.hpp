#pragma once

/// \file
/// The search for pairs of primitives whose boxes do not exclude a contact, one implementation for
/// each instruction set. (The algorithm: search_on_lanes.hpp.)

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "fast/broad_phase/body_tree.hpp"
#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/seeds.hpp"
#include "fast/platform/instruction_set.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/mesh.hpp"

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

/// The questions of a search about the pairs that it finds.
class PairQuestions {
 public:
  /// True if an uncertain pair is a pair.
  [[nodiscard]] virtual bool confirms(const Primitive& a, const Primitive& b) const = 0;
  /// True if two bodies meet; true if two primitives meet, one of which is mixed.
  [[nodiscard]] virtual bool bodies_meet(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] virtual bool primitives_meet(const Primitive& a, const Primitive& b) const;

 protected:
  ~PairQuestions() = default;
};

/// The rules for one kind of pairs.
struct PairRules {
  /// True if both primitives are edges; otherwise the first is a vertex.
  bool of_edges = false;
  /// True if pairs that share a vertex are kept, too.
  bool keeps_neighbours = false;
  Certainty certainty = Certainty::all;
  /// Null if all pairs are certain and all bodies meet.
  const PairQuestions* questions = nullptr;
  /// The bodies of the searching and of the other primitives, unless all bodies meet.
  const BodyTree* some_bodies = nullptr;
  const BodyTree* all_bodies = nullptr;
};

/// Buffer for the pairs found.
struct PairBuffer {
  static constexpr std::size_t capacity = 1024;

  std::size_t count = 0;
  alignas(64) std::array<IndexPair, capacity> pairs;

  void flush() {
    if (count > 0) take(std::span(pairs).first(count));
    count = 0;
  }

 protected:
  PairBuffer() = default;
  ~PairBuffer() = default;
  /// Takes the pairs when the next ones might not fit.
  virtual void take(std::span<const IndexPair> found) = 0;
};

/// A buffer that calls a function with its pairs. It throws Stopped, when it is made or before such
/// a call, once *stop is true.
template <class Take>
class PairSink final : public PairBuffer {
 public:
  explicit PairSink(Take take, const std::atomic<bool>* stop = nullptr)
      : take_(std::move(take)), stop_(stop) {
    go_on();
  }

 private:
  void take(std::span<const IndexPair> found) override {
    go_on();
    take_(found);
  }
  void go_on() const {
    if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Stopped();
  }

  Take take_;
  const std::atomic<bool>* stop_;
};

/// The two trees of a search and its rules.
template <std::size_t instants>
struct SearchInput {
  const BoxTree<instants>* some;
  /// The same tree for pairs within one tree; then each pair is found once, the smaller number
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

}  // namespace touchstone::fast
