#include "verify/judge/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace touchstone::verify::judge {
namespace {

/// A bucket contains the doubles ≥ 0 whose bit patterns agree except for these low bits; the
/// largest of them is its upper end.
constexpr unsigned low_bits = 52 - 6;

std::uint32_t bucket_of(double error) {
  // Zero has a separate bucket, the first.
  if (error == 0.0) return 0;
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(error) >> low_bits) + 1;
}

double upper_end(std::uint32_t bucket) {
  return bucket == 0 ? 0.0
                     : std::bit_cast<double>((static_cast<std::uint64_t>(bucket) << low_bits) - 1);
}

/// Is an answer wrong that has no other fault?
bool is_wrong(Fault fault) { return fault != Fault::hang && fault != Fault::undecided; }

std::string answer_text(Fault fault, const fast::Answer& answer) {
  if (fault == Fault::late_toi) return fmt::format("toi_lower {}", answer.toi_lower);
  if (fault == Fault::early_toi_upper) return fmt::format("toi_upper {}", answer.toi_upper);
  if (fault == Fault::beyond_tolerance) return fmt::format("yes, tolerance {}", answer.tolerance);
  return std::string(to_string(answer.verdict));
}

}  // namespace

std::string to_text(const std::string& solver, const WrongAnswer& wrong) {
  return fmt::format("{}: {}: {}, the truth is {}", solver, to_text(wrong.fault), wrong.answer,
                     wrong.truth);
}

void ToiErrors::add(double error) {
  ++buckets_[bucket_of(error)];
  ++count_;
  max_ = std::max(max_, error);
}

ToiErrors& ToiErrors::operator+=(const ToiErrors& other) {
  for (const auto& [bucket, count] : other.buckets_) buckets_[bucket] += count;
  count_ += other.count_;
  max_ = std::max(max_, other.max_);
  return *this;
}

double ToiErrors::quantile(double fraction) const {
  const double rank = std::ceil(fraction * static_cast<double>(count_));
  std::uint64_t up_to_here = 0;
  for (const auto& [bucket, count] : buckets_) {
    up_to_here += count;
    // The end of infinity's bucket is a NaN, which this order of arguments ignores.
    if (static_cast<double>(up_to_here) >= rank) return std::min(max_, upper_end(bucket));
  }
  return max();
}

double ToiErrors::max() const {
  return count_ == 0 ? std::numeric_limits<double>::quiet_NaN() : max_;
}

std::uint64_t Judgement::errors() const {
  std::uint64_t sum = unplaced_crashes;
  for (const Fault fault : all_failures) sum += is_error(fault) ? count(fault) : 0;
  return sum;
}

double Judgement::nanoseconds_per_query() const {
  return queries == 0 ? 0.0 : nanoseconds / static_cast<double>(queries);
}

void Judgement::add(const Question& question, const GroundTruth& truth, const fast::Answer& answer,
                    const Standard& standard, const Failure* failure) {
  ++queries;
  checks += answer.checks;
  const auto why = failure != nullptr ? std::optional(*failure) : failure_of(answer);
  for (const Fault fault : judge(question, truth, answer, standard, failure)) {
    auto& count = faults[static_cast<std::size_t>(fault)];
    if (++count > most_kept || !is_wrong(fault)) continue;
    wrong_answers.push_back({fault, truth.index,
                             is_error(fault) ? to_text(*why) : answer_text(fault, answer),
                             to_text(truth), answer, why});
  }
  if (!truth.collides || why || answer.verdict != fast::Verdict::yes ||
      std::isnan(answer.toi_lower)) {
    return;
  }
  // The farther of the two ends of the truth, so that no error is understated.
  const auto [lower, upper] = truth.toi.value();
  toi_errors.add(std::max(upper - answer.toi_lower, answer.toi_lower - lower));
}

void Judgement::add_missing(std::uint64_t index) {
  if (!first_missing) first_missing = index;
  ++missing;
}

Judgement& Judgement::operator+=(const Judgement& next) {
  std::array<std::uint64_t, fault_count> so_far = faults;
  for (const WrongAnswer& wrong : next.wrong_answers) {
    if (++so_far[static_cast<std::size_t>(wrong.fault)] <= most_kept) {
      wrong_answers.push_back(wrong);
    }
  }
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i] += next.faults[i];
  queries += next.queries;
  missing += next.missing;
  if (!first_missing) first_missing = next.first_missing;
  unplaced_crashes += next.unplaced_crashes;
  checks += next.checks;
  nanoseconds += next.nanoseconds;
  toi_errors += next.toi_errors;
  return *this;
}

bool keeps(const Judgement& judgement, fast::Promise promise) {
  return std::ranges::none_of(all_faults, [&](Fault fault) {
    return judgement.total(fault) != 0 && breaks(fault, promise);
  });
}

}  // namespace touchstone::verify::judge
