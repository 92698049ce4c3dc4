#include "fast/certified/exact/exact_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fast/certified/block.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast::exact_stage_test {
namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<double, 4> tolerances{0.0, 1e-12, 0.1, 1e300};

void expect_truth(const PosedQuery& posed, double tolerance) {
  const CertifiedOptions options{.toi_tolerance = tolerance};
  const CertifiedResult result = fast::decided_exactly(posed.kind, posed.query, options);
  EXPECT_EQ(tests::fault(posed.kind, posed.query, result, options).value_or(""), "") << posed;
}

TEST(ExactStage, EnclosesATinyTimeOfImpact) {
  // The height falls from 5e-324 by 1e308: the toi is far below the least double.
  const PosedQuery least = tests::over_triangle(1, 1, 5e-324, -1e308);
  const auto impact = decide_exactly(least.kind, least.query, 1e-12, 1.0);
  ASSERT_TRUE(impact.has_value());
  EXPECT_EQ(impact->toi_lower, 0.0);
  EXPECT_EQ(impact->toi_upper, std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(impact->u, 0.25);
  EXPECT_EQ(impact->v, 0.25);
  EXPECT_FALSE(decide_exactly(least.kind, least.query, 0.0, 0.0).has_value());
  // The toi 2^-1000 + 2^-1040, with subnormal tolerances.
  const PosedQuery small = tests::over_triangle(1, 1, 0x1p-500, 0x1p-500 - 0x1p500);
  expect_truth(small, 0.0);
  expect_truth(small, 1e-12);
  expect_truth(small, 5e-324);
}

// ---- Planted faults -----------------------------------------------------------------------------

bool is_wrong(tests::DecideExactly& decide, Kind kind, const Query& query) {
  const auto impact = decide(kind, query, {}, 1e-12, 1.0);
  const exact::Decision truth = exact::decide(kind, query);
  if (impact.has_value() != truth.collides()) return true;
  if (!impact) return false;
  const exact::AlgebraicNumber& toi = *truth.toi;
  return toi > Rational(impact->toi_upper) ||
         (impact->toi_upper != 0 && toi <= Rational(impact->toi_lower));
}

/// Queries whose determinant has a root at t=1/2 or 3/4, outside the domain, and another just
/// before it, nearer with each of these nudges. Found by the fuzzer.
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

/// The number of families with a wrong answer.
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
}  // namespace touchstone::fast::exact_stage_test
