#pragma once

/// \file
/// The distance of two primitives at a time, and the least distance in a scene, enclosed by
/// neighbouring doubles.
///
/// Positions at a time t are exactly (1−t) x0 + t x1. Primitives are closed sets: the distance is 0
/// iff they have a common point.
///
/// **The answer** is the greatest double that is not above the distance and the least double that
/// is not below it. It is exact if the distance is a double, such as 0, and otherwise as narrow as
/// doubles allow, at every scale. A positive distance has a positive lower end unless it is below
/// the least double. The result is the same on every machine and for any number of threads.
///
/// **Method.** fast/distance/polygon_features.hpp states the expressions for the distance. They are
/// evaluated in numbers of 106 bits with error bounds (touchstone/filters/ball.hpp), which decide
/// nearly all queries; integers decide the others. Batches in L2 are evaluated on SIMD lanes
/// (fast/distance/filter_on_lanes.hpp). For the least distance of a step, a test on lanes first
/// excludes pairs that are farther apart than the nearest known pair (fast/step/sieve.hpp).
/// All functions are thread-safe.

#include <optional>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

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
/// \param max_threads 0: one for each core.
/// \throws as above, the std::domain_error naming a query; std::invalid_argument for spans of
/// different lengths or a negative number of threads.
void distances(Kind kind, std::span<const Query> queries, double t, Norm norm,
               std::span<Distance> results, int max_threads = 0);

/// What is to be left of a distance d: more than least + part · (d − least).
struct KeptDistance {
  double part = 0.0;   ///< in [0,1]
  double least = 0.0;  ///< not negative
  Norm norm = Norm::l2;
};

/// True if one inequality shows that this is left of the distance at t=0 at all times up to t_max
/// in [0,1], whether the expression is computed in doubles or exactly; then d is more than `least`.
/// False shows nothing. Much faster than `distance`: to be asked before it
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
  /// All pairs with this enclosure, in order. If it is not a single double, their distances may
  /// differ within it.
  std::vector<PairDistance> pairs;

  friend bool operator==(const LeastDistance&, const LeastDistance&) = default;
};

/// The least distance at the time t of all pairs that the step considers (touchstone/step.hpp),
/// independent of its separation and t_max; empty if it considers none.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1.
[[nodiscard]] std::optional<LeastDistance> least_distance(const Step& step, double t = 0.0,
                                                          Norm norm = Norm::l2);

}  // namespace touchstone::fast
