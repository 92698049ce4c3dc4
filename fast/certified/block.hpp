#pragma once

/// \file
/// A block of queries through all stages: the kernel, the kernel once more for undecided queries of
/// unusual size, which are scaled (rescaling.hpp), and the exact stage for the rest.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/certified/rescaling.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// \throws std::invalid_argument for options out of range.
void require_valid(const CertifiedOptions& options);

/// The result of an exact decision.
[[nodiscard]] CertifiedResult result_of(const std::optional<ExactImpact>& impact);

/// The result of the exact stage.
[[nodiscard]] CertifiedResult decided_exactly(Kind kind, const Query& query,
                                              const CertifiedOptions& options);

/// The result of a impact, if its enclosure is narrow enough and on one side of t_max.
[[nodiscard]] std::optional<CertifiedResult> result_of(const KernelImpact& impact,
                                                       const CertifiedOptions& options);

/// A time such that every contact after it has an enclosure with both ends above toi_upper.
[[nodiscard]] double limit_after(double toi_upper, double tolerance);

/// Runs the kernel on a block, ignoring contacts after t_limit, and passes on the results of
/// queries that may have a contact: report(index, result). \pre strict floating point. \param
/// query_of(index) a query of the block
template <class QueryOf, class Report>
const KernelOutput& decide_block(KernelInput block, double t_limit, const CertifiedOptions& options,
                                 const CertifiedKernel& kernel, const QueryOf& query_of,
                                 const Report& report) {
  thread_local KernelOutput output;
  block.toi_tolerance = std::max(options.toi_tolerance, least_kernel_tolerance);
  block.t_limit = t_limit;
  block.separation = options.separation;
  kernel.decide(block, output);
  thread_local std::vector<Query> undecided;
  undecided.clear();
  for (std::size_t i = 0; i < output.undecided.count; ++i) {
    undecided.push_back(query_of(output.undecided.items[i]));
  }
  decide_rescaled(block, kernel, undecided, output);
  const auto report_exactly = [&](std::size_t index) {
    report(index, decided_exactly(block.kind, query_of(index), options));
  };
  for (std::size_t i = 0; i < output.impacts.count; ++i) {
    const KernelImpact& impact = output.impacts.items[i];
    if (const auto result = result_of(impact, options)) {
      report(std::size_t{impact.index}, *result);
    } else {
      report_exactly(impact.index);
    }
  }
  for (std::size_t i = 0; i < output.undecided.count; ++i) {
    report_exactly(output.undecided.items[i]);
  }
  return output;
}

}  // namespace touchstone::fast
