#include "examples/simulation/collision_detector.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "verify/solvers/published.hpp"

namespace touchstone::simulation {
namespace {

/// A number that depends on the coordinates alone, like one drawn at random.
std::uint64_t hash(const Query& query) {
  std::uint64_t result = 0x9e3779b97f4a7c15;
  for (const double x : query.coordinates) {
    result = (result ^ std::bit_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccd;
    result ^= result >> 32;
  }
  return result;
}

/// In which a method measures a separation; nothing if it knows of contact alone.
std::optional<Norm> norm_of(const fast::MethodInfo& info) {
  for (const Norm norm : {Norm::l2, Norm::linf}) {
    if (info.measures_in(norm)) return norm;
  }
  return std::nullopt;
}

}  // namespace

Candidates candidates_of(const fast::Step& step) {
  Candidates result;
  std::mutex mutex;
  step.candidates([&](const fast::StepCandidates& found) {
    const std::scoped_lock lock(mutex);
    auto& pairs = result[found.kind];
    pairs.insert(pairs.end(), found.pairs.begin(), found.pairs.end());
  });
  for (auto& [kind, pairs] : result) std::ranges::sort(pairs);
  return result;
}

CollisionDetector::CollisionDetector(DetectorOptions options)
    : options_(std::move(options)),
      solver_(verify::solvers::solver_in_process(
          verify::solvers::find_any(options_.method),
          {.tolerance = options_.tolerance, .max_checks = 1'000'000})) {}

bool CollisionDetector::is_whole() const {
  return options_.method == "certified" && options_.missed_one_in == 0 &&
         options_.missed_limit == 0;
}

void CollisionDetector::record(const fast::Step& step) {
  if (options_.recorder == nullptr) return;
  for (const auto& [kind, pairs] : candidates_of(step)) {
    const std::size_t count = std::min(pairs.size(), options_.record_limit);
    for (std::size_t i = 0; i < count; ++i) {
      const fast::IndexPair& pair = pairs[i * pairs.size() / count];
      options_.recorder->add(decided_as(kind), step.query_of(kind, pair));
    }
  }
}

std::vector<CollisionDetector::Impact> CollisionDetector::impacts(const fast::Step& step,
                                                                  const Separation& separation) {
  std::vector<Impact> result;
  for (const auto& [kind, pairs] : candidates_of(step.with_separation(separation))) {
    std::vector<Query> queries;
    for (const fast::IndexPair& pair : pairs) queries.push_back(step.query_of(kind, pair));
    std::vector<fast::Answer> answers(queries.size());
    statistics_.candidates += queries.size();
    (void)solver_->solve({.queries = {decided_as(kind), queries}, .separation = separation},
                         answers);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (answers[i].verdict == fast::Verdict::no) continue;
      if (options_.missed_one_in != 0 && hash(queries[i]) % options_.missed_one_in == 0) {
        ++statistics_.missed;
        continue;
      }
      // An undecided pair may collide immediately.
      const bool is_known = answers[i].verdict == fast::Verdict::yes && answers[i].toi_lower >= 0.0;
      result.push_back({kind, pairs[i], is_known ? answers[i].toi_lower : 0.0});
    }
  }
  return result;
}

double CollisionDetector::limit_by_method(const fast::Step& step) {
  const std::optional<Norm> norm = norm_of(solver_->info());
  Separation separation{};
  if (norm) {
    const auto least = fast::least_distance(step, 0.0, *norm);
    if (!least) return 1.0;
    separation = {.distance = options_.p * least->distance.lower, .norm = *norm};
  }
  std::vector<Impact> limits = impacts(step, separation);
  if (!limits.empty() && ++statistics_.limited == options_.missed_limit) {
    limits.erase(std::ranges::min_element(limits, {}, &Impact::toi));
    ++statistics_.missed;
  }
  if (limits.empty()) return 1.0;
  const double earliest = std::ranges::min(limits, {}, &Impact::toi).toi;
  return norm ? earliest : (1.0 - options_.p) * earliest;
}

double CollisionDetector::step_size(const fast::Step& step) {
  record(step);
  ++statistics_.calls;
  const Stopwatch stopwatch(statistics_.seconds);
  const double result =
      is_whole() ? fast::line_search_limit(step, options_.p,
                                           {.start_distance = fast::StartDistance::of_pair})
                       .step_size
                 : limit_by_method(step);
  if (result == 0.0) ++statistics_.steps_of_zero;
  return result;
}

std::vector<fast::ActiveContact> CollisionDetector::active_set(const fast::Step& step,
                                                               double distance) {
  record(step);
  ++statistics_.calls;
  const Stopwatch stopwatch(statistics_.seconds);
  if (is_whole()) return fast::active_set(step, {.distance = distance, .norm = Norm::l2});
  const std::optional<Norm> norm = norm_of(solver_->info());
  std::vector<fast::ActiveContact> result;
  for (const Impact& impact :
       impacts(step, {.distance = norm ? distance : 0.0, .norm = norm.value_or(Norm::l2)})) {
    result.push_back(fast::contact_at(step, impact.kind, impact.pair, std::min(impact.toi, 1.0)));
  }
  std::ranges::sort(result, [](const fast::ActiveContact& a, const fast::ActiveContact& b) {
    return std::tie(a.toi_lower, a.kind, a.pair) < std::tie(b.toi_lower, b.kind, b.pair);
  });
  return result;
}

}  // namespace touchstone::simulation
