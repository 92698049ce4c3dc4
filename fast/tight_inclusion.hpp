#pragma once

/// \file
/// Tight-Inclusion: conservative continuous collision detection by bisection of (t,u,v).
/// ([wang2021], section 4, algorithm 2; section 5 for the minimum separation. docs/theory.md,
/// section 7; docs/methods.md, section 2.)
///
/// **Why no collision is missed.** F is affine in each of t, u and v, so over a box of parameters it
/// stays within the bounding box of its values at the eight corners. These are computed in floating
/// point with an error of at most the filter (filters/error_bounds.hpp), the parameters being dyadic
/// and exact. A box is dropped only if on some axis all corner values are beyond separation plus
/// filter on one side: then F does not come within the separation in it. All other boxes are split
/// until they are small, and every point of the domain stays in some box.
///
/// **Why the time is conservative.** Boxes are examined level by level (number of splits), within a
/// level by their lower t. All boxes of a level are of one size, since the axis to split depends on
/// the size alone. The boxes of a level that are left cover all contacts, so the lower t of the
/// level's first box that is not dropped is not above the time of impact. That is what is returned,
/// whenever the search ends: at a first box that is small (its image within δ, or wholly inside the
/// filter), or when the number of checks runs out. A small box that is not the first is not split
/// but remembered: boxes that begin no earlier need no examination, and if all others get dropped it
/// is the answer.
///
/// **Order without a heap.** Splitting u or v keeps the order of t. Splitting t sends the lower
/// halves of boxes with equal t first, then their upper halves; the next box begins no earlier than
/// these end. So each level is an array in order, and a search holds two of them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "exact/query.hpp"
#include "fast/filter.hpp"
#include "fast/method.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"

namespace touchstone::fast {

struct TightInclusionOptions {
  /// δ: a box is small if its image is at most this wide on each axis, in units of the coordinates;
  /// positive and finite.
  double tolerance = 1e-6;
  /// m_I: after this many boxes the answer is a conservative yes with the tolerance reached. Not
  /// positive: no limit.
  std::int64_t max_checks = 1'000'000;
  /// Boxes that may wait to be examined, 24 bytes each and twice; beyond that as beyond max_checks.
  std::size_t max_boxes = std::size_t{1} << 22U;
  /// d: contact is to come this near on every axis (L∞); finite, not negative.
  double min_separation = 0.0;
  /// Only contacts up to this time count, in [0,1]; rounded up to a multiple of 2^-53.
  double t_max = 1.0;
  /// If the time of impact comes out as 0: try again with less separation, a smaller tolerance or a
  /// shorter time, until it does not or max_refinements is reached. For line searches that have to
  /// advance.
  bool no_zero_toi = false;
  /// Bounds the work of no_zero_toi to this many further searches.
  int max_refinements = 32;
  /// Where the filter comes from; with `released`, which misses contacts, the order of operations too
  /// is that of the public Tight-Inclusion, without vector instructions.
  ErrorModel error_model = ErrorModel::derived;
  /// Per axis, instead of the filter of each query: that of a scene (fast/filter.hpp). It must be
  /// that of this kind and of min_separation, or more; the filter of vertex_face serves both kinds.
  std::optional<std::array<double, 3>> scene_filter = std::nullopt;
  /// For tests: instead of the best kernel for this processor.
  const BoxKernel* kernel = nullptr;
};

struct TightInclusionResult {
  /// no: no contact, certainly (but for the released filter). yes: contact, or nearly. error: see `error`; never undecided.
  Verdict verdict = Verdict::error;
  /// With yes: not above the time of impact, in [0, t_max].
  double toi = Answer::none;
  /// With yes: the tolerance achieved. The points come within it, plus the separation asked for,
  /// plus twice the filter, of each other at some time. δ, or more if the search ended early, or
  /// less if no_zero_toi lowered it.
  double tolerance = Answer::none;
  /// Separation that `toi` is about: no contact within it before. Below that asked for only where
  /// no_zero_toi lowered it.
  double min_separation = 0.0;
  /// Boxes examined, over all searches.
  std::int64_t checks = 0;
  /// Further searches by no_zero_toi.
  int refinements = 0;
  /// With error: what is wrong with the query or the options.
  std::string_view error;
};

/// Decides one query. Memory (max_boxes bounds it) is kept for the thread's next call, until the
/// thread ends.
/// \throws std::runtime_error if the arithmetic is not strict (fast/platform/arithmetic_check.hpp);
/// std::bad_alloc, after which the next call is as good as any.
[[nodiscard]] TightInclusionResult tight_inclusion(Kind kind, const Query& query,
                                                   const TightInclusionOptions& options = {});

/// As a method: its name is `tight_inclusion`, with the published filter
/// `tight_inclusion_published`, with the released one `tight_inclusion_released`, which promises
/// nothing. What MethodOptions do not say is taken from `base`; a scene's filter must then be one for
/// both kinds, and with no_zero_toi it promises nothing.
[[nodiscard]] std::unique_ptr<Method> tight_inclusion_method(
    const TightInclusionOptions& base = {});

}  // namespace touchstone::fast
