#include "verify/methods/isolation.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

namespace touchstone::verify {
namespace {

using namespace std::chrono_literals;
using fast::Answer;
using fast::Verdict;
using Clock = std::chrono::steady_clock;

/// What the scripted method does with a query; its first coordinate says it.
enum class Act {
  answer,  ///< yes; times: the second coordinate and the kind; tolerance: length of the span
  dies,
  throws,
  exits,          ///< with status 0, as if all were well
  hangs,          ///< asleep
  burns,          ///< for ever
  works,          ///< 50 ms of processor time, then answers
  naps,           ///< 20 ms, then answers
  dies_in_spans,  ///< alone it answers
  closes,         ///< all descriptors but the standard ones, then is asleep
  forks           ///< a process that sleeps for ever, then answers
};

Query scripted(Act act, std::size_t number) {
  Query query{};
  query.coordinates[0] = static_cast<double>(act);
  query.coordinates[1] = static_cast<double>(number);
  return query;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void work() {
  const double end = processor_seconds() + 0.05;
  while (processor_seconds() < end) continue;
}

[[noreturn]] void burn() {
  for (volatile bool go_on = true;;) static_cast<void>(go_on);
}

[[noreturn]] void sleep_for_ever() {
  for (;;) ::pause();
}

class ScriptedMethod final : public fast::Method {
 public:
  [[nodiscard]] std::string_view name() const override { return "scripted"; }
  [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }

  void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
             const fast::MethodOptions& options) const override {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      act(static_cast<Act>(static_cast<int>(queries[i].coordinates[0])), queries.size());
      answers[i] = {.verdict = Verdict::yes,
                    .toi_lower = queries[i].coordinates[1] + options.t_max,
                    .toi_upper = static_cast<double>(kind),
                    .tolerance = static_cast<double>(queries.size())};
    }
  }

 private:
  static void act(Act act, std::size_t span) {
    if (act == Act::dies || (act == Act::dies_in_spans && span > 1)) std::raise(SIGKILL);
    if (act == Act::throws) throw std::runtime_error("thrown by a solver");
    if (act == Act::exits) ::_exit(0);
    if (act == Act::hangs) sleep_for_ever();
    if (act == Act::burns) burn();
    if (act == Act::works) work();
    if (act == Act::naps) std::this_thread::sleep_for(20ms);
    if (act == Act::forks && ::fork() == 0) sleep_for_ever();
    if (act == Act::closes) {
      for (int descriptor = 3; descriptor < 1024; ++descriptor) ::close(descriptor);
      sleep_for_ever();
    }
  }
};

std::vector<Query> numbered(std::size_t count) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) queries.push_back(scripted(Act::answer, i));
  return queries;
}

void plant(std::vector<Query>& queries, Act act, const std::vector<std::size_t>& indices) {
  for (const std::size_t i : indices) queries.at(i) = scripted(act, i);
}

struct Outcome {
  std::vector<Answer> answers;
  IsolatedSolve solve;
};

Outcome run(const std::vector<Query>& queries, double limit, Kind kind = Kind::vertex_face,
            const std::atomic<bool>* stop = nullptr) {
  Outcome outcome{.answers = std::vector<Answer>(queries.size()), .solve = {}};
  outcome.solve = solve_isolated(ScriptedMethod(), kind, queries, outcome.answers, {.t_max = 0.5},
                                 {.query_limit_seconds = limit, .stop = stop});
  return outcome;
}

/// Expects `verdict` and nothing else at these indices, and the method's own answer elsewhere.
void expect_answers(const std::vector<Answer>& answers, Verdict verdict = Verdict::yes,
                    const std::vector<std::size_t>& indices = {}) {
  std::vector<bool> special(answers.size());
  for (const std::size_t i : indices) special.at(i) = true;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    SCOPED_TRACE(i);
    if (special[i]) {
      ASSERT_EQ(answers[i].verdict, verdict);
      ASSERT_TRUE(std::isnan(answers[i].toi_lower));
      ASSERT_TRUE(std::isnan(answers[i].toi_upper));
      ASSERT_TRUE(std::isnan(answers[i].tolerance));
    } else {
      ASSERT_EQ(answers[i].verdict, Verdict::yes);
      ASSERT_EQ(answers[i].toi_lower, static_cast<double>(i) + 0.5);
    }
  }
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const std::function<void()>& work) {
  const Clock::time_point start = Clock::now();
  work();
  return seconds_since(start);
}

/// Writes to every page of some memory.
class TouchingMethod final : public fast::Method {
 public:
  explicit TouchingMethod(std::vector<char>& memory) : memory_(memory) {}
  [[nodiscard]] std::string_view name() const override { return "touching"; }
  [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }
  void solve(Kind, std::span<const Query>, std::span<Answer>,
             const fast::MethodOptions&) const override {
    for (std::size_t i = 0; i < memory_.size(); i += 4096) ++memory_[i];
  }

 private:
  std::vector<char>& memory_;
};

constexpr double long_limit = 60.0;

TEST(SolveIsolated, AnswersAsTheMethodDoes) {
  for (const double limit : {0.0, long_limit}) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const Outcome outcome = run(numbered(5000), limit, kind);
      expect_answers(outcome.answers);
      for (const Answer& answer : outcome.answers) {
        ASSERT_EQ(answer.toi_upper, static_cast<double>(kind));
      }
      EXPECT_EQ(outcome.solve.crashes, 0U);
      EXPECT_EQ(outcome.solve.limit_hits, 0U);
    }
  }
}

TEST(SolveIsolated, ShowsTheMethodSpansWithoutALimitAndSingleQueriesWithOne) {
  const std::vector<Answer> spans = run(numbered(2500), 0.0).answers;
  EXPECT_EQ(spans.front().tolerance, 1024.0);
  EXPECT_EQ(spans[2047].tolerance, 1024.0);
  EXPECT_EQ(spans[2048].tolerance, 452.0);
  for (const Answer& answer : run(numbered(2500), long_limit).answers) {
    ASSERT_EQ(answer.tolerance, 1.0);
  }
}

TEST(SolveIsolated, NeedsNoQueries) {
  const Outcome outcome = run({}, 0.0);
  EXPECT_EQ(outcome.solve.crashes, 0U);
  EXPECT_EQ(outcome.solve.processor_seconds, 0.0);
}

TEST(SolveIsolated, EveryWayToEndCostsOneQuery) {
  for (const Act act : {Act::dies, Act::throws, Act::exits}) {
    for (const double limit : {0.0, long_limit}) {
      SCOPED_TRACE(static_cast<int>(act));
      const std::vector<std::size_t> deadly{0, 100, 101, 1023, 1024, 2499};
      std::vector<Query> queries = numbered(2500);
      plant(queries, act, deadly);
      const Outcome outcome = run(queries, limit);
      expect_answers(outcome.answers, Verdict::error, deadly);
      EXPECT_EQ(outcome.solve.crashes, deadly.size());
      EXPECT_EQ(outcome.solve.limit_hits, 0U);
    }
  }
}

TEST(SolveIsolated, SurvivesAMethodThatNeverDoes) {
  std::vector<Query> queries = numbered(50);
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < queries.size(); ++i) all.push_back(i);
  plant(queries, Act::dies, all);
  for (const double limit : {0.0, long_limit}) {
    const Outcome outcome = run(queries, limit);
    expect_answers(outcome.answers, Verdict::error, all);
    EXPECT_EQ(outcome.solve.crashes, all.size());
  }
}

TEST(SolveIsolated, ADeathThatDoesNotRepeatCostsNoAnswerButIsCounted) {
  std::vector<Query> queries = numbered(3000);
  plant(queries, Act::dies_in_spans, {1500});
  const Outcome outcome = run(queries, 0.0);
  expect_answers(outcome.answers);
  EXPECT_EQ(outcome.solve.crashes, 0U);
  EXPECT_EQ(outcome.solve.unplaced_crashes, 1U);
  EXPECT_EQ(outcome.answers[1023].tolerance, 1024.0);
  EXPECT_EQ(outcome.answers[1024].tolerance, 1.0);
  EXPECT_EQ(outcome.answers[2047].tolerance, 1.0);
  EXPECT_EQ(outcome.answers[2048].tolerance, 952.0);
}

TEST(SolveIsolated, TellsDeathsThatRepeatFromThoseThatDoNot) {
  std::vector<Query> queries = numbered(5000);
  plant(queries, Act::dies_in_spans, {10, 3000});
  plant(queries, Act::dies, {1500, 1501, 4999});
  const Outcome outcome = run(queries, 0.0);
  expect_answers(outcome.answers, Verdict::error, {1500, 1501, 4999});
  EXPECT_EQ(outcome.solve.crashes, 3U);
  EXPECT_EQ(outcome.solve.unplaced_crashes, 2U);
}

TEST(SolveIsolated, TheLimitCostsOneQuery) {
  for (const Act act : {Act::hangs, Act::burns}) {
    const std::vector<std::size_t> slow{0, 7, 8, 29};
    std::vector<Query> queries = numbered(30);
    plant(queries, act, slow);
    const Clock::time_point start = Clock::now();
    const Outcome outcome = run(queries, 0.25);
    EXPECT_GE(seconds_since(start), 4 * 0.25);
    expect_answers(outcome.answers, Verdict::undecided, slow);
    EXPECT_EQ(outcome.solve.limit_hits, slow.size());
    EXPECT_EQ(outcome.solve.crashes, 0U);
  }
}

TEST(SolveIsolated, TheLimitHoldsForAChildThatClosesAllItsDescriptors) {
  std::vector<Query> queries = numbered(3);
  plant(queries, Act::closes, {1});
  const Outcome outcome = run(queries, 0.25);
  expect_answers(outcome.answers, Verdict::undecided, {1});
  EXPECT_EQ(outcome.solve.limit_hits, 1U);
}

TEST(SolveIsolated, AStopIsObeyedInTheMidstOfAQuery) {
  for (const double limit : {0.0, 600.0}) {
    std::vector<Query> queries = numbered(10);
    plant(queries, Act::hangs, {5});
    std::atomic<bool> stop = false;
    const Clock::time_point start = Clock::now();
    std::jthread stopper([&] {
      std::this_thread::sleep_for(100ms);
      stop = true;
    });
    const Outcome outcome = run(queries, limit, Kind::vertex_face, &stop);
    EXPECT_LT(seconds_since(start), 5.0);
    EXPECT_TRUE(outcome.solve.stopped);
    EXPECT_EQ(outcome.solve.limit_hits + outcome.solve.crashes, 0U);
  }
  std::atomic<bool> stop = false;
  EXPECT_FALSE(run(numbered(10), 0.0, Kind::vertex_face, &stop).solve.stopped);
}

TEST(SolveIsolated, TheLimitIsThatOfAQueryAndNotOfTheSpan) {
  std::vector<Query> queries = numbered(40);
  for (std::size_t i = 0; i < queries.size(); ++i) plant(queries, Act::naps, {i});
  const Clock::time_point start = Clock::now();
  const Outcome outcome = run(queries, 0.4);
  EXPECT_GT(seconds_since(start), 2 * 0.4);
  expect_answers(outcome.answers);
  EXPECT_EQ(outcome.solve.limit_hits, 0U);
}

TEST(SolveIsolated, TellsCrashesFromLimits) {
  std::vector<Query> queries = numbered(20);
  plant(queries, Act::hangs, {5});
  plant(queries, Act::dies, {6, 12});
  const Outcome outcome = run(queries, 0.25);
  EXPECT_EQ(outcome.answers[5].verdict, Verdict::undecided);
  EXPECT_EQ(outcome.answers[6].verdict, Verdict::error);
  EXPECT_EQ(outcome.answers[12].verdict, Verdict::error);
  EXPECT_EQ(outcome.answers[19].verdict, Verdict::yes);
  EXPECT_EQ(outcome.solve.limit_hits, 1U);
  EXPECT_EQ(outcome.solve.crashes, 2U);
}

TEST(SolveIsolated, CountsProcessorTime) {
  std::vector<Query> queries = numbered(3);
  plant(queries, Act::works, {0, 1, 2});
  for (const double limit : {0.0, long_limit}) {
    const double seconds = run(queries, limit).solve.processor_seconds;
    EXPECT_GE(seconds, 0.15);
    EXPECT_LT(seconds, 0.3);
  }
}

TEST(SolveIsolated, CountsSleepAsWallClockTimeOnly) {
  std::vector<Query> queries = numbered(10);
  for (std::size_t i = 0; i < queries.size(); ++i) plant(queries, Act::naps, {i});
  const IsolatedSolve solve = run(queries, 0.0).solve;
  EXPECT_LT(solve.processor_seconds, 0.1);
  EXPECT_GE(solve.wall_seconds, 0.2);
}

TEST(SolveIsolated, DoesNotCountTheFirstTouchOfThePagesOfThisProcess) {
  // The child copies each page that the first query writes to; that is no time of the solver.
  std::vector<char> pages(std::size_t{1} << 28U, 1);
  const TouchingMethod method(pages);
  const std::vector<Query> queries = numbered(1);
  std::vector<Answer> answers(1);
  const double cold = seconds_of([&] {
    const pid_t child = ::fork();
    if (child == 0) {
      method.solve(Kind::vertex_face, queries, answers, {});
      ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
  });
  const IsolatedSolve solve = solve_isolated(method, Kind::vertex_face, queries, answers, {});
  EXPECT_LT(solve.processor_seconds, 0.5 * cold);
}

TEST(SolveIsolated, CountsTheTimeOfChildrenThatDied) {
  std::vector<Query> queries = numbered(2);
  plant(queries, Act::works, {0});
  plant(queries, Act::dies, {1});
  const double seconds = run(queries, long_limit).solve.processor_seconds;
  EXPECT_GE(seconds, 0.045);  // the system counts in ticks of some milliseconds where it must
  EXPECT_LT(seconds, 0.2);

  std::vector<Query> burning = numbered(1);
  plant(burning, Act::burns, {0});
  EXPECT_GT(run(burning, 0.5).solve.processor_seconds, 0.02);
}

TEST(SolveIsolated, WakesUpAtOnceWhenTheChildEnds) {
  // Far less than the second or the tenth of the limit that a parent without a signal would sleep.
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < 20; ++i) expect_answers(run(numbered(10), i % 2 == 0 ? 0.0 : 600.0).answers);
  EXPECT_LT(seconds_since(start), 10.0);
}

// ---- The process around it ----------------------------------------------------------------------

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

TEST(SolveIsolated, LeavesNeitherChildrenNorDescriptors) {
  const std::ptrdiff_t before = open_descriptors();
  std::vector<Query> queries = numbered(10);
  plant(queries, Act::hangs, {3});
  plant(queries, Act::dies, {5});
  static_cast<void>(run(queries, 0.1));
  static_cast<void>(run(numbered(10), 0.0));
  EXPECT_EQ(open_descriptors(), before);
  errno = 0;
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(SolveIsolated, NeitherWaitsForGrandchildrenNorLeavesThem) {
  // Orphans become children of this process, which can then see how they ended.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  std::vector<Query> queries = numbered(10);
  plant(queries, Act::forks, {1, 2, 3});
  plant(queries, Act::dies, {4, 5, 6, 7, 8, 9});
  const Clock::time_point start = Clock::now();
  const Outcome outcome = run(queries, long_limit);
  EXPECT_LT(seconds_since(start), 4.0) << "seven children";
  expect_answers(outcome.answers, Verdict::error, {4, 5, 6, 7, 8, 9});
  int killed = 0;
  for (int i = 0; i < 500 && killed < 3; ++i) {
    int status = 0;
    const pid_t orphan = ::waitpid(-1, &status, WNOHANG);
    if (orphan > 0) killed += WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL ? 1 : 0;
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(killed, 3);
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
}

TEST(SolveIsolated, MayBeCalledFromSeveralThreads) {
  std::atomic<unsigned> right = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&right, thread] {
        for (std::size_t round = 0; round < 10; ++round) {
          std::vector<Query> queries = numbered(1500);
          const std::size_t deadly = 100 * thread + round;
          plant(queries, Act::dies, {deadly});
          const Outcome outcome = run(queries, round % 2 == 0 ? 0.0 : long_limit);
          expect_answers(outcome.answers, Verdict::error, {deadly});
          right += outcome.solve.crashes == 1 ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(right, 40U);
}

std::atomic<unsigned> signals = 0;
extern "C" void count_signal(int) { ++signals; }

TEST(SolveIsolated, DoesNotMindSignals) {
  struct sigaction action {
  }, old_action{};
  action.sa_handler = count_signal;
  ASSERT_EQ(::sigaction(SIGALRM, &action, &old_action), 0);
  const itimerval often{.it_interval = {0, 1000}, .it_value = {0, 1000}};
  ASSERT_EQ(::setitimer(ITIMER_REAL, &often, nullptr), 0);
  std::vector<Query> queries = numbered(10);
  plant(queries, Act::works, {1, 2});
  plant(queries, Act::hangs, {4});
  const Outcome outcome = run(queries, 0.5);
  const itimerval never{};
  ASSERT_EQ(::setitimer(ITIMER_REAL, &never, nullptr), 0);
  ASSERT_EQ(::sigaction(SIGALRM, &old_action, nullptr), 0);
  EXPECT_GT(signals, 10U);
  expect_answers(outcome.answers, Verdict::undecided, {4});
  EXPECT_EQ(outcome.solve.limit_hits, 1U);
}

TEST(SolveIsolated, WorksWhereTheSystemReapsChildren) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  std::vector<Query> queries = numbered(10);
  plant(queries, Act::dies, {4});
  const Outcome outcome = run(queries, 0.0);
  std::signal(SIGCHLD, before);
  expect_answers(outcome.answers, Verdict::error, {4});
  EXPECT_EQ(outcome.solve.crashes, 1U);
}

/// Writes down its process and sleeps for ever.
class LoggingMethod final : public fast::Method {
 public:
  explicit LoggingMethod(std::atomic<pid_t>& process) : process_(process) {}
  [[nodiscard]] std::string_view name() const override { return "logging"; }
  [[nodiscard]] fast::Promise promise() const override { return fast::Promise::none; }
  void solve(Kind, std::span<const Query>, std::span<Answer>,
             const fast::MethodOptions&) const override {
    process_ = ::getpid();
    sleep_for_ever();
  }

 private:
  std::atomic<pid_t>& process_;
};

TEST(SolveIsolated, TheChildDiesWithItsParent) {
  // The orphan becomes a child of this process, which can then see how it ended.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  void* const shared = ::mmap(nullptr, sizeof(std::atomic<pid_t>), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& grandchild = *new (shared) std::atomic<pid_t>(0);

  const pid_t parent = ::fork();
  if (parent == 0) {
    const std::vector<Query> queries = numbered(1);
    std::vector<Answer> answers(1);
    static_cast<void>(
        solve_isolated(LoggingMethod(grandchild), Kind::vertex_face, queries, answers, {}));
    ::_exit(0);
  }
  ASSERT_GT(parent, 0);
  while (grandchild == 0) std::this_thread::sleep_for(1ms);
  ASSERT_EQ(::kill(parent, SIGKILL), 0);
  ASSERT_EQ(::waitpid(parent, nullptr, 0), parent);

  int status = 0;
  ASSERT_EQ(::waitpid(grandchild, &status, 0), grandchild);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  ::munmap(shared, sizeof(std::atomic<pid_t>));
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
}

}  // namespace
}  // namespace touchstone::verify
