#include "verify/fuzz/finding_page.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/queries.hpp"
#include "verify/fuzz/fuzz_report.hpp"

// The transcript tests/transcripts/fuzz.md compiles the programs, and runs those of plugins.

namespace touchstone::verify::fuzz::finding_page_test {
namespace {

/// A vertex that falls through a triangle, with contact at t = 1/3.
Finding fall() {
  Finding finding;
  finding.method = "mine";
  finding.simplest = {.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -2).query},
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true,
                      .toi = {{0.33333333333333331, 0.33333333333333337}}};
  finding.original = finding.simplest;
  return finding;
}

/// All options of the call differ.
SolverCall call(const std::string& method = "mine") {
  return {.method = method,
          .options = {.tolerance = 0.125,
                      .max_checks = 77,
                      .separation = {.distance = 0.25, .norm = Norm::l2}}};
}

nlohmann::json json_of(const Finding& finding, const SolverCall& solver) {
  FuzzReport report;
  report.solver = solver;
  report.result.findings = {finding};
  return to_json(report).at("findings").at(0);
}

void expect_part(const nlohmann::json& finding, const std::string& part,
                 const std::string& calls = "") {
  const std::string program = as_program(finding, calls);
  EXPECT_NE(program.find(part), std::string::npos) << part << '\n' << program;
}

TEST(Program, EndsWithOneForTheFinding) {
  using enum judge::Fault;
  const auto expect_wrong_if = [](judge::Fault what, const std::string& condition,
                                  const fast::Terms& terms = {}) {
    Finding finding = fall();
    finding.what = what;
    SolverCall solver = call();
    solver.terms = terms;
    expect_part(json_of(finding, solver), "const bool is_wrong = " + condition + ";");
  };
  const fast::Terms estimates{.times = fast::Times::estimates, .time_error = 1e-6};
  const std::string yes = "answer.verdict == 1";
  expect_wrong_if(false_negative, "answer.verdict == 0");
  expect_wrong_if(asymmetry, "answer.verdict == 0");
  expect_wrong_if(false_positive, yes);
  expect_wrong_if(beyond_tolerance, yes);
  expect_wrong_if(late_toi, yes + " && answer.toi_lower > 0.3333333333333333");
  expect_wrong_if(late_toi, yes + " && answer.toi_lower - 1e-06 > 0.3333333333333333", estimates);
  expect_wrong_if(early_toi_upper, yes + " && answer.toi_upper < 0.33333333333333337");
  expect_wrong_if(early_toi_upper, yes + " && answer.toi_lower + 1e-06 < 0.33333333333333337",
                  estimates);
  expect_wrong_if(no_verdict, "answer.verdict == 3");
  expect_wrong_if(undecided, "answer.verdict == 2");
  expect_wrong_if(crash, "false");
}

TEST(Program, CallsTheInterfaceOfTheSolver) {
  const auto of = [](const std::string& method) {
    Finding finding = fall();
    finding.method = method;
    return json_of(finding, call(method));
  };
  expect_part(of("rp"), "const Options options{0.125, 77, 0.25, 1, 1};");
  expect_part(of("tight_inclusion_released"),
              "ticcd::vertexFaceCCD(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7),\n"
              "                              ticcd::Array3(-1, -1, -1), 0.25, toi, 0.125, 1,\n"
              "                              77, tolerance);");
  expect_part(of("accd"),
              "ipc::AdditiveCCD(77).point_triangle_ccd(\n"
              "      p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), toi, 0.25, 1);");
  expect_part(of("rp"), "ipc::AdditiveCCD", "ipc-toolkit");
  // Only plugins know curves.
  const QueryShape shape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true};
  Finding finding = fall();
  finding.original.query = {shape, std::vector<double>(shape.numbers_of_query(), 1.5)};
  finding.simplest.query = finding.original.query;
  expect_part(json_of(finding, call()), "kind = 1, degree = 2, is_rational = 1;", "ticcd");
  expect_part(json_of(finding, call()), "      {1.5, 1.5, 1.5, 1.5},  // eb1\n");
}

/// A finding against the judge, while another solver was asked.
TEST(FindingJson, NamesTheSolverThatIsWrong) {
  Finding finding = fall();
  finding.method = "certified";
  SolverCall asked = call();
  asked.plugin = "/tmp/mine.so";
  const nlohmann::json json = json_of(finding, asked);
  EXPECT_EQ(json.at("solver").at("method"), "certified");
  EXPECT_EQ(json.at("solver").at("promise"), "exact");
  EXPECT_TRUE(json.at("solver").at("plugin").is_null());
}

}  // namespace
}  // namespace touchstone::verify::fuzz::finding_page_test
