#include "verify/report/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/support/methods.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::report::stability_test {
namespace {

using fast::Answer;
using fast::Verdict;
using generate::hardness_from_name;
using tests::FunctionMethod;
using tests::true_answer;

constexpr std::uint64_t seed = 5, count = 8;

/// Measures queries of one hardness by a function as the method.
StabilityResult measure(const FunctionMethod& method, StabilityOptions options = {}) {
  const auto solver = solvers::solver_in_process(method, {});
  options.hardnesses = {&hardness_from_name("distance")};
  options.seed = seed;
  options.count = count;
  options.certify.solvers = {solver.get()};
  return measure_stability(options);
}

/// A random bit that depends only on the query.
bool coin(const Query& query) {
  return generate::mix(std::bit_cast<std::uint64_t>(query.coordinates[0])) % 2 == 0;
}

TEST(MeasureStability, HasACellForEachLevelAndKindInOrder) {
  const StabilityResult result = measure(FunctionMethod(true_answer));
  EXPECT_EQ(result.seed, seed);
  EXPECT_EQ(result.count, count);
  EXPECT_FALSE(result.total.interrupted);
  const generate::Hardness& distance = hardness_from_name("distance");
  ASSERT_EQ(result.cells.size(), 22U);
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const auto& [sort, judged] = result.cells[i];
    EXPECT_EQ(sort.hardness, &distance);
    EXPECT_EQ(sort.kind, i < 11 ? Kind::vertex_face : Kind::edge_edge);
    EXPECT_EQ(sort.level, distance.levels.at(i % 11));
    EXPECT_EQ(judged.queries, count);
    EXPECT_EQ(judged.collisions, count / 2);
    EXPECT_EQ(judged.labels, count);
  }
  EXPECT_EQ(result.total.queries, 22 * count);
  EXPECT_FALSE(jobs::has_wrong_answers(result.total));
  EXPECT_TRUE(std::ranges::none_of(
      marks_of(result), [](const StabilityMark& mark) { return mark.worst.has_value(); }));
}

/// A method that is always wrong in one way, and the worst that is said of it in each cell, with
/// the rate among those queries where it is possible.
TEST(MeasureStability, PlantedMethodsHaveExactlyTheirWorstFaultsAndRates) {
  const auto always = [](Verdict verdict) {
    return [verdict](Kind, const Query&) { return Answer{.verdict = verdict}; };
  };
  // Times that exclude the true one are worse than the errors and false positives beside them.
  const auto late = [](Kind kind, const Query& query) {
    Answer right = true_answer(kind, query);
    if (right.verdict == Verdict::no) right.verdict = coin(query) ? Verdict::error : Verdict::yes;
    if (right.toi_lower > 0.0) right.toi_lower = right.toi_upper = 2.0;
    return right;
  };
  struct Planted {
    std::function<Answer(Kind, const Query&)> method;
    judge::Fault worst;
  };
  for (const auto& [method, worst] :
       std::vector<Planted>{{always(Verdict::no), judge::Fault::false_negative},
                            {always(Verdict::yes), judge::Fault::false_positive},
                            {always(Verdict::undecided), judge::Fault::false_positive},
                            {always(Verdict::error), judge::Fault::crash},
                            {late, judge::Fault::late_toi}}) {
    for (const StabilityMark& mark : marks_of(measure(FunctionMethod(method)))) {
      EXPECT_EQ(mark.worst, worst);
      EXPECT_EQ(mark.worst_rate, 1.0);
    }
  }
}

/// The method is wrong on a known half of the queries, counted one by one.
TEST(MeasureStability, CountsWhatIsWrongInEachCell) {
  const StabilityResult result = measure(FunctionMethod([](Kind kind, const Query& query) {
    const Answer right = true_answer(kind, query);
    if (!coin(query)) return right;
    return Answer{.verdict = right.verdict == Verdict::yes ? Verdict::no : Verdict::yes};
  }));
  for (const auto& [sort, judged] : result.cells) {
    std::uint64_t missed = 0, invented = 0;
    for (std::uint64_t index = 0; index < count; ++index) {
      const data::RecordedQuery made = generate::make_hard_query(sort, seed, index);
      if (coin(made.query.straight())) ++(made.collides.value() ? missed : invented);
    }
    EXPECT_EQ(rate_of(judge::Fault::false_negative, judged, 0), static_cast<double>(missed) / 4.0);
    EXPECT_EQ(rate_of(judge::Fault::false_positive, judged, 0),
              static_cast<double>(invented) / 4.0);
  }
}

TEST(MeasureStability, AStopLeavesWhatWasJudged) {
  std::atomic<bool> stop = false;
  double latest = 0.0;
  StabilityOptions options;
  options.certify.stop = &stop;
  options.certify.on_progress = [&](double fraction) {
    EXPECT_GE(fraction, latest);
    latest = fraction;
    if (fraction > 0.4) stop = true;
  };
  const StabilityResult result = measure(FunctionMethod(true_answer), options);
  EXPECT_TRUE(result.total.interrupted);
  EXPECT_GE(result.cells.size(), 8U);
  EXPECT_LE(result.cells.size(), 11U);
  EXPECT_EQ(result.cells.size() + result.unjudged_cells, 22U);
}

}  // namespace
}  // namespace touchstone::verify::report::stability_test
