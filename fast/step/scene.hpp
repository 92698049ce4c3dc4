#pragma once

/// \file
/// A step's scene as its answers need it: vertices, primitives in groups, and which pairs of them are looked at.
///
/// **Numbers of pairs.** Inside, a vertex and an edge are the vertex and the place of the edge in a list of the edges that
/// vertices are held against; the faces (e0, e1, e0) of that list are what the certified solver gets. `reported` gives the
/// numbers that users see.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fast/broad_phase/body_tree.hpp"
#include "fast/broad_phase/box_tree.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/primitive_groups.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/mesh.hpp"
#include "fast/step.hpp"
#include "fast/step/bodies.hpp"
#include "fast/step/pair_classes.hpp"

namespace touchstone::fast {

/// Something for each sort of primitives that a search is about.
template <class Item>
struct OfPrimitives {
  Item vertices;  ///< all of the scene
  Item edges;
  Item faces;
  Item isolated;    ///< vertices without an edge
  Item bare_edges;  ///< in no face; none if no vertex is isolated
};

/// A part of the search for pairs of one kind.
struct SearchPart {
  PairKind kind;
  /// Groups of the tree that searches; or, of pairs that are listed and not searched for, places in the list.
  std::size_t first;
  std::size_t end;
  bool is_listed = false;
};

/// The trees of a scene.
template <std::size_t instants>
using Trees = OfPrimitives<BoxTree<instants>>;

class Scene {
 public:
  /// Uses the threads of the task arena that it is called in. Refers to the elements.
  /// \throws as Step.
  Scene(MovingVertices vertices, const MeshElements& elements, const StepOptions& options);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = delete;
  Scene& operator=(Scene&&) = delete;
  ~Scene() = default;

  [[nodiscard]] const MovingVertices& vertices() const { return vertices_; }
  [[nodiscard]] const MeshElements& elements() const { return elements_; }
  [[nodiscard]] const CertifiedOptions& certified() const { return certified_; }

  // ---- Searching ----

  /// The trees with boxes at t=0 and at the time `end` (of one instant: around all places up to it), a power of two.
  template <std::size_t instants>
  [[nodiscard]] Trees<instants> trees(double end) const;
  /// Sets the boxes anew.
  void fit(Trees<2>& trees, double end) const;

  /// Everything that there is to search for, kind by kind, in parts of at most so many groups.
  [[nodiscard]] std::vector<SearchPart> parts(std::size_t groups_of_part) const;

  /// Appends the pairs of a part to the buffer. With one instant: whose swept boxes are within the separation, exactly
  /// these. With two: those that may touch, at least those that do.
  template <std::size_t instants>
  void find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const;

  // ---- Pairs ----

  /// The numbers that users see.
  [[nodiscard]] IndexPair reported(PairKind kind, const IndexPair& pair) const;

  /// Hands on which of the pairs that were found together touch, if that may be up to t_limit: report(place, collision), in any
  /// order. \param is_listed of the part that they are from
  template <class Report>
  void decide(PairKind kind, std::span<const IndexPair> pairs, bool is_listed, double t_limit,
              const Report& report) const {
    PairRoom room;
    const Candidates candidates = candidates_of(kind, pairs, room);
    const KernelInput block{.kind = candidates.kind,
                            .count = pairs.size(),
                            .vertices = vertices_.data(),
                            .edges = candidates.edges.data(),
                            .faces = candidates.faces.data(),
                            .pairs = candidates.pairs.data(),
                            .axis_is_done = !is_listed};
    decide_block(
        block, t_limit, certified_,
        [&](std::size_t i) { return fast::query_of(vertices_, candidates, candidates.pairs[i]); },
        [&](std::size_t i, const CertifiedResult& result) {
          if (result.verdict == Verdict::yes) report(i, collision(kind, pairs[i], result));
        });
  }

  /// A pair with the numbers that users see, as a query.
  [[nodiscard]] Query query_of(PairKind kind, const IndexPair& pair) const;

 private:
  using PairRoom = std::array<IndexPair, kernel_block>;

  /// What the search asks about pairs of a kind.
  struct Asked {
    const Scene* scene = nullptr;
    PairKind kind = PairKind::vertex_face;
  };

  void list_edges_and_points();

  template <std::size_t instants>
  [[nodiscard]] PairRules rules(PairKind kind) const;
  template <std::size_t instants>
  [[nodiscard]] SearchInput<instants> input(const Trees<instants>& trees, PairKind kind) const;
  /// Calls use(pair) for the pairs of a listed part.
  template <class Use>
  void for_each_listed(const SearchPart& part, const Use& use) const;

  /// The pairs for the certified solver. \param room for their numbers, if these are others
  [[nodiscard]] Candidates candidates_of(PairKind kind, std::span<const IndexPair> pairs,
                                         PairRoom& room) const;
  [[nodiscard]] StepCollision collision(PairKind kind, const IndexPair& pair,
                                        const CertifiedResult& result) const;

  /// The primitives of a pair.
  [[nodiscard]] std::array<Primitive, 2> primitives_of(PairKind kind, const IndexPair& pair) const;
  /// Are their swept boxes within the separation?
  [[nodiscard]] bool are_near(PairKind kind, const IndexPair& pair) const;
  [[nodiscard]] bool may_meet(PairKind kind, const IndexPair& pair) const;

  MovingVertices vertices_;
  std::vector<Edge> edges_of_faces_;  ///< if no edges are given
  MeshElements elements_;
  CertifiedOptions certified_;
  const SearchKernel& search_;
  PairClasses classes_;
  Bodies bodies_;
  /// The edges that vertices are held against, those in no face and then those of folds: what the solver gets, and their
  /// numbers.
  std::vector<Face> edges_as_faces_;
  std::vector<std::int32_t> edge_numbers_;
  /// The vertices that vertices are held against, in order, and what the solver gets.
  std::vector<std::int32_t> points_;
  std::vector<Face> points_as_faces_;

  FloatBounds bounds_;
  std::optional<OfPrimitives<PrimitiveGroups>> groups_;
  std::optional<OfPrimitives<BodyTree>> bodies_of_groups_;
  std::array<Asked, pair_kinds> asked_;
};

}  // namespace touchstone::fast
