#include "verify/cli/solver_options.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/io/dataset_error.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::cli::solver_options_test {
namespace {

namespace fs = std::filesystem;

/// Parses words as the options of a solver.
SolverArguments parse(std::vector<std::string> words) {
  CLI::App app;
  SolverArguments arguments;
  std::vector<std::string> paths;
  app.add_option("PATH", paths);
  add_solver_options(app, arguments);
  std::ranges::reverse(words);
  app.parse(std::move(words));
  return arguments;
}

TEST(SolverOptions, EachTakesOneWordAndMayBeRepeated) {
  const SolverArguments arguments =
      parse({"--method", "a", "path", "--method", "b", "path", "--plugin", "l.so", "--query-limit",
             "0.5", "--tolerance", "1e-9", "--max-checks", "77"});
  EXPECT_EQ(arguments.methods, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(arguments.plugins, (std::vector<fs::path>{"l.so"}));
  EXPECT_EQ(arguments.query_limit, 0.5);
  EXPECT_EQ(arguments.options.tolerance, 1e-9);
  EXPECT_EQ(arguments.options.max_checks, 77);
  EXPECT_FALSE(arguments.empty());
  EXPECT_TRUE(parse({}).empty());
}

TEST(SolverOptions, NumbersOutOfRangeAreRefused) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--query-limit", "-1"},
                                                {"--query-limit", "nan"},
                                                {"--query-limit", "inf"},
                                                {"--tolerance", "0"},
                                                {"--tolerance", "-1e-6"},
                                                {"--tolerance", "nan"},
                                                {"--max-checks", "-1"},
                                                {"--max-checks", "1.5"}}) {
    EXPECT_THROW(static_cast<void>(parse(words)), CLI::ParseError)
        << ::testing::PrintToString(words);
  }
}

TEST(Solvers, AreThoseNamedInOrder) {
  SolverArguments arguments;
  for (const auto& method : solvers::methods()) arguments.methods.emplace_back(method->name());
  for (const double limit : {0.0, 1.0}) {
    arguments.query_limit = limit;
    Files files;
    const Solvers solvers(files, arguments);
    const auto all = solvers.all();
    ASSERT_EQ(all.size(), solvers::methods().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i]->name(), solvers::methods()[i]->name());
      EXPECT_EQ(all[i]->promise(), solvers::methods()[i]->promise());
    }
  }
  arguments.exact = true;
  Files files;
  const Solvers held(files, arguments);
  for (const solvers::Solver* solver : held.all()) {
    EXPECT_EQ(solver->promise(), fast::Promise::exact);
  }
}

TEST(Solvers, OfOneNameAreDistinguished) {
  const std::string name(solvers::methods().front()->name());
  SolverArguments arguments;
  arguments.methods = {name, name, name};
  Files files;
  const Solvers solvers(files, arguments);
  ASSERT_EQ(solvers.all().size(), 3U);
  EXPECT_EQ(solvers.all()[0]->name(), name);
  EXPECT_EQ(solvers.all()[1]->name(), name + " (2)");
  EXPECT_EQ(solvers.all()[2]->name(), name + " (3)");
}

TEST(Solvers, MayAllAnswerInThisProcessAndTheCertifiedOneWithAKernel) {
  SolverArguments arguments;
  arguments.methods = {"certified", "tight_inclusion"};
  arguments.query_limit = 1.0;
  const std::vector<Query> queries(1);
  std::vector<fast::Answer> answers(1);
  for (const fast::CertifiedKernel* kernel :
       {static_cast<const fast::CertifiedKernel*>(nullptr), fast::certified_kernels().front()}) {
    arguments.kernel = kernel;
    Files files;
    const Solvers solvers(files, arguments, MethodHost::this_process);
    for (const solvers::Solver* solver : solvers.all()) {
      const solvers::SolveReply reply = solver->solve({.queries = queries}, answers);
      EXPECT_FALSE(reply.time.has_value()) << "that of a child process";
      EXPECT_EQ(answers[0].verdict, fast::Verdict::yes);
    }
  }
}

/// Settles the arguments of a parsed command line.
SolverArguments settled(std::vector<std::string> words, bool built_in_set) {
  CLI::App app;
  SolverArguments arguments;
  add_solver_options(app, arguments);
  app.add_flag("--exact", arguments.exact);
  std::ranges::reverse(words);
  app.parse(std::move(words));
  settle_solver_options(app, built_in_set, arguments);
  return arguments;
}

TEST(SolverOptions, TheBuiltInSetHasFewerChecksByDefault) {
  const std::int64_t otherwise = fast::MethodOptions().max_checks;
  EXPECT_EQ(settled({}, true).options.max_checks, 100'000);
  EXPECT_EQ(settled({"--max-checks", std::to_string(otherwise)}, true).options.max_checks,
            otherwise);
  EXPECT_EQ(settled({"--method", "a"}, false).options.max_checks, otherwise);
}

TEST(SolverOptions, WithoutASolverAreRefused) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--exact"},
                                                {"--query-limit", "1"},
                                                {"--tolerance", "1e-6"},
                                                {"--max-checks", "5"}}) {
    EXPECT_THROW(static_cast<void>(settled(words, false)), std::invalid_argument) << words.front();
    EXPECT_NO_THROW(static_cast<void>(settled(words, true))) << words.front();
    std::vector<std::string> with_solver = words;
    with_solver.insert(with_solver.end(), {"--method", "a"});
    EXPECT_NO_THROW(static_cast<void>(settled(with_solver, false))) << words.front();
  }
}

TEST(Solvers, NoneIsNoSolver) {
  Files files;
  SolverArguments arguments;
  EXPECT_TRUE(Solvers(files, arguments).all().empty());
  arguments.methods = {"none"};
  EXPECT_FALSE(arguments.empty());
  EXPECT_TRUE(Solvers(files, arguments).all().empty());
}

TEST(Solvers, WhatIsNotThereIsAnError) {
  Files files;
  SolverArguments unknown, both, plugin, results;
  unknown.methods = {"nonsense"};
  EXPECT_THROW(Solvers(files, unknown), std::invalid_argument);
  both.methods = {"none", "nonsense"};
  EXPECT_THROW(Solvers(files, both), std::invalid_argument);
  plugin.plugins = {"missing.so"};
  EXPECT_THROW(Solvers(files, plugin), io::DatasetError);
  results.results = {"missing.csv"};
  EXPECT_THROW(Solvers(files, results), io::DatasetError);
}

TEST(Solvers, AnswersNeverAskedForAreAWarning) {
  const fs::path path =
      fs::path(::testing::TempDir()) / ("touchstone_solvers_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path)
      << solvers::answers_header()
      << solvers::answer_row("a", 0, Kind::edge_edge, {.verdict = fast::Verdict::no})
      << solvers::answer_row("a", 1, Kind::edge_edge, {.verdict = fast::Verdict::no})
      << solvers::answer_row("b", 0, Kind::edge_edge, {.verdict = fast::Verdict::no});
  SolverArguments arguments;
  arguments.results = {path};
  Files files;
  const Solvers solvers(files, arguments);
  fs::remove(path);
  const std::vector<Query> queries(1);
  const std::string a = "a", b = "b";
  std::vector<fast::Answer> answers(1);
  const auto ask = [&](const std::string& source, std::uint64_t index) {
    const std::vector<std::uint64_t> indices{index};
    const solvers::SolveReply reply = solvers.all().front()->solve(
        {.kind = Kind::edge_edge, .queries = queries, .source = source, .indices = indices},
        answers);
    EXPECT_TRUE(reply.unasked.empty());
  };
  ask(a, 0);
  const std::vector<std::string> warnings = solvers.warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            path.string() + ":3: 2 answers refer to unknown queries (first: edge-edge of a)");
  ask(a, 1);
  ask(b, 0);
  EXPECT_TRUE(solvers.warnings().empty());
}

}  // namespace
}  // namespace touchstone::verify::cli::solver_options_test
