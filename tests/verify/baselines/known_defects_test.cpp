/// \file
/// What the built-in baselines are known to be wrong about, as the header of each states, and what
/// they are right about beside that: answers to single queries, whose defects the oracle confirms.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "tests/support/baselines.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/baselines/baselines.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::baselines::known_defects_test {
namespace {

using fast::Verdict;
using tests::Movement;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::vertex_face;
using tests::within;
using tests::yes_at;

constexpr std::array kinds{ContactKind::vertex_face, ContactKind::edge_edge};
constexpr Verdict yes = Verdict::yes, no = Verdict::no;
constexpr double infinity = std::numeric_limits<double>::infinity();
using Rows = std::vector<tests::SaidRow>;
constexpr bool wrong = true, right = false;

const fast::Method& method(std::string_view name) { return verify::solvers::find_method(name); }

/// The vertex or the edge moves from one height to another above the inside of the other primitive.
PosedQuery over(ContactKind kind, double from, double to) {
  return kind == ContactKind::vertex_face ? over_triangle(1, 1, from, to)
                                          : over_edge(1, 2, from, to);
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
             yes_at(0.9, 2)},
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
  for (const ContactKind kind : kinds) {
    // The distance 0.25 is reached at t=3/4.
    rows.insert(rows.end(), {{"accd", over(kind, 1, 0.05), {yes}, wrong},
                             {"accd", over(kind, 1, 0.2), {no}},
                             {"accd", over(kind, 1, 0), {yes, 0.66, 0.75}, right, within(0.25)},
                             {"accd", over(kind, 1, 0.5), {no}, right, within(0.25)},
                             {"accd", over(kind, 0.25, 1), yes_at(0.0, 0), right, within(0.25)}});
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
  for (const ContactKind kind : kinds) {
    rows.insert(rows.end(), {{"cubic", over(kind, 1, 5e-5), {yes}, wrong, {.tolerance = 1e-4}},
                             {"cubic", over(kind, 1, 2e-4), {no}, right, {.tolerance = 1e-4}},
                             {"cubic", over(kind, 0, 1), yes_at(0.0)},
                             {"cubic", over(kind, 1, 0), yes_at(1.0)},
                             {"cubic", over(kind, 1, 2), {no}}});
  }
  return rows;
}

TEST(KnownDefects, OfAccdAndCubic) {
  for (const Rows& rows : {rows_of_accd(), rows_of_cubic()}) {
    for (const tests::SaidRow& row : rows) tests::expect_said(method(row.method), row);
  }
}

TEST(Baselines, RefuseWhatMeansNothing) {
  const PosedQuery collision = over_triangle(1, 1, 1, -1);
  for (const char* const name : {"accd", "accd_limited", "cubic"}) {
    const auto verdict = [&](const PosedQuery& posed, const fast::MethodOptions& options = {}) {
      return tests::answer_to(method(name), posed, options).verdict;
    };
    for (const double bad : {-0.5, infinity, fast::Answer::none}) {
      for (const fast::MethodOptions& options : {fast::MethodOptions{.tolerance = bad},
                                                 {.tolerance = 0.0},
                                                 {.t_max = bad},
                                                 {.separation = {.distance = bad}}}) {
        EXPECT_EQ(verdict(collision, options), Verdict::error) << name;
      }
    }
    EXPECT_EQ(verdict(collision, {.t_max = 1.5}), Verdict::error) << name;
    EXPECT_NE(verdict(collision, {.t_max = 0.0}), Verdict::error) << name;
    PosedQuery bad = collision;
    bad.query.coordinates[11] = infinity;
    EXPECT_EQ(verdict(bad), Verdict::error) << name;
  }
}

TEST(Accd, StopsStrictlyBeforeContactAndCubicEstimatesIt) {
  EXPECT_EQ(method("cubic").info().terms.times, fast::Times::estimates);
  EXPECT_EQ(method("accd_limited").info().terms.starts_apart, 0.0);
  EXPECT_GT(tests::answer_to(method("accd"), beside_triangle(0x1p-20, 0), {.max_checks = 0}).checks,
            500'000U);
  tests::Random random(9);
  for (const ContactKind kind : kinds) {
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

// ---- Methods for curves -------------------------------------------------------------------------

constexpr QueryShape parabolas{.kind = ContactKind::vertex_face, .degree = 2};

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
    EXPECT_FALSE(terms.answers({.kind = ContactKind::edge_edge})) << "straight lines";
    EXPECT_TRUE(terms.answers({.kind = ContactKind::edge_edge, .degree = 8}));
    EXPECT_FALSE(terms.answers({.kind = ContactKind::edge_edge, .degree = 2, .is_rational = true}));
  }
}

}  // namespace
}  // namespace touchstone::baselines::known_defects_test
