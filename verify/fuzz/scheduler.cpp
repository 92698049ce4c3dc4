#include "verify/fuzz/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchstone::verify::fuzz {
namespace {

constexpr unsigned table_bits = 16;

/// The assumed reward and work of an arm without results: little, but not less than that of an
/// unproductive one.
constexpr double first_reward = 1.0;
constexpr double first_work = 100.0;

}  // namespace

CoverageTable::CoverageTable() : counts_(std::size_t{1} << table_bits) {}

std::uint32_t CoverageTable::add(std::uint64_t coverage_key) {
  std::uint32_t& count = counts_[generate::mix(coverage_key) >> (64U - table_bits)];
  size_ += count == 0 ? 1U : 0U;
  const std::uint32_t before = count;
  if (count != std::numeric_limits<std::uint32_t>::max()) ++count;
  return before;
}

Scheduler::Scheduler(const std::vector<double>& parts, std::uint64_t seed,
                     const SchedulerOptions& options)
    : random_(generate::mix(seed)), options_(options) {
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  for (const double part : parts) arms_.push_back({.explored = options.explored * part / sum});
}

double Scheduler::rate(const Arm& arm) {
  return (arm.reward + first_reward) / (arm.work + first_work);
}

double Scheduler::share(std::size_t arm) const {
  double sum = 0.0;
  for (const Arm& other : arms_) sum += rate(other);
  return arms_.at(arm).explored + (1.0 - options_.explored) * rate(arms_.at(arm)) / sum;
}

std::size_t Scheduler::choose() {
  double sum = 0.0;
  for (const Arm& arm : arms_) sum += rate(arm);
  double left = random_.unit();
  for (std::size_t i = 0; i + 1 < arms_.size(); ++i) {
    left -= arms_[i].explored + (1.0 - options_.explored) * rate(arms_[i]) / sum;
    if (left < 0.0) return i;
  }
  return arms_.size() - 1;
}

void Scheduler::learn(std::size_t arm, double reward, double work) {
  // 1/(1+x), not exp: the same on every machine.
  const double kept = 1.0 / (1.0 + options_.forgetting * work);
  for (Arm& other : arms_) {
    other.reward *= kept;
    other.work *= kept;
  }
  arms_.at(arm).reward += reward;
  arms_.at(arm).work += work;
}

}  // namespace touchstone::verify::fuzz
