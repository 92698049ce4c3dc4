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
#include <optional>
#include <span>
#include <stdexcept>
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

/// The row of a solver on a group.
BenchRow row_of(const data::QueryGroup& group, const solvers::Solver& solver,
                const BenchOptions& options, const Separation& separation = {}) {
  return Bench(group, options).row(solver, {.separation = separation});
}

BenchRow row_of(const data::QueryGroup& group, FunctionMethod::Function function, Promise promise,
                const BenchOptions& options) {
  const FunctionMethod method(std::move(function), promise, "some");
  return row_of(group, *solvers::solver_in_process(method, {}), options);
}

Answer always_yes(AnyKind, const Query&) { return {.verdict = Verdict::yes}; }

Answer late(AnyKind kind, const Query& query) {
  Answer answer = tests::true_answer(kind, query);
  answer.toi_lower = std::nextafter(answer.toi_upper, 2.0);
  answer.toi_upper = Answer::none;
  return answer;
}

std::uint64_t all_faults(const judge::Judgement& judgement) {
  return judgement.wrong_answers.size();
}

// ---- Error --------------------------------------------------------------------------------------

TEST(Bench, CountsWhatASolverGetsWrong) {
  using enum judge::Fault;
  struct Row {
    Answer (*function)(AnyKind, const Query&);
    Promise promise;
    std::optional<judge::Fault> fault;
    std::size_t count = 0;
    bool broke_promise = false;
  };
  const data::QueryGroup group = falling_vertices(200);
  for (const Row& row : {Row{tests::true_answer, Promise::exact, {}},
                         {always_no, Promise::conservative, false_negative, 20, true},
                         {always_yes, Promise::conservative, false_positive, 180},
                         {always_yes, Promise::exact, false_positive, 180, true},
                         {late, Promise::conservative, late_toi, 20, true},
                         {always_no, Promise::none, false_negative, 20}}) {
    const BenchRow result = row_of(group, row.function, row.promise, quick());
    EXPECT_EQ(result.source, "falling");
    EXPECT_EQ(result.method, "some");
    EXPECT_EQ(result.queries, 200U);
    EXPECT_EQ(result.timed, 200U);
    EXPECT_EQ(result.judgement.queries, 200U);
    EXPECT_EQ(result.judgement.collisions, 20U);
    EXPECT_FALSE(result.interrupted);
    EXPECT_EQ(all_faults(result.judgement), row.count);
    if (row.fault) {
      EXPECT_EQ(result.judgement.count(*row.fault), row.count);
    }
    EXPECT_EQ(broke_promise(result), row.broke_promise);
  }
}

/// Methods of lines are not asked about curves.
TEST(Bench, TakesCurvesAndSeparations) {
  const data::QueryGroup curves = tests::curved_group(ContactKind::vertex_face, 30);
  const auto certified = fast::certified_method();
  const auto solver = solvers::solver_in_process(*certified, {});
  const BenchRow right = row_of(curves, *solver, quick());
  EXPECT_GT(right.judgement.collisions, 0U);
  EXPECT_EQ(right.judgement.toi_errors.count(), right.judgement.collisions);
  EXPECT_EQ(all_faults(right.judgement), 0U);
  const BenchRow none = row_of(curves, always_no, Promise::conservative, quick());
  EXPECT_EQ(none.judgement.outside, 30U);
  EXPECT_FALSE(broke_promise(none));
  // Those that fall to 1/2 come as near as that.
  const Separation half{.distance = 0.5, .norm = Norm::l2};
  EXPECT_EQ(row_of(falling_vertices(20), *solver, quick(), half).judgement.collisions, 20U);
}

/// An even part of the sample, and what the solver or the certified solver calls a collision.
TEST(Bench, JudgesAPartAndWhatIsCalledACollision) {
  const auto colliding = [](std::size_t most) {
    const auto sample = spread_sample(1000, most);
    return static_cast<std::size_t>(std::ranges::count_if(sample, collides));
  };
  struct Row {
    Answer (*function)(AnyKind, const Query&);
    std::size_t most, count, collisions;
  };
  const data::QueryGroup group = falling_vertices(1000);
  for (const auto& [function, most, count, collisions] :
       {Row{always_no, 150, 250 - colliding(150), 100},
        {tests::true_answer, 150, 250 - colliding(150), 100},
        {always_yes, 50, 50, colliding(50)}}) {
    BenchOptions options = quick();
    options.judge = most;
    const judge::Judgement judged = row_of(group, function, Promise::exact, options).judgement;
    EXPECT_EQ(judged.queries, count);
    EXPECT_EQ(judged.collisions, collisions);
    const bool is_no = function == always_no, is_yes = function == always_yes;
    EXPECT_EQ(judged.count(judge::Fault::false_negative), is_no ? collisions : 0U);
    EXPECT_EQ(judged.count(judge::Fault::false_positive), is_yes ? count - collisions : 0U);
  }
}

TEST(Bench, CountsQueriesThatReachTheLimitOfChecks) {
  const FunctionMethod method(
      [](AnyKind, const Query& query) {
        const bool is_hard = query.at(1, 0, 2) < 0.0;
        return Answer{.verdict = Verdict::yes, .checks = is_hard ? 10U : 9U};
      },
      Promise::none, "some");
  const auto solver = solvers::solver_in_process(method, {});
  const data::QueryGroup group = falling_vertices(100);
  const BenchOptions options = quick();
  EXPECT_EQ(Bench(group, options).row(*solver, {.max_checks = 10}).at_limit, 10U);
  EXPECT_EQ(Bench(group, options).row(*solver, {.max_checks = 0}).at_limit, 0U);
}

// ---- Speed --------------------------------------------------------------------------------------

/// A solver that spends time on each query, records every call, and answers yes.
class Burner final : public solvers::Solver {
 public:
  explicit Burner(double nanoseconds)
      : solvers::Solver(fast::MethodInfo{.name = "burner"}), nanoseconds_(nanoseconds) {}

  [[nodiscard]] solvers::SolveReply answer(const solvers::SolveRequest& request,
                                           std::span<Answer> answers) const override {
    log.push_back(request.queries.size());
    const std::span<const Query> lines = request.queries.straight();
    latest.assign(lines.begin(), lines.end());
    std::ranges::fill(answers, Answer{.verdict = Verdict::yes});
    burn(nanoseconds_ * static_cast<double>(request.queries.size()));
    if (on_solve) on_solve();
    return {};
  }

  mutable std::vector<std::size_t> log;
  mutable std::vector<Query> latest;
  std::function<void()> on_solve;

 private:
  double nanoseconds_;
};

TEST(Bench, TimesTheSampleBesideTheCertifiedSolverThenSingleQueries) {
  const Burner burner(1e6);
  BenchOptions options = quick();
  options.repetitions = 3;
  options.singles = 2;
  options.seconds = 1e-3;
  const BenchRow row = row_of(falling_vertices(4), burner, options);
  // A first look, three repetitions, two sweeps at most.
  ASSERT_GE(burner.log.size(), 6U);
  EXPECT_EQ(std::vector(burner.log.begin(), burner.log.begin() + 4),
            std::vector<std::size_t>(4, 4));
  EXPECT_EQ(burner.log.back(), 1U);
  EXPECT_GE(row.nanoseconds, 0.9e6);
  EXPECT_LT(row.certified_nanoseconds, row.nanoseconds);
  EXPECT_GT(row.certified_nanoseconds, 0.0);
  EXPECT_GT(row.pass_nanoseconds, 0.0);
  ASSERT_TRUE(row.singles);
  EXPECT_GE(row.singles->p50, 0.9e6);
}

TEST(Bench, SlowSolversAreTimedOnASpreadSample) {
  const Burner slow(50'000.0);
  BenchOptions options = quick();
  options.seconds = 0.02;
  options.singles = 0;
  const data::QueryGroup group = falling_vertices(20'000);
  const BenchRow row = row_of(group, slow, options);
  EXPECT_GE(row.timed, 16U);
  EXPECT_LT(row.timed, 800U) << "more would take two hundredths of a second";
  EXPECT_EQ(row.timed & (row.timed - 1), 0U) << "a power of two";
  ASSERT_EQ(slow.latest.size(), row.timed);
  const auto sample = spread_sample(group.queries().size(), row.timed);
  for (std::size_t i = 0; i < row.timed; ++i) {
    ASSERT_EQ(slow.latest[i], group.queries().straight()[sample[i]]) << i;
  }
  const auto colliding = static_cast<std::uint64_t>(std::ranges::count_if(sample, collides));
  EXPECT_EQ(row.judgement.queries, row.timed) << "it answered no others";
  EXPECT_EQ(row.judgement.count(judge::Fault::false_positive), row.timed - colliding);
  EXPECT_FALSE(row.singles);
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
  Burner burner(1e6);
  burner.on_solve = [&] { stop = burner.log.size() == 3; };
  BenchOptions options = quick();
  options.repetitions = 10;
  options.stop = &stop;
  const BenchRow row = row_of(falling_vertices(4), burner, options);
  EXPECT_TRUE(row.interrupted);
  EXPECT_EQ(burner.log.size(), 3U) << "a first look and two repetitions";
  EXPECT_GT(row.nanoseconds, 0.0);
  EXPECT_EQ(row.judgement.queries, 0U);
  EXPECT_FALSE(row.singles);
}

TEST(Bench, RefusesWhatMakesNoSense) {
  const data::QueryGroup group = falling_vertices(4), empty = falling_vertices(0);
  BenchOptions options = quick();
  options.repetitions = 0;
  EXPECT_THROW(Bench(group, options), std::invalid_argument);
  for (const double seconds : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options = quick();
    options.seconds = seconds;
    EXPECT_THROW(Bench(group, options), std::invalid_argument);
  }
  options = quick();
  EXPECT_THROW(Bench(empty, options), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::jobs::bench_test
