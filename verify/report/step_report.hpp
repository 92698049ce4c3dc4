#pragma once

/// \file
/// Steps of a simulation and the contacts in them, for people (tables) and for machines (JSON,
/// CSV).

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/intersections.hpp"
#include "verify/jobs/check_step.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::report {

/// As many pairs that intersect are found unless others are asked for: they may be quadratically
/// many.
inline constexpr std::size_t most_intersections = 200'000;

/// A frame and its intersections.
struct FrameRecord {
  std::string name;
  /// If they were searched for; without places. If there are more, one more than
  /// `most_intersections`.
  std::optional<std::vector<fast::Intersection>> intersections;
  jobs::WorkTime time;  ///< of finding them
};

/// The step from frame i to frame i + 1.
using StepRecord = jobs::StepCheck;

/// The results of a run of `touchstone step`. The elements are those of every frame.
struct StepReport {
  Separation separation = {};
  std::vector<std::string> group_names;
  fast::CollisionGroups groups;  ///< whose radii and separations are told
  jobs::StepQuestion question = jobs::StepQuestion::all;
  std::optional<double> alpha = std::nullopt;
  std::size_t vertices = 0;
  std::span<const fast::Edge> edges;
  std::span<const fast::Face> faces;
  std::span<const fast::Tetrahedron> tetrahedra;
  /// One more than steps; an interrupted run may have one more, or none.
  std::vector<FrameRecord> frames;
  std::vector<StepRecord> steps;
  bool interrupted = false;
};

/// True if something touches or inverts in a step, or a frame intersects itself.
[[nodiscard]] bool has_collisions(const StepReport& report);

/// A line for each step; then, for each step, the pairs that touch and the cells that invert,
/// the earliest ten of each; then the pairs that intersect, ten of a frame; last the meaning of a
/// verdict on frames.
[[nodiscard]] std::string to_text(const StepReport& report);

/// As docs/cli.md, "Steps", says. `intersections` of a frame are lists of the kind, the first
/// element and its number, the second one and its number; of counts and times that were not asked
/// for or do not exist there is null. `proof` has `claim`, `rules`, `directions` and
/// `certificates`, the pairs that are argued by each, `bytes`, and `complete`; `seconds` have
/// `broad_phase`, `narrow_phase` and `total`. A pair of `earliest` is as fast::ActiveContact, if
/// contacts were asked for, and a cell, behind the pairs, as fast::StepInversion.
[[nodiscard]] nlohmann::json to_json(const StepReport& report);

/// The names of the columns (docs/cli.md, "Steps").
[[nodiscard]] std::string step_csv_header();

/// A row for each contact of step `i`, then for each inversion, with the kind, its cell as
/// `first`, its times and its `start`: 1, or 0 and -1 if it was flat or inverted from the start.
/// `normal_error` is inf where there is no normal, or no bound; `has_side` is 0 or 1.
[[nodiscard]] std::string step_csv_rows(const StepReport& report, std::size_t i);

// The intersections of meshes at rest, for people (tables) and for machines (JSON, CSV).

/// A mesh, and what is unusual in it by itself.
struct RestingMesh {
  std::string name;
  mesh::Mesh mesh;
  fast::MeshDefects defects = {};
  std::vector<fast::StepInversion> inversions = {};  ///< the tetrahedra that are flat or inverted
};

/// Several meshes as one, whose vertices and elements are those of all in order. If there is more
/// than one, each is a group with its name.
[[nodiscard]] mesh::Mesh joined(const std::vector<RestingMesh>& meshes);

struct IntersectionReport {
  std::vector<RestingMesh> meshes;
  std::vector<fast::Intersection> intersections;  ///< of the joined mesh
  bool weld = false;
  /// Names of groups that were not searched for intersections with each other.
  std::vector<std::pair<std::string, std::string>> apart = {};
  /// True if more pairs intersect: these are the first.
  bool is_cut = false;
  double seconds = 0.0;
  bool interrupted = false;
};

/// What was left out of the search or seen otherwise: "left out: A with B; vertices at one place,
/// of one group, are one". Empty if nothing was.
[[nodiscard]] std::string rules_text(const IntersectionReport& report);

/// The numbers of each kind, and the rules; the first ten pairs with their places; what is unusual
/// in each mesh.
[[nodiscard]] std::string to_text(const IntersectionReport& report);

/// "face 0 (0 1 2), face 1 (3 4 5)", with the names of the meshes if there are several.
[[nodiscard]] std::string pair_text(const std::vector<RestingMesh>& meshes,
                                    const fast::Intersection& intersection);

/// `meshes` (`name`, `vertices`, `edges`, `faces`, `degenerate_faces`, `degenerate_edges`,
/// `duplicated_vertices`, `unreferenced_vertices`, `tetrahedra`, `flat_tetrahedra`,
/// `inverted_tetrahedra`), `intersections` (`kind`, `first` and `second`:
/// `mesh`, an index, `element`, `number`; `place`: two points of three intervals), `counts` by
/// kind, `weld`, `apart` (pairs of names), `is_cut`, `seconds`, `interrupted`.
[[nodiscard]] nlohmann::json to_json(const IntersectionReport& report);

/// kind,first_mesh,first_element,first,second_mesh,second_element,second,x0_lower,x0_upper,…
[[nodiscard]] std::string to_csv(const IntersectionReport& report);

}  // namespace touchstone::verify::report
