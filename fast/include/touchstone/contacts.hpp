#pragma once

/// \file
/// Distances and contacts, for line searches and constrained solvers: the distance of two
/// primitives, the least distance of a step, its active set, and the limit of a line search. All
/// functions are thread-safe.
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
/// **The active set** of a step is the set of pairs that a constrained solver must keep apart, with
/// time, place and direction of each contact ([wang2021], algorithm 3). A constraint of such a
/// solver is n·(x − y) ≥ η at the end of the step, where x and y are points of the two primitives
/// and n is the contact normal. It is active if the primitives come within η at some time of the
/// step. These pairs and their times are decided exactly (touchstone/step.hpp). Points and normals
/// are computed in doubles without a bound.
///
/// *The normal* is a unit vector that points from the second primitive to the first. Let F be the
/// difference x − y of the contact points, at the upper end of the time of impact, and F' its rate.
/// - It is parallel to the face's normal, or to the cross product of the edges. Of the two
///   directions it is the one with n·F > 0; if the points coincide, the one with n·F' < 0, from
///   which the first primitive comes; otherwise the direction of the product itself.
/// - *Degenerate pairs* have no such product: parallel edges, a face without an area, a vertex and
///   an edge, two vertices. Their normal is the direction of F; if the points coincide, the
///   direction of −F' without its component along the edge; otherwise any direction perpendicular
///   to the edge.
///
/// Edges are treated as parallel, and a face as one without an area, if the sine of the angle is
/// below 2^-20: about half of a normal's digits are right then. Points are treated as coincident if
/// F is below 2^-40 of the size of the pair, or below the motion of the pair within the enclosure
/// of the time of impact.
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
[[nodiscard]] Distance distance(Kind kind, const Query& query, double t, Norm norm = Norm::l2);

/// Writes the distance of query i into results[i].
/// \param max_threads Maximum number of threads; 0 (all_cores): one for each core that the process
/// may use.
/// \throws as above, the std::domain_error naming a query; std::invalid_argument for spans of
/// different lengths or a negative number of threads.
void distances(Kind kind, std::span<const Query> queries, double t, Norm norm,
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
[[nodiscard]] bool keeps_distance(Kind kind, const Query& query, double t_max,
                                  const KeptDistance& kept);

/// A pair of a step with its distance.
struct PairDistance {
  PairKind kind = PairKind::vertex_face;
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

// ---- Active sets --------------------------------------------------------------------------------

/// Two primitives that come within η, with the place of contact.
struct ActiveContact : StepCollision {
  /// The contact points at toi_upper: on the first primitive and on the second.
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
};

/// Every pair of the step that comes within η, the distance of `separation`, up to the step's
/// t_max, exactly these, in the order of toi_lower, toi_upper, kind and pair. The separation of the
/// step itself has no effect.
/// \param separation Its distance η is finite and not negative, in units of the coordinates; 0: the
/// pairs that collide.
/// \throws std::invalid_argument for another η.
[[nodiscard]] std::vector<ActiveContact> active_set(const Step& step, const Separation& separation);

/// The contact of a pair at a given time, at any distance: for pairs and times that another solver
/// has found. Its toi_lower and toi_upper are t; u and v are the parameters of the nearest points.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1; std::out_of_range for numbers out of range.
[[nodiscard]] ActiveContact contact_at(const Step& step, PairKind kind, const IndexPair& pair,
                                       double t, Norm norm = Norm::l2);

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
  limited,     ///< a pair limits the step
  in_contact,  ///< a pair is in contact at the start; the step size is 0
  too_small,   ///< the step size, or a distance s as above, would be below the least doubles; it is
               ///< 0
};

struct LineSearchOptions {
  Norm norm = Norm::l2;
  StartDistance start_distance = StartDistance::of_scene;
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
};

/// The greatest step size, rounded down by at most the step's toi_tolerance, up to which all
/// primitives stay at least p times as far apart as at the start. The separation of the step has no
/// effect.
/// \param p more than 0 and at most 1 − 2^-50.
/// \throws std::invalid_argument for another p.
[[nodiscard]] LineSearchLimit line_search_limit(const Step& step, double p,
                                                const LineSearchOptions& options = {});

}  // namespace touchstone::fast
