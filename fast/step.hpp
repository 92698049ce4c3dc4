#pragma once

/// \file
/// A whole step of a scene: is it free, when is the earliest impact, what touches.
///
/// A scene is a mesh before and after, and a rule of what can collide. Its *primitives* are faces, edges and
/// vertices; all vertices move on straight lines from t=0 to t=1. Two primitives that share no vertex and
/// whose groups meet *touch* if they have a common point at some time, or come within the separation.
///
/// **Which pairs are looked at.** Every pair of a vertex and a face (vertex_face) and of two edges (edge_edge)
/// without a common vertex. They tell of all others in an ordinary mesh: a vertex on an edge is on the edge's
/// face, or, if it has an edge itself, the two edges touch. What they do not tell of is looked at by
/// itself:
/// - vertex_edge: a vertex v and an edge e if every face of e has v, and every edge of v shares a vertex with e.
///   So are all codimensional points with all codimensional edges, and the end of a chain of
///   edges with the last but one of them.
/// - vertex_vertex: two vertices if neither has an edge but those between them. So are all codimensional
///   points, and the two ends of an edge by itself.
///
/// Each pair of a kind is found once. **Theorem** (docs/theory.md, section 8): if no edge pierces a face at t=0, then
/// no two primitives without a common vertex touch during the step iff none of these pairs do; and they first touch when
/// the first of these pairs does. (Whether an edge pierces a face at a time is a matter of that state of the mesh: an edge may
/// pass through the inside of a face from beginning to end, far from edges and vertices of its own.)
///
/// **How.** Boxes in float at both ends of the step, rounded outwards, in trees (fast/broad_phase/). A search finds
/// the pairs that no axis separates at both ends the same way round, which excludes a contact; so broad phase and first
/// stage of the certified solver are one, and sixteen pairs are compared at a time before any is
/// written. What is left goes to the certified solver in blocks as it is found. Nothing keeps all pairs: memory is that of the
/// mesh and of what touches. As soon as an impact is known, the earliest one is looked for in [0, that time]
/// only: with boxes at its end, and the solver told so.
///
/// Answers are as exact as the certified solver's, and the same for any number of threads and any instruction set.

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "exact/query.hpp"
#include "fast/certified.hpp"
#include "fast/mesh.hpp"

namespace touchstone::fast {

class Scene;
struct SearchKernel;

/// Which primitives a pair is of, and what its two numbers are.
enum class PairKind : std::uint8_t {
  vertex_face,    ///< a vertex and a face
  edge_edge,      ///< two edges, the smaller number first
  vertex_edge,    ///< a vertex and an edge
  vertex_vertex,  ///< two vertices, the smaller number first
};
inline constexpr std::size_t pair_kinds = 4;

/// "vertex-face" and so on.
[[nodiscard]] std::string_view to_string(PairKind kind);

/// What a scene is made of, by the numbers of vertices. A vertex that none of these names is not part of it.
struct MeshElements {
  /// All edges: those of the faces (fast::edges_of) and codimensional ones, which are in no face. If there are
  /// none, they are the edges of the faces, numbered by edges_of.
  std::span<const Edge> edges;
  std::span<const Face> faces;
  /// Codimensional points: vertices that may be in no edge or face.
  std::span<const std::int32_t> points;
};

/// What can collide. Two primitives do not if no vertex of the one is in a group that meets that of a vertex
/// of the other. As it is made, all vertices are in one group, which meets itself.
struct CollisionGroups {
  /// The group of each vertex, from 0 on; empty: all are in group 0.
  std::span<const std::int32_t> of_vertices;
  /// Two groups each that do not meet, in either order; the same twice: its primitives do not meet
  /// each other, as those of an obstacle need not. All others meet.
  std::span<const std::array<std::int32_t, 2>> apart;
};

struct StepOptions {
  /// What counts as contact: to be this near.
  Separation separation = {};
  /// As CertifiedOptions.
  double toi_tolerance = 1e-12;
  /// Only contacts up to this time count, in [0,1]. (Candidates are those of the whole step.)
  double t_max = 1.0;
  /// 0: as many as there are cores.
  int max_threads = 0;
  CollisionGroups groups = {};
  /// For tests: instead of the best ones for this processor.
  const CertifiedKernel* kernel = nullptr;
  const SearchKernel* search = nullptr;
};

/// Two primitives that touch.
struct StepCollision {
  PairKind kind = PairKind::vertex_face;
  IndexPair pair{};
  /// Around the time of impact, as CertifiedResult.
  double toi_lower = 0.0;
  double toi_upper = 0.0;
  /// Where: as CertifiedResult; of a vertex and an edge, u is the place on the edge and v is 0; of two vertices both are
  /// 0.
  double u = 0.0;
  double v = 0.0;

  friend bool operator==(const StepCollision&, const StepCollision&) = default;
};

/// The earliest impact of a step.
struct StepImpact {
  /// The smallest toi_lower and the smallest toi_upper of all pairs that touch.
  double toi_lower = 0.0;
  double toi_upper = 0.0;
  /// The pairs that touch then, in order: all whose toi_lower is not above that toi_upper. One of them is the
  /// first, and more than one are where impacts cannot be told apart.
  std::vector<StepCollision> pairs;
};

/// Some of a step's candidates.
struct StepCandidates {
  PairKind kind;
  std::span<const IndexPair> pairs;  ///< at most some thousands
};

class Step {
 public:
  /// From the vertices before and after: matrices of any floating-point type and storage order, a row for
  /// each, which are copied. Refers to the elements, not to the groups.
  /// \throws std::invalid_argument unless both are n×3, or for options that make no sense; std::domain_error
  /// naming the first vertex with a coordinate that is NaN or infinite; std::out_of_range naming the first element with an
  /// index that is no vertex's; std::length_error if there are more than 2^31−1 of anything.
  template <class Before, class After>
  Step(const Eigen::MatrixBase<Before>& before, const Eigen::MatrixBase<After>& after,
       const MeshElements& elements, const StepOptions& options = {})
      : Step(MovingVertices(before, after), elements, options) {}

  /// From x, y, z of each vertex in turn, float or double.
  template <class Scalar>
  Step(std::span<const Scalar> before, std::span<const Scalar> after, const MeshElements& elements,
       const StepOptions& options = {})
      : Step(rows(before), rows(after), elements, options) {}

  Step(MovingVertices vertices, const MeshElements& elements, const StepOptions& options = {});

  ~Step();
  Step(Step&& other) noexcept;
  Step& operator=(Step&& other) noexcept;
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  /// The earliest impact; nothing if nothing touches.
  [[nodiscard]] std::optional<StepImpact> earliest() const;

  /// Every pair that touches, by kinds. Their order depends on nothing but the step; pairs that are near in space are
  /// mostly near in the list.
  [[nodiscard]] std::vector<StepCollision> collisions() const;

  /// Does nothing touch?
  [[nodiscard]] bool is_free() const;

  /// Calls take(candidates) for all pairs whose swept boxes are within the separation on every axis (exactly these:
  /// fast/broad_phase.hpp), some at a time, each once. Does not store them. With more than one thread it
  /// is called in several at once, in any order. What it throws ends the search and is handed on.
  void candidates(const std::function<void(const StepCandidates&)>& take) const;

  /// A pair as the certified solver takes it: a vertex and an edge as vertex and face (e0, e1, e0), two vertices
  /// as vertex and face (w, w, w). \pre its numbers are in range.
  [[nodiscard]] static Kind kind_of(PairKind kind) {
    return kind == PairKind::edge_edge ? Kind::edge_edge : Kind::vertex_face;
  }
  [[nodiscard]] Query query_of(PairKind kind, const IndexPair& pair) const;

  [[nodiscard]] const MovingVertices& vertices() const;
  /// All edges that it looks at.
  [[nodiscard]] std::span<const Edge> edges() const;

 private:
  template <class Scalar>
  static auto rows(std::span<const Scalar> coordinates) {
    if (coordinates.size() % 3 != 0) {
      throw std::invalid_argument("vertices: each must have three coordinates");
    }
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(coordinates.data(),
                                  static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  }

  std::unique_ptr<const Scene> scene_;
};

}  // namespace touchstone::fast
