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
