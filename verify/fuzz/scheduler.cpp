#include "verify/fuzz/scheduler.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace touchstone::verify::fuzz {
namespace {

/// The exponent field of a double, 0 (zeros, subnormals) to 2047 (infinities, NaN).
std::uint64_t exponent_field(double x) { return (std::bit_cast<std::uint64_t>(x) >> 52U) & 0x7ffU; }

/// The exponent of numbers up to 1, from 0 to 64, which stands for all below 2^-64.
std::uint64_t small_exponent(double x) {
  static constexpr std::uint64_t bias = 1023, least = bias - 64;
  return std::max(exponent_field(x), least) - least;
}

/// The class of a time in [0,1]: the exponent of its distance from the closer end.
std::uint64_t time_place(double t) {
  return t < 0.5 ? small_exponent(t) / 8 : 16 + small_exponent(1.0 - t) / 8;
}

std::uint64_t boundary_place(Kind kind, double u, double v) {
  std::uint64_t place = 0;
  place |= u == 0.0 ? 1U : 0U;
  place |= v == 0.0 ? 2U : 0U;
  place |= (kind == Kind::vertex_face ? u + v == 1.0 : u == 1.0) ? 4U : 0U;
  place |= v == 1.0 ? 8U : 0U;
  return place;
}

class Hash {
 public:
  void add(std::uint64_t value) { state_ = generate::mix(state_ + value + 0x9e3779b97f4a7c15ULL); }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

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

std::uint64_t coverage_key(const Queries& query, const fast::CertifiedResult& judged,
                           const fast::Answer& answer) {
  double greatest = 0.0;
  std::uint64_t zeros = 0;
  for (const double x : query.numbers) {
    greatest = std::max(greatest, std::abs(x));
    zeros += x == 0.0 ? 1U : 0U;
  }
  Hash hash;
  if (!query.is_straight()) hash.add(2 * query.degree + (query.is_rational ? 1U : 0U));
  hash.add(static_cast<std::uint64_t>(query.kind) + 2 * static_cast<std::uint64_t>(judged.stage) +
           16 * static_cast<std::uint64_t>(judged.verdict) +
           64 * static_cast<std::uint64_t>(answer.verdict) + 256 * (zeros / 4) +
           4096 * (exponent_field(greatest) / 256));
  if (judged.verdict == fast::Verdict::yes) {
    hash.add(time_place(judged.toi_upper) + 64 * boundary_place(query.kind, judged.u, judged.v));
    hash.add(small_exponent(judged.toi_upper - answer.toi_lower) / 2);
  }
  hash.add(answer.verdict == fast::Verdict::yes ? exponent_field(answer.tolerance) / 2 : 0);
  return hash.value();
}

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
