#pragma once

/// \file
/// The method Tight-Inclusion: conservative continuous collision detection by bisection of (t,u,v).
/// ([wang2021], section 4, algorithm 2; section 5 for the minimum separation. docs/theory.md,
/// section 7; docs/methods.md, section 2.)
///
/// \code{.cpp}
/// // Conservative answers, for comparison.
/// #include <touchstone/tight_inclusion.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,
///                      1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
///   const fast::TightInclusionResult result =
///       fast::tight_inclusion(ContactKind::vertex_face, query, {.separation = {.distance =
///       1e-8}});
///   if (result.verdict != fast::Verdict::yes) return 1;  // no: certainly no contact
///   std::printf("no contact before %.6f\n", result.toi);  // never late
/// }
/// // no contact before 0.333333
/// \endcode
///
/// **No collision is missed.** F is affine in each of t, u and v, so over a box of parameters it
/// stays within the bounding box of its values at the eight corners. These are computed in floating
/// point with an error of at most the filter (touchstone/filters/error_bounds.hpp); the parameters
/// are dyadic and exact. A box is dropped only if on some axis all corner values are beyond
/// separation plus filter on one side; then it contains no contact. All other boxes are split until
/// they are small, and every other point of the domain stays in some box.
///
/// **The time is conservative.** Boxes are examined level by level (number of splits), within a
/// level by their lower t. All boxes of a level have the same size, because the axis to split
/// depends on the size alone. The remaining boxes of a level cover all contacts, so the lower t of
/// the level's first remaining box is not above the time of impact. The search returns this t
/// whenever it ends: at a first box that is small (its image within δ, or wholly inside the
/// filter), or at the limit of checks. A small box that is not the first is not split but
/// remembered: boxes that begin no earlier need no examination, and if all others are dropped it is
/// the answer.
///
/// **Order without a heap.** Splitting u or v keeps the order of t. Splitting t sends the lower
/// halves of boxes with equal t first, then their upper halves; the next box begins no earlier than
/// these end. Thus each level is a sorted array, and a search holds two of them.
///
/// **The filter** (error_filter) is a bound, on each axis, of the error of computed values of F,
/// for a query or for a scene. All functions are thread-safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

// ---- The filter ---------------------------------------------------------------------------------

/// The filter on each axis, in units of the coordinates, for F − d and F + d with `distance`
/// d, or F itself if d is 0. `x_max` is the maximum magnitude of the coordinates on each axis, of
/// one query or of a scene; the filter of a scene holds for all its queries. It is proved for the
/// operations that run, and infinite if overflow could occur.
/// \pre all arguments are finite and not negative.
[[nodiscard]] std::array<double, 3> error_filter(ContactKind kind,
                                                 const std::array<double, 3>& x_max,
                                                 double distance);

// ---- Tight-Inclusion ----------------------------------------------------------------------------

struct BoxKernel;

struct TightInclusionOptions {
  /// δ: a box is small if its image is at most this wide on each axis, in units of the coordinates;
  /// positive and finite.
  double tolerance = 1e-6;
  /// m_I: after this many boxes the answer is a conservative yes with the tolerance reached. Not
  /// positive: no limit.
  std::int64_t max_checks = 1'000'000;
  /// d: the distance at which primitives are in contact; finite, not negative. Its norm has no
  /// effect: it is measured in L∞, which is conservative for L2, where no distance is smaller.
  Separation separation = {};
  /// Only contacts up to this time, in [0,1], count; it is rounded up to a multiple of 2^-53.
  double t_max = 1.0;
  /// The filter of a scene on each axis (error_filter), which replaces the filter of each
  /// query. It must be at least the filter of this kind and of the separation; the filter of
  /// vertex_face holds for both kinds.
  std::optional<std::array<double, 3>> scene_filter = std::nullopt;
  /// For tests: null, or the kernel of queries on straight lines (fast/tight_inclusion/).
  const BoxKernel* kernel = nullptr;
};

struct TightInclusionResult {
  /// no: certainly no contact. yes: contact, or nearly so. error: a coordinate is NaN or infinite.
  /// Never undecided.
  Verdict verdict = Verdict::error;
  /// A time, with yes, in [0, t_max] and not above the time of impact.
  double toi = no_number;
  /// The tolerance achieved, with yes. At some time the distance is at most this tolerance plus the
  /// requested separation plus twice the filter. It is δ, or more if the search ended early.
  double tolerance = no_number;
  /// The number of boxes examined.
  std::int64_t checks = 0;
};

/// Solves one query. Thread-safe. Each thread keeps its memory until it ends: at most 200 MB, as a
/// search that needs more ends as beyond max_checks.
/// \throws std::invalid_argument for options out of range; std::runtime_error if the arithmetic is
/// not strict (fast/platform/arithmetic_check.hpp); std::bad_alloc, which does not affect later
/// calls.
[[nodiscard]] TightInclusionResult tight_inclusion(ContactKind kind, const Query& query,
                                                   const TightInclusionOptions& options = {});

/// Solves query i in results[i], in this thread: on straight lines as above, or on curves of degree
/// 2 or 3, polynomial or rational. On a piece of time F is in the hull of its control values, which
/// take the place of its values at both ends. ([wang2021], section 7: the extension to non-linear
/// trajectories.) Coordinates above 2^1000, of rational curves above 2^900 or with weights not
/// between 2^-30 and 2^30, are answered with yes, at time 0.
/// \throws std::invalid_argument also for other curves, on curves with a filter of a scene, and
/// unless there is a result for each query.
void tight_inclusion(const Queries& queries, std::span<TightInclusionResult> results,
                     const TightInclusionOptions& options = {});

}  // namespace touchstone::fast
