#include "verify/view/step_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "touchstone/broad_phase.hpp"
#include "verify/io/html.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::view {
namespace {

static_assert(std::endian::native == std::endian::little, "a page's arrays are little-endian");

/// The edges of a mesh that no face has.
std::vector<fast::Edge> edges_of_no_face(const mesh::Mesh& mesh) {
  const std::vector<fast::Edge> of_faces = fast::edges_of(mesh.faces);
  std::vector<fast::Edge> result;
  // Both lists are in this order.
  const auto key = [](const fast::Edge& edge) { return std::pair(edge[1], edge[0]); };
  std::ranges::set_difference(mesh.edges, of_faces, std::back_inserter(result), {}, key, key);
  return result;
}

/// The positions of the vertices at t = 1.
mesh::Vertices ends_of(const fast::Motion& vertices) {
  mesh::Vertices ends(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ends(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis)) =
          vertices[i].end.at(axis);
    }
  }
  return ends;
}

std::string pair_text(const fast::StepCollision& collision) {
  static constexpr std::array<std::array<std::string_view, 2>, 4> names{
      {{"vertex", "face"}, {"edge", "edge"}, {"vertex", "edge"}, {"vertex", "vertex"}}};
  const auto& [first, second] = names.at(static_cast<std::size_t>(collision.kind));
  return fmt::format("{} {}, {} {}", first, collision.pair[0], second, collision.pair[1]);
}

template <class Number>
std::string array_text(std::span<const Number> numbers) {
  return io::base64(std::as_bytes(numbers));
}

std::string array_text(const mesh::Vertices& vertices) {
  return array_text(std::span(vertices.data(), static_cast<std::size_t>(vertices.size())));
}

template <std::size_t count>
std::string array_text(const std::vector<std::array<std::int32_t, count>>& elements) {
  return array_text(
      std::span(elements.empty() ? nullptr : elements.front().data(), count * elements.size()));
}

/// The vertices of an element at rest.
std::vector<std::int32_t> vertices_of(const mesh::Mesh& mesh, fast::PrimitiveKind kind,
                                      std::int32_t number) {
  const auto as_list = [](const auto& element) {
    return std::vector<std::int32_t>(element.begin(), element.end());
  };
  const auto i = static_cast<std::size_t>(number);
  if (kind == fast::PrimitiveKind::face) return as_list(mesh.faces[i]);
  return kind == fast::PrimitiveKind::edge ? as_list(mesh.edges[i]) : std::vector{number};
}

}  // namespace

ViewedStep find_collisions(std::string label, const mesh::Mesh& mesh, mesh::Vertices before,
                           mesh::Vertices after, const fast::StepOptions& options,
                           std::optional<double> alpha) {
  fast::Step step(before, after, mesh, options);
  if (alpha) {
    step = step.scaled(*alpha);
    after = ends_of(step.vertices());
  }
  ViewedStep result{.label = std::move(label),
                    .before = std::move(before),
                    .after = std::move(after),
                    .faces = mesh.faces,
                    .codimensional_edges = edges_of_no_face(mesh),
                    .separation = options.solve.separation,
                    .collisions = step.collisions(),
                    .queries = {},
                    .separations = {},
                    .points = {}};
  std::ranges::sort(result.collisions, {}, [](const fast::StepCollision& collision) {
    return std::tuple(collision.toi_lower, collision.toi_upper, collision.kind, collision.pair);
  });
  for (const fast::StepCollision& collision : result.collisions) {
    result.queries.push_back(step.query_of(collision.kind, collision.pair));
    result.separations.push_back(step.separation_of(collision.kind, collision.pair));
    result.points.push_back(step.vertices_of(collision.kind, collision.pair));
  }
  return result;
}

std::vector<ViewedQuery> first_queries(const ViewedStep& step, std::size_t most) {
  std::vector<ViewedQuery> queries;
  for (std::size_t i = 0; i < std::min(most, step.collisions.size()); ++i) {
    queries.push_back(
        {.label = fmt::format("{}: {}", step.label, pair_text(step.collisions[i])),
         .query = base::AnyQuery(decided_as(step.collisions[i].kind), step.queries[i]),
         .separation = step.separations[i]});
  }
  return queries;
}

nlohmann::json step_facts(const ViewedStep& step) {
  nlohmann::json pairs = nlohmann::json::array();
  for (std::size_t i = 0; i < std::min(most_listed_pairs, step.collisions.size()); ++i) {
    const fast::StepCollision& collision = step.collisions[i];
    pairs.push_back({{"kind", to_string(decided_as(collision.kind))},
                     {"name", pair_text(collision)},
                     {"points", step.points[i]},
                     {"min_separation", step.separations[i].distance},
                     {"toi", {collision.toi_lower, collision.toi_upper}},
                     {"place", {collision.u, collision.v}}});
  }
  return {{"label", io::printable(step.label)},
          {"before", array_text(step.before)},
          {"after", array_text(step.after)},
          {"faces", array_text(step.faces)},
          {"edges", array_text(step.codimensional_edges)},
          {"pairs", std::move(pairs)},
          {"total", step.collisions.size()},
          {"min_separation", step.separation.distance},
          {"norm", to_string(step.separation.norm)}};
}

nlohmann::json resting_facts(std::string_view label, const mesh::Mesh& mesh,
                             std::span<const fast::Intersection> found,
                             const std::function<std::string(const fast::Intersection&)>& name) {
  nlohmann::json pairs = nlohmann::json::array();
  for (const fast::Intersection& one : found.first(std::min(most_listed_pairs, found.size()))) {
    pairs.push_back({{"kind", to_string(one.kind)},
                     {"name", name(one)},
                     {"elements",
                      {vertices_of(mesh, one.elements[0], one.numbers[0]),
                       vertices_of(mesh, one.elements[1], one.numbers[1])}},
                     {"place", {one.place[0].lower, one.place[1].lower}}});
  }
  return {{"label", io::printable(label)},   {"before", array_text(mesh.vertices)},
          {"faces", array_text(mesh.faces)}, {"edges", array_text(edges_of_no_face(mesh))},
          {"pairs", std::move(pairs)},       {"total", found.size()}};
}

}  // namespace touchstone::verify::view
