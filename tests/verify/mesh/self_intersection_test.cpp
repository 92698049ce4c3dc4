#include "verify/mesh/self_intersection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::mesh::self_intersection_test {
namespace {

using fast::Edge;
using fast::Face;

Vertices rows(std::initializer_list<std::array<double, 3>> points) {
  Vertices vertices(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index i = 0;
  for (const auto& [x, y, z] : points) vertices.row(i++) << x, y, z;
  return vertices;
}

/// True if the edge from the triangle's corner (0,0,0) to w pierces it.
bool enters_triangle(const std::array<double, 3>& w) {
  const Vertices vertices = rows({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, w});
  return !find_piercings(vertices, std::vector<Edge>{{0, 3}}, std::vector<Face>{{1, 2, 0}}).empty();
}

TEST(Piercings, OfAnEdgeAtACornerAreOverlapsBeyondTheCorner) {
  EXPECT_FALSE(enters_triangle({1, 1, 1}));
  EXPECT_FALSE(enters_triangle({-1, 1, 0}));
  EXPECT_FALSE(enters_triangle({-1, 0, 0})) << "away, along the line of an edge";
  EXPECT_FALSE(enters_triangle({0, 0, 0})) << "of no length";
  EXPECT_TRUE(enters_triangle({1, 1, 0}));
  EXPECT_TRUE(enters_triangle({9, 9, 0}));
  EXPECT_TRUE(enters_triangle({2, 0, 0})) << "along an edge";
}

TEST(Piercings, OfAFacesOwnEdgesDoNotExist) {
  const Vertices vertices = rows({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  EXPECT_TRUE(find_piercings(vertices, std::vector<Edge>{{0, 1}, {2, 1}, {0, 2}},
                             std::vector<Face>{{0, 1, 2}})
                  .empty());
}

TEST(Piercings, OfAnEdgeAtACornerOfAFaceThatIsASegment) {
  const Vertices vertices = rows({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {-1, 0, 0}, {5, 0, 0}});
  const auto count = [&](const Edge& edge) {
    return find_piercings(vertices, std::vector<Edge>{edge}, std::vector<Face>{{0, 1, 2}}).size();
  };
  EXPECT_EQ(count({0, 3}), 0U) << "away from its end";
  EXPECT_EQ(count({0, 4}), 1U) << "along it";
  EXPECT_EQ(count({1, 3}), 1U) << "along it from its middle";
}

/// Beside an edge of the face by one bit.
TEST(Piercings, AreDecidedExactly) {
  for (const double x : {2.0, std::nextafter(2.0, 3.0)}) {
    const Vertices vertices = rows({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, x, -1}, {2, x, 1}});
    EXPECT_EQ(
        find_piercings(vertices, std::vector<Edge>{{3, 4}}, std::vector<Face>{{0, 1, 2}}).size(),
        x == 2.0 ? 1U : 0U);
  }
}

TEST(Piercings, CountThePairsAskedForInOrder) {
  const Vertices vertices = rows({{0, 0, 0},
                                  {4, 0, 0},
                                  {0, 4, 0},
                                  {0, 0, 1},
                                  {4, 0, 1},
                                  {0, 4, 1},
                                  {1, 1, -1},
                                  {1, 1, 2},
                                  {1, 1, 0.5}});
  const std::vector<Edge> edges{{6, 7}, {7, 8}};
  const std::vector<Face> faces{{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(find_piercings(vertices, edges, faces),
            (std::vector<Piercing>{{0, 0}, {0, 1}, {1, 1}}));
  EXPECT_EQ(
      find_piercings(vertices, edges, faces, [](auto edge, auto face) { return edge == face; }),
      (std::vector<Piercing>{{0, 0}, {1, 1}}));
  EXPECT_TRUE(find_piercings(vertices, {}, faces).empty());
  EXPECT_TRUE(find_piercings(vertices, edges, {}).empty());
  const std::atomic<bool> stop = true;
  EXPECT_THROW((void)find_piercings(vertices, edges, faces, nullptr, &stop), fast::Stopped);
}

/// An edge and a face meet iff an end of the edge is in the face, the edge meets an edge of the
/// face, or it goes through the inside. All cases occur on a grid of few points, also with faces
/// and edges that are segments or points. The oracle decides the first two for resting primitives,
/// Cramer's rule in integers the last.
TEST(Piercings, AreThoseOfTheOracleOnAGrid) {
  tests::Random random(18);
  const auto coordinate = [&] { return static_cast<double>(random.between(0, 2)); };
  std::size_t found = 0, crossings = 0;
  for (int i = 0; i < 3000; ++i) {
    Vertices v(5, 3);
    for (Eigen::Index row = 0; row < 5; ++row)
      v.row(row) << coordinate(), coordinate(), coordinate();
    const auto resting = [&](Kind kind, const std::array<Eigen::Index, 4>& points) {
      Query query{};
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t point = 0; point < moving_points; ++point) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            query.at(end, point, axis) = v(points[point], static_cast<Eigen::Index>(axis));
          }
        }
      }
      return exact::decide(kind, query).collides();
    };
    const auto side = [&](Eigen::Index a, Eigen::Index b, Eigen::Index c, Eigen::Index d) {
      const Eigen::RowVector3d x = v.row(b) - v.row(a), y = v.row(c) - v.row(a),
                               z = v.row(d) - v.row(a);
      const double volume = x.dot(y.cross(z));  // small integers
      return (volume > 0) - (volume < 0);
    };
    const int to_pq = side(3, 4, 0, 1), to_qr = side(3, 4, 1, 2), to_rp = side(3, 4, 2, 0);
    const bool crosses =
        side(0, 1, 2, 3) * side(0, 1, 2, 4) < 0 && to_pq * to_qr > 0 && to_qr * to_rp > 0;
    const bool expected =
        crosses || resting(Kind::vertex_face, {3, 0, 1, 2}) ||
        resting(Kind::vertex_face, {4, 0, 1, 2}) || resting(Kind::edge_edge, {3, 4, 0, 1}) ||
        resting(Kind::edge_edge, {3, 4, 1, 2}) || resting(Kind::edge_edge, {3, 4, 2, 0});
    const bool pierces =
        !find_piercings(v, std::vector<Edge>{{3, 4}}, std::vector<Face>{{0, 1, 2}}).empty();
    ASSERT_EQ(pierces, expected) << v;
    found += pierces ? 1 : 0;
    crossings += crosses ? 1 : 0;
  }
  EXPECT_GT(found, 500U);
  EXPECT_GT(crossings, 20U);
}

}  // namespace
}  // namespace touchstone::verify::mesh::self_intersection_test
