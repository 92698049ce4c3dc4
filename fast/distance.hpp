#pragma once

/// \file
/// How far apart two primitives are at a time, and the primitives of a scene: between neighbouring doubles.
///
/// Places at a time are (1−t) x0 + t x1 exactly. The distance is that of closed primitives: 0 iff they
/// have a common point.
///
/// **What an answer is.** The greatest double that is not above the distance, and the least that is
/// not below it. So it is exact where the distance is a double, as 0 is, and else as narrow as
/// doubles allow, at every scale: a positive distance has a positive lower end, but for those below
/// the least double. Nothing else goes into it: not how it was found, the instruction set or the
/// number of threads.
///
/// **How.** fast/distance/polygon_features.hpp says which expressions are the distance. They are
/// evaluated in numbers of 106 bits that carry their error bounds (filters/ball.hpp), which settles
/// nearly all; the others are decided in integers. Many queries in L2 are evaluated on lanes
/// (fast/distance/filter_on_lanes.hpp). The least distance of a step first asks which pairs are no farther
/// apart than the nearest that is known, also on lanes (fast/distance/nearness.hpp).

#include <optional>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "fast/mesh.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// A distance, not negative, between doubles that are equal or neighbours. The upper one is infinity
/// for distances beyond the greatest double.
struct Distance {
  double lower = 0.0;
  double upper = 0.0;

  friend bool operator==(const Distance&, const Distance&) = default;
};

/// The distance of a query's primitives at the time t.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1; std::domain_error if a coordinate is not finite.
[[nodiscard]] Distance distance(Kind kind, const Query& query, double t, Norm norm = Norm::l2);

/// The distances of queries in distances[i].
/// \param max_threads 0: as many as there are cores.
/// \throws as above; std::invalid_argument for spans of different lengths or a negative number of
/// threads.
void distances(Kind kind, std::span<const Query> queries, double t, Norm norm,
               std::span<Distance> results, int max_threads = 0);

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
  /// All pairs with this distance, in order. If the distance is no double, they may be apart by different
  /// numbers between these two.
  std::vector<PairDistance> pairs;

  friend bool operator==(const LeastDistance&, const LeastDistance&) = default;
};

/// The least distance at the time t of all pairs that the step looks at (fast/step.hpp), whatever its
/// separation and t_max; nothing if it looks at none.
/// \throws std::invalid_argument unless 0 ≤ t ≤ 1.
[[nodiscard]] std::optional<LeastDistance> least_distance(const Step& step, double t = 0.0,
                                                          Norm norm = Norm::l2);

}  // namespace touchstone::fast
