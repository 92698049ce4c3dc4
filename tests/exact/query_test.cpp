#include "touchstone/query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace touchstone::query_test {
namespace {

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
          EXPECT_EQ(&query.coordinates[Query::index(end, point, axis)], expected);
        }
      }
    }
  }
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
