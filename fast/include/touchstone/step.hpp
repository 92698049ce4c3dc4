#pragma once

/// \file
/// A whole step of a scene: freedom from collisions and inversions, the earliest impact, and all of
/// them.
///
/// \code{.cpp}
/// // One triangle falls onto another one.
/// #include <touchstone/step.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   const Eigen::MatrixX3d before{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},
///                                 {1, 1, 1}, {2, 1, 2}, {1, 2, 2}};
///   Eigen::MatrixX3d after = before;
///   after.bottomRows<3>().col(2).array() -= 3;
///   const std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}};
///   const fast::Step step(before, after, {.faces = faces});
///
///   if (step.is_free()) return 0;
///   for (const fast::StepCollision& one : step.collisions()) {
///     if (one.kind == ContactKind::edge_edge) continue;
///     std::printf("vertex %d meets face %d at %.6f\n", one.pair[0], one.pair[1], one.toi_lower);
///   }
///   const double first = step.earliest()->toi_upper;  // at most 1e-12 above the exact time
///   const double alpha = *step.free_step_size();      // the step to x0 + alpha (x1 - x0) is free
///   std::printf("a free step ends before %.6f: %s\n", first, alpha < first ? "true" : "false");
/// }
/// // vertex 3 meets face 0 at 0.333333
/// // vertex 4 meets face 0 at 0.666667
/// // vertex 5 meets face 0 at 0.666667
/// // a free step ends before 0.333333: true
/// \endcode
///
/// A scene is a mesh before and after the step, and rules for the pairs that can collide. Its
/// *primitives* are faces, edges and vertices. All vertices move on straight lines from t=0 to t=1,
/// or on curves. Two primitives *collide* if they have a common point at some time, or come within
/// the separation.
///
/// **Pairs in the search.** The pairs without a common vertex that the rules let collide and that
/// are
/// - a vertex and a face,
/// - two edges,
/// - a codimensional point (a vertex without an edge) and a codimensional edge (of no face),
/// - two codimensional points.
///
/// **Theorem** (docs/theory.md, section 8.3): if at t=0 no edge meets a face except at a shared
/// vertex, then at the first contact of two primitives without a common vertex one of these pairs
/// is in contact, too. The theorem does not cover contact of a vertex with a vertex or an edge of
/// its own 2-ring: the elements around a vertex may fold onto each other, and collapse. (An edge
/// that pierces a face at t=0 may do so until t=1 without a collision. `starts_free` tells whether
/// there is one.)
///
/// **Method.** Trees hold boxes in float at both ends of the step (fast/broad_phase/). An axis that
/// separates a pair at both ends, in the same order, excludes a contact; a search finds the pairs
/// without such an axis. The broad phase thereby does the work of the certified solver's first
/// stage, for sixteen pairs at a time, before any pair is written. The certified solver decides the
/// remaining pairs in blocks as they are found. No list of candidates is kept: memory is
/// proportional to the mesh and the collisions. (A process keeps up to 64 MiB of the memory of its
/// steps for the next ones.) `earliest` tries a part of the pairs on [0, 2^-8] first, since steps
/// with contacts mostly have early ones; as soon as an impact is known, it searches only up to its
/// time.
///
/// **Radii.** Groups may have radii: in L2 vertices then are spheres and edges capsules. The
/// *thickness* of a pair is the greatest sum fl(r + s) of the radius r of a vertex of one primitive
/// and the radius s of a vertex of the other, or the distance that is given for their two groups in
/// its place. The separation of the pair is fl(D + thickness), where D is the separation of the
/// step and fl rounds to the nearest double. So a step with radii is in contact where the thick
/// primitives are within D. Steps made from a step keep the radii, and distances, active sets and
/// limits of line searches are those of thick primitives, too (touchstone/contacts.hpp). A box is
/// widened by its primitive's own part; the pairs of a block are decided by separations.
///
/// **Cells.** A scene may have tetrahedra and triangles of the plane, whose volumes and areas are
/// to stay positive (touchstone/cell.hpp). One *inverts* if its volume is 0 or negative at some
/// time; `earliest`, `is_free`, `starts_free`, `scaled`, `free_step_size` and limits of line
/// searches count this as they count collisions, as exactly, and name the cells in lists of
/// their own. A cell that is flat or inverted at the start inverts at time 0, and its `start`
/// says so. All are examined by their volumes on lanes before the search for pairs
/// (docs/theory.md, section 10), which then ends at the first inversion. Cells do not collide;
/// the surface of a solid does, if it is given as faces.
///
/// **On curves** (Motion) a vertex stays in the box around its control points, so a primitive stays
/// in the box around those of its vertices; the candidates are the pairs of primitives whose boxes
/// are within the separation. The pairs that can collide are the same: the theorem is about the
/// geometry at one time. Cells, step sizes, queries of pairs, distances, contacts,
/// limits of line searches and certificates need straight lines: on curves, they throw
/// std::invalid_argument.
///
/// Answers are as exact as the certified solver's (touchstone/certified.hpp), and the same for any
/// number of threads and any instruction set. Functions and const member functions are thread-safe.
///
/// A step owns its places, mesh and groups; the steps made from it share the mesh and the groups.

#include <Eigen/Core>

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

class Scene;
struct Intersection;

struct StepOptions {
  /// The options of the decisions. Primitives within the separation, and the thickness of their
  /// pair, are in contact. (`candidates` covers the whole step, whatever t_max is.)
  CertifiedOptions solve = {};
  CollisionGroups groups = {};
  /// A rule for pairs of vertices, unless it is empty: two primitives can collide if it is true for
  /// a vertex of one and a vertex of the other that are in groups that can collide. It must be
  /// symmetric. It is kept, and called for the pairs found, in several threads at once; its
  /// exceptions end the search.
  std::function<bool(std::int32_t, std::int32_t)> can_collide = nullptr;
  /// Null, or a flag that outlives the step and all made from it: a step reads it, and shares it
  /// with whoever sets it. While it is true, searches for impacts, collisions and candidates end
  /// soon with the exception Stopped.
  const std::atomic<bool>* stop = nullptr;
};

/// Two primitives that collide.
struct StepCollision {
  ContactKind kind = ContactKind::vertex_face;
  IndexPair pair{};
  /// Enclosure of the time of impact, as in CertifiedResult.
  double toi_lower = 0.0;
  double toi_upper = 0.0;
  /// The place, as in CertifiedResult. For a vertex and an edge, u is the place on the edge and v
  /// is 0; for two vertices, both are 0.
  double u = 0.0;
  double v = 0.0;

  friend bool operator==(const StepCollision&, const StepCollision&) = default;
};

/// A cell that inverts.
struct StepInversion {
  CellKind kind = CellKind::tetrahedron;
  std::int32_t cell = 0;  ///< its number among those of its kind
  /// The sign of its volume at the start, as in Inversion: 0 (flat) and −1 (inverted) have
  /// the time 0.
  std::int8_t start = 0;
  /// Enclosure of the first time at which its volume is 0 or negative, as in Inversion.
  double toi_lower = 0.0;
  double toi_upper = 0.0;

  friend bool operator==(const StepInversion&, const StepInversion&) = default;
};

/// The earliest impact of a step: a collision or an inversion.
struct StepImpact {
  /// The smallest toi_lower and the smallest toi_upper of all collisions and inversions.
  double toi_lower = 0.0;
  double toi_upper = 0.0;
  /// The candidates for the first collision: all with a toi_lower up to that toi_upper, in the
  /// order of kinds and pairs, which is not that of their times. The first one is among them; the
  /// enclosures of several do not tell which it is.
  std::vector<StepCollision> pairs;
  /// Likewise the candidates among the cells, tetrahedra first. One of the two lists may be
  /// empty.
  std::vector<StepInversion> inversions = {};

  friend bool operator==(const StepImpact&, const StepImpact&) = default;
};

/// A part of a step's candidates.
struct StepCandidates {
  ContactKind kind;
  std::span<const IndexPair> pairs;  ///< at most about a thousand, valid during the call
};

class Step {
 public:
  /// Makes a step.
  /// \pre If edges are given, those of all faces are among them.
  /// \throws std::invalid_argument for invalid options, and for cells on curves;
  /// std::domain_error naming the first vertex with a coordinate that is NaN or infinite, or a
  /// weight that is not positive and finite; std::out_of_range naming the first element with an
  /// index out of range; std::length_error if there are more than 2^31−1 elements of a kind.
  Step(Motion vertices, Mesh mesh, const StepOptions& options = {});

  /// Makes a step from places before and after, as Motion takes them: matrices or spans.
  /// \throws also std::invalid_argument as Motion.
  template <class Before, class After>
  requires std::constructible_from<Motion, const Before&, const After&> Step(
      const Before& before, const After& after, Mesh mesh, const StepOptions& options = {})
      : Step(Motion(before, after), std::move(mesh), options) {}

  ~Step();
  Step(Step&& other) noexcept;
  Step& operator=(Step&& other) noexcept;
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  /// The same mesh at other places, with the same options except the separation: the next step of a
  /// simulation, or another trial step of a line search. The steps share the data that do not
  /// depend on places, and the groups of primitives, until the places have made these much looser
  /// than new ones.
  /// \throws std::invalid_argument for another number of vertices or an invalid separation;
  /// std::domain_error as above.
  [[nodiscard]] Step with_places(Motion vertices, const Separation& separation) const;
  [[nodiscard]] Step with_separation(const Separation& separation) const {
    return with_places(vertices(), separation);
  }

  // ---- Impacts ----

  /// The earliest impact; nullopt if there is no collision and no inversion.
  [[nodiscard]] std::optional<StepImpact> earliest() const;

  /// All collisions, by kinds. The order depends only on the step and those that it was made from;
  /// pairs that are close in space are mostly close in the list.
  [[nodiscard]] std::vector<StepCollision> collisions() const;

  /// All cells that invert, tetrahedra first, in the order of their numbers.
  [[nodiscard]] std::vector<StepInversion> inversions() const;

  /// True if there is no collision and no inversion.
  [[nodiscard]] bool is_free() const;

  // ---- The start ----

  /// The intersections of the mesh at t=0, of groups that can collide: without any, the theorem
  /// above holds. (touchstone/intersections.hpp; `Intersection` is declared there.)
  /// \throws Stopped
  [[nodiscard]] std::vector<Intersection> intersections_at_start() const;
  /// True if there is no intersection at the start, and no cell is flat or inverted there: of
  /// inversions(), none has a `start` that is not 1. \throws Stopped
  [[nodiscard]] bool starts_free() const;

  // ---- The step that is taken ----

  /// The step from x0 to the places that a simulator computes with a step size α in doubles,
  ///
  ///     fl(x0 + fl(α fl(x1 − x0))),   fl: rounded to the nearest double,
  ///
  /// which in general are not on the straight line to x1. It has the same mesh and options, except
  /// t_max, which is 1: the whole scaled step counts.
  /// \throws std::invalid_argument unless 0 ≤ α ≤ 1; std::domain_error, which names the vertex, if
  /// fl(x1 − x0) overflows, for any α.
  [[nodiscard]] Step scaled(double alpha) const;

  /// A maximal step size: a double α in [0, t_max] such that scaled(α) is free and, unless α is
  /// t_max, scaled of the next double is not. Both are decided exactly. nullopt if scaled(0), which
  /// is at rest, is not free. So a step with is_free() gives t_max, as far as rounding does not
  /// move it into a contact.
  ///
  /// The search begins at the time of the earliest impact. It tries only some of the doubles from
  /// there. Because of rounding, a step with a larger α may avoid a contact of one with a smaller
  /// α. Therefore the result is not always the largest α with a free step, nor is the step of every
  /// smaller α free. One more search finds the few pairs that can collide in steps around the
  /// earliest impact, and these are tried for some dozens of α (docs/theory.md, section 8.4).
  /// \throws std::domain_error as `scaled`.
  [[nodiscard]] std::optional<double> free_step_size() const;

  // ---- Pairs ----

  /// Calls take(candidates) for all pairs in the search whose swept boxes are within their
  /// separation on every axis (exactly these: touchstone/broad_phase.hpp), some at a time, each
  /// once. Does not store them. Several threads call `take` concurrently, in any order. An
  /// exception from `take` ends the search and is rethrown.
  void candidates(const std::function<void(const StepCandidates&)>& take) const;

  /// The vertices of a pair as input of the certified solver: a vertex and an edge as vertex and
  /// face (e0, e1, e0), two vertices as vertex and face (w, w, w).
  /// \throws std::out_of_range for numbers out of range.
  [[nodiscard]] std::array<std::int32_t, moving_points> vertices_of(ContactKind kind,
                                                                    const IndexPair& pair) const;
  /// A pair as a query, whose points are these vertices.
  /// \throws std::out_of_range for numbers out of range.
  [[nodiscard]] Query query_of(ContactKind kind, const IndexPair& pair) const;
  /// A cell as a tetrahedron (touchstone/cell.hpp).
  /// \throws std::out_of_range for a number out of range.
  [[nodiscard]] Query tetrahedron_of(CellKind kind, std::int32_t cell) const;
  /// The distance at which a pair is in contact: the step's separation and the thickness.
  /// \throws std::out_of_range for numbers out of range.
  [[nodiscard]] Separation separation_of(ContactKind kind, const IndexPair& pair) const;

  [[nodiscard]] const Motion& vertices() const;
  /// The options that make it anew: Step(vertices(), mesh(), options()).
  [[nodiscard]] StepOptions options() const;
  /// The elements, with the edges of the faces if none were given.
  [[nodiscard]] const Mesh& mesh() const;
  [[nodiscard]] const CollisionGroups& groups() const;

 private:
  friend const Scene& scene_of(const Step& step);

  explicit Step(std::unique_ptr<const Scene> scene);

  std::unique_ptr<const Scene> scene_;
};

}  // namespace touchstone::fast
