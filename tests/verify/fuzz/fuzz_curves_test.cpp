#include "verify/fuzz/fuzz_curves.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/trials.hpp"
#include "verify/solvers/curved_answers.hpp"

namespace touchstone::verify::fuzz::fuzz_curves_test {
namespace {

AnswerCurves method(std::string name) {
  return [name](Kind kind, const CurvedQueries& queries, const fast::MethodOptions& options) {
    return solvers::curved_answers(name, kind, queries, options, 1);
  };
}

/// The certified solver's answers, changed.
AnswerCurves altered(const std::function<void(fast::Answer&)>& change) {
  return [=](Kind kind, const CurvedQueries& queries, const fast::MethodOptions& options) {
    auto answers = method("certified")(kind, queries, options);
    for (fast::Answer& answer : answers) change(answer);
    return answers;
  };
}

TEST(FuzzCurves, FindsNothingInOurSolvers) {
  // (Not fewer under the sanitizers: the queries of one block may all collide.)
  const std::uint64_t queries = tests::is_soak() ? 100'000 : 400;
  for (const double distance : {0.0, 0.25}) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      CurvedFuzzOptions options{.most_queries = queries};
      options.method.separation = {.distance = distance, .norm = norm};
      const CurvedFuzzResult certified = fuzz_curves(method("certified"), false, options);
      EXPECT_TRUE(certified.findings.empty());
      EXPECT_EQ(certified.queries, queries);
      EXPECT_GT(certified.collisions, queries / 10);
      EXPECT_LT(certified.collisions, queries - queries / 10);
    }
  }
  CurvedFuzzOptions options{.most_queries = queries, .promise = fast::Promise::conservative};
  options.method.max_checks = 2000;
  EXPECT_TRUE(fuzz_curves(method("tight_inclusion"), true, options).findings.empty());
}

TEST(FuzzCurves, FindsPlantedFaults) {
  using fast::Verdict;
  const CurvedFuzzOptions options{.most_queries = 3000, .most_findings = 1};
  const auto found = [&](const std::function<void(fast::Answer&)>& change) {
    const CurvedFuzzResult result = fuzz_curves(altered(change), false, options);
    return result.findings.empty() ? "" : std::string(judge::to_string(result.findings[0].what));
  };
  EXPECT_EQ(found([](fast::Answer& answer) { answer.verdict = Verdict::no; }), "false_negative");
  EXPECT_EQ(found([](fast::Answer& answer) { answer.verdict = Verdict::yes; }), "false_positive");
  EXPECT_EQ(found([](fast::Answer& answer) { answer.verdict = Verdict::error; }), "no_verdict");
  EXPECT_EQ(found([](fast::Answer& answer) { answer.toi_lower = answer.toi_upper + 1e-12; }),
            "late_toi");
  EXPECT_EQ(found([](fast::Answer& answer) { answer.toi_upper = answer.toi_lower - 1e-12; }),
            "early_toi_upper");
}

TEST(FuzzCurves, HasTheSameQueriesForTheSameSeed) {
  const auto numbers = [](std::uint64_t seed) {
    std::vector<double> all;
    const AnswerCurves note = [&](Kind, const CurvedQueries& queries, const fast::MethodOptions&) {
      all.insert(all.end(), queries.numbers.begin(), queries.numbers.end());
      return std::vector<fast::Answer>(queries.size(), {.verdict = fast::Verdict::undecided});
    };
    (void)fuzz_curves(note, false,
                      {.most_queries = 200, .seed = seed, .promise = fast::Promise::conservative});
    return all;
  };
  EXPECT_EQ(numbers(1), numbers(1));
  EXPECT_NE(numbers(1), numbers(2));
}

}  // namespace
}  // namespace touchstone::verify::fuzz::fuzz_curves_test
