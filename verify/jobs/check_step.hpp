#pragma once

/// \file
/// A step of a simulation between two frames: what touches on the way, when, and for how much of the step nothing does.
///
/// Every vertex moves on the straight line from one frame to the next. Frames that intersect themselves are found
/// by find_piercings: an edge may be in a face from the start to the end of a step and touch nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast/step.hpp"
#include "verify/jobs/prove_step.hpp"
#include "verify/jobs/work_time.hpp"
#include "verify/mesh/mesh.hpp"

namespace touchstone::verify::jobs {

/// What is asked about a step.
enum class StepQuestion : std::uint8_t {
  all,       ///< every pair that touches
  earliest,  ///< the earliest impact and the pairs that realise it
  free,      ///< does anything touch?
};

struct StepCheckOptions {
  StepQuestion question = StepQuestion::all;
  fast::StepOptions step = {};
  /// Instead of the whole step, the one that a simulator takes with this step size: to the rounded
  /// positions x0 + α (x1 − x0) (fast::Step::scaled).
  std::optional<double> alpha = std::nullopt;
  /// If there is a place for its text: a certificate of the step is written.
  StepProofOptions proof = {};
};

/// The kinds of pairs, in the order of fast::PairKind.
inline constexpr std::array pair_kinds{fast::PairKind::vertex_face, fast::PairKind::edge_edge,
                                       fast::PairKind::vertex_edge, fast::PairKind::vertex_vertex};

/// So many pairs of each kind, in that order.
using PairCounts = std::array<std::uint64_t, pair_kinds.size()>;

struct StepCheck {
  /// Pairs whose swept boxes are within the separation.
  PairCounts candidates{};
  bool is_free = true;
  /// Nothing where only freedom was asked for, or nothing touches.
  std::optional<fast::StepImpact> earliest;
  /// Those that touch, if all were asked for; by kinds, then by numbers.
  std::optional<std::vector<fast::StepCollision>> collisions;
  /// With alpha: a step size as large as can be that is free (fast::Step::free_step_size); nothing
  /// if something touches at the start.
  std::optional<double> free_alpha;
  /// What was proved, if it was asked for.
  std::optional<StepProof> proof;
  /// Boxes, their trees and all candidates, counted.
  WorkTime broad_phase;
  /// The answer, with the trees there.
  WorkTime narrow_phase;
};

/// How many of the pairs are of each kind.
[[nodiscard]] PairCounts counts_of(const std::vector<fast::StepCollision>& collisions);

/// \param before, after the vertices at the ends of the step: as many as the mesh has
/// \throws std::invalid_argument for options out of range.
[[nodiscard]] StepCheck check_step(const mesh::Mesh& mesh, const mesh::Vertices& before,
                                   const mesh::Vertices& after, const StepCheckOptions& options);

}  // namespace touchstone::verify::jobs
