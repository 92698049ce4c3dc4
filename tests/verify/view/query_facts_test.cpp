// What a page says of most queries is in tests/transcripts/view.md.

#include "verify/view/query_facts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/asked_solvers.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view::query_facts_test {
namespace {

using tests::PosedQuery;

/// A vertex falls through a resting triangle at t = 1/3, above (u,v) = (1/4, 1/4).
ViewedQuery falling() {
  const Query query = tests::over_triangle(1, 1, 1, -2).query;
  return {.label = "a label", .query = base::AnyQuery(Kind::vertex_face, query)};
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

TEST(QueryFacts, TextsArePrintable) {
  ViewedQuery query = falling();
  query.label = "a\x1b\n";
  query.notes = {"b\x01"};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("label"), "a\\x1b\\x0a");
  EXPECT_EQ(facts.at("notes"), nlohmann::json::array({"b\\x01"}));
}

// ---- Queries of certificates, and on curves -------------------------------------------------------

/// The first example of exact/CERTIFICATES.md.
const std::string over_an_edge =
    "touchstone-certificates 2\nquery vertex_face\nlabel over an edge\n"
    "point 0x1p+0 -0x1p+0 0x1p+0\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\n"
    "point 0x1p+0 0x1p+0 0x1p+0\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\n"
    "claim no_collision\nseparate 0 1/2 edge 0 1\nseparate 1/2 1 face +\nend\ncertificates 1\n";

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by);
}

TEST(CertificateFacts, TheQueryBitForBit) {
  const PosedQuery posed = tests::edge_edge({-1, 0.1, 1, 1, 0, 1, 0, -1, 0, 0, 1, 5e-324},
                                            {-1, 0, -1, 1, 0, -1, 0, -1.7e308, 0, 0, 1, 0});
  const Separation separation{.distance = 0.1, .norm = Norm::l2};
  const exact::Decision verdict = exact::decide(posed.kind, posed.query, separation);
  const std::string stream =
      exact::certificate_stream(exact::prove(posed.kind, posed.query, verdict), "a label");
  const ViewedQuery read = certified_query(stream);
  EXPECT_EQ(read.certificate, stream);
  EXPECT_EQ(std::get<base::AnyQuery>(read.query), base::AnyQuery(posed.kind, posed.query));
  EXPECT_EQ(read.separation, separation);
  EXPECT_EQ(read.label, "a label");
}

TEST(CertificateFacts, InvalidTextIsAnError) {
  EXPECT_NE(straight_of(certified_query(over_an_edge)), nullptr);
  for (const std::string& text :
       {std::string(), std::string("touchstone-certificates 1\n"),
        replaced(over_an_edge, "4 0 0", "4 0"), replaced(over_an_edge, "4 0 0", "1/3 0 0"),
        certificate_stream(
            exact::prove(Kind::tetrahedron, Query{}, exact::decide(Kind::tetrahedron, Query{})))}) {
    EXPECT_THROW((void)certified_query(text), std::invalid_argument) << text;
  }
}

/// A vertex on a parabola or, with weights, a conic: it falls from 1 to a triangle at rest, turned
/// where the middle control point is at -1, and rises again. (1−t)² − 4(1−t)t + 3t² = (1−4t)(1−2t).
OwnCurves turning(std::vector<double> weights = {}) {
  return {
      .curves = {{{.control = {{1, 1, 1}, {1, 1, -1}, {1, 1, 1}}, .weights = std::move(weights)},
                  {.control = {{0, 0, 0}}},
                  {.control = {{4, 0, 0}}, .weights = {0.5}},
                  {.control = {{0, 4, 0}}}}}};
}

TEST(ViewedQuery, InOneShapeHasConstantCurvesOfAnyDegreeWithWeightsOfOne) {
  const auto query = in_one_shape({.label = "", .query = turning({1, 2, 3})});
  ASSERT_TRUE(query);
  EXPECT_EQ(query->shape(), (QueryShape{.degree = 2, .is_rational = true}));
  const ViewedQuery shaped{.label = "", .query = *query};
  EXPECT_EQ(in_one_shape(shaped), *query);
  CurvedQuery expected = turning({1, 2, 3}).curves;
  for (std::size_t i = 1; i < moving_points; ++i) {
    expected.at(i).control.assign(3, expected.at(i).control.front());
    expected.at(i).weights.assign(3, i == 2 ? 0.5 : 1.0);
  }
  EXPECT_EQ(curves_of(shaped), expected);
  OwnCurves other = turning();
  other.curves[3].control.push_back({0, 4, 0});
  EXPECT_FALSE(in_one_shape({.label = "", .query = other}));
}

TEST(ViewedQuery, IsDecidedAndProvedAsItIsWritten) {
  const ViewedQuery own{.label = "", .query = turning({1, 2, 3})};
  const ViewedQuery shaped{.label = "", .query = in_one_shape(own).value()};
  const auto text = [](const ViewedQuery& viewed) {
    const exact::Decision decision = decide(viewed);
    EXPECT_EQ(decision.toi, exact::AlgebraicNumber(exact::Rational(1, 4)));
    return exact::certificate_stream(prove(viewed, decision), "");
  };
  EXPECT_NE(text(own).find("\ncurve 0\n"), std::string::npos);
  EXPECT_EQ(text(shaped).find("curve 0\n"), std::string::npos);
  EXPECT_EQ(straight_of(shaped), nullptr);
  const exact::Certificate certificate = prove(falling(), decide(falling()));
  EXPECT_EQ(std::get<Query>(certificate.query), *straight_of(falling()));
}

// ---- The nearest approach -------------------------------------------------------------------------

TEST(NearestApproach, IsBetweenNeighbouringDoubles) {
  for (const double height : {0.5, 1e-9, 0x1p-53, 1e-310, 5e-324}) {
    const PosedQuery posed = tests::over_triangle(1, 1, 1, height);
    const auto approach = nearest_approach(posed.kind, posed.query);
    ASSERT_TRUE(approach);
    EXPECT_EQ(approach->at_most, height);
    EXPECT_EQ(approach->above, std::nextafter(height, 0.0));
    EXPECT_EQ(approach->time, exact::AlgebraicNumber(1));
  }
}

/// Two edges that pass each other, one at height 3: their distance is least while they cross in
/// projection.
TEST(NearestApproach, IsTheFirstTimeOfTheLeastDistance) {
  const PosedQuery passing = tests::edge_edge({-1, 0, 3, 1, 0, 3, 0, 3, 0, 0, 5, 0},
                                              {-1, 0, 3, 1, 0, 3, 0, -5, 0, 0, -3, 0});
  const auto approach = nearest_approach(passing.kind, passing.query);
  ASSERT_TRUE(approach);
  EXPECT_EQ(approach->at_most, 3.0);
  // The nearer end is at y = 3 - 8t, 0 at t = 3/8.
  EXPECT_EQ(approach->time, exact::AlgebraicNumber(exact::Rational(3, 8)));
}

TEST(NearestApproach, AgreesWithTheOracleOnBothSides) {
  tests::Random random(20261123);
  int asked = 0;
  for (int i = 0; i < 200; ++i) {
    PosedQuery posed{i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge, {}};
    for (double& x : posed.query.coordinates) x = random.between(-1 << 20, 1 << 20) * 0x1p-20;
    const auto approach = nearest_approach(posed.kind, posed.query);
    const auto collides = [&](double d) {
      return exact::decide(posed.kind, posed.query, {.distance = d, .norm = Norm::l2}).collides();
    };
    ASSERT_EQ(!approach, collides(0.0)) << posed;
    if (!approach) continue;
    ++asked;
    EXPECT_EQ(approach->at_most, std::nextafter(approach->above, 2.0 * approach->above));
    EXPECT_FALSE(collides(approach->above)) << posed;
    EXPECT_TRUE(collides(approach->at_most)) << posed;
  }
  EXPECT_GT(asked, 50);
}

TEST(NearestApproach, BeyondEveryDoubleDoesNotExist) {
  constexpr double greatest = std::numeric_limits<double>::max();
  const PosedQuery far =
      tests::vertex_face({greatest, 0, 0, -greatest, 0, 0, -greatest, 1, 0, -greatest, 0, 1},
                         {greatest, 0, 0, -greatest, 0, 0, -greatest, 1, 0, -greatest, 0, 1});
  EXPECT_FALSE(nearest_approach(far.kind, far.query));
}

}  // namespace
}  // namespace touchstone::verify::view::query_facts_test
