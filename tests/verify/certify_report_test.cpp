#include "verify/certify_report.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace touchstone::verify {
namespace {

std::vector<CertifyResult> results() {
  CertifyResult clean;
  clean.name = "a/vertex-face.csv";
  clean.kind = Kind::vertex_face;
  clean.queries = 8;
  clean.collisions = 3;
  clean.labels = 8;
  clean.microseconds = 16.0;
  CertifyResult wrong;
  wrong.name = "b,c/edge-edge.csv";
  wrong.kind = Kind::edge_edge;
  wrong.queries = 2;
  wrong.collisions = 2;
  wrong.labels = 2;
  wrong.label_mismatches = 1;
  wrong.tois = 1;
  wrong.toi_mismatches = 1;
  wrong.skipped = 4;
  wrong.rounded = 9;
  wrong.microseconds = 34.0;
  wrong.mismatches = {{Mismatch::Of::label, 0, "no collision", "collision"},
                      {Mismatch::Of::toi, 1, "2.5E-1", "5E-1"}};
  wrong.fail("b,c/edge-edge.csv:17:3: denominator is zero");
  return {clean, wrong};
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(CertifyReport, TextHasARowASourceTheTotalAndEachMismatch) {
  std::istringstream text(to_text(results()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 8U);
  using Words = std::vector<std::string>;
  EXPECT_EQ(words(lines[1]),
            (Words{"a/vertex-face.csv", "vertex-face", "8", "3", "8", "0", "0", "0", "2.00"}));
  EXPECT_EQ(words(lines[2]),
            (Words{"b,c/edge-edge.csv", "edge-edge", "2", "2", "2", "1", "1", "1", "17.00"}));
  EXPECT_EQ(words(lines[3]), (Words{"total", "10", "5", "10", "1", "1", "1", "5.00"}));
  EXPECT_EQ(lines[4], "4 queries in error skipped");
  EXPECT_EQ(lines[5], "9 coordinates rounded to double");
  EXPECT_EQ(lines[6],
            "mismatch: b,c/edge-edge.csv: edge-edge query 0: recorded label no collision, truth "
            "collision");
  EXPECT_EQ(lines[7],
            "mismatch: b,c/edge-edge.csv: edge-edge query 1: recorded toi 2.5E-1, truth 5E-1");
}

TEST(CertifyReport, JsonHasTotalFilesAndMismatches) {
  const nlohmann::json json = to_json(results());
  EXPECT_EQ(json.at("queries"), 10);
  EXPECT_EQ(json.at("collisions"), 5);
  EXPECT_EQ(json.at("label_mismatches"), 1);
  EXPECT_EQ(json.at("toi_mismatches"), 1);
  EXPECT_EQ(json.at("skipped"), 4);
  EXPECT_EQ(json.at("rounded"), 9);
  EXPECT_EQ(json.at("errors"), 1);
  EXPECT_EQ(json.at("us_per_query"), 5.0);
  EXPECT_EQ(json.at("interrupted"), false);
  ASSERT_EQ(json.at("files").size(), 2U);
  EXPECT_EQ(json.at("files")[0].at("file"), "a/vertex-face.csv");
  EXPECT_EQ(json.at("files")[0].at("us_per_query"), 2.0);
  EXPECT_FALSE(json.at("files")[0].contains("error"));
  EXPECT_EQ(json.at("files")[1].at("kind"), "edge-edge");
  EXPECT_EQ(json.at("files")[1].at("error"), "b,c/edge-edge.csv:17:3: denominator is zero");
  ASSERT_EQ(json.at("mismatches").size(), 2U);
  EXPECT_EQ(json.at("mismatches")[1], (nlohmann::json{{"file", "b,c/edge-edge.csv"},
                                                      {"index", 1},
                                                      {"kind", "edge-edge"},
                                                      {"of", "toi"},
                                                      {"recorded", "2.5E-1"},
                                                      {"truth", "5E-1"}}));
}

TEST(CertifyReport, NothingGivesAnEmptyReport) {
  const nlohmann::json json = to_json({});
  EXPECT_EQ(json.at("queries"), 0);
  EXPECT_EQ(json.at("us_per_query"), 0.0);
  EXPECT_TRUE(json.at("mismatches").is_array());
}

TEST(CertifyReport, TruthIsCsvWhoseDoublesComeBack) {
  const double lower = 0.1, upper = std::nextafter(0.1, 1.0);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(truth_header(), "file,index,kind,collides,toi_lower,toi_upper\n");
  EXPECT_EQ(truth_row("plain.csv", Kind::vertex_face,
                      {.index = 0, .collides = false, .toi = std::nullopt}),
            "plain.csv,0,vertex-face,0,,\n");
  EXPECT_EQ(truth_row("with,comma \"and quotes\"", Kind::edge_edge,
                      {.index = 7, .collides = true, .toi = exact::DoubleInterval{lower, upper}}),
            "\"with,comma \"\"and quotes\"\"\",7,edge-edge,1,0.1,0.10000000000000002\n");
  EXPECT_EQ(truth_row("tiny", Kind::edge_edge,
                      {.index = 8, .collides = true, .toi = exact::DoubleInterval{0.0, least}}),
            "tiny,8,edge-edge,1,0,5e-324\n");
  EXPECT_EQ(std::stod("0.10000000000000002"), upper);
}

}  // namespace
}  // namespace touchstone::verify
