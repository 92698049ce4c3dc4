#include "verify/report/step_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace touchstone::verify::report::step_report_test {
namespace {

const std::vector<fast::Edge>& edges() {
  static const std::vector<fast::Edge> all{{0, 1}, {0, 2}, {1, 2}, {3, 4}};
  return all;
}

const std::vector<fast::Face>& faces() {
  static const std::vector<fast::Face> all{{0, 1, 2}};
  return all;
}

fast::StepCollision collision(fast::PairKind kind, fast::IndexPair pair, double lower) {
  return {.kind = kind, .pair = pair, .toi_lower = lower, .toi_upper = lower, .u = 0.25, .v = 0.5};
}

/// A step with this number of collisions, the last one first, and one piercing at its end.
StepReport report_of(std::size_t collisions) {
  StepReport report{.vertices = 5, .edges = edges(), .faces = faces(), .frames = {}, .steps = {}};
  using Piercings = std::vector<mesh::Piercing>;
  report.frames = {{.name = "a\n", .piercings = Piercings{}, .time = {}},
                   {.name = "b", .piercings = Piercings{{.edge = 3, .face = 0}}, .time = {}}};
  StepRecord step;
  step.candidates = jobs::PairCounts{7, 8, 0, 0};
  step.is_free = collisions == 0;
  step.collisions.emplace();
  for (std::size_t i = collisions; i > 0; --i) {
    step.collisions->push_back(
        collision(fast::PairKind::vertex_face, {3, 0}, static_cast<double>(i) / 64.0));
  }
  if (collisions != 0) {
    step.earliest = {
        .toi_lower = 1.0 / 64.0, .toi_upper = 1.0 / 64.0, .pairs = {step.collisions->back()}};
  }
  step.broad_phase = {.wall = 0.5, .processor = 1.0};
  step.narrow_phase = {.wall = 0.25, .processor = 0.5};
  report.steps.push_back(step);
  return report;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(StepReport, NamesPairsByTheirVerticesAndTheEarliestFirst) {
  const std::string text = to_text(report_of(12));
  EXPECT_TRUE(contains(text, "a\\x0a - b")) << text;
  const std::size_t first = text.find("vertex 3, face 0 (0 1 2)");
  ASSERT_NE(first, std::string::npos);
  EXPECT_TRUE(contains(text.substr(first, 80), "0.015625")) << text;
  EXPECT_TRUE(contains(text, "... and 2 more (--csv FILE)")) << text;
  EXPECT_TRUE(contains(text, "b: the mesh intersects itself; edges that pierce faces: 1")) << text;
  EXPECT_TRUE(contains(text, "edge 3 (3 4), face 0 (0 1 2)")) << text;
}

TEST(StepReport, KnowsWhetherAllIsFree) {
  StepReport report = report_of(1);
  EXPECT_TRUE(has_collisions(report));
  report = report_of(0);
  EXPECT_TRUE(has_collisions(report));
  report.frames[1].piercings->clear();
  EXPECT_FALSE(has_collisions(report));
  EXPECT_TRUE(contains(to_text(report), "free"));
}

TEST(StepReport, HasItsNumbersAsJson) {
  const nlohmann::json json = to_json(report_of(2));
  EXPECT_TRUE(json["separation"].is_null());
  EXPECT_EQ(json["question"], "all");
  const nlohmann::json& step = json["steps"][0];
  EXPECT_EQ(step["candidates"]["edge_edge"], 8);
  EXPECT_EQ(step["collisions"]["vertex_face"], 2);
  EXPECT_EQ(step["toi_lower"], 1.0 / 64.0);
  EXPECT_EQ(step["earliest"].size(), 1U);
  EXPECT_EQ(step["earliest"][0]["first"], 3);
  EXPECT_EQ(step["free"], false);
  EXPECT_EQ(step["pierced"], 1);
  EXPECT_EQ(step["seconds"]["total"], 0.75);
  EXPECT_EQ(step["processor_seconds"]["total"], 1.5);
  EXPECT_FALSE(step.contains("free_alpha"));
  EXPECT_EQ(json["frames"][1]["piercings"], (nlohmann::json{{3, 0}}));
}

TEST(StepReport, OfFreedomAloneHasNoTimes) {
  StepReport report = report_of(1);
  report.question = jobs::StepQuestion::free;
  report.steps[0].earliest.reset();
  report.steps[0].collisions.reset();
  EXPECT_TRUE(contains(to_text(report), "not free"));
  const nlohmann::json step = to_json(report)["steps"][0];
  EXPECT_TRUE(step["toi_lower"].is_null());
  EXPECT_TRUE(step["collisions"].is_null());
}

TEST(StepReport, HasARowOfCsvForEachPair) {
  EXPECT_EQ(step_csv_rows(report_of(2), 0),
            "0,a\\x0a,b,vertex-face,3,0,0.03125,0.03125,0.25,0.5\n"
            "0,a\\x0a,b,vertex-face,3,0,0.015625,0.015625,0.25,0.5\n");
  EXPECT_EQ(step_csv_header(), "step,frame0,frame1,kind,first,second,toi_lower,toi_upper,u,v\n");
}

}  // namespace
}  // namespace touchstone::verify::report::step_report_test
