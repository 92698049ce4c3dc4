#include "verify/judge/ground_truth_cache.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "verify/base/any_decision.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/deadline.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::judge {
namespace {

namespace tbb = oneapi::tbb;

/// The number of queries between two reports of progress.
constexpr std::size_t step = 4096;

}  // namespace

GroundTruthCache::GroundTruthCache(const data::QueryGroup& group, unsigned threads)
    : group_(group), threads_(base::cores_for(threads)) {}

GroundTruthCache::Known& GroundTruthCache::known_at(const Separation& separation) {
  const auto found = std::ranges::find_if(
      known_, [&](const auto& known) { return same_separation(known.first, separation); });
  if (found != known_.end()) return found->second;
  return known_.emplace_back(separation, Known()).second;
}

void GroundTruthCache::decide(const Separation& separation, std::span<const std::size_t> positions,
                              Known& known, const std::atomic<bool>* stop,
                              const std::function<void(double)>& on_progress) {
  const AnyQueries queries = group_.queries();
  if (!positions.empty() && positions.back() >= queries.size()) {
    throw std::out_of_range("a position beyond the group");
  }
  tbb::task_arena arena(threads_);
  std::vector<std::optional<GroundTruth>> found(std::min(step, positions.size()));
  for (std::size_t first = 0; first < positions.size(); first += step) {
    const std::size_t count = std::min(step, positions.size() - first);
    std::ranges::fill(found, std::nullopt);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        // The hardest take a quarter of a second each.
        if (base::is_stopped(stop)) return;
        const std::size_t position = positions[first + i];
        found[i] = truth_of(position, base::decide(queries, position, separation));
      });
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (!found[i]) return;
      known.emplace(positions[first + i], *found[i]);
    }
    if (on_progress) {
      on_progress(static_cast<double>(first + count) / static_cast<double>(positions.size()));
    }
  }
}

std::vector<GroundTruth> GroundTruthCache::of(const Separation& separation,
                                              std::span<const std::size_t> positions,
                                              const std::atomic<bool>* stop,
                                              const std::function<void(double)>& on_progress) {
  Known& known = known_at(separation);
  std::vector<std::size_t> unknown;
  for (const std::size_t position : positions) {
    if (!known.contains(position)) unknown.push_back(position);
  }
  std::ranges::sort(unknown);
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  decide(separation, unknown, known, stop, on_progress);
  std::vector<GroundTruth> truths;
  for (const std::size_t position : positions) {
    const auto found = known.find(position);
    if (found == known.end()) break;
    truths.push_back(found->second);
  }
  return truths;
}

}  // namespace touchstone::verify::judge
