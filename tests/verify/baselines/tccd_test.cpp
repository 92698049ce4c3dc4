/// \file
/// TCCD is right in general position, and wrong in the cases and the way that its header states.

#include "verify/baselines/tccd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "fast/candidates.hpp"
#include "tests/support/baselines.hpp"
#include "tests/support/simulation_steps.hpp"
#include "tests/support/trials.hpp"
#include "verify/baselines/bernstein.hpp"

namespace touchstone::baselines::tccd_test {
namespace {

using tests::PosedQuery;
using tests::Random;
using tests::says_yes;

const fast::Method& tccd() {
  static const std::unique_ptr<const fast::Method> method = baselines::tccd_method();
  return *method;
}

TEST(Tccd, IsRightInGeneralPosition) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto score =
        score_on(tccd(), kind, tests::Family::full_significands, 1, tests::trials(4000));
    EXPECT_GT(score.collisions, tests::trials(200));
    EXPECT_EQ(score.false_negatives, 0);
    EXPECT_EQ(score.false_positives, 0);
  }
}

TEST(Tccd, FindsContactsOnBoundaries) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto score = score_on(tccd(), kind, tests::Family::near_contact, 1, tests::trials(4000));
    EXPECT_GT(score.collisions, tests::trials(2000));
    EXPECT_EQ(score.false_negatives, 0);
    // Near misses are not distinguished from collisions.
    EXPECT_GT(score.false_positives, score.no_collisions / 2);
  }
}

/// A vertex that falls through the plane z=0 of a triangle at rest, or nearly z=0, at about
/// time t and at the given place in units of the triangle's edges.
PosedQuery falling_vertex(Random& random, double x, double y, double t) {
  std::array<double, 9> face{0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (double& coordinate : face) coordinate += random.uniform(-0.001, 0.001);
  const double drop = random.uniform(1.0, 2.0);
  return tests::vertex_face(tests::with_vertex(x, y, drop * t, face),
                            tests::with_vertex(x, y, drop * (t - 1.0), face));
}

TEST(Tccd, CallsWhateverFallsThroughAPlaneInTheMiddleThirdACollision) {
  Random random(2);
  const int count = tests::trials(500);
  for (const double t : {0.38, 0.5, 0.62}) {
    for (int i = 0; i < count; ++i) {
      const PosedQuery far = falling_vertex(random, 5.0, random.uniform(-5.0, 5.0), t);
      EXPECT_FALSE(tests::truly_collides(far));
      EXPECT_TRUE(says_yes(tccd(), far));
    }
  }
}

TEST(Tccd, CallsAllMotionInAPlaneACollision) {
  Random random(5);
  int no_collisions = 0;
  for (int i = 0; i < tests::trials(500); ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      PosedQuery posed{kind, tests::full_significand_query(random)};
      tests::flatten(posed.query, 1);
      EXPECT_TRUE(says_yes(tccd(), posed));
      no_collisions += tests::truly_collides(posed) ? 0 : 1;
    }
  }
  EXPECT_GT(no_collisions, tests::trials(200));
}

bool has_inflection(const PosedQuery& posed) {
  const auto points = baselines::moving_points_of<double>(posed.kind, posed.query);
  const auto opposite = [](double a, double b) { return a * b < 0.0; };
  const auto cubic = baselines::coplanarity(points, baselines::normal_of(points));
  return baselines::course_of(cubic, opposite, opposite) == baselines::Course::inflection;
}

TEST(Tccd, MissesByUnderflowBesideAnInflection) {
  // The same collisions at every scale: exact scalings of queries that are found at scale 1.
  Random random(6);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<PosedQuery> collisions(tests::trials(2000U));
    std::ranges::generate(collisions, [&] { return tests::random_hit(random, kind); });
    const auto missed_at = [&](int exponent) {
      std::vector<PosedQuery> missed;
      for (const PosedQuery& collision : collisions) {
        if (!says_yes(tccd(), scaled(collision, exponent))) missed.push_back(collision);
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

TEST(Tccd, MissesAGrazingContactAtACornerOfBothEdges) {
  // Y is a square with a double root at t = 1/2. Each constraint vanishes at that root, and is
  // taken for negative at one of the "two" roots.
  const PosedQuery edges = tests::edge_edge({0, -1, -1, -1, -1, -1, -1, 0, 0, -1, 0, -1},
                                            {0, -1, -1, 0, 1, 0, -1, 0, 0, 0, 0, 0});
  EXPECT_TRUE(tests::truly_collides(edges));
  EXPECT_FALSE(says_yes(tccd(), edges));
  const PosedQuery face = tests::vertex_face({-1, 1, 1, 1, 0, 1, 1, -1, -1, 0, 1, 0},
                                             {1, -1, -1, 1, 0, 1, 0, 0, 0, 0, 0, 1});
  EXPECT_TRUE(tests::truly_collides(face));
  EXPECT_FALSE(says_yes(tccd(), face));
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
      count += says_yes(tccd(), scaled(posed, exponent)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(missed(Kind::vertex_face, 0), 23);
  EXPECT_EQ(missed(Kind::edge_edge, 0), 171);
  EXPECT_EQ(missed(Kind::vertex_face, 4), 0);
  EXPECT_EQ(missed(Kind::edge_edge, 4), 3);
}

}  // namespace
}  // namespace touchstone::baselines::tccd_test
