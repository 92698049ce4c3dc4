#include "fast/step/scene.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "fast/broad_phase.hpp"
#include "fast/broad_phase/swept_box.hpp"

namespace touchstone::fast {
namespace {

constexpr auto all_kinds = std::to_array<PairKind>(
    {PairKind::vertex_face, PairKind::edge_edge, PairKind::vertex_edge, PairKind::vertex_vertex});

CertifiedOptions certified_options(const StepOptions& options) {
  const CertifiedOptions result{.toi_tolerance = options.toi_tolerance,
                                .t_max = options.t_max,
                                .separation = options.separation,
                                .max_threads = options.max_threads,
                                .kernel = options.kernel};
  require_valid(result);
  return result;
}

/// \throws as Step.
CertifiedOptions with_separation(CertifiedOptions options, const Separation& separation) {
  options.separation = separation;
  require_valid(options);
  return options;
}

/// \throws as Step.
MovingVertices checked(MovingVertices vertices, const MeshElements& elements) {
  require_finite(vertices);
  require_in_range(vertices, elements.edges);
  require_in_range(vertices, elements.faces);
  require_in_range(vertices, elements.points);
  return vertices;
}

MovingVertices checked(MovingVertices vertices, const Scene& other) {
  if (vertices.size() != other.vertices().size()) {
    throw std::invalid_argument("step: there must be as many vertices as before");
  }
  require_finite(vertices);
  return vertices;
}

template <class Items>
const auto& at(const Items& items, std::int32_t index) {
  return items[static_cast<std::size_t>(index)];
}

/// Applies `make` to the item of each sort.
template <class Item, class Make>
auto each(const OfPrimitives<Item>& items, const Make& make) {
  return OfPrimitives<decltype(make(items.vertices))>{make(items.vertices), make(items.edges),
                                                      make(items.faces), make(items.points),
                                                      make(items.bare_edges)};
}

/// The two sorts of primitives of a pair.
template <class Item>
std::pair<const Item&, const Item&> sides(const OfPrimitives<Item>& of, PairKind kind) {
  switch (kind) {
    case PairKind::vertex_face:
      return {of.vertices, of.faces};
    case PairKind::edge_edge:
      return {of.edges, of.edges};
    case PairKind::vertex_edge:
      return {of.points, of.bare_edges};
    case PairKind::vertex_vertex:
      break;
  }
  return {of.points, of.points};
}

template <std::size_t instants>
void fit_all(Trees<instants>& trees, const FloatBounds& bounds) {
  trees.vertices.fit(bounds);
  trees.edges.fit(bounds);
  trees.faces.fit(bounds);
  trees.points.fit(bounds);
  trees.bare_edges.fit(bounds);
}

/// Codimensional parts as input of the certified solver.
std::vector<Face> as_faces(std::span<const std::int32_t> points) {
  std::vector<Face> result;
  result.reserve(points.size());
  for (const std::int32_t point : points) result.push_back({point, point, point});
  return result;
}
std::vector<Face> as_faces(std::span<const std::int32_t> numbers, std::span<const Edge> edges) {
  std::vector<Face> result;
  result.reserve(numbers.size());
  for (const std::int32_t number : numbers) {
    const auto [a, b] = at(edges, number);
    result.push_back({a, b, a});
  }
  return result;
}

template <class Element>
PrimitiveGroups groups_of(const FloatBounds& bounds, const std::vector<Element>& elements) {
  return PrimitiveGroups(bounds, std::span<const Element>(elements));
}

}  // namespace

// ---- The mesh -----------------------------------------------------------------------------------

SceneMesh::SceneMesh(std::size_t vertex_count, const FloatBounds& bounds, const MeshElements& given,
                     const CollisionGroups& collision_groups)
    : edges_of_faces(given.edges.empty() ? edges_of(given.faces) : std::vector<Edge>()),
      elements{.edges = given.edges.empty() ? edges_of_faces : given.edges,
               .faces = given.faces,
               .points = given.points},
      vertices(vertices_of(vertex_count, elements)),
      codimensional(fast::codimensional(vertex_count, vertices, elements)),
      points_as_faces(as_faces(codimensional.points)),
      edges_as_faces(as_faces(codimensional.edges, elements.edges)),
      bodies(vertex_count, collision_groups),
      groups{groups_of(bounds, vertices), PrimitiveGroups(bounds, elements.edges),
             PrimitiveGroups(bounds, elements.faces), groups_of(bounds, points_as_faces),
             groups_of(bounds, edges_as_faces)} {
  if (bodies.all_meet()) return;
  bodies_of_groups = each(
      groups, [this](const PrimitiveGroups& some) { return BodyTree(some, bodies.of_vertices()); });
}

// ---- The scene ----------------------------------------------------------------------------------

Scene::Scene(MovingVertices vertices, const MeshElements& elements, const StepOptions& options)
    : vertices_(checked(std::move(vertices), elements)),
      certified_(certified_options(options)),
      search_(options.search != nullptr ? *options.search : best_search_kernel()),
      bounds_(vertices_, 1.0, certified_.separation.distance),
      mesh_(
          std::make_shared<const SceneMesh>(vertices_.size(), bounds_, elements, options.groups)) {}

Scene::Scene(MovingVertices vertices, const Scene& other)
    : Scene(std::move(vertices), other, other.certified_.separation) {
  certified_.t_max = 1.0;
}

Scene::Scene(MovingVertices vertices, const Scene& other, const Separation& separation)
    : vertices_(checked(std::move(vertices), other)),
      certified_(with_separation(other.certified_, separation)),
      search_(other.search_),
      bounds_(vertices_, 1.0, separation.distance),
      mesh_(other.mesh_) {}

// ---- Searching ----------------------------------------------------------------------------------

template <std::size_t instants>
Trees<instants> Scene::trees(double end) const {
  Trees<instants> result =
      each(mesh_->groups, [](const PrimitiveGroups& groups) { return BoxTree<instants>(groups); });
  if (end == 1.0) {
    fit_all(result, bounds_);
  } else {
    fit(result, end);
  }
  return result;
}

template Trees<1> Scene::trees<1>(double end) const;
template Trees<2> Scene::trees<2>(double end) const;

template <std::size_t instants>
void Scene::fit(Trees<instants>& trees, double end) const {
  fit_all(trees, FloatBounds(vertices_, end, certified_.separation.distance));
}

template void Scene::fit(Trees<2>& trees, double end) const;

std::vector<SearchPart> Scene::parts(std::size_t groups_of_part) const {
  std::vector<SearchPart> result;
  for (const PairKind kind : all_kinds) {
    const auto& [some, all] = sides(mesh_->groups, kind);
    if (all.size() == 0) continue;
    const std::size_t groups = some.members().size();
    for (std::size_t first = 0; first < groups; first += groups_of_part) {
      result.push_back(
          {.kind = kind, .first = first, .end = std::min(first + groups_of_part, groups)});
    }
  }
  return result;
}

template <std::size_t instants>
PairRules Scene::rules(const Asked& asked) const {
  const bool is_sure = instants == 2 || bounds_.are_exact();
  PairRules rules{.of_edges = asked.kind == PairKind::edge_edge,
                  .certainty = is_sure ? Certainty::all : Certainty::unless_close,
                  .confirms =
                      [](const void* context, const IndexPair& pair) {
                        const auto& of = *static_cast<const Asked*>(context);
                        return of.scene->are_within_separation(of.kind, pair);
                      },
                  .context = &asked};
  if (!mesh_->bodies_of_groups) return rules;
  const auto& [some, all] = sides(*mesh_->bodies_of_groups, asked.kind);
  rules.some_bodies = &some;
  rules.all_bodies = &all;
  rules.bodies_meet = [](const void* context, std::int32_t a, std::int32_t b) {
    return static_cast<const Asked*>(context)->scene->mesh_->bodies.meet(a, b);
  };
  rules.primitives_meet = [](const void* context, const IndexPair& pair) {
    const auto& of = *static_cast<const Asked*>(context);
    const auto [a, b] = of.scene->primitives_of(of.kind, pair);
    return of.scene->mesh_->bodies.meet(a, b);
  };
  return rules;
}

template <std::size_t instants>
void Scene::find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const {
  const Asked asked{.scene = this, .kind = part.kind};
  const auto& [some, all] = sides(trees, part.kind);
  search_.find(SearchInput<instants>{&some, &all, rules<instants>(asked)}, part.first, part.end,
               pairs);
}

template void Scene::find(const Trees<1>& trees, const SearchPart& part, PairBuffer& pairs) const;
template void Scene::find(const Trees<2>& trees, const SearchPart& part, PairBuffer& pairs) const;

// ---- Pairs --------------------------------------------------------------------------------------

IndexPair Scene::reported(PairKind kind, const IndexPair& pair) const {
  const Codimensional& parts = mesh_->codimensional;
  if (kind == PairKind::vertex_edge) return {at(parts.points, pair[0]), at(parts.edges, pair[1])};
  if (kind == PairKind::vertex_vertex) {
    return {at(parts.points, pair[0]), at(parts.points, pair[1])};
  }
  return pair;
}

Candidates Scene::candidates_of(PairKind kind, std::span<const IndexPair> pairs,
                                PairScratch& scratch) const {
  Candidates result{.kind = Step::kind_of(kind),
                    .pairs = pairs,
                    .edges = elements().edges,
                    .faces = elements().faces};
  if (kind == PairKind::vertex_face || kind == PairKind::edge_edge) return result;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    scratch[i] = {at(mesh_->codimensional.points, pairs[i][0]), pairs[i][1]};
  }
  result.pairs = std::span(scratch).first(pairs.size());
  result.faces = kind == PairKind::vertex_edge ? mesh_->edges_as_faces : mesh_->points_as_faces;
  return result;
}

StepCollision collision_of(PairKind kind, const IndexPair& pair, const CertifiedResult& result) {
  const bool has_u = kind != PairKind::vertex_vertex;
  const bool has_v = has_u && kind != PairKind::vertex_edge;
  return {.kind = kind,
          .pair = pair,
          .toi_lower = result.toi_lower,
          .toi_upper = result.toi_upper,
          .u = has_u ? result.u : 0.0,
          .v = has_v ? result.v : 0.0};
}

std::array<std::int32_t, moving_points> Scene::vertices_of(PairKind kind,
                                                           const IndexPair& pair) const {
  const auto [first, second] = pair;
  const auto edge = [this](std::int32_t number) { return at(elements().edges, number); };
  switch (kind) {
    case PairKind::vertex_face: {
      const auto [a, b, c] = at(elements().faces, second);
      return {first, a, b, c};
    }
    case PairKind::edge_edge:
      return {edge(first)[0], edge(first)[1], edge(second)[0], edge(second)[1]};
    case PairKind::vertex_edge:
      return {first, edge(second)[0], edge(second)[1], edge(second)[0]};
    case PairKind::vertex_vertex:
      break;
  }
  return {first, second, second, second};
}

Query Scene::query_of(PairKind kind, const IndexPair& pair) const {
  const auto [a, b, c, d] = vertices_of(kind, pair);
  const std::array<Edge, 2> edges{{{a, b}, {c, d}}};
  const std::array<Face, 1> faces{{{b, c, d}}};
  const Candidates of_one{.kind = Step::kind_of(kind), .pairs = {}, .edges = edges, .faces = faces};
  return fast::query_of(vertices_, of_one,
                        of_one.kind == Kind::edge_edge ? IndexPair{0, 1} : IndexPair{a, 0});
}

std::array<Primitive, 2> Scene::primitives_of(PairKind kind, const IndexPair& pair) const {
  const MeshElements& mesh = elements();
  switch (kind) {
    case PairKind::vertex_face:
      return {primitive_of(pair[0]), primitive_of(at(mesh.faces, pair[1]))};
    case PairKind::edge_edge:
      return {primitive_of(at(mesh.edges, pair[0])), primitive_of(at(mesh.edges, pair[1]))};
    case PairKind::vertex_edge:
      return {at(mesh_->points_as_faces, pair[0]), at(mesh_->edges_as_faces, pair[1])};
    case PairKind::vertex_vertex:
      break;
  }
  return {at(mesh_->points_as_faces, pair[0]), at(mesh_->points_as_faces, pair[1])};
}

bool Scene::are_within_separation(PairKind kind, const IndexPair& pair) const {
  const auto [a, b] = primitives_of(kind, pair);
  return widened(swept_box(vertices_, a), certified_.separation.distance)
      .overlaps(swept_box(vertices_, b));
}

}  // namespace touchstone::fast
