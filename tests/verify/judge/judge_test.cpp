#include "verify/judge/judgement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/oracle.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::verify::judge::judge_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;

constexpr double infinity = std::numeric_limits<double>::infinity();

GroundTruth miss() { return {.index = 7, .collides = false, .toi = std::nullopt}; }

GroundTruth hit(double lower, double upper) {
  return {.index = 8, .collides = true, .toi = exact::DoubleInterval{lower, upper}};
}

double above(double x) { return std::nextafter(x, infinity); }
double below(double x) { return std::nextafter(x, -infinity); }

Judgement judge(const GroundTruth& truth, const Answer& answer) {
  Judgement judgement;
  judgement.add(truth, answer);
  EXPECT_EQ(judgement.queries, 1U);
  return judgement;
}

std::uint64_t all_faults(const Judgement& judgement) {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : judgement.faults) sum += count;
  EXPECT_EQ(judgement.wrong_answers.size(), sum);
  return sum;
}

TEST(Judge, EveryVerdictHasItsColumn) {
  const GroundTruth collision = hit(0.5, 0.5);
  EXPECT_EQ(all_faults(judge(collision, {.verdict = Verdict::yes})), 0U);
  EXPECT_EQ(all_faults(judge(miss(), {.verdict = Verdict::no})), 0U);

  const Judgement false_negative = judge(collision, {.verdict = Verdict::no});
  EXPECT_EQ(all_faults(false_negative), 1U);
  EXPECT_EQ(false_negative.count(Fault::false_negative), 1U);
  EXPECT_EQ(false_negative.wrong_answers[0].fault, Fault::false_negative);
  EXPECT_EQ(false_negative.wrong_answers[0].index, 8U);
  EXPECT_EQ(false_negative.wrong_answers[0].answer, "no");
  EXPECT_EQ(false_negative.wrong_answers[0].truth, "collision at 0.5");

  const Judgement false_positive = judge(miss(), {.verdict = Verdict::yes});
  EXPECT_EQ(all_faults(false_positive), 1U);
  EXPECT_EQ(false_positive.count(Fault::false_positive), 1U);
  EXPECT_EQ(false_positive.wrong_answers[0].truth, "no collision");

  for (const GroundTruth& truth : {collision, miss()}) {
    const Judgement error = judge(truth, {.verdict = Verdict::error});
    EXPECT_EQ(all_faults(error), 1U);
    EXPECT_EQ(error.count(Fault::error), 1U);
  }
}

/// Late by less than a spacing of doubles: the printed end of the enclosure is not the time.
TEST(Judge, ATimeBesideTheExactOneIsSeenToBeWrong) {
  const GroundTruth third = hit(0.3333333333333333, 0.33333333333333337);
  const Judgement late = judge(third, {.verdict = Verdict::yes, .toi_lower = 0.33333333333333337});
  ASSERT_EQ(late.count(Fault::late_toi), 1U);
  EXPECT_EQ(late.wrong_answers[0].answer, "toi_lower 0.33333333333333337");
  EXPECT_EQ(late.wrong_answers[0].truth,
            "collision after 0.3333333333333333 and before 0.33333333333333337");
}

TEST(Judge, UndecidedIsAConservativeYesInAColumnOfItsOwn) {
  const Judgement of_hit = judge(hit(0.5, 0.5), {.verdict = Verdict::undecided});
  EXPECT_EQ(of_hit.undecided, 1U);
  EXPECT_EQ(all_faults(of_hit), 0U);
  const Judgement of_miss = judge(miss(), {.verdict = Verdict::undecided});
  EXPECT_EQ(of_miss.undecided, 1U);
  EXPECT_EQ(all_faults(of_miss), 1U);
  EXPECT_EQ(of_miss.count(Fault::false_positive), 1U);
  EXPECT_EQ(of_miss.wrong_answers[0].answer, "undecided");
}

TEST(Judge, ATimeIsLateByTheLastBit) {
  // The exact time is strictly between neighbouring doubles.
  const double before = 0.1, after = above(0.1);
  const auto faults = [&](double toi_lower, double toi_upper) {
    const Judgement judgement =
        judge(hit(before, after),
              {.verdict = Verdict::yes, .toi_lower = toi_lower, .toi_upper = toi_upper});
    all_faults(judgement);
    return std::pair(judgement.count(Fault::late_toi), judgement.count(Fault::early_toi_upper));
  };
  using Counts = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(faults(before, after), Counts(0, 0));
  EXPECT_EQ(faults(after, after), Counts(1, 0));
  EXPECT_EQ(faults(before, before), Counts(0, 1));
  EXPECT_EQ(faults(after, before), Counts(1, 1));
  EXPECT_EQ(faults(Answer::none, Answer::none), Counts(0, 0));
}

TEST(Judge, ATimeThatIsNotFiniteIsAnError) {
  for (const Answer& answer : {Answer{.verdict = Verdict::yes, .toi_lower = infinity},
                               Answer{.verdict = Verdict::yes, .toi_upper = infinity},
                               Answer{.verdict = Verdict::yes, .toi_lower = -infinity}}) {
    const Judgement judgement = judge(hit(0.1, above(0.1)), answer);
    EXPECT_EQ(judgement.count(Fault::error), 1U);
    EXPECT_EQ(all_faults(judgement), 1U);
    EXPECT_EQ(judgement.count(judge::Fault::not_finite), 1U);
    EXPECT_EQ(judgement.toi_errors.count(), 0U);
  }
}

TEST(Judge, CountsFailuresByTheirKind) {
  Judgement judgement;
  const GroundTruth truth = hit(0.25, 0.25);
  for (const judge::Fault kind : judge::failures) {
    const judge::Failure failure{.kind = kind, .number = 3};
    judgement.add(truth, {.verdict = judge::verdict_of(kind)}, &failure);
  }
  // Without a failure the answer shows it.
  judgement.add(truth, {.verdict = Verdict::error});
  judgement.add(truth, {.verdict = Verdict::undecided});
  for (const judge::Fault kind : judge::failures) {
    const bool is_shown =
        kind == judge::Fault::no_verdict || kind == judge::Fault::undecided;
    EXPECT_EQ(judgement.count(kind), is_shown ? 2U : 1U) << solvers::to_string(kind);
  }
  // A hang is no answer of the solver's, and taken for one that it is undecided.
  EXPECT_EQ(judgement.undecided, 3U);
  EXPECT_EQ(judgement.count(Fault::error), 6U);
  EXPECT_EQ(judgement.wrong_answers.at(1).answer, "exit: status 3");
  const Judgement once = judgement;
  judgement += once;
  EXPECT_EQ(judgement.count(judge::Fault::hang), 2U);
}

TEST(Judge, ATimeThatIsADoubleMayBeHit) {
  const auto late = [](double toi_lower) {
    return judge(hit(0.25, 0.25), {.verdict = Verdict::yes, .toi_lower = toi_lower})
        .count(Fault::late_toi);
  };
  const auto early = [](double toi_upper) {
    return judge(hit(0.25, 0.25), {.verdict = Verdict::yes, .toi_upper = toi_upper})
        .count(Fault::early_toi_upper);
  };
  EXPECT_EQ(late(0.25), 0U);
  EXPECT_EQ(late(above(0.25)), 1U);
  EXPECT_EQ(early(0.25), 0U);
  EXPECT_EQ(early(below(0.25)), 1U);
}

TEST(Judge, TimesOfOtherVerdictsAndOfMissesAreNotJudged) {
  for (const Verdict verdict : {Verdict::no, Verdict::undecided, Verdict::error}) {
    const Judgement judgement =
        judge(hit(0.25, 0.25), {.verdict = verdict, .toi_lower = 1.0, .toi_upper = 0.0});
    EXPECT_EQ(judgement.count(Fault::late_toi), 0U);
    EXPECT_EQ(judgement.count(Fault::early_toi_upper), 0U);
    EXPECT_EQ(judgement.toi_errors.count(), 0U);
  }
  const Judgement of_miss = judge(miss(), {.verdict = Verdict::yes, .toi_lower = 1.0});
  EXPECT_EQ(of_miss.count(Fault::late_toi), 0U);
  EXPECT_EQ(of_miss.toi_errors.count(), 0U);
}

/// The comparisons with the enclosure against those with the algebraic number itself.
TEST(Judge, AgreesWithExactComparison) {
  tests::Random random(41);
  int compared = 0, between_doubles = 0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
    const Query query = tests::random_query(random, kind, tests::all_families[i % 4]).query;
    const exact::Verdict verdict = exact::decide(kind, query);
    if (!verdict.collides()) continue;
    const exact::AlgebraicNumber& toi = *verdict.toi;
    const exact::DoubleInterval enclosure = toi.enclosure();
    between_doubles += enclosure.lower < enclosure.upper ? 1 : 0;
    for (const double t : {enclosure.lower, enclosure.upper, below(enclosure.lower),
                           above(enclosure.upper), random.uniform()}) {
      const Judgement judgement = judge(hit(enclosure.lower, enclosure.upper),
                                        {.verdict = Verdict::yes, .toi_lower = t, .toi_upper = t});
      EXPECT_EQ(judgement.count(Fault::late_toi) == 1, toi < exact::Rational(t));
      EXPECT_EQ(judgement.count(Fault::early_toi_upper) == 1, toi > exact::Rational(t));
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(between_doubles, 100);
}

TEST(Judge, ToiErrorIsTheDistanceNeverUnderstated) {
  const auto error = [](double lower, double upper, double toi_lower) {
    return judge(hit(lower, upper), {.verdict = Verdict::yes, .toi_lower = toi_lower})
        .toi_errors.max();
  };
  EXPECT_EQ(error(0.5, 0.5, 0.125), 0.375);
  EXPECT_EQ(error(0.5, 0.5, 0.5), 0.0);
  EXPECT_EQ(error(0.5, 0.5, 0.75), 0.25) << "late";
  EXPECT_EQ(error(0.5, above(0.5), 0.5), 0x1p-53);
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

TEST(ToiErrors, AddUp) {
  ToiErrors first, second, both;
  for (int i = 1; i <= 100; ++i) {
    (i % 3 == 0 ? first : second).add(1.0 / i);
    both.add(1.0 / i);
  }
  first += second;
  EXPECT_EQ(first.count(), both.count());
  EXPECT_EQ(first.max(), both.max());
  for (const double fraction : {0.1, 0.5, 0.99}) {
    EXPECT_EQ(first.quantile(fraction), both.quantile(fraction));
  }
}

TEST(Judgement, AddsUpInOrder) {
  Judgement sum = judge(hit(0.5, 0.5), {.verdict = Verdict::no, .checks = 3});
  sum.nanoseconds = 10;
  Judgement next = judge(miss(), {.verdict = Verdict::undecided, .checks = 4});
  next.nanoseconds = 30;
  next.add_missing(11);
  next.add_missing(12);
  sum += next;
  EXPECT_EQ(sum.queries, 2U);
  EXPECT_EQ(sum.undecided, 1U);
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
    for (int i = 0; i < 700; ++i) next.add(hit(0.5, 0.5), {.verdict = Verdict::no});
    for (int i = 0; i < 10; ++i) next.add(miss(), {.verdict = Verdict::yes});
    sum += next;
  }
  EXPECT_EQ(sum.count(Fault::false_negative), 2100U);
  EXPECT_EQ(sum.count(Fault::false_positive), 30U);
  EXPECT_EQ(sum.wrong_answers.size(), Judgement::most_kept + 30);
  Judgement alone;
  for (int i = 0; i < 1500; ++i) alone.add(hit(0.5, 0.5), {.verdict = Verdict::no});
  EXPECT_EQ(alone.count(Fault::false_negative), 1500U);
  EXPECT_EQ(alone.wrong_answers.size(), Judgement::most_kept);
}

TEST(Judgement, CrashesAtNoQueryAreErrorsThatBreakEveryPromise) {
  Judgement judgement, sum;
  judgement.add_unplaced_crashes(0);
  EXPECT_TRUE(keeps(judgement, fast::Promise::none));
  judgement.add_unplaced_crashes(2);
  sum += judgement;
  sum += judgement;
  EXPECT_EQ(sum.unplaced_crashes, 4U);
  EXPECT_EQ(sum.count(Fault::error), 4U);
  EXPECT_EQ(sum.queries, 0U);
  EXPECT_FALSE(keeps(sum, fast::Promise::none));
}

TEST(Promises, OnlyExactnessForbidsFalsePositives) {
  const Judgement false_positive = judge(miss(), {.verdict = Verdict::yes});
  const Judgement late = judge(hit(0.5, 0.5), {.verdict = Verdict::yes, .toi_lower = above(0.5)});
  const Judgement early = judge(hit(0.5, 0.5), {.verdict = Verdict::yes, .toi_upper = 0.25});
  const Judgement undecided = judge(hit(0.5, 0.5), {.verdict = Verdict::undecided});
  EXPECT_FALSE(keeps(false_positive, Promise::exact));
  EXPECT_TRUE(keeps(false_positive, Promise::conservative));
  EXPECT_TRUE(keeps(false_positive, Promise::none));
  for (const Promise promise : {Promise::none, Promise::conservative, Promise::exact}) {
    EXPECT_FALSE(keeps(judge(hit(0.5, 0.5), {.verdict = Verdict::no}), promise));
    EXPECT_FALSE(keeps(judge(miss(), {.verdict = Verdict::error}), promise));
    EXPECT_FALSE(keeps(late, promise));
    EXPECT_FALSE(keeps(early, promise));
    EXPECT_TRUE(keeps(undecided, promise));
    EXPECT_TRUE(keeps(Judgement{}, promise));
  }
}

}  // namespace
}  // namespace touchstone::verify::judge::judge_test
