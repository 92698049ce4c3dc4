#include "verify/solvers/contender.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/generate/workload.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::contender_test {
namespace {

using fast::Verdict;

std::vector<Query> falling_and_resting() {
  return {tests::over_triangle(1, 1, 1, -1).query, tests::over_triangle(1, 1, 1, 0.5).query,
          tests::over_triangle(1, 1, 1, -3).query};
}

/// The contender's answers to all of them.
std::vector<fast::Answer> answers_of(Contender& contender, Kind kind,
                                     const std::vector<Query>& queries) {
  contender.solve(kind, queries);
  std::vector<fast::Answer> answers;
  for (std::size_t i = 0; i < queries.size(); ++i) answers.push_back(contender.answer(i));
  return answers;
}

TEST(Contender, OfAMethodAnswersAsTheMethod) {
  const tests::FunctionMethod method(tests::true_answer, fast::Promise::exact, "truth");
  const auto contender = contend(method, {});
  EXPECT_EQ(contender->name(), "truth");
  EXPECT_EQ(contender->promise(), fast::Promise::exact);
  EXPECT_FALSE(contender->only_as_a_whole());
  const auto queries = falling_and_resting();
  const auto answers = answers_of(*contender, Kind::vertex_face, queries);
  EXPECT_EQ(answers[0].verdict, Verdict::yes);
  EXPECT_EQ(answers[0].toi_lower, 0.5);
  EXPECT_EQ(answers[1].verdict, Verdict::no);
  EXPECT_EQ(answers[2].toi_lower, 0.25);
  EXPECT_TRUE(contender->stages(Kind::vertex_face, queries).empty());
}

TEST(Contender, HandsItsOptionsToTheMethod) {
  class ToleranceMethod final : public fast::Method {
   public:
    [[nodiscard]] std::string_view name() const override { return "tolerance"; }
    [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }
    void solve(Kind, std::span<const Query>, std::span<fast::Answer> answers,
               const fast::MethodOptions& options) const override {
      for (fast::Answer& answer : answers) answer.tolerance = options.tolerance;
    }
  };
  const ToleranceMethod method;
  const auto contender = contend(method, {.tolerance = 0.125});
  EXPECT_EQ(answers_of(*contender, Kind::edge_edge, std::vector<Query>(1))[0].tolerance, 0.125);
}

TEST(Contender, AnswersFewerQueriesAfterMore) {
  const tests::FunctionMethod method(tests::true_answer);
  const auto contender = contend(method, {});
  const auto queries = falling_and_resting();
  static_cast<void>(answers_of(*contender, Kind::vertex_face, queries));
  contender->solve(Kind::vertex_face, std::span(queries).last(1));
  EXPECT_EQ(contender->answer(0).toi_lower, 0.25);
}

TEST(Contender, StagesAreCountedInTheirOrder) {
  std::vector<fast::CertifiedResult> results(6);
  results[0].stage = fast::Stage::exact;
  results[1].stage = fast::Stage::direction;
  results[2].stage = fast::Stage::direction;
  const auto counts = count_stages(results);
  const std::vector<StageCount> expected{
      {"axis", 3}, {"direction", 2}, {"determinant", 0}, {"bisection", 0}, {"exact", 1}};
  EXPECT_EQ(counts, expected);
}

TEST(Contender, TheCertifiedSolverIsExactAndKnowsItsStages) {
  const auto contender = contend_certified({});
  EXPECT_EQ(contender->name(), "certified");
  EXPECT_EQ(contender->promise(), fast::Promise::exact);
  const auto queries = falling_and_resting();
  const auto answers = answers_of(*contender, Kind::vertex_face, queries);
  EXPECT_EQ(answers[0].verdict, Verdict::yes);
  EXPECT_LE(answers[0].toi_lower, 0.5);
  EXPECT_GE(answers[0].toi_upper, 0.5);
  EXPECT_EQ(answers[1].verdict, Verdict::no);
  const auto counts = contender->stages(Kind::vertex_face, queries);
  EXPECT_EQ(counts.size(), fast::stages);
  const auto add = [](std::uint64_t sum, const StageCount& count) { return sum + count.queries; };
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}, add), queries.size());
}

TEST(Contender, PairsAreAnsweredAsTheirQueriesAre) {
  const MovingMesh mesh = moving_patches({.seed = 3, .cells = 6});
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto pairs = find_candidates(mesh, kind);
    const fast::Candidates candidates = candidates_of(mesh, kind, pairs);
    const auto queries = queries_of(mesh, candidates);
    const auto with_queries = contend_with_queries({});
    const auto with_pairs = contend_with_pairs(mesh.vertices, candidates, {});
    EXPECT_EQ(with_queries->name(), "certified_queries");
    EXPECT_EQ(with_pairs->name(), "certified_pairs");
    EXPECT_FALSE(with_queries->only_as_a_whole());
    EXPECT_TRUE(with_pairs->only_as_a_whole());
    const auto expected = answers_of(*with_queries, kind, queries);
    const auto answers = answers_of(*with_pairs, kind, queries);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      ASSERT_EQ(answers[i].verdict, expected[i].verdict) << i;
      ASSERT_EQ(answers[i].verdict, tests::true_answer(kind, queries[i]).verdict) << i;
      hits += answers[i].verdict == Verdict::yes ? 1U : 0U;
    }
    EXPECT_GT(hits, 0U);
    EXPECT_LT(hits, queries.size());
    EXPECT_THROW(with_pairs->solve(kind, std::span(queries).first(1)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace touchstone::verify::contender_test
