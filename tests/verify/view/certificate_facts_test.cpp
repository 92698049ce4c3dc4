#include "verify/view/query_facts.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <variant>

#include "tests/support/queries.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::view::certificate_facts_test {
namespace {

/// The first example of exact/CERTIFICATES.md.
const std::string over_an_edge =
    "touchstone-certificates 2\nquery vertex_face\nlabel over an edge\n"
    "point 0x1p+0 -0x1p+0 0x1p+0\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\n"
    "point 0x1p+0 0x1p+0 0x1p+0\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\n"
    "claim no_collision\nseparate 0 1/2 edge 0 1\nseparate 1/2 1 face +\nend\ncertificates 1\n";

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by);
}

TEST(CertificateFacts, TheSubintervalsWithTheirDirections) {
  const nlohmann::json facts = certificate_facts(over_an_edge);
  EXPECT_EQ(facts.at("claim"), "no_collision");
  EXPECT_EQ(facts.at("accepted"), true);
  EXPECT_EQ(facts.at("subintervals"),
            nlohmann::json::parse(R"([{"from": "0", "to": "1/2", "feature": "edge 0 1"},
                                      {"from": "1/2", "to": "1", "feature": "face +"}])"));
  EXPECT_EQ(facts.at("text"), over_an_edge);
}

TEST(CertificateFacts, AWrongProofIsShownAsRefused) {
  const nlohmann::json facts = certificate_facts(replaced(over_an_edge, "face +", "face -"));
  EXPECT_EQ(facts.at("accepted"), false);
  EXPECT_NE(facts.at("reason"), "");
  EXPECT_EQ(facts.at("subintervals").at(1).at("feature"), "face -");
}

TEST(CertificateFacts, TheQueryBitForBit) {
  const tests::PosedQuery posed = tests::edge_edge({-1, 0.1, 1, 1, 0, 1, 0, -1, 0, 0, 1, 5e-324},
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

/// The example on a curve of exact/CERTIFICATES.md, with weights of one point.
const std::string through_a_triangle =
    "touchstone-certificates 2\nquery vertex_face\ncurve 2\n"
    "point 1 1 -3/4\npoint 1 1 5/4\npoint 1 1 -3/4\n"
    "curve 0\npoint 0 0 0\nrational 0\npoint 4 0 0 0x1p-1\ncurve 0\npoint 0 4 0\n"
    "claim time_of_impact 0x1.fffffffffffffp-3 0x1p-2\nseparate 0 0x1.fffffffffffffp-3 face -\n"
    "contact time 0x1p-2\nat triangle 0 1 2 z\nend\ncertificates 1\n";

TEST(CertificateFacts, TheCurvesOfAQueryEachOfItsDegree) {
  const ViewedQuery read = certified_query(through_a_triangle);
  const CurvedQuery expected{{{.control = {{1.0, 1.0, -0.75}, {1.0, 1.0, 1.25}, {1.0, 1.0, -0.75}}},
                              {.control = {{0.0, 0.0, 0.0}}},
                              {.control = {{4.0, 0.0, 0.0}}, .weights = {0.5}},
                              {.control = {{0.0, 4.0, 0.0}}}}};
  EXPECT_EQ(std::get<OwnCurves>(read.query),
            (OwnCurves{.kind = Kind::vertex_face, .curves = expected}));
  EXPECT_EQ(certificate_facts(through_a_triangle).at("accepted"), true);
  EXPECT_NE(straight_of(certified_query(over_an_edge)), nullptr);
}

TEST(CertificateFacts, InvalidTextIsAnError) {
  for (const std::string number : {"0x1p-1", "5/4"}) {
    EXPECT_THROW((void)certified_query(replaced(through_a_triangle, number, "1/3")),
                 std::invalid_argument)
        << "1/3 is no double";
  }
  EXPECT_THROW((void)certified_query(""), std::invalid_argument);
  EXPECT_THROW((void)certified_query("touchstone-certificates 1\n"), std::invalid_argument);
  const exact::Certificate element =
      exact::prove(Kind::tetrahedron, Query{}, exact::decide(Kind::tetrahedron, Query{}));
  EXPECT_THROW((void)certified_query(certificate_stream(element)), std::invalid_argument);
  EXPECT_THROW((void)certified_query(replaced(over_an_edge, "4 0 0", "4 0")),
               std::invalid_argument);
  EXPECT_THROW((void)certified_query(replaced(over_an_edge, "4 0 0", "1/3 0 0")),
               std::invalid_argument)
      << "1/3 is no double";
}

}  // namespace
}  // namespace touchstone::verify::view::certificate_facts_test
