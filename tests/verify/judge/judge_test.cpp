#include "verify/judge/judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::judge::judge_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using Faults = std::vector<Fault>;

constexpr double infinity = std::numeric_limits<double>::infinity();

const GroundTruth no_collision{.index = 7, .collides = false, .toi = std::nullopt};

GroundTruth collision(double lower, double upper) {
  return {.index = 8, .collides = true, .toi = exact::DoubleInterval{lower, upper}};
}

double above(double x) { return std::nextafter(x, infinity); }
double below(double x) { return std::nextafter(x, -infinity); }

Answer yes(double lower, double upper, double tolerance = Answer::none) {
  return {.verdict = Verdict::yes, .toi_lower = lower, .toi_upper = upper, .tolerance = tolerance};
}

/// An estimate is judged by its error, on both sides; a time that does not count is not judged.
TEST(JudgeVerdict, TimesAreJudgedByWhatTheyAre) {
  const GroundTruth half = collision(0.5, 0.5);
  const fast::Terms estimates{.times = fast::Times::estimates, .time_error = 0.125};
  const fast::Terms none{.times = fast::Times::none};
  EXPECT_EQ(judge_verdict(half, yes(0.625, Answer::none), estimates), Faults{});
  EXPECT_EQ(judge_verdict(half, yes(0.75, Answer::none), estimates), Faults{Fault::late_toi});
  EXPECT_EQ(judge_verdict(half, yes(0.375, Answer::none), estimates), Faults{});
  EXPECT_EQ(judge_verdict(half, yes(0.25, Answer::none), estimates),
            Faults{Fault::early_toi_upper});
  EXPECT_EQ(judge_verdict(half, yes(Answer::none, 0.75), estimates), Faults{Fault::late_toi});
  EXPECT_EQ(judge_verdict(half, yes(Answer::none, Answer::none), estimates), Faults{});
  EXPECT_EQ(judge_verdict(half, yes(0.75, 0.25), none), Faults{});
}

TEST(Lateness, IsInUnitsOfTheStepAndInUlps) {
  const GroundTruth half = collision(0.5, 0.5);
  EXPECT_FALSE(lateness_of(half, yes(0.5, 1.0), {}));
  EXPECT_FALSE(lateness_of(no_collision, yes(0.5, 1.0), {}));
  EXPECT_FALSE(lateness_of(half, {.verdict = Verdict::no, .toi_lower = 1.0}, {}));
  EXPECT_FALSE(lateness_of(half, yes(1.0, 1.0), {.times = fast::Times::none}));
  const auto ulp = lateness_of(half, yes(above(0.5), 1.0), {});
  ASSERT_TRUE(ulp);
  EXPECT_EQ(ulp->step, 0x1p-53);
  EXPECT_EQ(ulp->ulps, 1.0);
  EXPECT_TRUE(is_slight(Fault::late_toi, ulp));
  EXPECT_FALSE(is_slight(Fault::false_negative, ulp));
  const auto much = lateness_of(half, yes(0.75, 1.0), {});
  ASSERT_TRUE(much);
  EXPECT_EQ(much->step, 0.25);
  EXPECT_FALSE(is_slight(Fault::late_toi, much));
}

TEST(Harm, IsInTheOrderOfWhatHurtsASimulation) {
  const auto harm = [](Fault fault, bool is_slight = false) {
    return harm_of(fault, is_slight, fast::Promise::exact);
  };
  EXPECT_LT(harm(Fault::false_negative), harm(Fault::late_toi));
  EXPECT_LT(harm(Fault::late_toi), harm(Fault::early_toi_upper));
  EXPECT_LT(harm(Fault::early_toi_upper), harm(Fault::false_positive));
  EXPECT_LT(harm(Fault::asymmetry), harm(Fault::late_toi, true));
  EXPECT_LT(harm(Fault::late_toi, true), harm(Fault::crash));
  EXPECT_LT(harm(Fault::crash), harm(Fault::undecided));
  // What the promise allows comes behind all that it excludes.
  EXPECT_LT(harm_of(Fault::crash, false, fast::Promise::conservative),
            harm_of(Fault::false_positive, false, fast::Promise::conservative));
}

TEST(JudgeVerdict, NamesEveryFault) {
  const GroundTruth half = collision(0.5, 0.5);
  EXPECT_EQ(judge_verdict(half, {.verdict = Verdict::yes}), Faults{});
  EXPECT_EQ(judge_verdict(no_collision, {.verdict = Verdict::no}), Faults{});
  EXPECT_EQ(judge_verdict(half, {.verdict = Verdict::no}), Faults{Fault::false_negative});
  EXPECT_EQ(judge_verdict(no_collision, {.verdict = Verdict::yes}), Faults{Fault::false_positive});
  EXPECT_EQ(judge_verdict(half, yes(above(0.5), below(0.5))),
            (Faults{Fault::late_toi, Fault::early_toi_upper}));
  for (const GroundTruth& truth : {half, no_collision}) {
    EXPECT_EQ(judge_verdict(truth, {.verdict = Verdict::error}), Faults{Fault::no_verdict});
    for (const Answer& answer :
         {yes(infinity, 1.0), yes(-infinity, 1.0), yes(0.0, infinity), yes(0.0, 1.0, -1.0)}) {
      EXPECT_EQ(judge_verdict(truth, answer), Faults{Fault::not_finite});
    }
  }
}

TEST(JudgeVerdict, UndecidedAndHangAreAConservativeYes) {
  const Failure hang{.kind = Fault::hang};
  const Answer undecided{.verdict = Verdict::undecided};
  EXPECT_EQ(judge_verdict(collision(0.5, 0.5), undecided), Faults{Fault::undecided});
  EXPECT_EQ(judge_verdict(collision(0.5, 0.5), undecided, {}, &hang), Faults{Fault::hang});
  EXPECT_EQ(judge_verdict(no_collision, undecided),
            (Faults{Fault::undecided, Fault::false_positive}));
  EXPECT_EQ(judge_verdict(no_collision, undecided, {}, &hang),
            (Faults{Fault::hang, Fault::false_positive}));
  const Failure crash{.kind = Fault::crash};
  EXPECT_EQ(judge_verdict(no_collision, {.verdict = Verdict::error}, {}, &crash),
            Faults{Fault::crash});
}

TEST(JudgeVerdict, ATimeIsLateByTheLastBit) {
  // The exact time is strictly between neighbouring doubles, or is a double.
  const GroundTruth between = collision(0.1, above(0.1)), quarter = collision(0.25, 0.25);
  EXPECT_EQ(judge_verdict(between, yes(0.1, above(0.1))), Faults{});
  EXPECT_EQ(judge_verdict(between, yes(above(0.1), above(0.1))), Faults{Fault::late_toi});
  EXPECT_EQ(judge_verdict(between, yes(0.1, 0.1)), Faults{Fault::early_toi_upper});
  EXPECT_EQ(judge_verdict(between, yes(Answer::none, Answer::none)), Faults{});
  EXPECT_EQ(judge_verdict(quarter, yes(0.25, 0.25)), Faults{});
  EXPECT_EQ(judge_verdict(quarter, yes(above(0.25), 1.0)), Faults{Fault::late_toi});
  EXPECT_EQ(judge_verdict(quarter, yes(0.0, below(0.25))), Faults{Fault::early_toi_upper});
}

TEST(JudgeVerdict, TimesOfOtherVerdictsAndOfMissesAreNotJudged) {
  for (const Verdict verdict : {Verdict::no, Verdict::undecided, Verdict::error}) {
    const Answer answer{.verdict = verdict, .toi_lower = 1.0, .toi_upper = 0.0};
    EXPECT_EQ(judge_verdict(collision(0.25, 0.25), answer),
              judge_verdict(collision(0.25, 0.25), {.verdict = verdict}));
  }
  EXPECT_EQ(judge_verdict(no_collision, yes(1.0, 0.0)), Faults{Fault::false_positive});
}

/// Compares judgements by the enclosure with those by the algebraic number itself.
TEST(JudgeVerdict, AgreesWithExactComparison) {
  tests::Random random(41);
  int compared = 0, between_doubles = 0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
    const Query query = tests::random_query(random, kind, tests::all_families[i % 4]).query;
    const exact::Decision verdict = exact::decide(kind, query);
    if (!verdict.collides()) continue;
    const exact::AlgebraicNumber& toi = *verdict.toi;
    const exact::DoubleInterval enclosure = toi.enclosure();
    between_doubles += enclosure.lower < enclosure.upper ? 1 : 0;
    for (const double t : {enclosure.lower, enclosure.upper, below(enclosure.lower),
                           above(enclosure.upper), random.uniform()}) {
      const Faults faults = judge_verdict(truth_of(0, verdict), yes(t, t));
      EXPECT_EQ(std::ranges::count(faults, Fault::late_toi) == 1, toi < exact::Rational(t));
      EXPECT_EQ(std::ranges::count(faults, Fault::early_toi_upper) == 1, toi > exact::Rational(t));
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(between_doubles, 100);
}

/// The primitives come within 1 in L∞ at the end, but no nearer.
TEST(Judge, HoldsAYesToItsTolerance) {
  const tests::PosedQuery never = tests::over_triangle(1, 1, 2, 1);
  const auto faults = [&](const Answer& answer, const Separation& separation = {},
                          const Failure* failure = nullptr) {
    return judge({{never.kind, {&never.query, 1}}, separation}, no_collision, answer, {}, failure);
  };
  const Faults only{Fault::false_positive}, beyond{Fault::false_positive, Fault::beyond_tolerance};
  // The distance at this time suffices, or only the oracle decides.
  for (const double toi : {1.0, 0.0, Answer::none}) {
    EXPECT_EQ(faults(yes(toi, 1.0, 1.0)), only);
    EXPECT_EQ(faults(yes(toi, 1.0, below(1.0))), beyond);
  }
  EXPECT_EQ(faults(yes(1.0, 1.0)), only) << "it claims nothing";
  EXPECT_EQ(faults(yes(1.0, 1.0, infinity)), only);
  EXPECT_EQ(faults(yes(1.0, 1.0, 0.5), {.distance = 0.5, .norm = Norm::l2}), only);
  EXPECT_EQ(faults(yes(1.0, 1.0, 0.25), {.distance = 0.5, .norm = Norm::l2}), beyond);
  EXPECT_EQ(faults({.verdict = Verdict::undecided, .tolerance = 0.0}),
            (Faults{Fault::undecided, Fault::false_positive}));
  const Failure crash{.kind = Fault::crash};
  EXPECT_EQ(faults(yes(1.0, 1.0, 0.0), {}, &crash), Faults{Fault::crash});
  EXPECT_EQ(judge({{never.kind, {&never.query, 1}}, {.distance = 2.0, .norm = Norm::linf}},
                  collision(0.0, 0.0), yes(0.0, 0.0, 0.0), {}),
            Faults{})
      << "a collision is near enough";
}

TEST(Breaks, OnlyExactnessForbidsFalsePositives) {
  for (const Fault fault : all_faults) {
    for (const Promise promise : {Promise::none, Promise::conservative, Promise::exact}) {
      const bool is_allowed = fault == Fault::hang || fault == Fault::undecided ||
                              (fault == Fault::false_positive && promise != Promise::exact);
      EXPECT_EQ(breaks(fault, promise), !is_allowed) << to_string(fault);
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::judge::judge_test
