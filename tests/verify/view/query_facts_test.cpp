#include "verify/view/query_facts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/queries.hpp"
#include "touchstone/number.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/asked_solvers.hpp"

namespace touchstone::verify::view::query_facts_test {
namespace {

/// A vertex falls through a resting triangle at t = 1/3, above (u,v) = (1/4, 1/4).
ViewedQuery falling() {
  const Query query = tests::over_triangle(1, 1, 1, -2).query;
  return {.label = "a label", .query = base::AnyQuery(Kind::vertex_face, query)};
}

/// √½: the third example of exact/CERTIFICATES.md.
ViewedQuery at_root_of_a_half() {
  const tests::PosedQuery posed = tests::vertex_face({0, 0.5, 0.25, 0, 0, 0, 2, 0, 0, 0, 0, 1},
                                                     {1, 0.5, 0.25, 0, 0, 0, 2, 2, 0, 0, 0, 1});
  return {.label = "root", .query = base::AnyQuery(posed.kind, posed.query)};
}

TEST(QueryFacts, ARationalTimeOfImpactIsGivenExactly) {
  const nlohmann::json facts = query_facts(falling(), {});
  EXPECT_EQ(facts.at("kind"), "vertex-face");
  EXPECT_EQ(facts.at("coordinates").size(), 24U);
  EXPECT_EQ(facts.at("coordinates").at(14), "-0x1p+1");
  const nlohmann::json& truth = facts.at("truth");
  EXPECT_EQ(truth.at("collides"), true);
  EXPECT_EQ(truth.at("toi").at("exact"), "1/3");
  EXPECT_EQ(truth.at("toi").at("time"), "1/3");
  EXPECT_EQ(truth.at("toi").at("lower"), "0x1.5555555555555p-2");
  EXPECT_EQ(truth.at("toi").at("upper"), "0x1.5555555555556p-2");
  EXPECT_EQ(truth.at("u").at("exact"), "1/4");
  EXPECT_EQ(truth.at("v").at("exact"), "1/4");
  EXPECT_TRUE(facts.at("approach").is_null());
  EXPECT_EQ(facts.at("certificate").at("claim"), "time_of_impact");
  EXPECT_EQ(facts.at("certificate").at("accepted"), true);
  EXPECT_EQ(facts.at("certificate").at("given"), false);
}

TEST(QueryFacts, AnIrrationalOneIsNearTheTimeGiven) {
  const nlohmann::json toi = query_facts(at_root_of_a_half(), {}).at("truth").at("toi");
  EXPECT_TRUE(toi.at("exact").is_null());
  EXPECT_EQ(toi.at("polynomial"), "2 t^2 - 1");
  EXPECT_EQ(toi.at("lower"), "0x1.6a09e667f3bccp-1");
  EXPECT_EQ(toi.at("upper"), "0x1.6a09e667f3bcdp-1");
  const exact::Rational time(toi.at("time").get<std::string>());
  EXPECT_LT(abs(time * time - exact::Rational(1, 2)), exact::power_of_two(-250));
}

TEST(QueryFacts, TheNearestApproachOfQueriesWithoutCollision) {
  Query almost = *straight_of(falling());
  almost.at(1, 0, 2) = 0x1p-60;
  const ViewedQuery query{.label = "near", .query = base::AnyQuery(Kind::vertex_face, almost)};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("truth").at("collides"), false);
  EXPECT_FALSE(facts.at("truth").contains("toi"));
  EXPECT_EQ(facts.at("approach").at("at_most"), "0x1p-60");
  EXPECT_EQ(facts.at("approach").at("above"), "0x1.fffffffffffffp-61");
  EXPECT_EQ(facts.at("approach").at("time"), "1");
  EXPECT_EQ(facts.at("certificate").at("claim"), "no_collision");
}

TEST(QueryFacts, AtASeparation) {
  ViewedQuery query = falling();
  query.separation = {.distance = 0.5, .norm = Norm::linf};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("min_separation"), "0x1p-1");
  EXPECT_EQ(facts.at("norm"), "linf");
  EXPECT_EQ(facts.at("truth").at("toi").at("exact"), "1/6");
  EXPECT_FALSE(facts.at("truth").contains("u"));
}

TEST(QueryFacts, AnswersAreHeldAgainstTheTruth) {
  ViewedQuery query = falling();
  query.answers = {{.solver = "mine", .answer = {.verdict = fast::Verdict::no}},
                   {.solver = "certified",
                    .answer = {.verdict = fast::Verdict::yes, .toi_lower = 0.5, .toi_upper = 0.5}},
                   {.solver = "hangs",
                    .answer = {.verdict = fast::Verdict::error},
                    .failure = judge::Failure{.kind = judge::Fault::crash, .number = 11}}};
  const auto method = solvers::solver_in_process(solvers::find_method("certified"), {});
  const std::array<const solvers::Solver*, 1> asked{method.get()};
  const nlohmann::json answers = query_facts(query, ask(asked, query).answers).at("answers");
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(answers[0].at("solver"), "mine");
  EXPECT_EQ(answers[0].at("recorded"), true);
  EXPECT_EQ(answers[0].at("promise"), "none");
  EXPECT_EQ(answers[0].at("faults"), nlohmann::json::array({"false negative"}));
  EXPECT_EQ(answers[1].at("faults"), nlohmann::json::array({"late toi"}));
  EXPECT_EQ(answers[1].at("breaks_promise"), true);
  EXPECT_EQ(answers[2].at("failure"), "crash: SIGSEGV");
  EXPECT_EQ(answers[2].at("faults"), nlohmann::json::array({"error"}));
  EXPECT_EQ(answers[3].at("recorded"), false);
  EXPECT_EQ(answers[3].at("verdict"), "yes");
  EXPECT_EQ(answers[3].at("faults"), nlohmann::json::array());
  EXPECT_FALSE(answers[3].at("toi_lower").is_null());
}

// ---- Curves -------------------------------------------------------------------------------------

/// A vertex on a parabola or, with weights, a conic: it falls from 1 to a triangle at rest, turned
/// where the middle control point is at -1, and rises again.
ViewedQuery turning(std::vector<double> weights = {}) {
  return {.label = "curved",
          .query = OwnCurves{.curves = {{{.control = {{1, 1, 1}, {1, 1, -1}, {1, 1, 1}},
                                          .weights = std::move(weights)},
                                         {.control = {{0, 0, 0}}},
                                         {.control = {{4, 0, 0}}},
                                         {.control = {{0, 4, 0}}}}}}};
}

TEST(QueryFacts, PointsOnCurvesAreGivenByTheirControlPoints) {
  const nlohmann::json facts = query_facts(turning(), {});
  EXPECT_FALSE(facts.contains("coordinates"));
  EXPECT_FALSE(facts.contains("weights"));
  EXPECT_EQ(facts.at("control"), nlohmann::json::parse(R"([
    [["0x1p+0", "0x1p+0", "0x1p+0"], ["0x0p+0", "0x0p+0", "0x0p+0"],
     ["0x1p+2", "0x0p+0", "0x0p+0"], ["0x0p+0", "0x1p+2", "0x0p+0"]],
    [["0x1p+0", "0x1p+0", "-0x1p+0"], null, null, null],
    [["0x1p+0", "0x1p+0", "0x1p+0"], null, null, null]])"));
  const nlohmann::json& truth = facts.at("truth");
  EXPECT_EQ(truth.at("toi").at("exact"), "1/2");
  EXPECT_EQ(truth.at("u").at("exact"), "1/4");
  EXPECT_EQ(truth.at("v").at("exact"), "1/4");
  EXPECT_EQ(facts.at("certificate").at("claim"), "time_of_impact");
  EXPECT_EQ(facts.at("certificate").at("accepted"), true);
}

// (1−t)² − 4(1−t)t + 3t² = (1−4t)(1−2t).
TEST(QueryFacts, OnRationalCurvesTheirWeightsAreGiven) {
  const nlohmann::json facts = query_facts(turning({1.0, 2.0, 3.0}), {});
  EXPECT_EQ(facts.at("weights"), nlohmann::json::parse(R"([
    ["0x1p+0", "0x1p+0", "0x1p+0", "0x1p+0"], ["0x1p+1", null, null, null],
    ["0x1.8p+1", null, null, null]])"));
  EXPECT_EQ(facts.at("truth").at("toi").at("exact"), "1/4");
}

TEST(QueryFacts, OnCurvesThereIsNoNearestApproach) {
  ViewedQuery query = turning();
  std::get<OwnCurves>(query.query).curves[0].control[1][2] = 0.0;
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("truth").at("collides"), false);
  EXPECT_TRUE(facts.at("approach").is_null());
  EXPECT_EQ(facts.at("certificate").at("claim"), "no_collision");
  query.separation = {.distance = 0.5, .norm = Norm::linf};
  EXPECT_EQ(query_facts(query, {}).at("truth").at("toi").at("exact"), "1/2");
}

TEST(QueryFacts, CurvesOfOneShapeHaveAllTheirControlPoints) {
  ViewedQuery query = turning({1.0, 2.0, 3.0});
  query.query = in_one_shape(query).value();
  query.answers = {{.solver = "certified", .answer = {.verdict = fast::Verdict::no}}};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("weights"), nlohmann::json::parse(R"([
    ["0x1p+0", "0x1p+0", "0x1p+0", "0x1p+0"], ["0x1p+1", "0x1p+0", "0x1p+0", "0x1p+0"],
    ["0x1.8p+1", "0x1p+0", "0x1p+0", "0x1p+0"]])"));
  EXPECT_EQ(facts.at("control").at(2).at(3),
            nlohmann::json::parse(R"(["0x0p+0", "0x1p+2", "0x0p+0"])"));
  EXPECT_EQ(facts.at("truth").at("toi").at("exact"), "1/4");
  EXPECT_EQ(facts.at("answers").at(0).at("faults"), nlohmann::json::array({"false negative"}));
}

TEST(QueryFacts, TextsArePrintable) {
  ViewedQuery query = falling();
  query.label = "a\x1b\n";
  query.notes = {"b\x01"};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("label"), "a\\x1b\\x0a");
  EXPECT_EQ(facts.at("notes"), nlohmann::json::array({"b\\x01"}));
}

}  // namespace
}  // namespace touchstone::verify::view::query_facts_test
