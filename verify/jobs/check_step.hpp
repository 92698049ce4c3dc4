#pragma once

/// \file
/// A step of a simulation between two frames: its collisions and inversions with their times, and
/// the part of the step without any.
///
/// Every vertex moves on the straight line from one frame to the next. Frames that intersect
/// themselves are found by touchstone intersections: an edge may be in a face from the start to the
/// end of a step without a new contact.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "touchstone/contacts.hpp"
#include "touchstone/scene_certificate.hpp"
#include "touchstone/step.hpp"
#include "verify/jobs/work_time.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::jobs {

/// The question about a step.
enum class StepQuestion : std::uint8_t {
  all,       ///< every pair that collides, and every cell that inverts
  earliest,  ///< the earliest impact and the pairs that realise it
  free,      ///< only whether there is one
};

struct StepCheckOptions {
  StepQuestion question = StepQuestion::all;
  fast::StepOptions step = {};
  /// Replaces the whole step by the one with this step size: to the rounded positions x0 + α (x1 −
  /// x0) (fast::Step::scaled).
  std::optional<double> alpha = std::nullopt;
  /// Count the candidates also if the question is not `all`: this takes longer than the answer.
  bool count_candidates = false;
  /// The greatest number of candidates of which all that collide are listed: each of these takes
  /// memory.
  std::uint64_t most_candidates = std::uint64_t{1} << 27U;
  /// Find the places and normals of the collisions.
  bool find_contacts = false;
  /// Its on_text, if set, receives a certificate of the step.
  exact::SceneProofOptions proof = {};
};

/// The kinds of pairs, in the order of ContactKind.
inline constexpr std::array pair_kinds{ContactKind::vertex_face, ContactKind::edge_edge,
                                       ContactKind::vertex_edge, ContactKind::vertex_vertex};

/// Numbers of pairs of each kind, in that order.
using PairCounts = std::array<std::uint64_t, pair_kinds.size()>;

struct StepCheck {
  /// Pairs whose swept boxes are within the separation, if they were counted.
  std::optional<PairCounts> candidates;
  bool is_free = true;
  /// Empty if the question was `free`, or there is no collision.
  std::optional<fast::StepImpact> earliest;
  /// The pairs that collide, if the question was `all`; by kinds, then by numbers.
  std::optional<std::vector<fast::StepCollision>> collisions;
  /// The cells that invert, if the question was `all`.
  std::optional<std::vector<fast::StepInversion>> inversions = {};
  /// The contacts of `collisions`, or of the pairs of `earliest` if the question was that, if they
  /// were asked for; in their order, which is by kinds, then by numbers.
  std::vector<fast::ActiveContact> contacts = {};
  /// With alpha: a maximal step size that is free (fast::Step::free_step_size); empty if there is
  /// contact at the start.
  std::optional<double> free_alpha;
  /// The proof, if requested.
  std::optional<exact::SceneProof> proof;
  /// True if its scene ends at the frame with which the next step begins.
  bool ends_at_frame = true;
  /// Time of boxes and groups, and of the count of all candidates.
  WorkTime broad_phase;
  /// Time of the answer, given the trees.
  WorkTime narrow_phase;
};

/// The number of pairs of each kind.
[[nodiscard]] PairCounts counts_of(const std::vector<fast::StepCollision>& collisions);

/// \param step Empty, or an earlier step of the mesh with the same options, which then saves making
/// the groups of primitives; set to this step.
/// \param before, after the vertices at the ends of the step: as many as the mesh has
/// \throws std::invalid_argument for options out of range; std::runtime_error if all that collide
/// are asked for, of too many candidates.
[[nodiscard]] StepCheck check_step(std::optional<fast::Step>& step, const mesh::Mesh& mesh,
                                   const mesh::Vertices& before, const mesh::Vertices& after,
                                   const StepCheckOptions& options);

}  // namespace touchstone::verify::jobs
