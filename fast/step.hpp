#pragma once

/// \file
/// A whole step of a scene: is it free, when is the earliest impact, and what touches.
///
/// A scene is a mesh before and after, and a rule of what can collide. Its *primitives* are faces,
/// edges and vertices. All vertices move on straight lines from t=0 to t=1. Two primitives *touch*
/// if they have a common point at some time, or come within the separation.
///
/// **Which pairs are looked at.** Those without a common vertex whose groups meet, and that are
/// - a vertex and a face,
/// - two edges,
/// - a codimensional point (a vertex without an edge) and a codimensional edge (of no face),
/// - two codimensional points.
///
/// **Theorem** (docs/theory.md, section 8.3): if no edge meets a face at t=0, but where they share a
/// vertex, then one of these pairs touches when the first two primitives without a common vertex do.
/// One thing is left out: that a vertex touches another vertex or an edge to which a path of one or
/// two edges leads. So the elements around a vertex may fold onto each other, and collapse.
/// (An edge that meets a face at t=0 may do so until t=1, and nothing touches.)
///
/// **How.** Boxes in float at both ends of the step, in trees (fast/broad_phase/). A search finds the
/// pairs that no axis separates at both ends the same way round. An axis that does so excludes a
/// contact. So the broad phase does the work of the certified solver's first stage, for sixteen pairs
/// at a time, before any pair is written. The certified solver decides the others in blocks as they
/// are found. No list of candidates is kept: memory is that of the mesh and
/// of what touches. As soon as an impact is known, `earliest` searches up to that time alone.
///
/// Answers are as exact as the certified solver's (fast/certified.hpp), and the same for any number
/// of threads and any instruction set.

#include <Eigen/Core>

#include <array>
#include <cstddef>
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
  vertex_edge,    ///< a codimensional point and a codimensional edge
  vertex_vertex,  ///< two codimensional points, the smaller number first
};

/// "vertex-face" and so on.
[[nodiscard]] std::string_view to_string(PairKind kind);

/// What a scene is made of, by the numbers of vertices. A vertex that none of these names is not
/// part of it.
struct MeshElements {
  /// All edges: those of the faces and codimensional ones. If there are none, they are the edges of
  /// the faces, numbered as edges_of (fast/broad_phase.hpp) does. One from a vertex to itself touches
  /// what the vertex does.
  std::span<const Edge> edges;
  std::span<const Face> faces;
  /// Vertices that are part of the scene, whether or not an edge or a face has them.
  std::span<const std::int32_t> points;
};

/// What can collide: two primitives can if the group of a vertex of the one meets that of a vertex
/// of the other. Without further ado, all do.
struct CollisionGroups {
  /// The group of each vertex, from 0 on; empty: all are in group 0.
  std::span<const std::int32_t> of_vertices;
  /// Two groups each that do not meet, in either order. The same group twice: its primitives do not
  /// meet each other, as those of an obstacle need not. All others meet.
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
  /// Where, as CertifiedResult. Of a vertex and an edge, u is the place on the edge and v is 0; of
  /// two vertices, both are 0.
  double u = 0.0;
  double v = 0.0;

  friend bool operator==(const StepCollision&, const StepCollision&) = default;
};

/// The earliest impact of a step.
struct StepImpact {
  /// The smallest toi_lower and the smallest toi_upper of all pairs that touch.
  double toi_lower = 0.0;
  double toi_upper = 0.0;
  /// All pairs that touch with a toi_lower up to that toi_upper, in order. The first to touch is
  /// among them; if they are several, their enclosures do not tell which it is.
  std::vector<StepCollision> pairs;

  friend bool operator==(const StepImpact&, const StepImpact&) = default;
};

/// Some of a step's candidates.
struct StepCandidates {
  PairKind kind;
  std::span<const IndexPair> pairs;  ///< a thousand or so at most
};

class Step {
 public:
  /// From the vertices before and after: matrices of any floating-point type and storage order, a
  /// row for each vertex, which are copied. Refers to the elements, not to the groups.
  /// \pre If edges are given, those of all faces are among them.
  /// \throws std::invalid_argument unless both are n×3, or for options that make no sense;
  /// std::domain_error naming the first vertex with a coordinate that is NaN or infinite;
  /// std::out_of_range naming the first element with an index that is no vertex's;
  /// std::length_error if there are more than 2^31−1 of anything.
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

  /// The same mesh at other places, with the same options but for the separation. What does not depend on
  /// places is shared; this step may go before that one does.
  /// \throws std::invalid_argument unless there are as many vertices, or for a separation that makes no
  /// sense; std::domain_error as above.
  [[nodiscard]] Step with_places(MovingVertices vertices, const Separation& separation) const;
  [[nodiscard]] Step with_separation(const Separation& separation) const {
    return with_places(vertices(), separation);
  }

  // ---- Impacts ----

  /// The earliest impact; nothing if nothing touches.
  [[nodiscard]] std::optional<StepImpact> earliest() const;

  /// Every pair that touches, by kinds. Their order depends on nothing but the step; pairs that are
  /// near in space are mostly near in the list.
  [[nodiscard]] std::vector<StepCollision> collisions() const;

  /// Does nothing touch?
  [[nodiscard]] bool is_free() const;

  // ---- The step that is taken ----

  /// The step from x0 to the places that a simulator computes with a step size α in doubles,
  ///
  ///     fl(x0 + fl(α fl(x1 − x0))),   fl: rounded to the nearest double,
  ///
  /// which lie on no straight line to x1 in general. It has the same mesh and options, but for
  /// t_max, which is 1: all of it counts. It does not refer to this step.
  /// \throws std::invalid_argument unless 0 ≤ α ≤ 1; std::domain_error, which names the vertex, if
  /// fl(x1 − x0) overflows, for any α.
  [[nodiscard]] Step scaled(double alpha) const;

  /// A step size as large as can be: a double α in [0,1] such that scaled(α) is free and, unless
  /// α = 1, scaled of the next double is not. Both were decided exactly. Nothing if scaled(0), which
  /// rests, is not free.
  ///
  /// The search begins at the time of the earliest impact. It follows doubles from there, not all of
  /// them: rounding may let a contact of a step be missed by one with a larger α, so that α is not
  /// always the largest at which a step is free, nor is every smaller one free. It takes some dozens
  /// of calls of is_free.
  /// \throws std::domain_error as `scaled`.
  [[nodiscard]] std::optional<double> free_step_size() const;

  // ---- Pairs ----

  /// Calls take(candidates) for all pairs that are looked at whose swept boxes are within the
  /// separation on every axis (exactly these: fast/broad_phase.hpp), some at a time, each once. Does
  /// not store them. With more than one thread, it is called in several at once, in any order. What
  /// it throws ends the search and is handed on.
  void candidates(const std::function<void(const StepCandidates&)>& take) const;

  /// The vertices of a pair as the certified solver takes them: a vertex and an edge as vertex and
  /// face (e0, e1, e0), two vertices as vertex and face (w, w, w). \pre Its numbers are in range.
  [[nodiscard]] std::array<std::int32_t, moving_points> vertices_of(PairKind kind,
                                                                    const IndexPair& pair) const;
  /// A pair as a query, whose points are these vertices. \pre Its numbers are in range.
  [[nodiscard]] Query query_of(PairKind kind, const IndexPair& pair) const;
  [[nodiscard]] static Kind kind_of(PairKind kind) {
    return kind == PairKind::edge_edge ? Kind::edge_edge : Kind::vertex_face;
  }

  [[nodiscard]] const MovingVertices& vertices() const;
  /// How it decides pairs: separation, tolerance, t_max and so on.
  [[nodiscard]] const CertifiedOptions& certified() const;
  /// All edges that it looks at.
  [[nodiscard]] std::span<const Edge> edges() const;

 private:
  explicit Step(std::unique_ptr<const Scene> scene);

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
