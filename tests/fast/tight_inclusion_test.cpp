/// \file
/// Tight-Inclusion against known truth, and with planted faults, each of which the built-in
/// families must find.

#include "touchstone/tight_inclusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast::tight_inclusion_test {
namespace {

using exact::Rational;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t seed = 3;

/// Enough checks for nearly all queries of the families, and few enough for a test.
constexpr std::int64_t some_checks = 20000;

TightInclusionResult solve(const PosedQuery& posed, const TightInclusionOptions& options = {}) {
  return tight_inclusion(posed.kind, posed.query, options);
}

/// Calls visit(family, kind, known query) for `count` queries of each family and kind.
template <class Visit>
void for_each_family_query(std::uint64_t count, const Visit& visit) {
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t index = 0; index < count; ++index) {
        visit(family, kind, verify::generate::make_query(family, kind, seed, index));
      }
    }
  }
}

/// Options whose work is limited.
TightInclusionOptions limited(TightInclusionOptions options = {}) {
  options.max_checks = std::min(options.max_checks, some_checks);
  return options;
}

// ---- Never a miss, never late -------------------------------------------------------------------

/// The fault of an answer, by the truth about the query that was decided, or nothing.
std::string fault(const exact::Decision& truth, const TightInclusionOptions& options,
                  const TightInclusionResult& result) {
  const bool yes = result.verdict == Verdict::yes;
  if (!yes && truth.collides() && *truth.toi <= Rational(options.t_max)) return "a miss";
  if (yes && truth.collides() && *truth.toi < Rational(result.toi)) return "a late time";
  if (yes != (result.toi >= 0.0 && result.toi <= 1.0)) return "no time";
  if (yes != (result.tolerance >= options.tolerance)) return "no tolerance";
  return "";
}

/// Options for a query; none if it has no such options.
struct NamedOptions {
  const char* name;
  std::function<std::optional<TightInclusionOptions>(ContactKind, const Query&)> options_of;
};

NamedOptions always(const char* name, const TightInclusionOptions& options) {
  return {name, [options](ContactKind, const Query&) { return limited(options); }};
}

/// The least double that is not below the time of impact, as t_max.
std::optional<TightInclusionOptions> until_impact(ContactKind kind, const Query& query) {
  const exact::Decision truth = exact::decide(kind, query);
  if (!truth.collides()) return std::nullopt;
  return limited({.t_max = truth.toi->enclosure().upper});
}

/// The filter of a scene with coordinates up to 2000.
std::optional<TightInclusionOptions> of_a_scene(ContactKind kind, const Query& query) {
  constexpr double most = 2000.0;
  const auto is_far = [](double x) { return std::abs(x) > most; };
  if (std::ranges::any_of(query.coordinates, is_far)) return std::nullopt;
  return limited({.scene_filter = error_filter(kind, {most, most, most}, 0.0)});
}

class Conservative : public testing::TestWithParam<NamedOptions> {};

INSTANTIATE_TEST_SUITE_P(
    TightInclusion, Conservative,
    testing::Values(always("default_options", {}), always("coarse", {.tolerance = 1e-2}),
                    always("fine", {.tolerance = 1e-14}), always("ten_checks", {.max_checks = 10}),
                    always("one_check", {.max_checks = 1}),
                    always("separation_2", {.separation = {.distance = 1e-2}}),
                    always("separation_8", {.separation = {.distance = 1e-8}}),
                    always("separation_16", {.separation = {.distance = 1e-16}}),
                    always("separation_100", {.separation = {.distance = 1e-100}}),
                    always("separation_large", {.separation = {.distance = 1e10}}),
                    NamedOptions{"until_impact", until_impact},
                    NamedOptions{"filter_of_a_scene", of_a_scene}),
    [](const auto& param) { return param.param.name; });

TEST_P(Conservative, OnAllFamilies) {
  std::size_t decided = 0;
  for_each_family_query(
      24, [&](const verify::generate::Family& family, ContactKind kind, const auto& known) {
        const auto options = GetParam().options_of(kind, known.query);
        if (!options) return;
        const TightInclusionResult result = tight_inclusion(kind, known.query, *options);
        const exact::Decision truth = exact::decide(kind, known.query, options->separation);
        EXPECT_EQ(fault(truth, *options, result), "") << family.name << ' ' << to_string(kind);
        ++decided;
      });
  EXPECT_GT(decided, 100U);
}

TEST(TightInclusion, MissesNothingOnThePublicData) {
  int false_positives = 0;
  const auto visit = [&](const auto& file, std::uint64_t index, ContactKind kind,
                         const Query& query) {
    const exact::Decision truth = exact::decide(kind, query);
    const auto result = tight_inclusion(kind, query, limited());
    EXPECT_EQ(fault(truth, limited(), result), "") << file << ' ' << index;
    if (result.verdict == Verdict::yes && !truth.collides()) ++false_positives;
  };
  if (!tests::for_each_public_query(visit)) GTEST_SKIP() << "public data missing";
  EXPECT_GT(false_positives, 0);  // conservative, not exact
}

// ---- Minimum separation, by construction --------------------------------------------------------

/// A query without a collision whose points of least L∞ distance are `gap` apart along an axis, at
/// t=1: the vertex or edge comes straight down and stops there.
PosedQuery stops_above(ContactKind kind, double height, double gap) {
  return kind == ContactKind::vertex_face ? over_triangle(1.0, 1.0, height, gap)
                                          : over_edge(1.0, 2.0, height, gap);
}

/// Up to the filter.
TEST(MinimumSeparation, ReachesHardlyFartherThanItSays) {
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const double d : {0x1p-3, 0x1.8p-20, 0x1p-40, 0.1, 1e-10}) {
      const double filter = error_filter(kind, {4, 4, 1}, d)[2];
      const TightInclusionOptions options{.tolerance = filter / 8, .separation = {.distance = d}};
      EXPECT_EQ(solve(stops_above(kind, 1.0, d), options).verdict, Verdict::yes) << d;
      EXPECT_EQ(solve(stops_above(kind, 1.0, d + 3 * filter), options).verdict, Verdict::no) << d;
    }
  }
}

// ---- Options ------------------------------------------------------------------------------------

/// A height falls at this speed, and is the distance at `toi`: it is within δ of that not before
/// toi − δ / speed.
TEST(Tolerance, BoundsTheErrorOfTheTime) {
  struct Row {
    PosedQuery posed;
    TightInclusionOptions options;
    Rational toi;
    double speed;
  };
  std::vector<Row> rows;
  for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
    rows.push_back({over_triangle(1, 1, 1, -2), {.tolerance = tolerance}, Rational(1, 3), 3.0});
  }
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const double d : {0x1p-1, 0x1p-3, 0x1p-10, 0x1p-30}) {
      rows.push_back({stops_above(kind, 1.0, -1.0),
                      {.separation = {.distance = d}},
                      (1 - Rational(d)) / 2,
                      2.0});
    }
  }
  for (const auto& [posed, options, toi, speed] : rows) {
    const auto result = solve(posed, options);
    ASSERT_EQ(result.verdict, Verdict::yes);
    EXPECT_LE(Rational(result.toi), toi);
    EXPECT_GE(Rational(result.toi + 2 * result.tolerance / speed), toi);
    EXPECT_LE(result.tolerance, is_zero(options.separation) ? options.tolerance : 1e-2);
  }
}

/// An edge that slides along another: contact for an interval of time and of parameters.
const PosedQuery sliding =
    tests::edge_edge({0, 0, 0, 4, 0, 0, 1, 0, 0, 5, 0, 0}, {0, 0, 0, 4, 0, 0, 2, 0, 0, 6, 0, 0});

TEST(MaxChecks, EndsEarlyWithTheToleranceReached) {
  double last_tolerance = infinity;
  for (const std::int64_t checks : {10, 100, 1000, 10000}) {
    const auto result = solve(sliding, {.max_checks = checks});
    EXPECT_EQ(result.verdict, Verdict::yes);
    EXPECT_EQ(result.toi, 0.0);
    EXPECT_GT(result.tolerance, 1e-6);
    EXPECT_LT(result.tolerance, last_tolerance);
    EXPECT_LE(result.checks, 2 * checks + 1);
    last_tolerance = result.tolerance;
  }
}

TEST(MaxChecks, AreBoundedByTheMemoryToo) {
  const auto result = solve(sliding, {.max_checks = 0});
  EXPECT_EQ(result.verdict, Verdict::yes);
  EXPECT_GT(result.tolerance, 1e-6);
  EXPECT_LT(result.checks, 20'000'000);
  // The next search is independent.
  EXPECT_EQ(solve(over_triangle(1, 1, 5, 6)).verdict, Verdict::no);
}

TEST(TMax, CountsContactsUpToItOnly) {
  // A vertex that falls from 1 to `end`, or rises from 0, and the least t_max that counts.
  for (const auto& [start, end, toi] :
       {std::tuple(1.0, -2.0, 1.0 / 3), {1.0, -1.0, 0.5}, {0.0, 1.0, 0.0}}) {
    for (const double t_max : {1.0, 0.5, 0.34, 0.3334, 0.3333, 0.25, 0.1, 1e-20, 1e-300, 0.0}) {
      const auto result = solve(over_triangle(1, 1, start, end), {.t_max = t_max});
      EXPECT_EQ(result.verdict, t_max >= toi ? Verdict::yes : Verdict::no) << toi << ' ' << t_max;
      if (result.verdict == Verdict::yes) {
        EXPECT_LE(Rational(result.toi), Rational(toi));
      }
    }
  }
}

TEST(SceneFilter, IsUsedAsItIs) {
  const PosedQuery above = over_triangle(1, 1, 1, 0.25);
  EXPECT_EQ(solve(above).verdict, Verdict::no);
  EXPECT_EQ(solve(above, {.scene_filter = {{0.3, 0.3, 0.3}}}).verdict, Verdict::yes);
  EXPECT_EQ(solve(above, {.scene_filter = {{0.2, 0.2, 0.2}}}).verdict, Verdict::no);
}

// ---- Range --------------------------------------------------------------------------------------

/// Coordinates of a few least subnormals on two axes and huge ones on the third; two points, one of
/// each primitive, meet exactly at t=½.
Query huge_and_tiny(Random& random, ContactKind kind) {
  Query query{};
  const std::size_t partner = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int exponent = axis == 0 ? 990 : -1074;
    const auto set = [&](std::size_t end, std::size_t point, int whole) {
      query.at(end, point, axis) = std::ldexp(whole, exponent);
    };
    const auto draw = [&] { return random.between(-(1 << 20), 1 << 20); };
    for (std::size_t point = 0; point < 4; ++point) {
      for (const std::size_t end : {0U, 1U}) set(end, point, draw());
    }
    const int start = draw(), end = draw(), other_start = draw();
    set(0, 0, start);
    set(1, 0, end);
    set(0, partner, other_start);
    set(1, partner, start + end - other_start);
  }
  query.at(0, 3, 0) = 0x1p1017;
  return query;
}

TEST(Range, ASceneFilterCoversUnderflowOfHugeQueriesToo) {
  Random random(21);
  for (int i = 0; i < 20000; ++i) {
    const ContactKind kind = random.coin() ? ContactKind::edge_edge : ContactKind::vertex_face;
    const Query query = huge_and_tiny(random, kind);
    BoxProblem problem;
    const Extent extent = box_kernels().back()->load(query, problem);
    TightInclusionOptions options;
    options.max_checks = 200;
    options.t_max = 0.5;
    for (const bool scene : {false, true}) {
      if (scene) options.scene_filter = error_filter(kind, extent.x_max, 0.0);
      ASSERT_EQ(tight_inclusion(kind, query, options).verdict, Verdict::yes) << i << ' ' << scene;
    }
  }
}

TEST(Range, ParametersReachTheirLastBitAndStop) {
  // A point, and a triangle of width 2^1000: parameters would have to be split a thousand times.
  const double far = 0x1p1000;
  const PosedQuery posed = tests::vertex_face({1, 1, 1, 0, 0, 0, far, 0, 0, 0, far, 0},
                                              {1, 1, -1, 0, 0, 0, far, 0, 0, 0, far, 0});
  const auto result = solve(posed, {.max_checks = 0});
  EXPECT_EQ(result.verdict, Verdict::yes);
  EXPECT_LE(result.toi, 0.5);
  EXPECT_GT(result.tolerance, 1e-6);
  EXPECT_LT(result.checks, 100000);
}

// ---- Planted faults -----------------------------------------------------------------------------

bool is_wrong(const verify::generate::KnownQuery& known, const Answer& answer) {
  const bool yes = answer.verdict == Verdict::yes;
  return known.collides && (!yes || (known.toi && Rational(answer.toi_lower) > *known.toi));
}

/// The number of families that find a fault, by a miss or a late time, among 100 queries of each
/// kind.
std::size_t families_that_find(const Method& method) {
  std::set<std::string_view> result;
  for_each_family_query(
      100, [&](const verify::generate::Family& family, ContactKind kind, const auto& known) {
        Answer answer;
        method.solve({kind, {&known.query, 1}}, std::span(&answer, 1), {.max_checks = some_checks});
        if (is_wrong(known, answer)) result.insert(family.name);
      });
  return result.size();
}

TEST(TightInclusion, FamiliesFindPlantedFaults) {
  const auto expect_found = [](const tests::FaultInfo& fault, const Method& method) {
    if (fault.separation.distance > 0.0 || !fault.is_to_be_found() || fault.is_for_fuzzer) return;
    const std::size_t found = families_that_find(method);
    std::printf("%s: found by %zu families\n", fault.name.data(), found);
    EXPECT_GT(found, 0U) << fault.name;
  };
  for (const auto& fault : tests::planted_faults().box_kernel) {
    expect_found(fault, *tight_inclusion_method({.kernel = fault.part}));
  }
  for (const auto& fault : tests::planted_faults().tight_inclusion) {
    expect_found(fault, *fault.part({}));
  }
}

// ---- As a method --------------------------------------------------------------------------------

TEST(Method, RefusesToRunWithSubnormalsFlushed) {
  {
    const tests::ChangedModes flushing(tests::flush_to_zero);
    EXPECT_THROW(static_cast<void>(solve(over_triangle(1, 1, 1, -1))), std::runtime_error);
  }
  EXPECT_EQ(solve(over_triangle(1, 1, 1, -1)).verdict, Verdict::yes);
}

/// As the function, on lines and on curves; one query is not finite.
TEST(Method, AnswersAsTheFunction) {
  Random random(105);
  for (const QueryShape& shape : {QueryShape{}, {.kind = ContactKind::edge_edge, .degree = 3}}) {
    std::vector<double> numbers(100 * shape.numbers_of_query());
    for (double& x : numbers) x = random.uniform(-1, 1);
    numbers[5] = infinity;
    const Queries queries(shape, numbers);
    std::vector<TightInclusionResult> found(queries.size());
    tight_inclusion(queries, found, {.tolerance = 1e-2, .max_checks = 500, .t_max = 0.75});
    std::vector<Answer> answers(found.size());
    tight_inclusion_method()->solve(queries, answers,
                                    {.tolerance = 1e-2, .max_checks = 500, .t_max = 0.75});
    EXPECT_EQ(answers[0].verdict, Verdict::error);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(answers[i].verdict, found[i].verdict);
      EXPECT_EQ(answers[i].checks, found[i].checks);
      EXPECT_TRUE(std::isnan(answers[i].toi_upper));
      EXPECT_EQ(std::isnan(answers[i].toi_lower), found[i].verdict != Verdict::yes);
      if (found[i].verdict != Verdict::yes) continue;
      EXPECT_EQ(answers[i].toi_lower, found[i].toi);
      EXPECT_EQ(answers[i].tolerance, found[i].tolerance);
    }
    for (const Verdict verdict : {Verdict::yes, Verdict::no}) {
      EXPECT_GT(std::ranges::count(found, verdict, &TightInclusionResult::verdict), 5);
    }
  }
}

// ---- Filters ------------------------------------------------------------------------------------

constexpr double least = std::numeric_limits<double>::denorm_min();

double on_first_axis(ContactKind kind, double x_max, double d) {
  return error_filter(kind, {x_max, 0.0, 0.0}, d)[0];
}

TEST(ErrorFilter, IsTheDerivedBoundAndTakesTheSeparationForACoordinate) {
  EXPECT_EQ(on_first_axis(ContactKind::edge_edge, 3.0, 2.0),
            filters::edge_edge_separated_double(3.0));
  EXPECT_EQ(on_first_axis(ContactKind::vertex_face, 3.0, 5.0),
            filters::vertex_face_separated_double(5.0));
  EXPECT_EQ(on_first_axis(ContactKind::vertex_face, 3.0, least),
            filters::vertex_face_separated_double(3.0));
}

TEST(ErrorFilter, IsInfiniteWhereOverflowCouldOccurAndNeverZero) {
  EXPECT_EQ(on_first_axis(ContactKind::edge_edge, std::numeric_limits<double>::max(), 0.0),
            infinity);
  EXPECT_EQ(on_first_axis(ContactKind::vertex_face, 1.0, 0x1p1022), infinity);
  EXPECT_LT(on_first_axis(ContactKind::edge_edge, 0x1p1020, 0.0), infinity);
  // Nothing but underflow.
  EXPECT_GT(on_first_axis(ContactKind::edge_edge, 0.0, 0.0), 0.0);
  EXPECT_GT(on_first_axis(ContactKind::vertex_face, least, 0.0), least);
}

}  // namespace
}  // namespace touchstone::fast::tight_inclusion_test
