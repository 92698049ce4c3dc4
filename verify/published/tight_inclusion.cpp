// Tight-Inclusion ([wang2021]; docs/methods.md, section 2) with other filters than ours, as our own
// search runs it. `tight_inclusion_published` has the filter of the paper, which is a bound too;
// `tight_inclusion_released` that of the public code since 2022, and its order of operations;
// `tight_inclusion_float` computes F in float, of queries rounded to float.
//
// **Promise.** Conservative, of tight_inclusion_float for the rounded query.
//
// **Known defect.** The released filter is no bound (tight_inclusion_filters.hpp): contacts whose
// coordinates have full significands are missed at scales far from 1. It promises nothing.

#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"
#include "fast/tight_inclusion/lane_by_lane.hpp"
#include "fast/tight_inclusion_variant.hpp"
#include "touchstone/filters/expressions.hpp"
#include "verify/published/published.hpp"
#include "verify/published/tight_inclusion_filters.hpp"

namespace touchstone::verify::published {
namespace {

/// The steps of filters::ReleasedEdgeEdge and filters::ReleasedVertexFace.
struct ReleasedSteps {
  template <class Lanes>
  static Lanes blend(const Lanes& a, const Lanes& b, const Lanes& /*weight_a*/,
                     const Lanes& weight_b) {
    return filters::blend_from_first(a, b, weight_b);
  }
  template <class Lanes>
  static Lanes blend(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& /*weight_a*/,
                     const Lanes& weight_b, const Lanes& weight_c) {
    return filters::blend_from_first(a, b, c, weight_b, weight_c);
  }
};

using fast::BoxKernelOnLanes, fast::InstructionSet, fast::lane_by_lane::Lanes;
constexpr fast::BoxKernel released_kernel =
    BoxKernelOnLanes<Lanes<double>, ReleasedSteps>::kernel(InstructionSet::scalar);
constexpr fast::BoxKernel float_kernel =
    BoxKernelOnLanes<Lanes<float>>::kernel(InstructionSet::scalar);

Answer solve(ContactKind kind, const Query& query, const TouchstonePluginOptions& options,
             const fast::TightInclusionVariant& variant) {
  const fast::TightInclusionResult result =
      fast::tight_inclusion(kind, query,
                            {.tolerance = options.tolerance,
                             .max_checks = options.max_checks,
                             .separation = {.distance = options.min_separation},
                             .t_max = options.t_max},
                            variant);
  return {static_cast<TouchstoneVerdict>(result.verdict), result.toi, result.tolerance};
}

}  // namespace

Answer tight_inclusion_published(ContactKind kind, const Query& query,
                                 const TouchstonePluginOptions& options) {
  return solve(kind, query, options, {*fast::box_kernels().back(), published_filter});
}

Answer tight_inclusion_released(ContactKind kind, const Query& query,
                                const TouchstonePluginOptions& options) {
  return solve(kind, query, options, {released_kernel, released_filter});
}

Answer tight_inclusion_float(ContactKind kind, const Query& query,
                             const TouchstonePluginOptions& options) {
  return solve(kind, query, options, {float_kernel, float_filter});
}

}  // namespace touchstone::verify::published
