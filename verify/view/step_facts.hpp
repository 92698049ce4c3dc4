#pragma once

/// \file
/// The contents of a view of a step: the mesh before and after, and the colliding pairs by
/// time. And of a mesh at rest: the mesh, and the pairs that intersect.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"
#include "verify/mesh/mesh_file.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// A step with its collisions.
struct ViewedStep {
  std::string label;  ///< its origin
  mesh::Vertices before, after;
  std::vector<fast::Face> faces;
  std::vector<fast::Edge> codimensional_edges;  ///< the edges of no face
  Separation separation = {};
  std::vector<fast::StepCollision> collisions;  ///< in the order of toi_lower
  /// Each collision as a query, and its separation.
  std::vector<Query> queries;
  std::vector<Separation> separations;
  /// The numbers of each query's four points.
  std::vector<std::array<std::int32_t, 4>> points;
};

/// Finds the collisions.
/// \param mesh the elements of both frames
/// \param alpha replaces the whole step by the one with this step size (fast::Step::scaled)
/// \throws the exceptions of fast::Step
[[nodiscard]] ViewedStep find_collisions(std::string label, const mesh::Mesh& mesh,
                                         mesh::Vertices before, mesh::Vertices after,
                                         const fast::StepOptions& options,
                                         std::optional<double> alpha = std::nullopt);

/// The first colliding pairs, at most this number, as queries for a view.
[[nodiscard]] std::vector<ViewedQuery> first_queries(const ViewedStep& step, std::size_t most);

/// The maximum number of pairs in the list of a page.
inline constexpr std::size_t most_listed_pairs = 20'000;

/// The input of a page's script: an object of `label`, `before`, `after`, `faces`, `edges` (arrays
/// of little-endian doubles, and of 32-bit integers, in base 64), `pairs`, a list of the first
/// most_listed_pairs of `kind` (of the query), `name`, `points` (of the query, by their numbers),
/// `min_separation`, `toi` (lower and upper), `place` (u and v), `total`, the number of collisions,
/// and `min_separation` and `norm`.
[[nodiscard]] nlohmann::json step_facts(const ViewedStep& step);

/// The same of a mesh at rest: an object of `label`, `before`, `faces`, `edges`, `pairs`, a list of
/// the first most_listed_pairs of `kind` (of the intersection), `name`, `elements` (the vertices of
/// both) and `place` (its two ends, rounded down), and `total`.
/// \param name the name of a pair
[[nodiscard]] nlohmann::json resting_facts(
    std::string_view label, const mesh::Mesh& mesh, std::span<const fast::Intersection> found,
    const std::function<std::string(const fast::Intersection&)>& name);

}  // namespace touchstone::verify::view
