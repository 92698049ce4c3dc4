#include "verify/judge/ground_truth_cache.hpp"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "verify/judge/ground_truth.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify {
namespace {

namespace tbb = oneapi::tbb;

/// Queries decided between two looks at `stop`: the hardest take a quarter of a second each.
constexpr std::size_t step = 64;
constexpr unsigned most_threads = 1024;

}  // namespace

Truths::Truths(const QueryGroup& group, unsigned threads)
    : group_(group),
      threads_(threads == 0 ? tbb::info::default_concurrency()
                            : static_cast<int>(std::min(threads, most_threads))) {}

Truths::Known& Truths::known_at(const Separation& separation) {
  const auto found = std::ranges::find_if(
      known_, [&](const auto& known) { return same_question(known.first, separation); });
  if (found != known_.end()) return found->second;
  return known_.emplace_back(separation, Known(group_.queries().size())).second;
}

void Truths::decide(const Separation& separation, std::span<const std::size_t> positions,
                    Known& known, const std::atomic<bool>* stop) {
  tbb::task_arena arena(threads_);
  for (std::size_t first = 0; first < positions.size(); first += step) {
    if (stop != nullptr && *stop) return;
    const std::size_t last = std::min(first + step, positions.size());
    arena.execute([&] {
      tbb::parallel_for(first, last, [&](std::size_t i) {
        const std::size_t position = positions[i];
        known[position] = truth_of(
            position, exact::decide(group_.kind(), group_.queries()[position], separation));
      });
    });
    decided_ += last - first;
  }
}

std::vector<Truth> Truths::of(const Separation& separation, std::span<const std::size_t> positions,
                              const std::atomic<bool>* stop) {
  Known& known = known_at(separation);
  std::vector<std::size_t> unknown;
  for (const std::size_t position : positions) {
    if (!known.at(position)) unknown.push_back(position);
  }
  std::ranges::sort(unknown);
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  decide(separation, unknown, known, stop);
  std::vector<Truth> truths;
  for (const std::size_t position : positions) {
    if (!known[position]) break;
    truths.push_back(*known[position]);
  }
  return truths;
}

}  // namespace touchstone::verify
