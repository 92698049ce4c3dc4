#include "verify/fuzz/recheck.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "fast/method.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/shared_counter.hpp"
#include "touchstone/certified.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/judge/ground_truth.hpp"

namespace touchstone::verify::fuzz::recheck_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;
using namespace std::chrono_literals;

Answer honest(Kind kind, const Query& query) { return answer_of(fast::solve(kind, query)); }

Answer sometimes_wrong(Kind kind, const Query& query) {
  Answer answer = honest(kind, query);
  if (query.at(0, 0, 0) < query.at(1, 2, 1)) answer.verdict = Verdict::no;
  return answer;
}

/// An answer that is late by a tenth of the remaining time.
Answer late(Kind kind, const Query& query) {
  Answer answer = honest(kind, query);
  answer.toi_lower += 0.1 * (1.0 - answer.toi_lower);
  answer.toi_upper = Answer::none;
  return answer;
}

/// The first finding of this fault in a run without simplification.
Finding find(const FunctionMethod& method, const FuzzOptions& options = {}) {
  FuzzOptions search = options;
  search.most_queries = 20'000;
  search.most_groups = 1;
  const FuzzResult result = fuzz(method, search);
  EXPECT_FALSE(result.findings.empty());
  return result.findings.empty() ? Finding{} : result.findings.front();
}

// ---- Asking again -------------------------------------------------------------------------------

TEST(Recheck, AsksAgainAboutAnyQuery) {
  const FunctionMethod method(sometimes_wrong, Promise::none);
  const Finding finding = find(method);
  Recheck recheck(method, finding, {});
  EXPECT_TRUE(recheck.ask(finding.original.query));
  // The first point is raised first, and so never below the point that the method compares it with.
  EXPECT_FALSE(recheck.ask({Kind::vertex_face, tests::over_triangle(8, 8, 1, -1).query}));
  AnyQuery infinite = finding.original.query;
  infinite.numbers().front() = HUGE_VAL;
  EXPECT_FALSE(recheck.ask(infinite));
  EXPECT_FALSE(recheck.ask(finding.original.query, base::Deadline(0.0)));
}

TEST(Recheck, KnowsCrashesHangsAndMissingBounds) {
  const auto ill = [](Kind kind, const Query& query) {
    const double word = query.at(0, 0, 0);
    if (word == 1.0) std::abort();
    if (word == 2.0) std::this_thread::sleep_for(1h);
    Answer answer = honest(kind, query);
    if (word == 0.5) answer.toi_lower = Answer::none;
    return answer;
  };
  const FunctionMethod method(ill, Promise::none);
  const FuzzOptions options{.query_limit_seconds = 0.5};
  const auto query_at = [](double x) {
    return AnyQuery(Kind::vertex_face, tests::over_triangle(x, 0.25, 1, -1).query);
  };
  Finding finding;
  finding.method = "function";
  finding.original.query = query_at(1.0);
  finding.original.answer = {.verdict = Verdict::yes, .toi_lower = Answer::none, .toi_upper = 0.5};
  finding.missing.lower = true;
  const std::array<judge::Fault, 3> kinds{judge::Fault::crash, judge::Fault::hang,
                                          judge::Fault::not_finite};
  const std::array<double, 3> words{1.0, 2.0, 0.5};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    finding.what = kinds.at(i);
    Recheck recheck(method, finding, options);
    for (std::size_t j = 0; j < words.size(); ++j) {
      EXPECT_EQ(recheck.ask(query_at(words.at(j))).has_value(), i == j);
    }
  }
}

// ---- Making simpler -----------------------------------------------------------------------------

/// Expects that all parts of the case agree with its query, by the method and the oracle.
void expect_consistent(const Finding& finding, const FailingCase& failing,
                       const FunctionMethod::Function& function) {
  const Answer answer = function(finding.kind(), failing.query.straight());
  EXPECT_EQ(failing.answer.verdict, answer.verdict);
  EXPECT_EQ(failing.answer.toi_lower, answer.toi_lower);
  const exact::Decision truth = exact::decide(failing.query.queries(), 0, finding.separation);
  EXPECT_EQ(failing.collides, truth.collides());
  EXPECT_EQ(failing.truth, judge::to_text(judge::truth_of(0, truth)));
  EXPECT_NE(failing.detail.find(fmt::format("{}", answer.toi_lower)), std::string::npos)
      << failing.detail;
  EXPECT_EQ(tests::check_text(failing.certificate).accepted(), 1U) << failing.certificate;
  const std::optional<tests::ReadClaim> claim = tests::read_claim(failing.certificate);
  ASSERT_TRUE(claim);
  EXPECT_EQ(AnyQuery(claim->posed.kind, claim->posed.query), failing.query);
  EXPECT_TRUE(tests::is_true(*claim));
}

TEST(Simplify, KeepsAnswerTruthAndCertificateWithTheirQuery) {
  const FunctionMethod method(late, Promise::conservative);
  Finding finding = find(method);
  EXPECT_EQ(finding.what, judge::Fault::late_toi);
  const FailingCase original = finding.original;
  simplify(method, {}, {}, finding);
  EXPECT_EQ(finding.shrinking, Shrinking::complete);
  EXPECT_NE(finding.simplest.query, original.query);
  EXPECT_EQ(finding.original.query, original.query);
  EXPECT_EQ(finding.original.detail, original.detail);
  expect_consistent(finding, finding.simplest, late);
  expect_consistent(finding, finding.original, late);
  EXPECT_NE(finding.simplest.certificate, finding.original.certificate);
}

TEST(Simplify, SaysIfTheTimeWasTooShort) {
  const FunctionMethod method(late, Promise::conservative);
  const Finding found = find(method);
  // A clock that advances at each reading.
  for (const double step : {1.0, 0.2, 0.05}) {
    double now = 0.0;
    const base::Deadline deadline(1.0, [&now, step] { return now += step; });
    Finding finding = found;
    simplify(method, {}, deadline, finding);
    EXPECT_EQ(finding.shrinking, Shrinking::cut_short);
    expect_consistent(finding, finding.simplest, late);
    EXPECT_LE(now, 1.0 + 5.0 * step);
  }
}

TEST(Simplify, SaysIfTheMethodIsNotWrongAlone) {
  const FunctionMethod wrong(late, Promise::conservative), right(honest, Promise::conservative);
  Finding finding = find(wrong);
  simplify(right, {}, {}, finding);
  EXPECT_EQ(finding.shrinking, Shrinking::not_reproduced);
  EXPECT_EQ(finding.simplest.query, finding.original.query);
}

/// The method was asked twice before the finding, and a repetition may cost as much as a hang.
TEST(Simplify, DoesNotRepeatACrash) {
  tests::SharedCounter asked;
  Query crashing = tests::over_triangle(1, 1, 1, -1).query;
  const FunctionMethod method([&](Kind kind, const Query& query) {
    if (query == crashing) asked.add();
    return honest(kind, query);
  });
  Finding finding;
  finding.what = judge::Fault::crash;
  finding.method = "function";
  finding.original.query = {Kind::vertex_face, crashing};
  finding.simplest = finding.original;
  simplify(method, {}, {}, finding);
  EXPECT_EQ(asked.value(), 0U);
  EXPECT_EQ(finding.shrinking, Shrinking::complete);
  EXPECT_EQ(finding.simplest.query, finding.original.query);
}

TEST(Simplify, DoesNotRepeatAHangLongerThanTheTime) {
  const FunctionMethod method([](Kind, const Query&) -> Answer { std::abort(); });
  Finding finding;
  finding.what = judge::Fault::hang;
  finding.method = "function";
  simplify(method, {.query_limit_seconds = 10.0}, base::Deadline(5.0, [] { return 0.0; }), finding);
  EXPECT_EQ(finding.shrinking, Shrinking::not_tried);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::recheck_test
