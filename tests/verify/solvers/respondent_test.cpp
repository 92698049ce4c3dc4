#include "verify/solvers/respondent.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/methods.hpp"
#include "verify/run/stream.hpp"
#include "verify/run/thread_clock.hpp"

namespace touchstone::verify::respondent_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;

/// Queries whose first coordinate is their number in the source, which is 100 and up.
struct Numbered {
  std::string source = "a,file";
  std::vector<Query> queries;
  std::vector<std::uint64_t> indices;

  explicit Numbered(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      indices.push_back(100 + i);
      queries.push_back({{static_cast<double>(100 + i)}});
    }
  }

  [[nodiscard]] Questions questions() const {
    return {.source = source, .kind = Kind::edge_edge, .queries = queries, .indices = indices};
  }
};

/// Yes, the number as the time.
Answer echo(Kind, const Query& query) {
  return {.verdict = Verdict::yes, .toi_lower = query.coordinates[0]};
}

struct Outcome {
  std::vector<Answer> answers;
  Response response;
};

Outcome ask(const Respondent& respondent, std::uint64_t count) {
  const Numbered numbered(count);
  Outcome outcome{.answers = std::vector<Answer>(count), .response = {}};
  outcome.response = respondent.answer(numbered.questions(), outcome.answers);
  return outcome;
}

TEST(Respondent, InProcessAndIsolatedGiveTheMethodsAnswers) {
  const FunctionMethod method(echo, Promise::conservative, "echo");
  const auto in_process = respond_in_process(method, {}),
             isolated = respond_isolated(method, {}, {});
  for (const Respondent* respondent : {in_process.get(), isolated.get()}) {
    EXPECT_EQ(respondent->name(), "echo");
    EXPECT_EQ(respondent->promise(), Promise::conservative);
    EXPECT_TRUE(respondent->timed());
    const Outcome outcome = ask(*respondent, 50);
    EXPECT_TRUE(outcome.response.missing.empty());
    EXPECT_GT(outcome.response.nanoseconds, 0.0);
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_EQ(outcome.answers[i].verdict, Verdict::yes);
      EXPECT_EQ(outcome.answers[i].toi_lower, 100.0 + static_cast<double>(i));
    }
  }
}

TEST(Respondent, TimeIsTheProcessorTimeOfTheMethod) {
  const FunctionMethod burner([](Kind, const Query&) -> Answer {
    const double start = thread_nanoseconds();
    while (thread_nanoseconds() < start + 2e6) continue;
    return {};
  });
  EXPECT_GE(ask(*respond_in_process(burner, {}), 10).response.nanoseconds, 20e6);
  EXPECT_GE(ask(*respond_isolated(burner, {}, {}), 10).response.nanoseconds, 20e6);
}

TEST(Respondent, ItIsHeldToWhatItIsToldTo) {
  const FunctionMethod method(echo);
  const auto respondent = respond_in_process(method, {});
  respondent->hold_to(Promise::exact);
  EXPECT_EQ(respondent->promise(), Promise::exact);
}

TEST(Respondent, AnExceptionCostsOneQuery) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    if (query.coordinates[0] == 103.0) throw std::runtime_error("thrown by a solver");
    return echo(kind, query);
  });
  const Outcome outcome = ask(*respond_in_process(method, {}), 10);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(outcome.answers[i].verdict, i == 3 ? Verdict::error : Verdict::yes) << i;
  }
  ASSERT_EQ(outcome.response.failures.size(), 1U);
  EXPECT_EQ(outcome.response.failures[0].position, 3U);
  EXPECT_EQ(to_text(outcome.response.failures[0].failure), "exception: thrown by a solver");
}

TEST(Respondent, ACrashAndAHangCostAQueryEachWhenIsolated) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    if (query.coordinates[0] == 103.0) std::raise(SIGKILL);
    while (query.coordinates[0] == 105.0) std::this_thread::sleep_for(std::chrono::seconds(1));
    return echo(kind, query);
  });
  const Outcome outcome = ask(*respond_isolated(method, {}, {.query_limit_seconds = 0.5}), 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const Verdict expected = i == 3 ? Verdict::error : (i == 5 ? Verdict::undecided : Verdict::yes);
    EXPECT_EQ(outcome.answers[i].verdict, expected) << i;
  }
  ASSERT_EQ(outcome.response.failures.size(), 2U);
  EXPECT_EQ(outcome.response.failures[0].position, 3U);
  EXPECT_EQ(to_text(outcome.response.failures[0].failure), "crash: SIGKILL");
  EXPECT_EQ(outcome.response.failures[1].position, 5U);
  EXPECT_EQ(to_text(outcome.response.failures[1].failure), "hang");
}

TEST(Respondent, RecordedAnswersAreLookedUpBySourceKindAndIndex) {
  const auto path = std::filesystem::path(::testing::TempDir()) /
                    ("touchstone_respondent_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path) << answers_header()
                      << answer_row("a,file", 102, Kind::edge_edge, {.verdict = Verdict::error})
                      << answer_row("a,file", 100, Kind::edge_edge,
                                    {.verdict = Verdict::yes, .toi_lower = 0.25})
                      << answer_row("a,file", 101, Kind::vertex_face, {.verdict = Verdict::no})
                      << answer_row("other", 101, Kind::edge_edge, {.verdict = Verdict::no});
  const RecordedAnswers answers = load_answers(path);
  std::filesystem::remove(path);
  const auto respondent = respond_recorded("answers", answers);
  EXPECT_EQ(respondent->name(), "answers");
  EXPECT_EQ(respondent->promise(), Promise::none);
  EXPECT_FALSE(respondent->timed());
  const Outcome outcome = ask(*respondent, 4);
  EXPECT_EQ(outcome.response.missing, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(outcome.response.nanoseconds, 0.0);
  EXPECT_EQ(outcome.answers[0].verdict, Verdict::yes);
  EXPECT_EQ(outcome.answers[0].toi_lower, 0.25);
  EXPECT_EQ(outcome.answers[2].verdict, Verdict::error);
  ASSERT_EQ(outcome.response.failures.size(), 1U);
  EXPECT_EQ(outcome.response.failures[0].position, 2U);
  EXPECT_EQ(outcome.response.failures[0].failure.kind, FailureKind::no_verdict);
}

TEST(Respondent, SpansAreShortForSlowAndLongForFastSolvers) {
  const FunctionMethod slow([](Kind, const Query&) -> Answer {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return {};
  });
  const FunctionMethod fast_one(echo);
  const auto slow_respondent = respond_in_process(slow, {});
  const auto fast_respondent = respond_in_process(fast_one, {});
  EXPECT_EQ(fast_respondent->good_span(), 1U) << "not known yet";
  static_cast<void>(ask(*slow_respondent, 4));
  static_cast<void>(ask(*fast_respondent, 1000));
  EXPECT_LE(slow_respondent->good_span(), 2U);
  EXPECT_GE(fast_respondent->good_span(), 1000U);
}

TEST(Respondent, TheMakingOfChildProcessesDoesNotShortenSpans) {
  const FunctionMethod method(echo);
  const auto isolated = respond_isolated(method, {}, {});
  // What fork() costs grows with the memory of the process.
  const std::vector<char> ballast(std::size_t{1} << 29U, 1);
  EXPECT_EQ(ballast.back(), 1);
  static_cast<void>(ask(*isolated, 16));
  EXPECT_GE(isolated->good_span(), 1000U);
}

TEST(Respondent, OneChildProcessAnswersCallAfterCall) {
  const FunctionMethod method([](Kind, const Query&) {
    return Answer{.verdict = Verdict::yes, .toi_lower = static_cast<double>(getpid())};
  });
  const auto isolated = respond_isolated(method, {}, {});
  const double first = ask(*isolated, 3).answers.front().toi_lower;
  EXPECT_NE(first, static_cast<double>(getpid()));
  EXPECT_EQ(ask(*isolated, 3).answers.back().toi_lower, first);
}

TEST(Respondent, KeepsWhatItsProcessesPrint) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    std::printf("asked %g\n", query.coordinates[0]);
    return echo(kind, query);
  });
  const auto isolated = respond_isolated(method, {}, {});
  static_cast<void>(ask(*isolated, 2));
  EXPECT_EQ(isolated->output().text, "asked 100\nasked 101\n");
  static_cast<void>(ask(*isolated, 1));
  EXPECT_EQ(isolated->output().text, "asked 100\nasked 101\nasked 100\n");
  EXPECT_EQ(respond_in_process(method, {})->output().text, "");
}

TEST(Respondent, SaysWhatItsChildProcessesDid) {
  const pid_t parent = getpid();
  int calls = 0;  // of each process
  const FunctionMethod dies_late([&calls, parent](Kind kind, const Query& query) {
    if (getpid() != parent && ++calls == 1500) std::raise(SIGKILL);
    return echo(kind, query);
  });
  const Outcome outcome = ask(*respond_isolated(dies_late, {}, {}), Block::size);
  EXPECT_EQ(outcome.response.unplaced_crashes, 1U);
  EXPECT_FALSE(outcome.response.stopped);
  EXPECT_EQ(outcome.answers.back().verdict, Verdict::yes);

  const std::atomic<bool> stop = true;
  const FunctionMethod hangs([](Kind, const Query&) -> Answer {
    for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
  });
  EXPECT_TRUE(ask(*respond_isolated(hangs, {}, {.stop = &stop}), 10).response.stopped);
}

TEST(Respondent, MayBeCalledAnythingElse) {
  const FunctionMethod method(echo, Promise::conservative, "echo");
  const auto respondent = respond_in_process(method, {});
  respondent->call("echo (2)");
  EXPECT_EQ(respondent->name(), "echo (2)");
}

}  // namespace
}  // namespace touchstone::verify::respondent_test
