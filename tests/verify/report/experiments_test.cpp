#include "verify/report/experiments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/query_groups.hpp"
#include "touchstone/certified.hpp"
#include "verify/report/measure.hpp"

namespace touchstone::verify::report::experiments_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;
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
  options.methods = {"certified", "tight_inclusion", "accd", "cubic"};
  const std::vector<data::QueryGroup> groups = falling();
  const Measurements all = run_experiments(groups, options);
  EXPECT_EQ(settings_in(all, Experiment::field), 4U);
  EXPECT_EQ(settings_in(all, Experiment::tolerance), 2U * 9U);
  EXPECT_EQ(settings_in(all, Experiment::checks), 6U);
  EXPECT_EQ(settings_in(all, Experiment::separation), 7U * (2U + 2U));
  // Those of the paper's tables are among the distances, and there are two more.
  std::set<double> distances;
  for (const Measurement& measurement : all.all) distances.insert(measurement.separation.distance);
  EXPECT_EQ(distances, (std::set<double>{0.0, 1e-100, 1e-30, 1e-16, 1e-8, 1e-4, 1e-2, 1.0}));
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

// ---- Measuring a group --------------------------------------------------------------------------

std::uint64_t count(const TimeHistogram& times) {
  std::uint64_t sum = 0;
  for (const auto& [bin, queries] : times.bins) sum += queries;
  return sum;
}

bool truly_collides(const Query& query) { return query.at(1, 0, 2) < 0.0; }

Answer yes_at(double toi, double tolerance = Answer::none, std::uint32_t checks = 0) {
  return {.verdict = Verdict::yes, .checks = checks, .toi_lower = toi, .tolerance = tolerance};
}

/// Methods with their options.
class Field {
 public:
  void add(FunctionMethod::Function function, Promise promise, const std::string& name,
           const fast::MethodOptions& options = {}) {
    methods_.push_back(std::make_unique<FunctionMethod>(std::move(function), promise, name));
    settings_.push_back({methods_.back().get(), options});
  }

  [[nodiscard]] std::vector<Measurement> run(const data::QueryGroup& group,
                                             const MeasureOptions& options = {}) {
    return run(group, options, *fast::certified_method());
  }
  [[nodiscard]] std::vector<Measurement> run(const data::QueryGroup& group,
                                             const MeasureOptions& options,
                                             const fast::Method& reference) {
    judge::GroundTruthCache truths(group);
    return measure(group, truths, settings_, reference, options);
  }

 private:
  std::vector<std::unique_ptr<fast::Method>> methods_;
  std::vector<Setting> settings_;
};

TEST(Measure, CountsExactlyTheFaultsThatAMethodHas) {
  const data::QueryGroup group = tests::falling_group(200);
  Field field;
  field.add(tests::always_no, Promise::conservative, "no");
  field.add([](Kind, const Query&) { return yes_at(0.375, 0.25, 7); }, Promise::conservative,
            "early yes", {.tolerance = 0.125, .max_checks = 7});
  field.add(
      [](Kind, const Query& query) {
        return truly_collides(query) ? yes_at(0.75) : Answer{.verdict = Verdict::undecided};
      },
      Promise::none, "late");
  field.add([](Kind, const Query&) { return Answer{.verdict = Verdict::error}; }, Promise::none,
            "error");
  const std::vector<Measurement> all = field.run(group);
  ASSERT_EQ(all.size(), 4U);
  for (const Measurement& measurement : all) {
    EXPECT_EQ(measurement.group, "falling");
    EXPECT_EQ(measurement.kind, Kind::vertex_face);
    EXPECT_EQ(measurement.experiment, Experiment::field);
    EXPECT_EQ(measurement.group_queries, 200U);
    EXPECT_EQ(measurement.asked, 200U);
    EXPECT_EQ(count(measurement.collision_times), 20U);
    EXPECT_EQ(count(measurement.no_collision_times), 180U);
    EXPECT_EQ(measurement.repetitions, 5U);
    EXPECT_GT(measurement.nanoseconds, 0.0);
    EXPECT_GT(measurement.certified_nanoseconds, 0.0);
    EXPECT_TRUE(measurement.stages.empty());
  }
  EXPECT_EQ(all[1].max_checks, 7);
  EXPECT_EQ(all[1].tolerance, 0.125);
  EXPECT_FALSE(all[0].achieved_tolerance.has_value());
  EXPECT_EQ(all[1].achieved_tolerance, (Spread{.count = 200, .median = 0.25, .max = 0.25}));
  struct Row {
    std::string method;
    JudgedAnswers answers;
    std::uint64_t at_limit;  // with the undecided, which were given up
    bool keeps_promise;
  };
  const std::vector<Row> rows{{"no", {.false_negatives = 20}, 0, false},
                              {"early yes",
                               {.false_positives = 180,
                                .beyond_tolerance = 180,  // the misses end ½ above
                                .toi_error = Spread{.count = 20, .median = 0.125, .max = 0.125}},
                               200,
                               false},
                              {"late",  // it promised nothing
                               {.false_positives = 180,
                                .late_tois = 20,
                                .undecided = 180,
                                .toi_error = Spread{.count = 20, .median = 0.25, .max = 0.25}},
                               180,
                               true},
                              {"error", {.errors = 200}, 0, true}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    JudgedAnswers found = all[i], expected = rows[i].answers;
    found.nanoseconds = expected.nanoseconds = 0.0;  // no number equals NaN
    expected.collisions = 20;
    EXPECT_EQ(all[i].method, rows[i].method);
    EXPECT_EQ(found, expected) << rows[i].method;
    EXPECT_EQ(all[i].at_limit, rows[i].at_limit) << rows[i].method;
    EXPECT_EQ(all[i].keeps_promise, rows[i].keeps_promise) << rows[i].method;
  }
}

/// Slow methods get a smaller sample and their own reference; settings of a method may share the
/// smallest sample.
TEST(Measure, ASampleIsNoLargerThanTheTimeAllows) {
  const data::QueryGroup group = tests::falling_group(1000);
  Field field;
  field.add(tests::slow_no, Promise::none, "method", {.tolerance = 1e-8});
  field.add(tests::always_no, Promise::none, "method", {.tolerance = 1.0});
  field.add(tests::always_no, Promise::none, "other");
  for (const bool same_sample : {false, true}) {
    MeasureOptions options;
    options.seconds = 0.05;
    options.same_sample = same_sample;
    const std::vector<Measurement> all = field.run(group, options);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_GE(all[0].asked, 16U);
    EXPECT_LE(all[0].asked, 64U) << "a millisecond each";
    EXPECT_LT(all[0].repetitions, 5U);
    EXPECT_GE(all[0].repetitions, 1U);
    EXPECT_EQ(all[1].asked, same_sample ? all[0].asked : 1000U);
    EXPECT_EQ(all[1].collisions == all[0].collisions, same_sample);
    EXPECT_EQ(count(all[1].collision_times) + count(all[1].no_collision_times), all[1].asked);
    EXPECT_EQ(all[2].asked, 1000U);
  }
}

}  // namespace
}  // namespace touchstone::verify::report::experiments_test
