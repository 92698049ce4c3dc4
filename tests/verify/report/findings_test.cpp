#include "verify/report/findings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::findings_test {
namespace {

using Findings = std::vector<std::string>;

Findings findings(const Measurements& measurements) {
  return findings_of(measurements, figures_of(measurements));
}

TEST(Findings, SayWhatTheMeasurementsSay) {
  EXPECT_EQ(
      findings(tests::small_report()),
      (Findings{
          "Every method kept its promise.",
          "3 methods were asked up to 100 queries, 20 of which collide.",
          "No missed collision and no time of impact after the exact one: certified, "
          "tight_inclusion. Some: msrf (2 of 100).",
          "Right on every query, with no false positive either: certified.",
          "certified takes 10 ns a query. As a multiple of that, the others that miss nothing: "
          "tight_inclusion 250.",
          "On the Pareto front of time against error, among those that miss nothing: certified "
          "in 3 of 3 panels."}));
}

TEST(Findings, SumOverGroups) {
  Measurements measurements;
  measurements.all = {tests::measured("a", "certified", 10.0), tests::measured("a", "msrf", 30.0),
                      tests::measured("b", "certified", 20.0), tests::measured("b", "msrf", 40.0)};
  measurements.all[3].late_tois = 1;
  measurements.all[3].keeps_promise = false;
  measurements.all[3].late.add({.step = 0.25, .ulps = 7.0});
  measurements.all[3].outside = 3;
  measurements.all[2].asked = 50;
  const Findings said = findings(measurements);
  ASSERT_EQ(said.size(), 7U);
  EXPECT_EQ(said[0], "Broke its promise: msrf (1 late times, at most by 0.25 of the step).");
  EXPECT_EQ(said[1], "2 methods were asked up to 200 queries, 40 of which collide.");
  EXPECT_TRUE(said[2].ends_with("Some: msrf (1 of 200).")) << said[2];
  EXPECT_EQ(
      said[4],
      "certified takes 10 to 20 ns a query. As a multiple of that, the others that miss nothing: "
      "none.");
  EXPECT_EQ(said[6], "Not asked: msrf (3 queries outside its promise, 0 for lack of time).");
}

TEST(Findings, WithoutTheFieldAreThePromisesAlone) {
  Measurements measurements;
  EXPECT_EQ(findings(measurements), Findings{});
  measurements.all = {tests::measured_in(Experiment::tolerance, "tight_inclusion", 1.0)};
  EXPECT_EQ(findings(measurements), Findings{"Every method kept its promise."});
}

}  // namespace
}  // namespace touchstone::verify::report::findings_test
