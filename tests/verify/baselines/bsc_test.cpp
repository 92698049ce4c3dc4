/// \file
/// BSC is right without inflections and common planes, and wrong in the cases and the way that its
/// header states.

#include "verify/baselines/bsc.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "tests/support/baselines.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::baselines::bsc_test {
namespace {

using tests::PosedQuery;
using tests::Random;
using tests::says_yes;

const fast::Method& bsc() {
  static const std::unique_ptr<const fast::Method> method = baselines::bsc_method();
  return *method;
}

bool throws(const PosedQuery& posed) {
  try {
    (void)bsc_collides(posed.kind, posed.query);
    return false;
  } catch (const std::domain_error&) {
    return true;
  }
}

TEST(Bsc, ThrowsAtAnInflectionAndRestoresTheRounding) {
  EXPECT_TRUE(throws(tests::printed_query("inflection")));
  EXPECT_EQ(tests::one_and_a_little(), 1.0);
  EXPECT_FALSE(throws(tests::over_triangle(1, 1, 1, -1)));
}

TEST(Bsc, IsRightInGeneralPositionButForInflections) {
  Random random(1);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    tests::Score without, with;
    for (int i = 0; i < tests::trials(4000); ++i) {
      const auto posed = random_query(random, kind, tests::Family::full_significands);
      (throws(posed) ? with : without).count(tests::truly_collides(posed), says_yes(bsc(), posed));
    }
    EXPECT_GT(without.collisions, tests::trials(40));
    EXPECT_EQ(without.false_negatives, 0);
    EXPECT_EQ(without.false_positives, 0);
    EXPECT_GT(with.no_collisions, tests::trials(500));
    EXPECT_EQ(with.false_negatives, 0);
    EXPECT_EQ(with.false_positives, with.no_collisions);
  }
}

TEST(Bsc, MissesEveryContactInACommonPlane) {
  Random random(3);
  int collisions = 0;
  for (int i = 0; i < tests::trials(500); ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      PosedQuery posed{kind, tests::full_significand_query(random)};
      tests::flatten(posed.query, 1);
      collisions += tests::truly_collides(posed) ? 1 : 0;
      EXPECT_FALSE(says_yes(bsc(), posed));
    }
  }
  EXPECT_GT(collisions, tests::trials(200));
  const PosedQuery crossing = tests::over_edge(1, 2, 0, 0);  // at rest
  EXPECT_TRUE(tests::truly_collides(crossing));
  EXPECT_FALSE(says_yes(bsc(), crossing));
}

TEST(Bsc, MissesByItsThresholdAtLargeScales) {
  // Contact at t=0, where Y is 0 and is computed as a rounding error: below the threshold at scale
  // 1, far above it at scale 2^40. If the others have its sign, that is a quick no.
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
    if (!tests::truly_collides(posed) || throws(posed)) continue;
    missed_at_1 += says_yes(bsc(), posed) ? 0 : 1;
    missed_at_large += says_yes(bsc(), scaled(posed, 40)) ? 0 : 1;
  }
  EXPECT_EQ(missed_at_1, 0);
  EXPECT_GT(missed_at_large, 0);
}

TEST(Bsc, IsExactAtEveryScaleBelow) {
  Random random(5);
  for (int i = 0; i < tests::trials(50); ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const auto posed = random_query(random, kind, tests::Family::full_significands);
      EXPECT_EQ(says_yes(bsc(), posed), says_yes(bsc(), scaled(posed, -400)));
      EXPECT_EQ(throws(posed), throws(scaled(posed, -400)));
    }
  }
}

}  // namespace
}  // namespace touchstone::baselines::bsc_test
