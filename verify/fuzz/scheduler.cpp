#include "verify/fuzz/scheduler.hpp"

#include <limits>

namespace touchstone::verify::fuzz {
namespace {

constexpr unsigned table_bits = 16;

/// The assumed reward and work of an arm without results: little, but not less than that of an
/// unproductive one.
constexpr double first_reward = 1.0;
constexpr double first_work = 100.0;
/// The factor by which the weight of earlier results decreases with each unit of later work: half
/// after 0.7 / this.
constexpr double forgetting = 1e-4;
/// The share of draws for exploration, which is divided by the parts of the arms, independent of
/// their rewards.
constexpr double explored = 0.25;

}  // namespace

CoverageTable::CoverageTable() : counts_(std::size_t{1} << table_bits) {}

std::uint32_t CoverageTable::add(std::uint64_t coverage_key) {
  std::uint32_t& count = counts_[generate::mix(coverage_key) >> (64U - table_bits)];
  const std::uint32_t before = count;
  if (count != std::numeric_limits<std::uint32_t>::max()) ++count;
  return before;
}

Scheduler::Scheduler(const std::vector<Generator>& generators, std::uint64_t seed)
    : random_(generate::mix(seed)) {
  double sum = 0.0;
  for (const Generator& generator : generators) sum += generator.explored;
  for (const Generator& generator : generators) {
    arms_.push_back({.explored = explored * generator.explored / sum});
  }
}

double Scheduler::rate(const Arm& arm) {
  return (arm.reward + first_reward) / (arm.work + first_work);
}

std::size_t Scheduler::choose() {
  double sum = 0.0;
  for (const Arm& arm : arms_) sum += rate(arm);
  double left = random_.unit();
  for (std::size_t i = 0; i + 1 < arms_.size(); ++i) {
    left -= arms_[i].explored + (1.0 - explored) * rate(arms_[i]) / sum;
    if (left < 0.0) return i;
  }
  return arms_.size() - 1;
}

void Scheduler::learn(std::size_t arm, double reward, double work) {
  // 1/(1+x), not exp: the same on every machine.
  const double kept = 1.0 / (1.0 + forgetting * work);
  for (Arm& other : arms_) {
    other.reward *= kept;
    other.work *= kept;
  }
  arms_.at(arm).reward += reward;
  arms_.at(arm).work += work;
}

}  // namespace touchstone::verify::fuzz
