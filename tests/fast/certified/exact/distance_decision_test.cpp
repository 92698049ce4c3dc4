#include "fast/certified/exact/distance_decision.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "fast/certified/block.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "tests/faults/limb_products.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::exact_stage::distance_decision_test {
namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<Norm, 2> norms{Norm::linf, Norm::l2};
constexpr double denorm_min = std::numeric_limits<double>::denorm_min();

double below(double x) { return std::nextafter(x, 0.0); }

std::optional<ExactImpact> decide(const PosedQuery& posed, const Separation& separation,
                                  double t_max = 1.0) {
  return decide_exactly(posed.kind, posed.query, separation, 0.0, t_max);
}

/// Expects the first time within the separation between neighbouring doubles.
void expect_truth(const PosedQuery& posed, const CertifiedResult& result,
                  const Separation& separation) {
  const CertifiedOptions options{.toi_tolerance = 0.0, .separation = separation};
  EXPECT_EQ(tests::fault(posed.kind, posed.query, result, options).value_or(""), "") << posed;
}

// ---- Known by construction ----------------------------------------------------------------------

/// Expects the first time within the distance to be the double `toi`, or none if it is `never`.
constexpr double never = 2.0;
void expect_time(const PosedQuery& posed, const Separation& separation, double toi) {
  const auto impact = decide(posed, separation);
  ASSERT_EQ(impact.has_value(), toi != never) << posed;
  if (!impact) return;
  EXPECT_EQ(impact->toi_upper, toi) << posed;
  EXPECT_EQ(impact->toi_lower, toi == 0.0 ? 0.0 : below(toi)) << posed;
  EXPECT_TRUE(decide(posed, separation, toi).has_value()) << posed;
  if (toi > 0.0) {
    EXPECT_FALSE(decide(posed, separation, below(toi)).has_value()) << posed;
  }
}

/// Primitives over each other, at height z0 and then z1.
PosedQuery over(Kind kind, double z0, double z1) {
  return kind == Kind::vertex_face ? tests::over_triangle(1, 1, z0, z1)
                                   : tests::over_edge(1, 1, z0, z1);
}

/// Primitives beside each other, nearest at corners with the difference (3,4,z), z from z0 to z1;
/// as points if they are to be degenerate.
PosedQuery beside(Kind kind, bool as_points, double z0, double z1) {
  const double size = as_points ? 0.0 : 4.0;
  if (kind == Kind::vertex_face) {
    const auto at = [size](double z) {
      return tests::FourPoints{-3, -4, z, 0, 0, 0, size, 0, 0, 0, size, 0};
    };
    return tests::vertex_face(at(z0), at(z1));
  }
  const auto at = [size](double z) {
    return tests::FourPoints{0, 0, 0, size, 0, 0, -3, 4, z, -3, 4 + size, z};
  };
  return tests::edge_edge(at(z0), at(z1));
}

/// (Between heights 2 and −2 the least distance is reached shortly before 1/2.)
TEST(SeparatedDecision, ContactAtTheDistanceCountsInTheWholeRange) {
  constexpr double largest = std::numeric_limits<double>::max();
  struct Row {
    double z0, z1, distance, toi;
  };
  for (const auto& [z0, z1, distance, toi] :
       {Row{3, -1, 1, 0.5}, Row{1, 3, 1, 0}, Row{0.5, 3, 1, 0}, Row{3, 1, 1, 1},
        Row{3, 1, below(1), never}, Row{1, 3, below(1), never}, Row{1, 0x1p-60, largest, 0},
        Row{1, denorm_min, denorm_min, 1}, Row{1, 2 * denorm_min, denorm_min, never},
        Row{largest, denorm_min, denorm_min, 1}, Row{2, -2, denorm_min, 0.5}}) {
    for (const Kind kind : kinds) {
      for (const Norm norm : norms) expect_time(over(kind, z0, z1), {distance, norm}, toi);
    }
  }
}

TEST(SeparatedDecision, GrazingCounts) {
  for (const Kind kind : kinds) {
    for (const bool as_points : {false, true}) {
      const PosedQuery posed = beside(kind, as_points, -8, 8);
      expect_time(posed, {5.0, Norm::l2}, 0.5);
      expect_time(posed, {below(5.0), Norm::l2}, never);
      expect_time(posed, {13.0, Norm::l2}, 0.0);
      expect_time(posed, {4.0, Norm::linf}, 0.25);
      expect_time(posed, {5.0, Norm::linf}, 0.1875);
      expect_time(posed, {below(4.0), Norm::linf}, never);
    }
  }
}

TEST(SeparatedDecision, NearestParametersAreThoseOfTheCorner) {
  const auto face = decide(beside(Kind::vertex_face, false, -8, 8), {5.0, Norm::l2});
  ASSERT_TRUE(face.has_value());
  EXPECT_EQ(face->u, 0.0);
  EXPECT_EQ(face->v, 0.0);
  const auto edges = decide(over(Kind::edge_edge, 3, -1), {1.0, Norm::l2});
  ASSERT_TRUE(edges.has_value());
  EXPECT_EQ(edges->u, 0.25);
  EXPECT_EQ(edges->v, 0.25);
}

/// The height falls from 1 + k 2^-52 by about 2^1000, to 1 at about k 2^-1052: the enclosure has
/// the documented width also if the time is subnormal.
TEST(SeparatedDecision, SubnormalTimesAreEnclosedByOneSpacing) {
  for (const Kind kind : kinds) {
    for (const Norm norm : norms) {
      for (const int k : {1, 3, 1000}) {
        const PosedQuery posed = over(kind, 1.0 + k * 0x1p-52, -0x1p1000);
        const Separation one{1.0, norm};
        for (const double tolerance : {0.0, 1e-12, 0.1}) {
          const CertifiedResult result = fast::decided_exactly(
              kind, posed.query, {.toi_tolerance = tolerance, .separation = one});
          ASSERT_LT(result.toi_upper, std::numeric_limits<double>::min());
          expect_truth(posed, result, one);
        }
      }
    }
  }
}

/// A query whose first form has a root just before t=1; a later form is negative for a while before
/// that.
PosedQuery dipping_query() {
  return tests::edge_edge({0, 3, -3, -8, 7, 9, 0, 0, 0, 1, -1, -5},
                          {0x1.8000000002316p+0, -0x1.800000000694p+0, -0x1.c000000001764p+2,
                           -0x1.8000000000bb2p+3, 0x1.300000000074fp+3, 0x1.bfffffffff44ep+2, 0, 0,
                           0, 1, -0x1.400000000118bp+1, -0x1.7ffffffffe89cp+1});
}

TEST(SeparatedDecision, DipsBeforeASeparatorsEndCount) {
  const PosedQuery dipping = dipping_query();
  const Separation separation{2.0, Norm::linf};
  const CertifiedOptions options{.toi_tolerance = 0.0, .separation = separation};
  const CertifiedResult result = fast::decided_exactly(dipping.kind, dipping.query, options);
  EXPECT_EQ(result.verdict, Verdict::yes);
  expect_truth(dipping, result, separation);
}

// ---- Work ---------------------------------------------------------------------------------------

/// Queries whose roots are almost equal: tiny coordinates among those that nearly overflow make
/// roots that differ by parts of 2^-2000, 2^-4000 and so on. Each once took seconds or more.
struct Slow {
  PosedQuery posed;
  Separation separation;
  std::optional<double> toi_upper;  ///< from an earlier bisection in integers
};

std::vector<Slow> slow_queries() {
  constexpr double s = 0x1p-1074, l = 0x1p1022;
  return {
      {tests::vertex_face({s, -l, -l, -l, l, -s, -l, s, s, l, -s, -l},
                          {-l, s, -s, -s, -l, -s, -s, l, s, s, l, l}),
       {l, Norm::l2},
       0x1.9c3be0c5b2633p-2},
      {tests::edge_edge({-s, -l, s, l, -l, s, l, s, l, l, s, s},
                        {-s, l, l, -l, s, -s, -l, -s, s, -s, -s, s}),
       {0x1p-942, Norm::linf},
       0.5},
      {tests::vertex_face({0, -l, 0, -s, 0, s, 0, -l, -l, 0, 0, 0},
                          {-l, 0, 0, l, 0, 0, 0, 0, 0, 0, s, l}),
       {0x1p-496, Norm::l2},
       std::nullopt},
      {tests::edge_edge({0, 0, 0x1.ep977, 0x1.4p-1000, 0x1.ap949, 0, 0, 0, -0x1.8p-999, 0, 0, 0},
                        {0, 0, -0x1.ap-981, -0x1.ap988, -0x1p904, 0, 0, 0, 0, -0x1.8p-999,
                         -0x1.ap988, -0x1.ep1003}),
       {0x1.ep454, Norm::l2},
       1.0},
      {tests::edge_edge(
           {0, -2 * s, -1.5 * l, 1.875 * l, 0, -2 * s, 0, -2 * s, -2 * s, 0, 0, -1.125 * l},
           {l, 0, -2 * s, -s, 0, 0, -2 * s, 0, 0, -2 * s, l, 0}),
       {0x1.ap-903, Norm::l2},
       1.0},
      {tests::vertex_face({-l, -l, s, -s, l, s, l, l, -s, s, s, -l},
                          {-s, -s, l, l, s, -s, -s, s, s, l, l, l}),
       {0x1p-685, Norm::l2},
       std::nullopt},
      {tests::edge_edge({-1.375, 0, 0, 0, 0, 0, 0, 0, -1.625, 0, 1, 0},
                        {1.25, 0, 0, 0, 0, 0, 0, 0, 0, -1.5, -1.375, 0}),
       {0x1.8p-481, Norm::l2},
       1.0}};
}

TEST(SeparatedDecision, RootsThatAreHardlyApartTakeFewSteps) {
  constexpr std::uint64_t most = 400'000'000;  // less than half a second
  for (const auto& [posed, separation, toi_upper] : slow_queries()) {
    const auto impact = decide(posed, separation);
    ASSERT_EQ(impact.has_value(), toi_upper.has_value()) << posed;
    if (impact) {
      EXPECT_EQ(impact->toi_upper, *toi_upper) << posed;
    }
    for (const auto& counting : tests::planted_faults().counting) {
      tests::limb_products = 0;
      static_cast<void>(counting.part(posed.kind, posed.query, separation, 0.0, 1.0));
      EXPECT_LE(tests::limb_products, most) << posed;
      EXPECT_GT(tests::limb_products, 0U);
    }
  }
}

// ---- Planted faults -----------------------------------------------------------------------------

/// The number of wrong answers about small integers, at tiny distances and with contact near the
/// distance.
int wrong_answers(tests::DecideExactly& decide_so) {
  Random random(8);
  int wrong = 0;
  for (int i = 0; i < 400; ++i) {
    const PosedQuery posed{kinds[random.bits() % 2], tests::integer_query(random, 3)};
    const Separation separation{i % 4 == 0 ? 1e-40 : 0.8, norms[random.bits() % 2]};
    const auto truth = exact::decide(posed.kind, posed.query, separation);
    const auto impact = decide_so(posed.kind, posed.query, separation, 0.0, 1.0);
    const bool right = impact.has_value() == truth.collides() &&
                       (!impact || (*truth.toi <= Rational(impact->toi_upper) &&
                                    *truth.toi >= Rational(impact->toi_lower)));
    if (!right) ++wrong;
  }
  return wrong;
}

TEST(SeparatedDecision, PlantedFaultsAreFoundAndNoOthers) {
  EXPECT_EQ(wrong_answers(decide_exactly), 0);
  const PosedQuery dipping = dipping_query();
  for (const auto& fault : tests::planted_faults().exact_stage) {
    if (fault.separation.distance == 0.0) continue;
    const int found = wrong_answers(*fault.part);
    const bool is_dip_missed =
        !fault.part(dipping.kind, dipping.query, {2.0, Norm::linf}, 0.0, 1.0).has_value();
    std::printf("%s: %d wrong answers\n", fault.name.data(), found);
    EXPECT_TRUE(found > 0 || is_dip_missed) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::distance_decision_test
