#include "verify/report/results.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::results_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Results, HaveTheTablesWithThePublishedNumbers) {
  const std::string text = results_document(tests::small_report());
  EXPECT_TRUE(text.starts_with("# Results\n"));
  EXPECT_TRUE(
      contains(text, "## Table 1: all methods\n\n### handcrafted, vertex-face\n\n| method |"));
  EXPECT_TRUE(contains(text,
                       "| msrf | 2 | 1 (1.2 %) | 0.4 | 40 | 0 | 100 of 200 | 20 | 0 | – | – | "
                       "12.90 | 16 | 386 |\n"));
  EXPECT_TRUE(contains(text, "## Table 2: MSRF over the minimum separation d\n"));
  EXPECT_TRUE(contains(text, "| 1e-08 | msrf | L2 | 0 | 0 | 0.03 | 3 |"));
  EXPECT_FALSE(contains(text, "## Table 3"));
}

/// Names and commands may come from folders and from JSON of other authors.
TEST(Results, HoldNoMarkupOfNames) {
  Measurements measurements = tests::small_report();
  measurements.command = "touchstone report x\n```\n# forged";
  measurements.machine = "<script>";
  for (Measurement& measurement : measurements.all) measurement.group = "a\n# b <b>\u202e";
  const std::string text = results_document(measurements);
  EXPECT_TRUE(contains(text,
                       "Made on \\<script\\>, 2026-01-31 by\n\n```\n"
                       "touchstone report x\\x0a```\\x0a# forged\n```\n"))
      << text;
  EXPECT_TRUE(contains(text, "### a\\\\x0a# b \\<b\\>\\\\xe2\\\\x80\\\\xae, vertex-face\n"))
      << text;
  EXPECT_FALSE(contains(text, "<b>"));
  EXPECT_FALSE(contains(text, "\n# b"));
}

TEST(Results, SayInSentencesWhatTheDataSay) {
  const std::string text = results_document(tests::small_report());
  EXPECT_TRUE(contains(text,
                       "- **handcrafted, vertex-face**: with false negatives: `msrf`. Without "
                       "false positives: `certified`. Faster than `certified` on the same queries: "
                       "none.\n"))
      << text;
  EXPECT_TRUE(contains(text,
                       "On the Pareto front of time against false positives and of time "
                       "against the error of the time of impact, of those without a miss: "
                       "certified, in all 3 comparisons.\n"))
      << text;
}

TEST(Results, TellFrontsThatDifferApart) {
  Measurements measurements = tests::small_report();
  measurements.all[1].nanoseconds = 5.0;
  EXPECT_TRUE(contains(results_document(measurements),
                       ": tight_inclusion, certified, in all 3 comparisons.\n"));
  measurements.all[1].false_positives = 0;
  const std::string text = results_document(measurements);
  EXPECT_TRUE(contains(text, "\n- tight_inclusion: false positives (handcrafted, vertex-face)\n"))
      << text;
  EXPECT_TRUE(contains(text,
                       "\n- tight_inclusion, certified: error of the time of impact, median "
                       "(handcrafted, vertex-face); error of the time of impact, greatest "
                       "(handcrafted, vertex-face)\n"));
}

TEST(Results, ExplainTheMethodsThatWereMeasured) {
  const std::string text = results_document(tests::small_report());
  EXPECT_TRUE(contains(text, "\n- `msrf`: "));
  EXPECT_FALSE(contains(text, "\n- `bsc`: "));
}

TEST(Results, SayWhatTheFiltersMiss) {
  const std::string text = results_document(tests::small_report());
  EXPECT_TRUE(contains(text, "## What Tight-Inclusion misses with each filter\n"));
  EXPECT_TRUE(contains(text, "| 0.01 | vertex-face | 20 | 0 | 2 (10 %) |\n")) << text;
  EXPECT_TRUE(contains(text, "| a-family | vertex-face | 20 | 0 | 2 (10 %) |\n")) << text;
}

TEST(Results, NameTheCommandAndAnInterrupt) {
  Measurements measurements = tests::small_report();
  EXPECT_TRUE(contains(results_document(measurements),
                       "```\ntouchstone report handcrafted --out 'a <page>.html'\n```\n"));
  EXPECT_FALSE(contains(results_document(measurements), "Interrupted"));
  measurements.interrupted = true;
  EXPECT_TRUE(contains(results_document(measurements), "**Interrupted"));
}

TEST(Results, NameNoFolderOfAMachine) {
  Measurements measurements = tests::small_report();
  measurements.command =
      "touchstone report /data/sets/handcrafted '/my data/simulation/' --json=/tmp/a.json "
      "--out '/my data/a <page>.html' out/b.json ../c/d 'e f/g' / --markdown docs/results.md";
  EXPECT_TRUE(contains(results_document(measurements),
                       "```\ntouchstone report handcrafted 'simulation' --json=a.json "
                       "--out 'a <page>.html' out/b.json ../c/d 'e f/g' / "
                       "--markdown docs/results.md\n```\n"))
      << results_document(measurements);
}

}  // namespace
}  // namespace touchstone::verify::report::results_test
