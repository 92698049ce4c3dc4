// What a page says of most queries is in tests/transcripts/view.md.

#include "verify/view/query_facts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/oracle.hpp"
#include "verify/io/compressor.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/mesh/mesh_file.hpp"
#include "verify/view/query_files.hpp"
#include "verify/view/step_facts.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view::query_facts_test {
namespace {

using tests::PosedQuery;

/// A vertex falls through a resting triangle at t = 1/3, above (u,v) = (1/4, 1/4).
ViewedQuery falling() {
  const Query query = tests::over_triangle(1, 1, 1, -2).query;
  return {.label = "a label", .query = base::AnyQuery(ContactKind::vertex_face, query)};
}

TEST(QueryFacts, TextsArePrintable) {
  ViewedQuery query = falling();
  query.label = "a\x1b\n";
  query.notes = {"b\x01"};
  const nlohmann::json facts = query_facts(query, {});
  EXPECT_EQ(facts.at("label"), "a\\x1b\\x0a");
  EXPECT_EQ(facts.at("notes"), nlohmann::json::array({"b\\x01"}));
}

// ---- The nearest approach -------------------------------------------------------------------------

TEST(NearestApproach, AgreesWithTheOracleOnBothSides) {
  tests::Random random(20261123);
  int asked = 0;
  for (int i = 0; i < 200; ++i) {
    PosedQuery posed{i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge, {}};
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

// ---- Steps --------------------------------------------------------------------------------------

/// The points of a pair are those of its query.
TEST(StepFacts, EveryKindOfPairByItsPoints) {
  // Edge 0-1 and point 4 pass down through edge 2-3, and point 6 through point 5.
  const std::vector<std::array<double, 3>> coordinates{
      {-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}, {0, 0.5, 3}, {5, 5, 5}, {5, 5, 6}};
  mesh::Mesh mesh = mesh::make_mesh(coordinates, {}, std::vector<fast::Edge>{{0, 1}, {2, 3}});
  mesh.points = {4, 5, 6};
  mesh::Vertices after = mesh.vertices;
  after(0, 2) = after(1, 2) = -1;
  after(4, 2) = -1;
  after(6, 2) = 4;
  const ViewedStep found = find_collisions("kinds", mesh, mesh.vertices, after, {});
  ASSERT_EQ(found.collisions.size(), 3U);
  for (std::size_t i = 0; i < found.collisions.size(); ++i) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const Eigen::Index vertex = found.points[i].at(point);
      EXPECT_EQ(point_of(found.queries[i], 0, point), mesh.vertices.row(vertex).transpose()) << i;
      EXPECT_EQ(point_of(found.queries[i], 1, point), after.row(vertex).transpose()) << i;
    }
  }
}

// ---- Queries of files ---------------------------------------------------------------------------

class QueryFiles : public tests::FolderTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  [[nodiscard]] std::vector<ViewedQuery> queries(const std::string& name,
                                                 const QueryFileOptions& options = {}) const {
    return read_queries(path(name), options);
  }
  /// The reason why the file is refused.
  [[nodiscard]] std::string reason(const std::string& name,
                                   const QueryFileOptions& options = {}) const {
    try {
      (void)queries(name, options);
    } catch (const io::DatasetError& error) {
      return error.reason();
    }
    return "none";
  }
};

TEST_F(QueryFiles, CurvesInJsonAreThoseOfAPage) {
  const std::vector<double> numbers{1, 1, 1,  1, 0, 0, 0.1, 1, 4, 0, 0, 0.5, 0, 4, 0, 1,
                                    1, 1, -1, 2, 0, 0, 0.1, 1, 4, 0, 0, 0.5, 0, 4, 0, 1};
  const base::AnyQuery curves({ContactKind::edge_edge, 1, true}, numbers);
  nlohmann::json facts = query_facts({.label = "of a page", .query = curves}, {});
  const auto read_again = [&] {
    write("curves.json", facts.dump());
    return reason("curves.json");
  };
  EXPECT_EQ(read_again(), "none");
  EXPECT_EQ(queries("curves.json").at(0).query, curves);
  facts["weights"][1][0] = -1;
  EXPECT_EQ(read_again(), "query 0: a weight is not positive");
  facts.erase("weights");
  EXPECT_EQ(read_again(), "none");
  EXPECT_TRUE(queries("curves.json").at(0).query.shape().is_straight());
  facts["control"] = nlohmann::json::array();
  EXPECT_EQ(read_again(), "query 0: control must be a list for each of 2 to 9 control points");
}

TEST_F(QueryFiles, FaultyJson) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {R"({"kind": "edge-edge", "coordinates": [1, 2]})",
            "query 0: coordinates must be a list of 24 numbers"},
           {R"([{"kind": "both", "coordinates": []}])",
            "query 0: kind must be vertex-face, edge-edge, tetrahedron or plane-triangle"},
           {R"({"coordinates": []})", "query 0: nothing says the kind; add --kind"},
           {R"({"findings": []})", "there is no query in it"}}) {
    write("faulty.json", text);
    EXPECT_EQ(reason("faulty.json"), expected);
  }
}

// A small compressed file may hold a text of any length: the memory does not follow it.
TEST_F(QueryFiles, ACertificateIsBounded) {
  const auto write_compressed = [this](const std::string& name, const std::string& beginning,
                                       const std::string& block, int count) {
    io::Compressor compressor;
    std::ofstream file(path(name), std::ios::binary);
    file << compressor.compress(beginning);
    for (int n = 0; n < count; ++n) file << compressor.compress(block);
    file << compressor.finish();
  };
  std::string mebibyte;
  for (int n = 0; n < 1'024; ++n) mebibyte += '#' + std::string(1'022, ' ') + '\n';
  const std::string header(exact::certificates_header());
  write_compressed("endless.cert.zst", header + "query vertex_face\n", mebibyte, 17);
  EXPECT_EQ(reason("endless.cert.zst"),
            "a certificate of more than 16 MiB; is its line 'end' missing?");
  write_compressed("comments.cert.zst", header, mebibyte, 17);
  EXPECT_EQ(reason("comments.cert.zst"), "there is no query in it");
  write("text.cert", "no certificate\n");
  EXPECT_EQ(reason("text.cert"), "not a stream of certificates");
  write("cut.cert.zst", read("comments.cert.zst").substr(0, 100));
  EXPECT_EQ(reason("cut.cert.zst"), "its compressed stream is cut");
}

TEST(ParseNumber, DecimalsHexadecimalsAndFractions) {
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number("-0x1.8p-3"), -0.1875);
  EXPECT_EQ(parse_number("1/3"), 1.0 / 3.0);
  EXPECT_EQ(parse_number("0x1p-1074"), 5e-324);
  for (const std::string text :
       {"", "x", "0x", "1e999", "nan", "inf", "0x1p+2000", "1/0", "1.5x"}) {
    EXPECT_THROW((void)parse_number(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace touchstone::verify::view::query_facts_test
