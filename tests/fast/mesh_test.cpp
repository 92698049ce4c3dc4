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

#include "fast/candidates.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/messages.hpp"
#include "touchstone/query.hpp"

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

MovingVertices counted(Eigen::Index count) { return {places(count, 0), places(count, 100)}; }

const std::vector<Edge> some_edges{{0, 1}, {4, 2}};
const std::vector<Face> some_faces{{0, 1, 2}, {4, 3, 1}};

Candidates candidates(Kind kind, const std::vector<IndexPair>& pairs) {
  return {.kind = kind, .pairs = pairs, .edges = some_edges, .faces = some_faces};
}

/// The message of require_in_range with five vertices, or "".
std::string range_error(const Candidates& given) {
  return tests::message_of<std::out_of_range>([&] { require_in_range(counted(5), given); });
}

TEST(MovingVertices, HoldsWhatItIsMadeFromWhateverTheStorage) {
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor> start =
      places(5, 0).cast<float>();
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> end = places(5, 100);
  const MovingVertices vertices(start, end);
  ASSERT_EQ(vertices.size(), 5U);
  EXPECT_EQ(vertices[4].start, (std::array<double, 4>{12, 13, 14, 0}));
  EXPECT_EQ(vertices[4].end, (std::array<double, 4>{112, 113, 114, 0}));
  EXPECT_EQ(vertices.data() + 4, &vertices[4]);
  EXPECT_EQ(MovingVertices(places(0, 0), places(0, 0)).size(), 0U);
}

TEST(MovingVertices, KeepSubnormalFloatsThatTheCallerTakesForZero) {
  Eigen::Matrix<float, 2, 3> floats;
  floats << 0x1p-149F, -0x1p-149F, 0x1.8p-127F, -0x1.fffffcp-127F, -0.0F, 0x1p-126F;
  Eigen::Matrix<double, 2, 3> expected;
  expected << 0x1p-149, -0x1p-149, 0x1.8p-127, -0x1.fffffcp-127, -0.0, 0x1p-126;
  const MovingVertices vertices = [&floats] {
    const tests::ChangedModes changed(tests::flush_to_zero | tests::subnormals_are_zero);
    return MovingVertices(floats, floats);
  }();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const auto& [start, end] = vertices[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < 3; ++k) {
      EXPECT_EQ(start[static_cast<std::size_t>(k)], expected(i, k));
      EXPECT_EQ(end[static_cast<std::size_t>(k)], expected(i, k));
    }
  }
}

TEST(MovingVertices, RefusesMatricesOfOtherShapes) {
  const Eigen::MatrixXd two_columns = Eigen::MatrixXd::Zero(5, 2);
  const Eigen::MatrixXd four_rows = Eigen::MatrixXd::Zero(4, 3);
  EXPECT_THROW(MovingVertices(two_columns, two_columns), std::invalid_argument);
  EXPECT_THROW(MovingVertices(places(5, 0), two_columns), std::invalid_argument);
  EXPECT_THROW(MovingVertices(places(5, 0), four_rows), std::invalid_argument);
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

TEST(RequireInRange, NamesTheFirstPairAndWhatIsWrongThere) {
  struct Row {
    Kind kind;
    std::vector<IndexPair> bad;
    std::string expected;
  };
  constexpr int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  constexpr Kind face = Kind::vertex_face, edges = Kind::edge_edge;
  for (const auto& [kind, bad, expected] :
       {Row{face, {{4, 1}}, ""}, Row{edges, {{1, 0}}, ""},
        Row{face, {{5, 1}, {-1, 0}}, "vertex 5, but there are 5"},
        Row{face, {{-1, 0}}, "vertex -1, but there are 5"},
        Row{face, {{0, 2}}, "face 2, but there are 2"},
        Row{face, {{0, -1}}, "face -1, but there are 2"},
        Row{edges, {{2, 0}}, "edge 2, but there are 2"},
        Row{edges, {{5, 0}}, "edge 5, but there are 2"},
        Row{edges, {{-1, 0}}, "edge -1, but there are 2"},
        Row{edges, {{0, most}}, "edge 2147483647, but there are 2"},
        Row{edges, {{0, least}}, "edge -2147483648, but there are 2"}}) {
    for (const std::size_t place : {0U, 50U, 98U}) {
      std::vector<IndexPair> pairs(100, IndexPair{0, 1});
      std::ranges::copy(bad, pairs.begin() + static_cast<std::ptrdiff_t>(place));
      EXPECT_EQ(range_error(candidates(kind, pairs)),
                expected.empty() ? "" : "pair " + std::to_string(place) + ": " + expected);
    }
  }
  EXPECT_EQ(range_error(candidates(edges, {})), "");
}

TEST(RequireInRange, MindsNoEdgeOrFaceThatNoPairHas) {
  const std::vector<Edge> edges{{0, 1}, {1, 2}, {0, 5}};
  const std::vector<Face> faces{{0, 1, 2}, {0, 1, 3}, {0, 1, -2}};
  std::vector<IndexPair> pairs(100, IndexPair{0, 1});
  EXPECT_EQ(range_error({Kind::vertex_face, pairs, edges, faces}), "");
  EXPECT_EQ(range_error({Kind::edge_edge, pairs, edges, faces}), "");
  pairs[70] = {0, 2};
  EXPECT_EQ(range_error({Kind::vertex_face, pairs, edges, faces}),
            "pair 70: face 2, vertex -2, but there are 5");
  EXPECT_EQ(range_error({Kind::edge_edge, pairs, edges, faces}),
            "pair 70: edge 2, vertex 5, but there are 5");
}

}  // namespace
}  // namespace touchstone::fast::mesh_test
