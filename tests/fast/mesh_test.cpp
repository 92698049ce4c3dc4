#include "touchstone/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/floating_point_modes.hpp"
#include "tests/support/messages.hpp"

namespace touchstone::fast::mesh_test {
namespace {

/// Vertex i is at (3i, 3i+1, 3i+2) and moves by 100.
Eigen::MatrixX3d places(Eigen::Index count, double offset) {
  Eigen::MatrixX3d result(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) result(i, k) = static_cast<double>(3 * i + k) + offset;
  }
  return result;
}

const std::vector<Edge> some_edges{{0, 1}, {4, 2}};
const std::vector<Face> some_faces{{0, 1, 2}, {4, 3, 1}};

TEST(Motion, HoldsWhatItIsMadeFromWhateverTheStorage) {
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor> start =
      places(5, 0).cast<float>();
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> end = places(5, 100);
  const Motion vertices(start, end);
  ASSERT_EQ(vertices.size(), 5U);
  EXPECT_EQ(vertices[4].start, (std::array<double, 4>{12, 13, 14, 0}));
  EXPECT_EQ(vertices[4].end, (std::array<double, 4>{112, 113, 114, 0}));
  EXPECT_EQ(vertices.data() + 4, &vertices[4]);
  EXPECT_EQ(Motion(places(0, 0), places(0, 0)).size(), 0U);
}

TEST(Motion, KeepSubnormalFloatsThatTheCallerTakesForZero) {
  Eigen::Matrix<float, 2, 3> floats;
  floats << 0x1p-149F, -0x1p-149F, 0x1.8p-127F, -0x1.fffffcp-127F, -0.0F, 0x1p-126F;
  Eigen::Matrix<double, 2, 3> expected;
  expected << 0x1p-149, -0x1p-149, 0x1.8p-127, -0x1.fffffcp-127, -0.0, 0x1p-126;
  const Motion vertices = [&floats] {
    const tests::ChangedModes changed(tests::flush_to_zero | tests::subnormals_are_zero);
    return Motion(floats, floats);
  }();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const auto& [start, end] = vertices[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < 3; ++k) {
      EXPECT_EQ(start[static_cast<std::size_t>(k)], expected(i, k));
      EXPECT_EQ(end[static_cast<std::size_t>(k)], expected(i, k));
    }
  }
}

TEST(Motion, RefusesMatricesOfOtherShapes) {
  const Eigen::MatrixXd two_columns = Eigen::MatrixXd::Zero(5, 2);
  const Eigen::MatrixXd four_rows = Eigen::MatrixXd::Zero(4, 3);
  EXPECT_THROW(Motion(two_columns, two_columns), std::invalid_argument);
  EXPECT_THROW(Motion(places(5, 0), two_columns), std::invalid_argument);
  EXPECT_THROW(Motion(places(5, 0), four_rows), std::invalid_argument);
}

/// The same elements from matrices of all types, sizes and orders of storage.
TEST(Elements, AreMadeFromMatrices) {
  Eigen::Matrix<int, 2, 3> faces;
  faces << 0, 1, 2, 4, 3, 1;
  Eigen::MatrixXi edges(2, 2);
  edges << 0, 1, 4, 2;
  using Rows64 = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3, Eigen::RowMajor>;
  EXPECT_EQ(elements_from<Face>(faces), some_faces);
  EXPECT_EQ(elements_from<Face>(Rows64(faces.cast<std::int64_t>())), some_faces);
  EXPECT_EQ(elements_from<Face>(faces.cast<unsigned>().array()), some_faces);
  EXPECT_EQ(elements_from<Face>((faces.array() + 1).matrix().topRows(1)),
            (std::vector<Face>{{1, 2, 3}}));
  EXPECT_EQ(elements_from<Edge>(edges), some_edges);
  EXPECT_EQ(elements_from<Edge>(edges.cast<std::int64_t>()), some_edges);
  EXPECT_EQ(elements_from<Face>(Eigen::MatrixXi()), std::vector<Face>{});
  EXPECT_EQ(elements_from<Edge>(Eigen::MatrixX3i(0, 3)), std::vector<Edge>{});
}

TEST(Elements, AreRefusedInOtherShapesAndOutOfRange) {
  EXPECT_THROW((void)elements_from<Face>(Eigen::MatrixXi::Zero(3, 2)), std::invalid_argument);
  EXPECT_THROW((void)elements_from<Edge>(Eigen::MatrixXi::Zero(2, 3)), std::invalid_argument);
  using Rows64 = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2, Eigen::RowMajor>;
  Rows64 edges = Rows64::Zero(3, 2);
  edges(1, 0) = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(elements_from<Edge>(edges)[1][0], std::numeric_limits<std::int32_t>::max());
  for (const std::int64_t bad : {std::int64_t{-1}, std::int64_t{1} << 31U, std::int64_t{1} << 32U,
                                 std::numeric_limits<std::int64_t>::min()}) {
    edges(2, 1) = bad;
    EXPECT_EQ(tests::message_of<std::out_of_range>([&] { (void)elements_from<Edge>(edges); }),
              "element 2: vertex " + std::to_string(bad) + " is not in [0, 2^31-1]");
  }
}

/// One cell after the other, of each kind.
TEST(Elements, HaveTheCornersOfCellsInARow) {
  const Mesh mesh{.faces = some_faces,
                  .tetrahedra = {{3, 1, 4, 0}, {2, 7, 1, 8}, {0, 0, 0, 5}},
                  .plane_triangles = {{2, 0, 1}, {6, 5, 4}}};
  EXPECT_EQ(mesh.count_of(CellKind::tetrahedron), 3U);
  EXPECT_EQ(mesh.count_of(CellKind::plane_triangle), 2U);
  EXPECT_TRUE(std::ranges::equal(mesh.corners_of(CellKind::tetrahedron),
                                 std::array{3, 1, 4, 0, 2, 7, 1, 8, 0, 0, 0, 5}));
  EXPECT_TRUE(
      std::ranges::equal(mesh.corners_of(CellKind::plane_triangle), std::array{2, 0, 1, 6, 5, 4}));
  for (const CellKind kind : cell_kinds) {
    EXPECT_TRUE(Mesh{.faces = some_faces}.corners_of(kind).empty());
    EXPECT_EQ(Mesh{}.count_of(kind), 0U);
  }
}

}  // namespace
}  // namespace touchstone::fast::mesh_test
