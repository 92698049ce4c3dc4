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
    EXPECT_EQ(measurement.collisions, 20U);
    EXPECT_EQ(count(measurement.collision_times), 20U);
    EXPECT_EQ(count(measurement.no_collision_times), 180U);
    EXPECT_EQ(measurement.repetitions, 5U);
    EXPECT_GT(measurement.nanoseconds, 0.0);
    EXPECT_GT(measurement.certified_nanoseconds, 0.0);
    EXPECT_TRUE(measurement.stages.empty());
  }
  const Measurement& no = all[0];
  EXPECT_EQ(no.method, "no");
  EXPECT_EQ(no.promise, Promise::conservative);
  EXPECT_EQ(no.false_negatives, 20U);
  EXPECT_EQ(no.false_positives, 0U);
  EXPECT_EQ(no.at_limit, 0U);
  EXPECT_FALSE(no.keeps_promise);
  EXPECT_FALSE(no.toi_error.has_value());
  EXPECT_FALSE(no.achieved_tolerance.has_value());
  const Measurement& early = all[1];
  EXPECT_EQ(early.false_negatives, 0U);
  EXPECT_EQ(early.false_positives, 180U);
  EXPECT_EQ(early.late_tois, 0U);
  EXPECT_EQ(early.at_limit, 200U);
  EXPECT_EQ(early.max_checks, 7);
  EXPECT_EQ(early.tolerance, 0.125);
  EXPECT_EQ(early.beyond_tolerance, 180U) << "the misses end ½ above";
  EXPECT_FALSE(early.keeps_promise);
  EXPECT_EQ(early.toi_error, (Spread{.count = 20, .median = 0.125, .max = 0.125}));
  EXPECT_EQ(early.achieved_tolerance, (Spread{.count = 200, .median = 0.25, .max = 0.25}));
  const Measurement& late = all[2];
  EXPECT_EQ(late.late_tois, 20U);
  EXPECT_EQ(late.undecided, 180U);
  EXPECT_EQ(late.false_positives, 180U);
  EXPECT_EQ(late.at_limit, 180U) << "an undecided query was given up";
  EXPECT_EQ(late.toi_error, (Spread{.count = 20, .median = 0.25, .max = 0.25}));
  EXPECT_TRUE(late.keeps_promise) << "it promised nothing";
  EXPECT_EQ(all[3].errors, 200U);
  EXPECT_EQ(all[3].false_negatives, 0U);
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
