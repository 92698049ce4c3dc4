/// \file
/// The published methods side by side: the answers of each to the printed queries and to simple
/// ones, the options that it uses, and its misses and false positives on the public data. (The file
/// named after a method tests its known defects.)

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/baselines.hpp"
#include "verify/baselines/baselines.hpp"

namespace touchstone::baselines::baselines_test {
namespace {

using fast::Promise;
using fast::Verdict;
using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// An answer to a printed query: a verdict, and the bounds of its toi_lower.
struct Said {
  Verdict verdict;
  double from = -infinity, to = infinity;
};

/// Misses and false positives on the public data of a folder.
struct Wrong {
  int missed_faces, invented_faces, missed_edges, invented_edges;
};

struct Baseline {
  std::string_view name;
  std::unique_ptr<fast::Method> (*make)();
  Promise promise;
  Said hourglass, inflection, coplanar;
  bool counts_up_to_t_max;
  Wrong handcrafted, simulation;
  fast::MethodOptions on_public_data = {};
  std::uint64_t stride = 1;
};

/// The parts of a row, one after the other.
Baseline row(std::string_view name, std::unique_ptr<fast::Method> (*make)(), Promise promise,
             Said hourglass, Said inflection, Said coplanar, bool counts_up_to_t_max,
             Wrong handcrafted, Wrong simulation, fast::MethodOptions on_public_data = {},
             std::uint64_t stride = 1) {
  return {
      name,        make,       promise,        hourglass, inflection, coplanar, counts_up_to_t_max,
      handcrafted, simulation, on_public_data, stride};
}

constexpr Verdict yes = Verdict::yes, no = Verdict::no;
constexpr fast::MethodOptions short_search{.max_checks = 2000};
constexpr double coplanar_toi = 0.07 / 0.29;

const std::array all_baselines{
    row("accd", accd_method, Promise::none, {yes, 0, 0.9}, {no}, {yes, 0, coplanar_toi}, true,
        {0, 174, 0, 217}, {0, 67, 0, 156}, {.max_checks = 10000}),
    row("accd_limited", accd_limited_method, Promise::none, {yes, 0, 0.9}, {no},
        {yes, 0, coplanar_toi}, true, {14, 174, 6, 222}, {199, 67, 9, 156}),
    row("bsc", bsc_method, Promise::none, {yes}, {yes}, {no}, false, {3, 28, 2, 4}, {0, 0, 13, 20}),
    row("cubic", cubic_method, Promise::none, {yes, 0.9 - 1e-4, 0.9 + 1e-4}, {no}, {yes}, true,
        {1, 123, 1, 166}, {0, 59, 0, 151}),
    row("fprf", fprf_method, Promise::none, {yes, 0.499999, 0.500001}, {no},
        {yes, coplanar_toi - 1e-6, coplanar_toi + 1e-6}, true, {24, 9, 33, 3}, {1874, 0, 52, 0}),
    row("irf", irf_method, Promise::conservative, {yes}, {no}, {yes}, true, {0, 2, 0, 5},
        {0, 2, 0, 4}, short_search, 16),
    row("msrf", msrf_method, Promise::none, {yes, 0.9 - 1e-4, 0.9 + 1e-4}, {no}, {yes}, true,
        {0, 119, 4, 111}, {236, 67, 13, 156}),
    row("rp", rp_method, Promise::none, {yes}, {no}, {yes}, false, {0, 1, 0, 1}, {63, 0, 1, 0}),
    row("rrp", rrp_method, Promise::none, {yes}, {no}, {yes}, false, {0, 0, 0, 0}, {63, 0, 1, 0}),
    row("tccd", tccd_method, Promise::none, {yes}, {no}, {yes}, false, {0, 288, 0, 192},
        {23, 35, 0, 65}),
    row("uirf", uirf_method, Promise::conservative, {yes}, {no},
        {yes, coplanar_toi - 1e-3, coplanar_toi + 1e-3}, true, {0, 4, 0, 7}, {0, 2, 0, 0},
        short_search, 16)};

class Baselines : public testing::TestWithParam<const Baseline*> {
 protected:
  const Baseline& baseline = *GetParam();
  std::unique_ptr<fast::Method> method = baseline.make();

  Verdict verdict(const PosedQuery& posed, const fast::MethodOptions& options = {}) const {
    return answer_to(*method, posed, options).verdict;
  }

  void expect_said(const char* family, const Said& said) const {
    const fast::Answer answer =
        answer_to(*method, tests::printed_query(family), {.tolerance = 1e-4});
    EXPECT_EQ(answer.verdict, said.verdict) << family;
    EXPECT_TRUE(said.to == infinity ||
                (said.from <= answer.toi_lower && answer.toi_lower < said.to))
        << family << ' ' << answer.toi_lower;
  }

  void expect_wrong(const std::string& folder, const Wrong& wrong) const {
    const auto score = [&](Kind kind) {
      const tests::Score of_kind = tests::score_on_public_data(*method, baseline.on_public_data,
                                                               folder, kind, baseline.stride);
      if (baseline.promise != Promise::none) {
        EXPECT_EQ(of_kind.false_negatives + of_kind.late, 0) << folder;
      }
      return of_kind;
    };
    const tests::Score faces = score(Kind::vertex_face), edges = score(Kind::edge_edge);
    if (faces.collisions == 0) GTEST_SKIP() << "public data missing";
    const std::array found{faces.false_negatives, faces.false_positives, edges.false_negatives,
                           edges.false_positives};
    EXPECT_EQ(found, (std::array{wrong.missed_faces, wrong.invented_faces, wrong.missed_edges,
                                 wrong.invented_edges}))
        << folder;
    EXPECT_EQ(faces.errors + edges.errors, 0) << folder;
  }
};

TEST_P(Baselines, AnswerThePrintedQueriesAsTheyWereSeenTo) {
  EXPECT_EQ(method->name(), baseline.name);
  EXPECT_EQ(method->promise(), baseline.promise);
  expect_said("hourglass", baseline.hourglass);
  expect_said("inflection", baseline.inflection);
  expect_said("sliding-degenerate", baseline.coplanar);
}

TEST_P(Baselines, TellCollisionsFromWideGaps) {
  for (const PosedQuery& collision : {over_triangle(1, 1, 1, -3), over_edge(1, 2, 1, -3)}) {
    const fast::Answer answer = answer_to(*method, collision);
    EXPECT_EQ(answer.verdict, yes) << collision;
    EXPECT_TRUE(std::isnan(answer.toi_lower) || std::abs(answer.toi_lower - 0.25) < 0.06)
        << collision << ' ' << answer.toi_lower;
    for (const double number : {fast::Answer::none, infinity, -infinity}) {
      for (const std::size_t place : {0U, 11U, 23U}) {
        PosedQuery bad = collision;
        bad.query.coordinates[place] = number;
        EXPECT_EQ(verdict(bad), Verdict::error);
      }
    }
  }
  for (const PosedQuery& no_collision : {over_triangle(1, 1, 3, 1), over_edge(1, 2, 3, 1)}) {
    EXPECT_EQ(verdict(no_collision), no) << no_collision;
  }
}

TEST_P(Baselines, HeedTheOptionsThatTheyKnow) {
  const PosedQuery collision = over_triangle(1, 1, 1, -1), near = over_triangle(1, 1, 2, 1);
  EXPECT_EQ(verdict(collision, {.t_max = 0.75}), yes);
  EXPECT_EQ(verdict(collision, {.t_max = 0.25}), baseline.counts_up_to_t_max ? no : yes);
  const bool knows = method->info().measures_in(Norm::l2);
  EXPECT_EQ(verdict(near, {.separation = {.distance = 1.5, .norm = Norm::l2}}), knows ? yes : no);
  EXPECT_TRUE(!method->info().measures_in(Norm::linf) ||
              verdict(near, {.separation = {.distance = 1.5, .norm = Norm::linf}}) == yes);
}

TEST_P(Baselines, RefuseOptionsThatMeanNothing) {
  for (const double bad : {-0.5, infinity, fast::Answer::none}) {
    for (const fast::MethodOptions& options : {fast::MethodOptions{.tolerance = bad},
                                               {.tolerance = 0.0},
                                               {.t_max = bad},
                                               {.separation = {.distance = bad}}}) {
      EXPECT_EQ(verdict(over_triangle(1, 1, 1, -1), options), Verdict::error);
    }
  }
  EXPECT_EQ(verdict(over_triangle(1, 1, 1, -1), {.t_max = 1.5}), Verdict::error);
  EXPECT_NE(verdict(over_triangle(1, 1, 1, -1), {.t_max = 0.0}), Verdict::error);
}

TEST_P(Baselines, AnswerAlikeInAnyOrderAndAnyRounding) {
  tests::Random random(2);
  std::vector<Query> queries{over_edge(1, 2, 0.7, -1.3).query};
  for (int i = 0; i < 60; ++i) {
    const auto family = i % 2 == 0 ? tests::Family::tiny_integers : tests::Family::near_contact;
    queries.push_back(tests::random_query(random, Kind::edge_edge, family).query);
  }
  std::vector<fast::Answer> expected(queries.size()), found(queries.size());
  method->solve(Queries(Kind::edge_edge, queries), expected, short_search);
  std::ranges::reverse(queries);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    std::fesetround(mode);
    method->solve(Queries(Kind::edge_edge, queries), found, short_search);
    const int after = std::fegetround();
    const double sum = tests::one_and_a_little();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(after, mode);
    EXPECT_EQ(sum > 1.0, mode == FE_UPWARD);
    std::ranges::reverse(found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].verdict, expected[i].verdict);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i].toi_lower),
                std::bit_cast<std::uint64_t>(expected[i].toi_lower));
    }
  }
}

TEST_P(Baselines, AreWrongOnThePublicDataAsOftenAsKnown) {
  expect_wrong("handcrafted", baseline.handcrafted);
  expect_wrong("simulation", baseline.simulation);
}

/// Methods with a promise miss no generated query.
TEST_P(Baselines, KeepTheirPromise) {
  if (baseline.promise == Promise::none) GTEST_SKIP() << "it promises nothing";
  for (const tests::Score& score : {tests::score_on_families(*method, short_search, 4),
                                    tests::score_on_random(*method, short_search, 60)}) {
    EXPECT_GT(score.collisions, 0);
    EXPECT_EQ(score.false_negatives + score.late + score.errors, 0);
    EXPECT_GT(score.denied, score.no_collisions / 4);
  }
}

INSTANTIATE_TEST_SUITE_P(Are, Baselines, testing::ValuesIn([] {
                           std::array<const Baseline*, all_baselines.size()> each{};
                           for (std::size_t i = 0; i < each.size(); ++i) {
                             each.at(i) = &all_baselines.at(i);
                           }
                           return each;
                         }()),
                         [](const auto& tested) { return std::string(tested.param->name); });

}  // namespace
}  // namespace touchstone::baselines::baselines_test
