#include "verify/solvers/solver_process.hpp"
#include "tests/support/shared_counter.hpp"
#include "tests/support/trials.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// A separate program, because it makes processes, which copy no threads. The ways of a plugin to
// end are in plugin_method_test.cpp.

namespace touchstone::verify::solvers::solver_process_test {
namespace {

using namespace std::chrono_literals;
using fast::Answer;
using fast::Verdict;

/// The actions of the scripted method, which the first coordinate of a query selects.
enum class Act {
  answer,  ///< yes; times: the second coordinate and the kind; tolerance: length of the span
  dies,
  throws,
  hangs,          ///< asleep
  burns,          ///< without end
  works,          ///< 50 ms of processor time, then answers
  dies_in_spans,  ///< answers if it is asked alone
  dies_once,      ///< in the first process
  forks,          ///< a process that sleeps without end, then answers
  allocates,      ///< as much as possible, then answers; tolerance: GiB
  prints
};

Query scripted(Act act, std::size_t number) {
  Query query{};
  query.coordinates[0] = static_cast<double>(act);
  query.coordinates[1] = static_cast<double>(number);
  return query;
}

/// Another number for each shape.
double shape_number(const AnyShape& shape) {
  return static_cast<double>(shape.kind.number()) + 10.0 * static_cast<double>(shape.degree) +
         (shape.is_rational ? 100.0 : 0.0);
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr double work_seconds = 0.05;
void work() {
  const double end = processor_seconds() + work_seconds;
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
  /// The first processes that load it, as many as this, end before their first query.
  explicit ScriptedMethod(std::uint64_t lost_starts = 0) : lost_starts_(lost_starts) {}

  [[nodiscard]] const fast::MethodInfo& info() const override {
    static const fast::MethodInfo info{.name = "scripted"};
    return info;
  }

  void solve(const AnyQueries& queries, std::span<Answer> answers,
             const fast::MethodOptions& options) const override {
    if (queries.empty() && starts_.add() <= lost_starts_) std::raise(SIGKILL);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const std::span<const double> numbers = queries.row(i);
      const auto what = static_cast<Act>(static_cast<int>(numbers[0]));
      answers[i] = {.verdict = Verdict::yes,
                    .toi_lower = numbers[1] + options.t_max,
                    .toi_upper = shape_number(queries),
                    .tolerance = static_cast<double>(queries.size())};
      end_badly(what, queries.size());
      act(what, answers[i]);
    }
  }

 private:
  void end_badly(Act act, std::size_t span) const {
    if (act == Act::dies || (act == Act::dies_in_spans && span > 1)) std::raise(SIGKILL);
    if (act == Act::dies_once && processes_.add() == 1) std::raise(SIGKILL);
    if (act == Act::throws) throw std::runtime_error("thrown by a solver");
    if (act == Act::hangs) sleep_for_ever();
    if (act == Act::burns) burn();
  }

  static void act(Act act, Answer& answer) {
    if (act == Act::works) work();
    if (act == Act::forks && ::fork() == 0) sleep_for_ever();
    if (act == Act::prints) {
      std::printf("out %g\n", answer.toi_lower);
      std::cerr << "err\n";
    }
    if (act == Act::allocates) {
      constexpr std::size_t gibibyte = std::size_t{1} << 30U;
      constexpr int enough = 64;
      int count = 0;
      // The memory is never used: the limit applies to requests.
      while (count < enough && std::malloc(gibibyte) != nullptr) ++count;  // NOLINT
      answer.tolerance = count;
    }
  }

  std::uint64_t lost_starts_;
  tests::SharedCounter starts_, processes_;
};

/// Answers a span of queries with a function.
class SpanMethod final : public fast::Method {
 public:
  using Function = std::function<void(std::span<const Query>, std::span<Answer>, double tolerance)>;

  explicit SpanMethod(Function function) : function_(std::move(function)) {}
  [[nodiscard]] const fast::MethodInfo& info() const override {
    static const fast::MethodInfo info{.name = "spans"};
    return info;
  }
  void solve(const AnyQueries& queries, std::span<Answer> answers,
             const fast::MethodOptions& options) const override {
    function_(queries.straight(), answers, options.tolerance);
  }

 private:
  Function function_;
};

std::vector<Query> all_of(Act act, std::size_t count) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) queries.push_back(scripted(act, i));
  return queries;
}

std::vector<Query> numbered(std::size_t count) { return all_of(Act::answer, count); }

AnyQueries lines(const std::vector<Query>& queries) { return {ContactKind::vertex_face, queries}; }

using Places = std::vector<std::size_t>;

/// Numbered queries, but for some that do something else.
std::vector<Query> with(std::size_t count, Act act, const Places& places) {
  std::vector<Query> queries = numbered(count);
  for (const std::size_t i : places) queries.at(i) = scripted(act, i);
  return queries;
}

struct Outcome {
  std::vector<Answer> answers;
  SolverRun run;
  CapturedOutput output;
};

Outcome run(const std::vector<Query>& queries, const SolverProcessOptions& options = {},
            const ScriptedMethod& method = ScriptedMethod()) {
  SolverProcess process(method, options);
  Outcome outcome{.answers = std::vector<Answer>(queries.size()), .run = {}, .output = {}};
  outcome.run = process.solve(lines(queries), outcome.answers, {.t_max = 0.5});
  outcome.output = process.take_output();
  return outcome;
}

/// Expects these failures, and the method's own answer elsewhere.
void expect_failures(const Outcome& outcome, const judge::Failure& failure, const Places& places,
                     std::uint64_t unplaced = 0) {
  const std::vector<Answer>& answers = outcome.answers;
  EXPECT_EQ(outcome.run.answered, answers.size());
  EXPECT_EQ(outcome.run.unplaced_crashes, unplaced);
  Places found;
  for (const judge::QueryFailure& other : outcome.run.failures) {
    found.push_back(other.position);
    EXPECT_EQ(other.failure, failure) << to_text(other.failure);
  }
  EXPECT_EQ(found, places);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const bool has_failed = std::ranges::binary_search(places, i);
    ASSERT_EQ(answers[i].verdict, has_failed ? judge::verdict_of(failure.kind) : Verdict::yes) << i;
    if (has_failed) {
      ASSERT_TRUE(std::isnan(answers[i].toi_lower + answers[i].toi_upper + answers[i].tolerance));
    } else {
      ASSERT_EQ(answers[i].toi_lower, static_cast<double>(i) + 0.5);
    }
  }
}

constexpr double long_limit = 60.0;
/// The cost of a hang in seconds. Queries that do not hang take microseconds, and may wait for a
/// processor five times as long.
constexpr double hang_limit = 0.5;
const judge::Failure killed{.kind = judge::Fault::crash, .number = SIGKILL};
const judge::Failure hang{.kind = judge::Fault::hang};

/// The largest queries fill the shared memory several times, and other shapes follow them in the
/// same process.
TEST(SolverProcess, AnswersQueriesOfAllShapes) {
  const ScriptedMethod method;
  SolverProcess process(method);
  constexpr std::size_t count = 9000, deadly = 4096;
  for (const AnyShape shape : {AnyShape{ContactKind::edge_edge, greatest_degree, true},
                               {ContactKind::vertex_face, 2, false},
                               {ContactKind::edge_edge, 1, true},
                               {ContactKind::vertex_face, 3, false},
                               {ContactKind::vertex_face, 1, false}}) {
    std::vector<double> numbers(count * shape.numbers_of_query());
    for (std::size_t i = 0; i < count; ++i) {
      numbers[i * shape.numbers_of_query() + 1] = static_cast<double>(i);
    }
    numbers[deadly * shape.numbers_of_query()] = static_cast<double>(Act::dies);
    Outcome outcome{.answers = std::vector<Answer>(count), .run = {}, .output = {}};
    outcome.run = process.solve(AnyQueries(shape, numbers), outcome.answers, {.t_max = 0.5});
    expect_failures(outcome, killed, {deadly});
    for (std::size_t i = 0; i < count; ++i) {
      if (i == deadly) continue;
      ASSERT_EQ(outcome.answers[i].toi_upper, shape_number(shape));
    }
  }
}

/// The same process stays, as the method's memory shows.
TEST(SolverProcess, AsksOneProcessThatIsNotThisOne) {
  int calls = 0;
  const SpanMethod method([&](auto, std::span<Answer> answers, double tolerance) {
    for (Answer& answer : answers) {
      answer = {.verdict = Verdict::yes,
                .toi_lower = static_cast<double>(++calls),
                .toi_upper = static_cast<double>(::getpid()),
                .tolerance = tolerance};
    }
  });
  SolverProcess process(method);
  std::vector<Answer> first(10), second(10);
  static_cast<void>(process.solve(lines(numbered(10)), first, {.tolerance = 0.5}));
  static_cast<void>(process.solve(lines(numbered(10)), second, {.tolerance = 0.25}));
  EXPECT_EQ(second.back().toi_lower, 20.0);
  EXPECT_EQ(first.front().toi_upper, second.back().toi_upper);
  EXPECT_NE(first.front().toi_upper, static_cast<double>(::getpid()));
  EXPECT_EQ(first.back().tolerance, 0.5);
  EXPECT_EQ(second.back().tolerance, 0.25);
  EXPECT_EQ(calls, 0);
}

// ---- Failures -----------------------------------------------------------------------------------

/// What queries do, and what comes of it.
struct Event {
  const char* name;
  std::vector<Query> queries;
  judge::Failure failure = {};
  Places failed = {};
  std::uint64_t unplaced = 0;
  std::vector<double> limits = {0.0, long_limit};
};

TEST(SolverProcess, AnEndCostsOneQueryAndOneThatDoesNotRepeatNone) {
  const judge::Failure thrown{.kind = judge::Fault::exception, .what = "thrown by a solver"};
  const Places deadly{0, 100, 101, 1023, 1024, 2499}, slow{0, 7, 8, 29}, some{1500, 1501, 4999};
  std::vector<Query> mixed = with(5000, Act::dies_in_spans, {10, 3000});
  for (const std::size_t i : some) mixed[i] = scripted(Act::dies, i);
  for (const Event& event : std::vector<Event>{
           {"no query", {}},
           {"one", numbered(1)},
           {"many", numbered(9000)},
           {"deaths", with(2500, Act::dies, deadly), killed, deadly},
           {"one death", all_of(Act::dies, 1), killed, {0}},
           {"exceptions", with(2500, Act::throws, deadly), thrown, deadly},
           {"hangs", with(30, Act::burns, slow), hang, slow, 0, {hang_limit}},
           {"a death in a span", with(3000, Act::dies_in_spans, {1500}), {}, {}, 1},
           {"a death in the first process", with(20, Act::dies_once, {0}), {}, {}, 1},
           {"one alone", with(1, Act::dies_once, {0}), {}, {}, 1},
           {"deaths of both kinds", mixed, killed, some, 2}}) {
    SCOPED_TRACE(event.name);
    for (const double limit : event.limits) {
      expect_failures(run(event.queries, {.query_limit_seconds = limit}), event.failure,
                      event.failed, event.unplaced);
    }
  }
}

TEST(SolverProcess, MakesAProcessAgainThatEndsBeforeItsFirstQuery) {
  for (const std::uint64_t lost : {1U, 2U}) {
    expect_failures(run(numbered(20), {}, ScriptedMethod(lost)), {}, {});
  }
  const ScriptedMethod never_starts(std::numeric_limits<std::uint64_t>::max());
  expect_failures(run(numbered(4), {}, never_starts), killed, {0, 1, 2, 3});
}

/// A span of these never ends, and one of them takes no time, for certain. The spans become
/// shorter: 512, 64, 8, 1.
TEST(SolverProcess, ABatchThatTakesTooLongIsSearchedAndNotCharged) {
  tests::SharedCounter slow;
  const SpanMethod method([&](std::span<const Query> queries, std::span<Answer> answers, double) {
    if (queries.size() > 1) {
      slow.add();
      sleep_for_ever();
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
      answers[i] = {.verdict = Verdict::yes, .toi_lower = queries[i].coordinates[1] + 0.5};
    }
  });
  SolverProcess process(method, {.query_limit_seconds = hang_limit});
  const std::vector<Query> queries = numbered(700);
  Outcome outcome{.answers = std::vector<Answer>(queries.size()), .run = {}, .output = {}};
  outcome.run = process.solve(lines(queries), outcome.answers, {});
  expect_failures(outcome, {}, {});
  EXPECT_EQ(slow.value(), 3U);
}

TEST(SolverProcess, LeavesTheRestBehindManyLostChildren) {
  const Outcome outcome = run(all_of(Act::dies, 50), {.most_failures = 3});
  EXPECT_EQ(outcome.run.answered, 3U);
  EXPECT_EQ(outcome.run.failures.size(), 3U);
  // Exceptions do not count.
  EXPECT_EQ(run(all_of(Act::throws, 50), {.most_failures = 3}).run.answered, 50U);
}

TEST(SolverProcess, AStopIsObeyedInTheMidstOfAQuery) {
  for (const double limit : {0.0, 600.0}) {
    std::atomic<bool> stop = false;
    std::jthread stopper([&] {
      std::this_thread::sleep_for(50ms);
      stop = true;
    });
    const Outcome outcome =
        run(with(10, Act::hangs, {5}), {.query_limit_seconds = limit, .stop = &stop});
    EXPECT_LE(outcome.run.answered, 5U);
    EXPECT_TRUE(outcome.run.failures.empty());
  }
  std::atomic<bool> stop = false;
  EXPECT_EQ(run(numbered(10), {.stop = &stop}).run.answered, 10U);
}

TEST(SolverProcess, StopsAtItsTime) {
  const ScriptedMethod method;
  SolverProcess process(method);
  std::vector<Answer> answers(10);
  const SolverRun cut =
      process.solve(lines(with(10, Act::hangs, {5})), answers, {}, {.end = base::Deadline(0.1)});
  EXPECT_LE(cut.answered, 5U);
  EXPECT_TRUE(cut.failures.empty());
  // The next call has its full time.
  EXPECT_EQ(process.solve(lines(numbered(10)), answers, {}).answered, 10U);
}

TEST(SolverProcess, BeginsNoBatchBehindItsTime) {
  const ScriptedMethod method;
  SolverProcess process(method);
  std::vector<Answer> answers(2000);
  // Together they take longer than the time.
  const std::vector<Query> queries = with(2000, Act::works, {0, 1, 2, 3, 4, 5});
  const SolverRun cut =
      process.solve(lines(queries), answers, {}, {.begin = base::Deadline(6.0 * work_seconds)});
  EXPECT_EQ(cut.answered, 512U);
  EXPECT_TRUE(cut.failures.empty());
}

// ---- Limits -------------------------------------------------------------------------------------

TEST(SolverProcess, MayMakeThreads) {
  const SpanMethod method([](auto, std::span<Answer> answers, double) {
    std::jthread([&] {
      for (Answer& answer : answers) answer.verdict = Verdict::no;
    });
  });
  SolverProcess process(method);
  std::vector<Answer> answers(3);
  EXPECT_TRUE(process.solve(lines(numbered(3)), answers, {}).failures.empty());
  EXPECT_EQ(answers.back().verdict, Verdict::no);
}

#ifndef TOUCHSTONE_SANITIZED
TEST(SolverProcess, GetsAsMuchMemoryAsItMay) {
  constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30U;
  const auto gibibytes = [&](std::uint64_t limit) {
    return run(all_of(Act::allocates, 1), {.limits = {.memory_bytes = limit}})
        .answers.front()
        .tolerance;
  };
  EXPECT_EQ(gibibytes(gibibyte / 2), 0.0);
  EXPECT_EQ(gibibytes(3 * gibibyte + gibibyte / 2), 3.0);
  EXPECT_EQ(gibibytes(0), 64.0);
}
#endif

// ---- Output -------------------------------------------------------------------------------------

TEST(SolverProcess, DoesNotTakeWhatThisProcessHasYetToPrint) {
  testing::internal::CaptureStdout();
  std::printf("ours");
  const Outcome outcome = run(all_of(Act::prints, 1));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "ours");
  EXPECT_EQ(outcome.output.text.find("ours"), std::string::npos);
}

TEST(SolverProcess, KeepsTheBeginningOfALotAndNeverBlocks) {
  const Outcome outcome = run(all_of(Act::prints, 20'000));
  expect_failures(outcome, {}, {});
  EXPECT_EQ(outcome.output.text.size(), CapturedOutput::most_bytes);
  EXPECT_GT(outcome.output.dropped, 0U);
}

// ---- Time ---------------------------------------------------------------------------------------

/// Without what it had to search for a query that ends its process; but what a hang burnt counts.
TEST(SolverProcess, CountsProcessorTimeOfEveryQueryOnce) {
  std::vector<Query> queries = all_of(Act::works, 7);
  for (const bool is_deadly : {false, true}) {
    if (is_deadly) queries.push_back(scripted(Act::dies, 7));
    for (const double limit : {0.0, long_limit}) {
      const SolverRun solved = run(queries, {.query_limit_seconds = limit}).run;
      EXPECT_GE(solved.processor_seconds, 7 * work_seconds);
      EXPECT_LT(solved.processor_seconds, 10 * work_seconds);
      EXPECT_GE(solved.wall_seconds, 7 * work_seconds);
    }
  }
  EXPECT_GT(run(all_of(Act::burns, 1), {.query_limit_seconds = 0.5}).run.processor_seconds, 0.02);
}

/// A child is made, and asked no queries at first, which is for the method to load what it needs.
TEST(SolverProcess, DoesNotCountTheMakingOfAChild) {
  const SpanMethod method([](std::span<const Query> queries, std::span<Answer>, double) {
    if (queries.empty()) work();
  });
  SolverProcess process(method);
  std::vector<Answer> answers(3);
  const SolverRun solved = process.solve(lines(numbered(3)), answers, {});
  EXPECT_LT(solved.processor_seconds, work_seconds);
  EXPECT_LT(solved.wall_seconds, work_seconds);
}

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

// ---- A child of any work ------------------------------------------------------------------------

/// Waits for a message or the end.
ChildProcess::Event next(ChildProcess& child, std::string& message) {
  CapturedOutput output;
  for (;;) {
    const auto event = child.wait(ChildProcess::Seconds(60.0), message, output);
    if (event != ChildProcess::Event::none) return event;
  }
}

/// Standard descriptors, connection, lifeline, and the listed folder; no input, no core.
TEST(ChildProcess, HasAWorldOfItsOwn) {
  std::filesystem::path folder;
  {
    const TemporaryFolder its_own;
    folder = its_own.path();
    const std::ifstream of_parent("/proc/self/stat");
    ChildProcess child(
        [](const ChildChannel& channel) {
          std::ofstream("written") << "x";
          rlimit core{};
          ::getrlimit(RLIMIT_CORE, &core);
          char byte = 0;
          static_cast<void>(channel.send(fmt::format(
              "{} {} {} {} {}", std::filesystem::current_path().string(), open_descriptors(),
              core.rlim_cur, ::read(STDIN_FILENO, &byte, 1), ::getpgrp() == ::getpid())));
          throw 7;
        },
        {}, folder);
    std::string message;
    ASSERT_EQ(next(child, message), ChildProcess::Event::message);
    EXPECT_EQ(message, folder.string() + " 6 0 0 true");
    EXPECT_EQ(next(child, message), ChildProcess::Event::ended);
    CapturedOutput output;
    EXPECT_EQ(child.end(output).failure, (judge::Failure{.kind = judge::Fault::exit, .number = 1}));
    EXPECT_TRUE(std::filesystem::exists(folder / "written"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(ChildProcess, TellsWorkFromSleep) {
  const TemporaryFolder folder;
  ChildProcess busy(
      [](const ChildChannel& channel) {
        static_cast<void>(channel.send("up"));
        burn();
      },
      {}, folder.path());
  ChildProcess idle([](const ChildChannel& channel) { static_cast<void>(channel.receive()); }, {},
                    folder.path());
  std::string message;
  ASSERT_EQ(next(busy, message), ChildProcess::Event::message);
  EXPECT_TRUE(busy.is_runnable());
  while (busy.processor_seconds() < 0.01) std::this_thread::yield();
  // The child sleeps as soon as it gets there.
  while (idle.is_runnable()) std::this_thread::yield();
}

// ---- The process around it ----------------------------------------------------------------------

TEST(SolverProcess, LeavesNeitherChildrenNorDescriptors) {
  const std::ptrdiff_t before = open_descriptors();
  std::vector<Query> queries = with(10, Act::hangs, {3});
  queries[5] = scripted(Act::dies, 5);
  static_cast<void>(run(queries, {.query_limit_seconds = 0.1}));
  static_cast<void>(run(numbered(10)));
  EXPECT_EQ(open_descriptors(), before);
  errno = 0;
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(SolverProcess, NeitherWaitsForGrandchildrenNorLeavesThem) {
  // Orphans become children of this process, which can then see how they ended.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  // Once in the batch, and once alone.
  std::vector<Query> queries = with(10, Act::forks, {1, 2, 3});
  queries[9] = scripted(Act::dies, 9);
  expect_failures(run(queries, {.limits = {.may_fork = true}}), killed, {9});
  for (int orphans = 0; orphans < 6; ++orphans) {
    int status = 0;
    ASSERT_GT(::waitpid(-1, &status, 0), 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  }
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
}

TEST(SolverProcess, ThereMayBeOneInEachThread) {
  // The sanitizers' allocator, unlike the system's, is not prepared for a fork() beside other
  // threads: the child may wait for a lock that no thread of it holds.
  constexpr std::size_t count = tests::sanitizer_divisor > 1 ? 1 : 4;
  std::atomic<unsigned> right = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < count; ++thread) {
      threads.emplace_back([&right, thread] {
        for (std::size_t round = 0; round < 5; ++round) {
          const std::size_t deadly = 100 * thread + round;
          const Outcome outcome = run(with(1500, Act::dies, {deadly}),
                                      {.query_limit_seconds = round % 2 == 0 ? 0.0 : long_limit});
          expect_failures(outcome, killed, {deadly});
          right += outcome.run.failures.size() == 1 ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(right, 5 * count);
}

/// The life of the child depends on this process, not on the thread that made it.
TEST(SolverProcess, OutlivesTheThreadThatFirstAsked) {
  const ScriptedMethod method;
  SolverProcess process(method);
  std::vector<Answer> answers(10);
  std::jthread([&] { static_cast<void>(process.solve(lines(numbered(10)), answers, {})); }).join();
  const SolverRun solved = process.solve(lines(numbered(10)), answers, {});
  EXPECT_EQ(solved.answered, 10U);
  EXPECT_EQ(solved.unplaced_crashes, 0U);
}

std::atomic<unsigned> signals = 0;
extern "C" void count_signal(int) { ++signals; }

TEST(SolverProcess, DoesNotMindSignals) {
  struct sigaction action {
  }, old_action{};
  action.sa_handler = count_signal;
  ASSERT_EQ(::sigaction(SIGALRM, &action, &old_action), 0);
  const itimerval often{.it_interval = {0, 1000}, .it_value = {0, 1000}};
  ASSERT_EQ(::setitimer(ITIMER_REAL, &often, nullptr), 0);
  const Outcome outcome = run(with(10, Act::hangs, {4}), {.query_limit_seconds = hang_limit});
  const itimerval never{};
  ASSERT_EQ(::setitimer(ITIMER_REAL, &never, nullptr), 0);
  ASSERT_EQ(::sigaction(SIGALRM, &old_action, nullptr), 0);
  EXPECT_GT(signals, 0U);
  expect_failures(outcome, hang, {4});
}

TEST(SolverProcess, WorksWhereTheSystemReapsChildren) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const Outcome outcome = run(with(10, Act::dies, {4}));
  std::signal(SIGCHLD, before);
  // The signal is then unknown.
  expect_failures(outcome, {.kind = judge::Fault::crash}, {4});
}

TEST(SolverProcess, DiesWithItsParent) {
  // The orphan becomes a child of this process, which can then see how it ended.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  tests::SharedCounter number;
  // A killed process leaves its temporary folder behind.
  const TemporaryFolder folder;
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::setenv("TMPDIR", folder.path().c_str(), 1);
    const std::vector<Query> queries = numbered(1);
    std::vector<Answer> answers(1);
    const SpanMethod method([&](auto, auto, double) {
      number.add(static_cast<std::uint64_t>(::getpid()));
      sleep_for_ever();
    });
    static_cast<void>(SolverProcess(method).solve(lines(queries), answers, {}));
    ::_exit(0);
  }
  ASSERT_GT(parent, 0);
  while (number.value() == 0) std::this_thread::sleep_for(1ms);
  ASSERT_EQ(::kill(parent, SIGKILL), 0);
  ASSERT_EQ(::waitpid(parent, nullptr, 0), parent);

  const auto grandchild = static_cast<pid_t>(number.value());
  int status = 0;
  ASSERT_EQ(::waitpid(grandchild, &status, 0), grandchild);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
}

}  // namespace
}  // namespace touchstone::verify::solvers::solver_process_test
