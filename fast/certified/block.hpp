#pragma once

/// \file
/// The stages for a block of queries: the kernel, the kernel again for undecided queries of unusual
/// size, which are scaled (rescaling.hpp), and the exact stage for the rest.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/certified/rescaling.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// \throws std::invalid_argument for options out of range.
void require_valid(const CertifiedOptions& options);

/// The result of an exact decision.
[[nodiscard]] CertifiedResult result_of(const std::optional<ExactImpact>& impact);

/// The result of the exact stage.
[[nodiscard]] CertifiedResult decided_exactly(ContactKind kind, const Query& query,
                                              const CertifiedOptions& options);
[[nodiscard]] CertifiedResult decided_exactly(const Queries& queries, std::size_t i,
                                              const CertifiedOptions& options);

/// The result of an impact, if its enclosure is narrow enough and on one side of t_max.
[[nodiscard]] std::optional<CertifiedResult> result_of(const KernelImpact& impact,
                                                       const CertifiedOptions& options);

/// A time such that every contact after it has an enclosure with both ends above toi_upper.
[[nodiscard]] double limit_after(double toi_upper, double tolerance);

/// Calls body(first) for each block of the kernel, under strict floating point, in the allowed
/// number of threads, in tasks of `blocks_a_task` blocks.
template <class Body>
void for_each_kernel_block(std::size_t size, int max_threads, std::size_t blocks_a_task,
                           const Body& body) {
  const std::size_t blocks = (size + kernel_block - 1) / kernel_block;
  const auto run = [&](std::size_t begin, std::size_t end) {
    const StrictFloatingPoint strict;
    for (std::size_t block = begin; block < end; ++block) body(block * kernel_block);
  };
  if (max_threads == 1 || blocks <= 1) {
    run(0, blocks);
    return;
  }
  with_threads(max_threads, [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, blocks_a_task),
        [&](const tbb::blocked_range<std::size_t>& range) { run(range.begin(), range.end()); });
  });
}

/// Passes on the results of the block's queries that may have a contact: report(index, result).
/// \param exactly(index) decides a query exactly
template <class Exactly, class Report>
void report_contacts(const KernelOutput& output, const CertifiedOptions& options,
                     const Exactly& exactly, const Report& report) {
  for (std::size_t i = 0; i < output.impacts.count; ++i) {
    const KernelImpact& impact = output.impacts.items[i];
    const std::size_t index = impact.index;
    const auto result = result_of(impact, options);
    report(index, result ? *result : exactly(index));
  }
  for (std::size_t i = 0; i < output.undecided.count; ++i) {
    const std::size_t index = output.undecided.items[i];
    report(index, exactly(index));
  }
}

/// The output of blocks in this thread: one for all instances of run_kernel, whose callers do not
/// run another block while they use it.
[[nodiscard]] inline KernelOutput& block_output() {
  thread_local KernelOutput output;
  return output;
}

/// Runs the kernel on a block, ignoring contacts after t_limit.
/// \pre strict floating point. \param query_of(index) a query of the block
template <class QueryOf>
KernelOutput& run_kernel(KernelInput& block, double t_limit, const CertifiedOptions& options,
                         const CertifiedKernel& kernel, const QueryOf& query_of) {
  KernelOutput& output = block_output();
  block.toi_tolerance = std::max(options.toi_tolerance, least_kernel_tolerance);
  block.t_limit = t_limit;
  block.separation = options.separation;
  kernel.decide(block, output);
  if (output.undecided.count > 0) {
    thread_local std::vector<Query> undecided;
    undecided.clear();
    for (std::size_t i = 0; i < output.undecided.count; ++i) {
      undecided.push_back(query_of(output.undecided.items[i]));
    }
    decide_rescaled(block, *kernel.decide, undecided, output);
  }
  return output;
}

/// Decides a block of queries and passes on the results of those that may have one:
/// report(index, result). \pre as above
template <class QueryOf, class Report>
const KernelOutput& decide_block(KernelInput block, double t_limit, const CertifiedOptions& options,
                                 const CertifiedKernel& kernel, const QueryOf& query_of,
                                 const Report& report) {
  KernelOutput& output = run_kernel(block, t_limit, options, kernel, query_of);
  report_contacts(
      output, options,
      [&](std::size_t index) { return decided_exactly(block.kind, query_of(index), options); },
      report);
  return output;
}

}  // namespace touchstone::fast
