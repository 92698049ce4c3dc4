#pragma once

/// \file
/// The built-in workload of the benchmark: two patches of triangle mesh that move through
/// each other in one step, as cloth does when its step is too long.
///
/// The patches are square grids of cells, each cut into two triangles, bent like shallow bowls with
/// their bottoms towards each other, one turned against the other so that no edges are parallel.
/// Vertices are displaced at random from the grid, and each moves a little differently from its
/// neighbours. As in a simulation, the candidates are those of the broad phase, including pairs
/// within one patch.

#include <cstdint>

#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::generate {

struct PatchOptions {
  std::uint64_t seed = 2021;
  /// Cells along a side of a patch, at least 1. The default gives well over 100,000 candidates of
  /// each kind, some per cent of which collide, with any seed.
  int cells = 60;
};

/// The two patches: a function of the options, the same on every machine.
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] mesh::MovingMesh moving_patches(const PatchOptions& options = {});

}  // namespace touchstone::verify::generate
