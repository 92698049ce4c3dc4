#include "verify/fuzz/reproduce.hpp"
#include "tests/support/built_files.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/solvers/registry.hpp"

// What the two golden files define.
namespace touchstone::reproduction_of_miss {
void expect_no_fault(const fast::Method& method);
}
namespace touchstone::reproduction_of_claim {
void expect_no_fault(const fast::Method& method);
}

namespace touchstone::verify::fuzz::reproduce_test {
namespace {

using fast::Answer;
using fast::Promise;
using tests::FunctionMethod;

/// A vertex that falls through a triangle: they touch at t = 1/3.
Reproduction miss() {
  return {.what = judge::Fault::false_negative,
          .kind = Kind::vertex_face,
          .failing = {.query = tests::over_triangle(1, 1, 1, -2).query,
                      .answer = {.verdict = fast::Verdict::no},
                      .collides = true},
          .solver = {.method = "tight_inclusion",
                     .options = {.tolerance = 0.125, .max_checks = 77},
                     .query_limit_seconds = 10.0}};
}

/// Two edges that come within 0.1 of each other, and are asked for 0.09.
Reproduction claim() {
  return {.what = judge::Fault::false_positive,
          .kind = Kind::edge_edge,
          .failing = {.query = tests::over_edge(1, 1, -1, -0.1).query,
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

TEST(AsPoints, names_the_points_of_the_kind) {
  Query query{};
  for (std::size_t i = 0; i < 24; ++i) query.coordinates[i] = static_cast<double>(i) / 4;
  const auto lines = lines_of(as_points(Kind::vertex_face, query));
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(lines[0], "v   at t=0  (0, 0.25, 0.5) = (0x0p+0, 0x1p-2, 0x1p-1)");
  EXPECT_EQ(lines[3], "f2  at t=0  (2.25, 2.5, 2.75) = (0x1.2p+1, 0x1.4p+1, 0x1.6p+1)");
  EXPECT_EQ(lines[5].substr(0, 10), "f0  at t=1");
  const auto of_edges = lines_of(as_points(Kind::edge_edge, query));
  EXPECT_EQ(of_edges[6], "eb0 at t=1  (4.5, 4.75, 5) = (0x1.2p+2, 0x1.3p+2, 0x1.4p+2)");
}

TEST(AsPoints, gives_the_very_doubles_twice) {
  tests::Random random(1);
  for (int i = 0; i < 50; ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.finite_double();
    const auto lines = lines_of(as_points(Kind::edge_edge, query));
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

// ---- As CSV -------------------------------------------------------------------------------------

TEST(AsCsv, reads_back_as_it_was) {
  const data::test::TemporaryFolder folder;
  tests::Random random(2);
  std::vector<Query> queries{tests::over_edge(1, 1, 1, -1).query};
  for (int i = 0; i < 30; ++i) {
    queries.push_back(tests::full_significand_query(random));
    for (double& x : queries.emplace_back().coordinates) x = random.finite_double();
  }
  std::string text;
  for (std::size_t i = 0; i < queries.size(); ++i) text += as_csv(queries[i], i % 2 == 0);
  data::CsvDataset source(folder.file("ee.csv", text), {.kind = Kind::edge_edge});
  const auto read = data::test::read_all(source);
  ASSERT_EQ(read.size(), queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(read[i].query, queries[i]);
    EXPECT_EQ(read[i].collides, i % 2 == 0);
  }
}

TEST(AsCsv, has_eight_rows_of_the_format) {
  const auto lines = lines_of(as_csv(tests::over_triangle(0.5, 1, 1, -2).query, true));
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(lines[0], "1,2,1,1,1,1,1");
  EXPECT_EQ(lines[4], "1,2,1,1,-2,1,1");
  EXPECT_EQ(lines_of(as_csv(miss().failing.query))[4], "1,1,1,1,-2,1");
  Query infinite{};
  infinite.coordinates[3] = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)as_csv(infinite), std::invalid_argument);
}

// ---- As a C++ test ------------------------------------------------------------------------------

std::string golden(const std::string& name) {
  return data::test::contents(tests::source_folder() + "/tests/verify/fuzz/" + name);
}

/// The text with a name for its fingerprint.
std::string called(std::string text, const std::string& name) {
  const std::string before = "touchstone::reproduction_";
  const std::string fingerprint = text.substr(text.find(before) + before.size(), 8);
  for (std::size_t place = text.find(fingerprint); place != std::string::npos;
       place = text.find(fingerprint, place)) {
    text.replace(place, fingerprint.size(), name);
  }
  return text;
}

TEST(AsCppTest, is_what_is_compiled_here) {
  EXPECT_EQ(called(as_cpp_test(miss()), "of_miss"), golden("reproduction_of_miss.cpp"));
  EXPECT_EQ(called(as_cpp_test(claim()), "of_claim"), golden("reproduction_of_claim.cpp"));
}

/// How many expectations fail for a method.
int failures(void (*expect_no_fault)(const fast::Method&), const fast::Method& method) {
  ::testing::TestPartResultArray results;
  {
    const ::testing::ScopedFakeTestPartResultReporter reporter(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    expect_no_fault(method);
  }
  return results.size();
}

/// A method that always gives this answer.
FunctionMethod always(const Answer& answer, Promise promise = Promise::conservative,
                      const std::string& name = "function") {
  return FunctionMethod([answer](Kind, const Query&) { return answer; }, promise, name);
}

constexpr Answer no{.verdict = fast::Verdict::no};
constexpr Answer yes{.verdict = fast::Verdict::yes};

Answer yes_between(double lower, double upper) {
  return {.verdict = fast::Verdict::yes, .toi_lower = lower, .toi_upper = upper};
}

TEST(AsCppTest, passes_on_methods_that_are_right) {
  for (const auto& method : solvers::methods()) {
    if (method->info().is_baseline) continue;
    EXPECT_EQ(failures(reproduction_of_miss::expect_no_fault, *method), 0) << method->name();
    EXPECT_EQ(failures(reproduction_of_claim::expect_no_fault, *method), 0) << method->name();
  }
  EXPECT_EQ(failures(reproduction_of_miss::expect_no_fault, always(yes)), 0);
  EXPECT_EQ(failures(reproduction_of_miss::expect_no_fault, always(yes_between(0.333, 0.334))), 0);
  EXPECT_EQ(failures(reproduction_of_claim::expect_no_fault, always(no)), 0);
}

TEST(AsCppTest, fails_on_methods_that_are_wrong) {
  const auto of_miss = reproduction_of_miss::expect_no_fault;
  EXPECT_EQ(failures(of_miss, always(no)), 1);
  EXPECT_EQ(failures(of_miss, always(yes_between(0.34, 0.35))), 1);  // late
  EXPECT_EQ(failures(of_miss, always(yes_between(0.32, 0.33))), 1);  // over too early
  EXPECT_EQ(failures(of_miss, always({.verdict = fast::Verdict::error})), 1);
  const auto of_claim = reproduction_of_claim::expect_no_fault;
  // It is held to exactness, whatever it promises.
  EXPECT_EQ(failures(of_claim, always(yes, Promise::conservative)), 1);
  const Answer near{.verdict = fast::Verdict::yes, .tolerance = 1e-6};
  const Answer far{.verdict = fast::Verdict::yes, .tolerance = 1.0};
  const std::string bounded = "tight_inclusion";
  EXPECT_EQ(failures(of_claim, always(near, Promise::conservative, bounded)), 2);
  EXPECT_EQ(failures(of_claim, always(far, Promise::conservative, bounded)), 1);
}

/// The method is asked with what it was asked with, and wrong with that alone.
TEST(AsCppTest, asks_with_the_options) {
  class OnlyWithThese final : public fast::Method {
   public:
    [[nodiscard]] const fast::MethodInfo& info() const override {
      static const fast::MethodInfo info{.name = "only_with_these"};
      return info;
    }
    void solve(Kind, std::span<const Query>, std::span<Answer> answers,
               const fast::MethodOptions& options) const override {
      const bool wrong = options.tolerance == 0.125 && options.max_checks == 77 &&
                         options.separation.distance == 0.0 &&
                         options.separation.norm == Norm::linf && options.t_max == 1.0;
      answers[0].verdict = wrong ? fast::Verdict::no : fast::Verdict::yes;
    }
  };
  EXPECT_EQ(failures(reproduction_of_miss::expect_no_fault, OnlyWithThese()), 1);
}

TEST(AsCppTest, asks_for_the_numbers_that_were_missing_or_none) {
  const std::string lower = "EXPECT_TRUE(std::isfinite(answer.toi_lower))";
  const std::string upper = "EXPECT_TRUE(std::isfinite(answer.toi_upper))";
  const std::string tolerance = "EXPECT_FALSE(answer.tolerance < 0.0)";
  const auto has = [](const Reproduction& found, const std::string& part) {
    return as_cpp_test(found).find(part) != std::string::npos;
  };
  Reproduction found = miss();
  found.what = judge::Fault::not_finite;
  found.failing.answer = yes;
  EXPECT_FALSE(has(found, lower) || has(found, upper) || has(found, tolerance));
  found.missing.upper = true;
  EXPECT_TRUE(!has(found, lower) && has(found, upper) && !has(found, tolerance));
  found.missing = {};
  found.failing.answer.toi_lower = -std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(found, lower) && !has(found, upper) && !has(found, tolerance));
  found.failing.answer = {.verdict = fast::Verdict::yes, .tolerance = -1.0};
  EXPECT_TRUE(!has(found, lower) && !has(found, upper) && has(found, tolerance));
}

TEST(AsCppTest, loads_plugins_and_makes_names_of_any_text) {
  Reproduction found = miss();
  found.solver.method = "my \"solver\",\nversion 2";
  found.solver.plugin = "/tmp/a \"b\".so";
  found.solver.promise = Promise::exact;
  const std::string text = as_cpp_test(found);
  EXPECT_NE(text.find(R"(expect_no_fault(*verify::solvers::load_plugin("/tmp/a \"b\".so"));)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("promise = fast::Promise::exact;"), std::string::npos);
  EXPECT_NE(text.find("TEST(Reproduction, my_solver_version_2_false_negative_"), std::string::npos);
  EXPECT_NE(text.find("// my \"solver\",\\x0aversion 2: false_negative. The primitives collide.\n"),
            std::string::npos);
}

TEST(AsCppTest, warns_of_a_hang) {
  const std::string warning = "// Run it with a limit of time.\n";
  Reproduction found = miss();
  EXPECT_EQ(as_cpp_test(found).find(warning), std::string::npos);
  found.what = judge::Fault::hang;
  EXPECT_NE(as_cpp_test(found).find(warning), std::string::npos);
}

TEST(AsCppTest, tells_findings_apart) {
  const auto name_of = [](const Reproduction& found) {
    const std::string text = as_cpp_test(found);
    const std::size_t begin = text.find("TEST(");
    return text.substr(begin, text.find(')', begin) - begin);
  };
  Reproduction other = miss();
  EXPECT_EQ(name_of(other), name_of(miss()));
  other.failing.query.coordinates[7] = 5.0;
  EXPECT_NE(name_of(other), name_of(miss()));
  other = miss();
  other.solver.options.separation.distance = 1e-3;
  EXPECT_NE(name_of(other), name_of(miss()));
  other = miss();
  other.kind = Kind::edge_edge;
  EXPECT_NE(name_of(other), name_of(miss()));
}

// ---- As a command -------------------------------------------------------------------------------

TEST(AsCommand, names_all_that_the_solver_was_asked_with) {
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

/// A dataset's labels are about contact itself, unless more is said.
TEST(AsCommand, writes_no_label_with_a_separation) {
  const std::vector<std::string> lines = lines_of(as_command(claim()));
  EXPECT_EQ(lines[1], "0,1,0,1,0,1");
  EXPECT_TRUE(lines[10].ends_with("--min-separation 0.09 --norm l2 --query-limit 0 --exact"));
}

TEST(AsCommand, names_limits_that_are_not_the_defaults) {
  Reproduction found = miss();
  found.solver.limits = {.memory_bytes = std::uint64_t{1} << 29U, .may_fork = true};
  EXPECT_NE(as_command(found).find("--query-limit 10 --memory-limit 0.5 --allow-processes\n"),
            std::string::npos);
}

TEST(AsCommand, quotes_the_plugin_for_the_shell) {
  Reproduction found = miss();
  found.solver.plugin = "/tmp/it's $HOME.so";
  const std::string command = as_command(found);
  EXPECT_NE(command.find(R"(--plugin '/tmp/it'\''s $HOME.so' --tolerance)"), std::string::npos)
      << command;
}

// ---- Of a finding -------------------------------------------------------------------------------

TEST(ReproductionOf, is_about_the_simplest_query_and_who_is_wrong) {
  Finding finding;
  finding.method = "mine";
  finding.original.query = tests::over_triangle(1, 1, 1, -3).query;
  finding.simplest.query = tests::over_triangle(1, 1, 1, -2).query;
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
