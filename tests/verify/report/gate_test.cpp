#include "verify/report/certify_report.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/report/bench_report.hpp"

namespace touchstone::verify::report::gate_test {
namespace {

using judge::Fault;

/// The result of a file of ten queries, in which a solver has these faults.
jobs::CertifyResult result_of(const std::string& file, const std::string& solver,
                              fast::Promise promise,
                              const std::vector<std::pair<std::uint64_t, Fault>>& faults) {
  jobs::MethodResult method;
  method.name = solver;
  method.promise = promise;
  for (const auto& [index, fault] : faults) {
    ++method.judgement.faults[static_cast<std::size_t>(fault)];
    method.judgement.wrong_answers.push_back(
        {.fault = fault, .index = index, .answer = "", .truth = ""});
  }
  jobs::CertifyResult result;
  result.name = file;
  result.shape = QueryShape{.kind = Kind::edge_edge};
  result.queries = 10;
  result.methods = {method};
  return result;
}

std::vector<jobs::CertifyResult> results_of(
    const std::vector<std::pair<std::uint64_t, Fault>>& faults) {
  return {result_of("a_ee.csv", "naive", fast::Promise::conservative, faults)};
}

TEST(Gate, ABaselineIsReadAsItIsWritten) {
  const KnownAnswers known{{"naïve \"1\"", "folder/a,b.csv", "vertex-face", 7, Fault::late_toi},
                           {"naive", "a_ee.csv", "edge-edge", 0, Fault::false_negative}};
  const tests::TemporaryFolder folder;
  EXPECT_EQ(read_baseline(folder.file("known.json", baseline_document(known))), known);
  const auto other =
      folder.file("other.json", R"({"known": [["naive", "a", "edge-edge", 1, "luck"]]})");
  EXPECT_THROW(static_cast<void>(read_baseline(other)), io::DatasetError);
}

// New answers and mended ones, and the badge, are in tests/transcripts/certify.md.
TEST(Gate, AnAnswerThatTheRunDidNotAskForStaysKnownAndAllowedOnesAreNone) {
  EXPECT_TRUE(wrong_answers_of(results_of({{3, Fault::false_positive}})).empty());
  const KnownAnswers before{{"naive", "a_ee.csv", "edge-edge", 10, Fault::crash},
                            {"naive", "b_ee.csv", "edge-edge", 1, Fault::crash},
                            {"other", "a_ee.csv", "edge-edge", 1, Fault::crash}};
  const auto change = change_of(before, results_of({}));
  EXPECT_EQ(change.now, before);
  EXPECT_TRUE(change.mended.empty());
}

TEST(Gate, MoreAnswersThanAreKeptAreAnError) {
  auto results = results_of({{1, Fault::false_negative}});
  results[0].methods[0].judgement.faults[0] = judge::Judgement::most_kept + 1;
  EXPECT_THROW(static_cast<void>(wrong_answers_of(results)), std::runtime_error);
}

// The rest of it is in tests/transcripts/bench.md.
TEST(BenchReport, AnImpactThatContradictsTheCollisionsIsWrong) {
  BenchReport report;
  report.step.emplace().earliest.emplace();
  EXPECT_FALSE(has_wrong_answers(report));
  report.step->earliest_agrees = false;
  EXPECT_TRUE(has_wrong_answers(report));
  EXPECT_NE(to_text(report).find("NOT that of the collisions"), std::string::npos);
}

}  // namespace
}  // namespace touchstone::verify::report::gate_test
