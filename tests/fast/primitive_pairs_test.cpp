#include "fast/primitive_pairs.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/certified.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::fast::primitive_pairs_test {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector3d;
using tests::Random;

constexpr double third = 1.0 / 3.0;

void expect_enclosed(const CertifiedResult& result, double toi) {
  EXPECT_EQ(result.verdict, Verdict::yes);
  EXPECT_LT(result.toi_lower, toi);
  EXPECT_GE(result.toi_upper, toi);
}

TEST(PrimitivePairs, PointAndTriangleMeetWhereTheyDo) {
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const CertifiedResult result =
      point_triangle(Vector3d(2, 1, 1), a, b, c, Vector3d(2, 1, -1), a, b, c);
  expect_enclosed(result, 0.5);
  EXPECT_DOUBLE_EQ(result.u, 0.5);
  EXPECT_DOUBLE_EQ(result.v, 0.25);
  EXPECT_EQ(point_triangle(Vector3d(3, 2, 1), a, b, c, Vector3d(3, 2, -1), a, b, c).verdict,
            Verdict::no);
}

TEST(PrimitivePairs, EdgesMeetWhereTheyDo) {
  const Vector3d a0(0, 0, 0), a1(4, 0, 0);
  const CertifiedResult result = edge_edge(a0, a1, Vector3d(1, -1, 1), Vector3d(1, 3, 1),  //
                                           a0, a1, Vector3d(1, -1, -2), Vector3d(1, 3, -2));
  expect_enclosed(result, third);
  EXPECT_DOUBLE_EQ(result.u, 0.25);
  EXPECT_DOUBLE_EQ(result.v, 0.25);
}

TEST(PrimitivePairs, PointAndEdgeMeetOnTheEdgeAlone) {
  const Vector3d a(0, 0, 0), b(4, 0, 0);
  const CertifiedResult result = point_edge(Vector3d(3, 0, 1), a, b, Vector3d(3, 0, -1), a, b);
  expect_enclosed(result, 0.5);
  EXPECT_DOUBLE_EQ(result.u, 0.75);
  EXPECT_EQ(result.v, 0.0);
  EXPECT_EQ(point_edge(Vector3d(3, 1e-300, 1), a, b, Vector3d(3, 1e-300, -1), a, b).verdict,
            Verdict::no);
  EXPECT_EQ(point_edge(Vector3d(5, 0, 1), a, b, Vector3d(5, 0, -1), a, b).verdict, Verdict::no);
}

TEST(PrimitivePairs, PointsMeetInOnePlaceAlone) {
  const CertifiedResult result =
      point_point(Vector3d(0, 0, 0), Vector3d(3, 0, 0), Vector3d(2, 0, 0), Vector3d(-1, 0, 0));
  expect_enclosed(result, 0.5);
  EXPECT_EQ(result.u, 0.0);
  EXPECT_EQ(result.v, 0.0);
  EXPECT_EQ(point_point(Vector3d(0, 0, 0), Vector3d(3, 0, 1e-300), Vector3d(2, 0, 0),
                        Vector3d(-1, 0, 1e-300))
                .verdict,
            Verdict::no);
}

TEST(PrimitivePairs, MayBeGivenInAnyShape) {
  const std::vector<double> doubles{3, 0, 1, 3, 0, -1, 0, 0, 0, 4, 0, 0};
  const std::vector<float> floats(doubles.begin(), doubles.end());
  const CertifiedResult expected =
      point_edge(&doubles[0], &doubles[6], &doubles[9], &doubles[3], &doubles[6], &doubles[9]);
  ASSERT_EQ(expected.verdict, Verdict::yes);
  const auto expect_same = [&](const CertifiedResult& result) {
    EXPECT_EQ(result.toi_lower, expected.toi_lower);
    EXPECT_EQ(result.toi_upper, expected.toi_upper);
    EXPECT_EQ(result.u, expected.u);
  };
  expect_same(point_edge(&floats[0], &floats[6], &floats[9], &floats[3], &floats[6], &floats[9]));
  const Eigen::Map<const Eigen::Matrix<float, 4, 3, Eigen::RowMajor>> rows(floats.data());
  expect_same(
      point_edge(rows.row(0), rows.row(2), rows.row(3), rows.row(1), rows.row(2), rows.row(3)));
  const Eigen::MatrixXd columns = rows.cast<double>().transpose();
  expect_same(point_edge(columns.col(0), columns.col(2), columns.col(3), columns.col(1),
                         columns.col(2), columns.col(3)));
  const Eigen::VectorXd of_any_size = columns.col(0);
  expect_same(point_edge(of_any_size, RowVector3d(0, 0, 0), Vector3d(4, 0, 0),
                         columns.col(1) + Vector3d::Zero(), &doubles[6], columns.col(3)));
  const double plain[3] = {3, 0, 1};  // NOLINT(modernize-avoid-c-arrays)
  expect_same(point_edge(plain, &doubles[6], &doubles[9], &doubles[3], &doubles[6], &doubles[9]));
}

TEST(PrimitivePairs, RefuseAnythingElse) {
  const Vector3d o(0, 0, 0);
  EXPECT_THROW((void)point_point(Eigen::VectorXd(2), o, o, o), std::invalid_argument);
  EXPECT_THROW((void)point_point(o, o, o, o, {.t_max = 2.0}), std::invalid_argument);
  EXPECT_EQ(point_point(Vector3d(std::nan(""), 0, 0), o, o, o).verdict, Verdict::error);
}

TEST(PrimitivePairs, TakeTheSolversOptions) {
  const Vector3d o(0, 0, 0);
  const CertifiedOptions near{.separation = {.distance = 1.0, .norm = Norm::l2}};
  expect_enclosed(point_point(Vector3d(3, 0, 0), o, Vector3d(-3, 0, 0), o, near), third);
  const CertifiedOptions early{.t_max = 0.25};
  EXPECT_EQ(point_point(Vector3d(3, 0, 0), o, Vector3d(-3, 0, 0), o, early).verdict, Verdict::no);
}

TEST(PrimitivePairs, AgreeWithTheOracle) {
  Random random(181);
  int touching = 0;
  for (int i = 0; i < tests::trials(400); ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.between(0, 3);
    const auto p = [&](std::size_t end, std::size_t k) { return query.point(end, k); };
    const auto expect_right = [&](Kind kind, const CertifiedResult& result) {
      EXPECT_EQ(tests::fault(kind, query, result).value_or(""), "");
      touching += result.verdict == Verdict::yes ? 1 : 0;
    };
    expect_right(Kind::vertex_face, point_triangle(p(0, 0), p(0, 1), p(0, 2), p(0, 3),  //
                                                   p(1, 0), p(1, 1), p(1, 2), p(1, 3)));
    expect_right(Kind::edge_edge, edge_edge(p(0, 0), p(0, 1), p(0, 2), p(0, 3),  //
                                            p(1, 0), p(1, 1), p(1, 2), p(1, 3)));
    for (const std::size_t end : {0U, 1U}) p(end, 3) = p(end, 1);
    expect_right(Kind::vertex_face, point_edge(p(0, 0), p(0, 1), p(0, 2),  //
                                               p(1, 0), p(1, 1), p(1, 2)));
    for (const std::size_t end : {0U, 1U}) p(end, 2) = p(end, 3) = p(end, 1);
    expect_right(Kind::vertex_face, point_point(p(0, 0), p(0, 1), p(1, 0), p(1, 1)));
  }
  EXPECT_GT(touching, tests::trials(40));
}

}  // namespace
}  // namespace touchstone::fast::primitive_pairs_test
