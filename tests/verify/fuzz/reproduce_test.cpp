#include "verify/fuzz/reproduce.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/data/csv_dataset.hpp"

namespace touchstone::verify::fuzz::reproduce_test {
namespace {

using fast::Promise;

/// A vertex that falls through a triangle, with contact at t = 1/3.
Reproduction miss() {
  return {.what = judge::Fault::false_negative,
          .failing = {.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -2).query},
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true},
          .solver = {.method = "tight_inclusion",
                     .options = {.tolerance = 0.125, .max_checks = 77},
                     .query_limit_seconds = 10.0}};
}

/// Two edges that come within 0.1 of each other, with a tolerance of 0.09.
Reproduction claim() {
  return {.what = judge::Fault::false_positive,
          .failing = {.query = {Kind::edge_edge, tests::over_edge(1, 1, -1, -0.1).query},
                      .answer = {.verdict = fast::Verdict::yes}},
          .solver = {.method = "certified",
                     .promise = Promise::exact,
                     .options = {.separation = {.distance = 0.09, .norm = Norm::l2}}}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// ---- As points ----------------------------------------------------------------------------------

TEST(AsPoints, NamesThePointsOfTheKind) {
  Query query{};
  for (std::size_t i = 0; i < 24; ++i) query.coordinates[i] = static_cast<double>(i) / 4;
  const auto lines = lines_of(as_points({Kind::vertex_face, query}));
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(lines[0], "v   at t=0  (0, 0.25, 0.5) = (0x0p+0, 0x1p-2, 0x1p-1)");
  EXPECT_EQ(lines[3], "f2  at t=0  (2.25, 2.5, 2.75) = (0x1.2p+1, 0x1.4p+1, 0x1.6p+1)");
  EXPECT_EQ(lines[5].substr(0, 10), "f0  at t=1");
  const auto of_edges = lines_of(as_points({Kind::edge_edge, query}));
  EXPECT_EQ(of_edges[6], "eb0 at t=1  (4.5, 4.75, 5) = (0x1.2p+2, 0x1.3p+2, 0x1.4p+2)");
}

TEST(AsPoints, GivesTheExactDoublesTwice) {
  tests::Random random(1);
  for (int i = 0; i < 50; ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.finite_double();
    const auto lines = lines_of(as_points({Kind::edge_edge, query}));
    for (std::size_t row = 0; row < 8; ++row) {
      std::string numbers = lines[row].substr(lines[row].find('('));
      for (char& c : numbers) {
        if (c == '(' || c == ')' || c == ',' || c == '=') c = ' ';
      }
      const char* rest = numbers.c_str();
      for (const std::size_t axis : {0U, 1U, 2U, 0U, 1U, 2U}) {
        char* end = nullptr;
        EXPECT_EQ(std::strtod(rest, &end), query.coordinates[3 * row + axis]) << lines[row];
        rest = end;
      }
    }
  }
}

TEST(AsPoints, NamesControlPointsAndWeights) {
  const QueryShape shape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true};
  std::vector<double> numbers(shape.numbers_of_query());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i) / 4;
  const AnyQuery query(shape, numbers);
  const auto lines = lines_of(as_points(query));
  ASSERT_EQ(lines.size(), 12U);
  EXPECT_EQ(lines[0],
            "ea0 control point 0  (0, 0.25, 0.5; 0.75) = (0x0p+0, 0x1p-2, 0x1p-1; 0x1.8p-1)");
  EXPECT_TRUE(lines[11].starts_with("eb1 control point 2  (11, 11.25, 11.5; 11.75) = "));
  EXPECT_EQ(lines_of(as_short_points(query)).at(1),
            "ea1  (1, 1.25, 1.5; 1.75) → (5, 5.25, 5.5; 5.75) → (9, 9.25, 9.5; 9.75)");
}

// ---- As a command -------------------------------------------------------------------------------

TEST(AsCommand, NamesAllOptionsOfTheSolver) {
  const std::vector<std::string> lines = lines_of(as_command(miss()));
  ASSERT_EQ(lines.size(), 11U);
  const std::string file = lines[0].substr(6, lines[0].find(" <<") - 6);
  EXPECT_TRUE(file.ends_with("-vertex-face.csv")) << file;
  EXPECT_EQ(lines[0], "cat > " + file + " <<'END'");
  EXPECT_EQ(lines[1], "1,1,1,1,1,1,1");
  EXPECT_EQ(lines[9], "END");
  EXPECT_EQ(lines[10], "touchstone certify " + file +
                           " --method tight_inclusion --tolerance 0.125 --max-checks 77"
                           " --min-separation 0 --norm linf --query-limit 10");
}

/// A dataset's labels are about contact without separation.
TEST(AsCommand, WritesNoLabelWithASeparation) {
  const std::vector<std::string> lines = lines_of(as_command(claim()));
  EXPECT_EQ(lines[1], "0,1,0,1,0,1");
  EXPECT_TRUE(lines[10].ends_with("--min-separation 0.09 --norm l2 --query-limit 0 --exact"));
}

TEST(AsCommand, NamesLimitsThatAreNotTheDefaults) {
  Reproduction found = miss();
  found.solver.limits = {.memory_bytes = std::uint64_t{1} << 29U, .may_fork = true};
  EXPECT_NE(as_command(found).find("--query-limit 10 --memory-limit 0.5 --allow-processes\n"),
            std::string::npos);
}

TEST(AsCommand, QuotesThePluginForTheShell) {
  Reproduction found = miss();
  found.solver.plugin = "/tmp/it's $HOME.so";
  const std::string command = as_command(found);
  EXPECT_NE(command.find(R"(--plugin '/tmp/it'\''s $HOME.so' --tolerance)"), std::string::npos)
      << command;
}

/// Different findings have different files.
TEST(AsCommand, TellsFindingsApart) {
  const auto name_of = [](const Reproduction& found) { return lines_of(as_command(found)).at(0); };
  Reproduction other = miss();
  EXPECT_EQ(name_of(other), name_of(miss()));
  other.failing.query.numbers()[7] = 5.0;
  EXPECT_NE(name_of(other), name_of(miss()));
  other = miss();
  other.solver.options.separation.distance = 1e-3;
  EXPECT_NE(name_of(other), name_of(miss()));
  other = miss();
  other.failing.query = {Kind::edge_edge, miss().failing.query.straight()};
  EXPECT_NE(name_of(other), name_of(miss()));
}

// ---- Reproductions of findings ------------------------------------------------------------------

TEST(ReproductionOf, ShowsTheSimplestQueryAndTheSolver) {
  Finding finding;
  finding.method = "mine";
  finding.original.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -3).query};
  finding.simplest.query = {Kind::vertex_face, tests::over_triangle(1, 1, 1, -2).query};
  const SolverCall asked{.method = "mine", .plugin = "/tmp/mine.so", .options = {.max_checks = 5}};
  const Reproduction found = reproduction_of(finding, asked);
  EXPECT_EQ(found.failing.query, finding.simplest.query);
  EXPECT_EQ(found.solver.plugin, asked.plugin);
  EXPECT_EQ(found.solver.options.max_checks, 5);
  finding.method = "certified";
  const Reproduction of_judge = reproduction_of(finding, asked);
  EXPECT_EQ(of_judge.solver.method, "certified");
  EXPECT_TRUE(of_judge.solver.plugin.empty());
  EXPECT_EQ(of_judge.solver.promise, Promise::exact);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::reproduce_test
