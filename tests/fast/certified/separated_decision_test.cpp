#include "fast/certified/separated_decision.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "exact/distance_oracle.hpp"
#include "exact/oracle.hpp"
#include "fast/certified/exact_stage.hpp"
#include "tests/fast/certified/decisions.hpp"
#include "tests/support/queries.hpp"
#include "verify/families/families.hpp"

namespace touchstone::fast::exact_stage {
namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<Norm, 2> norms{Norm::linf, Norm::l2};
constexpr std::array<double, 5> distances{1e-2, 1e-8, 1e-16, 1e-30, 1e-100};
constexpr double denorm_min = std::numeric_limits<double>::denorm_min();

double below(double x) { return std::nextafter(x, 0.0); }

std::optional<ExactImpact> decide(const PosedQuery& posed, const Separation& separation,
                                  double t_max = 1.0) {
  return decide_exactly(posed.kind, posed.query, separation, 0.0, t_max);
}

/// Is the impact at `toi`, between neighbouring doubles, and in the domain?
void expect_impact(const PosedQuery& posed, const ExactImpact& impact,
                   const exact::AlgebraicNumber& toi) {
  EXPECT_TRUE(toi <= Rational(impact.toi_upper)) << posed;
  if (toi == Rational(0)) {
    EXPECT_TRUE(impact.toi_lower == 0.0 && impact.toi_upper == 0.0) << posed;
  } else {
    EXPECT_TRUE(toi > Rational(impact.toi_lower)) << posed;
    EXPECT_EQ(impact.toi_lower, below(impact.toi_upper)) << posed;
  }
  const Rational u(impact.u), v(impact.v);
  EXPECT_TRUE(u >= 0 && v >= 0) << posed;
  EXPECT_TRUE(posed.kind == Kind::vertex_face ? u + v <= 1 : u <= 1 && v <= 1) << posed;
}

/// Verdict and enclosure against the oracle.
void expect_truth(const PosedQuery& posed, const Separation& separation) {
  const exact::DistanceVerdict truth = exact::decide(posed.kind, posed.query, separation);
  const auto impact = decide(posed, separation);
  ASSERT_EQ(impact.has_value(), truth.collides())
      << posed << ' ' << to_string(separation.norm) << ' ' << separation.distance;
  if (impact) expect_impact(posed, *impact, *truth.toi);
}

void expect_truth(const PosedQuery& posed) {
  for (const Norm norm : norms) {
    for (const double distance : distances) expect_truth(posed, {distance, norm});
  }
}

TEST(SeparatedDecision, AgreesWithTheOracleOnRandomQueries) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Kind kind = kinds[static_cast<std::size_t>(i) % 2];
    for (const tests::Family family : tests::all_families) {
      expect_truth(tests::random_query(random, kind, family));
    }
    if (HasFailure()) return;
  }
}

TEST(SeparatedDecision, AgreesWithTheOracleOnAllFamilies) {
  for (const verify::Family& family : verify::families()) {
    for (const Kind kind : kinds) {
      if (!verify::supports(family, kind)) continue;
      for (std::uint64_t i = 0; i < 2; ++i) {
        SCOPED_TRACE(std::string(family.name) + ' ' + std::to_string(i));
        expect_truth({kind, verify::make_query(family, kind, 3, i).query});
        if (HasFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::fast::exact_stage
