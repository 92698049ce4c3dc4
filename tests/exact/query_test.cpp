#include "touchstone/query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tests/support/contact_function.hpp"
#include "touchstone/number.hpp"

namespace touchstone::query_test {
namespace {

using exact::Rational;
using Vector = std::array<Rational, 3>;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};

TEST(Query, AnArrayOfDoublesIsASpanOfQueriesInTheOrderEndPointAxis) {
  std::vector<double> values(5 * 24);
  std::iota(values.begin(), values.end(), 0.0);
  const std::span<const Query> queries(reinterpret_cast<const Query*>(values.data()), 5);
  ASSERT_EQ(queries.size_bytes(), values.size() * sizeof(double));
  const double* expected = values.data();
  for (const Query& query : queries) {
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis, ++expected) {
          EXPECT_EQ(query.at(end, point, axis), *expected);
          EXPECT_EQ(query.point(end, point).data() + axis, expected);
        }
      }
    }
  }
}

TEST(ContactFunction, HasTheValuesComputedByHand) {
  // Point k stands at (k, k², 1) at t=0 and moves by (4, 0, −2k).
  Query query{};
  for (std::size_t k = 0; k < moving_points; ++k) {
    const auto x = static_cast<double>(k);
    query.point(0, k) = Eigen::Vector3d(x, x * x, 1.0);
    query.point(1, k) = Eigen::Vector3d(x + 4.0, x * x, 1.0 - 2.0 * x);
  }
  // At t=1/2 point k is at (k+2, k², 1−k).
  const Rational t(1, 2), u(1, 4), v(1, 3);
  // v = (2,0,1); the face at (5/12, 1/4, 1/3): (3,1,0)·5/12 + (4,4,−1)·1/4 + (5,9,−2)·1/3.
  EXPECT_EQ(tests::contact_function(Kind::vertex_face, query, t, u, v),
            (Vector{Rational(-23, 12), Rational(-53, 12), Rational(23, 12)}));
  // ea: (2,0,1)·3/4 + (3,1,0)·1/4; eb: (4,4,−1)·2/3 + (5,9,−2)·1/3.
  EXPECT_EQ(tests::contact_function(Kind::edge_edge, query, t, u, v),
            (Vector{Rational(-25, 12), Rational(-65, 12), Rational(25, 12)}));
}

TEST(Kind, TextsAreThoseOfTheDatasets) {
  EXPECT_EQ(to_string(Kind::vertex_face), "vertex-face");
  EXPECT_EQ(to_string(Kind::edge_edge), "edge-edge");
  for (const Kind kind : kinds) EXPECT_EQ(kind_from_string(to_string(kind)), kind);
}

TEST(Kind, AnyOtherTextIsAnError) {
  for (const std::string_view text : {"", "vertex", "vertex_face", "Vertex-Face", "edge-edge ",
                                      " edge-edge", "edge-edgeedge-edge", "face-vertex"}) {
    EXPECT_THROW(static_cast<void>(kind_from_string(text)), std::invalid_argument) << text;
  }
  using namespace std::string_view_literals;
  EXPECT_THROW(static_cast<void>(kind_from_string("edge-edge\0"sv)), std::invalid_argument);
}

TEST(Norm, TextsAndNormsAreEachOthersInverse) {
  EXPECT_EQ(to_string(Norm::linf), "linf");
  EXPECT_EQ(to_string(Norm::l2), "l2");
  for (const Norm norm : {Norm::linf, Norm::l2}) EXPECT_EQ(norm_from_string(to_string(norm)), norm);
  for (const std::string_view text : {"", "l", "L2", "linf ", "l1", "inf"}) {
    EXPECT_THROW(static_cast<void>(norm_from_string(text)), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace touchstone::query_test
