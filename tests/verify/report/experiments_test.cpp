#include "verify/report/experiments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/query_groups.hpp"

namespace touchstone::verify::report::experiments_test {
namespace {

/// Vertices over a triangle, every second of which falls through it.
std::vector<data::QueryGroup> falling() {
  std::vector<data::QueryGroup> groups;
  groups.push_back(tests::falling_group(20, 2));
  return groups;
}

ExperimentOptions quick() {
  ExperimentOptions options;
  options.methods = {"certified", "tight_inclusion"};
  options.count = 10;
  options.seconds = 0.02;
  options.repetitions = 1;
  options.stability_count = 2;
  return options;
}

std::size_t settings_in(const Measurements& measured, Experiment experiment) {
  return static_cast<std::size_t>(
      std::ranges::count(measured.all, experiment, &Measurement::experiment));
}

TEST(Experiments, TrialsAreThoseOfTheMethodsThere) {
  ExperimentOptions options = quick();
  options.stability_count = 0;
  options.methods = {"certified", "tight_inclusion", "irf", "uirf", "fprf", "msrf", "tccd"};
  const std::vector<data::QueryGroup> groups = falling();
  const Measurements all = run_experiments(groups, options);
  EXPECT_EQ(settings_in(all, Experiment::field), 7U);
  EXPECT_EQ(settings_in(all, Experiment::tolerance), 3U * 9U);
  EXPECT_EQ(settings_in(all, Experiment::checks), 6U);
  EXPECT_EQ(settings_in(all, Experiment::separation), 7U * (2U + 3U));
  // Those of the paper's tables are among the distances, and there are two more.
  std::set<double> distances;
  for (const Measurement& measurement : all.all) distances.insert(measurement.separation.distance);
  EXPECT_EQ(distances, (std::set<double>{0.0, 1e-100, 1e-30, 1e-16, 1e-8, 1e-4, 1e-2, 1.0}));

  options.methods = {"tccd"};
  const Measurements one = run_experiments(groups, options);
  ASSERT_EQ(one.all.size(), 1U);
  EXPECT_EQ(one.all[0].experiment, Experiment::field);
  EXPECT_EQ(one.all[0].method, "tccd");
}

TEST(Experiments, MeasuresEveryTrialAndTheMapOfStability) {
  const std::vector<data::QueryGroup> groups = falling();
  const Measurements result = run_experiments(groups, quick());
  EXPECT_FALSE(result.interrupted);
  EXPECT_FALSE(result.machine.empty());
  EXPECT_TRUE(std::regex_match(result.date, std::regex(R"(\d{4}-\d\d-\d\d)"))) << result.date;
  // Of certified and tight_inclusion: the field; tolerances and checks of the second; distances in
  // both norms, and in one.
  ASSERT_EQ(result.all.size(), 2U + 9U + 6U + 7U * (2U + 1U));
  for (const Measurement& measurement : result.all) {
    EXPECT_EQ(measurement.group, "falling");
    EXPECT_EQ(measurement.asked, measurement.experiment == Experiment::separation ? 3U : 10U);
    EXPECT_TRUE(measurement.keeps_promise) << measurement.method;
    if (measurement.experiment == Experiment::field) {
      EXPECT_EQ(measurement.collisions, 5U);
    }
    if (measurement.separation.distance == 1.0) {
      EXPECT_EQ(measurement.collisions, 3U);
    }
  }
  EXPECT_EQ(result.all[0].method, "certified");
  EXPECT_EQ(result.all[0].stages.size(), 5U);
  // Ten hardnesses, eleven levels, two kinds, two methods.
  ASSERT_EQ(result.stability.size(), 10U * 11U * 2U * 2U);
  for (const StabilityMark& mark : result.stability) {
    EXPECT_EQ(mark.queries, 2U);
    EXPECT_EQ(mark.collisions, 1U);
    if (mark.method == "certified") {
      EXPECT_EQ(mark.worst, std::nullopt);
    }
  }
}

TEST(Experiments, MethodsAreMeasuredOnTheCurvesThatTheyTake) {
  std::vector<data::QueryGroup> groups = falling();
  groups.push_back(tests::curved_group(Kind::edge_edge, 10));
  ExperimentOptions options = quick();
  options.methods = {"certified", "subdivision", "accd"};
  options.experiments = {Experiment::field};
  options.stability_count = 1;
  const Measurements result = run_experiments(groups, options);
  std::vector<std::pair<std::string, std::string>> measured;
  for (const Measurement& m : result.all) {
    measured.emplace_back(m.group, m.method);
    EXPECT_EQ(m.asked, 10U) << m.method;
    EXPECT_EQ(m.outside, 0U) << m.method;
  }
  const std::vector<std::pair<std::string, std::string>> expected{{"falling", "certified"},
                                                                  {"falling", "accd"},
                                                                  {"curves", "certified"},
                                                                  {"curves", "subdivision"}};
  EXPECT_EQ(measured, expected);
  std::set<std::string> on_the_map;
  for (const StabilityMark& mark : result.stability) on_the_map.insert(mark.method);
  EXPECT_EQ(on_the_map, (std::set<std::string>{"accd", "certified"}));
}

TEST(Experiments, FiltersAreComparedOnFamiliesAndOverTheScale) {
  const std::vector<data::QueryGroup> groups = falling();
  ExperimentOptions options = quick();
  options.methods = {"tight_inclusion", "tight_inclusion_released"};
  options.count = 40;
  options.experiments = {Experiment::filter};
  options.stability_count = 0;
  const Measurements result = run_experiments(groups, options);
  std::set<double> scales;
  std::map<std::string, std::uint64_t> missed;
  for (const Measurement& m : result.all) {
    EXPECT_EQ(m.experiment, Experiment::filter);
    EXPECT_EQ(m.kind, Kind::vertex_face) << "the groups are of one kind";
    EXPECT_EQ(m.asked, 40U);
    if (m.scale) {
      EXPECT_EQ(m.collisions, 40U);
      scales.insert(*m.scale);
      missed[m.method] += m.false_negatives;
    }
  }
  EXPECT_EQ(scales.size(), 7U);
  EXPECT_EQ(missed["tight_inclusion"], 0U);
  EXPECT_GT(missed["tight_inclusion_released"], 0U);
}

}  // namespace
}  // namespace touchstone::verify::report::experiments_test
