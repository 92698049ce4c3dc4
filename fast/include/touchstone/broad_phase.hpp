#pragma once

/// \file
/// The broad phase: the pairs of primitives of a moving mesh that come close enough to need a
/// query.
///
/// **No contact is missed.** A primitive's *swept box* is the smallest box around its vertices at
/// t=0 and at t=1. Every point of the primitive at every time is a convex combination of these
/// positions, so it is inside. If two primitives come within d of each other in L∞ at some time,
/// their swept boxes are within d of each other on every axis. The bounds of swept boxes are
/// coordinates, not computed, so comparing two of them is exact. With a separation one of the two
/// boxes is widened:
///
///     lower_a − d ≤ upper_b  and  lower_b ≤ upper_a + d,   on every axis.
///
/// upper_a + d is rounded down, to the greatest double that is not above the sum. A double is at
/// most this one iff it is at most the sum. Likewise lower_a − d is rounded up. Hence the
/// candidates are *exactly* the pairs whose swept boxes are within d, for all coordinates: rounding
/// removes no pair and adds none. (Beyond the greatest double the rounded bound is that double,
/// which no coordinate exceeds.)
///
/// **Method.** The first comparison is in float: trees of boxes with sixteen children per node,
/// sixteen comparisons at a time (fast/broad_phase/). Boxes that overlap in double overlap in
/// float. The converse holds if all coordinates are floats, or if the overlap exceeds the rounding;
/// otherwise the boxes in double are compared. Primitives are split at the median of their centres
/// along the axis of greatest spread. Splitting by rank rather than by place gives all trees the
/// same depth, and memory proportional to the number of primitives, for any sizes and clusters of
/// boxes.
///
/// Pairs that share a vertex are excluded, because they are always in contact. The functions are
/// thread-safe.

#include <atomic>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::fast {

struct BroadPhaseOptions {
  /// d: the boxes of candidates are within this distance on every axis; finite, not negative, in
  /// units of the coordinates.
  Separation separation = {};
  /// Maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
  /// More candidates are an error. Each takes eight bytes.
  std::uint64_t max_candidates = (std::numeric_limits<std::uint64_t>::max)();
  /// Null, or a flag: once it is true, the search ends soon with the exception Stopped.
  const std::atomic<bool>* stop = nullptr;
};

/// BroadPhaseOptions::stop or StepOptions::stop has ended a search.
class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("the search was stopped") {}
};

/// More candidates than allowed, or than fit into memory. Counting them takes the time of the
/// search and no memory.
class TooManyCandidates : public std::runtime_error {
 public:
  explicit TooManyCandidates(std::uint64_t count);

  /// The number of candidates.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_;
};

/// All pairs of a vertex and a face without that vertex whose swept boxes are within the separation
/// of each other (≤). Vertices without a face take part. The order depends only on the arguments
/// and the separation; pairs that are close in space are mostly close in the list, which keeps
/// their vertices in the cache. Independent of the caller's floating-point environment.
/// \throws std::domain_error naming the first vertex with a coordinate that is NaN or infinite;
/// std::out_of_range naming the first face with an index out of range; std::invalid_argument for
/// invalid options; std::length_error if there are more than 2^31−1 of a primitive;
/// TooManyCandidates; Stopped.
[[nodiscard]] std::vector<IndexPair> vertex_face_candidates(const Motion& vertices,
                                                            std::span<const Face> faces,
                                                            const BroadPhaseOptions& options = {});

/// All pairs of edges without a common vertex whose swept boxes are within the separation of each
/// other, each pair once, the smaller index first. Otherwise like vertex_face_candidates.
[[nodiscard]] std::vector<IndexPair> edge_edge_candidates(const Motion& vertices,
                                                          std::span<const Edge> edges,
                                                          const BroadPhaseOptions& options = {});

/// The edges of faces, each once, the smaller vertex first; in ascending order of the larger
/// vertex, then of the smaller. The public simulation datasets of the 2023 time-of-impact benchmark
/// number edges in this order. A face that names a vertex twice has no edge from it to itself.
[[nodiscard]] std::vector<Edge> edges_of(std::span<const Face> faces);

}  // namespace touchstone::fast
