#include "touchstone/inversion.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast/cells/decision.hpp"
#include "fast/certified/block.hpp"
#include "fast/kernels.hpp"

namespace touchstone::fast {

void for_each_inversion(const Cells& cells, const InversionOptions& options,
                        const std::function<void(std::size_t, const Inversion&)>& report) {
  require_valid({.toi_tolerance = options.toi_tolerance,
                 .t_max = options.t_max,
                 .max_threads = options.max_threads});
  if (!cells.is_straight()) {
    throw std::invalid_argument("inversions: cells must move on straight lines");
  }
  const std::span<const Query> all = cells.straight();
  // The widest lanes, which have registers for all vectors, for one cell too.
  const CertifiedKernel& kernel = certified_kernel(options.kernels);
  for_each_kernel_block(all.size(), options.max_threads, 8, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, all.size() - first);
    decide_cells(
        {.kind = cells.kind, .count = count, .queries = all.data() + first}, options.t_max, options,
        kernel, [&](std::size_t i) { return to_tetrahedron(cells.kind, all[first + i]); },
        [&](std::size_t i, const Inversion& result) { report(first + i, result); });
  });
}

Inversion inversion(CellKind kind, const Query& cell, const InversionOptions& options) {
  Inversion result;
  inversions(Cells(kind, std::span(&cell, 1)), std::span(&result, 1), options);
  return result;
}

void inversions(const Cells& cells, std::span<Inversion> results, const InversionOptions& options) {
  if (results.size() != cells.size()) {
    throw std::invalid_argument("inversions: " + std::to_string(results.size()) + " results for " +
                                std::to_string(cells.size()) + " cells");
  }
  std::ranges::fill(results, no_inversion);
  for_each_inversion(cells, options,
                     [&](std::size_t i, const Inversion& found) { results[i] = found; });
}

}  // namespace touchstone::fast
