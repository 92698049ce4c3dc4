#include "touchstone/certified.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace touchstone::fast::primitive_pairs_test {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector3d;

void expect_enclosed(const CertifiedResult& result, double toi) {
  EXPECT_EQ(result.verdict, Verdict::yes);
  EXPECT_LT(result.toi_lower, toi);
  EXPECT_GE(result.toi_upper, toi);
}

TEST(PrimitivePairs, PointAndEdgeMeetOnTheEdgeAlone) {
  const Vector3d a(0, 0, 0), b(4, 0, 0);
  const CertifiedResult result =
      solve_vertex_edge(Vector3d(3, 0, 1), a, b, Vector3d(3, 0, -1), a, b);
  expect_enclosed(result, 0.5);
  EXPECT_DOUBLE_EQ(result.u, 0.75);
  EXPECT_EQ(result.v, 0.0);
  EXPECT_EQ(solve_vertex_edge(Vector3d(3, 1e-300, 1), a, b, Vector3d(3, 1e-300, -1), a, b).verdict,
            Verdict::no);
  EXPECT_EQ(solve_vertex_edge(Vector3d(5, 0, 1), a, b, Vector3d(5, 0, -1), a, b).verdict,
            Verdict::no);
}

TEST(PrimitivePairs, PointsMeetInOnePlaceAlone) {
  const CertifiedResult result = solve_vertex_vertex(Vector3d(0, 0, 0), Vector3d(3, 0, 0),
                                                     Vector3d(2, 0, 0), Vector3d(-1, 0, 0));
  expect_enclosed(result, 0.5);
  EXPECT_EQ(result.u, 0.0);
  EXPECT_EQ(result.v, 0.0);
  EXPECT_EQ(solve_vertex_vertex(Vector3d(0, 0, 0), Vector3d(3, 0, 1e-300), Vector3d(2, 0, 0),
                                Vector3d(-1, 0, 1e-300))
                .verdict,
            Verdict::no);
  // With the options of the solver.
  const Vector3d o(0, 0, 0), before(3, 0, 0), after(-3, 0, 0);
  const CertifiedOptions near{.separation = {.distance = 1.0, .norm = Norm::l2}};
  expect_enclosed(solve_vertex_vertex(before, o, after, o, near), 1.0 / 3.0);
  EXPECT_EQ(solve_vertex_vertex(before, o, after, o, {.t_max = 0.25}).verdict, Verdict::no);
}

TEST(PrimitivePairs, MayBeGivenInAnyShape) {
  const std::vector<double> doubles{3, 0, 1, 3, 0, -1, 0, 0, 0, 4, 0, 0};
  const std::vector<float> floats(doubles.begin(), doubles.end());
  const CertifiedResult expected = solve_vertex_edge(&doubles[0], &doubles[6], &doubles[9],
                                                     &doubles[3], &doubles[6], &doubles[9]);
  ASSERT_EQ(expected.verdict, Verdict::yes);
  const auto expect_same = [&](const CertifiedResult& result) {
    EXPECT_EQ(result.toi_lower, expected.toi_lower);
    EXPECT_EQ(result.toi_upper, expected.toi_upper);
    EXPECT_EQ(result.u, expected.u);
  };
  expect_same(
      solve_vertex_edge(&floats[0], &floats[6], &floats[9], &floats[3], &floats[6], &floats[9]));
  const Eigen::Map<const Eigen::Matrix<float, 4, 3, Eigen::RowMajor>> rows(floats.data());
  expect_same(solve_vertex_edge(rows.row(0), rows.row(2), rows.row(3), rows.row(1), rows.row(2),
                                rows.row(3)));
  const Eigen::MatrixXd columns = rows.cast<double>().transpose();
  expect_same(solve_vertex_edge(columns.col(0), columns.col(2), columns.col(3), columns.col(1),
                                columns.col(2), columns.col(3)));
  const Eigen::VectorXd of_any_size = columns.col(0);
  expect_same(solve_vertex_edge(of_any_size, RowVector3d(0, 0, 0), Vector3d(4, 0, 0),
                                columns.col(1) + Vector3d::Zero(), &doubles[6], columns.col(3)));
  const double plain[3] = {3, 0, 1};  // NOLINT(modernize-avoid-c-arrays)
  expect_same(
      solve_vertex_edge(plain, &doubles[6], &doubles[9], &doubles[3], &doubles[6], &doubles[9]));
}

TEST(PrimitivePairs, RefuseAnythingElse) {
  const Vector3d o(0, 0, 0);
  EXPECT_THROW((void)solve_vertex_vertex(Eigen::VectorXd(2), o, o, o), std::invalid_argument);
  EXPECT_EQ(solve_vertex_vertex(Vector3d(std::nan(""), 0, 0), o, o, o).verdict, Verdict::error);
}

}  // namespace
}  // namespace touchstone::fast::primitive_pairs_test
