#include "verify/judge/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "verify/solvers/answers.hpp"

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

std::string answer_text(Fault fault, const fast::Answer& answer) {
  if (fault == Fault::late_toi) return fmt::format("toi_lower {}", answer.toi_lower);
  if (fault == Fault::early_toi_upper) return fmt::format("toi_upper {}", answer.toi_upper);
  if (fault == Fault::beyond_tolerance) return fmt::format("yes, tolerance {}", answer.tolerance);
  return std::string(solvers::to_string(answer.verdict));
}

}  // namespace

std::string_view to_string(Fault fault) {
  switch (fault) {
    case Fault::false_negative:
      return "false negative";
    case Fault::false_positive:
      return "false positive";
    case Fault::late_toi:
      return "late toi";
    case Fault::early_toi_upper:
      return "early toi_upper";
    case Fault::beyond_tolerance:
      return "beyond tolerance";
    default:
      return "error";
  }
}

std::string to_text(const std::string& solver, const WrongAnswer& wrong) {
  return fmt::format("{}: {}: {}, the truth is {}", solver, to_string(wrong.fault), wrong.answer,
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

double Judgement::nanoseconds_per_query() const {
  return queries == 0 ? 0.0 : nanoseconds / static_cast<double>(queries);
}

void Judgement::add(const GroundTruth& truth, const fast::Answer& answer,
                    const solvers::Failure* failure) {
  using fast::Verdict;
  ++queries;
  checks += answer.checks;
  Verdict verdict = answer.verdict;
  const auto why = failure != nullptr ? std::optional(*failure) : solvers::failure_of(answer);
  if (why) {
    ++failures[static_cast<std::size_t>(why->kind)];
    verdict = solvers::verdict_of(why->kind);
    if (verdict == Verdict::error) {
      add_fault(Fault::error, truth, answer, why);
      return;
    }
  }
  undecided += verdict == Verdict::undecided ? 1U : 0U;
  if (truth.collides) {
    if (verdict == Verdict::no) add_fault(Fault::false_negative, truth, answer);
    if (verdict == Verdict::yes) add_toi(truth, answer);
  } else if (verdict != Verdict::no) {
    add_fault(Fault::false_positive, truth, answer, why);
  }
}

void Judgement::add_toi(const GroundTruth& truth, const fast::Answer& answer) {
  const auto [lower, upper] = truth.toi.value();
  // No comparison holds for a NaN, which marks a missing field.
  if (answer.toi_lower > lower) add_fault(Fault::late_toi, truth, answer);
  if (answer.toi_upper < upper) add_fault(Fault::early_toi_upper, truth, answer);
  if (std::isnan(answer.toi_lower)) return;
  // The farther of the two ends of the truth, so that no error is understated.
  toi_errors.add(std::max(upper - answer.toi_lower, answer.toi_lower - lower));
}

void Judgement::add_fault(Fault fault, const GroundTruth& truth, const fast::Answer& answer,
                          const std::optional<solvers::Failure>& failure) {
  auto& count = faults[static_cast<std::size_t>(fault)];
  if (++count > most_kept) return;
  wrong_answers.push_back(
      {fault, truth.index,
       fault == Fault::error && failure ? solvers::to_text(*failure) : answer_text(fault, answer),
       to_text(truth), answer, failure});
}

void Judgement::add_beyond_tolerance(const GroundTruth& truth, const fast::Answer& answer) {
  add_fault(Fault::beyond_tolerance, truth, answer);
}

void Judgement::add_missing(std::uint64_t index) {
  if (!first_missing) first_missing = index;
  ++missing;
}

void Judgement::add_unplaced_crashes(std::uint64_t crashes) {
  unplaced_crashes += crashes;
  faults[static_cast<std::size_t>(Fault::error)] += crashes;
}

Judgement& Judgement::operator+=(const Judgement& next) {
  std::array<std::uint64_t, fault_count> so_far = faults;
  for (const WrongAnswer& wrong : next.wrong_answers) {
    if (++so_far[static_cast<std::size_t>(wrong.fault)] <= most_kept) {
      wrong_answers.push_back(wrong);
    }
  }
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i] += next.faults[i];
  for (std::size_t i = 0; i < failures.size(); ++i) failures[i] += next.failures[i];
  queries += next.queries;
  missing += next.missing;
  if (!first_missing) first_missing = next.first_missing;
  unplaced_crashes += next.unplaced_crashes;
  undecided += next.undecided;
  checks += next.checks;
  nanoseconds += next.nanoseconds;
  toi_errors += next.toi_errors;
  return *this;
}

bool breaks(Fault fault, fast::Promise promise) {
  return fault != Fault::false_positive || promise == fast::Promise::exact;
}

bool keeps(const Judgement& judgement, fast::Promise promise) {
  for (std::size_t i = 0; i < fault_count; ++i) {
    if (judgement.faults[i] != 0 && breaks(static_cast<Fault>(i), promise)) return false;
  }
  return true;
}

}  // namespace touchstone::verify::judge
