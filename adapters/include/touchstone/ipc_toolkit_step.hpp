#pragma once

/// \file
/// Whole steps of an `ipc::CollisionMesh`: the functions of the IPC Toolkit's `ipc/ipc.hpp`
/// (version 1.6) under their names and with their arguments, by the certified solver.
///
/// Write `touchstone::adapters::` instead of `ipc::` before a call. The toolkit stores its
/// candidates and examines them one by one; these functions search and decide at once
/// (touchstone/step.hpp), and their memory is proportional to the mesh.
///
/// **Pairs**, as in the toolkit: those without a common vertex that
/// - have a vertex i of one and a vertex j of the other with `mesh.can_collide(i, j)`,
/// - are, in three dimensions, two edges, a vertex and a face, a codimensional vertex and a
///   codimensional edge, or two codimensional vertices; in two dimensions, a vertex and an edge, or
///   two codimensional vertices,
/// - have swept boxes within `min_distance` of each other on every axis (exactly).
///
/// (The toolkit numbers codimensional vertices anew before it asks whether they can collide. Here i
/// and j always number the vertices of the mesh.)
///
/// **Distances.** Of the given narrow phase only `conservative_rescaling` is used: a pair at a
/// distance d > min_distance at t=0 may come as near as
///
///     min_distance + (1 − conservative_rescaling) (d − min_distance),
///
/// as in touchstone/ipc_toolkit.hpp. A given broad phase has no effect.
///
/// **Errors.** All functions throw std::invalid_argument for vertices that are not a row of two or
/// three coordinates for each vertex of the mesh, for a bad `min_distance` or rescaling (see
/// there), and for a mesh with `planes`, which are not supported; std::domain_error, naming the
/// vertex, for a coordinate that is NaN or infinite. They are thread-safe, call `can_collide` in
/// several threads and use as many threads as oneTBB allows.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ipc/collision_mesh.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "touchstone/broad_phase.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/ipc_toolkit.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace ipc {
class BroadPhase;
}  // namespace ipc

namespace touchstone::adapters {

/// A collision mesh as a scene, for the functions below.
class CollisionScene {
 public:
  /// Refers to the mesh. \throws std::invalid_argument as above.
  explicit CollisionScene(const ipc::CollisionMesh& mesh)
      : mesh_(mesh),
        edges_(fast::elements_from<fast::Edge>(mesh.edges())),
        points_(mesh.codim_vertices().begin(), mesh.codim_vertices().end()) {
    if (!mesh.planes.empty()) {
      throw std::invalid_argument("the planes of a collision mesh are not supported");
    }
    if (!is_flat()) {
      faces_ = fast::elements_from<fast::Face>(mesh.faces());
      return;
    }
    // Edges are triangles without an area (touchstone/certified.hpp).
    for (const auto& [a, b] : edges_) faces_.push_back({a, b, a});
  }

  /// True in two dimensions: then two edges are no pair of the scene.
  [[nodiscard]] bool is_flat() const { return mesh_.dim() == 2; }

  /// Refers to this scene. \throws as above.
  [[nodiscard]] fast::Step step(Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
                                Eigen::ConstRef<Eigen::MatrixXd> vertices_t1,
                                double min_distance) const {
    return fast::Step(
        places(vertices_t0), places(vertices_t1),
        {.edges = edges_, .faces = faces_, .points = points_},
        {.separation = {.distance = min_distance, .norm = Norm::l2},
         .can_collide = [this](std::int32_t i, std::int32_t j) { return can_collide(i, j); }});
  }

  /// True if an edge and a face intersect that can collide; in two dimensions, two edges.
  /// \throws as above.
  [[nodiscard]] bool has_intersections(Eigen::ConstRef<Eigen::MatrixXd> vertices) const {
    return fast::has_intersections(
        places(vertices), {.edges = edges_, .faces = faces_},
        {.pairs = fast::IntersectingPairs::edges_with_faces,
         .can_collide = [this](std::int32_t i, std::int32_t j) { return can_collide(i, j); }});
  }

 private:
  [[nodiscard]] bool can_collide(std::int32_t i, std::int32_t j) const {
    return mesh_.can_collide(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }

  [[nodiscard]] Eigen::MatrixX3d places(Eigen::ConstRef<Eigen::MatrixXd> vertices) const {
    if (static_cast<std::size_t>(vertices.rows()) != mesh_.num_vertices() ||
        static_cast<std::size_t>(vertices.cols()) != mesh_.dim()) {
      throw std::invalid_argument("vertices: there must be a row of coordinates for each vertex");
    }
    Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(vertices.rows(), 3);
    result.leftCols(vertices.cols()) = vertices;
    return result;
  }

  const ipc::CollisionMesh& mesh_;
  std::vector<fast::Edge> edges_;
  std::vector<fast::Face> faces_;
  std::vector<std::int32_t> points_;
};

/// The time at which the first pair of a step of the scene, with the separation min_distance, comes
/// as near as it may, rounded down as in touchstone/ipc_toolkit.hpp; nullopt if none does.
[[nodiscard]] inline std::optional<double> first_limit(const CollisionScene& scene,
                                                       const fast::Step& step,
                                                       const NarrowPhaseCCD& narrow_phase,
                                                       double min_distance) {
  const double part = 1.0 - narrow_phase.conservative_rescaling;
  double until = 1.0;
  if (!scene.is_flat()) {
    if (min_distance == 0.0 && part > 0.0 && part <= 1.0 - 0x1p-50) {
      const fast::LineSearchLimit limit =
          fast::line_search_limit(step, part, {.start_distance = fast::StartDistance::of_pair});
      if (limit.status == fast::LineSearchStatus::whole) return std::nullopt;
      return limit.step_size;
    }
    const std::optional<fast::StepImpact> impact = step.earliest();
    if (part == 0.0) return impact ? std::optional(impact->toi_lower) : std::nullopt;
    // A pair reaches its limit before it reaches the minimum distance.
    if (impact) until = (std::min)(until, impact->toi_upper);
  }
  std::atomic<double> first = std::numeric_limits<double>::infinity();
  step.candidates([&](const fast::StepCandidates& some) {
    if (scene.is_flat() && some.kind == fast::PairKind::edge_edge) return;
    for (const fast::IndexPair& pair : some.pairs) {
      // The margin makes the result independent of the order of the pairs.
      const double tmax = (std::min)(until, first.load() * (1.0 + 0x1p-38));
      double toi = 0.0;
      if (!narrow_phase.query_ccd(fast::Step::kind_of(some.kind), step.query_of(some.kind, pair),
                                  toi, min_distance, tmax)) {
        continue;
      }
      double known = first.load();
      while (toi < known && !first.compare_exchange_weak(known, toi)) {
      }
    }
  });
  return first < std::numeric_limits<double>::infinity() ? std::optional(first.load())
                                                         : std::nullopt;
}

/// The step size in [0,1] up to which no pair comes nearer than it may. It is 0 only if a pair is
/// within `min_distance` at the start, or the time is among the least doubles.
[[nodiscard]] inline double compute_collision_free_stepsize(
    const ipc::CollisionMesh& mesh, Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
    Eigen::ConstRef<Eigen::MatrixXd> vertices_t1, double min_distance = 0.0,
    const ipc::BroadPhase* /*broad_phase*/ = nullptr,
    const ipc::NarrowPhaseCCD& narrow_phase_ccd = NarrowPhaseCCD()) {
  const NarrowPhaseCCD narrow_phase(narrow_phase_ccd.conservative_rescaling);
  const CollisionScene scene(mesh);
  const fast::Step step = scene.step(vertices_t0, vertices_t1, min_distance);
  return first_limit(scene, step, narrow_phase, min_distance).value_or(1.0);
}

/// True if no pair comes nearer than it may in the whole step. With NarrowPhaseCCD(1.0): if no pair
/// comes within `min_distance`, exactly.
[[nodiscard]] inline bool is_step_collision_free(
    const ipc::CollisionMesh& mesh, Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
    Eigen::ConstRef<Eigen::MatrixXd> vertices_t1, double min_distance = 0.0,
    const ipc::BroadPhase* /*broad_phase*/ = nullptr,
    const ipc::NarrowPhaseCCD& narrow_phase_ccd = NarrowPhaseCCD()) {
  const NarrowPhaseCCD narrow_phase(narrow_phase_ccd.conservative_rescaling);
  const CollisionScene scene(mesh);
  const fast::Step step = scene.step(vertices_t0, vertices_t1, min_distance);
  // Any collision is found sooner than the first limit.
  if (!scene.is_flat() && !step.is_free()) return false;
  return !first_limit(scene, step, narrow_phase, min_distance);
}

/// True if an edge and a face without a common vertex that can collide have a common point; in two
/// dimensions, two edges. Decided exactly, also where they only touch or lie in one plane.
[[nodiscard]] inline bool has_intersections(const ipc::CollisionMesh& mesh,
                                            Eigen::ConstRef<Eigen::MatrixXd> vertices,
                                            const ipc::BroadPhase* /*broad_phase*/ = nullptr) {
  return CollisionScene(mesh).has_intersections(vertices);
}

}  // namespace touchstone::adapters
