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
#include <functional>
#include <ipc/collision_mesh.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

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

/// The rule of a collision mesh, which is copied.
[[nodiscard]] inline std::function<bool(std::int32_t, std::int32_t)> rule_of(
    const ipc::CollisionMesh& mesh) {
  return [rule = mesh.can_collide](std::int32_t i, std::int32_t j) {
    return rule(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  };
}

/// The elements of a collision mesh. \throws std::invalid_argument as above.
[[nodiscard]] inline fast::Mesh elements_of(const ipc::CollisionMesh& mesh) {
  if (!mesh.planes.empty()) {
    throw std::invalid_argument("the planes of a collision mesh are not supported");
  }
  fast::Mesh result{.edges = fast::elements_from<fast::Edge>(mesh.edges()),
                    .points = {mesh.codim_vertices().begin(), mesh.codim_vertices().end()}};
  if (mesh.dim() == 3) {
    result.faces = fast::elements_from<fast::Face>(mesh.faces());
  } else {
    // Edges are triangles without an area (touchstone/certified.hpp).
    for (const auto& [a, b] : result.edges) result.faces.push_back({a, b, a});
  }
  return result;
}

/// A row of three coordinates for each vertex. \throws std::invalid_argument as above.
[[nodiscard]] inline Eigen::MatrixX3d places_of(const ipc::CollisionMesh& mesh,
                                                Eigen::ConstRef<Eigen::MatrixXd> vertices) {
  if (static_cast<std::size_t>(vertices.rows()) != mesh.num_vertices() ||
      static_cast<std::size_t>(vertices.cols()) != mesh.dim()) {
    throw std::invalid_argument("vertices: there must be a row of coordinates for each vertex");
  }
  Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(vertices.rows(), 3);
  result.leftCols(vertices.cols()) = vertices;
  return result;
}

/// A step of a collision mesh; in two dimensions, two edges are no pair that counts. \throws as
/// above.
[[nodiscard]] inline fast::Step step_of(const ipc::CollisionMesh& mesh,
                                        Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
                                        Eigen::ConstRef<Eigen::MatrixXd> vertices_t1,
                                        double min_distance) {
  fast::Mesh elements = elements_of(mesh);
  return {places_of(mesh, vertices_t0),
          places_of(mesh, vertices_t1),
          std::move(elements),
          {.solve = {.separation = {.distance = min_distance, .norm = Norm::l2}},
           .can_collide = rule_of(mesh)}};
}

/// The time at which the first pair of a step, with the separation min_distance, comes as near as
/// it may, rounded down as in touchstone/ipc_toolkit.hpp; nullopt if none does.
[[nodiscard]] inline std::optional<double> first_limit(const fast::Step& step, bool is_flat,
                                                       const NarrowPhaseCCD& narrow_phase,
                                                       double min_distance) {
  const double part = 1.0 - narrow_phase.conservative_rescaling;
  double until = 1.0;
  if (!is_flat) {
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
    if (is_flat && some.kind == ContactKind::edge_edge) return;
    for (const fast::IndexPair& pair : some.pairs) {
      // The margin makes the result independent of the order of the pairs.
      const double tmax = (std::min)(until, first.load() * (1.0 + 0x1p-38));
      double toi = 0.0;
      if (!narrow_phase.query_ccd(decided_as(some.kind), step.query_of(some.kind, pair), toi,
                                  min_distance, tmax)) {
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
  const fast::Step step = step_of(mesh, vertices_t0, vertices_t1, min_distance);
  return first_limit(step, mesh.dim() == 2, narrow_phase, min_distance).value_or(1.0);
}

/// True if no pair comes nearer than it may in the whole step. With NarrowPhaseCCD(1.0): if no pair
/// comes within `min_distance`, exactly.
[[nodiscard]] inline bool is_step_collision_free(
    const ipc::CollisionMesh& mesh, Eigen::ConstRef<Eigen::MatrixXd> vertices_t0,
    Eigen::ConstRef<Eigen::MatrixXd> vertices_t1, double min_distance = 0.0,
    const ipc::BroadPhase* /*broad_phase*/ = nullptr,
    const ipc::NarrowPhaseCCD& narrow_phase_ccd = NarrowPhaseCCD()) {
  const NarrowPhaseCCD narrow_phase(narrow_phase_ccd.conservative_rescaling);
  const fast::Step step = step_of(mesh, vertices_t0, vertices_t1, min_distance);
  const bool is_flat = mesh.dim() == 2;
  // Any collision is found sooner than the first limit.
  if (!is_flat && !step.is_free()) return false;
  return !first_limit(step, is_flat, narrow_phase, min_distance);
}

/// True if an edge and a face without a common vertex that can collide have a common point; in two
/// dimensions, two edges. Decided exactly, also where they only touch or lie in one plane.
[[nodiscard]] inline bool has_intersections(const ipc::CollisionMesh& mesh,
                                            Eigen::ConstRef<Eigen::MatrixXd> vertices,
                                            const ipc::BroadPhase* /*broad_phase*/ = nullptr) {
  const fast::Mesh elements = elements_of(mesh);
  return fast::has_intersections(
      places_of(mesh, vertices), elements,
      {.pairs = fast::IntersectingPairs::edges_with_faces, .can_collide = rule_of(mesh)});
}

}  // namespace touchstone::adapters
