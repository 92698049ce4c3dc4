#include "verify/judge/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "verify/base/any_decision.hpp"
#include "verify/io/json.hpp"
#include "verify/judge/terms.hpp"

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

/// True if an answer with this fault alone is wrong.
bool is_wrong(Fault fault) { return fault != Fault::hang && fault != Fault::undecided; }

/// \param norm of the distance that a tolerance claims
std::string answer_text(Fault fault, const fast::Answer& answer, Norm norm) {
  if (fault == Fault::late_toi) return fmt::format("toi_lower {}", answer.toi_lower);
  if (fault == Fault::early_toi_upper) return fmt::format("toi_upper {}", answer.toi_upper);
  if (fault == Fault::beyond_tolerance) {
    return fmt::format("yes, tolerance {} ({})", answer.tolerance, to_string(norm));
  }
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

nlohmann::json to_json(const ToiErrors& errors) {
  if (errors.count_ == 0) return {};
  nlohmann::json histogram = nlohmann::json::array();
  for (const auto& [bucket, count] : errors.buckets_) histogram.push_back({bucket, count});
  return {{"count", errors.count_},
          {"p50", io::number_to_json(errors.quantile(0.5))},
          {"p90", io::number_to_json(errors.quantile(0.9))},
          {"p99", io::number_to_json(errors.quantile(0.99))},
          {"max", io::number_to_json(errors.max_)},
          {"histogram", std::move(histogram)}};
}

ToiErrors toi_errors_from_json(const nlohmann::json& json) {
  ToiErrors errors;
  if (json.is_null()) return errors;
  for (const nlohmann::json& item : json.at("histogram")) {
    errors.buckets_[item.at(0)] = item.at(1);
    errors.count_ += item.at(1).get<std::uint64_t>();
  }
  errors.max_ = io::number_from_json(json.at("max"));
  return errors;
}

void LateTimes::add(const Lateness& lateness) {
  ++count;
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    if (lateness.step > thresholds.at(i)) ++beyond.at(i);
  }
  greatest.step = std::max(greatest.step, lateness.step);
  greatest.ulps = std::max(greatest.ulps, lateness.ulps);
}

LateTimes& LateTimes::operator+=(const LateTimes& other) {
  count += other.count;
  for (std::size_t i = 0; i < thresholds.size(); ++i) beyond.at(i) += other.beyond.at(i);
  greatest.step = std::max(greatest.step, other.greatest.step);
  greatest.ulps = std::max(greatest.ulps, other.greatest.ulps);
  return *this;
}

std::uint64_t Judgement::errors() const {
  std::uint64_t sum = unplaced_crashes;
  for (const Fault fault : all_failures) sum += is_error(fault) ? count(fault) : 0;
  return sum;
}

double Judgement::nanoseconds_per_query() const {
  return queries == 0 ? 0.0 : nanoseconds / static_cast<double>(queries);
}

void Judgement::add(const Question& question, const GroundTruth& known, const fast::Answer& answer,
                    const Standard& standard, const Failure* failure) {
  const auto& [query, separation] = question;
  const base::AnyQuery asked = as_asked(standard.terms, {query, 0});
  const bool is_rounded = !std::ranges::equal(asked.numbers(), query.numbers);
  const GroundTruth truth =
      is_rounded ? truth_of(known.index, base::decide(asked.queries(), 0, separation)) : known;
  ++queries;
  collisions += truth.collides ? 1U : 0U;
  const auto why = failure != nullptr ? std::optional(*failure) : failure_of(answer);
  const auto lateness = why ? std::nullopt : lateness_of(truth, answer, standard.terms);
  if (lateness) late.add(*lateness);
  const Question posed{asked.queries(), separation};
  for (const Fault fault : judge(posed, truth, answer, standard, failure)) {
    const bool is_kept = count_kept(fault, is_slight(fault, lateness));
    if (!is_kept || !is_wrong(fault)) continue;
    const bool is_claim = fault == Fault::beyond_tolerance;
    const Norm norm = (is_claim ? claim_of(posed, answer, standard).value() : separation).norm;
    wrong_answers.push_back(
        {fault, truth.index, is_error(fault) ? to_text(*why) : answer_text(fault, answer, norm),
         to_text(truth), answer, why, fault == Fault::late_toi ? lateness : std::nullopt});
  }
  const double time = answer.toi_lower;
  if (!truth.collides || why || answer.verdict != fast::Verdict::yes || std::isnan(time) ||
      standard.terms.times == fast::Times::none) {
    return;
  }
  // The farther of the two ends of the truth, so that no error is understated.
  const auto [lower, upper] = truth.toi.value();
  toi_errors.add(std::max(upper - time, time - lower));
}

void Judgement::add(const fast::Answer& answer, const Failure* failure) {
  ++queries;
  if (const auto why = failure != nullptr ? std::optional(*failure) : failure_of(answer)) {
    ++faults[static_cast<std::size_t>(why->kind)];
  } else if (answer.verdict == fast::Verdict::yes) {
    ++collisions;
  }
}

bool Judgement::count_kept(Fault fault, bool is_slight) {
  const std::uint64_t all = ++faults[static_cast<std::size_t>(fault)];
  if (is_slight) return ++slightly_late <= most_kept;
  return (fault == Fault::late_toi ? all - slightly_late : all) <= most_kept;
}

void Judgement::add_unasked(Unasked why, std::uint64_t index) {
  switch (why) {
    case Unasked::outside:
      ++outside;
      break;
    case Unasked::left_out:
      ++left_out;
      break;
    default:
      if (!first_missing) first_missing = index;
      ++missing;
  }
}

Judgement& Judgement::operator+=(const Judgement& next) {
  const auto so_far = faults;
  const std::uint64_t slightly_late_so_far = slightly_late;
  for (const WrongAnswer& wrong : next.wrong_answers) {
    if (count_kept(wrong.fault, is_slight(wrong.fault, wrong.lateness))) {
      wrong_answers.push_back(wrong);
    }
  }
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i] = so_far[i] + next.faults[i];
  slightly_late = slightly_late_so_far + next.slightly_late;
  queries += next.queries;
  collisions += next.collisions;
  outside += next.outside;
  left_out += next.left_out;
  missing += next.missing;
  if (!first_missing) first_missing = next.first_missing;
  unplaced_crashes += next.unplaced_crashes;
  nanoseconds += next.nanoseconds;
  toi_errors += next.toi_errors;
  late += next.late;
  return *this;
}

bool keeps(const Judgement& judgement, fast::Promise promise) {
  return std::ranges::none_of(all_faults, [&](Fault fault) {
    return judgement.total(fault) != 0 && breaks(fault, promise);
  });
}

}  // namespace touchstone::verify::judge
