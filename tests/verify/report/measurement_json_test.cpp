#include "verify/report/measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace touchstone::verify::report::measurement_json_test {
namespace {

Measurement with_all_fields() {
  Measurement m;
  m.experiment = Experiment::separation;
  m.group = "group \"quoted\"";
  m.kind = Kind::edge_edge;
  m.method = "msrf";
  m.promise = fast::Promise::conservative;
  m.tolerance = 1e-6;
  m.max_checks = 7;
  m.separation = {.distance = 1e-100, .norm = Norm::l2};
  m.scale = 1e-3;
  m.group_queries = 1000;
  m.asked = 100;
  m.collisions = 40;
  m.false_positives = 1;
  m.false_negatives = 2;
  m.late_tois = 3;
  m.early_upper_tois = 4;
  m.errors = 5;
  m.undecided = 6;
  m.at_limit = 8;
  m.keeps_promise = false;
  m.nanoseconds = 0.1;
  m.repetitions = 9;
  m.certified_nanoseconds = 1.0 / 3.0;
  m.toi_error = Spread{.count = 38, .median = 1e-300, .max = 0.7};
  m.achieved_tolerance =
      Spread{.count = 2, .median = 1.0, .max = std::numeric_limits<double>::infinity()};
  m.stages = {{"axis", 99}, {"exact", 1}};
  m.collision_times.bins = {{-1, 2}, {40, 38}};
  m.no_collision_times.bins = {{8, 60}};
  return m;
}

Measurements example() {
  Measurements measurements;
  measurements.command = "touchstone report 'a b'";
  measurements.machine = "a machine";
  measurements.date = "2026-01-31";
  measurements.interrupted = true;
  measurements.all = {with_all_fields(), Measurement{}};
  StabilityMark mark{{.collisions = 10,
                      .false_positives = 1,
                      .false_negatives = 2,
                      .late_tois = 3,
                      .early_upper_tois = 4,
                      .beyond_tolerance = 5,
                      .errors = 6,
                      .undecided = 7,
                      .toi_error = Spread{.count = 8, .median = 0.0, .max = 1e-9},
                      .nanoseconds = 1e3}};
  mark.method = "certified";
  mark.hardness = "angle";
  mark.measure = "angle to parallel";
  mark.exponent = -50;
  mark.kind = Kind::edge_edge;
  mark.queries = 20;
  mark.worst = judge::Fault::late_toi;
  mark.is_slight = true;
  mark.worst_rate = 0.2;
  mark.checks = 2.5;
  measurements.stability.push_back(mark);
  return measurements;
}

TEST(MeasurementJson, ComesBackWithoutLoss) {
  const nlohmann::json written = to_json(example());
  const Measurements read = measurements_from_json(nlohmann::json::parse(written.dump()));
  ASSERT_EQ(read.all.size(), 2U);
  EXPECT_EQ(read.all[0].achieved_tolerance, with_all_fields().achieved_tolerance);
  EXPECT_TRUE(std::isnan(read.all[1].nanoseconds));
  EXPECT_EQ(read.stability, example().stability);
  EXPECT_EQ(to_json(read), written) << "every field that is written is read";
}

/// From before there were scale and date, and maps had all counts.
TEST(MeasurementJson, ReadsWhatEarlierVersionsWrote) {
  nlohmann::json earlier = to_json(example());
  earlier["measurements"][0].erase("scale");
  earlier.erase("date");
  for (const char* const later :
       {"late_tois", "early_upper_tois", "beyond_tolerance", "errors", "undecided", "toi_error",
        "checks_per_query", "is_power", "is_slight", "hangs"}) {
    earlier["stability"][0].erase(later);
  }
  const Measurements read = measurements_from_json(earlier);
  EXPECT_FALSE(read.all[0].scale.has_value());
  EXPECT_EQ(read.date, "");
  const StabilityMark& mark = read.stability.at(0);
  EXPECT_EQ(mark.false_negatives, 2U);
  EXPECT_EQ(mark.late_tois, 0U);
  EXPECT_TRUE(mark.is_power);
  EXPECT_EQ(mark.hangs, 0U);
  EXPECT_FALSE(mark.toi_error.has_value());
  EXPECT_TRUE(std::isnan(mark.checks));
}

TEST(MeasurementJson, InvalidTextIsRefused) {
  const nlohmann::json good = to_json(example());
  for (const char* const patch :
       {R"([{"op": "replace", "path": "/format", "value": "touchstone measurements 0"}])",
        R"([{"op": "remove", "path": "/measurements/0/asked"}])",
        R"([{"op": "replace", "path": "/measurements/0/kind", "value": "face-face"}])",
        R"([{"op": "replace", "path": "", "value": 3}])"}) {
    EXPECT_THROW(
        static_cast<void>(measurements_from_json(good.patch(nlohmann::json::parse(patch)))),
        std::runtime_error)
        << patch;
  }
}

}  // namespace
}  // namespace touchstone::verify::report::measurement_json_test
