#include "verify/view/query_files.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/io/compressor.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::view::query_files_test {
namespace {

/// Queries that differ in one number.
Query numbered(int number) { return tests::over_triangle(1, 1, 1, -0.1 * number).query; }

/// A query as it is viewed.
using AnyViewed = decltype(ViewedQuery::query);

AnyViewed any(const Query& query) { return base::AnyQuery(Kind::vertex_face, query); }

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

TEST_F(QueryFiles, RowsOfADataset) {
  const auto rows = [](int i) { return data::csv_rows({Kind::vertex_face, numbered(i)}, i != 0); };
  write("vertex-face.csv", rows(0) + rows(1) + rows(2));
  const auto all = queries("vertex-face.csv");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].query, any(numbered(1)));
  EXPECT_EQ(all[1].label, path("vertex-face.csv") + ":1");
  EXPECT_EQ(all[1].notes, std::vector<std::string>{"The dataset says that they collide."});
  const auto chosen = queries("vertex-face.csv", {.indices = {2, 0}});
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_EQ(chosen[0].query, any(numbered(0)));
  EXPECT_EQ(chosen[1].query, any(numbered(2)));
  EXPECT_EQ(queries("vertex-face.csv", {.most = 2}).size(), 2U);
  EXPECT_EQ(reason("vertex-face.csv", {.indices = {3}}), "there is no query 3; it has 3");
}

TEST_F(QueryFiles, QueriesOnCurves) {
  std::string text = "rational,2\n";
  for (int row = 0; row < 24; ++row) text += std::to_string(row) + ",-0.25,3,0.5\n";
  write("edge-edge.csv", text);
  const auto all = queries("edge-edge.csv");
  ASSERT_EQ(all.size(), 2U);
  const auto& second = std::get<base::AnyQuery>(all[1].query);
  EXPECT_EQ(second.shape(),
            (QueryShape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true}));
  const Trajectory third = curves_of(all[1])[2];
  EXPECT_EQ(third.control[1], (std::array{18.0, -0.25, 3.0}));
  EXPECT_EQ(third.weights, std::vector<double>(3, 0.5));
  EXPECT_EQ(all[1].label, path("edge-edge.csv") + ":1");
  EXPECT_EQ(queries("edge-edge.csv", {.indices = {1}}).at(0).query, all[1].query);
  EXPECT_EQ(queries("edge-edge.csv", {.most = 1}).size(), 1U);
  EXPECT_EQ(kind_of(queries("edge-edge.csv", {.kind = Kind::vertex_face}).at(0)),
            Kind::vertex_face);
  EXPECT_EQ(reason("edge-edge.csv", {.indices = {2}}), "there is no query 2; it has 2");
}

TEST_F(QueryFiles, AFindingOfTheFuzzer) {
  write(
      "found.json", R"({"findings": [{"kind": "edge-edge", "what": "late_toi", "method": "mine",
    "detail": "toi_lower is above", "separation": {"min_separation": 0.5, "norm": "l2"},
    "coordinates": [)" + std::string("\"0x1p-1074\", \"-0x1.8p+0\"") +
                        [] {
                          std::string rest;
                          for (int i = 2; i < 24; ++i) rest += ", " + std::to_string(i);
                          return rest;
                        }() +
                        R"(], "answer": {"verdict": "yes", "toi_lower": 0.75, "toi_upper": null,
    "tolerance": null}}]})");
  const auto all = queries("found.json");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(kind_of(all[0]), Kind::edge_edge);
  const Query* const query = straight_of(all[0]);
  ASSERT_NE(query, nullptr);
  EXPECT_EQ(query->coordinates[0], 5e-324);
  EXPECT_EQ(query->coordinates[1], -1.5);
  EXPECT_EQ(query->coordinates[23], 23.0);
  EXPECT_EQ(all[0].separation, (Separation{.distance = 0.5, .norm = Norm::l2}));
  EXPECT_EQ(all[0].label, path("found.json") + ":0, late_toi of mine");
  ASSERT_EQ(all[0].answers.size(), 1U);
  EXPECT_EQ(all[0].answers[0].solver, "mine");
  EXPECT_EQ(all[0].answers[0].answer.toi_lower, 0.75);
  EXPECT_EQ(all[0].answers[0].answer.verdict, fast::Verdict::yes);
}

TEST_F(QueryFiles, CurvesInJsonAreThoseOfAPage) {
  const OwnCurves curves{.kind = Kind::edge_edge,
                         .curves = {{{.control = {{1, 1, 1}, {1, 1, -1}}, .weights = {1, 2}},
                                     {.control = {{0, 0, 0.1}}, .weights = {1}},
                                     {.control = {{4, 0, 0}}, .weights = {0.5}},
                                     {.control = {{0, 4, 0}}, .weights = {1}}}}};
  nlohmann::json facts = query_facts({.label = "of a page", .query = curves}, {});
  const auto read_again = [&] {
    write("curves.json", facts.dump());
    return reason("curves.json");
  };
  EXPECT_EQ(read_again(), "none");
  EXPECT_EQ(queries("curves.json").at(0).query, AnyViewed(curves));
  facts["weights"][1][0] = -1;
  EXPECT_EQ(read_again(), "query 0: a weight is not positive");
  facts.erase("weights");
  EXPECT_EQ(read_again(), "none");
  EXPECT_TRUE(curves_of(queries("curves.json").at(0))[0].weights.empty());
  facts["control"].push_back(facts["control"][0]);
  EXPECT_EQ(read_again(), "query 0: a curve has a gap");
  facts["control"] = nlohmann::json::array();
  EXPECT_EQ(read_again(), "query 0: control must be a list for each of 1 to 9 control points");
  facts["control"] = {{nullptr, nullptr, nullptr, nullptr}};
  EXPECT_NE(read_again(), "none") << "each curve has a point";
}

TEST_F(QueryFiles, FaultyJson) {
  write("text.json", "no json");
  EXPECT_NE(reason("text.json").find("parse error"), std::string::npos);
  write("few.json", R"({"kind": "edge-edge", "coordinates": [1, 2]})");
  EXPECT_EQ(reason("few.json"), "query 0: coordinates must be a list of 24 numbers");
  write("kind.json", R"([{"kind": "both", "coordinates": []}])");
  EXPECT_EQ(reason("kind.json"),
            "query 0: kind must be vertex-face, edge-edge, tetrahedron or plane-triangle");
  write("none.json", R"({"coordinates": []})");
  EXPECT_EQ(reason("none.json"), "query 0: nothing says the kind; add --kind");
  write("empty.json", R"({"findings": []})");
  EXPECT_EQ(reason("empty.json"), "there is no query in it");
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
}

TEST_F(QueryFiles, LinesOfVertices) {
  write("query.obj",
        "# a query\nv 1 1 1\nv 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -0.10000000000000001\nv 0 0 0\n"
        "v 4 0 0\nv 0 4 0\n");
  const auto read_ones = queries("query.obj", {.kind = Kind::vertex_face});
  ASSERT_EQ(read_ones.size(), 1U);
  EXPECT_EQ(read_ones[0].query, any(numbered(1)));
  EXPECT_NE(reason("query.obj"), "none") << "nothing says the kind";
  write("few.obj", "v 1 2 3\n");
  EXPECT_EQ(reason("few.obj", {.kind = Kind::edge_edge}), "3 numbers, not the 24 of a query");
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

TEST(ParsePoints, AnySeparators) {
  const Query query = parse_points(
      "{{1, 1,1; (0 0 0) [4,0,0] 0 4 0\n1 1 -0x1.999999999999ap-4 0 0 0 4 0 0 0 4 0}}");
  EXPECT_EQ(query, numbered(1));
  EXPECT_THROW((void)parse_points("1 2 3"), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::view::query_files_test
