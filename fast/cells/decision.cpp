#include "fast/cells/decision.hpp"

#include <algorithm>
#include <vector>

#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/rescaling.hpp"

namespace touchstone::fast {
namespace {

/// The decision of integers.
Inversion decided_exactly(const Query& tetrahedron, double t_max, double kept_volume) {
  Inversion result{.is_exact = true};
  if (!is_finite(tetrahedron)) return result;
  const ExactInversion found = decide_inversion_exactly(tetrahedron, t_max, kept_volume);
  result.verdict = found.inverts ? Verdict::yes : Verdict::no;
  result.start = static_cast<std::int8_t>(found.start);
  if (!found.inverts) return result;
  result.toi_lower = found.toi_lower;
  result.toi_upper = found.toi_upper;
  return result;
}

}  // namespace

void decide_cells(CellInput block, double t_limit, const InversionOptions& options,
                  const CertifiedKernel& kernel,
                  const std::function<Query(std::size_t)>& tetrahedron,
                  const std::function<void(std::size_t, const Inversion&)>& report) {
  thread_local CellOutput output;
  block.toi_tolerance = std::max(options.toi_tolerance, least_kernel_tolerance);
  block.t_limit = t_limit;
  kernel.invert(block, output);
  if (output.undecided.count > 0) {
    std::vector<Query> undecided;
    for (std::size_t i = 0; i < output.undecided.count; ++i) {
      undecided.push_back(tetrahedron(output.undecided.items[i]));
    }
    invert_rescaled(block, *kernel.invert, undecided, output);
  }
  for (std::size_t i = 0; i < output.inverted.count; ++i) {
    report(output.inverted.items[i],
           {.verdict = Verdict::yes, .start = -1, .toi_lower = 0.0, .toi_upper = 0.0});
  }
  const auto report_exactly = [&](std::size_t index) {
    report(index, decided_exactly(tetrahedron(index), options.t_max, block.kept_volume));
  };
  for (std::size_t i = 0; i < output.inversions.count; ++i) {
    const auto& [index, lower, upper] = output.inversions.items[i];
    if (lower >= options.t_max) {
      report(index, no_inversion);
    } else if (upper > options.t_max || options.toi_tolerance < least_kernel_tolerance) {
      report_exactly(index);
    } else {
      report(index, {.verdict = Verdict::yes, .start = 1, .toi_lower = lower, .toi_upper = upper});
    }
  }
  for (std::size_t i = 0; i < output.undecided.count; ++i)
    report_exactly(output.undecided.items[i]);
}

}  // namespace touchstone::fast
