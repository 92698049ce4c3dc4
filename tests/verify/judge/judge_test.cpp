/// \file
/// Single answers as rows {truth, answer, faults}, and what they add up to.

#include "verify/judge/judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/judge/responses.hpp"

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

// ---- Faults and failures ------------------------------------------------------------------------

TEST(Fault, HasANameOfItsOwnAndAText) {
  std::set<std::string_view> names, texts;
  for (const Fault fault : all_faults) {
    names.insert(to_string(fault));
    texts.insert(to_text(fault));
    EXPECT_EQ(fault_from_name(to_string(fault)), fault);
    // Tables count all errors as one.
    EXPECT_EQ(to_text(fault) == "error", is_error(fault));
  }
  EXPECT_EQ(names.size(), fault_count);
  EXPECT_EQ(texts.size(), fault_count - 4);
  EXPECT_EQ(fault_from_name("crashes"), std::nullopt);
}

TEST(Failure, IsALineOfTextAndBack) {
  const std::vector<std::pair<Failure, std::string>> texts{
      {{.kind = Fault::crash, .number = SIGSEGV}, "crash: SIGSEGV"},
      {{.kind = Fault::crash, .number = SIGXFSZ}, "crash: SIGXFSZ"},
      {{.kind = Fault::crash}, "crash: signal 0"},
      {{.kind = Fault::exit, .number = 3}, "exit: status 3"},
      {{.kind = Fault::exception, .what = "a: b"}, "exception: a: b"},
      {{.kind = Fault::no_verdict}, "no_verdict"},
      {{.kind = Fault::not_finite, .what = "toi_lower inf"}, "not_finite: toi_lower inf"},
      {{.kind = Fault::hang}, "hang"},
      {{.kind = Fault::undecided}, "undecided"}};
  for (const auto& [failure, text] : texts) {
    EXPECT_EQ(to_text(failure), text);
    EXPECT_EQ(failure_from_text(text), failure) << text;
  }
  EXPECT_EQ(failure_from_text(""), std::nullopt);
  EXPECT_EQ(failure_from_text("nonsense: crash"), std::nullopt);
  EXPECT_EQ(failure_from_text("false_negative"), std::nullopt) << "no failure";
  EXPECT_EQ(failure_from_text("crash: bang"), Failure{.kind = Fault::crash});
  EXPECT_EQ(to_text({.kind = Fault::exception, .what = "two\nlines\x1b"}),
            "exception: two\\x0alines\\x1b");
}

// ---- Answers ------------------------------------------------------------------------------------

/// Of a collision at 1/2, at a time strictly between neighbouring doubles, and never.
TEST(JudgeVerdict, NamesEveryFault) {
  using enum Fault;
  const GroundTruth half = collision(0.5, 0.5), between = collision(0.1, above(0.1));
  constexpr double none = Answer::none;
  const Answer no{.verdict = Verdict::no}, only_yes{.verdict = Verdict::yes},
      undecided_answer{.verdict = Verdict::undecided}, error{.verdict = Verdict::error};
  const Failure hangs{.kind = hang}, crashes{.kind = crash};
  // An estimate is judged by its error, on both sides; a time that does not count is not judged.
  const fast::Terms estimates{.times = fast::Times::estimates, .time_error = 0.125},
      timeless{.times = fast::Times::none};
  struct Row {
    const GroundTruth& truth;
    Answer answer;
    Faults faults;
    fast::Terms terms = {};
    const Failure* failure = nullptr;
  };
  const std::vector<Row> rows{{half, only_yes, {}},
                              {no_collision, no, {}},
                              {half, no, {false_negative}},
                              {no_collision, only_yes, {false_positive}},
                              {no_collision, yes(1.0, 0.0), {false_positive}},
                              {half, yes(above(0.5), below(0.5)), {late_toi, early_toi_upper}},
                              {half, yes(0.5, 0.5), {}},
                              {half, yes(above(0.5), 1.0), {late_toi}},
                              {half, yes(0.0, below(0.5)), {early_toi_upper}},
                              {between, yes(0.1, above(0.1)), {}},
                              {between, yes(above(0.1), above(0.1)), {late_toi}},
                              {between, yes(0.1, 0.1), {early_toi_upper}},
                              {half, yes(0.625, none), {}, estimates},
                              {half, yes(0.75, none), {late_toi}, estimates},
                              {half, yes(0.375, none), {}, estimates},
                              {half, yes(0.25, none), {early_toi_upper}, estimates},
                              {half, yes(none, 0.75), {late_toi}, estimates},
                              {half, yes(none, none), {}, estimates},
                              {half, yes(0.75, 0.25), {}, timeless},
                              // Undecided and hang are a conservative yes.
                              {half, undecided_answer, {undecided}},
                              {half, undecided_answer, {hang}, {}, &hangs},
                              {no_collision, undecided_answer, {undecided, false_positive}},
                              {no_collision, undecided_answer, {hang, false_positive}, {}, &hangs},
                              {no_collision, error, {crash}, {}, &crashes}};
  for (const auto& [truth, answer, faults, terms, failure] : rows) {
    EXPECT_EQ(judge_verdict(truth, answer, terms, failure), faults) << answer.toi_lower;
  }
  for (const GroundTruth& truth : {half, no_collision}) {
    EXPECT_EQ(judge_verdict(truth, error), Faults{no_verdict});
    for (const Answer& answer :
         {yes(infinity, 1.0), yes(-infinity, 1.0), yes(0.0, infinity), yes(0.0, 1.0, -1.0)}) {
      EXPECT_EQ(judge_verdict(truth, answer), Faults{not_finite});
    }
  }
  // Times of other verdicts are not judged.
  for (const Verdict verdict : {Verdict::no, Verdict::undecided, Verdict::error}) {
    EXPECT_EQ(judge_verdict(half, {.verdict = verdict, .toi_lower = 1.0, .toi_upper = 0.0}),
              judge_verdict(half, {.verdict = verdict}));
  }
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

/// Compares judgements by the enclosure with those by the algebraic number itself.
TEST(JudgeVerdict, AgreesWithExactComparison) {
  tests::Random random(41);
  int compared = 0, between_doubles = 0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const ContactKind kind = random.coin() ? ContactKind::vertex_face : ContactKind::edge_edge;
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

// ---- Judgements ---------------------------------------------------------------------------------

// Counts, texts and kinds of failures are in tests/transcripts/certify_{solvers,plugins}.md.

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

TEST(Judgement, ToiErrorIsTheDistanceNeverUnderstated) {
  const auto error = [](double lower, double upper, double toi_lower) {
    return judged(collision(lower, upper), yes(toi_lower, Answer::none)).toi_errors.max();
  };
  EXPECT_EQ(error(0.5, 0.5, 0.125), 0.375);
  EXPECT_EQ(error(0.5, 0.5, 0.5), 0.0);
  EXPECT_EQ(error(0.5, 0.5, 0.75), 0.25) << "late";
  EXPECT_EQ(error(0.5, above(0.5), 0.5), 0x1p-53);
}

TEST(ToiErrors, ComeBackFromJsonAndAddUpAsBefore) {
  ToiErrors first, second;
  tests::Random random(6);
  for (int i = 0; i < 1000; ++i) {
    (i % 3 == 0 ? first : second).add(i % 7 == 0 ? 0.0 : std::ldexp(random.uniform(), -i % 60));
  }
  first.add(infinity);
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
  ToiErrors zeros;
  for (int i = 0; i < 9; ++i) zeros.add(0.0);
  zeros.add(std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(zeros.quantile(0.9), 0.0);
  EXPECT_EQ(zeros.quantile(1.0), std::numeric_limits<double>::denorm_min());
  zeros.add(infinity);
  EXPECT_EQ(zeros.quantile(1.0), infinity);
}

TEST(Judgement, AddsUpInOrder) {
  Judgement sum = judged(collision(0.5, 0.5), {.verdict = Verdict::no});
  sum.nanoseconds = 10;
  Judgement next = judged(no_collision, {.verdict = Verdict::undecided});
  next.nanoseconds = 30;
  next.add_unasked(Unasked::missing, 11);
  next.add_unasked(Unasked::missing, 12);
  next.unplaced_crashes = 2;
  sum += next;
  EXPECT_EQ(sum.queries, 2U);
  EXPECT_EQ(sum.errors(), 2U) << "crashes at no query";
  EXPECT_EQ(sum.undecided(), 1U);
  EXPECT_EQ(sum.missing, 2U);
  EXPECT_EQ(sum.first_missing, 11U);
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

/// One hang in a hundred queries is allowed; no answer at all is no judgement.
TEST(Responses, ThatAreMissingAreAFault) {
  EXPECT_FALSE(silence_of("a", {}));
  EXPECT_FALSE(silence_of("a", {.asked = 100, .hangs = 1, .unasked = 5}));
  const auto often = silence_of("a", {.asked = 199, .hangs = 2});
  ASSERT_TRUE(often);
  EXPECT_FALSE(often->is_unjudged);
  for (const Responses& none :
       {Responses{.unasked = 1}, Responses{.asked = 3, .hangs = 1, .errors = 2}}) {
    const auto silence = silence_of("a", none);
    ASSERT_TRUE(silence);
    EXPECT_TRUE(silence->is_unjudged);
    EXPECT_NE(silence->text.find("a was not judged"), std::string::npos);
  }
}

}  // namespace
}  // namespace touchstone::verify::judge::judge_test
