#include "touchstone/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "exact/rigid/rigid_place.hpp"
#include "tests/support/certified.hpp"
#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact {
namespace {

using tests::Random;
using Point = std::array<double, 3>;
constexpr double pi = std::numbers::pi;

// ---- Without rotation ---------------------------------------------------------------------------

/// A query whose primitives are translated.
RigidQuery translated(Random& random, Kind kind) {
  RigidQuery result;
  const auto vector = [&] {
    return Point{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  for (Point& point : result.points) point = vector();
  for (RigidMotion& body : result.bodies) body = {{.position = vector()}, {.position = vector()}};
  // Half of them meet: a point of the first primitive goes through one of the second.
  if (random.coin()) {
    RigidMotion& first = result.bodies[0];
    const Point target = kind == Kind::vertex_face ? result.points[2] : result.points[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double other = result.bodies[1].end.position[k] + 0.9 * target[k] +
                           0.05 * (result.points[1][k] + result.points[3][k]);
      first.end.position[k] =
          other - result.points[0][k] + 0.25 * (other - first.start.position[k]);
    }
  }
  return result;
}

/// The same motion as a linear query.
Query linear(Kind kind, const RigidQuery& rigid) {
  Query query;
  for (std::size_t i = 0; i < moving_points; ++i) {
    const std::size_t body = i < (kind == Kind::vertex_face ? 1U : 2U) ? 0 : 1;
    for (std::size_t end = 0; end < 2; ++end) {
      const Point x = place_of(rigid.bodies[body], rigid.points[i], static_cast<double>(end));
      for (std::size_t k = 0; k < 3; ++k) query.coordinates[12 * end + 3 * i + k] = x[k];
    }
  }
  return query;
}

TEST(RigidMotion, DecidesTranslationsAsTheOracle) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    Random random(1);
    int decided = 0, colliding = 0;
    constexpr int count = 800;
    for (int i = 0; i < count; ++i) {
      const RigidQuery query = translated(random, kind);
      const RigidDecision decision = decide(kind, query);
      if (decision.verdict == RigidVerdict::undecided) continue;
      ++decided;
      const Decision truth = decide(kind, linear(kind, query));
      ASSERT_EQ(decision.verdict == RigidVerdict::yes, truth.collides());
      if (!truth.collides()) continue;
      ++colliding;
      // The places of the linear query are rounded.
      EXPECT_GE(tests::compare(*truth.toi, decision.toi_lower - 1e-12), 0);
      EXPECT_LE(tests::compare(*truth.toi, decision.toi_upper + 1e-12), 0);
      EXPECT_LE(decision.toi_upper - decision.toi_lower, RigidOptions{}.toi_tolerance);
    }
    EXPECT_GT(decided, count * 95 / 100);
    EXPECT_GT(colliding, 20);
  }
}

// ---- Planted contacts of rotations --------------------------------------------------------------

/// A vertex at (1,0,0) turns about the z axis, from angle `from` by `turn`, and a triangle stands
/// across its way at an angle, from a radius to another.
RigidQuery gate(double from, double turn, double at, double radius, double other_radius) {
  RigidQuery query;
  query.bodies[0] = {{.rotation = {0, 0, from}}, {.rotation = {0, 0, from + turn}}};
  const double c = std::cos(at), s = std::sin(at);
  query.points = {{{1, 0, 0},
                   {radius * c, radius * s, -1},
                   {radius * c, radius * s, 1},
                   {other_radius * c, other_radius * s, 0}}};
  return query;
}

TEST(RigidMotion, FindsTheFirstPassageThroughAGate) {
  for (const double turn : {0.5, 2.0, -2.0, 4 * pi, -4 * pi, 40 * pi, -1000.0}) {
    for (const double way : {0.1, 0.4, 1.3, 3.0}) {
      const double angle = 0.7 + (turn > 0 ? way : -way);
      const RigidDecision decision = decide(Kind::vertex_face, gate(0.7, turn, angle, 0.5, 1.5));
      const double toi = way / std::abs(turn);
      if (toi > 1.0) {
        EXPECT_EQ(decision.verdict, RigidVerdict::no) << turn << ' ' << way;
        continue;
      }
      ASSERT_EQ(decision.verdict, RigidVerdict::yes) << turn << ' ' << way;
      // The gate's angle is rounded.
      EXPECT_LE(decision.toi_lower, toi + 1e-12);
      EXPECT_GE(decision.toi_upper, toi - 1e-12);
    }
  }
}

TEST(RigidMotion, SeesThatATurnJustMisses) {
  // A gate from inside the circle or from outside that ends just before the vertex's way, or
  // reaches just over it.
  for (const double turn : {2.0, -4 * pi, 40.0}) {
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12}) {
      const double angle = turn > 0 ? 1.0 : -1.0;
      const auto verdict = [&](double radius, double other) {
        return decide(Kind::vertex_face, gate(0.0, turn, angle, radius, other)).verdict;
      };
      EXPECT_EQ(verdict(0.5, 1.0 - gap), RigidVerdict::no) << turn << ' ' << gap;
      EXPECT_EQ(verdict(1.5, 1.0 + gap), RigidVerdict::no) << turn << ' ' << gap;
      EXPECT_EQ(verdict(0.5, 1.0 + gap), RigidVerdict::yes) << turn << ' ' << gap;
      EXPECT_EQ(verdict(1.5, 1.0 - gap), RigidVerdict::yes) << turn << ' ' << gap;
    }
  }
}

TEST(RigidMotion, LeavesATouchUndecidedWithinItsError) {
  const RigidDecision decision = decide(Kind::vertex_face, gate(0.0, 2.0, 1.0, 0.5, 1.0));
  EXPECT_EQ(decision.verdict, RigidVerdict::undecided);
  EXPECT_GT(decision.error, 0.0);
  EXPECT_LT(decision.error, 1e-13);
  EXPECT_NEAR(decision.toi_lower, 0.5, 1e-6);
}

// ---- Compared with sampling ---------------------------------------------------------------------

RigidQuery tumbling(Random& random) {
  RigidQuery result;
  const auto vector = [&](double size) {
    return Point{random.uniform(-size, size), random.uniform(-size, size),
                 random.uniform(-size, size)};
  };
  for (Point& point : result.points) point = vector(1.0);
  for (RigidMotion& body : result.bodies) {
    body = {{vector(0.3), vector(2.0)}, {vector(0.3), vector(2.0)}};
  }
  return result;
}

/// True if a chord of one of many parts of the motion collides.
bool collides_by_samples(Kind kind, const RigidQuery& rigid) {
  constexpr int parts = 128;
  RigidQuery part = rigid;
  for (int i = 0; i < parts; ++i) {
    for (std::size_t body = 0; body < 2; ++body) {
      const auto at = [&](double t) {
        RigidPose pose;
        const auto& [start, end] = rigid.bodies[body];
        for (std::size_t k = 0; k < 3; ++k) {
          pose.position[k] = start.position[k] + t * (end.position[k] - start.position[k]);
          pose.rotation[k] = start.rotation[k] + t * (end.rotation[k] - start.rotation[k]);
        }
        return pose;
      };
      part.bodies[body] = {at(i / double{parts}), at((i + 1) / double{parts})};
    }
    if (decide(kind, linear(kind, part)).collides()) return true;
  }
  return false;
}

TEST(RigidMotion, AgreesWithSamplesOfTumblingBodies) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    Random random(3);
    int colliding = 0, different = 0;
    constexpr int count = 100;
    for (int i = 0; i < count; ++i) {
      const RigidQuery query = tumbling(random);
      const RigidDecision decision = decide(kind, query);
      ASSERT_NE(decision.verdict, RigidVerdict::undecided);
      colliding += decision.verdict == RigidVerdict::yes ? 1 : 0;
      // Chords of samples are off by some 1e-5 of the size.
      different +=
          (decision.verdict == RigidVerdict::yes) != collides_by_samples(kind, query) ? 1 : 0;
      // Backwards in time, the same happens.
      RigidQuery reversed = query;
      for (RigidMotion& body : reversed.bodies) std::swap(body.start, body.end);
      EXPECT_EQ(decide(kind, reversed).verdict, decision.verdict);
    }
    EXPECT_GT(colliding, 3);
    EXPECT_LT(colliding, count * 19 / 20);
    EXPECT_LE(different, 1);
  }
}

TEST(RigidMotion, RefusesNumbersOutOfRange) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {infinity, -infinity, std::nan(""), 0x1p101}) {
    RigidQuery query;
    query.points[2][1] = x;
    EXPECT_THROW((void)decide(Kind::edge_edge, query), std::domain_error);
    query = {};
    query.bodies[1].end.rotation[2] = x;
    EXPECT_THROW((void)decide(Kind::vertex_face, query), std::domain_error);
  }
  EXPECT_THROW((void)decide(Kind::edge_edge, RigidQuery{}, {.toi_tolerance = 0.0}),
               std::invalid_argument);
  EXPECT_THROW((void)decide(Kind::edge_edge, RigidQuery{}, {.least_interval = 2.0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::exact
