#include "verify/report/measure.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "tests/support/methods.hpp"
#include "tests/support/query_groups.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::verify::report::measure_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;

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
    EXPECT_GE(all[0].nanoseconds, 1e6);
    EXPECT_LT(all[0].nanoseconds, 1e7);
    EXPECT_LT(all[0].certified_nanoseconds, 1e5);
    EXPECT_EQ(all[1].asked, same_sample ? all[0].asked : 1000U);
    EXPECT_EQ(all[1].collisions == all[0].collisions, same_sample);
    EXPECT_EQ(count(all[1].collision_times) + count(all[1].no_collision_times), all[1].asked);
    EXPECT_EQ(all[2].asked, 1000U);
  }
}

TEST(Measure, TheTruthIsAboutTheSeparation) {
  const data::QueryGroup group = tests::falling_group(10);
  Field field;
  field.add(tests::true_answer, Promise::none, "contact only",
            {.separation = {.distance = 0.5, .norm = Norm::l2}});
  field.add(tests::true_answer, Promise::none, "contact");
  const std::vector<Measurement> all = field.run(group);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].collisions, 10U);
  EXPECT_EQ(all[0].false_negatives, 9U);
  EXPECT_EQ(all[0].separation, (Separation{.distance = 0.5, .norm = Norm::l2}));
  EXPECT_EQ(all[1].collisions, 1U);
  EXPECT_EQ(all[1].false_negatives, 0U);
}

TEST(Measure, StoppedBetweenRepetitionsItKeepsThoseThatAreDone) {
  const data::QueryGroup group = tests::falling_group(10);
  Field field;
  field.add(tests::true_answer, Promise::exact, "truth");
  std::atomic<bool> stop = false;
  MeasureOptions options;
  options.stop = &stop;
  options.on_progress = [&](double fraction) { stop = fraction > 0.5; };
  const std::vector<Measurement> all = field.run(group, options);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].repetitions, 1U);
  EXPECT_EQ(all[0].collisions, 1U);
}

}  // namespace
}  // namespace touchstone::verify::report::measure_test
