/// \file
/// RP is right if the number of roots is odd or 0, and wrong in the cases and the way that its
/// header states.

#include "verify/baselines/rp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <memory>
#include <stdexcept>
#include <vector>

#include "tests/support/baselines.hpp"
#include "tests/support/root_count.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::baselines::rp_test {
namespace {

using tests::PosedQuery;
using tests::Random;
using tests::says_yes;

const fast::Method& rp() {
  static const std::unique_ptr<const fast::Method> method = baselines::rp_method();
  return *method;
}

TEST(Rp, SaysYesExactlyToOddNumbersOfRoots) {
  Random random(1);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    int odd = 0, missed = 0;
    for (int i = 0; i < 6000; ++i) {
      const PosedQuery posed = tests::deforming_query(random, kind);
      const int contacts = tests::count_contacts(posed);
      ASSERT_EQ(contacts > 0, tests::truly_collides(posed));
      EXPECT_EQ(says_yes(rp(), posed), contacts % 2 == 1) << contacts << " contacts: " << posed;
      odd += contacts % 2;
      missed += contacts == 2 ? 1 : 0;
    }
    EXPECT_GT(odd, 200);
    EXPECT_GT(missed, 8);
  }
}

TEST(Rp, FindsContactsThatItsRayStartsOn) {
  // Contact at t=0 and at t=1, at a corner and an edge's end, at rest, and in a plane through the
  // ray.
  EXPECT_TRUE(says_yes(rp(), tests::over_triangle(1, 1, 0, 1)));
  EXPECT_TRUE(says_yes(rp(), tests::over_triangle(1, 1, 1, 0)));
  EXPECT_TRUE(says_yes(rp(), tests::over_triangle(0, 0, 1, -1)));
  EXPECT_TRUE(says_yes(rp(), tests::over_triangle(1, 1, 0, 0)));
  EXPECT_TRUE(says_yes(rp(), tests::over_edge(0, 0, 1, -1)));
  EXPECT_TRUE(says_yes(rp(), tests::over_edge(1, 2, 0, 0)));
  EXPECT_FALSE(says_yes(rp(), tests::over_triangle(3, 3, 1, -1)));
  EXPECT_FALSE(says_yes(rp(), tests::over_edge(5, 2, 1, -1)));
}

TEST(Rp, TakesTheHullOfAnHourglassForThePatch) {
  // The edge f0 f1 turns over in the plane z=0 while f2 stays below: the patch is an hourglass
  // about (1/2, 0) in units of F, whose hull holds 0 although the patch does not.
  const PosedQuery beside = tests::vertex_face({0, 0, 0, 0.5, 1, 0, -1.5, 1, 0, 0, 0, -5},
                                               {0, 0, 0, -1.5, -1, 0, 0.5, -1, 0, 0, 0, -5});
  EXPECT_FALSE(tests::truly_collides(beside));
  EXPECT_TRUE(says_yes(rp(), beside));
}

TEST(Rp, AnswersAlikeInAnyOrderAndAnyRounding) {
  Random random(2);
  std::vector<Query> queries(200);
  for (Query& query : queries) {
    query = tests::random_query(random, Kind::edge_edge, tests::Family::tiny_integers).query;
  }
  std::vector<fast::Answer> forwards(queries.size()), backwards(queries.size());
  rp().solve(Queries(Kind::edge_edge, queries), forwards, {});
  std::ranges::reverse(queries);
  std::fesetround(FE_UPWARD);
  rp().solve(Queries(Kind::edge_edge, queries), backwards, {});
  const double after = tests::one_and_a_little();
  std::fesetround(FE_TONEAREST);
  EXPECT_GT(after, 1.0);
  std::ranges::reverse(backwards);
  EXPECT_TRUE(
      std::ranges::equal(forwards, backwards, {}, &fast::Answer::verdict, &fast::Answer::verdict));
}

TEST(Rp, KeepsItsAnswersAtOtherScales) {
  // Ten more than the greatest coordinate gives another ray, but the same crossings.
  Random random(3);
  for (int i = 0; i < tests::trials(200); ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const PosedQuery posed = tests::deforming_query(random, kind);
      for (const int exponent : {-30, 60, 300}) {
        EXPECT_EQ(says_yes(rp(), posed), says_yes(rp(), scaled(posed, exponent))) << exponent;
      }
    }
  }
}

TEST(Rp, TakesACrossingOfATinyCapForContactThere) {
  Random random(4);
  tests::Score score;
  for (int i = 0; i < 1000; ++i) {
    const PosedQuery posed = tests::deforming_query(random, Kind::vertex_face);
    const bool yes = says_yes(rp(), posed);
    score.count(yes, says_yes(rp(), scaled(posed, -100)));
  }
  EXPECT_EQ(score.false_negatives, 0);
  EXPECT_GT(score.false_positives, 0);
}

TEST(Rp, CallsWhatIsOutOfItsRangeACollision) {
  const PosedQuery no_collision = tests::edge_edge({0, 0, 0, 4, 0, 0, 5, -1, 0, 5, 1, 1e308},
                                                   {0, 0, 0, 4, 0, 0, 5, -1, 0, -5, 1, -1.7e308});
  EXPECT_THROW((void)rp_collides(no_collision.kind, no_collision.query), std::overflow_error);
  EXPECT_EQ(tests::one_and_a_little(), 1.0);
  EXPECT_TRUE(says_yes(rp(), no_collision));
}

}  // namespace
}  // namespace touchstone::baselines::rp_test
