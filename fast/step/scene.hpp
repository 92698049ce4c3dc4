#pragma once

/// \file
/// A step's scene as its answers need it: vertices, primitives in groups, and which of them meet.
///
/// **Numbers of pairs.** Inside, the codimensional points and edges go by their places in lists of
/// their own; `reported` gives the numbers that users see. The certified solver gets an edge that is
/// held against a vertex as the face (e0, e1, e0), and a vertex as the face (w, w, w).

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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
#include "fast/step/codimensional.hpp"

namespace touchstone::fast {

/// Something for each sort of primitives that a search is about.
template <class Item>
struct OfPrimitives {
  Item vertices;  ///< all of the elements
  Item edges;
  Item faces;
  Item points;      ///< codimensional ones
  Item bare_edges;  ///< codimensional ones
};

/// The trees of a scene.
template <std::size_t instants>
using Trees = OfPrimitives<BoxTree<instants>>;

/// A part of the search for pairs of one kind: groups of the tree that searches.
struct SearchPart {
  PairKind kind;
  std::size_t first;
  std::size_t end;
};

/// What does not depend on where the vertices are (but for the groups' quality): steps of one mesh
/// share it.
struct SceneMesh {
  /// Refers to the elements. \throws as Step.
  SceneMesh(std::size_t vertex_count, const FloatBounds& bounds, const MeshElements& given,
            const CollisionGroups& collision_groups);
  SceneMesh(const SceneMesh&) = delete;
  SceneMesh& operator=(const SceneMesh&) = delete;
  SceneMesh(SceneMesh&&) = delete;
  SceneMesh& operator=(SceneMesh&&) = delete;
  ~SceneMesh() = default;

  std::vector<Edge> edges_of_faces;  ///< if no edges are given
  MeshElements elements;
  std::vector<std::int32_t> vertices;  ///< of all elements
  Codimensional codimensional;
  /// The codimensional points and edges as the certified solver gets them.
  std::vector<Face> points_as_faces;
  std::vector<Face> edges_as_faces;
  Bodies bodies;
  OfPrimitives<PrimitiveGroups> groups;
  std::optional<OfPrimitives<BodyTree>> bodies_of_groups;  ///< unless all meet
};

/// What the certified solver says of a pair that touches, with the numbers that users see.
[[nodiscard]] StepCollision collision_of(PairKind kind, const IndexPair& pair,
                                         const CertifiedResult& result);

class Scene {
 public:
  /// Uses the threads of the task arena that it is called in. Refers to the elements.
  /// \throws as Step.
  Scene(MovingVertices vertices, const MeshElements& elements, const StepOptions& options);
  /// The same mesh at other places, with the same options but for t_max, which is 1.
  Scene(MovingVertices vertices, const Scene& other);
  /// The same mesh at other places, with the same options but for the separation.
  Scene(MovingVertices vertices, const Scene& other, const Separation& separation);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = delete;
  Scene& operator=(Scene&&) = delete;
  ~Scene() = default;

  [[nodiscard]] const MovingVertices& vertices() const { return vertices_; }
  [[nodiscard]] const MeshElements& elements() const { return mesh_->elements; }
  [[nodiscard]] const CertifiedOptions& certified() const { return certified_; }

  // ---- Searching ----

  /// The trees with boxes at t=0 and at the time `end`; with one instant, around all places up to
  /// it. \param end as that of FloatBounds
  template <std::size_t instants>
  [[nodiscard]] Trees<instants> trees(double end) const;
  /// Sets the boxes anew.
  template <std::size_t instants>
  void fit(Trees<instants>& trees, double end) const;

  /// Everything that there is to search for, kind by kind, in parts of at most so many groups.
  [[nodiscard]] std::vector<SearchPart> parts(std::size_t groups_of_part) const;

  /// Appends the pairs of a part to the buffer. With one instant: whose swept boxes are within the
  /// separation, exactly these. With two: those that may touch, at least those that do.
  template <std::size_t instants>
  void find(const Trees<instants>& trees, const SearchPart& part, PairBuffer& pairs) const;

  // ---- Pairs ----

  /// The numbers that users see.
  [[nodiscard]] IndexPair reported(PairKind kind, const IndexPair& pair) const;

  /// Hands on which of the pairs that were found touch: report(place, collision), in any order.
  /// Contacts after t_limit are of no interest.
  template <class Report>
  void decide(PairKind kind, std::span<const IndexPair> pairs, double t_limit,
              const Report& report) const {
    PairRoom room;
    const Candidates candidates = candidates_of(kind, pairs, room);
    const KernelInput block{.kind = candidates.kind,
                            .count = pairs.size(),
                            .vertices = vertices_.data(),
                            .edges = candidates.edges.data(),
                            .faces = candidates.faces.data(),
                            .pairs = candidates.pairs.data(),
                            .axis_is_done = true};
    decide_block(
        block, t_limit, certified_,
        [&](std::size_t i) { return fast::query_of(vertices_, candidates, candidates.pairs[i]); },
        [&](std::size_t i, const CertifiedResult& result) {
          if (result.verdict != Verdict::yes) return;
          report(i, collision_of(kind, reported(kind, pairs[i]), result));
        });
  }

  /// The vertices of a pair with the numbers that users see, and this pair as a query: as Step.
  [[nodiscard]] std::array<std::int32_t, moving_points> vertices_of(PairKind kind,
                                                                    const IndexPair& pair) const;
  [[nodiscard]] Query query_of(PairKind kind, const IndexPair& pair) const;

 private:
  using PairRoom = std::array<IndexPair, kernel_block>;

  /// What the search asks about pairs of a kind.
  struct Asked {
    const Scene* scene;
    PairKind kind;
  };

  template <std::size_t instants>
  [[nodiscard]] PairRules rules(const Asked& asked) const;

  /// The pairs for the certified solver. \param room for their numbers, if these are others
  [[nodiscard]] Candidates candidates_of(PairKind kind, std::span<const IndexPair> pairs,
                                         PairRoom& room) const;
  /// The primitives of a pair.
  [[nodiscard]] std::array<Primitive, 2> primitives_of(PairKind kind, const IndexPair& pair) const;
  /// Are their swept boxes within the separation?
  [[nodiscard]] bool are_near(PairKind kind, const IndexPair& pair) const;

  MovingVertices vertices_;
  CertifiedOptions certified_;
  const SearchKernel& search_;
  FloatBounds bounds_;
  std::shared_ptr<const SceneMesh> mesh_;
};

}  // namespace touchstone::fast
