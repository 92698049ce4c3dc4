#include "verify/solvers/process_contender.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/run/bench.hpp"

// A program of its own: it makes processes, which copy no threads.

namespace touchstone::verify::process_contender_test {
namespace {

using fast::Answer;
using fast::Verdict;
using tests::FunctionMethod;

constexpr auto vf = Kind::vertex_face;

/// Vertices that fall onto a triangle, each from a height of its own.
std::vector<Query> falling(std::size_t count) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) {
    queries.push_back(tests::over_triangle(1, 1, 1.0 + static_cast<double>(i), -1).query);
  }
  return queries;
}

double height(const Query& query) { return query.at(0, 0, 2); }

TEST(ProcessContender, AnswersAsTheMethodInAnotherProcess) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    Answer answer = tests::true_answer(kind, query);
    answer.tolerance = static_cast<double>(::getpid());
    return answer;
  });
  ProcessContender contender(method, {}, {});
  EXPECT_EQ(contender.name(), method.name());
  for (const std::size_t count : {5U, 3U, 0U}) {
    const std::vector<Query> queries = falling(count);
    contender.solve(vf, queries);
    ASSERT_TRUE(contender.nanoseconds_elsewhere().has_value());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(contender.answer(i).toi_lower, tests::true_answer(vf, queries[i]).toi_lower);
      EXPECT_NE(contender.answer(i).tolerance, static_cast<double>(::getpid()));
      EXPECT_EQ(contender.failure(i), nullptr);
    }
  }
}

TEST(ProcessContender, AsksNoQueryAgainThatEndedItsProcess) {
  // A file remembers the processes that ended.
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "log").string();
  const FunctionMethod method([&log](Kind kind, const Query& query) {
    if (height(query) == 3.0) {
      std::ofstream(log, std::ios::app) << "x";
      std::raise(SIGKILL);
    }
    if (height(query) == 5.0) throw std::runtime_error("thrown");
    return tests::true_answer(kind, query);
  });
  ProcessContender contender(method, {}, {});
  const std::vector<Query> queries = falling(8);
  for (int round = 0; round < 3; ++round) {
    contender.solve(vf, queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      SCOPED_TRACE(i);
      const bool fails = i == 2 || i == 4;
      EXPECT_EQ(contender.answer(i).verdict, fails ? Verdict::error : Verdict::yes);
      ASSERT_EQ(contender.failure(i) != nullptr, fails);
    }
    EXPECT_EQ(to_text(*contender.failure(2)), "crash: SIGKILL");
    EXPECT_EQ(to_text(*contender.failure(4)), "exception: thrown");
  }
  const auto ends = std::filesystem::file_size(log);
  contender.solve(vf, queries);
  EXPECT_EQ(std::filesystem::file_size(log), ends);
}

/// The whole benchmark survives it.
TEST(ProcessContender, ACrashInABenchmarkCostsAQuery) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    if (height(query) == 3.0) std::raise(SIGSEGV);
    return tests::true_answer(kind, query);
  });
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(
      std::make_unique<ProcessContender>(method, fast::MethodOptions{}, SolverProcessOptions{}));
  BenchOptions options;
  options.repetitions = 2;
  const BenchResult result = bench(QueryGroup("falling", vf, falling(8)), contenders, options);
  const ContenderResult& said = result.contenders.at(0);
  EXPECT_EQ(said.queries, 8U);
  EXPECT_EQ(said.judgement.count(FailureKind::crash), 1U);
  EXPECT_EQ(said.judgement.count(Fault::error), 1U);
  ASSERT_EQ(said.judgement.wrong_answers.size(), 1U);
  EXPECT_EQ(said.judgement.wrong_answers[0].answer, "crash: SIGSEGV");
  EXPECT_GT(said.times.median(), 0.0);
  EXPECT_TRUE(said.singles.has_value());
}

}  // namespace
}  // namespace touchstone::verify::process_contender_test
