#include "verify/cli/respondents.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/data/dataset_error.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::cli::respondents_test {
namespace {

namespace fs = std::filesystem;

/// Parses words as the options of a solver.
RespondentArguments parse(std::vector<std::string> words) {
  CLI::App app;
  RespondentArguments arguments;
  std::vector<std::string> paths;
  app.add_option("PATH", paths);
  add_solver_options(app, arguments);
  std::ranges::reverse(words);
  app.parse(std::move(words));
  return arguments;
}

TEST(RespondentOptions, EachTakesOneWordAndMayBeRepeated) {
  const RespondentArguments arguments =
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

TEST(RespondentOptions, NumbersOutOfRangeAreRefused) {
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

TEST(Respondents, AreThoseNamedInOrder) {
  RespondentArguments arguments;
  for (const auto& method : methods()) arguments.methods.emplace_back(method->name());
  for (const double limit : {0.0, 1.0}) {
    arguments.query_limit = limit;
    const Respondents respondents(arguments);
    const auto all = respondents.all();
    ASSERT_EQ(all.size(), methods().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i]->name(), methods()[i]->name());
      EXPECT_EQ(all[i]->promise(), methods()[i]->promise());
    }
  }
  arguments.exact = true;
  const Respondents held(arguments);
  for (const Respondent* respondent : held.all()) {
    EXPECT_EQ(respondent->promise(), fast::Promise::exact);
  }
}

TEST(Respondents, OfOneNameAreToldApart) {
  const std::string name(methods().front()->name());
  RespondentArguments arguments;
  arguments.methods = {name, name, name};
  const Respondents respondents(arguments);
  ASSERT_EQ(respondents.all().size(), 3U);
  EXPECT_EQ(respondents.all()[0]->name(), name);
  EXPECT_EQ(respondents.all()[1]->name(), name + " (2)");
  EXPECT_EQ(respondents.all()[2]->name(), name + " (3)");
}

/// Settles the arguments of a parsed command line.
RespondentArguments settled(std::vector<std::string> words, bool built_in_set) {
  CLI::App app;
  RespondentArguments arguments;
  add_solver_options(app, arguments);
  app.add_flag("--exact", arguments.exact);
  std::ranges::reverse(words);
  app.parse(std::move(words));
  settle_solver_options(app, built_in_set, arguments);
  return arguments;
}

TEST(RespondentOptions, TheBuiltInSetHasFewerChecksUnlessToldOtherwise) {
  const std::int64_t otherwise = fast::MethodOptions().max_checks;
  EXPECT_EQ(settled({}, true).options.max_checks, 100'000);
  EXPECT_EQ(settled({"--max-checks", std::to_string(otherwise)}, true).options.max_checks,
            otherwise);
  EXPECT_EQ(settled({"--method", "a"}, false).options.max_checks, otherwise);
}

TEST(RespondentOptions, WithoutASolverAreRefused) {
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

TEST(Respondents, NoneIsNobody) {
  RespondentArguments arguments;
  EXPECT_TRUE(Respondents(arguments).all().empty());
  arguments.methods = {"none"};
  EXPECT_FALSE(arguments.empty());
  EXPECT_TRUE(Respondents(arguments).all().empty());
}

TEST(Respondents, WhatIsNotThereIsAnError) {
  RespondentArguments unknown, both, plugin, results;
  unknown.methods = {"nonsense"};
  EXPECT_THROW(Respondents{unknown}, std::invalid_argument);
  both.methods = {"none", "nonsense"};
  EXPECT_THROW(Respondents{both}, std::invalid_argument);
  plugin.plugins = {"missing.so"};
  EXPECT_THROW(Respondents{plugin}, DatasetError);
  results.results = {"missing.csv"};
  EXPECT_THROW(Respondents{results}, DatasetError);
}

TEST(Respondents, AnswersNeverAskedForAreAWarning) {
  const fs::path path = fs::path(::testing::TempDir()) /
                        ("touchstone_respondents_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path) << answers_header()
                      << answer_row("a", 0, Kind::edge_edge, {.verdict = fast::Verdict::no})
                      << answer_row("a", 1, Kind::edge_edge, {.verdict = fast::Verdict::no})
                      << answer_row("b", 0, Kind::edge_edge, {.verdict = fast::Verdict::no});
  RespondentArguments arguments;
  arguments.results = {path};
  const Respondents respondents(arguments);
  fs::remove(path);
  const std::vector<Query> queries(1);
  const std::string a = "a", b = "b";
  std::vector<fast::Answer> answers(1);
  const auto ask = [&](const std::string& source, std::uint64_t index) {
    const std::vector<std::uint64_t> indices{index};
    const Response response = respondents.all().front()->answer(
        {.source = source, .kind = Kind::edge_edge, .queries = queries, .indices = indices},
        answers);
    EXPECT_TRUE(response.missing.empty());
  };
  ask(a, 0);
  const std::vector<std::string> warnings = respondents.warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], path.string() +
                             ":3: 2 answers are to queries that were not there, first to "
                             "edge-edge of a");
  ask(a, 1);
  ask(b, 0);
  EXPECT_TRUE(respondents.warnings().empty());
}

}  // namespace
}  // namespace touchstone::verify::cli::respondents_test
