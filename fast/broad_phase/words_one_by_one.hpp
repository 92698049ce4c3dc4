#pragma once

/// \file
/// The operations of search_on_lanes.hpp and division_on_lanes.hpp that write selected words, for
/// instruction sets that cannot select within a vector: the lanes derive from it. Every processor
/// can run this code.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/broad_phase/box_tree.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

struct WordsOneByOne {
  template <class Word>
  using Words = std::array<Word, group_size>;

  template <class Word>
  static Words<Word> load_words(const Word* from) {
    Words<Word> result;
    for (std::size_t i = 0; i < group_size; ++i) result[i] = from[i];
    return result;
  }
  template <class Word>
  static void write(Word* to, const Words<Word>& words, unsigned bits) {
    for (std::size_t i = 0; i < group_size; ++i) {
      *to = words[i];
      to += bits >> i & 1U;
    }
  }

  template <bool is_ordered>
  static IndexPair* append(IndexPair* to, std::int32_t number, const std::int32_t* numbers,
                           unsigned bits) {
    for (unsigned rest = bits; rest != 0; rest &= rest - 1) {
      const std::int32_t other = numbers[__builtin_ctz(rest)];
      *to++ = is_ordered && other < number ? IndexPair{other, number} : IndexPair{number, other};
    }
    return to;
  }
};

}  // namespace touchstone::fast
