#include "verify/report/bench_report.hpp"

#include <gtest/gtest.h>

#include <string>

// What no run shows; the rest is in tests/transcripts/bench.md.

namespace touchstone::verify::report::bench_report_test {
namespace {

TEST(BenchReport, AnImpactThatContradictsTheCollisionsIsWrong) {
  BenchReport report;
  report.step.emplace().earliest.emplace();
  EXPECT_FALSE(has_wrong_answers(report));
  report.step->earliest_agrees = false;
  EXPECT_TRUE(has_wrong_answers(report));
  EXPECT_NE(to_text(report).find("NOT that of the collisions"), std::string::npos);
}

}  // namespace
}  // namespace touchstone::verify::report::bench_report_test
