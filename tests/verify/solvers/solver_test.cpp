#include "verify/solvers/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/solvers/hang_limits.hpp"

// A separate program, because it makes processes, which copy no threads.

namespace touchstone::verify::solvers::solver_test {
namespace {

using fast::Answer;
using fast::Promise;
using fast::Verdict;
using tests::FunctionMethod;

/// Queries whose first coordinate is their number in the source, from 100 on.
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

  [[nodiscard]] SolveRequest request() const {
    return {.queries = {Kind::edge_edge, queries}, .source = source, .indices = indices};
  }
};

/// The answer yes, with the number as the time.
Answer echo(Kind, const Query& query) {
  return {.verdict = Verdict::yes, .toi_lower = query.coordinates[0]};
}

struct Outcome {
  std::vector<Answer> answers;
  SolveReply reply;

  [[nodiscard]] double nanoseconds() const { return reply.time.value().processor_nanoseconds; }
};

Outcome ask(const Solver& solver, std::uint64_t count) {
  const Numbered numbered(count);
  Outcome outcome{.answers = std::vector<Answer>(count), .reply = {}};
  outcome.reply = solver.solve_timed(numbered.request(), outcome.answers);
  return outcome;
}

TEST(Solver, TimeIsTheProcessorTimeOfTheMethod) {
  const FunctionMethod burner(tests::slow_no);
  EXPECT_GE(ask(*solver_in_process(burner, {}), 10).nanoseconds(), 10e6);
  EXPECT_GE(ask(*solver_in_children(burner, {}, {}), 10).nanoseconds(), 10e6);
}

TEST(Solver, AnExceptionCostsOneQuery) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    if (query.coordinates[0] == 103.0) throw std::runtime_error("thrown by a solver");
    return echo(kind, query);
  });
  const Outcome outcome = ask(*solver_in_process(method, {}), 10);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(outcome.answers[i].verdict, i == 3 ? Verdict::error : Verdict::yes) << i;
  }
  ASSERT_EQ(outcome.reply.failures.size(), 1U);
  EXPECT_EQ(outcome.reply.failures[0].position, 3U);
  EXPECT_EQ(to_text(outcome.reply.failures[0].failure), "exception: thrown by a solver");
}

// ---- In child processes -------------------------------------------------------------------------

constexpr auto vf = Kind::vertex_face;

/// The rest of their kind in their source is left out, and no other queries.
TEST(Solver, LeavesOutQueriesBehindThreeHangsOfTheirSort) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    for (; query.coordinates[0] >= 105.0;) std::this_thread::sleep_for(std::chrono::hours(1));
    return echo(kind, query);
  });
  const auto solver = solver_in_children(method, {}, {.query_limit_seconds = 0.5});
  const Outcome outcome = ask(*solver, 20);
  ASSERT_EQ(outcome.reply.failures.size(), 3U);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(outcome.answers[i].verdict, i < 5 ? Verdict::yes : Verdict::undecided) << i;
    const auto why = i < 8 ? std::nullopt : std::optional(judge::Unasked::left_out);
    EXPECT_EQ(outcome.reply.why_unasked(i), why) << i;
  }
  EXPECT_FALSE(outcome.reply.stopped);
  Numbered other(3);
  other.source = "another";
  std::vector<Answer> answers(3);
  EXPECT_TRUE(solver->solve(other.request(), answers).unasked.empty());
}

TEST(HangLimits, ShrinkAfterThreeHangsAndEndTheirSort) {
  HangLimits limits(10.0);
  for (int hang = 0; hang < 6; ++hang) {
    EXPECT_EQ(limits.seconds(), hang < 3 ? 10.0 : 1.0) << hang;
    EXPECT_EQ(limits.is_over("a"), hang >= 5) << hang;
    limits.add(hang % 2 == 0 ? "a" : "b");
  }
  EXPECT_FALSE(limits.is_over("c"));
  EXPECT_EQ(HangLimits(0.0).seconds(), 0.0);
}

/// A sort at which every query hangs costs a logarithmic number of hangs.
TEST(HangLimits, AskFewOfASortThatAlwaysHangs) {
  HangLimits limits(1.0);
  int asked = 0;
  for (int i = 0; i < 100'000; ++i) {
    if (limits.leaves_out("a")) continue;
    ++asked;
    limits.add("a");
  }
  EXPECT_GT(asked, 3 * 10);
  EXPECT_LT(asked, 3 * 18);
}

// ---- Shapes -------------------------------------------------------------------------------------

/// Queries whose second number is 100 more than their place.
Queries numbered(const QueryShape& shape, std::vector<double>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); i += shape.numbers_of_query()) {
    numbers[i + 1] = 100.0 + static_cast<double>(i / shape.numbers_of_query());
  }
  return {shape, numbers};
}

/// Terms are about shapes, too: a method of curves is not asked the lines, nor one of lines the
/// curves, in this process and in children.
TEST(Solver, AsksNoShapeOutsideTheTerms) {
  const auto function = [](const Queries& one) -> Answer {
    return {.verdict = Verdict::yes, .toi_lower = one.numbers[1]};
  };
  const FunctionMethod curves(function,
                              {.name = "curves", .terms = {.straight = false, .most_degree = 2}}),
      lines(function, {.name = "lines"});
  constexpr QueryShape degree_2{.kind = vf, .degree = 2}, straight{.kind = vf};
  for (const bool in_children : {false, true}) {
    for (const QueryShape& shape : {degree_2, straight}) {
      std::vector<double> numbers(3 * shape.numbers_of_query());
      const SolveRequest request{.queries = numbered(shape, numbers)};
      for (const FunctionMethod* method : {&curves, &lines}) {
        const auto solver =
            in_children ? solver_in_children(*method, {}, {}) : solver_in_process(*method, {});
        std::vector<Answer> answers(3);
        const SolveReply reply = solver->solve(request, answers);
        const bool answered = (method == &lines) == shape.is_straight();
        EXPECT_EQ(reply.unasked.size(), answered ? 0U : 3U);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_EQ(answers[i].verdict, answered ? Verdict::yes : Verdict::undecided);
          if (answered) {
            EXPECT_EQ(answers[i].toi_lower, 100.0 + static_cast<double>(i));
          } else {
            EXPECT_EQ(reply.why_unasked(i), judge::Unasked::outside);
          }
        }
      }
    }
  }
}

TEST(Solver, RecordedAnswersAreLookedUpForAllShapesInDoubles) {
  const RecordedAnswers none;
  const std::uint64_t index = 0;
  for (const QueryShape& shape : {QueryShape{vf, 3}, {vf, 1}, {vf, 2, true}, {vf, 8}}) {
    const std::vector<double> numbers(shape.numbers_of_query());
    const SolveRequest request{.queries = Queries(shape, numbers), .indices = {&index, 1}};
    for (const bool is_float : {false, true}) {
      const auto solver = recorded_solver("a.csv", none, {.float_coordinates = is_float});
      std::vector<Answer> answers(1);
      EXPECT_EQ(solver->solve(request, answers).why_unasked(0), is_float && !shape.is_straight()
                                                                    ? judge::Unasked::outside
                                                                    : judge::Unasked::missing);
    }
  }
}

/// A query that ended its process is not asked again. The same points with another distance are
/// another query, and so are curves of degree 3, which have as many numbers as rational ones of 2.
TEST(Solver, ALostQueryIsThatOfItsShapeAndSeparation) {
  const FunctionMethod method(
      [](const Queries& one) -> Answer {
        if (one.is_rational && one.numbers[1] == 101.0) {
          std::cerr << "asked";
          std::raise(SIGKILL);
        }
        return {.verdict = Verdict::no};
      },
      {.name = "lethal", .terms = {.most_degree = 3, .rational = true}});
  const auto solver = solver_in_children(method, {}, {});
  constexpr QueryShape rational{.kind = vf, .degree = 2, .is_rational = true},
      polynomial{.kind = vf, .degree = 3};
  std::vector<double> numbers(4 * rational.numbers_of_query());
  SolveRequest request{.queries = numbered(rational, numbers)};
  for (const auto& [distance, is_known] :
       {std::pair(0.0, false), {0.0, true}, {0.25, false}, {0.0, true}}) {
    request.separation = {.distance = distance, .norm = Norm::l2};
    std::vector<Answer> answers(4);
    const SolveReply reply = solver->solve(request, answers);
    ASSERT_EQ(reply.failures.size(), 1U);
    EXPECT_EQ(reply.failures[0].position, 1U);
    EXPECT_EQ(to_text(reply.failures[0].failure), "crash: SIGKILL");
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(answers[i].verdict, i == 1 ? Verdict::error : Verdict::no) << i;
    }
    EXPECT_EQ(solver->take_output().text.empty(), is_known);
    const SolveReply other = solver->solve({.queries = Queries(polynomial, numbers)}, answers);
    EXPECT_TRUE(other.failures.empty());
    EXPECT_EQ(answers[1].verdict, Verdict::no);
  }
}

}  // namespace
}  // namespace touchstone::verify::solvers::solver_test
