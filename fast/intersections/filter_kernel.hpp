#pragma once

/// \file
/// The filter of pairs of triangles, for many pairs at a time: one implementation for each
/// instruction set. (The algorithm: filter_on_lanes.hpp.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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

/// The functions of one instruction set. All sets leave the same pairs.
struct TriangleKernel {
  InstructionSet instructions;
  /// Writes the pairs that may intersect, as far as rounded numbers tell, in their order, and
  /// returns the end.
  /// \param common The number of common vertices of all pairs: 0, 1 or 2.
  /// \pre strict floating point; coordinates of magnitude up to Positions::greatest_coordinate.
  IndexPair* (*find_open)(const MovingVertex* vertices, std::size_t common,
                          std::span<const TrianglePair> pairs, IndexPair* open);
  /// a b + c on its lanes, as CertifiedKernel.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const TriangleKernel* const> triangle_kernels();

}  // namespace touchstone::fast
