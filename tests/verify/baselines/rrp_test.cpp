/// \file
/// RRP is right if the number of roots is odd or 0 and nothing is degenerate, and wrong in the
/// cases and the way that its header states.

#include "verify/baselines/rrp.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/baselines.hpp"
#include "tests/support/root_count.hpp"

namespace touchstone::baselines::rrp_test {
namespace {

using fast::Method;
using tests::PosedQuery;
using tests::Random;
using tests::says_yes;

const fast::Method& rrp() {
  static const std::unique_ptr<const fast::Method> method = baselines::rrp_method();
  return *method;
}

TEST(Rrp, SaysYesExactlyToOddNumbersOfRoots) {
  Random random(1);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    int odd = 0, missed = 0;
    for (int i = 0; i < 1500; ++i) {
      const PosedQuery posed = tests::deforming_query(random, kind);
      const int contacts = tests::count_contacts(posed);
      EXPECT_EQ(says_yes(rrp(), posed), contacts % 2 == 1) << contacts << " contacts: " << posed;
      odd += contacts % 2;
      missed += contacts == 2 ? 1 : 0;
    }
    EXPECT_GT(odd, 50);
    EXPECT_GT(missed, 0);
  }
}

TEST(Rrp, MissesContactAtRestOrUnderACommonTranslation) {
  for (const auto& [x, y, z] : {std::array{0.0, 0.0, 0.0}, std::array{1.0, -2.0, 0.5}}) {
    for (PosedQuery posed : {tests::over_triangle(1, 1, 0, 0), tests::over_edge(1, 2, 0, 0)}) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        posed.query.at(1, point, 0) += x;
        posed.query.at(1, point, 1) += y;
        posed.query.at(1, point, 2) += z;
      }
      EXPECT_TRUE(tests::truly_collides(posed));
      EXPECT_FALSE(says_yes(rrp(), posed));
    }
  }
}

TEST(Rrp, MissesContactWithATriangleThatIsDegenerateAtAnEnd) {
  // The triangle unfolds from a segment while the vertex falls onto it, or folds into one.
  const tests::FourPoints open{1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0};
  const tests::FourPoints folded{1, 1, 1, 0, 0, 0, 4, 0, 0, 2, 0, 0};
  for (const PosedQuery& posed :
       {tests::vertex_face(folded, open), tests::vertex_face(open, folded)}) {
    EXPECT_TRUE(tests::truly_collides(posed));
    EXPECT_FALSE(says_yes(rrp(), posed));
  }
  // A triangle of a small area is found.
  tests::FourPoints narrow = folded;
  narrow[10] = 0x1p-40;
  EXPECT_TRUE(says_yes(rrp(), tests::vertex_face(narrow, open)));
}

TEST(Rrp, KnowsAnHourglassFromItsHull) {
  const PosedQuery beside = tests::vertex_face({0, 0, 0, 0.5, 1, 0, -1.5, 1, 0, 0, 0, -5},
                                               {0, 0, 0, -1.5, -1, 0, 0.5, -1, 0, 0, 0, -5});
  EXPECT_FALSE(tests::truly_collides(beside));
  EXPECT_FALSE(says_yes(rrp(), beside));
}

TEST(Rrp, TakesAFlatPatchWithAReflexCornerForItsTwoTriangles) {
  // The patch of w0 and w1 lies in x + y = −1, its outline (x,z): (0,−2), (0,0), (−1,1), (1,2).
  const PosedQuery reflex = tests::vertex_face({1, 0, -1, 1, 1, 1, 1, 1, -1, -1, 0, 1},
                                               {0, -1, 1, -1, 1, -1, 1, -1, 0, -1, 0, 1});
  EXPECT_FALSE(tests::truly_collides(reflex));
  EXPECT_TRUE(says_yes(rrp(), reflex));
}

}  // namespace
}  // namespace touchstone::baselines::rrp_test
