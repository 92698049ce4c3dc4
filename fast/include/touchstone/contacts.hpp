#pragma once

/// \file
/// Distances and contacts, for line searches and constrained solvers: the distance of two
/// primitives, the least distance of a step, its contacts and active set, and the limit of a line
/// search. All functions are thread-safe.
///
/// \code{.cpp}
/// // A sheet falls towards the ground: what is active, and how far a line search may go.
/// #include <touchstone/contacts.hpp>
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
///   const auto least = fast::least_distance(step);  // at the start, of all pairs
///   std::printf("distance at the start: %g\n", least->distance.lower);
///   // All pairs that come within 1/4, ordered by time.
///   const auto active = fast::active_set(step, {.distance = 0.25, .norm = Norm::l2});
///   const fast::ActiveContact& first = active.front();
///   std::printf("at t = %.3f a gap of %.3f\n", first.toi_lower,
///               first.normal.dot(first.first - first.second));
///   // No pair comes closer than half of its distance at the start.
///   std::printf("step size %.3f\n", fast::line_search_limit(step, 0.5).step_size);
/// }
/// // distance at the start: 1
/// // at t = 0.250 a gap of 0.250
/// // step size 0.167
/// \endcode
///
/// **Distances** are those at a time t, at positions that are exactly (1−t) x0 + t x1. Primitives
/// are closed sets: the distance is 0 iff they have a common point. The answer is the greatest
/// double that is not above the distance and the least double that is not below it. It is exact if
/// the distance is a double, such as 0, and otherwise as narrow as doubles allow, at every scale. A
/// positive distance has a positive lower end unless it is below the least double. The result is
/// the same on every machine and for any number of threads.
///
/// *Method.* fast/distance/polygon_features.hpp states the expressions for the distance. They are
/// evaluated in numbers of 106 bits with error bounds (touchstone/filters/ball.hpp), which decide
/// nearly all queries; integers decide the others. Batches in L2 are evaluated on SIMD lanes
/// (fast/distance/filter_on_lanes.hpp). For the least distance of a step, a test on lanes first
/// excludes pairs that are farther apart than the nearest known pair (fast/step/sieve.hpp).
///
/// **Contacts.** A collision says which primitives meet and when; its contact says where, and from
/// which side. Let τ be its exact time of impact, and x* and y* points of the two primitives that
/// are nearest to each other at τ in L2, whichever the norm of the separation: if they touch, a
/// common point. The points `first` and `second` are those at the parameters u and v, and each is
/// within `point_error` of such a pair.
///
/// *The normal* is a unit vector that points from the second primitive to the first:
/// - *apart*, as with a separation: the direction of x* − y*. The plane through either point
///   perpendicular to it has all of that primitive on its far side.
/// - *touching*: the face's normal, or the cross product of the edges, at τ, even if the common
///   point is on the boundary of the face or an end of an edge. Of the two directions it is the one
///   from which the first primitive comes: n·(x − y) > 0 just before τ. If τ is 0, the motion is
///   continued backwards. `has_side` is false if this side is not proved: both are at rest, slide
///   along each other, or only graze. Then either direction may be right.
/// - *touching a segment or a point*, which is codimensional or an edge without length: against the
///   relative motion, without its component along the segment. That is the direction of the nearest
///   points just before τ.
///
/// `normal_error` bounds the distance of the vector from this exact one (the nearer of the two, if
/// the side is not proved). It is infinity where no bound below 1/2 is found, and in *degenerate
/// contact*, which has no such vector: touching edges that are parallel, or a touching face without
/// an area. `normal` is then only a unit vector to go on with: of primitives apart, the computed
/// direction of the points; else the vector of the third rule with the longer edge, or one
/// perpendicular to that.
///
/// The bounds follow from the enclosure of τ by arithmetic with error bounds
/// (fast/distance/contact_enclosure.hpp; docs/theory.md, section 8.9). In well-conditioned contact
/// they are near the width of that enclosure, times the motion. Parallel edges that touch have a
/// whole segment in common. Nearly parallel ones do not, and no error of a point is greater than
/// its edge.
///
/// **The active set** of a step are the pairs that a constrained solver has to keep apart, with
/// their contacts ([wang2021], algorithm 3). A constraint of such a solver is n·(x − y) ≥ η at the
/// end of the step, where x and y are the points of contact and n is the normal. It is active if
/// the primitives come within η at some time of the step. These pairs and their times are decided
/// exactly (touchstone/step.hpp).
///
/// **The limit of a line search** is the step size up to which all primitives stay at least p times
/// as far apart as at the start ([wang2021], algorithm 4, without its corrections).
///
/// *Theorem* (docs/theory.md, section 8.5). Let d > 0 be the distance at the start and s a double
/// with p d ≤ s < d. If no pair comes within s up to the time t, all pairs stay at least p d apart
/// up to t. The first time at which a pair comes within s is at least (d − s) / L > 0, where L is
/// the greatest relative speed.
///
/// d is enclosed by neighbouring doubles, so s exists for all distances but the least subnormal
/// ones. The time is enclosed to the step's toi_tolerance, and its lower end is positive unless the
/// time is below two of the least doubles. There are no other tolerances or corrections: a step
/// size of 0 always comes with a status that explains it.
///
/// Cells (Mesh) limit it, too: each keeps more than the part `kept_volume`
/// of its volume at the start. V(t) − f V(0) is a cubic polynomial, whose sign is decided exactly,
/// like that of V; f = 0 says that no cell inverts.
///
/// **Radii** of a step's groups (touchstone/step.hpp) thicken its primitives. The distance of a
/// pair is then less by its thickness, and negative where thick primitives overlap; it is enclosed
/// by the ends for the primitives themselves, less the thickness, rounded outwards. The active set
/// has the pairs whose thick primitives come within η, and the limit of a line search keeps a part
/// of their distances. Contact points are those of the primitives themselves.

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

// ---- Distances ----------------------------------------------------------------------------------

/// A distance ≥ 0, enclosed by doubles that are equal or neighbours. The upper one is infinity for
/// distances beyond the greatest double.
struct Distance {
  double lower = 0.0;
  double upper = 0.0;

  friend bool operator==(const Distance&, const Distance&) = default;
};

/// The distance of a query's primitives at the time t.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1; std::domain_error if a coordinate is not finite.
[[nodiscard]] Distance distance(ContactKind kind, const Query& query, double t,
                                Norm norm = Norm::l2);

/// Writes the distance of query i into results[i].
/// \param max_threads Maximum number of threads; 0 (all_cores): one for each core that the process
/// may use.
/// \throws as above, the std::domain_error naming a query; std::invalid_argument for spans of
/// different lengths or a negative number of threads.
void distances(ContactKind kind, std::span<const Query> queries, double t, Norm norm,
               std::span<Distance> results, int max_threads = all_cores);

/// The part of a distance d that must be left: more than least + part · (d − least).
struct KeptDistance {
  double part = 0.0;   ///< in [0,1]
  double least = 0.0;  ///< not negative
  Norm norm = Norm::l2;
};

/// True if one inequality shows that this part of the distance at t=0 is left at all times up to
/// t_max in [0,1], whether the expression is computed in doubles or exactly; then d is more than
/// `least`. False shows nothing. Much faster than `distance`: call it first
/// (fast/distance/kept_distance.cpp). Never throws; false if a coordinate is not finite.
[[nodiscard]] bool keeps_distance(ContactKind kind, const Query& query, double t_max,
                                  const KeptDistance& kept);

/// A pair of a step with its distance.
struct PairDistance {
  ContactKind kind = ContactKind::vertex_face;
  IndexPair pair{};
  Distance distance;

  friend bool operator==(const PairDistance&, const PairDistance&) = default;
};

/// The least distance of a step's pairs.
struct LeastDistance {
  Distance distance;
  /// All pairs with this enclosure, in order; with radii, all whose enclosures overlap it. If it is
  /// not a single double, their distances may differ within it.
  std::vector<PairDistance> pairs;

  friend bool operator==(const LeastDistance&, const LeastDistance&) = default;
};

/// The least distance at the time t of all pairs that the step considers (touchstone/step.hpp),
/// independent of its separation and t_max; empty if it considers none.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1.
[[nodiscard]] std::optional<LeastDistance> least_distance(const Step& step, double t = 0.0,
                                                          Norm norm = Norm::l2);

// ---- Contacts -----------------------------------------------------------------------------------

/// Two primitives that touch, or come within a distance, with the place of contact. u and v are the
/// parameters of its points.
struct ActiveContact : StepCollision {
  /// The points at the time of impact: on the first primitive and on the second.
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  /// The greatest distance, in L2, of each of these points from the exact one. Finite, unless the
  /// coordinates are near the greatest double.
  double point_error = std::numeric_limits<double>::infinity();
  /// The greatest distance of the normal from the exact one: at most 1/2, or infinity.
  double normal_error = std::numeric_limits<double>::infinity();
  /// True if the normal points to the proved side. False if there is no normal.
  bool has_side = false;

  /// True if the contact has a normal, which is known but for normal_error. (Compared so that it
  /// holds where a caller's compiler takes every number for finite.)
  [[nodiscard]] bool has_normal() const { return normal_error < 1.0; }
};

/// The contact of a collision of this step, as from its `earliest` or `collisions`.
/// \throws std::out_of_range for numbers out of range; std::invalid_argument unless the times are
/// in [0,1], in order.
[[nodiscard]] ActiveContact contact_of(const Step& step, const StepCollision& collision);

/// The contacts of several, in their order, in the step's number of threads.
/// \throws as above.
[[nodiscard]] std::vector<ActiveContact> contacts_of(const Step& step,
                                                     std::span<const StepCollision> collisions);

/// The contact of a pair at a given time, at any distance: for pairs and times that another solver
/// has found. Its toi_lower and toi_upper are t.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1; std::out_of_range for numbers out of range.
[[nodiscard]] ActiveContact contact_at(const Step& step, ContactKind kind, const IndexPair& pair,
                                       double t);

/// The contacts of every pair of the step that comes within η, the distance of `separation`, up to
/// the step's t_max, exactly these, in the order of toi_lower, toi_upper, kind and pair. The
/// separation of the step itself has no effect.
/// \param separation Its distance η is finite and not negative, in units of the coordinates; 0: the
/// pairs that collide.
/// \throws std::invalid_argument for another η.
[[nodiscard]] std::vector<ActiveContact> active_set(const Step& step, const Separation& separation);

// ---- Line searches ------------------------------------------------------------------------------

/// The reference distance at the start.
enum class StartDistance : std::uint8_t {
  /// The least distance of the scene: no pair comes within p times that distance.
  of_scene,
  /// The distance of each pair, as in ipc-toolkit: no pair comes within p times its own. Pairs
  /// whose swept boxes are disjoint are not considered: they cannot collide, but may come closer
  /// than that.
  of_pair,
};

enum class LineSearchStatus : std::uint8_t {
  whole,       ///< the whole step is allowed
  limited,     ///< a pair or a cell limits the step
  in_contact,  ///< a pair is in contact at the start; the step size is 0
  too_small,   ///< the step size, or a distance s as above, would be below the least doubles; it is
               ///< 0
  inverted,    ///< a cell is flat or inverted at the start; the step size is 0
};

struct LineSearchOptions {
  Norm norm = Norm::l2;
  StartDistance start_distance = StartDistance::of_scene;
  /// The part of its volume at the start of which a cell must keep more, in [0,1).
  double kept_volume = 0.0;
};

struct LineSearchLimit {
  LineSearchStatus status = LineSearchStatus::whole;
  /// The step size, in [0, t_max] of the step.
  double step_size = 0.0;
  /// The least distance at the start, of the scene or of `pairs` as the options say; infinity if
  /// there are no pairs.
  Distance distance{std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  /// limited: the pairs that limit the step first, as in StepImpact. in_contact: the pairs in
  /// contact at the start. too_small: the pairs that limit the step at a time or a distance too
  /// small for doubles.
  std::vector<StepCollision> pairs = {};
  /// Likewise the cells: those that limit the step first, are flat or inverted at the start, or
  /// limit it at a time too small for doubles. Their times are those at which no more than the kept
  /// part is left.
  std::vector<StepInversion> inversions = {};
};

/// The greatest step size, rounded down by at most the step's toi_tolerance, up to which all
/// primitives stay at least p times as far apart as at the start, and all cells keep more than
/// the part of their volume. The separation of the step has no effect.
/// \param p more than 0 and at most 1 − 2^-50.
/// \throws std::invalid_argument for another p, or a kept_volume out of range.
[[nodiscard]] LineSearchLimit line_search_limit(const Step& step, double p,
                                                const LineSearchOptions& options = {});

}  // namespace touchstone::fast
