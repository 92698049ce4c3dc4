#include "verify/jobs/timing.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "verify/base/deadline.hpp"

namespace touchstone::verify::jobs {
namespace {

using WallClock = std::chrono::steady_clock;

/// Shorter work is repeated within one measurement.
constexpr double least_nanoseconds = 2e6;
/// The number of queries for the first estimate of a solver's speed, and the greatest factor to the
/// next estimate.
constexpr std::size_t first_sample = 16;
constexpr double most_growth = 64.0;
/// The targeted share of the time limit of a sample.
constexpr double aimed_share = 0.9;
constexpr int sweeps = 3;
constexpr int clock_readings = 10'000;

double nanoseconds_since(WallClock::time_point start) {
  return std::chrono::duration<double, std::nano>(WallClock::now() - start).count();
}

}  // namespace

std::shared_ptr<const Sample> sample_of(const data::QueryGroup& group, std::size_t count) {
  const AnyQueries all = group.queries();
  const auto sample = std::make_shared<Sample>();
  sample->positions = spread_sample(all.size(), count);
  sample->queries = all;
  if (count < all.size()) {
    sample->copies.reserve(count * all.numbers_of_query());
    for (const std::size_t position : sample->positions) {
      const std::span<const double> row = all.row(position);
      sample->copies.insert(sample->copies.end(), row.begin(), row.end());
    }
    sample->queries.numbers = sample->copies;
  }
  return sample;
}

TimedSolver::TimedSolver(const solvers::Solver& solver, const data::QueryGroup& group,
                         const Separation& separation)
    : solver_(&solver), group_(&group), separation_(separation) {}

void TimedSolver::take(std::shared_ptr<const Sample> sample) {
  sample_ = std::move(sample);
  answers_.resize(queries().size());
  calls_ = 0;
}

void TimedSolver::choose_sample(double seconds, const std::atomic<bool>* stop) {
  const std::size_t most = group_->queries().size();
  std::size_t count = std::min(first_sample, most);
  // The speed varies from query to query, so a small sample is not significant.
  for (;;) {
    take(sample_of(*group_, count));
    double growth = possible_growth(seconds);
    if (count == most || base::is_stopped(stop)) return;
    // The first run of a sample also accesses its memory for the first time.
    if (growth < 2.0) growth = possible_growth(seconds);
    if (growth < 2.0 || base::is_stopped(stop)) return;
    count = std::min(count * std::bit_floor(static_cast<std::size_t>(growth)), most);
  }
}

double TimedSolver::possible_growth(double seconds) {
  const WallClock::time_point start = WallClock::now();
  double nanoseconds = time_calls(1);
  // A child process may sleep.
  if (reply_.time) nanoseconds = std::max(nanoseconds, nanoseconds_since(start));
  calls_ = calls_for(nanoseconds);
  return std::min(aimed_share * 1e9 * seconds / nanoseconds, most_growth);
}

double TimedSolver::time_calls(std::size_t calls) {
  const solvers::SolveRequest request{.queries = queries(), .separation = separation_};
  double own = 0.0;
  const double here = time_of(calls, [&] {
    reply_ = solver_->solve(request, answers_);
    unplaced_crashes_ += reply_.unplaced_crashes;
    own += reply_.time.value_or(solvers::SolverTime{}).processor_nanoseconds;
  });
  return reply_.time ? own / static_cast<double>(calls) : here;
}

double TimedSolver::asked() const {
  return static_cast<double>(std::max<std::size_t>(1, queries().size() - reply_.unasked.size()));
}

void TimedSolver::repeat() {
  if (calls_ == 0) calls_ = calls_for(time_calls(1));
  times_.push_back(time_calls(calls_) / asked());
}

std::optional<std::vector<double>> TimedSolver::time_singles(std::size_t count, double seconds,
                                                             const std::atomic<bool>* stop) const {
  const std::vector<std::size_t> chosen = spread_sample(queries().size(), count);
  std::vector<double> times(chosen.size(), std::numeric_limits<double>::infinity());
  fast::Answer answer;
  const WallClock::time_point start = WallClock::now();
  for (int sweep = 0; sweep < sweeps && nanoseconds_since(start) <= 1e9 * seconds; ++sweep) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (base::is_stopped(stop)) return std::nullopt;
      const solvers::SolveRequest request{.queries = queries().part(chosen[i], 1),
                                          .separation = separation_};
      const WallClock::time_point before = WallClock::now();
      const solvers::SolveReply reply = solver_->solve(request, {&answer, 1});
      const double here = nanoseconds_since(before);
      const double time = reply.time ? reply.time.value().processor_nanoseconds : here;
      if (reply.unasked.empty()) times[i] = std::min(times[i], time);
    }
  }
  const double clock = clock_nanoseconds();
  for (double& time : times) time = std::max(time - clock, 0.0);
  return times;
}

judge::Judgement TimedSolver::judge(std::span<const judge::GroundTruth> truths) const {
  judge::Judgement judgement;
  const std::vector<std::size_t>& places = positions();
  std::size_t i = 0;
  for (const judge::GroundTruth& truth : truths) {
    while (i < places.size() && places[i] < truth.index) ++i;
    if (i == places.size()) break;
    if (places[i] != truth.index) continue;
    if (const auto why = reply_.why_unasked(i)) {
      judgement.add_unasked(*why, truth.index);
      continue;
    }
    judgement.add({queries().part(i, 1), separation_}, truth, answers_[i], solver_->standard(),
                  judge::failure_at(reply_.failures, i));
  }
  judgement.unplaced_crashes = unplaced_crashes_;
  return judgement;
}

bool takes_curves(const fast::Terms& terms, AnyShape shape) {
  const bool of_cells = shape.kind.is_cell();
  return std::ranges::any_of(all_kinds, [&](AnyKind kind) {
    shape.kind = kind;
    return kind.is_cell() == of_cells && terms.answers(shape);
  });
}

std::size_t calls_for(double nanoseconds) {
  return static_cast<std::size_t>(std::clamp(least_nanoseconds / nanoseconds, 1.0, 1e6));
}

double clock_nanoseconds() {
  std::vector<double> times(clock_readings);
  for (double& time : times) time = nanoseconds_since(WallClock::now());
  return median(times);
}

namespace {

constexpr double golden_section = 0.6180339887498949;

/// A stride without a common divisor with the size, whose multiples therefore meet every position.
std::size_t stride_of(std::size_t size) {
  auto stride = static_cast<std::size_t>(golden_section * static_cast<double>(size));
  while (std::gcd(stride, size) != 1) ++stride;
  return stride;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto place = std::min(static_cast<std::size_t>(std::max(rank, 1.0)), values.size()) - 1;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(place));
  return values[place];
}

std::vector<std::size_t> spread_sample(std::size_t size, std::size_t count) {
  std::vector<std::size_t> positions(std::min(size, count));
  if (count >= size) {
    std::iota(positions.begin(), positions.end(), std::size_t{0});
    return positions;
  }
  const std::size_t stride = stride_of(size);
  std::size_t position = 0;
  for (std::size_t& chosen : positions) {
    chosen = position;
    position = (position + stride) % size;
  }
  std::ranges::sort(positions);
  return positions;
}

}  // namespace touchstone::verify::jobs
