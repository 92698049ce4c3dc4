#include "verify/fuzz/finding_page.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "tests/support/queries.hpp"
#include "verify/fuzz/fuzz_report.hpp"

// The transcript tests/transcripts/fuzz.md compiles the programs, and runs those of plugins.

namespace touchstone::verify::fuzz::finding_page_test {
namespace {

/// A vertex that falls through a triangle, with contact at t = 1/3.
Finding fall(const std::string& method = "mine") {
  Finding finding;
  finding.method = method;
  finding.simplest = {.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -2).query},
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true,
                      .toi = {{0.33333333333333331, 0.33333333333333337}}};
  finding.original = finding.simplest;
  return finding;
}

/// All options of the call differ.
nlohmann::json json_of(const Finding& finding, const fast::Terms& terms = {}) {
  FuzzReport report;
  report.solver = {.method = finding.method,
                   .terms = terms,
                   .options = {.tolerance = 0.125,
                               .max_checks = 77,
                               .separation = {.distance = 0.25, .norm = Norm::l2}}};
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
  const fast::Terms usual, estimates{.times = fast::Times::estimates, .time_error = 1e-6};
  const std::string no = "answer.verdict == 0", yes = "answer.verdict == 1";
  for (const auto& [what, terms, condition] :
       {std::tuple(false_negative, usual, no),
        {asymmetry, usual, no},
        {false_positive, usual, yes},
        {beyond_tolerance, usual, yes},
        {late_toi, usual, yes + " && answer.toi_lower > 0.3333333333333333"},
        {late_toi, estimates, yes + " && answer.toi_lower - 1e-06 > 0.3333333333333333"},
        {early_toi_upper, usual, yes + " && answer.toi_upper < 0.33333333333333337"},
        {early_toi_upper, estimates, yes + " && answer.toi_lower + 1e-06 < 0.33333333333333337"},
        {no_verdict, usual, "answer.verdict == 3"},
        {undecided, usual, "answer.verdict == 2"},
        {crash, usual, "false"}}) {
    Finding finding = fall();
    finding.what = what;
    expect_part(json_of(finding, terms), "const bool is_wrong = " + condition + ";");
  }
}

TEST(Program, CallsTheInterfaceOfTheSolver) {
  expect_part(json_of(fall("rp")), "const Options options{0.125, 77, 0.25, 1, 1};");
  expect_part(json_of(fall("tight_inclusion_released")),
              "ticcd::vertexFaceCCD(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7),\n"
              "                              ticcd::Array3(-1, -1, -1), 0.25, toi, 0.125, 1,\n"
              "                              77, tolerance);");
  expect_part(json_of(fall("accd")),
              "ipc::AdditiveCCD(77).point_triangle_ccd(\n"
              "      p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), toi, 0.25, 1);");
  expect_part(json_of(fall("rp")), "ipc::AdditiveCCD", "ipc-toolkit");
  // Only plugins know curves.
  const QueryShape shape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true};
  Finding finding = fall();
  finding.original.query = {shape, std::vector<double>(shape.numbers_of_query(), 1.5)};
  finding.simplest.query = finding.original.query;
  expect_part(json_of(finding), "kind = 1, degree = 2, is_rational = 1;", "ticcd");
  expect_part(json_of(finding), "      {1.5, 1.5, 1.5, 1.5},  // eb1\n");
}

/// A finding against the judge, while another solver was asked.
TEST(FindingJson, NamesTheSolverThatIsWrong) {
  FuzzReport report;
  report.solver = {.method = "mine", .plugin = "/tmp/mine.so"};
  report.result.findings = {fall("certified")};
  const nlohmann::json json = to_json(report).at("findings").at(0);
  EXPECT_EQ(json.at("solver").at("method"), "certified");
  EXPECT_EQ(json.at("solver").at("promise"), "exact");
  EXPECT_TRUE(json.at("solver").at("plugin").is_null());
}

}  // namespace
}  // namespace touchstone::verify::fuzz::finding_page_test
