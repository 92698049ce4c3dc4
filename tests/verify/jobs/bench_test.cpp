#include "verify/jobs/bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/query_groups.hpp"
#include "tests/support/random.hpp"
#include "verify/jobs/memory_pass.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::jobs::bench_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::always_no;
using tests::burn;
using tests::FunctionMethod;

constexpr std::size_t hit_every = 10;

bool collides(std::size_t position) { return position % hit_every == 0; }

data::QueryGroup falling_vertices(std::size_t count) {
  return tests::falling_group(count, hit_every, 0.001);
}

BenchOptions quick() {
  BenchOptions options;
  options.repetitions = 2;
  options.seconds = 10.0;
  options.singles = 50;
  return options;
}

/// Methods and the solvers made of them.
class Field {
 public:
  void add(FunctionMethod::Function function, Promise promise, const std::string& name) {
    add(std::make_unique<FunctionMethod>(std::move(function), promise, name));
  }
  void add(std::unique_ptr<fast::Method> method) {
    methods_.push_back(std::move(method));
    solvers_.push_back(solvers::solver_in_process(*methods_.back(), {}));
  }
  void add(std::unique_ptr<solvers::Solver> solver) { solvers_.push_back(std::move(solver)); }

  [[nodiscard]] BenchResult run(const data::QueryGroup& group, const BenchOptions& options) const {
    std::vector<const solvers::Solver*> solvers;
    for (const auto& solver : solvers_) solvers.push_back(solver.get());
    return bench(group, solvers, options);
  }

 private:
  std::vector<std::unique_ptr<fast::Method>> methods_;
  std::vector<std::unique_ptr<solvers::Solver>> solvers_;
};

Answer always_yes(Kind, const Query&) { return {.verdict = Verdict::yes}; }

Answer late(Kind kind, const Query& query) {
  Answer answer = tests::true_answer(kind, query);
  answer.toi_lower = std::nextafter(answer.toi_upper, 2.0);
  answer.toi_upper = Answer::none;
  return answer;
}

std::uint64_t all_faults(const judge::Judgement& judgement) {
  return judgement.wrong_answers.size();
}

// ---- Error --------------------------------------------------------------------------------------

/// On lines, and on curves, of which methods of lines are not asked.
TEST(Bench, CountsWhatEachSolverGetsWrong) {
  using enum judge::Fault;
  struct Row {
    Answer (*function)(Kind, const Query&);
    Promise promise;
    std::optional<judge::Fault> fault;
    std::size_t count = 0;
    bool broke_promise = false;
  };
  const std::vector<Row> rows{{tests::true_answer, Promise::exact, {}},
                              {always_no, Promise::conservative, false_negative, 20, true},
                              {always_yes, Promise::conservative, false_positive, 180},
                              {always_yes, Promise::exact, false_positive, 180, true},
                              {late, Promise::conservative, late_toi, 20, true},
                              {always_no, Promise::none, false_negative, 20}};
  Field field;
  for (const Row& row : rows) field.add(row.function, row.promise, "some");
  const BenchResult result = field.run(falling_vertices(200), quick());
  EXPECT_EQ(result.name, "falling");
  EXPECT_EQ(result.queries, 200U);
  EXPECT_EQ(result.judged, 200U);
  EXPECT_EQ(result.collisions, 20U);
  EXPECT_FALSE(result.interrupted);
  ASSERT_EQ(result.solvers.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    const SolverResult& solver = result.solvers[i];
    EXPECT_EQ(solver.queries, 200U);
    EXPECT_EQ(solver.judgement.queries, 200U);
    EXPECT_EQ(all_faults(solver.judgement), rows[i].count);
    if (rows[i].fault) {
      EXPECT_EQ(solver.judgement.count(*rows[i].fault), rows[i].count);
    }
    EXPECT_EQ(broke_promise(solver), rows[i].broke_promise);
  }
  EXPECT_EQ(result.solvers[0].judgement.toi_errors.count(), 20U);
  EXPECT_LT(result.solvers[0].judgement.toi_errors.max(), 1e-15);
  EXPECT_TRUE(any_broke_promise({&result, 1}));

  Field on_curves;
  on_curves.add(fast::certified_method());
  on_curves.add(solvers::certified_queries({}));
  on_curves.add(always_no, Promise::conservative, "lines alone");
  const BenchResult curves = on_curves.run(tests::curved_group(Kind::vertex_face, 30), quick());
  EXPECT_GT(curves.collisions, 0U);
  for (std::size_t i = 0; i < 2; ++i) {
    const SolverResult& right = curves.solvers.at(i);
    EXPECT_EQ(right.judgement.toi_errors.count(), curves.collisions) << right.name;
    EXPECT_EQ(all_faults(right.judgement), 0U) << right.name;
    EXPECT_GT(right.times.median(), 0.0) << right.name;
  }
  EXPECT_EQ(curves.solvers.at(2).judgement.outside, 30U);
  EXPECT_FALSE(broke_promise(curves.solvers.at(2)));
}

/// A sample of the queries, which is that of the calls too, and all that any solver calls a
/// collision, up to the limit.
TEST(Bench, JudgesASampleAndWhatAnySolverCallsACollision) {
  const auto judged = [](FunctionMethod::Function function, std::size_t most) {
    BenchOptions options = quick();
    options.judge = most;
    Field field;
    field.add(always_no, Promise::conservative, "no");
    field.add(std::move(function), Promise::exact, "other");
    return field.run(falling_vertices(1000), options);
  };
  const auto colliding = [](std::size_t most) {
    const auto sample = spread_sample(1000, most);
    return static_cast<std::size_t>(std::ranges::count_if(sample, collides));
  };
  struct Row {
    Answer (*function)(Kind, const Query&);
    std::size_t most, count, collisions;
  };
  for (const auto& [function, most, count, collisions] :
       {Row{always_no, 50, 50, colliding(50)},
        {tests::true_answer, 150, 250 - colliding(150), 100},
        {always_yes, 50, 50, colliding(50)}}) {
    const BenchResult result = judged(function, most);
    ASSERT_GT(collisions, 0U);
    EXPECT_EQ(result.judged, count);
    EXPECT_EQ(result.collisions, collisions);
    const judge::Judgement &no = result.solvers[0].judgement, &other = result.solvers[1].judgement;
    EXPECT_EQ(no.queries, count);
    EXPECT_EQ(no.count(judge::Fault::false_negative), collisions);
    const bool says_yes = function == always_yes;
    EXPECT_EQ(other.count(judge::Fault::false_positive), says_yes ? count - collisions : 0U);
    EXPECT_EQ(all_faults(other) == 0, function == tests::true_answer);
  }
}

// ---- Speed --------------------------------------------------------------------------------------

/// A solver that spends time on each query, records every call, and answers yes.
class Burner final : public solvers::Solver {
 public:
  using Log = std::vector<std::pair<std::string, std::size_t>>;

  Burner(std::string_view name, double nanoseconds, Log& log)
      : solvers::Solver(fast::MethodInfo{.name = name}), nanoseconds_(nanoseconds), log_(log) {}

  [[nodiscard]] bool only_as_a_whole() const override { return whole; }
  [[nodiscard]] solvers::SolveReply answer(const solvers::SolveRequest& request,
                                           std::span<Answer> answers) const override {
    log_.emplace_back(name(), request.queries.size());
    const std::span<const Query> lines = request.queries.straight();
    latest.assign(lines.begin(), lines.end());
    std::ranges::fill(answers, Answer{.verdict = Verdict::yes});
    burn(nanoseconds_ * static_cast<double>(request.queries.size()));
    if (on_solve) on_solve();
    return {};
  }

  bool whole = false;
  mutable std::vector<Query> latest;
  std::function<void()> on_solve;

 private:
  double nanoseconds_;
  Log& log_;
};

TEST(Bench, InterleavesTheSolvers) {
  Burner::Log log;
  Field field;
  // The time makes one call a repetition.
  field.add(std::make_unique<Burner>("a", 1e6, log));
  field.add(std::make_unique<Burner>("b", 1e6, log));
  BenchOptions options = quick();
  options.repetitions = 3;
  options.singles = 2;
  options.seconds = 1e-3;
  const BenchResult result = field.run(falling_vertices(4), options);
  const Burner::Log expected{{"a", 4}, {"b", 4},  // a first look
                             {"a", 4}, {"b", 4},  // memory, a, b
                             {"a", 4}, {"b", 4},  // a, b, memory
                             {"b", 4}, {"a", 4},  // b, memory, a
                             {"a", 1}, {"a", 1}, {"b", 1}, {"b", 1}};
  EXPECT_EQ(log, expected);
  EXPECT_EQ(result.memory_pass.repetitions.size(), 3U);
  EXPECT_EQ(result.solvers[1].times.repetitions.size(), 3U);
}

TEST(Bench, SlowSolversAreTimedOnASpreadSample) {
  Burner::Log log;
  auto burner = std::make_unique<Burner>("burner", 50'000.0, log);
  const Burner& slow = *burner;
  Field field;
  field.add(std::move(burner));
  field.add(always_no, Promise::none, "fast");
  BenchOptions options = quick();
  options.seconds = 0.02;
  options.singles = 0;
  const data::QueryGroup group = falling_vertices(20'000);
  const BenchResult result = field.run(group, options);
  const std::size_t timed = result.solvers[0].queries;
  EXPECT_GE(timed, 16U);
  EXPECT_LT(timed, 800U) << "more would take two hundredths of a second";
  EXPECT_EQ(timed & (timed - 1), 0U) << "a power of two";
  EXPECT_EQ(result.solvers[1].queries, 20'000U);
  ASSERT_EQ(slow.latest.size(), timed);
  const auto sample = spread_sample(group.queries().size(), timed);
  for (std::size_t i = 0; i < timed; ++i) {
    ASSERT_EQ(slow.latest[i], group.queries().straight()[sample[i]]) << i;
  }
  const auto colliding = static_cast<std::uint64_t>(std::ranges::count_if(sample, collides));
  EXPECT_EQ(result.solvers[0].judgement.queries, timed) << "it answered no others";
  EXPECT_EQ(result.solvers[0].judgement.count(judge::Fault::false_positive), timed - colliding);
  EXPECT_FALSE(result.solvers[0].singles);
}

TEST(Bench, WhatCanOnlyBeAskedAsAWholeIs) {
  Burner::Log log;
  auto burner = std::make_unique<Burner>("whole", 10'000.0, log);
  burner->whole = true;
  Field field;
  field.add(std::move(burner));
  BenchOptions options = quick();
  options.seconds = 1e-3;
  const BenchResult result = field.run(falling_vertices(1000), options);
  EXPECT_EQ(log, (Burner::Log{{"whole", 1000}, {"whole", 1000}, {"whole", 1000}}));
  EXPECT_EQ(result.solvers[0].queries, 1000U);
  EXPECT_FALSE(result.solvers[0].singles);
}

// ---- The pass over the memory --------------------------------------------------------------------

TEST(MemoryPass, ReadsEveryCoordinateOfAnyNumberOfQueries) {
  for (const std::size_t count : {0U, 1U, 2U, 3U, 7U, 8U, 16U, 19U, 100'003U}) {
    tests::Random random(count);
    std::vector<Query> queries(count);
    std::uint64_t all = 0;
    for (Query& query : queries) {
      for (double& x : query.coordinates) {
        x = std::bit_cast<double>(random.bits());
        all ^= std::bit_cast<std::uint64_t>(x);
      }
    }
    EXPECT_EQ(memory_pass(queries), all) << count;
  }
}

TEST(MemoryPass, FillsUpTheLastWord) {
  EXPECT_EQ(memory_pass(std::vector<unsigned char>{}), 0U);
  EXPECT_EQ(memory_pass(std::vector<std::uint32_t>{1, 2, 4}), (std::uint64_t{2} << 32U) ^ 5U);
  std::vector<unsigned char> bytes(10'001);
  bytes.back() = 3;
  EXPECT_EQ(memory_pass(bytes), 3U) << "the last byte is the first of its word";
}

// ---- The run ------------------------------------------------------------------------------------

TEST(Bench, AStopKeepsWhatIsDone) {
  std::atomic<bool> stop = false;
  Burner::Log log;
  auto burner = std::make_unique<Burner>("a", 1e6, log);
  burner->on_solve = [&] { stop = log.size() == 3; };
  Field field;
  field.add(std::move(burner));
  BenchOptions options = quick();
  options.repetitions = 10;
  options.stop = &stop;
  const BenchResult result = field.run(falling_vertices(4), options);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(log.size(), 3U) << "a first look and two repetitions";
  EXPECT_EQ(result.solvers[0].times.repetitions.size(), 2U);
  EXPECT_EQ(result.judged, 0U);
  EXPECT_FALSE(result.solvers[0].singles);
}

TEST(Bench, RefusesWhatMakesNoSense) {
  Field field;
  field.add(always_yes, Promise::none, "yes");
  BenchOptions options = quick();
  options.repetitions = 0;
  EXPECT_THROW((void)field.run(falling_vertices(4), options), std::invalid_argument);
  options = quick();
  for (const double seconds : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options.seconds = seconds;
    EXPECT_THROW((void)field.run(falling_vertices(4), options), std::invalid_argument);
  }
  EXPECT_THROW((void)field.run(falling_vertices(0), quick()), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::jobs::bench_test
