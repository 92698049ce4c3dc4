#include "fast/step/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "fast/broad_phase/swept_box.hpp"
#include "fast/cells/decision.hpp"
#include "fast/kernels.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/broad_phase.hpp"

namespace touchstone::fast {
namespace {

/// \throws as Step.
CertifiedOptions with_separation(CertifiedOptions options, const Separation& separation) {
  options.separation = separation;
  require_valid(options);
  return options;
}

/// \throws std::invalid_argument if a separation overflows.
std::shared_ptr<const SceneMesh> checked(std::shared_ptr<const SceneMesh> mesh,
                                         const Separation& separation) {
  if (!std::isfinite(separation.distance + mesh->bodies.greatest_thickness())) {
    throw std::invalid_argument("step: the separation of a pair would be infinite");
  }
  return mesh;
}

void require_cells_on_lines(const Motion& vertices, const Mesh& mesh) {
  for (const CellKind kind : cell_kinds) {
    if (mesh.count_of(kind) > 0) require_straight(vertices, "step: cells");
  }
}

/// \throws as Step.
Motion checked(Motion vertices, const Mesh& mesh) {
  require_cells_on_lines(vertices, mesh);
  require_finite(vertices);
  require_in_range(vertices, mesh.edges);
  require_in_range(vertices, mesh.faces);
  require_in_range(vertices, mesh.points);
  require_cells_in_range(vertices, mesh);
  return vertices;
}

Motion checked(Motion vertices, const Scene& other) {
  if (vertices.size() != other.vertices().size()) {
    throw std::invalid_argument("step: there must be as many vertices as before");
  }
  require_cells_on_lines(vertices, other.mesh());
  require_finite(vertices);
  return vertices;
}

template <class Items>
const auto& at(const Items& items, std::int32_t index) {
  return items[static_cast<std::size_t>(index)];
}

/// The mesh with the edges of its faces, if it has no edges.
Mesh with_edges(Mesh mesh) {
  if (mesh.edges.empty()) mesh.edges = edges_of(mesh.faces);
  return mesh;
}

/// Applies `make` to the item of each sort.
template <class Item, class Make>
auto each(const OfPrimitives<Item>& items, const Make& make) {
  const auto& [vertices, edges, faces, points, bare_edges] = items;
  return OfPrimitives<decltype(make(vertices))>{make(vertices), make(edges), make(faces),
                                                make(points), make(bare_edges)};
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

OfPrimitives<PrimitiveGroups> groups_of(const SceneMesh& mesh, const FloatBounds& bounds) {
  OfPrimitives<PrimitiveGroups> groups;
  const auto make = [&]<class Element>(std::size_t sort, std::span<const Element> elements) {
    groups[sort] = PrimitiveGroups(bounds, elements);
  };
  // At the same time: the first divisions of a sort are of one task.
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t sort) {
    const StrictFloatingPoint strict;
    if (sort == Sort::vertices) return make(sort, std::span(mesh.vertices));
    if (sort == Sort::edges) return make(sort, std::span(mesh.elements.edges));
    make(sort, mesh.as_faces[sort]);
  });
  return groups;
}

template <std::size_t instants>
Trees<instants> trees_of(const OfPrimitives<PrimitiveGroups>& groups, const FloatBounds& bounds) {
  return each(groups, [&bounds](const PrimitiveGroups& some) {
    BoxTree<instants> tree(some);
    tree.fit(bounds);
    return tree;
  });
}

}  // namespace

// ---- The mesh -----------------------------------------------------------------------------------

SceneMesh::SceneMesh(std::size_t vertex_count, Mesh given, const StepOptions& options)
    : elements(with_edges(std::move(given))),
      groups(options.groups),
      vertices(vertices_of(vertex_count, elements)),
      codimensional(fast::codimensional(vertex_count, vertices, elements)),
      points_as_faces(fast::as_faces(codimensional.points)),
      edges_as_faces(fast::as_faces(codimensional.edges, elements.edges)),
      numbers{{{}, {}, {}, codimensional.points, codimensional.edges}},
      as_faces{{{}, {}, elements.faces, points_as_faces, edges_as_faces}},
      bodies(vertex_count, groups, options.can_collide),
      reaches(bodies.reaches()) {
  if (!bodies.has_thickness()) return;
  const std::vector<double> of_vertices = reaches;
  const auto widen = [&](const auto& element) {
    double reach = 0.0;
    for (const std::int32_t vertex : element) reach = std::max(reach, at(of_vertices, vertex));
    for (const std::int32_t vertex : element) {
      double& known = reaches[static_cast<std::size_t>(vertex)];
      known = std::max(known, reach);
    }
  };
  std::ranges::for_each(elements.edges, widen);
  std::ranges::for_each(elements.faces, widen);
}

// ---- The groups ---------------------------------------------------------------------------------

namespace {

/// The size of boxes around groups, in proportion to that of their primitives: the sums of the
/// boxes' extents at t=0, for a sample of the groups. Of points alone, the groups' sum.
double looseness_of(const PrimitiveGroups& groups, const FloatBounds& bounds) {
  static constexpr std::size_t stride = 16;
  double of_groups = 0.0, of_primitives = 0.0;
  for (std::size_t i = 0; i < groups.members().size(); i += stride) {
    const GroupMembers& members = groups.members()[i];
    const auto extent = [](const FloatRow& lower, const FloatRow& upper) {
      const FloatRow size = upper - lower;
      return static_cast<double>(size[0] + size[1] + size[2]);
    };
    const auto vertex = [&](std::size_t corner, std::size_t lane) -> const VertexBounds& {
      return bounds[static_cast<std::size_t>(members.vertices[corner][lane])];
    };
    FloatRow group_lower = vertex(0, 0).lower[0], group_upper = vertex(0, 0).upper[0];
    for (std::size_t lane = 0; lane < group_size; ++lane) {
      FloatRow lower = vertex(0, lane).lower[0], upper = vertex(0, lane).upper[0];
      for (std::size_t corner = 1; corner < 3; ++corner) {
        lower = least(lower, vertex(corner, lane).lower[0]);
        upper = greatest(upper, vertex(corner, lane).upper[0]);
      }
      of_primitives += extent(lower, upper);
      group_lower = least(group_lower, lower);
      group_upper = greatest(group_upper, upper);
    }
    of_groups += extent(group_lower, group_upper);
  }
  return of_primitives > 0.0 ? of_groups / of_primitives : of_groups;
}

double looseness_of(const OfPrimitives<PrimitiveGroups>& groups, const FloatBounds& bounds) {
  return looseness_of(groups[groups[Sort::edges].size() > 0 ? Sort::edges : Sort::vertices],
                      bounds);
}

/// The same groups, or new ones if they have become loose.
std::shared_ptr<const SceneGroups> still_tight(const std::shared_ptr<const SceneGroups>& groups,
                                               const SceneMesh& mesh, const FloatBounds& bounds) {
  // Looser groups cost more in each search than new ones.
  static constexpr double loose = 1.3;
  if (!(looseness_of(groups->groups, bounds) > loose * groups->looseness)) return groups;
  return std::make_shared<const SceneGroups>(mesh, bounds);
}

}  // namespace

SceneGroups::SceneGroups(const SceneMesh& mesh, const FloatBounds& bounds)
    : groups(groups_of(mesh, bounds)), looseness(looseness_of(groups, bounds)) {
  if (mesh.bodies.all_meet()) return;
  bodies = each(groups, [&mesh](const PrimitiveGroups& some) {
    return BodyTree(some, mesh.bodies.of_vertices(), mesh.bodies.has_rule_for_vertices());
  });
}

// ---- The scene ----------------------------------------------------------------------------------

Scene::Scene(Motion vertices, Mesh mesh, const StepOptions& options)
    : vertices_(checked(std::move(vertices), mesh)),
      certified_(options.solve),
      stop_(options.stop),
      kernel_(certified_kernel(certified_.kernels)),
      search_(search_kernel(certified_.kernels)),
      mesh_(checked(std::make_shared<const SceneMesh>(vertices_.size(), std::move(mesh), options),
                    certified_.separation)),
      bounds_(bounds_up_to(1.0)),
      groups_(std::make_shared<const SceneGroups>(*mesh_, bounds_)) {}

Scene::Scene(Motion vertices, const Scene& other)
    : Scene(std::move(vertices), other, other.certified_.separation) {
  certified_.t_max = 1.0;
}

Scene::Scene(Motion vertices, const Scene& other, const Separation& separation)
    : vertices_(checked(std::move(vertices), other)),
      certified_(with_separation(other.certified_, separation)),
      stop_(other.stop_),
      kernel_(other.kernel_),
      search_(other.search_),
      mesh_(checked(other.mesh_, separation)),
      bounds_(bounds_up_to(1.0)),
      groups_(still_tight(other.groups_, *mesh_, bounds_)) {}

// ---- Searching ----------------------------------------------------------------------------------

double t_end_of(double time) {
  constexpr double least_t_end = 0x1p-40;
  if (time <= least_t_end) return least_t_end;
  int exponent = 0;
  const double fraction = std::frexp(time, &exponent);
  return std::ldexp(1.0, fraction == 0.5 ? exponent - 1 : exponent);
}

FloatBounds Scene::bounds_up_to(double end) const {
  // Cells alone do not collide.
  if (mesh_->vertices.empty()) return FloatBounds(Motion(Eigen::MatrixX3d(), Eigen::MatrixX3d()));
  return FloatBounds(vertices_, end, certified_.separation.distance, mesh_->reaches);
}

Trees<1> Scene::swept_trees() const { return trees_of<1>(groups_->groups, bounds_); }

template <std::size_t instants>
SceneInterval<instants> Scene::up_to(double end) const {
  return {.end = end,
          .trees = end == 1.0 ? trees_of<instants>(groups_->groups, bounds_)
                              : trees_of<instants>(groups_->groups, bounds_up_to(end)),
          .rounded = vertices_.is_straight()
                         ? fixed_point_vertices(vertices_, end, certified_.separation.distance)
                         : FixedPointVertices{}};
}

template SceneInterval<1> Scene::up_to<1>(double end) const;
template SceneInterval<2> Scene::up_to<2>(double end) const;

std::vector<SearchPart> Scene::parts(std::size_t most_groups) const {
  std::vector<SearchPart> result;
  for (std::size_t kind = 0; kind < pair_records.size(); ++kind) {
    const PrimitiveGroups& some = groups_->groups[pair_records[kind].some];
    const PrimitiveGroups& all = groups_->groups[pair_records[kind].all];
    if (all.size() == 0) continue;
    const std::size_t groups = some.members().size();
    for (std::size_t first = 0; first < groups; first += most_groups) {
      result.push_back({.kind = static_cast<ContactKind>(kind),
                        .first = first,
                        .end = std::min(first + most_groups, groups)});
    }
  }
  return result;
}

PairRules Scene::rules_of(const PairRecord& record, Certainty certainty) const {
  PairRules rules{
      .of_edges = record.some == Sort::edges, .certainty = certainty, .questions = this};
  if (groups_->bodies) {
    rules.some_bodies = &(*groups_->bodies)[record.some];
    rules.all_bodies = &(*groups_->bodies)[record.all];
  }
  return rules;
}

template <std::size_t instants>
void Scene::find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const {
  const PairRecord& record = record_of(part.kind);
  search_.find(SearchInput<instants>{&trees[record.some], &trees[record.all],
                                     rules_of(record, Certainty::all)},
               part.first, part.end, pairs);
}

template void Scene::find(const Trees<1>& trees, const SearchPart& part, PairBuffer& pairs) const;
template void Scene::find(const Trees<2>& trees, const SearchPart& part, PairBuffer& pairs) const;

void Scene::find_candidates(const Trees<1>& trees, const SearchPart& part,
                            PairBuffer& pairs) const {
  const PairRecord& record = record_of(part.kind);
  const Certainty certainty = has_thickness()       ? Certainty::none
                              : bounds_.are_exact() ? Certainty::all
                                                    : Certainty::unless_close;
  search_.find(SearchInput<1>{&trees[record.some], &trees[record.all], rules_of(record, certainty)},
               part.first, part.end, pairs);
}

bool Scene::confirms(const Primitive& a, const Primitive& b) const {
  const double thickness = has_thickness() ? mesh_->bodies.thickness(a, b) : 0.0;
  return are_within_distance(vertices_, a, b, certified_.separation.distance + thickness);
}

bool Scene::bodies_meet(std::int32_t a, std::int32_t b) const { return mesh_->bodies.meet(a, b); }

bool Scene::primitives_meet(const Primitive& a, const Primitive& b) const {
  // The vertices without those that stand for a missing second or third one.
  const auto vertices = [](const Primitive& primitive) {
    const auto& [first, second, third] = primitive;
    const std::size_t count = third != first && third != second ? 3 : second != first ? 2 : 1;
    return std::span(primitive).first(count);
  };
  return mesh_->bodies.meet(vertices(a), vertices(b));
}

// ---- Cells --------------------------------------------------------------------------------------

void Scene::find_inversions(const CertifiedOptions& options, double kept_volume,
                            const std::function<double()>& limit,
                            const std::function<void(const StepInversion&)>& report) const {
  const InversionOptions of_cells{.toi_tolerance = options.toi_tolerance, .t_max = options.t_max};
  for (const CellKind kind : cell_kinds) {
    const std::span corners = mesh().corners_of(kind);
    const std::size_t size = mesh().count_of(kind);
    tbb::parallel_for(std::size_t{0}, (size + kernel_block - 1) / kernel_block, [&](std::size_t i) {
      if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Stopped();
      const double t_limit = limit();
      if (t_limit < 0.0) return;
      const StrictFloatingPoint strict;
      const std::size_t first = i * kernel_block;
      const auto number = [&](std::size_t index) {
        return static_cast<std::int32_t>(first + index);
      };
      decide_cells(
          {.kind = kind,
           .count = std::min(kernel_block, size - first),
           .vertices = vertices_.data(),
           .corners = corners.data() + first * record_of(kind).point_count,
           .kept_volume = kept_volume},
          t_limit, of_cells, kernel_,
          [&](std::size_t index) { return tetrahedron_of(kind, number(index)); },
          [&](std::size_t index, const Inversion& result) {
            if (result.verdict != Verdict::yes) return;
            report({.kind = kind,
                    .cell = number(index),
                    .start = result.start,
                    .toi_lower = result.toi_lower,
                    .toi_upper = result.toi_upper});
          });
    });
  }
}

Query Scene::tetrahedron_of(CellKind kind, std::int32_t cell) const {
  const std::size_t count = record_of(kind).point_count;
  const std::span corners =
      mesh().corners_of(kind).subspan(static_cast<std::size_t>(cell) * count, count);
  Tetrahedron points{};
  std::ranges::copy(corners, points.begin());
  return to_tetrahedron(kind, fast::query_of(vertices_, points));
}

// ---- Pairs --------------------------------------------------------------------------------------

IndexPair Scene::reported(ContactKind kind, const IndexPair& pair) const {
  const PairRecord& record = record_of(kind);
  if (record.some != Sort::points) return pair;
  return {at(mesh_->numbers[record.some], pair[0]), at(mesh_->numbers[record.all], pair[1])};
}

Candidates Scene::candidates_of(ContactKind kind, std::span<const IndexPair> pairs,
                                PairScratch& scratch) const {
  const PairRecord& record = record_of(kind);
  Candidates result{.kind = decided_as(kind),
                    .pairs = pairs,
                    .edges = mesh().edges,
                    .faces = mesh_->as_faces[record.all]};
  const auto& numbers = mesh_->numbers[record.some];
  if (numbers.empty()) return result;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    scratch[i] = {at(numbers, pairs[i][0]), pairs[i][1]};
  result.pairs = std::span(scratch).first(pairs.size());
  return result;
}

std::vector<double> Scene::numbers_of(ContactKind kind, std::span<const IndexPair> pairs) const {
  const QueryShape& shape = vertices_.shape();
  const std::size_t size = shape.numbers_of_point();
  std::vector<double> numbers;
  numbers.reserve(pairs.size() * shape.numbers_of_query());
  for (const IndexPair& pair : pairs) {
    const auto of_pair = vertices_of(kind, reported(kind, pair));
    for (std::size_t k = 0; k <= shape.degree; ++k) {
      for (const std::int32_t vertex : of_pair) {
        const auto point =
            vertices_.control_points(static_cast<std::size_t>(vertex)).subspan(k * size, size);
        numbers.insert(numbers.end(), point.begin(), point.end());
      }
    }
  }
  return numbers;
}

KernelInput Scene::block_of(const Candidates& candidates, const FixedPointVertices& rounded,
                            const Separation& separation) const {
  const float distance =
      has_thickness() ? rounded.distance_for(separation.distance) : rounded.distance;
  const bool is_usual = distance < std::numeric_limits<float>::infinity();
  return {.kind = candidates.kind,
          .count = candidates.pairs.size(),
          .vertices = vertices_.data(),
          .edges = candidates.edges.data(),
          .faces = candidates.faces.data(),
          .pairs = candidates.pairs.data(),
          .axis_is_done = true,
          .rounded = is_usual ? rounded.vertices.data() : nullptr,
          .rounded_distance = distance};
}

double Scene::thickness_of(ContactKind kind, const IndexPair& pair) const {
  if (!has_thickness()) return 0.0;
  const auto vertices = vertices_of(kind, pair);
  const std::span all(vertices);
  const std::size_t of_first = decided_as(kind) == ContactKind::edge_edge ? 2 : 1;
  return mesh_->bodies.thickness(all.first(of_first), all.subspan(of_first));
}

std::pair<double, double> Scene::find_distances(ContactKind kind, std::span<const IndexPair> pairs,
                                                const Separation& of_step,
                                                std::span<double> distances) const {
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    distances[i] = separation_of(kind, reported(kind, pairs[i]), of_step).distance;
    least = std::min(least, distances[i]);
    greatest = std::max(greatest, distances[i]);
  }
  return {least, greatest};
}

const KernelOutput& Scene::decided_on_lanes(ContactKind kind, std::span<const IndexPair> pairs,
                                            const FixedPointVertices& rounded,
                                            const Separation& separation, double t_limit) const {
  thread_local KernelOutput output;
  PairScratch scratch;
  KernelInput block = block_of(candidates_of(kind, pairs, scratch), rounded, separation);
  block.separation = separation;
  block.t_limit = t_limit;
  kernel_.decide(block, output);
  return output;
}

StepCollision collision_of(ContactKind kind, const IndexPair& pair, const CertifiedResult& result) {
  const PairRecord& record = record_of(kind);
  return {.kind = kind,
          .pair = pair,
          .toi_lower = result.toi_lower,
          .toi_upper = result.toi_upper,
          .u = record.has_u ? result.u : 0.0,
          .v = record.has_v ? result.v : 0.0};
}

void sort_by_pair(std::vector<StepCollision>& collisions) {
  std::ranges::sort(collisions, [](const StepCollision& a, const StepCollision& b) {
    return std::tie(a.kind, a.pair) < std::tie(b.kind, b.pair);
  });
}

void sort_by_number(std::vector<StepInversion>& inversions) {
  std::ranges::sort(inversions, [](const StepInversion& a, const StepInversion& b) {
    return std::tie(a.kind, a.cell) < std::tie(b.kind, b.cell);
  });
}

Distance less(const Distance& distance, double thickness) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (thickness == 0.0) return distance;
  // The error of a difference of doubles [knuth1997].
  const auto error = [thickness](double from, double difference) {
    const double subtracted = from - difference, kept = difference + subtracted;
    return (from - kept) + (subtracted - thickness);
  };
  Distance result{distance.lower - thickness, distance.upper - thickness};
  if (error(distance.lower, result.lower) < 0.0) {
    result.lower = std::nextafter(result.lower, -infinity);
  }
  if (distance.upper < infinity && error(distance.upper, result.upper) > 0.0) {
    result.upper = std::nextafter(result.upper, infinity);
  }
  return result;
}

std::array<std::int32_t, moving_points> Scene::vertices_of(ContactKind kind,
                                                           const IndexPair& pair) const {
  const auto [first, second] = pair;
  const PairRecord& record = record_of(kind);
  if (record.all == Sort::points) return {first, second, second, second};
  if (record.all == Sort::faces) {
    const auto [a, b, c] = at(mesh().faces, second);
    return {first, a, b, c};
  }
  const auto [a, b] = at(mesh().edges, second);
  if (record.all == Sort::bare_edges) return {first, a, b, a};
  const auto [c, d] = at(mesh().edges, first);
  return {c, d, a, b};
}

Query Scene::query_of(ContactKind kind, const IndexPair& pair) const {
  return fast::query_of(vertices_, vertices_of(kind, pair));
}

}  // namespace touchstone::fast
