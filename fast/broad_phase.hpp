#pragma once

/// \file
/// Broad phase: which primitives of a moving mesh come near enough to each other that a query is
/// worth its time.
///
/// **Why no contact is missed.** A primitive's *swept box* is the smallest box around its vertices
/// at t=0 and at t=1. Every point of the primitive at every time is a convex combination of these,
/// so it is inside. If two primitives come within d of each other in L∞ at some time, their swept
/// boxes are within d of each other on every axis. The bounds of swept boxes are coordinates, not
/// computed, so comparing two of them is exact. With a separation one of the two boxes is widened:
///
///     lower_a − d ≤ upper_b  and  lower_b ≤ upper_a + d,   on every axis.
///
/// upper_a + d is rounded down: the right-hand side becomes the greatest double that is not above
/// the sum, so a double is at most the one iff it is at most the other. Likewise lower_a − d is
/// rounded up. Hence the candidates are *exactly* the pairs whose swept boxes are within d, whatever
/// the coordinates: none is missed, and none is added by rounding. (Beyond the greatest double the
/// rounded bound is that double, which no coordinate exceeds.)
///
/// **How.** First in float: boxes in trees of sixteen children a node, sixteen comparisons at a time
/// (fast/broad_phase/). What overlaps in double overlaps there. What overlaps there does so in double as
/// well if all coordinates are floats, or by more than the rounding; else the boxes above are
/// compared. Primitives are split at the median of their centres along the axis where these spread
/// most. Splitting by rank and not by place makes all trees equally deep, and memory proportional
/// to the primitives, however large or clustered the boxes are.
///
/// Pairs that share a vertex are left out: they always touch.

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "fast/mesh.hpp"

namespace touchstone::fast {

struct BroadPhaseOptions {
  /// d: swept boxes that come this near on every axis overlap; finite, not negative, in units of
  /// the coordinates.
  double min_separation = 0.0;
  /// Cores to use at most; 0: all of them. The result does not depend on it.
  int max_threads = 0;
  /// More candidates are an error. They take eight bytes each.
  std::uint64_t max_candidates = std::numeric_limits<std::uint64_t>::max();
};

/// Thrown where there are more candidates than are allowed or than fit into memory. Finding out how many
/// takes no memory, and as long as the search would have taken.
class TooManyCandidates : public std::runtime_error {
 public:
  explicit TooManyCandidates(std::uint64_t count);

  /// How many there are.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_;
};

/// All pairs of a vertex and a face, none of its own vertices, whose swept boxes are within
/// min_separation of each other; touching boxes are. Every vertex counts, whether or not a face has
/// it. The order depends on nothing but the arguments and the separation; pairs that are near in
/// space are mostly near in the list, which keeps their vertices in the cache.
/// Independent of the caller's floating-point environment.
/// \throws std::domain_error naming the first vertex with a coordinate that is NaN or infinite;
/// std::out_of_range naming the first face with an index that is no vertex's; std::invalid_argument
/// for options that make no sense; std::length_error if there are more than 2^31−1 of a primitive;
/// TooManyCandidates.
[[nodiscard]] std::vector<IndexPair> vertex_face_candidates(const MovingVertices& vertices,
                                                            std::span<const Face> faces,
                                                            const BroadPhaseOptions& options = {});

/// All pairs of edges without a common vertex whose swept boxes are within min_separation of each
/// other, each pair once, the smaller index first. Otherwise as vertex_face_candidates.
[[nodiscard]] std::vector<IndexPair> edge_edge_candidates(const MovingVertices& vertices,
                                                          std::span<const Edge> edges,
                                                          const BroadPhaseOptions& options = {});

/// The edges of faces, each once, the smaller vertex first; in ascending order of the larger
/// vertex, then of the smaller. That is the order in which the public simulation datasets of the
/// 2023 time-of-impact benchmark number them. A face that names a vertex twice has no edge from it
/// to itself.
[[nodiscard]] std::vector<Edge> edges_of(std::span<const Face> faces);

}  // namespace touchstone::fast
