#pragma once

/// \file
/// The filter of pairs of triangles, for many pairs at a time: one implementation for each
/// instruction set. (The algorithm: filter_on_lanes.hpp.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/broad_phase/search.hpp"
#include "fast/platform/instruction_set.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// x, y and z of a vertex at rest, and an unused number.
using PlaceAtRest = std::array<double, 4>;

/// The vertices of an element in normal form (contacts.hpp), and 0.
using ElementRow = std::array<std::int32_t, 4>;

/// A pair of elements, and its vertices: the common ones first, then the others of the first
/// element, then those of the second. (With common vertices the last places are unused.)
struct alignas(32) ElementPair {
  std::array<std::int32_t, 6> vertices;
  IndexPair pair;
};

/// Pairs by the number of their common vertices. The last list has those with the same vertices,
/// and those of which one element has a common vertex twice; their `vertices` have no meaning.
struct SortedPairs {
  /// So many that the lists stay in the first cache.
  static constexpr std::size_t capacity = 512;

  std::array<std::size_t, 4> count;
  std::array<std::array<ElementPair, capacity>, 4> lists;
};

/// What rounded numbers tell of pairs; those that certainly do not intersect are left out.
struct FilteredPairs {
  /// No more pairs than a search has at a time.
  static constexpr std::size_t capacity = PairBuffer::capacity;

  std::size_t open_count = 0, crossing_count = 0;
  /// Pairs that may intersect.
  std::array<IndexPair, capacity> open;
  /// Pairs that certainly intersect, with the kind edge_through_face.
  std::array<IndexPair, capacity> crossing;
};

/// The functions of one instruction set. All sets have the same results.
struct TriangleKernel {
  InstructionSet instructions;
  /// Sorts pairs of elements into empty lists; each keeps their order.
  /// \pre there are at most SortedPairs::capacity pairs.
  void (*sort)(const ElementRow* elements, std::span<const IndexPair> pairs, SortedPairs& sorted);
  /// Appends what is known of pairs of one of the first three lists, in their order.
  /// \param common The number of common vertices.
  /// \pre there is room; strict floating point; coordinates of magnitude up to
  /// Positions::greatest_coordinate.
  void (*filter)(const PlaceAtRest* vertices, std::size_t common,
                 std::span<const ElementPair> pairs, FilteredPairs& result);
  /// a b + c on its lanes, as CertifiedKernel.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const TriangleKernel* const> triangle_kernels();

}  // namespace touchstone::fast
