#pragma once

/// \file
/// A step's scene in the form of the search: vertices, primitives in groups, and the bodies
/// that meet.
///
/// **Numbers of pairs.** Internally, a codimensional point or edge has the number of its place in a
/// list of its own; `reported` converts to the numbers of the interface. The certified solver gets
/// the edge of a pair vertex-edge as the face (e0, e1, e0), and the second vertex of a pair
/// vertex-vertex as the face (w, w, w).
///
/// **Thickness.** Boxes are widened by reaches: each vertex has the greatest reach of all
/// primitives that it is a vertex of (Bodies). The pairs of a block are decided by separations,
/// those of one separation at once.
///
/// **Curves.** The step from the least to the greatest coordinates of control points has the swept
/// boxes of the step on curves, so the search with boxes for the whole time is the same.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fast/broad_phase/body_tree.hpp"
#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/candidates.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/curves.hpp"
#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/step/codimensional.hpp"
#include "fast/step/thickness.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// The sorts of primitives in a search, as indices.
struct Sort {
  enum : std::size_t {
    vertices,  ///< all of the elements
    edges,
    faces,
    points,      ///< codimensional ones
    bare_edges,  ///< codimensional ones
    count
  };
};

/// An item for each sort of primitives.
template <class Item>
using OfPrimitives = std::array<Item, Sort::count>;

/// The differences between the kinds of pairs.
struct PairRecord {
  std::size_t some;  ///< the sort of the first primitive
  std::size_t all;   ///< the sort of the second primitive
  bool has_u;        ///< true if a collision has a parameter u, or v
  bool has_v;
};
inline constexpr std::array<PairRecord, 4> pair_records{
    {{Sort::vertices, Sort::faces, true, true},
     {Sort::edges, Sort::edges, true, true},
     {Sort::points, Sort::bare_edges, true, false},
     {Sort::points, Sort::points, false, false}}};
[[nodiscard]] constexpr const PairRecord& record_of(ContactKind kind) {
  return pair_records[static_cast<std::size_t>(kind)];
}

// ---- Intervals of time ---------------------------------------------------------------------------

/// The end time of the boxes, for contacts up to a time: the least power of two that is not below
/// it, with a minimum, because at smaller ones the rounding of places in float would exceed the
/// motion.
[[nodiscard]] double t_end_of(double time);

/// The end of a short interval. Swept boxes suffice there, and need not be fitted again.
inline constexpr double short_end = 0x1p-8;

/// The trees of a scene.
template <std::size_t instants>
using Trees = OfPrimitives<BoxTree<instants>>;

/// The scene on an interval [0, end] of times. With one instant, the boxes are swept ones: they
/// take half the time of those at both ends, and exclude as much if little moves in the interval.
template <std::size_t instants>
struct SceneInterval {
  double end;
  Trees<instants> trees;
  FixedPointVertices rounded;
};

// ---- The search ---------------------------------------------------------------------------------

/// Groups per task: few, because contacts are mostly in a few places, and the task with most of
/// them is the last one to end.
inline constexpr std::size_t groups_of_part = 16;

/// A part of the search for pairs of one kind: groups of the searching tree.
struct SearchPart {
  ContactKind kind;
  std::size_t first;
  std::size_t end;
};

/// The data that do not depend on the places of vertices: steps of one mesh share them.
struct SceneMesh {
  /// \throws as Step.
  SceneMesh(std::size_t vertex_count, Mesh given, const StepOptions& options);
  SceneMesh(const SceneMesh&) = delete;
  SceneMesh& operator=(const SceneMesh&) = delete;
  SceneMesh(SceneMesh&&) = delete;
  SceneMesh& operator=(SceneMesh&&) = delete;
  ~SceneMesh() = default;

  Mesh elements;  ///< with the edges of the faces if none are given
  CollisionGroups groups;
  std::vector<std::int32_t> vertices;  ///< of all elements
  Codimensional codimensional;
  /// The codimensional points and edges as input of the certified solver.
  std::vector<Face> points_as_faces;
  std::vector<Face> edges_as_faces;
  /// The reported numbers of primitives, where they differ from the numbers in the groups.
  OfPrimitives<std::span<const std::int32_t>> numbers;
  /// The second primitives of pairs as input of the certified solver.
  OfPrimitives<std::span<const Face>> as_faces;
  Bodies bodies;
  /// How far boxes are widened at each vertex for the thickness; empty without.
  std::vector<double> reaches;
};

/// The primitives in groups. Their quality depends on the places of the vertices: steps of one mesh
/// share them until the groups are loose.
struct SceneGroups {
  SceneGroups(const SceneMesh& mesh, const FloatBounds& bounds);

  OfPrimitives<PrimitiveGroups> groups;
  std::optional<OfPrimitives<BodyTree>> bodies;  ///< unless all meet
  double looseness;                              ///< at the places for which they were made
};

/// The certified solver's result for a pair that collides, with the numbers of the interface.
[[nodiscard]] StepCollision collision_of(ContactKind kind, const IndexPair& pair,
                                         const CertifiedResult& result);

/// Sorts by kind, then by the numbers of the primitives.
void sort_by_pair(std::vector<StepCollision>& collisions);
void sort_by_number(std::vector<StepInversion>& inversions);

class Scene final : private PairQuestions {
 public:
  /// Uses the threads of the caller's task arena. \throws as Step.
  Scene(Motion vertices, Mesh mesh, const StepOptions& options);
  /// The same mesh at other places, with the same options except t_max, which is 1.
  Scene(Motion vertices, const Scene& other);
  /// The same mesh at other places, with the same options except the separation.
  Scene(Motion vertices, const Scene& other, const Separation& separation);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = delete;
  Scene& operator=(Scene&&) = delete;
  ~Scene() = default;

  [[nodiscard]] const Motion& vertices() const { return vertices_; }
  [[nodiscard]] const Mesh& mesh() const { return mesh_->elements; }
  /// The options of the decisions on pairs without thickness.
  [[nodiscard]] const CertifiedOptions& certified() const { return certified_; }
  [[nodiscard]] bool has_groups_of(const Scene& other) const { return groups_ == other.groups_; }
  [[nodiscard]] const std::atomic<bool>* stop() const { return stop_; }
  [[nodiscard]] const CollisionGroups& groups() const { return mesh_->groups; }
  [[nodiscard]] const std::function<bool(std::int32_t, std::int32_t)>& can_collide() const {
    return mesh_->bodies.can_collide();
  }

  // ---- Searching ----

  /// The trees with boxes around all places of the step.
  [[nodiscard]] Trees<1> swept_trees() const;
  /// \param end As in FloatBounds; on curves 1.
  template <std::size_t instants>
  [[nodiscard]] SceneInterval<instants> up_to(double end) const;

  /// The whole search, kind by kind, in parts of at most that many groups.
  [[nodiscard]] std::vector<SearchPart> parts(std::size_t most_groups) const;

  /// Appends the pairs of a part to the buffer: those that may collide, including all that do up to
  /// the end of the trees' interval.
  template <std::size_t instants>
  void find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const;
  /// Appends exactly the pairs whose swept boxes are within the separation.
  /// \param trees swept_trees()
  void find_candidates(const Trees<1>& trees, const SearchPart& part, PairBuffer& pairs) const;

  // ---- Cells ----

  /// Calls report(inversion), in several threads, for the cells that keep no more than this part
  /// of their volume at times up to limit(), which may fall, and is negative to end the search;
  /// later inversions may be reported, too. Uses the threads of the caller's task arena.
  /// \param options certified(), or others \throws Stopped
  void find_inversions(const CertifiedOptions& options, double kept_volume,
                       const std::function<double()>& limit,
                       const std::function<void(const StepInversion&)>& report) const;
  /// A cell as a tetrahedron.
  [[nodiscard]] Query tetrahedron_of(CellKind kind, std::int32_t cell) const;

  // ---- Pairs ----

  /// The numbers of the interface.
  [[nodiscard]] IndexPair reported(ContactKind kind, const IndexPair& pair) const;

  /// True if the thickness of some pairs is not 0.
  [[nodiscard]] bool has_thickness() const { return mesh_->bodies.has_thickness(); }
  /// A bound of the thickness of all pairs.
  [[nodiscard]] double greatest_thickness() const { return mesh_->bodies.greatest_thickness(); }
  /// The thickness of a pair with the numbers of the interface.
  [[nodiscard]] double thickness_of(ContactKind kind, const IndexPair& pair) const;
  /// Its separation in a step of that separation.
  [[nodiscard]] Separation separation_of(ContactKind kind, const IndexPair& pair,
                                         const Separation& of_step) const {
    return {.distance = of_step.distance + thickness_of(kind, pair), .norm = of_step.norm};
  }

  /// Calls report(place, collision) for each pair that collides, in any order. Contacts after
  /// t_limit, or after the interval of the rounded vertices, may be ignored. On curves, nothing is
  /// rounded.
  template <class Report>
  void decide(ContactKind kind, std::span<const IndexPair> pairs, const FixedPointVertices& rounded,
              double t_limit, const Report& report) const {
    for_each_separation(
        kind, pairs, rounded, certified_.separation, t_limit,
        [&](std::span<const IndexPair> some, const Separation& separation, const Places& place) {
          CertifiedOptions options = certified_;
          options.separation = separation;
          const auto take = [&](std::size_t i, const CertifiedResult& result) {
            if (result.verdict != Verdict::yes) return;
            report(place(i), collision_of(kind, reported(kind, some[i]), result));
          };
          if (!vertices_.is_straight()) {
            const std::vector<double> numbers = numbers_of(kind, some);
            QueryShape shape = vertices_.shape();
            shape.kind = decided_as(kind);
            decide_curves(Queries(shape, numbers), t_limit, options, kernel_, take);
            return;
          }
          PairScratch scratch;
          const Candidates candidates = candidates_of(kind, some, scratch);
          decide_block(
              block_of(candidates, rounded, separation), t_limit, options, kernel_,
              [&](std::size_t i) {
                return fast::query_of(vertices_, candidates, candidates.pairs[i]);
              },
              take);
        });
  }

  /// Calls report(place) for the pairs that collide up to t_limit at a separation, and possibly for
  /// others: those that floating point does not exclude. \param rounded for this separation
  template <class Report>
  void sieve(ContactKind kind, std::span<const IndexPair> pairs, const FixedPointVertices& rounded,
             const Separation& separation, double t_limit, const Report& report) const {
    for_each_separation(
        kind, pairs, rounded, separation, t_limit,
        [&](std::span<const IndexPair> some, const Separation& of_some, const Places& place) {
          sieve_alike(kind, some, rounded, of_some, t_limit,
                      [&](std::size_t i) { report(place(i)); });
        });
  }

  /// The vertices of a pair with the numbers of the interface, and this pair as a query: as in
  /// Step.
  [[nodiscard]] std::array<std::int32_t, moving_points> vertices_of(ContactKind kind,
                                                                    const IndexPair& pair) const;
  [[nodiscard]] Query query_of(ContactKind kind, const IndexPair& pair) const;

 private:
  using PairScratch = std::array<IndexPair, kernel_block>;

  /// The distance of a pair's separation, and the place of the pair in its block.
  using DistanceAndPlace = std::pair<double, std::size_t>;
  /// The places in their block of some of its pairs, or of all.
  struct Places {
    const DistanceAndPlace* of_some = nullptr;

    std::size_t operator()(std::size_t i) const {
      return of_some == nullptr ? i : of_some[i].second;
    }
  };

  /// The rules of the search for pairs of a kind.
  [[nodiscard]] PairRules rules_of(const PairRecord& record, Certainty certainty) const;

  [[nodiscard]] bool confirms(const Primitive& a, const Primitive& b) const override;
  [[nodiscard]] bool bodies_meet(std::int32_t a, std::int32_t b) const override;
  [[nodiscard]] bool primitives_meet(const Primitive& a, const Primitive& b) const override;

  /// The kernel's output for pairs with this separation, valid until the thread's next call.
  [[nodiscard]] const KernelOutput& decided_on_lanes(ContactKind kind,
                                                     std::span<const IndexPair> pairs,
                                                     const FixedPointVertices& rounded,
                                                     const Separation& separation,
                                                     double t_limit) const;
  /// `sieve` for pairs with this separation.
  template <class Report>
  void sieve_alike(ContactKind kind, std::span<const IndexPair> pairs,
                   const FixedPointVertices& rounded, const Separation& separation, double t_limit,
                   const Report& report) const {
    const KernelOutput& output = decided_on_lanes(kind, pairs, rounded, separation, t_limit);
    for (std::size_t i = 0; i < output.impacts.count; ++i) report(output.impacts.items[i].index);
    for (std::size_t i = 0; i < output.undecided.count; ++i) report(output.undecided.items[i]);
  }

  /// Calls take(some, separation, place) for some pairs at a time, all those of one separation in a
  /// step of that separation, where place(i) is the place of some[i] among all. Leaves out pairs
  /// that do not collide up to t_limit by the greatest of several separations: many separations
  /// leave few pairs for each call.
  template <class Take>
  void for_each_separation(ContactKind kind, std::span<const IndexPair> pairs,
                           const FixedPointVertices& rounded, const Separation& of_step,
                           double t_limit, const Take& take) const {
    if (!has_thickness()) {
      take(pairs, of_step, Places{});
      return;
    }
    std::array<double, kernel_block> distances;
    const auto [least, greatest] = find_distances(kind, pairs, of_step, distances);
    if (least == greatest) {
      take(pairs, Separation{greatest, of_step.norm}, Places{});
      return;
    }
    std::vector<DistanceAndPlace> order;
    const auto add = [&](std::size_t place) { order.emplace_back(distances[place], place); };
    if (vertices_.is_straight()) {
      sieve_alike(kind, pairs, rounded, {greatest, of_step.norm}, t_limit, add);
    } else {
      for (std::size_t place = 0; place < pairs.size(); ++place) add(place);
    }
    std::ranges::sort(order);
    std::vector<IndexPair> some;
    for (std::size_t first = 0; first < order.size(); first += some.size()) {
      const double distance = order[first].first;
      some.clear();
      for (std::size_t i = first; i < order.size() && order[i].first == distance; ++i) {
        some.push_back(pairs[order[i].second]);
      }
      take(std::span<const IndexPair>(some), Separation{distance, of_step.norm},
           Places{order.data() + first});
    }
  }

  /// The pairs for the certified solver. \param scratch Memory for the numbers, if they differ.
  [[nodiscard]] Candidates candidates_of(ContactKind kind, std::span<const IndexPair> pairs,
                                         PairScratch& scratch) const;
  /// The pairs as queries on curves: their numbers.
  [[nodiscard]] std::vector<double> numbers_of(ContactKind kind,
                                               std::span<const IndexPair> pairs) const;
  [[nodiscard]] KernelInput block_of(const Candidates& candidates,
                                     const FixedPointVertices& rounded,
                                     const Separation& separation) const;
  /// Finds the distances of pairs' separations. Returns the least and the greatest.
  std::pair<double, double> find_distances(ContactKind kind, std::span<const IndexPair> pairs,
                                           const Separation& of_step,
                                           std::span<double> distances) const;
  [[nodiscard]] FloatBounds bounds_up_to(double end) const;

  Motion vertices_;
  CertifiedOptions certified_;
  const std::atomic<bool>* stop_;
  const CertifiedKernel& kernel_;
  const SearchKernel& search_;
  std::shared_ptr<const SceneMesh> mesh_;
  FloatBounds bounds_;
  std::shared_ptr<const SceneGroups> groups_;
};

/// The distance of primitives, less a thickness, rounded outwards. \pre strict floating point
[[nodiscard]] Distance less(const Distance& distance, double thickness);

/// The scene of a step.
[[nodiscard]] const Scene& scene_of(const Step& step);

/// Calls take(pairs) for the pairs that find(buffer) appends, in the strict floating-point state.
/// \throws Stopped once the scene's stop is true.
template <class Find, class Take>
void for_each_block(const Scene& scene, const Find& find, Take take) {
  const StrictFloatingPoint strict;
  PairSink buffer(std::move(take), scene.stop());
  find(buffer);
  buffer.flush();
}

}  // namespace touchstone::fast
