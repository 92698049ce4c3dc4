#include "verify/stability/heat_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cstddef>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::verify::heat_map_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Tree = boost::property_tree::ptree;

/// The picture as any reader of XML sees it.
Tree parsed(const StabilityResult& result) {
  std::istringstream text(heat_map(result));
  Tree tree;
  boost::property_tree::read_xml(text, tree);
  return tree.get_child("svg");
}

/// How often each class of rectangles occurs below.
void count_classes(const Tree& tree, std::map<std::string, int>& counts) {
  for (const auto& [name, child] : tree) {
    if (name == "rect") ++counts[child.get<std::string>("<xmlattr>.class")];
    count_classes(child, counts);
  }
}

/// All texts, groups' descriptions included.
void collect_texts(const Tree& tree, std::vector<std::string>& texts) {
  for (const auto& [name, child] : tree) {
    if (name == "text" || name == "title") texts.push_back(child.data());
    collect_texts(child, texts);
  }
}

/// Classes of the cells of a picture, without those of the same picture without cells' faults.
std::map<std::string, int> classes_of(const StabilityResult& result) {
  std::map<std::string, int> counts;
  count_classes(parsed(result), counts);
  return counts;
}

std::vector<std::string> texts_of(const StabilityResult& result) {
  std::vector<std::string> texts;
  collect_texts(parsed(result), texts);
  return texts;
}

bool has(const std::vector<std::string>& texts, const std::string& text) {
  return std::ranges::find(texts, text) != texts.end();
}

/// All levels of a hardness, ten queries a cell, half of them collisions.
StabilityResult calm_result(const std::string& method = "planted") {
  StabilityResult result;
  result.count = 10;
  const Hardness& hardness = hardness_from_name("distance");
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const int exponent : hardness.exponents) {
      StabilityCell cell{.hardness = &hardness, .exponent = exponent, .kind = kind, .judged = {}};
      cell.judged.queries = 10;
      cell.judged.collisions = 5;
      MethodResult judged{
          .name = method, .promise = fast::Promise::conservative, .timed = true, .judgement = {}};
      judged.judgement.queries = 10;
      judged.judgement.nanoseconds = 1000.0;
      cell.judged.methods.push_back(judged);
      result.total += cell.judged;
      result.cells.push_back(cell);
    }
  }
  return result;
}

void plant(StabilityResult& result, std::size_t cell, Fault fault, std::uint64_t count) {
  result.cells[cell].judged.methods[0].judgement.faults[static_cast<std::size_t>(fault)] = count;
  result.total.methods[0].judgement.faults[static_cast<std::size_t>(fault)] += count;
}

TEST(HeatMap, HasACellForEachMeasureLevelAndKind) {
  std::map<std::string, int> before = classes_of(StabilityResult{});
  const std::map<std::string, int> after = classes_of(calm_result());
  // 22 outcomes and the one of the table above; no times of impact, hence 44 empty cells.
  EXPECT_EQ(after.at("calm") - before.at("calm"), 23);
  EXPECT_EQ(after.at("void"), 44);
  EXPECT_EQ(after.at("q1") - before["q1"], 22) << "100 ns a query";
}

TEST(HeatMap, ShowsAFalseNegativeInItsOwnColourWithItsRate) {
  StabilityResult result = calm_result();
  const std::map<std::string, int> before = classes_of(result);
  plant(result, 3, Fault::false_negative, 1);
  plant(result, 3, Fault::false_positive, 5);
  const std::map<std::string, int> after = classes_of(result);
  EXPECT_EQ(after.at("fn"), before.at("fn") + 2) << "in the cell and in the table";
  EXPECT_EQ(after.at("calm"), before.at("calm") - 2);
  const std::vector<std::string> texts = texts_of(result);
  EXPECT_TRUE(has(texts, "20%"));
  EXPECT_TRUE(has(texts, "<1%")) << "of all collisions, in the table";
  EXPECT_TRUE(has(texts, "planted — promises: conservative; BROKEN"));
}

TEST(HeatMap, ShadesFalsePositivesByTheirRate) {
  StabilityResult result = calm_result();
  const std::map<std::string, int> before = classes_of(result);
  for (std::uint64_t count = 1; count <= 5; ++count) {
    plant(result, count, Fault::false_positive, count);
  }
  const std::map<std::string, int> after = classes_of(result);
  EXPECT_EQ(after.at("p2") - before.at("p2"), 2) << "20%, and all in the table: 15 of 110";
  EXPECT_EQ(after.at("p3") - before.at("p3"), 1) << "40%";
  EXPECT_EQ(after.at("p4") - before.at("p4"), 2) << "60%, 80%";
  EXPECT_EQ(after.at("p5") - before.at("p5"), 1) << "100%";
  EXPECT_TRUE(has(texts_of(result), "planted — promises: conservative; kept"));
}

TEST(HeatMap, OtherFaultsHaveTheirColours) {
  StabilityResult result = calm_result();
  const std::map<std::string, int> before = classes_of(result);
  plant(result, 0, Fault::late_toi, 1);
  plant(result, 1, Fault::error, 1);
  plant(result, 2, Fault::beyond_tolerance, 1);
  const std::map<std::string, int> after = classes_of(result);
  EXPECT_EQ(after.at("time") - before.at("time"), 2) << "the worst in the table";
  EXPECT_EQ(after.at("err") - before.at("err"), 1);
  EXPECT_EQ(after.at("tol") - before.at("tol"), 1);
}

TEST(HeatMap, HasARowOfChecksWhereTheMethodCountsThem) {
  StabilityResult result = calm_result();
  EXPECT_FALSE(has(texts_of(result), "checks/query"));
  for (StabilityCell& cell : result.cells) cell.judged.methods[0].judgement.checks = 123'450;
  result.total.methods[0].judgement.checks = 22 * 123'450;
  const std::vector<std::string> texts = texts_of(result);
  EXPECT_TRUE(has(texts, "checks/query"));
  EXPECT_EQ(std::ranges::count(texts, "12k"), 22);
}

TEST(HeatMap, PrintsNumbersThatFit) {
  StabilityResult result = calm_result();
  const std::vector<std::pair<double, std::string>> printed{
      {0.0, "0"},       {4.9e-324, "10⁻³²⁴"}, {3.2e-13, "3e-13"}, {0.051, "0.051"},
      {1.0, "1"},       {999.6, "1k"},        {999'600, "1M"},    {3e8, "300M"},
      {9.996e8, "9e8"}, {2.5e12, "2e12"},     {1e300, "10³⁰⁰"},   {infinity, "∞"}};
  for (const auto& [error, text] : printed) {
    result.cells[0].judged.methods[0].judgement.toi_errors = {};
    result.cells[0].judged.methods[0].judgement.toi_errors.add(error);
    EXPECT_TRUE(has(texts_of(result), text)) << error;
  }
  EXPECT_TRUE(has(texts_of(result), "100ns"));
  for (const auto& [time, text] : std::vector<std::pair<double, std::string>>{
           {999.6, "1µs"}, {999'600, "1ms"}, {1.2e8, "0.12s"}, {9.996e8, "1s"}, {1e12, "1ks"}}) {
    result.cells[0].judged.methods[0].judgement.nanoseconds = 10.0 * time;
    EXPECT_TRUE(has(texts_of(result), text)) << time;
  }
}

TEST(HeatMap, EscapesTheNamesOfMethods) {
  const std::string name = "<script>&\"\xE9";
  const std::vector<std::string> texts = texts_of(calm_result(name));
  EXPECT_TRUE(has(texts, "<script>&\"\xEF\xBF\xBD"));
  EXPECT_EQ(heat_map(calm_result(name)).find("<script>"), std::string::npos);
}

TEST(HeatMap, SaysWhatItIsAbout) {
  StabilityResult result = calm_result();
  result.seed = 77;
  result.separation = {.distance = 0.25, .norm = Norm::l2};
  result.total.interrupted = true;
  EXPECT_TRUE(has(texts_of(result),
                  "10 queries a cell, half of them collisions; seed 77; separation 0.25 (l2); "
                  "interrupted: not all is here"));
  EXPECT_TRUE(has(texts_of(StabilityResult{}), "no cells were judged"));
  const std::vector<std::string> texts = texts_of(calm_result());
  EXPECT_TRUE(has(texts, "2⁻⁵⁰"));
  EXPECT_TRUE(
      has(texts,
          "planted: distance 2⁻⁵⁰, edge-edge\n10 queries, 5 collisions\n0 false negatives, 0 "
          "false positives, 0 late toi, 0 early upper toi, 0 beyond tolerance, 0 errors, 0 "
          "undecided\n100 ns/query"));
}

TEST(PowerText, IsTheExponentAsPeopleWriteIt) {
  EXPECT_EQ(power_text(0), "2⁰");
  EXPECT_EQ(power_text(-1000), "2⁻¹⁰⁰⁰");
  EXPECT_EQ(power_text(1234567890), "2¹²³⁴⁵⁶⁷⁸⁹⁰");
}

}  // namespace
}  // namespace touchstone::verify::heat_map_test
