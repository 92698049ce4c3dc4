#include "verify/fuzz/diagnosis.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "fast/method.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/query.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/judge/ground_truth.hpp"

namespace touchstone::verify::fuzz::diagnosis_test {
namespace {

using fast::Answer;
using fast::CertifiedResult;
using fast::Promise;
using fast::Verdict;

/// Queries with contact at 1/2, and never.
const tests::PosedQuery at_half = tests::over_triangle(1, 1, 1, -1);
const tests::PosedQuery never = tests::over_triangle(1, 1, 2, 1);

/// The oracle's fault, after a check that the quick look does not excuse a wrong answer.
std::optional<judge::Fault> fault(const tests::PosedQuery& posed, const Answer& answer,
                                  const judge::Standard& standard = {},
                                  const Separation& separation = {}) {
  const judge::Question question{Queries(posed.kind, {&posed.query, 1}), separation};
  const judge::GroundTruth truth =
      judge::truth_of(0, exact::decide(posed.kind, posed.query, separation));
  const CertifiedResult judged = fast::solve(posed.kind, posed.query, {.separation = separation});
  const auto diagnosis = diagnose(question, truth, answer, standard);
  EXPECT_FALSE(diagnosis && is_beyond_doubt(question, judged, answer, standard));
  if (!diagnosis) return std::nullopt;
  EXPECT_FALSE(diagnosis->detail.empty());
  return diagnosis->what;
}

Answer yes(double lower, double upper, double tolerance = Answer::none) {
  return {.verdict = Verdict::yes, .toi_lower = lower, .toi_upper = upper, .tolerance = tolerance};
}

TEST(Diagnose, HoldsOnlyWhatIsExactToMisses) {
  const judge::Standard exact{.promise = Promise::exact};
  EXPECT_EQ(fault(never, {.verdict = Verdict::yes}), std::nullopt);
  EXPECT_EQ(fault(never, {.verdict = Verdict::yes}, exact), judge::Fault::false_positive);
  EXPECT_EQ(fault(never, {.verdict = Verdict::undecided}), std::nullopt);
  EXPECT_EQ(fault(never, {.verdict = Verdict::undecided}, exact), judge::Fault::undecided);
  EXPECT_EQ(fault(never, {.verdict = Verdict::no}, exact), std::nullopt);
  EXPECT_EQ(fault(at_half, {.verdict = Verdict::undecided}, exact), std::nullopt);
}

/// The primitives come within 1, but no nearer.
TEST(Diagnose, HoldsAYesToItsTolerance) {
  const judge::Standard standard{.promise = Promise::conservative,
                                 .filter = fast::ErrorModel::derived};
  EXPECT_EQ(fault(never, yes(0.5, Answer::none, 1.0), standard), std::nullopt);
  EXPECT_EQ(fault(never, yes(0.5, Answer::none, 0.99), standard), judge::Fault::beyond_tolerance);
  EXPECT_EQ(fault(never, yes(0.5, Answer::none), standard), std::nullopt);
  EXPECT_EQ(fault(never, {.verdict = Verdict::undecided, .tolerance = 0.1}, standard),
            std::nullopt);
}

/// A tolerance in the norm of the separation, for a solver without further promises.
TEST(Diagnose, HoldsAYesToItsToleranceBeyondTheSeparation) {
  const Separation separation{.distance = 0.5, .norm = Norm::l2};
  const auto claims = [&](double tolerance) {
    return fault(never, yes(0.5, Answer::none, tolerance), {}, separation);
  };
  EXPECT_EQ(claims(0.5), std::nullopt);
  EXPECT_EQ(claims(0.49), judge::Fault::beyond_tolerance);
  EXPECT_EQ(claims(0.0), judge::Fault::beyond_tolerance);
}

TEST(Diagnose, JudgesAtTheSeparation) {
  const judge::Standard exact{.promise = Promise::exact};
  const Separation separation{.distance = 1.5};
  EXPECT_EQ(fault(never, {.verdict = Verdict::no}, exact, separation),
            judge::Fault::false_negative);
  EXPECT_EQ(fault(never, yes(0.5, 0.5), exact, separation), std::nullopt);
  EXPECT_EQ(fault(never, yes(0.75, 0.75), exact, separation), judge::Fault::late_toi);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::diagnosis_test
