/// \file
/// What each published method is known to be wrong about, as its header states, and what it is
/// right about beside that: answers to single queries as a table, whose defects the oracle
/// confirms, and shares of random queries.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fast/candidates.hpp"
#include "tests/support/baselines.hpp"
#include "tests/support/root_count.hpp"
#include "tests/support/simulation_steps.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/baselines/baselines.hpp"
#include "verify/baselines/bernstein.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::baselines::known_defects_test {
namespace {

using fast::MethodOptions;
using fast::Verdict;
using tests::edge_edge;
using tests::missed_centre_hits;
using tests::Movement;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;
using tests::says_yes;
using tests::truly_collides;
using tests::vertex_face;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};
constexpr Verdict yes = Verdict::yes, no = Verdict::no, undecided = Verdict::undecided;
constexpr double infinity = std::numeric_limits<double>::infinity();

const fast::Method& method(std::string_view name) { return verify::solvers::find_method(name); }

// ---- Single queries -----------------------------------------------------------------------------

constexpr std::uint32_t any_number = std::numeric_limits<std::uint32_t>::max();

/// A verdict, from ≤ toi_lower < to, and the number of checks.
struct Said {
  Verdict verdict;
  double from = -infinity, to = infinity;
  std::uint32_t checks = any_number;
};

Said at(double toi, std::uint32_t checks = any_number) {
  return {yes, toi, std::nextafter(toi, 2.0), checks};
}

struct Row {
  const char* method;
  PosedQuery query;
  Said said;
  bool is_wrong = false;  ///< a yes without a collision, or a no to one
  MethodOptions options = {};
};

using Rows = std::vector<Row>;
constexpr bool wrong = true, right = false;

MethodOptions within(double distance) {
  return {.separation = {.distance = distance, .norm = Norm::l2}};
}

/// The vertex or the edge moves from one height to another above the inside of the other primitive.
PosedQuery over(Kind kind, double from, double to) {
  return kind == Kind::vertex_face ? over_triangle(1, 1, from, to) : over_edge(1, 2, from, to);
}

/// A vertex above the triangle that moves by 1 with it, or along it.
PosedQuery beside_triangle(double height, double motion_of_triangle) {
  const double x = motion_of_triangle;
  return vertex_face({1, 1, height, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                     {2, 1, height, x, 0, 0, 4 + x, 0, 0, x, 4, 0});
}

/// The vertex comes down from 1 to −1 and moves along the face, `along` in all. Each step of ACCD
/// covers a share of 0.8 · 2/√(along² + 4) of the gap, at most.
PosedQuery comes_down_along(double along) {
  const double wide = 2.0 * along + 4.0;
  return vertex_face({1, 1, 1, -wide, -wide, 0, wide, -wide, 0, 0, wide, 0},
                     {1 + along, 1, -1, -wide, -wide, 0, wide, -wide, 0, 0, wide, 0});
}

/// A near miss is a collision if the gap shrinks to a tenth, or, limited, to a fifth.
Rows rows_of_accd() {
  // The vertex comes down by 1/2 and the face up by 1/2, with a mean motion up by 1/4: ℓ = 3/4 +
  // 1/4, and d = 1 − t. The first step, to 0.9, is not tested; the next would leave 0.01 < 0.1.
  Rows rows{{"accd",
             vertex_face({1, 1, 0.5, 0, 0, -0.5, 4, 0, -0.5, 0, 4, -0.5},
                         {1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}),
             at(0.9, 2)},
            {"accd", over_triangle(1, 1, 1, 0.15), {no}},
            {"accd_limited", over_triangle(1, 1, 1, 0.15), {yes}, wrong},
            {"accd_limited", over_triangle(1, 1, 1, 0.3), {no}},
            // Without relative motion only the start counts.
            {"accd", beside_triangle(0, 1), {yes}},
            {"accd", beside_triangle(0x1p-30, 1), {no}},
            {"accd", beside_triangle(0x1p-20, 0), {yes, 0, 1, 1000}, wrong, {.max_checks = 1000}},
            {"accd", beside_triangle(0x1p-20, 0), {no}, right, {.max_checks = 0}},
            {"accd_limited", comes_down_along(0.0), {yes, 0, 0.5}},
            {"accd_limited", comes_down_along(8.0), {yes, 0, 0.5}},
            {"accd_limited", comes_down_along(100.0), {no, -infinity, infinity, 32}, wrong},
            {"accd", comes_down_along(100.0), {yes}}};
  for (const Kind kind : kinds) {
    // The distance 0.25 is reached at t=3/4.
    rows.insert(rows.end(), {{"accd", over(kind, 1, 0.05), {yes}, wrong},
                             {"accd", over(kind, 1, 0.2), {no}},
                             {"accd", over(kind, 1, 0), {yes, 0.66, 0.75}, right, within(0.25)},
                             {"accd", over(kind, 1, 0.5), {no}, right, within(0.25)},
                             {"accd", over(kind, 0.25, 1), at(0.0, 0), right, within(0.25)}});
  }
  return rows;
}

Rows rows_of_cubic() {
  // In a plane the cubic is 0: a vertex enters a triangle by an edge, and leaves it.
  Rows rows{
      {"cubic",
       vertex_face({-1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}, {5, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}),
       {no},
       wrong}};
  for (const Kind kind : kinds) {
    rows.insert(rows.end(), {{"cubic", over(kind, 1, 5e-5), {yes}, wrong, {.tolerance = 1e-4}},
                             {"cubic", over(kind, 1, 2e-4), {no}, right, {.tolerance = 1e-4}},
                             {"cubic", over(kind, 0, 1), at(0.0)},
                             {"cubic", over(kind, 1, 0), at(1.0)},
                             {"cubic", over(kind, 1, 2), {no}}});
  }
  return rows;
}

/// Edges that meet along a segment at t=1/2.
PosedQuery parallel_edges() {
  return edge_edge({0, 0, 0, 4, 0, 0, 1, 0, 1, 3, 0, 1}, {0, 0, 0, 4, 0, 0, 1, 0, -1, 3, 0, -1});
}

Rows rows_of_fprf() {
  // Small edges all count as parallel.
  Rows rows{{"fprf", parallel_edges(), {no}, wrong},
            {"fprf", parallel_edges(), {no}, wrong, within(1e-3)},
            {"fprf", over_edge(1, 2, 1, -1), {yes}},
            {"fprf", tests::scaled(over_edge(1, 2, 1, -1), -16), {no}, wrong}};
  // It separates interiors only: contacts beside the primitives at that distance are not found.
  for (const double gap : {0.25, 0.75}) {
    const bool is_near = gap < 0.5;
    for (const PosedQuery& above : {over_triangle(1, 1, 2, gap), over_edge(1, 2, 2, gap)}) {
      rows.push_back({"fprf", above, {is_near ? yes : no}, right, within(0.5)});
    }
    for (const PosedQuery& beside : {over_triangle(-gap, 1, 2, -2), over_edge(4 + gap, 2, 2, -2)}) {
      rows.push_back({"fprf", beside, {no}, is_near, within(0.5)});
    }
  }
  return rows;
}

/// Near misses within the tolerance are collisions, and the parallelogram is not the face.
Rows rows_of_irf() {
  const auto at_rest = [](const tests::FourPoints& points) { return vertex_face(points, points); };
  Rows rows{{"irf", over_triangle(1, 3, 1, -1), {yes}},
            {"irf", over_triangle(1, 3.01, 1, -1), {no}},
            {"irf", over_triangle(3, 3, 1, -1), {no}},
            {"irf",
             over_triangle(1, 1, 1, -3),
             {undecided, -infinity, infinity, 10},
             right,
             {.max_checks = 10}},
            {"irf", over_triangle(1, 1, 0, 0), {yes}},
            // There is no tolerance to reach, or none that doubles can.
            {"irf", over_triangle(1, 1, 1, -3), {yes}, right, {.tolerance = 1e-300}},
            {"irf", at_rest({1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}), {yes, -infinity, infinity, 1}}};
  // A path past the side u + v = 1 of the face; and an edge whose end stops short of the other,
  // diagonal one.
  const auto near_edges = [](double gap) {
    return edge_edge({0, 0, 0, 4, 4, 0, 2.6, 0, 1, 1.3 + gap, 1.3 - gap, 1},
                     {0, 0, 0, 4, 4, 0, 2.6, 0, -1, 1.3 + gap, 1.3 - gap, -1});
  };
  for (const double tolerance : {1e-3, 1e-6}) {
    for (const double gap : {tolerance / 16, 16 * tolerance}) {
      for (const PosedQuery& near : {over_triangle(2 + gap, 2, 1, -1), near_edges(gap)}) {
        const bool is_taken = gap < tolerance;
        rows.push_back({"irf", near, {is_taken ? yes : no}, is_taken, {.tolerance = tolerance}});
      }
    }
  }
  return rows;
}

/// All that is on one line passes, and in a plane all intervals are candidates: 2047 of 2^-10.
Rows rows_of_uirf() {
  const PosedQuery edges = edge_edge({0, 0, 0, 1, 0, 0, 8, 0, 0, 9, 0, 0},  //
                                     {0, 0, 0, 1, 0, 0, 8, 0, 0, 9, 0, 0});
  const PosedQuery needle = vertex_face({9, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0},  //
                                        {9, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0});
  const PosedQuery plane = vertex_face({3, 3, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0},  //
                                       {3, 4, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  return {{"uirf", edges, {yes}, wrong},
          {"uirf", needle, {yes, 0, 2, 1}, wrong},
          {"uirf", over_triangle(1, 3, 1, -1), {yes}},
          {"uirf", over_triangle(1, 3.01, 1, -1), {no}},
          {"uirf", over_edge(4.01, 2, 1, -1), {no}},
          {"uirf", plane, {undecided, -infinity, infinity, 100}, right, {.max_checks = 100}},
          {"uirf",
           plane,
           {no, -infinity, infinity, 2047},
           right,
           {.tolerance = 1e-3, .max_checks = 0}}};
}

/// It reaches the root of its separation, √(h² + 0.1 h) = 3.16e-5 for h = 1e-8; misses what is
/// within its separation from the start, or rests; and ends of edges and parallel edges.
Rows rows_of_msrf() {
  const PosedQuery near = vertex_face({1, 1, 0.25, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                      {1.5, 1, 0.125, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const PosedQuery hourglass = tests::printed_query("hourglass");
  Rows rows{{"msrf", hourglass, {yes, 0.9 - 1e-4, 0.9 + 1e-4}, right, within(1e-8)},
            {"msrf", tests::printed_query("inflection"), {no}, right, within(1e-8)},
            {"msrf", over_triangle(-3e-5, 1, 1, -1), {yes}, wrong, within(1e-8)},
            {"msrf", over_triangle(-3.3e-5, 1, 1, -1), {no}, right, within(1e-8)},
            {"msrf", near, {no}, wrong, within(0.5)},
            {"msrf", over_triangle(1, 1, 1, 0.25), {yes}, right, within(0.5)},
            {"msrf", over_triangle(1, 1, 0, 0), {no}, wrong},
            {"msrf", {Kind::vertex_face, Query{}}, {no}, wrong},
            {"msrf", over_edge(4.25, 2, 1, -1), {no}, wrong, within(0.25)},
            {"msrf", parallel_edges(), {no}, wrong, within(0.25)},
            // A vertex has candidates for the edges and vertices of a face.
            {"msrf", over_triangle(-0.125, 1, 1, -1), {yes}, right, within(0.25)},
            {"msrf", over_triangle(-0.125, -0.125, 1, -1), {yes}, right, within(0.25)}};
  for (const double h : {1e-16, 1e-30, 1e-100}) {
    rows.push_back({"msrf", hourglass, {no}, wrong, within(h)});
  }
  return rows;
}

/// The edge f0 f1 turns over in the plane z=0 while f2 stays below: the patch is an hourglass about
/// (1/2, 0) in units of F, whose hull holds 0 although the patch does not.
PosedQuery beside_hourglass() {
  return vertex_face({0, 0, 0, 0.5, 1, 0, -1.5, 1, 0, 0, 0, -5},
                     {0, 0, 0, -1.5, -1, 0, 0.5, -1, 0, 0, 0, -5});
}

/// RP finds contacts on which its ray starts, at t=0 and at t=1, at a corner and an edge's end, at
/// rest and in a plane through the ray. RRP tells an hourglass from its hull, but misses contact at
/// rest or under a common translation, and with a triangle that is a segment at an end.
Rows rows_of_rp_and_rrp() {
  const tests::FourPoints open{1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0};
  const tests::FourPoints folded{1, 1, 1, 0, 0, 0, 4, 0, 0, 2, 0, 0};
  tests::FourPoints narrow = folded;
  narrow[10] = 0x1p-40;
  Rows rows{{"rp", over_triangle(1, 1, 0, 1), {yes}},
            {"rp", over_triangle(1, 1, 1, 0), {yes}},
            {"rp", over_triangle(0, 0, 1, -1), {yes}},
            {"rp", over_triangle(1, 1, 0, 0), {yes}},
            {"rp", over_edge(0, 0, 1, -1), {yes}},
            {"rp", over_edge(1, 2, 0, 0), {yes}},
            {"rp", beside_hourglass(), {yes}, wrong},
            {"rrp", beside_hourglass(), {no}},
            {"rrp", vertex_face(folded, open), {no}, wrong},
            {"rrp", vertex_face(open, folded), {no}, wrong},
            {"rrp", vertex_face(narrow, open), {yes}},
            // A flat patch with a reflex corner is taken for its two triangles: the patch of w0 and
            // w1 lies in x + y = −1, its outline (x,z): (0,−2), (0,0), (−1,1), (1,2).
            {"rrp",
             vertex_face({1, 0, -1, 1, 1, 1, 1, 1, -1, -1, 0, 1},
                         {0, -1, 1, -1, 1, -1, 1, -1, 0, -1, 0, 1}),
             {yes},
             wrong}};
  for (const Eigen::Vector3d& step : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -2, 0.5)}) {
    for (PosedQuery posed : {over_triangle(1, 1, 0, 0), over_edge(1, 2, 0, 0)}) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        point_of(posed.query, 1, point) += step;
      }
      rows.push_back({"rrp", posed, {no}, wrong});
    }
  }
  return rows;
}

/// TCCD misses a grazing contact at a corner of both: Y is a square with a double root at t = 1/2,
/// and each constraint, which vanishes there, is taken for negative at one of the "two" roots. BSC
/// misses every contact in a common plane.
Rows rows_of_tccd_and_bsc() {
  return {
      {"tccd",
       edge_edge({0, -1, -1, -1, -1, -1, -1, 0, 0, -1, 0, -1},
                 {0, -1, -1, 0, 1, 0, -1, 0, 0, 0, 0, 0}),
       {no},
       wrong},
      {"tccd",
       vertex_face({-1, 1, 1, 1, 0, 1, 1, -1, -1, 0, 1, 0}, {1, -1, -1, 1, 0, 1, 0, 0, 0, 0, 0, 1}),
       {no},
       wrong},
      {"bsc", over_edge(1, 2, 0, 0), {no}, wrong}};
}

TEST(KnownDefects, OfSingleQueries) {
  for (const Rows& rows :
       {rows_of_accd(), rows_of_cubic(), rows_of_fprf(), rows_of_irf(), rows_of_uirf(),
        rows_of_msrf(), rows_of_rp_and_rrp(), rows_of_tccd_and_bsc()}) {
    for (const Row& row : rows) {
      SCOPED_TRACE(::testing::Message() << row.method << ' ' << row.query);
      const fast::Answer answer = tests::answer_to(method(row.method), row.query, row.options);
      EXPECT_EQ(answer.verdict, row.said.verdict);
      if (row.said.to != infinity) {
        EXPECT_TRUE(row.said.from <= answer.toi_lower && answer.toi_lower < row.said.to)
            << answer.toi_lower;
      }
      EXPECT_TRUE(answer.verdict == yes || std::isnan(answer.toi_lower));
      if (row.said.checks != any_number) {
        EXPECT_EQ(answer.checks, row.said.checks);
      }
      const bool collides =
          exact::decide(row.query.kind, row.query.query, row.options.separation).collides();
      EXPECT_EQ(answer.verdict == (collides ? no : yes), row.is_wrong);
    }
  }
}

// ---- Shares of random queries -------------------------------------------------------------------

TEST(Accd, StopsStrictlyBeforeContactAndCubicEstimatesIt) {
  EXPECT_EQ(method("cubic").info().terms.times, fast::Times::estimates);
  EXPECT_EQ(method("accd_limited").info().terms.starts_apart, 0.0);
  EXPECT_GT(tests::answer_to(method("accd"), beside_triangle(0x1p-20, 0), {.max_checks = 0}).checks,
            500'000U);
  Random random(9);
  for (const Kind kind : kinds) {
    for (int i = 0; i < 1000; ++i) {
      const PosedQuery posed = tests::centre_hit(random, kind, Movement::independent);
      const fast::Answer accd = tests::answer_to(method("accd"), posed);
      const fast::Answer cubic = tests::answer_to(method("cubic"), posed);
      ASSERT_EQ(accd.verdict, yes) << posed;
      ASSERT_EQ(cubic.verdict, yes) << posed;
      EXPECT_LT(accd.toi_lower, 0.5) << posed;
      EXPECT_LT(cubic.toi_lower, 0.5 + 1e-6) << posed;
      EXPECT_TRUE(std::isnan(accd.toi_upper));
    }
  }
}

/// FPRF misses deforming triangles whatever its separation, and by chance without one; MSRF the
/// more the smaller its separation.
TEST(Msrf, AndFprfMissAShareOfContactsInTheMiddle) {
  const auto missed = [](std::string_view name, Kind kind, Movement movement, double distance) {
    constexpr int count = 4000;
    return missed_centre_hits(method(name), kind, movement, within(distance), count) /
           (1.0 * count);
  };
  EXPECT_NEAR(missed("fprf", Kind::vertex_face, Movement::independent, 1e-3), 0.288, 0.04);
  EXPECT_EQ(missed("fprf", Kind::edge_edge, Movement::independent, 1e-3), 0);
  for (const Kind kind : kinds) {
    EXPECT_EQ(missed("fprf", kind, Movement::translation, 1e-3), 0);
    const double by_chance = missed("fprf", kind, Movement::translation, 0.0);
    EXPECT_GT(by_chance, 0.05) << to_string(kind);
    EXPECT_LT(by_chance, 1.0) << to_string(kind);
    EXPECT_GT(missed("msrf", kind, Movement::independent, 1e-100), 0.995) << to_string(kind);
    EXPECT_NEAR(missed("msrf", kind, Movement::independent, 1e-8), 0.045, 0.015) << to_string(kind);
    EXPECT_LT(missed("msrf", kind, Movement::independent, 1e-2), 0.002) << to_string(kind);
  }
}

TEST(Msrf, QuickTestsRuleOutZerosToo) {
  const auto ruled_out = [](std::array<double, 7> c) { return msrf_rules_out_zeros(c); };
  // 10 − 9t − 1.25t⁶ is 10 at 0 and −0.25 at 1; without the last it is 1 there.
  EXPECT_TRUE(ruled_out({10, -9, 0, 0, 0, 0, -1.25}));
  EXPECT_FALSE(ruled_out({10, -9, 0, 0, 0, 0, -1.5})) << "not steep enough to be sure: 9 = 6 · 1.5";
  // t² is 0 at 0.
  EXPECT_TRUE(ruled_out({0, 0, 1, 0, 0, 0, 0}));
}

TEST(Rp, AndRrpSayYesExactlyToOddNumbersOfRoots) {
  Random random(1);
  for (const Kind kind : kinds) {
    int odd = 0, missed = 0;
    for (int i = 0; i < 6000; ++i) {
      const PosedQuery posed = tests::deforming_query(random, kind);
      const int contacts = tests::count_contacts(posed);
      ASSERT_EQ(contacts > 0, truly_collides(posed));
      for (const std::string_view name : {"rp", "rrp"}) {
        if (name == "rrp" && i % 4 != 0) continue;
        EXPECT_EQ(says_yes(method(name), posed), contacts % 2 == 1)
            << name << ", " << contacts << " contacts: " << posed;
      }
      odd += contacts % 2;
      missed += contacts == 2 ? 1 : 0;
    }
    EXPECT_GT(odd, 200);
    EXPECT_GT(missed, 8);
  }
}

/// Ten more than the greatest coordinate gives another ray, but the same crossings. At tiny scales
/// a crossing of a cap is taken for contact there.
TEST(Rp, KeepsItsAnswersAtScalesThatAreNotTiny) {
  Random random(3);
  tests::Score tiny;
  for (int i = 0; i < 1000; ++i) {
    for (const Kind kind : kinds) {
      const PosedQuery posed = tests::deforming_query(random, kind);
      const bool is_yes = says_yes(method("rp"), posed);
      for (const int exponent : {-30, 60, 300}) {
        if (i >= tests::trials(200)) break;
        EXPECT_EQ(is_yes, says_yes(method("rp"), scaled(posed, exponent))) << exponent;
      }
      if (kind == Kind::edge_edge) continue;
      tiny.count(is_yes, says_yes(method("rp"), scaled(posed, -100)));
    }
  }
  EXPECT_EQ(tiny.false_negatives, 0);
  EXPECT_GT(tiny.false_positives, 0);
}

/// What a method throws is a yes, and the rounding is as before.
TEST(Rp, AndBscThrowOutOfTheirRange) {
  const PosedQuery huge = edge_edge({0, 0, 0, 4, 0, 0, 5, -1, 0, 5, 1, 1e308},
                                    {0, 0, 0, 4, 0, 0, 5, -1, 0, -5, 1, -1.7e308});
  EXPECT_THROW((void)rp_collides(huge.kind, huge.query), std::overflow_error);
  EXPECT_EQ(tests::one_and_a_little(), 1.0);
  EXPECT_TRUE(says_yes(method("rp"), huge));
  const PosedQuery inflection = tests::printed_query("inflection");
  EXPECT_THROW((void)bsc_collides(inflection.kind, inflection.query), std::domain_error);
  EXPECT_EQ(tests::one_and_a_little(), 1.0);
}

bool throws_in_bsc(const PosedQuery& posed) {
  try {
    (void)bsc_collides(posed.kind, posed.query);
    return false;
  } catch (const std::domain_error&) {
    return true;
  }
}

/// And at every scale below.
TEST(Bsc, IsRightInGeneralPositionButForInflections) {
  Random random(1);
  for (const Kind kind : kinds) {
    tests::Score without, with;
    for (int i = 0; i < tests::trials(4000); ++i) {
      const PosedQuery posed = random_query(random, kind, tests::Family::full_significands);
      const bool is_yes = says_yes(method("bsc"), posed), throws = throws_in_bsc(posed);
      (throws ? with : without).count(truly_collides(posed), is_yes);
      if (i >= tests::trials(50)) continue;
      EXPECT_EQ(is_yes, says_yes(method("bsc"), scaled(posed, -400)));
      EXPECT_EQ(throws, throws_in_bsc(scaled(posed, -400)));
    }
    EXPECT_GT(without.collisions, tests::trials(40));
    EXPECT_EQ(without.false_negatives + without.false_positives, 0);
    EXPECT_GT(with.no_collisions, tests::trials(500));
    EXPECT_EQ(with.false_negatives, 0);
    EXPECT_EQ(with.false_positives, with.no_collisions);
  }
}

TEST(Bsc, MissesAndTccdInventsAllMotionInAPlane) {
  Random random(3);
  int collisions = 0, all = 0;
  for (int i = 0; i < tests::trials(500); ++i) {
    for (const Kind kind : kinds) {
      PosedQuery posed{kind, tests::full_significand_query(random)};
      tests::flatten(posed.query, 1);
      collisions += truly_collides(posed) ? 1 : 0;
      ++all;
      EXPECT_FALSE(says_yes(method("bsc"), posed));
      EXPECT_TRUE(says_yes(method("tccd"), posed));
    }
  }
  EXPECT_GT(collisions, tests::trials(200));
  EXPECT_GT(all - collisions, tests::trials(200));
}

/// Contact at t=0, where Y is 0 and is computed as a rounding error: below the threshold at scale
/// 1, far above it at scale 2^40. If the others have its sign, that is a quick no.
TEST(Bsc, MissesByItsThresholdAtLargeScales) {
  Random random(4);
  int missed_at_1 = 0, missed_at_large = 0;
  for (int i = 0; i < 2000; ++i) {
    PosedQuery posed{Kind::vertex_face, tests::full_significand_query(random)};
    // The vertex starts on the middle of the edge from f0 to f1 if that is a double.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& f1 = posed.query.at(0, 2, axis);
      const double f0 = posed.query.at(0, 1, axis);
      const double middle = f0 + 0.5 * (f1 - f0);
      posed.query.at(0, 0, axis) = middle;
      f1 = middle + (middle - f0);
    }
    if (!truly_collides(posed) || throws_in_bsc(posed)) continue;
    missed_at_1 += says_yes(method("bsc"), posed) ? 0 : 1;
    missed_at_large += says_yes(method("bsc"), scaled(posed, 40)) ? 0 : 1;
  }
  EXPECT_EQ(missed_at_1, 0);
  EXPECT_GT(missed_at_large, 0);
}

/// On boundaries near misses are not distinguished from collisions.
TEST(Tccd, IsRightInGeneralPositionAndFindsContactsOnBoundaries) {
  for (const Kind kind : kinds) {
    const auto count = tests::trials(4000);
    const auto general = score_on(method("tccd"), kind, tests::Family::full_significands, 1, count);
    const auto near = score_on(method("tccd"), kind, tests::Family::near_contact, 1, count);
    EXPECT_GT(general.collisions, tests::trials(200));
    EXPECT_EQ(general.false_negatives + general.false_positives, 0);
    EXPECT_GT(near.collisions, tests::trials(2000));
    EXPECT_EQ(near.false_negatives, 0);
    EXPECT_GT(near.false_positives, near.no_collisions / 2);
  }
}

/// A vertex that falls through the plane z=0 of a triangle at rest, or nearly z=0, far from it.
TEST(Tccd, CallsWhateverFallsThroughAPlaneInTheMiddleThirdACollision) {
  Random random(2);
  for (const double t : {0.38, 0.5, 0.62}) {
    for (int i = 0; i < tests::trials(500); ++i) {
      std::array<double, 9> face{0, 0, 0, 1, 0, 0, 0, 1, 0};
      for (double& coordinate : face) coordinate += random.uniform(-0.001, 0.001);
      const double drop = random.uniform(1.0, 2.0), y = random.uniform(-5.0, 5.0);
      const PosedQuery far = vertex_face(tests::with_vertex(5.0, y, drop * t, face),
                                         tests::with_vertex(5.0, y, drop * (t - 1.0), face));
      EXPECT_FALSE(truly_collides(far));
      EXPECT_TRUE(says_yes(method("tccd"), far));
    }
  }
}

bool has_inflection(const PosedQuery& posed) {
  const auto points = moving_points_of<double>(posed.kind, posed.query);
  const auto opposite = [](double a, double b) { return a * b < 0.0; };
  return course_of(coplanarity(points, normal_of(points)), opposite, opposite) ==
         Course::inflection;
}

TEST(Tccd, MissesByUnderflowBesideAnInflection) {
  // The same collisions at every scale: exact scalings of queries that are found at scale 1.
  Random random(6);
  for (const Kind kind : kinds) {
    std::vector<PosedQuery> collisions(tests::trials(2000U));
    std::ranges::generate(collisions, [&] { return tests::random_hit(random, kind); });
    const auto missed_at = [&](int exponent) {
      std::vector<PosedQuery> missed;
      for (const PosedQuery& collision : collisions) {
        if (!says_yes(method("tccd"), scaled(collision, exponent))) missed.push_back(collision);
      }
      return missed;
    };
    EXPECT_EQ(missed_at(0).size(), 0U);
    EXPECT_EQ(missed_at(-1).size(), 0U);
    std::size_t most = 0;
    for (int exponent = -3; exponent >= -8; --exponent) {
      const auto missed = missed_at(exponent);
      most = std::max(most, missed.size());
      EXPECT_TRUE(std::ranges::all_of(missed, has_inflection)) << exponent;
    }
    EXPECT_GE(most, tests::trials(20U)) << to_string(kind);
    // All numbers underflow to 0 in the end: nothing can be rejected.
    EXPECT_EQ(missed_at(-400).size(), 0U);
  }
}

TEST(Tccd, MissesContactsOfASimulationWhichScalingFinds) {
  const auto folder = tests::simulation_folder();
  if (folder.empty()) GTEST_SKIP() << "public data missing";
  const auto step = tests::load_simulation_step(folder, "armadillo-rollers");
  const auto missed = [&](Kind kind, int exponent) {
    const tests::LabelledPairs& labelled = step.labelled(kind);
    int count = 0;
    for (std::size_t i = 0; i < labelled.pairs.size(); ++i) {
      if (!labelled.collides[i]) continue;
      const PosedQuery posed{
          kind, query_of(step.vertices, step.candidates(kind, labelled.pairs), labelled.pairs[i])};
      count += says_yes(method("tccd"), scaled(posed, exponent)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(missed(Kind::vertex_face, 0), 23);
  EXPECT_EQ(missed(Kind::edge_edge, 0), 171);
  EXPECT_EQ(missed(Kind::vertex_face, 4), 0);
  EXPECT_EQ(missed(Kind::edge_edge, 4), 3);
}

// ---- Methods for curves -------------------------------------------------------------------------

constexpr QueryShape parabolas{.kind = Kind::vertex_face, .degree = 2};

fast::Answer answer_to(const fast::Method& method, const std::vector<double>& numbers,
                       const fast::MethodOptions& options = {}) {
  fast::Answer answer;
  method.solve(Queries(parabolas, numbers), {&answer, 1}, options);
  return answer;
}

/// A vertex at (x, 1, z) whose coordinates have these control values, and a triangle at rest in the
/// plane z=0, with corners 0, (4,0) and (0,4).
std::vector<double> over_resting_triangle(const std::array<double, 3>& x,
                                          const std::array<double, 3>& z) {
  std::vector<double> numbers;
  for (std::size_t j = 0; j < 3; ++j) {
    for (const double number : {x.at(j), 1.0, z.at(j), 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 4.0, 0.0})
      numbers.push_back(number);
  }
  return numbers;
}

/// Both primitives bulge towards each other between their ends, by 3/8 each, and are 1/2 apart
/// there: chords come within the sum of the deviations, and not within the greater one.
std::vector<double> bulging() {
  std::vector<double> numbers;
  for (const double bulge : {0.0, 0.75, 0.0}) {
    for (const double x :
         {0.0, 0.0, 0.5 - bulge, -1.0, -1.0, bulge, 2.0, -1.0, bulge, -1.0, 2.0, bulge}) {
      numbers.push_back(x);
    }
  }
  return numbers;
}

/// z = 4 (t − 0.505)² − 1e-5: below the plane for less than 0.01.
std::vector<double> dipping() {
  constexpr double start = 4.0 * 0.505 * 0.505 - 1e-5, end = 4.0 * 0.495 * 0.495 - 1e-5;
  return over_resting_triangle({1, 1, 1}, {start, start - 4.0 * 0.505, end});
}

/// x = t − 0.505 in the plane of the triangle.
std::vector<double> sliding() { return over_resting_triangle({-0.505, -0.005, 0.495}, {0, 0, 0}); }

/// z = 4 (t − 0.3)² + 5e-7: never in contact, and within the tolerance.
std::vector<double> near_miss() {
  constexpr double start = 0.36 + 5e-7;
  return over_resting_triangle({1, 1, 1}, {start, start - 1.2, 1.96 + 5e-7});
}

struct CurvedRow {
  const char* name;
  std::vector<double> numbers;
  bool collides;
  /// The verdicts of subdivision, with the largest deviation, of sampling and of advancement.
  std::array<Verdict, 4> said;
};

TEST(CurvedMethods, AreWrongWhereKnown) {
  const std::array methods{subdivision_method(), subdivision_largest_deviation_method(),
                           sampling_method(), advancement_method()};
  for (const CurvedRow& row :
       {CurvedRow{"bulging", bulging(), true, {yes, no, no, yes}},
        {"dipping", dipping(), true, {yes, yes, no, yes}},
        {"sliding", sliding(), true, {yes, yes, yes, yes}},
        {"near miss", near_miss(), false, {yes, yes, yes, yes}},
        {"far", over_resting_triangle({1, 1, 1}, {1, 2, 1}), false, {no, no, no, no}}}) {
    EXPECT_EQ(exact::decide(Queries(parabolas, row.numbers), 0).collides(), row.collides)
        << row.name;
    for (std::size_t i = 0; i < methods.size(); ++i) {
      EXPECT_EQ(answer_to(*methods.at(i), row.numbers).verdict, row.said.at(i))
          << row.name << ' ' << methods.at(i)->name();
    }
  }
  // Sampling is late there, and subdivision is not.
  EXPECT_EQ(answer_to(*methods[2], sliding()).toi_lower, 0.51);
  EXPECT_LT(*exact::decide(Queries(parabolas, sliding()), 0).toi, exact::Rational(0.51));
  EXPECT_NEAR(answer_to(*methods[0], sliding()).toi_lower, 0.505, 1e-5);
}

TEST(CurvedMethods, HeedTMaxAndRefuseWhatIsNotFinite) {
  for (const auto& method : {subdivision_method(), subdivision_largest_deviation_method(),
                             sampling_method(), advancement_method()}) {
    EXPECT_EQ(answer_to(*method, sliding(), {.t_max = 0.5}).verdict, Verdict::no) << method->name();
    std::vector<double> bad = sliding();
    bad[20] = std::nan("");
    EXPECT_EQ(answer_to(*method, bad).verdict, Verdict::error) << method->name();
    const fast::Terms& terms = method->info().terms;
    EXPECT_FALSE(terms.answers({.kind = Kind::edge_edge})) << "straight lines";
    EXPECT_TRUE(terms.answers({.kind = Kind::edge_edge, .degree = 8}));
    EXPECT_FALSE(terms.answers({.kind = Kind::edge_edge, .degree = 2, .is_rational = true}));
  }
}

}  // namespace
}  // namespace touchstone::baselines::known_defects_test
