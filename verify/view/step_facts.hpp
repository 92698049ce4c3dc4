#pragma once

/// \file
/// What a view says about a step: the mesh before and after, and the pairs that touch, by their time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exact/query.hpp"
#include "fast/step.hpp"
#include "verify/mesh/mesh.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::view {

/// A step with what touches in it.
struct ViewedStep {
  std::string label;  ///< where it is from
  mesh::Vertices before, after;
  std::vector<fast::Face> faces;
  std::vector<fast::Edge> codimensional_edges;  ///< those of no face
  Separation separation = {};
  std::vector<fast::StepCollision> collisions;  ///< in the order of toi_lower
  /// Of each of these, as a query.
  std::vector<Query> queries;
  /// And the numbers of the query's four points.
  std::vector<std::array<std::int32_t, 4>> points;
};

/// Finds what touches.
/// \param mesh the elements of both frames
/// \param alpha instead of the whole step, the one that a simulator takes with this step size (fast::Step::scaled)
/// \throws what fast::Step throws
[[nodiscard]] ViewedStep find_collisions(std::string label, const mesh::Mesh& mesh,
                                         mesh::Vertices before, mesh::Vertices after,
                                         const fast::StepOptions& options,
                                         std::optional<double> alpha = std::nullopt);

/// The first pairs that touch, at most so many, as queries to be looked at.
[[nodiscard]] std::vector<ViewedQuery> first_queries(const ViewedStep& step, std::size_t most);

/// A page lists at most so many pairs.
inline constexpr std::size_t most_listed_pairs = 20'000;

/// As the script of a page reads it: an object of `label`, `before`, `after`, `faces`, `edges` (arrays of
/// little-endian doubles, and of 32-bit integers, in base 64), `pairs`, a list of the first
/// most_listed_pairs of `kind` (of the query), `name`, `points` (of the query, by their numbers), `toi` (lower and upper),
/// `place` (u and v), `total`, how many touch, and `min_separation` and `norm`.
[[nodiscard]] nlohmann::json step_facts(const ViewedStep& step);

}  // namespace touchstone::verify::view
