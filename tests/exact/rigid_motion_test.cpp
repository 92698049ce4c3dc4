#include "touchstone/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "exact/rigid/rigid_place.hpp"
#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact {
namespace {

using tests::Random;
using Point = std::array<double, 3>;
constexpr double pi = std::numbers::pi;

// ---- Places ------------------------------------------------------------------------------------

RigidMotion turning(const Point& from, const Point& to) {
  return {{.rotation = from}, {.rotation = to}};
}

TEST(RigidPlace, OfTinyAndOfHugeAngles) {
  const Point v{1, 0, 0};
  EXPECT_EQ(place_of(turning({}, {}), v, 0.5), v);
  EXPECT_EQ(place_of(turning({}, {0, 0, 0x1p-1060}), v, 1.0)[1], 0x1p-1060);
  // sin and cos of 10^22, to many digits.
  const Point x = place_of(turning({}, {0, 0, 1e22}), v, 1.0);
  EXPECT_NEAR(x[0], 0.5232147853951389, 1e-15);
  EXPECT_NEAR(x[1], -0.8522008497671888, 1e-15);
  const RigidMotion moving{{.position = {1, 2, 3}, .rotation = {0, 0, std::numbers::pi}},
                           {.position = {3, 2, 1}, .rotation = {0, 0, -std::numbers::pi}}};
  EXPECT_EQ(place_of(moving, v, 0.5), (Point{3, 2, 2}));
  EXPECT_EQ(place_of(moving, v, 0.5, 2), (Point{0.75, 0.5, 0.5}));
  constexpr double least = 0x1p-1074;
  const RigidMotion tiny = turning({}, {0, 0, std::numbers::pi / 3});
  EXPECT_EQ(place_of(tiny, {least, 0, 0}, 1.0, -1074), place_of(tiny, v, 1.0));
}

// ---- Without rotation ---------------------------------------------------------------------------

/// A query whose points no rotation moves: of small whole numbers times a scale.
RigidQuery translated(Random& random, Kind kind, double scale) {
  RigidQuery result;
  const auto vector = [&] {
    Point point;
    for (double& x : point) x = scale * random.between(-2, 2);
    return point;
  };
  for (Point& point : result.points) point = vector();
  for (RigidMotion& body : result.bodies) body = {{.position = vector()}, {.position = vector()}};
  // A vertex on the axis of its body.
  if (kind == Kind::vertex_face && random.coin()) {
    result.points[0] = {0, 0, scale};
    result.bodies[0].start.rotation[2] = 3.0;
    result.bodies[0].end.rotation[2] = -1e9;
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

constexpr std::array scales{-1074, -1073, -1060, -1022, -537, -60, 0, 60, 537, 1000};

TEST(RigidMotion, DecidesTranslationsExactly) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    int colliding = 0;
    for (const int exponent : scales) {
      Random random(1);
      for (int i = 0; i < 300; ++i) {
        const RigidQuery query = translated(random, kind, std::ldexp(1.0, exponent));
        const RigidDecision decision = decide(kind, query);
        const Decision truth = decide(kind, linear(kind, query));
        ASSERT_EQ(decision.verdict, truth.collides() ? RigidVerdict::yes : RigidVerdict::no)
            << exponent << ' ' << i;
        if (!truth.collides()) continue;
        ++colliding;
        const auto [lower, upper] = truth.toi->enclosure();
        EXPECT_EQ(decision.toi_lower, lower);
        EXPECT_EQ(decision.toi_upper, upper);
      }
    }
    EXPECT_GT(colliding, 200);
    EXPECT_LT(colliding, 2500);
  }
}

/// Sums of positions and points that are no doubles: a vertex above a triangle, by the least
/// number.
TEST(RigidMotion, DecidesTranslationsOfNumbersThatDoNotAdd) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  for (const double height : {least, 0.0, -least}) {
    RigidQuery query;
    query.points = {{{0, 0, height}, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}};
    query.bodies[0] = {{.position = {0, 0, 1}}, {.position = {0, 0, 0}}};
    const RigidDecision decision = decide(Kind::vertex_face, query);
    EXPECT_EQ(decision.verdict, height > 0.0 ? RigidVerdict::no : RigidVerdict::yes);
    EXPECT_EQ(decision.toi_lower, height < 0.0 ? 1.0 - 0x1p-53 : 1.0);
  }
}

// ---- Planted contacts of rotations --------------------------------------------------------------

void expect_toi(const RigidDecision& decision, double toi, double error) {
  ASSERT_EQ(decision.verdict, RigidVerdict::yes);
  EXPECT_LE(decision.toi_lower, toi + error);
  EXPECT_GE(decision.toi_upper, toi - error);
}

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
      SCOPED_TRACE(turn);
      expect_toi(decision, toi, 1e-12);  // the gate's angle is rounded
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

TEST(RigidMotion, FindsAGateAtAnyScale) {
  for (const int exponent : scales) {
    for (const double radius : {2.0, 0.0, -1.0}) {
      const double scale = std::ldexp(1.0, exponent);
      RigidQuery query;
      query.bodies[0].end.rotation = {0, 0, pi};
      query.points = {{{scale, 0, 0}, {0, 0, -scale}, {0, 0, scale}, {0, radius * scale, 0}}};
      const RigidDecision decision = decide(Kind::vertex_face, query);
      if (radius <= 0.0) {
        EXPECT_EQ(decision.verdict, RigidVerdict::no) << exponent;
        continue;
      }
      SCOPED_TRACE(exponent);
      expect_toi(decision, 0.5, 0.0);
      EXPECT_LT(decision.toi_lower, 0.5);
      EXPECT_LE(decision.toi_upper - decision.toi_lower, RigidOptions{}.toi_tolerance);
    }
  }
}

// ---- In a plane ---------------------------------------------------------------------------------

/// A rod turns about (1,1,1) once, in the plane of a bar that is √8 away and 2 √6 long.
RigidQuery rod(double from, double to) {
  RigidQuery query;
  query.bodies[0].end.rotation.fill(2 * pi / std::sqrt(3.0));
  query.points = {{{from, -from, 0}, {to, -to, 0}, {-2, 3, -1}, {2, 1, -3}}};
  return query;
}

TEST(RigidMotion, DecidesMotionInAPlane) {
  // The rod's side meets the bar's end, or its end the bar's side; or a point the bar.
  const double at_end = 1.0 / 3.0 - std::atan(std::sqrt(0.75)) / (2 * pi);
  const double at_side = 1.0 / 3.0 - std::acos(0.8) / (2 * pi);
  for (const auto& [from, to, toi] :
       {std::array{1.0, 3.0, at_end}, {0.0, 2.5, at_side}, {2.5, 2.5, at_side}}) {
    expect_toi(decide(Kind::edge_edge, rod(from, to)), toi, 1e-12);
  }
  EXPECT_EQ(decide(Kind::edge_edge, rod(1.0, 2.0 - 1e-9)).verdict, RigidVerdict::no);
  EXPECT_EQ(decide(Kind::edge_edge, rod(2.7, 3.0)).verdict, RigidVerdict::no);
  RigidQuery crossed = rod(1.0, 3.0);
  crossed.points[2] = {1, -2, 1};
  crossed.points[3] = {3, -2, -1};
  const RigidDecision decision = decide(Kind::edge_edge, crossed);
  EXPECT_EQ(decision.verdict, RigidVerdict::yes);
  EXPECT_EQ(decision.toi_lower, 0.0);
}

// ---- Limits -------------------------------------------------------------------------------------

/// A triangle that turns many times below a vertex separates from it, until its plane wobbles.
TEST(RigidMotion, EndsWithABoundAfterItsWork) {
  RigidQuery query;
  query.points = {{{0.3, 0.2, 1e-4}, {-5, -5, 0}, {5, -5, 0}, {0, 5, 0}}};
  query.bodies[1].end.rotation = {0, 0, 4e5};
  RigidDecision decision = decide(Kind::vertex_face, query);
  EXPECT_EQ(decision.verdict, RigidVerdict::no);
  EXPECT_EQ(decision.intervals, 1U);
  query.points[3][2] = 1e-4;
  decision = decide(Kind::vertex_face, query, {.greatest_count = 64});
  EXPECT_EQ(decision.verdict, RigidVerdict::undecided);
  EXPECT_EQ(decision.limit, RigidLimit::count);
  EXPECT_GT(decision.error, 4e-5);  // 5e-5 at all times, and more
  EXPECT_LT(decision.error, 2e-4);
  const std::atomic<bool> stop(true);
  decision = decide(Kind::vertex_face, query, {.stop = &stop});
  EXPECT_EQ(decision.limit, RigidLimit::stop);
  EXPECT_EQ(decision.intervals, 0U);
}

TEST(RigidMotion, LeavesATouchUndecidedWithinItsError) {
  const RigidDecision decision = decide(Kind::vertex_face, gate(0.0, 2.0, 1.0, 0.5, 1.0));
  EXPECT_EQ(decision.verdict, RigidVerdict::undecided);
  EXPECT_EQ(decision.limit, RigidLimit::interval);
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
      const auto at = [&start = rigid.bodies[body].start, &end = rigid.bodies[body].end](double t) {
        RigidPose pose;
        for (std::size_t k = 0; k < 3; ++k) {
          pose.position[k] = std::lerp(start.position[k], end.position[k], t);
          pose.rotation[k] = std::lerp(start.rotation[k], end.rotation[k], t);
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
    if (x != 0x1p101) {
      EXPECT_THROW((void)decide(Kind::edge_edge, query), std::domain_error);
    }
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
