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

/// A pair of triangles, and its vertices: the common ones first, then the others of the first
/// triangle, then those of the second. (With common vertices the last places are unused.) With one
/// common vertex or none, those of each triangle keep their sense of rotation.
struct alignas(32) TrianglePair {
  std::array<std::int32_t, 6> vertices;
  IndexPair pair;
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
  /// Appends what is known of pairs, in their order.
  /// \param common The number of common vertices of all pairs: 0, 1 or 2.
  /// \pre there is room; strict floating point; coordinates of magnitude up to
  /// Positions::greatest_coordinate.
  void (*filter)(const MovingVertex* vertices, std::size_t common,
                 std::span<const TrianglePair> pairs, FilteredPairs& result);
  /// a b + c on its lanes, as CertifiedKernel.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const TriangleKernel* const> triangle_kernels();

}  // namespace touchstone::fast
