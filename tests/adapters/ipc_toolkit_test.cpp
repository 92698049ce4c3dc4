#include "touchstone/ipc_toolkit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::adapters::narrow_phase_ccd_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Said {
  bool collision = false;
  double toi = -1.0;
};

Said ask(const ipc::NarrowPhaseCCD& ccd, Kind kind, const Query& query, double min_distance = 0.0,
         double tmax = 1.0) {
  const auto p = [&](std::size_t i) { return Vector3d(query.coordinates.data() + 3 * i); };
  Said said;
  said.collision = kind == Kind::vertex_face
                       ? ccd.point_triangle_ccd(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7),
                                                said.toi, min_distance, tmax)
                       : ccd.edge_edge_ccd(p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7), said.toi,
                                           min_distance, tmax);
  return said;
}

/// A vertex that falls by two from a height onto a face.
Query falling(double height) {
  return {{1, 1, height, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, height - 2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
}

TEST(IpcAdapter, LeavesItsPartOfTheDistance) {
  const NarrowPhaseCCD ccd(0.75);
  // From 1 to 1/4 at 3/8, from 1 to 1/2 + 1/8 at 3/16.
  EXPECT_NEAR(ask(ccd, Kind::vertex_face, falling(1)).toi, 0.375, 1e-12);
  EXPECT_LT(ask(ccd, Kind::vertex_face, falling(1)).toi, 0.375);
  EXPECT_NEAR(ask(ccd, Kind::vertex_face, falling(1), 0.5).toi, 0.1875, 1e-12);
  EXPECT_FALSE(ask(ccd, Kind::vertex_face, falling(1), 0.0, 0.25).collision);
  EXPECT_EQ(ask(ccd, Kind::vertex_face, falling(1), 0.0, 0.25).toi, infinity);
  EXPECT_NEAR(ask(NarrowPhaseCCD(1.0), Kind::vertex_face, falling(1)).toi, 0.5, 1e-12);
}

TEST(IpcAdapter, IsInContactAtZeroExactlyWhereItIs) {
  const NarrowPhaseCCD ccd;
  EXPECT_TRUE(ask(ccd, Kind::vertex_face, falling(0)).collision);
  EXPECT_EQ(ask(ccd, Kind::vertex_face, falling(0)).toi, 0.0);
  EXPECT_EQ(ask(ccd, Kind::vertex_face, falling(0.5), 0.5).toi, 0.0);
  EXPECT_GT(ask(ccd, Kind::vertex_face, falling(std::nextafter(0.5, 1.0)), 0.5).toi, 0.0);
  // The distance sqrt(2) is between two neighbouring doubles.
  const Query away{{-1, -1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const double below =
      std::sqrt(2.0) * std::sqrt(2.0) > 2.0 ? std::nextafter(std::sqrt(2.0), 0.0) : std::sqrt(2.0);
  EXPECT_GT(ask(ccd, Kind::vertex_face, away, below).toi, 0.0);
  EXPECT_EQ(ask(ccd, Kind::vertex_face, away, std::nextafter(below, 2.0)).toi, 0.0);
}

/// The time is positive for every start without contact, and before the exact impact.
TEST(IpcAdapter, NeverStalls) {
  const NarrowPhaseCCD ccd;
  for (double height = 1.0; height > 1e-300; height *= 0x1p-20) {
    const Said said = ask(ccd, Kind::vertex_face, falling(height));
    EXPECT_TRUE(said.collision);
    EXPECT_NEAR(said.toi / (0.8 * height / 2.0), 1.0, 1e-9) << height;
  }
}

TEST(IpcAdapter, AgreesWithTheOracleOnFreedom) {
  Random random(3);
  const NarrowPhaseCCD ccd;
  int collisions = 0;
  for (int i = 0; i < 400; ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.between(-3, 3);
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const exact::Decision truth = exact::decide(kind, query);
    const Said said = ask(ccd, kind, query);
    EXPECT_TRUE(said.collision || !truth.collides()) << i;
    if (!truth.collides()) continue;
    ++collisions;
    const double upper = truth.toi->enclosure().upper;
    EXPECT_TRUE(upper == 0.0 ? said.toi == 0.0 : said.toi < upper) << i;
  }
  EXPECT_GT(collisions, 50);
}

TEST(IpcAdapter, AnswersForPointsAndEdgesInTwoAndThreeDimensions) {
  const NarrowPhaseCCD ccd(1.0);
  double toi = -1.0;
  EXPECT_TRUE(
      ccd.point_point_ccd(Vector2d(0, 0), Vector2d(3, 0), Vector2d(2, 0), Vector2d(-1, 0), toi));
  EXPECT_NEAR(toi, 0.5, 1e-12);
  EXPECT_FALSE(ccd.point_point_ccd(Vector3d(0, 0, 1e-300), Vector3d(3, 0, 0),
                                   Vector3d(2, 0, 1e-300), Vector3d(-1, 0, 0), toi));
  EXPECT_EQ(toi, infinity);
  EXPECT_TRUE(ccd.point_edge_ccd(Vector2d(1, 1), Vector2d(0, 0), Vector2d(2, 0), Vector2d(1, -1),
                                 Vector2d(0, 0), Vector2d(2, 0), toi));
  EXPECT_NEAR(toi, 0.5, 1e-12);
  EXPECT_FALSE(ccd.point_edge_ccd(Vector3d(3, 0, 1), Vector3d(0, 0, 0), Vector3d(2, 0, 0),
                                  Vector3d(3, 0, -1), Vector3d(0, 0, 0), Vector3d(2, 0, 0), toi));
}

TEST(IpcAdapter, StopsWhatIsNotFinite) {
  const Said said =
      ask(NarrowPhaseCCD(), Kind::vertex_face, falling(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(said.collision);
  EXPECT_EQ(said.toi, 0.0);
}

/// Bad arguments are refused for all points: also at distance 0, in contact, or not finite.
TEST(IpcAdapter, RefusesBadArgumentsAndLeavesTheTime) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(NarrowPhaseCCD(2.0)), std::invalid_argument);
  const NarrowPhaseCCD ccd;
  for (const double height : {0.0, 1.0, nan}) {
    const Query query = falling(height);
    for (const double min_distance : {-1.0, -1e-300, nan, infinity}) {
      EXPECT_THROW(ask(ccd, Kind::vertex_face, query, min_distance), std::invalid_argument);
    }
    for (const double tmax : {-0.5, 1.5, nan}) {
      EXPECT_THROW(ask(ccd, Kind::vertex_face, query, 0.0, tmax), std::invalid_argument);
    }
  }
  double toi = 7.0;
  const Vector2d p(0, 0), q(2, 0);
  const Vector3d r(1, 1, 1), s(1, -1, 1);
  EXPECT_THROW(ccd.point_point_ccd(p, r, p, s, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_point_ccd(p, q, p, s, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_edge_ccd(r, p, q, s, p, q, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_point_ccd(p, q, p, q, toi, -1.0), std::invalid_argument);
  EXPECT_EQ(toi, 7.0);
}

}  // namespace
}  // namespace touchstone::adapters::narrow_phase_ccd_test
