#include "fast/step/scene.hpp"

#include <algorithm>
#include <cstddef>
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
MovingVertices checked(MovingVertices vertices, const MeshElements& elements) {
  require_finite(vertices);
  require_in_range(vertices, elements.edges);
  require_in_range(vertices, elements.faces);
  require_in_range(vertices, elements.points);
  return vertices;
}

template <class Items>
const auto& at(const Items& items, std::int32_t index) {
  return items[static_cast<std::size_t>(index)];
}

Face face_of(const Edge& edge) { return {edge[0], edge[1], edge[0]}; }
Face face_of(std::int32_t vertex) { return {vertex, vertex, vertex}; }

/// make(item) of each sort.
template <class Item, class Make>
auto each(const OfPrimitives<Item>& items, const Make& make) {
  return OfPrimitives<decltype(make(items.vertices))>{make(items.vertices), make(items.edges),
                                                      make(items.faces), make(items.isolated),
                                                      make(items.bare_edges)};
}

template <std::size_t instants>
void fit_all(Trees<instants>& trees, const FloatBounds& bounds) {
  trees.vertices.fit(bounds);
  trees.edges.fit(bounds);
  trees.faces.fit(bounds);
  trees.isolated.fit(bounds);
  trees.bare_edges.fit(bounds);
}

/// What is held against what.
template <class Item>
std::pair<const Item&, const Item&> sides(const OfPrimitives<Item>& of, PairKind kind) {
  switch (kind) {
    case PairKind::vertex_face:
      return {of.vertices, of.faces};
    case PairKind::edge_edge:
      return {of.edges, of.edges};
    case PairKind::vertex_edge:
      return {of.isolated, of.bare_edges};
    case PairKind::vertex_vertex:
      break;
  }
  return {of.isolated, of.isolated};
}

}  // namespace

Scene::Scene(MovingVertices vertices, const MeshElements& elements, const StepOptions& options)
    : vertices_(checked(std::move(vertices), elements)),
      edges_of_faces_(elements.edges.empty() ? edges_of(elements.faces) : std::vector<Edge>()),
      elements_{.edges = elements.edges.empty() ? edges_of_faces_ : elements.edges,
                .faces = elements.faces,
                .points = elements.points},
      certified_(certified_options(options)),
      search_(options.search != nullptr ? *options.search : best_search_kernel()),
      classes_(pair_classes(vertices_.size(), elements_)),
      bodies_(vertices_.size(), options.groups),
      bounds_(vertices_) {
  list_edges_and_points();
  std::vector<Edge> bare_edges;
  if (!classes_.isolated.empty()) {
    for (const std::int32_t edge : classes_.bare_edges)
      bare_edges.push_back(at(elements_.edges, edge));
  }
  using Numbers = std::span<const std::int32_t>;
  groups_.emplace(PrimitiveGroups(bounds_, Numbers(classes_.vertices)),
                  PrimitiveGroups(bounds_, elements_.edges),
                  PrimitiveGroups(bounds_, elements_.faces),
                  PrimitiveGroups(bounds_, Numbers(classes_.isolated)),
                  PrimitiveGroups(bounds_, std::span<const Edge>(bare_edges)));
  if (!bodies_.all_meet()) {
    bodies_of_groups_ = each(*groups_, [this](const PrimitiveGroups& groups) {
      return BodyTree(groups, bodies_.of_vertices());
    });
  }
  for (const PairKind kind : all_kinds) asked_[static_cast<std::size_t>(kind)] = {this, kind};
}

void Scene::list_edges_and_points() {
  edge_numbers_ = classes_.bare_edges;
  for (const IndexPair& fold : classes_.folds) edge_numbers_.push_back(fold[1]);
  for (const std::int32_t edge : edge_numbers_) {
    edges_as_faces_.push_back(face_of(at(elements_.edges, edge)));
  }
  points_ = classes_.isolated;
  for (const IndexPair& ends : classes_.lone_ends) points_.push_back(ends[1]);
  std::ranges::sort(points_);
  for (const std::int32_t vertex : points_) points_as_faces_.push_back(face_of(vertex));
}

// ---- Searching ----------------------------------------------------------------------------------

template <std::size_t instants>
Trees<instants> Scene::trees(double end) const {
  Trees<instants> result =
      each(*groups_, [](const PrimitiveGroups& groups) { return BoxTree<instants>(groups); });
  if (end == 1.0) {
    fit_all(result, bounds_);
  } else {
    fit_all(result, FloatBounds(vertices_, end));
  }
  return result;
}

template Trees<1> Scene::trees<1>(double end) const;
template Trees<2> Scene::trees<2>(double end) const;

void Scene::fit(Trees<2>& trees, double end) const { fit_all(trees, FloatBounds(vertices_, end)); }

std::vector<SearchPart> Scene::parts(std::size_t groups_of_part) const {
  static constexpr std::size_t listed_of_part = 256;
  std::vector<SearchPart> result;
  const auto append = [&result](SearchPart part, std::size_t of_part) {
    for (const std::size_t end = part.end; part.first < end; part.first = part.end) {
      part.end = std::min(part.first + of_part, end);
      result.push_back(part);
    }
  };
  for (const PairKind kind : all_kinds) {
    const auto& [some, all] = sides(*groups_, kind);
    if (all.size() == 0) continue;
    append({.kind = kind, .first = 0, .end = some.members().size()}, groups_of_part);
  }
  append({.kind = PairKind::vertex_edge,
          .first = 0,
          .end = classes_.hubs.size() + classes_.folds.size(),
          .is_listed = true},
         listed_of_part);
  append({.kind = PairKind::vertex_vertex,
          .first = 0,
          .end = classes_.lone_ends.size(),
          .is_listed = true},
         listed_of_part);
  return result;
}

template <std::size_t instants>
PairRules Scene::rules(PairKind kind) const {
  const double distance = certified_.separation.distance;
  const bool is_sure = instants == 2 || (bounds_.are_exact() && is_contact(certified_.separation));
  PairRules rules{.of_edges = kind == PairKind::edge_edge,
                  .distance_above = bounds_.scaled_up(distance),
                  .distance_below = bounds_.scaled_down(distance),
                  .certainty = is_sure ? Certainty::all : Certainty::unless_close,
                  .confirms =
                      [](const void* context, const IndexPair& pair) {
                        const auto& asked = *static_cast<const Asked*>(context);
                        return asked.scene->are_near(asked.kind, pair);
                      },
                  .context = &asked_[static_cast<std::size_t>(kind)]};
  if (!bodies_of_groups_) return rules;
  const auto& [some, all] = sides(*bodies_of_groups_, kind);
  rules.some_bodies = &some;
  rules.all_bodies = &all;
  rules.bodies_meet = [](const void* context, std::int32_t a, std::int32_t b) {
    return static_cast<const Asked*>(context)->scene->bodies_.meet(a, b);
  };
  rules.primitives_meet = [](const void* context, const IndexPair& pair) {
    const auto& asked = *static_cast<const Asked*>(context);
    return asked.scene->may_meet(asked.kind, pair);
  };
  return rules;
}

template <class Use>
void Scene::for_each_listed(const SearchPart& part, const Use& use) const {
  for (std::size_t i = part.first; i < part.end; ++i) {
    if (part.kind == PairKind::vertex_vertex) {
      use(classes_.lone_ends[i]);
    } else if (i >= classes_.hubs.size()) {
      const std::size_t fold = i - classes_.hubs.size();
      use({classes_.folds[fold][0], static_cast<std::int32_t>(classes_.bare_edges.size() + fold)});
    } else {
      for (const std::int32_t leaf : classes_.hubs[i].leaves) {
        for (const std::int32_t edge : classes_.hubs[i].edges) {
          if (std::ranges::count(at(edges_as_faces_, edge), leaf) == 0) use({leaf, edge});
        }
      }
    }
  }
}

template <std::size_t instants>
void Scene::find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const {
  if (!part.is_listed) {
    const auto& [some, all] = sides(trees, part.kind);
    search_.find(SearchInput<instants>{&some, &all, rules<instants>(part.kind)}, part.first,
                 part.end, pairs);
    return;
  }
  for_each_listed(part, [&](const IndexPair& pair) {
    if (!may_meet(part.kind, pair)) return;
    if (instants == 1 && !are_near(part.kind, pair)) return;
    if (pairs.count == PairBuffer::capacity) pairs.flush();
    pairs.pairs[pairs.count++] = pair;
  });
}

template void Scene::find(const Trees<1>& trees, const SearchPart& part, PairBuffer& pairs) const;
template void Scene::find(const Trees<2>& trees, const SearchPart& part, PairBuffer& pairs) const;

// ---- Pairs --------------------------------------------------------------------------------------

IndexPair Scene::reported(PairKind kind, const IndexPair& pair) const {
  return kind == PairKind::vertex_edge ? IndexPair{pair[0], at(edge_numbers_, pair[1])} : pair;
}

Candidates Scene::candidates_of(PairKind kind, std::span<const IndexPair> pairs,
                                PairRoom& room) const {
  Candidates result{.kind = Step::kind_of(kind),
                    .pairs = pairs,
                    .edges = elements_.edges,
                    .faces = elements_.faces};
  if (kind == PairKind::vertex_edge) result.faces = edges_as_faces_;
  if (kind != PairKind::vertex_vertex) return result;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto point = std::ranges::lower_bound(points_, pairs[i][1]);
    room[i] = {pairs[i][0], static_cast<std::int32_t>(point - points_.begin())};
  }
  result.pairs = std::span(room).first(pairs.size());
  result.faces = points_as_faces_;
  return result;
}

StepCollision Scene::collision(PairKind kind, const IndexPair& pair,
                               const CertifiedResult& result) const {
  const bool has_u = kind != PairKind::vertex_vertex;
  const bool has_v = has_u && kind != PairKind::vertex_edge;
  return {.kind = kind,
          .pair = reported(kind, pair),
          .toi_lower = result.toi_lower,
          .toi_upper = result.toi_upper,
          .u = has_u ? result.u : 0.0,
          .v = has_v ? result.v : 0.0};
}

Query Scene::query_of(PairKind kind, const IndexPair& pair) const {
  const auto of_face = [&](const Face& face) {
    const Candidates of_one{
        .kind = Kind::vertex_face, .pairs = {}, .edges = {}, .faces = {&face, 1}};
    return fast::query_of(vertices_, of_one, {pair[0], 0});
  };
  if (kind == PairKind::vertex_edge) return of_face(face_of(at(elements_.edges, pair[1])));
  if (kind == PairKind::vertex_vertex) return of_face(face_of(pair[1]));
  const Candidates all{
      .kind = Step::kind_of(kind), .pairs = {}, .edges = elements_.edges, .faces = elements_.faces};
  return fast::query_of(vertices_, all, pair);
}

std::array<Primitive, 2> Scene::primitives_of(PairKind kind, const IndexPair& pair) const {
  switch (kind) {
    case PairKind::vertex_face:
      return {primitive_of(pair[0]), primitive_of(at(elements_.faces, pair[1]))};
    case PairKind::edge_edge:
      return {primitive_of(at(elements_.edges, pair[0])),
              primitive_of(at(elements_.edges, pair[1]))};
    case PairKind::vertex_edge:
      return {primitive_of(pair[0]), at(edges_as_faces_, pair[1])};
    case PairKind::vertex_vertex:
      break;
  }
  return {primitive_of(pair[0]), primitive_of(pair[1])};
}

bool Scene::are_near(PairKind kind, const IndexPair& pair) const {
  const auto [a, b] = primitives_of(kind, pair);
  return widened(swept_box(vertices_, a), certified_.separation.distance)
      .overlaps(swept_box(vertices_, b));
}

bool Scene::may_meet(PairKind kind, const IndexPair& pair) const {
  if (bodies_.all_meet()) return true;
  const auto [a, b] = primitives_of(kind, pair);
  return bodies_.meet(a, b);
}

}  // namespace touchstone::fast
