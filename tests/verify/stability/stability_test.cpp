#include "verify/stability/stability.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "tests/support/methods.hpp"
#include "verify/generate/random_stream.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::stability::stability_test {
namespace {

using fast::Answer;
using fast::Verdict;
using tests::FunctionMethod;
using tests::true_answer;

constexpr std::uint64_t count = 8;

/// Measures queries of one hardness by a function as the method.
StabilityResult measure(const FunctionMethod& method, const StabilityOptions& base = {}) {
  const auto solver = solvers::solver_in_process(method, {});
  StabilityOptions options = base;
  options.seed = 5;
  options.count = count;
  options.solvers = {solver.get()};
  return measure_stability({&hardness_from_name("distance")}, options);
}

/// A random bit that depends only on the query.
bool coin(const Query& query) {
  return generate::mix(std::bit_cast<std::uint64_t>(query.coordinates[0])) % 2 == 0;
}

Answer answer(Verdict verdict) { return {.verdict = verdict}; }

TEST(MeasureStability, HasACellForEachLevelAndKindInOrder) {
  const StabilityResult result = measure(FunctionMethod(true_answer));
  EXPECT_EQ(result.seed, 5U);
  EXPECT_EQ(result.count, count);
  EXPECT_FALSE(result.total.interrupted);
  const Hardness& distance = hardness_from_name("distance");
  ASSERT_EQ(result.cells.size(), 22U);
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const StabilityCell& cell = result.cells[i];
    EXPECT_EQ(cell.hardness, &distance);
    EXPECT_EQ(cell.kind, i < 11 ? Kind::vertex_face : Kind::edge_edge);
    EXPECT_EQ(cell.level, distance.levels.at(i % 11));
    EXPECT_EQ(cell.judged.queries, count);
    EXPECT_EQ(cell.judged.collisions, count / 2);
    EXPECT_EQ(cell.judged.labels, count);
    EXPECT_EQ(cell.judged.label_mismatches, 0U);
    EXPECT_FALSE(outcome_of(cell.judged, 0).worst);
  }
  EXPECT_EQ(result.total.queries, 22 * count);
  EXPECT_FALSE(has_wrong_answers(result));
}

TEST(MeasureStability, PlantedMethodsHaveExactlyTheirRates) {
  const FunctionMethod never([](Kind, const Query&) { return answer(Verdict::no); });
  const FunctionMethod always([](Kind, const Query&) { return answer(Verdict::yes); });
  const FunctionMethod unsure([](Kind, const Query&) { return answer(Verdict::undecided); });
  const FunctionMethod broken([](Kind, const Query&) { return answer(Verdict::error); });
  for (const auto& [method, fault] : {std::pair{&never, judge::Fault::false_negative},
                                      std::pair{&always, judge::Fault::false_positive},
                                      std::pair{&unsure, judge::Fault::false_positive},
                                      std::pair{&broken, judge::Fault::crash}}) {
    const StabilityResult result = measure(*method);
    for (const StabilityCell& cell : result.cells) {
      const Outcome outcome = outcome_of(cell.judged, 0);
      ASSERT_TRUE(outcome.worst);
      EXPECT_EQ(*outcome.worst, fault);
      EXPECT_EQ(outcome.rate, 1.0);
      EXPECT_EQ(rate_of(judge::Fault::late_toi, cell.judged, 0), 0.0);
    }
  }
}

/// The method is wrong on a known half of the queries, counted one by one.
TEST(MeasureStability, CountsWhatIsWrongInEachCell) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    const Answer right = true_answer(kind, query);
    if (!coin(query)) return right;
    return answer(right.verdict == Verdict::yes ? Verdict::no : Verdict::yes);
  });
  const StabilityResult result = measure(method);
  for (const StabilityCell& cell : result.cells) {
    std::uint64_t missed = 0, invented = 0;
    for (std::uint64_t index = 0; index < count; ++index) {
      const HardQuery made = make_hard_query(
          {.hardness = cell.hardness, .level = cell.level, .kind = cell.kind}, 5, index);
      if (coin(made.query.straight())) ++(made.collides ? missed : invented);
    }
    EXPECT_EQ(rate_of(judge::Fault::false_negative, cell.judged, 0),
              static_cast<double>(missed) / 4.0);
    EXPECT_EQ(rate_of(judge::Fault::false_positive, cell.judged, 0),
              static_cast<double>(invented) / 4.0);
  }
}

TEST(MeasureStability, TimesThatExcludeTheTrueOneAreWorseThanErrorsAndFalsePositives) {
  const FunctionMethod late([](Kind kind, const Query& query) {
    Answer right = true_answer(kind, query);
    if (right.verdict == Verdict::no) right.verdict = coin(query) ? Verdict::error : Verdict::yes;
    if (right.toi_lower > 0.0) right.toi_lower = right.toi_upper = 2.0;
    return right;
  });
  const StabilityResult result = measure(late);
  for (const StabilityCell& cell : result.cells) {
    const Outcome outcome = outcome_of(cell.judged, 0);
    EXPECT_EQ(outcome.worst, judge::Fault::late_toi);
    EXPECT_EQ(outcome.rate, 1.0);
  }
}

/// The queries and their truth are about the requested distance.
TEST(MeasureStability, TakesASeparation) {
  const auto certified = solvers::solver_in_process(solvers::find_method("certified"), {});
  const StabilityResult result = measure_stability(
      {&hardness_from_name("scale")}, {.separation = {.distance = 0.01, .norm = Norm::l2},
                                       .count = count,
                                       .solvers = {certified.get()}});
  EXPECT_FALSE(has_wrong_answers(result));
  EXPECT_EQ(result.total.collisions, result.total.queries / 2);
  EXPECT_EQ(result.total.labels, result.total.queries) << "labels are about the same separation";
  for (const StabilityCell& cell : result.cells) {
    EXPECT_EQ(cell.judged.separation,
              separation_at(*cell.hardness, cell.level, {.distance = 0.01, .norm = Norm::l2}));
  }
  EXPECT_THROW(
      (void)measure_stability({&hardness_from_name("scale")}, {.separation = {.distance = 1e9}}),
      std::invalid_argument);
}

TEST(MeasureStability, IsTheSameForAnyNumberOfThreads) {
  const FunctionMethod method([](Kind kind, const Query& query) {
    return coin(query) ? answer(Verdict::undecided) : true_answer(kind, query);
  });
  const StabilityResult one = measure(method, {.threads = 1});
  const StabilityResult three = measure(method, {.threads = 3});
  ASSERT_EQ(one.cells.size(), three.cells.size());
  for (std::size_t i = 0; i < one.cells.size(); ++i) {
    const judge::Judgement& a = one.cells[i].judged.methods.at(0).judgement;
    const judge::Judgement& b = three.cells[i].judged.methods.at(0).judgement;
    EXPECT_EQ(a.faults, b.faults);
    EXPECT_EQ(a.undecided(), b.undecided());
    ASSERT_EQ(a.toi_errors.count(), b.toi_errors.count());
    if (a.toi_errors.count() != 0) {
      EXPECT_EQ(a.toi_errors.max(), b.toi_errors.max());
    }
  }
}

TEST(MeasureStability, AStopLeavesWhatWasJudged) {
  std::atomic<bool> stop = false;
  double latest = 0.0;
  StabilityOptions options;
  options.stop = &stop;
  options.on_progress = [&](double fraction) {
    EXPECT_GE(fraction, latest);
    latest = fraction;
    if (fraction > 0.4) stop = true;
  };
  const StabilityResult result = measure(FunctionMethod(true_answer), options);
  EXPECT_TRUE(result.total.interrupted);
  EXPECT_GE(result.cells.size(), 8U);
  EXPECT_LE(result.cells.size(), 11U);
}

}  // namespace
}  // namespace touchstone::verify::stability::stability_test
