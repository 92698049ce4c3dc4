#include "verify/fuzz/examinee.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/methods.hpp"

namespace touchstone::verify {
namespace {

using fast::Answer;
using fast::Verdict;
using tests::FunctionMethod;
using namespace std::chrono_literals;

/// The first coordinate tells the method what to do.
constexpr double dies = -1.0, sleeps = -2.0, throws = -3.0;

/// Answers with the first coordinate as the time, unless that says otherwise.
Answer obey(Kind kind, const Query& query) {
  const double word = query.coordinates.front();
  if (word == dies) std::abort();
  if (word == sleeps) std::this_thread::sleep_for(1h);
  if (word == throws) throw std::runtime_error("thrown");
  return {.verdict = kind == Kind::vertex_face ? Verdict::yes : Verdict::no, .toi_lower = word};
}

std::vector<Query> numbered(std::size_t count) {
  std::vector<Query> queries(count);
  for (std::size_t i = 0; i < count; ++i) {
    queries[i].coordinates.front() = static_cast<double>(i);
  }
  return queries;
}

void expect_right(const std::vector<Answer>& answers, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    ASSERT_EQ(answers[i].verdict, Verdict::yes) << i;
    ASSERT_EQ(answers[i].toi_lower, static_cast<double>(i)) << i;
  }
}

TEST(Examinee, AnswersBlockAfterBlockOfAnySize) {
  const FunctionMethod method(obey);
  Examinee examinee(method);
  for (const std::size_t count : {0U, 1U, 700U, 9000U, 3U}) {
    const std::vector<Query> queries = numbered(count);
    std::vector<Answer> answers(count);
    const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers);
    EXPECT_EQ(sitting.answered, count);
    EXPECT_TRUE(sitting.incidents.empty());
    EXPECT_EQ(sitting.unplaced, 0U);
    expect_right(answers, 0, count);
    static_cast<void>(examinee.answer(Kind::edge_edge, queries, answers));
    for (const Answer& answer : answers) EXPECT_EQ(answer.verdict, Verdict::no);
  }
}

/// One process lives on: what the method remembers shows it.
TEST(Examinee, AsksOneProcessThatIsNotThisOne) {
  int calls = 0;
  const FunctionMethod method([&calls](Kind, const Query&) {
    ++calls;
    return Answer{.verdict = Verdict::yes,
                  .toi_lower = static_cast<double>(calls),
                  .tolerance = static_cast<double>(::getpid())};
  });
  Examinee examinee(method);
  std::vector<Answer> first(10), second(10);
  static_cast<void>(examinee.answer(Kind::vertex_face, numbered(10), first));
  static_cast<void>(examinee.answer(Kind::vertex_face, numbered(10), second));
  EXPECT_EQ(second.back().toi_lower, 20.0);
  EXPECT_EQ(first.front().tolerance, second.back().tolerance);
  EXPECT_NE(first.front().tolerance, static_cast<double>(::getpid()));
  EXPECT_EQ(calls, 0);
}

TEST(Examinee, FindsWhichQueryEndsTheProcess) {
  const FunctionMethod method(obey);
  for (const double word : {dies, throws}) {
    Examinee examinee(method);
    std::vector<Query> queries = numbered(1000);
    queries[0].coordinates.front() = word;
    queries[600].coordinates.front() = word;
    std::vector<Answer> answers(queries.size());
    const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers);
    EXPECT_EQ(sitting.answered, queries.size());
    ASSERT_EQ(sitting.incidents.size(), 2U);
    EXPECT_EQ(sitting.incidents[0].position, 0U);
    EXPECT_EQ(sitting.incidents[1].position, 600U);
    EXPECT_FALSE(sitting.incidents[0].hang || sitting.incidents[1].hang);
    EXPECT_EQ(sitting.unplaced, 0U);
    expect_right(answers, 1, 600);
    expect_right(answers, 601, 1000);
  }
}

TEST(Examinee, FindsWhichQueryTakesTooLong) {
  const FunctionMethod method(obey);
  Examinee examinee(method, {.query_limit_seconds = 0.2});
  std::vector<Query> queries = numbered(300);
  queries[200].coordinates.front() = sleeps;
  std::vector<Answer> answers(queries.size());
  const auto start = std::chrono::steady_clock::now();
  const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
  EXPECT_EQ(sitting.answered, queries.size());
  ASSERT_EQ(sitting.incidents.size(), 1U);
  EXPECT_EQ(sitting.incidents.front().position, 200U);
  EXPECT_TRUE(sitting.incidents.front().hang);
  expect_right(answers, 201, 300);
}

/// What dies only in company cannot be pinned on a query.
TEST(Examinee, CountsADeathThatNoQueryCausesAlone) {
  class Crowded final : public fast::Method {
   public:
    [[nodiscard]] std::string_view name() const override { return "crowded"; }
    [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }
    void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
               const fast::MethodOptions&) const override {
      if (queries.size() > 8) std::abort();
      for (std::size_t i = 0; i < queries.size(); ++i) answers[i] = obey(kind, queries[i]);
    }
  };
  const Crowded method;
  Examinee examinee(method);
  std::vector<Answer> answers(60);
  const Sitting sitting = examinee.answer(Kind::vertex_face, numbered(60), answers);
  EXPECT_EQ(sitting.answered, 60U);
  EXPECT_TRUE(sitting.incidents.empty());
  // Steps of 1, 2, 4, 8, 16, of which the last one dies; then of all that is left behind it.
  EXPECT_EQ(sitting.unplaced, 2U);
  expect_right(answers, 0, 60);
}

TEST(Examinee, LeavesTheRestAfterManyIncidents) {
  const FunctionMethod method(obey);
  Examinee examinee(method, {.most_incidents = 3});
  std::vector<Query> queries = numbered(50);
  for (Query& query : queries) query.coordinates.front() = dies;
  std::vector<Answer> answers(queries.size());
  const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers);
  EXPECT_EQ(sitting.answered, 3U);
  EXPECT_EQ(sitting.incidents.size(), 3U);
}

TEST(Examinee, StopsWhenTold) {
  const FunctionMethod method(obey);
  std::atomic<bool> stop = false;
  Examinee examinee(method, {.stop = &stop});
  std::vector<Query> queries = numbered(10);
  queries[5].coordinates.front() = sleeps;
  std::vector<Answer> answers(queries.size());
  std::thread interrupt([&stop] {
    std::this_thread::sleep_for(100ms);
    stop = true;
  });
  const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers);
  interrupt.join();
  EXPECT_LE(sitting.answered, 5U);
  EXPECT_TRUE(sitting.incidents.empty());
}

TEST(Examinee, StopsAtItsTime) {
  const FunctionMethod method(obey);
  Examinee examinee(method);
  std::vector<Query> queries = numbered(10);
  queries[5].coordinates.front() = sleeps;
  std::vector<Answer> answers(queries.size());
  const Sitting sitting = examinee.answer(Kind::vertex_face, queries, answers, 0.1);
  EXPECT_LE(sitting.answered, 5U);
  EXPECT_TRUE(sitting.incidents.empty());
  // The next call has all the time.
  EXPECT_EQ(examinee.answer(Kind::vertex_face, numbered(10), answers).answered, 10U);
}

TEST(Examinee, PassesTheOptionsOn) {
  class Echo final : public fast::Method {
   public:
    [[nodiscard]] std::string_view name() const override { return "echo"; }
    [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }
    void solve(Kind, std::span<const Query>, std::span<Answer> answers,
               const fast::MethodOptions& options) const override {
      answers[0] = {.verdict = Verdict::yes, .tolerance = options.tolerance};
    }
  };
  const Echo method;
  Examinee examinee(method, {.method = {.tolerance = 0.125}});
  std::vector<Answer> answers(1);
  static_cast<void>(examinee.answer(Kind::vertex_face, numbered(1), answers));
  EXPECT_EQ(answers.front().tolerance, 0.125);
}

}  // namespace
}  // namespace touchstone::verify
