#include "filters/derivation/gappa.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "filters/derivation/shipped_bound.hpp"
#include "tests/filters/support.hpp"
#include "tests/filters/worked_example/orientation.hpp"

namespace touchstone::filters {
namespace {

/// The nearest multiple of 2^-200 below x.
mpq_class dyadic_below(const mpq_class& x) {
  mpq_class scaled = x << 200U;
  return mpq_class(scaled.get_num() / scaled.get_den()) >> 200U;
}

/// Gappa's bound over ours, less 1.
mpq_class excess(const ExpressionGraph& graph, const Format& format, GappaGoal goal) {
  const std::optional<mpq_class> found = gappa_bound(graph, format, goal);
  if (!found) return -1;
  const DerivedBound ours = derive_bound(graph, format);
  if (goal == GappaGoal::rounding) return *found / ours.rounding() - 1;
  return *found * power_of_two(format.least_exponent - 1) / ours.coefficients.at(0) - 1;
}

TEST(Gappa, FindsOurBoundsAndNoLess) {
  const mpq_class precision = power_of_two(-200);
  for (const GappaGoal goal : {GappaGoal::rounding, GappaGoal::underflow}) {
    EXPECT_LT(abs(excess(record<EdgeEdge>(), double_format, goal)), precision);
    EXPECT_LT(abs(excess(record<Blend>(), float_format, goal)), precision);
  }
  EXPECT_LT(abs(excess(record<PaperVertexFace>(), float_format, GappaGoal::rounding)), precision);
  EXPECT_LT(abs(excess(record<researcher::Orientation>(), double_format, GappaGoal::rounding)),
            precision);
}

TEST(Gappa, ProvesNoBoundThatIsTooSmall) {
  const ExpressionGraph graph = record<VertexFace>();
  const DerivedBound bound = derive_bound(graph, double_format);
  const mpq_class less = dyadic_below(bound.rounding() * 99 / 100);
  EXPECT_FALSE(gappa_proves(graph, double_format, GappaGoal::rounding, less));
  const mpq_class units = bound.coefficients.at(0) / power_of_two(double_format.least_exponent - 1);
  const mpq_class less_units = dyadic_below(units * 99 / 100);
  EXPECT_FALSE(gappa_proves(graph, double_format, GappaGoal::underflow, less_units));
}

/// EdgeEdge with one operation more: + 0·x.
struct OneOperationMore : EdgeEdge {
  static constexpr std::string_view name = "one_operation_more";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 8>& x, const std::array<Scalar, 6>& w) {
    return EdgeEdge::evaluate(x, w) + (x[0] - x[0]);
  }
};

TEST(Gappa, ProvesNoBoundOfAnotherOrderOfOperations) {
  const mpq_class bound =
      shipped_coefficients(derive_bound(record<EdgeEdge>(), double_format), double_format).back();
  EXPECT_FALSE(gappa_proves(record<OneOperationMore>(), double_format, GappaGoal::rounding, bound));
  EXPECT_FALSE(gappa_proves(record<PaperEdgeEdge>(), double_format, GappaGoal::rounding, bound));
}

TEST(Gappa, TakesOperationsThatAgreeOnlyAtAVertexForDifferentOnes) {
  const mpq_class u = double_format.unit_roundoff();
  const std::optional<mpq_class> found =
      gappa_bound(record<TwoErrors>(), double_format, GappaGoal::rounding);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, 2 * u + 2 * u * u);
}

TEST(Gappa, ScriptsSayWhatIsComputedAndWhatIsExact) {
  const std::string script =
      gappa_script(record<Blend>(), float_format, GappaGoal::rounding, {0, 1}, mpq_class(3, 1024));
  EXPECT_NE(script.find("= mul_rel<24>(x0, w0);"), std::string::npos) << script;
  EXPECT_NE(script.find("w0 in [0,0] /\\ w1 in [1,1]"), std::string::npos) << script;
  EXPECT_NE(script.find("= x0 * (0);"), std::string::npos) << script;
  EXPECT_NE(script.find("-> 1b-0 * x1;"), std::string::npos) << script;
  EXPECT_NE(script.find("<= 3b-10 }"), std::string::npos) << script;
}

TEST(Gappa, AcceptsEveryRuleOfAScript) {
  // It would warn of rules that are no identities, and of variables that are not bounded.
  const ExpressionGraph graph = record<PaperVertexFace>();
  for (const std::vector<int>& weights : graph.weight_vertices()) {
    const GappaAnswer answer =
        run_gappa(gappa_script(graph, double_format, GappaGoal::rounding, weights));
    EXPECT_TRUE(answer.proved);
    EXPECT_EQ(answer.output.find("not trivially equal"), std::string::npos) << answer.output;
    EXPECT_EQ(answer.output.find("Error"), std::string::npos) << answer.output;
  }
}

TEST(Gappa, AnswersQuestionsWithExactNumbers) {
  const GappaAnswer answer = run_gappa("{ x in [-3,1b-4] -> |x * 0.25| in ? }");
  EXPECT_TRUE(answer.proved);
  ASSERT_TRUE(answer.bound) << answer.output;
  EXPECT_EQ(*answer.bound, mpq_class(3, 4));
  const GappaAnswer unknown = run_gappa("{ x in [0,1] -> |x + y| in ? }");
  EXPECT_FALSE(unknown.bound) << unknown.output;
  EXPECT_FALSE(run_gappa("{ x in [0,1] -> x <= 0.5 }").proved);
  EXPECT_FALSE(run_gappa("no script").proved);
}

TEST(Gappa, RefusesGoalsThatItsModelDoesNotHave) {
  const ExpressionGraph orientation = record<researcher::Orientation>();
  EXPECT_THROW(
      static_cast<void>(gappa_script(orientation, double_format, GappaGoal::underflow, {})),
      std::invalid_argument);
  EXPECT_THROW(static_cast<void>(gappa_script(orientation, double_format, GappaGoal::rounding, {},
                                              mpq_class(1, 3))),
               std::invalid_argument);
}

TEST(Gappa, IsMissedByThePackagesName) {
  const char* const path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  setenv("PATH", "/nonexistent", 1);
  std::string reason;
  try {
    static_cast<void>(run_gappa("{ x in [0,1] -> x in ? }"));
  } catch (const GappaMissing& missing) {
    reason = missing.what();
  }
  setenv("PATH", before.c_str(), 1);
  EXPECT_NE(reason.find("install the Debian package gappa"), std::string::npos) << reason;
}

}  // namespace
}  // namespace touchstone::filters
