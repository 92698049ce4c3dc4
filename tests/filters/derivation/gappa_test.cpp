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

template <class... Expressions>
void expect_our_bounds() {
  for (const mpq_class& one :
       {excess(record<Expressions>(), double_format, GappaGoal::rounding)...}) {
    EXPECT_LT(abs(one), power_of_two(-200));
  }
}

TEST(Gappa, FindsOurBoundsAndNoLess) {
  expect_our_bounds<EdgeEdge, PaperEdgeEdge, PaperVertexFace, PaperEdgeEdgeSeparated,
                    PaperVertexFaceSeparated, ReleasedEdgeEdge, ReleasedVertexFace, TwoErrors,
                    researcher::Orientation, MeasuredOrientationEnd>();
  for (const GappaGoal goal : {GappaGoal::rounding, GappaGoal::underflow}) {
    EXPECT_LT(abs(excess(record<EdgeEdge>(), double_format, goal)), power_of_two(-200));
    EXPECT_LT(abs(excess(record<Blend>(), float_format, goal)), power_of_two(-200));
  }
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

// ---- Bounds by hand -----------------------------------------------------------------------------

/// Bounds that stand in texts, because no expression of the catalogue has them: stage axis up to a
/// time (docs/theory.md, section 6.2, fast/certified/stages/axis.hpp) and the inequality of
/// keeps_distance (section 8.6, fast/distance/kept_distance.cpp). Sizes are at most 1, and
/// exponents have no end, so that a bound holds for any size in proportion; what underflow adds is
/// in the texts. u is 2^-53.
struct ByHand {
  std::string name;
  std::string script;  ///< up to the bound
  std::string bound;   ///< that the text has
  std::string rest;    ///< rules
  std::string less;    ///< a bound that is too small
};

const ByHand all[] = {
    {"a position is wrong by 5/2 u + 2 u²",
     R"(weight rnd= 1 - T;
position rnd= weight * a + T * b;
{ a in [-1,1] /\ b in [-1,1] /\ T in [0,1] -> |position - ((1 - T) * a + T * b)| <= )",
     "41b-57", "", "32b-57"},
    {"a height s·w is wrong by 16 u",
     R"(w0 rnd= a - b; w1 rnd= c - d; w2 rnd= e - f;
height rnd= s0 * w0 + s1 * w1 + s2 * w2;
{ s0 in [-1,1] /\ s1 in [-1,1] /\ s2 in [-1,1] /\ w0 in [-1,1] /\ w1 in [-1,1] /\ w2 in [-1,1]
-> |height - (s0 * (a - b) + s1 * (c - d) + s2 * (e - f))| <= )",
     "16b-53", "", "1b-53"},
    {"a motion of a corner is wrong by 2.01 u, before it is rounded",
     R"(start rnd= a - b; end rnd= c - d;
{ start in [-1,1] /\ end in [-1,1] -> |(end - start) - ((c - d) - (a - b))| <= )",
     "32b-57", "", "1b-54"},
    // For l from 1/2 to 1; 8 u l of the 16 u l are left for the caller.
    {"the sides of the inequality are wrong by 8 u l",
     R"(k = 1b-49 * a;
way rnd= T * b; gap rnd= a - way; left rnd= gap - k;
over rnd= a - c; share rnd= part * over; kept rnd= c + share;
wrong = (a - T * b) - (c + part * (a - c)) - (left - kept) - k;
{ a in [0.5,1] /\ T * b in [0,1] /\ c in [0,1] /\ over in [0,1] /\ part in [0,1]
-> |wrong| <= )",
     "8b-54",
     R"(wrong -> (way - T * b) + ((a - way) - gap) + ((gap - k) - left) + (kept - (c + share)) +
  (share - part * over) + part * (over - (a - c));
)",
     "1b-54"},
};

bool proves(const ByHand& one, const std::string& bound) {
  std::string script = "@rnd = float<53, -4000, ne>;\n";
  for (const char* const name : {"a", "b", "c", "d", "e", "f", "s0", "s1", "s2", "T", "part"}) {
    script += std::string(name) + " = rnd(" + name + "_);\n";
  }
  return run_gappa(script + one.script + bound + " }\n" + one.rest).proved;
}

TEST(BoundsByHand, AreProvedByGappa) {
  for (const ByHand& one : all) {
    EXPECT_TRUE(proves(one, one.bound)) << one.name;
    EXPECT_FALSE(proves(one, one.less)) << one.name;
  }
}

// ---- Other programs -----------------------------------------------------------------------------

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
