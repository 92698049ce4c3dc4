#include "verify/solvers/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <optional>
#include <string>
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
    return {.queries = {ContactKind::edge_edge, queries}, .source = source, .indices = indices};
  }
};

/// The answer yes, with the number as the time.
Answer echo(AnyKind, const Query& query) {
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
  const FunctionMethod method([](AnyKind kind, const Query& query) {
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

constexpr auto vf = ContactKind::vertex_face;

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
AnyQueries numbered(const AnyShape& shape, std::vector<double>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); i += shape.numbers_of_query()) {
    numbers[i + 1] = 100.0 + static_cast<double>(i / shape.numbers_of_query());
  }
  return {shape, numbers};
}

TEST(Solver, RecordedAnswersAreLookedUpForAllShapesInDoubles) {
  const RecordedAnswers none;
  const std::uint64_t index = 0;
  for (const AnyShape& shape : {AnyShape{vf, 3}, {vf, 1}, {vf, 2, true}, {vf, 8}}) {
    const std::vector<double> numbers(shape.numbers_of_query());
    const SolveRequest request{.queries = AnyQueries(shape, numbers), .indices = {&index, 1}};
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
      [](const AnyQueries& one) -> Answer {
        if (one.is_rational && one.numbers[1] == 101.0) {
          std::cerr << "asked";
          std::raise(SIGKILL);
        }
        return {.verdict = Verdict::no};
      },
      {.name = "lethal", .terms = {.most_degree = 3, .rational = true}});
  const auto solver = solver_in_children(method, {}, {});
  constexpr AnyShape rational{.kind = vf, .degree = 2, .is_rational = true},
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
    const SolveReply other = solver->solve({.queries = AnyQueries(polynomial, numbers)}, answers);
    EXPECT_TRUE(other.failures.empty());
    EXPECT_EQ(answers[1].verdict, Verdict::no);
  }
}

}  // namespace
}  // namespace touchstone::verify::solvers::solver_test
