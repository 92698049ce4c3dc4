#include "verify/jobs/check_step.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace touchstone::verify::jobs {
namespace {

PairCounts count_candidates(const fast::Step& step) {
  std::array<std::atomic<std::uint64_t>, pair_kinds.size()> counts{};
  step.candidates([&counts](const fast::StepCandidates& some) {
    counts.at(static_cast<std::size_t>(some.kind)).fetch_add(some.pairs.size());
  });
  PairCounts result{};
  std::ranges::copy(counts, result.begin());
  return result;
}

void require_few(const PairCounts& candidates, std::uint64_t most) {
  const std::uint64_t count =
      std::accumulate(candidates.begin(), candidates.end(), std::uint64_t{0});
  if (count <= most) return;
  throw std::runtime_error(std::to_string(count) + " pairs come near each other, more than " +
                           std::to_string(most) +
                           ", too many to list all that collide: --earliest names the first, "
                           "--free says whether there are any");
}

/// The earliest impact of all pairs that collide and cells that invert, as from
/// fast::Step::earliest.
std::optional<fast::StepImpact> earliest_of(const std::vector<fast::StepCollision>& collisions,
                                            const std::vector<fast::StepInversion>& inversions) {
  if (collisions.empty() && inversions.empty()) return std::nullopt;
  fast::StepImpact impact{.toi_lower = std::numeric_limits<double>::infinity(),
                          .toi_upper = std::numeric_limits<double>::infinity(),
                          .pairs = {}};
  const auto take_times = [&](const auto& one) {
    impact.toi_lower = std::min(impact.toi_lower, one.toi_lower);
    impact.toi_upper = std::min(impact.toi_upper, one.toi_upper);
  };
  std::ranges::for_each(collisions, take_times);
  std::ranges::for_each(inversions, take_times);
  const auto may_be_first = [&](const auto& one) { return one.toi_lower <= impact.toi_upper; };
  std::ranges::copy_if(collisions, std::back_inserter(impact.pairs), may_be_first);
  std::ranges::copy_if(inversions, std::back_inserter(impact.inversions), may_be_first);
  return impact;
}

void sort_by_numbers(std::vector<fast::StepCollision>& collisions) {
  std::ranges::sort(collisions, {}, [](const fast::StepCollision& collision) {
    return std::tuple(collision.kind, collision.pair);
  });
}

void answer(const fast::Step& step, StepQuestion question, StepCheck& check) {
  switch (question) {
    case StepQuestion::all:
      check.collisions = step.collisions();
      sort_by_numbers(*check.collisions);
      check.inversions = step.inversions();
      check.earliest = earliest_of(*check.collisions, *check.inversions);
      check.is_free = !check.earliest;
      return;
    case StepQuestion::earliest:
      check.earliest = step.earliest();
      check.is_free = !check.earliest.has_value();
      return;
    case StepQuestion::free:
      check.is_free = step.is_free();
      return;
  }
}

bool end_alike(const fast::Motion& some, const fast::Motion& others) {
  return std::ranges::equal(std::span(some.data(), some.size()),
                            std::span(others.data(), others.size()), {}, &fast::MovingVertex::end,
                            &fast::MovingVertex::end);
}

}  // namespace

PairCounts counts_of(const std::vector<fast::StepCollision>& collisions) {
  PairCounts counts{};
  for (const fast::StepCollision& collision : collisions) {
    ++counts.at(static_cast<std::size_t>(collision.kind));
  }
  return counts;
}

StepCheck check_step(std::optional<fast::Step>& step, const mesh::Mesh& mesh,
                     const mesh::Vertices& before, const mesh::Vertices& after,
                     const StepCheckOptions& options) {
  StepCheck check;
  std::optional<fast::Step> part;
  check.broad_phase = work_time_of([&] {
    fast::Motion vertices(before, after);
    if (step) {
      step.emplace(step->with_places(std::move(vertices), options.step.solve.separation));
    } else {
      step.emplace(std::move(vertices), mesh, options.step);
    }
    if (options.alpha) part.emplace(step->scaled(*options.alpha));
    if (options.question == StepQuestion::all || options.count_candidates) {
      check.candidates = count_candidates(part ? *part : *step);
    }
  });
  if (options.question == StepQuestion::all) {
    require_few(*check.candidates, options.most_candidates);
  }
  check.narrow_phase = work_time_of([&] { answer(part ? *part : *step, options.question, check); });
  if (options.find_contacts && check.earliest) {
    check.contacts = fast::contacts_of(
        part ? *part : *step, check.collisions ? *check.collisions : check.earliest->pairs);
  }
  if (options.proof.on_text) {
    check.proof = exact::prove_step(part ? *part : *step, options.proof);
    check.ends_at_frame = !part || end_alike(part->vertices(), step->vertices());
  }
  if (options.alpha) check.free_alpha = step->free_step_size();
  return check;
}

}  // namespace touchstone::verify::jobs
