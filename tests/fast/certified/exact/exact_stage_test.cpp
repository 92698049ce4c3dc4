#include "fast/certified/exact/exact_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exact/oracle.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/trials.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast {

namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<double, 4> tolerances{0.0, 1e-12, 0.1, 1e300};

double below(double x) { return std::nextafter(x, 0.0); }

/// Is the enclosure as promised?
void expect_enclosure(const PosedQuery& posed, const exact::AlgebraicNumber& toi,
                      const ExactImpact& impact, double tolerance) {
  const Rational lower(impact.toi_lower), upper(impact.toi_upper);
  if (toi == Rational(0)) {
    EXPECT_TRUE(impact.toi_lower == 0.0 && impact.toi_upper == 0.0) << posed;
    return;
  }
  EXPECT_TRUE(toi > lower && toi <= upper) << posed << impact.toi_lower << ' ' << impact.toi_upper;
  const Rational spacing = upper - Rational(below(impact.toi_upper));
  EXPECT_LE(Rational(upper - lower), std::max(spacing, Rational(Rational(tolerance) * upper)))
      << posed;
  if (tolerance == 0.0) {
    EXPECT_EQ(impact.toi_lower, below(impact.toi_upper)) << posed;
  }
}

/// Is (u,v) in the domain, and F(toi,u,v) near 0 on every axis, relative to its coordinates? By
/// toi_upper F has moved on: corners are differences of coordinates, at most 4 of these apart.
void expect_contact(const PosedQuery& posed, const ExactImpact& impact) {
  const Rational u(impact.u), v(impact.v);
  EXPECT_TRUE(u >= 0 && v >= 0) << posed;
  const bool face = posed.kind == Kind::vertex_face;
  EXPECT_TRUE(face ? u + v <= 1 : u <= 1 && v <= 1) << posed << impact.u << ' ' << impact.v;
  const auto f =
      contact_function<Rational>(posed.kind, posed.query, Rational(impact.toi_upper), u, v);
  const Rational moved = 4 * (Rational(impact.toi_upper) - Rational(impact.toi_lower));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Rational largest = 0;
    for (std::size_t i = 0; i < query_points; ++i) {
      largest = std::max(
          largest,
          Rational(abs(Rational(posed.query.at(i / moving_points, i % moving_points, axis)))));
    }
    EXPECT_LE(abs(f[axis]), largest * (exact::power_of_two(-43) + moved)) << posed;
  }
}

/// Verdict, enclosure, contact, and t_max around the time of impact, all against the oracle.
void expect_truth(const PosedQuery& posed, double tolerance) {
  const exact::Verdict truth = exact::decide(posed.kind, posed.query);
  const auto impact = decide_exactly(posed.kind, posed.query, tolerance, 1.0);
  ASSERT_EQ(impact.has_value(), truth.collides()) << posed;
  if (!impact) return;
  expect_enclosure(posed, *truth.toi, *impact, tolerance);
  if (tolerance <= 1e-12) expect_contact(posed, *impact);
  const auto collides_until = [&](double t_max) {
    return decide_exactly(posed.kind, posed.query, tolerance, t_max).has_value();
  };
  EXPECT_TRUE(collides_until(impact->toi_upper)) << posed;
  if (impact->toi_upper == 0.0) return;
  EXPECT_FALSE(collides_until(impact->toi_lower)) << posed;
  const exact::DoubleInterval cell = truth.toi->enclosure();
  EXPECT_TRUE(collides_until(cell.upper)) << posed;
  EXPECT_FALSE(collides_until(below(cell.upper))) << posed;
}

TEST(ExactStage, AgreesWithTheOracleOnAllFamilies) {
  constexpr std::uint64_t count = tests::trials(200U);
  std::size_t turn = 0;
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const Kind kind : kinds) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t i = 0; i < count; ++i) {
        SCOPED_TRACE(std::string(family.name) + ' ' + std::to_string(i));
        expect_truth({kind, verify::generate::make_query(family, kind, 1, i).query},
                     tolerances[turn++ % tolerances.size()]);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(ExactStage, KnowsTheTruthOfTheFamiliesByConstruction) {
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const Kind kind : kinds) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t i = 0; i < tests::trials(300U); ++i) {
        const verify::generate::KnownQuery known = verify::generate::make_query(family, kind, 2, i);
        const auto impact = decide_exactly(kind, known.query, 1e-12, 1.0);
        ASSERT_EQ(impact.has_value(), known.collides) << family.name << ' ' << i;
        if (!known.toi) continue;
        EXPECT_LE(*known.toi, Rational(impact->toi_upper)) << family.name << ' ' << i;
        EXPECT_TRUE(*known.toi > Rational(impact->toi_lower) || impact->toi_upper == 0.0);
      }
    }
  }
}

void expect_truth_of_integers(int bound, std::uint64_t seed, int count) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2],
                           tests::integer_query(random, bound)};
    expect_truth(posed, tolerances[static_cast<std::size_t>(i) % tolerances.size()]);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ExactStage, AgreesWithTheOracleOnTinyIntegers) {
  expect_truth_of_integers(1, 3, tests::trials(10000));
}

TEST(ExactStage, AgreesWithTheOracleOnSmallIntegers) {
  expect_truth_of_integers(2, 4, tests::trials(20000));
}

TEST(ExactStage, AgreesWithTheOracleOnFullSignificands) {
  Random random(5);
  for (int i = 0; i < tests::trials(1500); ++i) {
    const Kind kind = kinds[static_cast<std::size_t>(i) % 2];
    for (const auto family : {tests::Family::full_significands, tests::Family::near_contact}) {
      expect_truth(tests::random_query(random, kind, family),
                   tolerances[static_cast<std::size_t>(i) % tolerances.size()]);
    }
    if (HasFailure()) return;
  }
}

TEST(ExactStage, AgreesWithTheOracleOnSmallIntegersPerturbedInTheLastPlace) {
  Random random(6);
  for (int i = 0; i < tests::trials(2000); ++i) {
    PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2], tests::integer_query(random, 2)};
    for (double& x : posed.query.coordinates) {
      if (random.between(0, 3) == 0) x = std::nextafter(x, random.coin() ? 4.0 : -4.0);
    }
    expect_truth(posed, tolerances[static_cast<std::size_t>(i) % tolerances.size()]);
    if (HasFailure()) return;
  }
}

TEST(ExactStage, AgreesWithTheOracleOnMagnitudesOfTheWholeRange) {
  Random random(7);
  for (int i = 0; i < 40; ++i) {
    PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2], {}};
    for (double& x : posed.query.coordinates) x = random.finite_double();
    expect_truth(posed, 0.0);
    if (HasFailure()) return;
  }
}

TEST(ExactStage, AgreesWithTheOracleOnDegeneraciesOfMixedMagnitudes) {
  Random random(8);
  constexpr std::array<double, 6> values{0.0, 1.0, 5e-324, 1e308, -1e308, 0x1p-600};
  for (int i = 0; i < tests::trials(200); ++i) {
    PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2], {}};
    for (double& x : posed.query.coordinates) {
      x = values[random.bits() % values.size()];
      if (random.coin()) x = random.between(-1, 1);
    }
    tests::degenerate(random, posed.query);
    const bool finite =
        std::ranges::all_of(posed.query.coordinates, [](double x) { return std::isfinite(x); });
    if (finite) expect_truth(posed, tolerances[static_cast<std::size_t>(i) % 2]);
    if (HasFailure()) return;
  }
}

TEST(ExactStage, AgreesWithTheOracleOnSubnormals) {
  Random random(9);
  for (int i = 0; i < tests::trials(1000); ++i) {
    PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2], tests::integer_query(random, 3)};
    for (double& x : posed.query.coordinates) x *= std::numeric_limits<double>::denorm_min();
    expect_truth(posed, 0.0);
    if (HasFailure()) return;
  }
}

TEST(ExactStage, EnclosesATinyTimeOfImpact) {
  // From height 5e-324 down by 1e308: far below the least double.
  const PosedQuery least = tests::over_triangle(1, 1, 5e-324, -1e308);
  const auto impact = decide_exactly(least.kind, least.query, 1e-12, 1.0);
  ASSERT_TRUE(impact.has_value());
  EXPECT_EQ(impact->toi_lower, 0.0);
  EXPECT_EQ(impact->toi_upper, std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(impact->u, 0.25);
  EXPECT_EQ(impact->v, 0.25);
  EXPECT_FALSE(decide_exactly(least.kind, least.query, 0.0, 0.0).has_value());
  // 2^-1000 + 2^-1040, subnormal tolerances included.
  const PosedQuery small = tests::over_triangle(1, 1, 0x1p-500, 0x1p-500 - 0x1p500);
  expect_truth(small, 0.0);
  expect_truth(small, 1e-12);
  expect_truth(small, 5e-324);
}

TEST(ExactStage, AnIrrationalTimeOfImpactIsBetweenNeighbours) {
  // The triangle turns by t x = y and the vertex is at x = 1 − t, y = 1/8: 8 t (1 − t) = 1; at the
  // first root the vertex is still beside the triangle.
  const PosedQuery posed = tests::turning_triangle(1, 1, 0, 0.125);
  const auto impact = decide_exactly(posed.kind, posed.query, 0.0, 1.0);
  ASSERT_TRUE(impact.has_value());
  const double toi = 0.5 + std::sqrt(0.125);
  EXPECT_NEAR(impact->toi_upper, toi, 1e-15);
  expect_truth(posed, 0.0);
}

/// The result in another rounding mode.
std::optional<ExactImpact> decide_rounding(int mode, const PosedQuery& posed) {
  const int before = std::fegetround();
  std::fesetround(mode);
  const auto result = decide_exactly(posed.kind, posed.query, 0.0, 1.0);
  std::fesetround(before);
  return result;
}

TEST(ExactStage, DoesNotDependOnTheRoundingMode) {
  Random random(10);
  for (int i = 0; i < 3000; ++i) {
    const auto family = tests::all_families[static_cast<std::size_t>(i) % 4];
    const PosedQuery posed =
        tests::random_query(random, kinds[static_cast<std::size_t>(i) % 2], family);
    const auto expected = decide_exactly(posed.kind, posed.query, 0.0, 1.0);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      const auto result = decide_rounding(mode, posed);
      ASSERT_EQ(result.has_value(), expected.has_value()) << posed;
      if (!result) continue;
      EXPECT_EQ(result->toi_lower, expected->toi_lower) << posed;
      EXPECT_EQ(result->toi_upper, expected->toi_upper) << posed;
      expect_contact(posed, *result);
    }
  }
}

#ifdef __SSE2__
TEST(ExactStage, DoesNotDependOnFlushedSubnormals) {
  Random random(11);
  constexpr unsigned flush_and_zero = 0x8040;
  for (int i = 0; i < 500; ++i) {
    PosedQuery posed{kinds[static_cast<std::size_t>(i) % 2], tests::integer_query(random, 3)};
    for (double& x : posed.query.coordinates) x *= std::numeric_limits<double>::denorm_min();
    const auto expected = decide_exactly(posed.kind, posed.query, 0.0, 1.0);
    const unsigned before = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(before | flush_and_zero);
    const auto result = decide_exactly(posed.kind, posed.query, 0.0, 1.0);
    __builtin_ia32_ldmxcsr(before);
    ASSERT_EQ(result.has_value(), expected.has_value()) << posed;
    if (!result) continue;
    EXPECT_EQ(result->toi_lower, expected->toi_lower) << posed;
    EXPECT_EQ(result->toi_upper, expected->toi_upper) << posed;
  }
}
#endif

// ---- Planted faults -----------------------------------------------------------------------------

bool is_wrong(tests::DecideExactly& decide, Kind kind, const Query& query) {
  const auto impact = decide(kind, query, {}, 1e-12, 1.0);
  const exact::Verdict truth = exact::decide(kind, query);
  if (impact.has_value() != truth.collides()) return true;
  if (!impact) return false;
  const exact::AlgebraicNumber& toi = *truth.toi;
  return toi > Rational(impact->toi_upper) ||
         (impact->toi_upper != 0 && toi <= Rational(impact->toi_lower));
}

/// The determinant has a root at t=1/2 or 3/4, outside the domain, and another one just before it, nearer
/// with each of these nudges. Found by the fuzzer.
std::vector<PosedQuery> neighbouring_roots() {
  const Query edges{{0.0,    0.0,    -0.875, 0.125,  -1.125, 0.0,    -1.125, -2.375,
                     -0.875, 3.4375, 5.25,   2.375,  0.125,  0.0,    0.875,  0.0,
                     1.125,  0.0,    -1.0,   -1.125, -0.875, 3.4375, 5.25,   2.875}};
  const Query face{{-0.75,     0.0,       0.0,  -2.25,     0.046875, -2.25,    0.0, -0.1171875,
                    2.25,      0.0078125, 2.25, 0.0,       0.25,     -0.03125, 0.0, 0.75,
                    -0.046875, 0.75,      0.0,  0.0078125, -0.75,    0.0,      0.0, 0.0}};
  std::vector<PosedQuery> result;
  for (int nudge = 1; nudge <= 64; ++nudge) {
    result.push_back({Kind::edge_edge, edges});
    result.back().query.coordinates[23] -= nudge * 0x1p-48;
    result.push_back({Kind::vertex_face, face});
    result.back().query.coordinates[13] += nudge * 0x1p-48;
  }
  return result;
}

TEST(ExactStage, SeparatesARootFromOneBesideIt) {
  std::size_t collisions = 0;
  for (const PosedQuery& posed : neighbouring_roots()) {
    for (const double tolerance : tolerances) expect_truth(posed, tolerance);
    if (HasFailure()) return;
    if (exact::decide(posed.kind, posed.query).collides()) ++collisions;
  }
  EXPECT_GT(collisions, 64U);
}

/// How many families have an answer that is wrong.
std::size_t families_that_find(tests::DecideExactly& decide) {
  return static_cast<std::size_t>(std::ranges::count_if(
      verify::generate::families(), [&](const verify::generate::Family& family) {
        for (const Kind kind : kinds) {
          if (!verify::generate::supports(family, kind)) continue;
          for (std::uint64_t i = 0; i < 50; ++i) {
            if (is_wrong(decide, kind, verify::generate::make_query(family, kind, 5, i).query))
              return true;
          }
        }
        return false;
      }));
}

TEST(ExactStage, FamiliesFindPlantedFaultsAndNoOthers) {
  EXPECT_EQ(families_that_find(decide_exactly), 0U);
  const std::vector<PosedQuery> neighbours = neighbouring_roots();
  for (const auto& fault : tests::planted_faults().exact_stage) {
    if (fault.separation.distance > 0.0) continue;
    const std::size_t found = families_that_find(*fault.part);
    const auto neighbours_found = std::ranges::count_if(neighbours, [&](const PosedQuery& posed) {
      return is_wrong(*fault.part, posed.kind, posed.query);
    });
    std::printf("%s: found by %zu families and %td neighbouring roots\n", fault.name.data(), found,
                neighbours_found);
    EXPECT_TRUE(found > 0 || neighbours_found > 32) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast
