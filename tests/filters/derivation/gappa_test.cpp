#include "touchstone/derivation/gappa.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "tests/support/folder_test.hpp"
#include "touchstone/derivation/shipped_bound.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters::gappa_test {
namespace {

namespace fs = std::filesystem;

/// The nearest multiple of 2^-200 below x.
mpq_class dyadic_below(const mpq_class& x) {
  mpq_class scaled = x << 200U;
  return mpq_class(scaled.get_num() / scaled.get_den()) >> 200U;
}

/// Gappa's bound divided by ours, less 1.
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
  EXPECT_LT(abs(excess(record<MeasuredOrientationEnd>(), double_format, GappaGoal::rounding)),
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

/// EdgeEdge with one more operation: + 0·x.
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

/// The number of scripts that prove a bound, of how many vertices.
template <class Expression>
std::pair<std::size_t, std::size_t> scripts_and_vertices() {
  const ExpressionGraph graph = record<Expression>();
  return {gappa_scripts(graph, double_format, GappaGoal::rounding).size(),
          graph.weight_vertices().size()};
}

TEST(Gappa, AsksOnceWhatIsAlikeAtManyVertices) {
  using Pair = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(scripts_and_vertices<Blend>(), Pair(1, 2));
  EXPECT_EQ(scripts_and_vertices<EdgeEdge>(), Pair(1, 8)) << "a point of each edge at one time";
  EXPECT_EQ(scripts_and_vertices<VertexFace>(), Pair(3, 8)) << "f0; f1 or f2; f1 + f2 − f0";
  EXPECT_EQ(scripts_and_vertices<TwoErrors>(), Pair(4, 4)) << "x − x, x − 0, 0 − x, 0 − 0";
  EXPECT_EQ(scripts_and_vertices<MeasuredDeterminantEnd>(), Pair(1, 8));
  EXPECT_EQ(scripts_and_vertices<MeasuredDeterminantMiddle>(), Pair(8, 64))
      << "r, p and q each at one end or at both";
  EXPECT_EQ(scripts_and_vertices<MeasuredOrientationMiddle>(), Pair(4, 16));
  EXPECT_EQ(gappa_scripts(record<Blend>(), double_format, GappaGoal::underflow).size(), 2U)
      << "there products with 0 underflow too";
}

/// Two sums that share a term and differ in one that is 0 at a vertex.
struct TwoSums : Blend {
  static constexpr std::string_view name = "two_sums";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 2>& w) {
    const Scalar shared = x[0] * w[0];
    return (shared + x[1] * w[1]) - (shared + x[0] * w[1]);
  }
};

TEST(Gappa, TakesZerosForDifferentOnes) {
  // At (1, 0) both sums are fl(shared + 0), each with its rounding error.
  const std::optional<mpq_class> found =
      gappa_bound(record<TwoSums>(), double_format, GappaGoal::rounding);
  ASSERT_TRUE(found);
  const GappaAnswer at_vertex =
      run_gappa(gappa_script(record<TwoSums>(), double_format, GappaGoal::rounding, {1, 0}));
  ASSERT_TRUE(at_vertex.bound);
  EXPECT_GE(*at_vertex.bound, 2 * double_format.unit_roundoff());
  EXPECT_GE(*found, *at_vertex.bound);
}

TEST(Gappa, AcceptsEveryRuleOfAScript) {
  // Gappa would warn of rules that are not identities, and of variables without bounds.
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

/// A program called gappa, alone in PATH, during the life of this object.
class FakeGappa {
 public:
  explicit FakeGappa(const std::string& body) {
    fs::permissions(folder_.file("gappa", "#!/bin/sh\n" + body + "\n"), fs::perms::owner_all);
    if (const char* const before = std::getenv("PATH")) path_before_ = before;
    setenv("PATH", folder_.path().c_str(), 1);
  }
  FakeGappa(const FakeGappa&) = delete;
  FakeGappa& operator=(const FakeGappa&) = delete;
  FakeGappa(FakeGappa&&) = delete;
  FakeGappa& operator=(FakeGappa&&) = delete;
  ~FakeGappa() { setenv("PATH", path_before_.c_str(), 1); }

 private:
  tests::TemporaryFolder folder_;
  std::string path_before_;
};

TEST(Gappa, HasProvedNothingWhenItsTimeIsOver) {
  const FakeGappa endless("echo said; while :; do :; done");
  const GappaAnswer answer = run_gappa("{ x in [0,1] -> x in ? }", std::chrono::seconds(1));
  EXPECT_FALSE(answer.proved);
  EXPECT_FALSE(answer.bound);
  EXPECT_EQ(answer.output, "said\n");
}

TEST(Gappa, HasFailedIfItIsEndedByAnotherSignal) {
  const FakeGappa killed("kill -9 $$");
  EXPECT_THROW(static_cast<void>(run_gappa("{ x in [0,1] -> x in ? }")), std::runtime_error);
}

}  // namespace
}  // namespace touchstone::filters::gappa_test
