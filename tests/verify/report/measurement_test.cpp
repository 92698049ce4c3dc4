#include "verify/report/measurement.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace touchstone::verify::report::measurement_test {
namespace {

TEST(Measurement, ExperimentsHaveNames) {
  for (const Experiment experiment :
       {Experiment::field, Experiment::separation, Experiment::tolerance, Experiment::checks,
        Experiment::filter}) {
    EXPECT_EQ(experiment_from_string(to_string(experiment)), experiment);
  }
  EXPECT_EQ(to_string(Experiment::checks), "checks");
  EXPECT_THROW(static_cast<void>(experiment_from_string("guess")), std::invalid_argument);
}

TEST(Measurement, RatesAreOfTheQueriesThatTheyCanHappenTo) {
  Measurement measurement;
  EXPECT_EQ(false_positive_rate(measurement), 0.0);
  EXPECT_EQ(false_negative_rate(measurement), 0.0);
  measurement.asked = 10;
  measurement.collisions = 2;
  measurement.false_positives = 4;
  measurement.false_negatives = 1;
  EXPECT_EQ(false_positive_rate(measurement), 0.5);
  EXPECT_EQ(false_negative_rate(measurement), 0.5);
}

TEST(TimeHistogram, BinsAreEighthsOfADecade) {
  TimeHistogram times;
  for (const double nanoseconds : {0.0, 1.0, 1.3, 1.4, 10.0, 1000.0, 1001.0}) {
    times.add(nanoseconds);
  }
  const TimeHistogram expected{.bins = {{0, 3}, {1, 1}, {8, 1}, {24, 2}}};
  EXPECT_EQ(times, expected);
  EXPECT_EQ(times.count(), 7U);
  EXPECT_EQ(TimeHistogram::lower_end(0), 1.0);
  EXPECT_DOUBLE_EQ(TimeHistogram::lower_end(24), 1000.0);
}

TEST(Measurements, AreChosenByExperimentInTheirOrder) {
  Measurements measurements;
  measurements.all.resize(3);
  measurements.all[1].experiment = Experiment::tolerance;
  measurements.all[2].method = "last";
  const auto field = of_experiment(measurements, Experiment::field);
  ASSERT_EQ(field.size(), 2U);
  EXPECT_EQ(field[1]->method, "last");
  EXPECT_EQ(of_experiment(measurements, Experiment::tolerance).size(), 1U);
  EXPECT_TRUE(of_experiment(measurements, Experiment::checks).empty());
}

TEST(Measurements, SayWhereAndWhenTheyWereMade) {
  Measurements measurements;
  EXPECT_EQ(origin_text(measurements), "");
  measurements.machine = "a processor";
  EXPECT_EQ(origin_text(measurements), " on a processor");
  measurements.date = "2026-01-31";
  EXPECT_EQ(origin_text(measurements), " on a processor, 2026-01-31");
}

TEST(Measurements, HaveWrongAnswersIfOnePromiseIsBroken) {
  Measurements measurements;
  measurements.all.resize(2);
  EXPECT_FALSE(has_wrong_answers(measurements));
  measurements.all[1].keeps_promise = false;
  EXPECT_TRUE(has_wrong_answers(measurements));
}

}  // namespace
}  // namespace touchstone::verify::report::measurement_test
