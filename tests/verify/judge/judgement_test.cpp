#include "verify/judge/judgement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::verify::judge::judgement_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;

constexpr double infinity = std::numeric_limits<double>::infinity();

const GroundTruth no_collision{.index = 7, .collides = false, .toi = std::nullopt};

GroundTruth collision(double lower, double upper) {
  return {.index = 8, .collides = true, .toi = exact::DoubleInterval{lower, upper}};
}

/// Adds an answer without regard to its query. Its tolerance, if it has one, is compared with the
/// distance of two points at one place, which never contradicts it.
void add(Judgement& judgement, const GroundTruth& truth, const Answer& answer,
         const Failure* failure = nullptr) {
  const base::AnyQuery query;
  judgement.add({query.queries()}, truth, answer, {}, failure);
}

Judgement judged(const GroundTruth& truth, const Answer& answer) {
  Judgement judgement;
  add(judgement, truth, answer);
  return judgement;
}

TEST(Judgement, CountsAndListsFaults) {
  Judgement judgement;
  add(judgement, collision(0.5, 0.5), {.verdict = Verdict::no});
  add(judgement, no_collision, {.verdict = Verdict::yes});
  add(judgement, no_collision, {.verdict = Verdict::undecided});
  add(judgement, collision(0.5, 0.5), {.verdict = Verdict::undecided});
  add(judgement, no_collision, {.verdict = Verdict::error});
  // The answer is late by less than a spacing of doubles: the printed end of the enclosure is not
  // the time.
  add(judgement, collision(0.3333333333333333, 0.33333333333333337),
      {.verdict = Verdict::yes, .toi_lower = 0.33333333333333337});
  EXPECT_EQ(judgement.queries, 6U);
  EXPECT_EQ(judgement.count(Fault::false_negative), 1U);
  EXPECT_EQ(judgement.count(Fault::false_positive), 2U);
  EXPECT_EQ(judgement.undecided(), 2U);
  EXPECT_EQ(judgement.errors(), 1U);
  std::vector<std::string> texts;
  for (const WrongAnswer& wrong : judgement.wrong_answers) texts.push_back(to_text("S", wrong));
  EXPECT_EQ(texts, (std::vector<std::string>{
                       "S: false negative: no, the truth is collision at 0.5",
                       "S: false positive: yes, the truth is no collision",
                       "S: false positive: undecided, the truth is no collision",
                       "S: error: no_verdict, the truth is no collision",
                       "S: late toi: toi_lower 0.33333333333333337, the truth is collision after "
                       "0.3333333333333333 and before 0.33333333333333337"}));
  EXPECT_EQ(judgement.wrong_answers[0].index, 8U);
}

TEST(Judgement, CountsFailuresByTheirKind) {
  Judgement judgement;
  const GroundTruth truth = collision(0.25, 0.25);
  for (const Fault kind : all_failures) {
    const Failure failure{.kind = kind, .number = 3};
    add(judgement, truth, {.verdict = verdict_of(kind)}, &failure);
  }
  // Without a failure the verdict determines the fault.
  add(judgement, truth, {.verdict = Verdict::error});
  add(judgement, truth, {.verdict = Verdict::undecided});
  for (const Fault kind : all_failures) {
    const bool is_shown = kind == Fault::no_verdict || kind == Fault::undecided;
    EXPECT_EQ(judgement.count(kind), is_shown ? 2U : 1U) << to_string(kind);
  }
  // A hang is not an answer, and counts as undecided.
  EXPECT_EQ(judgement.undecided(), 3U);
  EXPECT_EQ(judgement.errors(), 6U);
  EXPECT_EQ(judgement.wrong_answers.at(1).answer, "exit: status 3");
  const Judgement once = judgement;
  judgement += once;
  EXPECT_EQ(judgement.count(Fault::hang), 2U);
}

TEST(Judgement, ToiErrorIsTheDistanceNeverUnderstated) {
  const auto error = [](double lower, double upper, double toi_lower) {
    return judged(collision(lower, upper), {.verdict = Verdict::yes, .toi_lower = toi_lower})
        .toi_errors.max();
  };
  EXPECT_EQ(error(0.5, 0.5, 0.125), 0.375);
  EXPECT_EQ(error(0.5, 0.5, 0.5), 0.0);
  EXPECT_EQ(error(0.5, 0.5, 0.75), 0.25) << "late";
  EXPECT_EQ(error(0.5, std::nextafter(0.5, 1.0), 0.5), 0x1p-53);
}

TEST(ToiErrors, ComeBackFromJsonAndAddUpAsBefore) {
  ToiErrors first, second;
  tests::Random random(6);
  for (int i = 0; i < 1000; ++i) {
    (i % 3 == 0 ? first : second).add(i % 7 == 0 ? 0.0 : std::ldexp(random.uniform(), -i % 60));
  }
  first.add(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(to_json(ToiErrors()).is_null());
  EXPECT_EQ(to_json(toi_errors_from_json(to_json(first))), to_json(first));
  ToiErrors sum = toi_errors_from_json(to_json(first));
  sum += toi_errors_from_json(to_json(second));
  EXPECT_EQ(to_json(sum), to_json(first += second));
}

TEST(ToiErrors, QuantilesAreWithinTheirBucketAndTheMaximumIsExact) {
  ToiErrors errors;
  EXPECT_TRUE(std::isnan(errors.quantile(0.5)));
  EXPECT_TRUE(std::isnan(errors.max()));
  std::vector<double> all;
  tests::Random random(5);
  for (int i = 0; i < 10001; ++i) {
    all.push_back(std::ldexp(random.uniform(), -random.between(0, 60)));
    errors.add(all.back());
  }
  std::ranges::sort(all);
  EXPECT_EQ(errors.count(), 10001U);
  EXPECT_EQ(errors.max(), all.back());
  EXPECT_EQ(errors.quantile(1.0), all.back());
  for (const std::size_t rank : {1U, 100U, 5001U, 9001U, 9901U}) {
    const double exact = all[rank - 1];
    const double quantile = errors.quantile(static_cast<double>(rank) / 10001.0);
    EXPECT_GE(quantile, exact);
    EXPECT_LE(quantile, exact * (1.0 + 1.0 / 64.0)) << rank;
  }
}

TEST(ToiErrors, ZerosAreZeros) {
  ToiErrors errors;
  for (int i = 0; i < 9; ++i) errors.add(0.0);
  errors.add(std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(errors.quantile(0.9), 0.0);
  EXPECT_EQ(errors.quantile(1.0), std::numeric_limits<double>::denorm_min());
  errors.add(infinity);
  EXPECT_EQ(errors.quantile(1.0), infinity);
}

TEST(Judgement, AddsUpInOrder) {
  Judgement sum = judged(collision(0.5, 0.5), {.verdict = Verdict::no, .checks = 3});
  sum.nanoseconds = 10;
  Judgement next = judged(no_collision, {.verdict = Verdict::undecided, .checks = 4});
  next.nanoseconds = 30;
  next.add_unasked(Unasked::missing, 11);
  next.add_unasked(Unasked::missing, 12);
  sum += next;
  EXPECT_EQ(sum.queries, 2U);
  EXPECT_EQ(sum.undecided(), 1U);
  EXPECT_EQ(sum.missing, 2U);
  EXPECT_EQ(sum.first_missing, 11U);
  EXPECT_EQ(sum.checks, 7U);
  EXPECT_EQ(sum.nanoseconds_per_query(), 20.0);
  ASSERT_EQ(sum.wrong_answers.size(), 2U);
  EXPECT_EQ(sum.wrong_answers[0].fault, Fault::false_negative);
  EXPECT_EQ(sum.wrong_answers[1].fault, Fault::false_positive);
}

TEST(Judgement, KeepsSoManyWrongAnswersOfAFaultAndCountsAll) {
  Judgement sum;
  for (int block = 0; block < 3; ++block) {
    Judgement next;
    for (int i = 0; i < 700; ++i) add(next, collision(0.5, 0.5), {.verdict = Verdict::no});
    for (int i = 0; i < 10; ++i) add(next, no_collision, {.verdict = Verdict::yes});
    sum += next;
  }
  EXPECT_EQ(sum.count(Fault::false_negative), 2100U);
  EXPECT_EQ(sum.count(Fault::false_positive), 30U);
  EXPECT_EQ(sum.wrong_answers.size(), Judgement::most_kept + 30);
  Judgement alone;
  for (int i = 0; i < 1500; ++i) add(alone, collision(0.5, 0.5), {.verdict = Verdict::no});
  EXPECT_EQ(alone.count(Fault::false_negative), 1500U);
  EXPECT_EQ(alone.wrong_answers.size(), Judgement::most_kept);
}

TEST(Judgement, CrashesAtNoQueryAreErrorsThatBreakEveryPromise) {
  Judgement judgement, sum;
  EXPECT_TRUE(keeps(judgement, fast::Promise::none));
  judgement.unplaced_crashes = 2;
  sum += judgement;
  sum += judgement;
  EXPECT_EQ(sum.unplaced_crashes, 4U);
  EXPECT_EQ(sum.errors(), 4U);
  EXPECT_EQ(sum.queries, 0U);
  EXPECT_FALSE(keeps(sum, fast::Promise::none));
}

}  // namespace
}  // namespace touchstone::verify::judge::judgement_test
