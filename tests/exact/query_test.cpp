#include "touchstone/query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/plugin.h"

namespace touchstone::query_test {
namespace {

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

TEST(AnyKind, TextsAreThoseOfTheDatasets) {
  EXPECT_EQ(to_string(ContactKind::vertex_face), "vertex-face");
  EXPECT_EQ(to_string(ContactKind::edge_edge), "edge-edge");
  for (const AnyKind kind : all_kinds) EXPECT_EQ(kind_from_string(to_string(kind)), kind);
}

TEST(AnyKind, IsAContactOrACellAndHasTheNumbersOfTheInterfacesInC) {
  EXPECT_EQ(AnyKind(ContactKind::vertex_face).number(), TOUCHSTONE_VERTEX_FACE);
  EXPECT_EQ(AnyKind(ContactKind::edge_edge).number(), TOUCHSTONE_EDGE_EDGE);
  EXPECT_EQ(AnyKind(ContactKind::vertex_edge).number(), TOUCHSTONE_VERTEX_EDGE);
  EXPECT_EQ(AnyKind(ContactKind::vertex_vertex).number(), TOUCHSTONE_VERTEX_VERTEX);
  EXPECT_EQ(AnyKind(CellKind::tetrahedron).number(), TOUCHSTONE_TETRAHEDRON);
  EXPECT_EQ(AnyKind(CellKind::plane_triangle).number(), TOUCHSTONE_PLANE_TRIANGLE);
  for (std::size_t number = 0; number < AnyKind::count; ++number) {
    const AnyKind kind = AnyKind::with_number(static_cast<std::int64_t>(number)).value();
    EXPECT_EQ(kind.number(), number);
    EXPECT_EQ(kind.is_cell(), number > TOUCHSTONE_VERTEX_VERTEX);
    if (kind.is_cell()) {
      EXPECT_EQ(AnyKind(kind.cell()), kind);
      EXPECT_THROW(static_cast<void>(kind.contact()), std::invalid_argument);
    } else {
      EXPECT_EQ(AnyKind(kind.contact()), kind);
      EXPECT_THROW(static_cast<void>(kind.cell()), std::invalid_argument);
    }
  }
  for (const std::int64_t none : {std::int64_t{-1}, std::int64_t{AnyKind::count}, std::int64_t{256},
                                  std::int64_t{1} << 32U}) {
    EXPECT_EQ(AnyKind::with_number(none), std::nullopt);
  }
  for (std::size_t i = 0; i < all_kinds.size(); ++i) EXPECT_EQ(all_kinds.at(i).index(), i);
}

TEST(AnyKind, AnyOtherTextIsAnError) {
  for (const std::string_view text :
       {"", "vertex", "vertex_face", "Vertex-Face", "edge-edge ", " edge-edge",
        "edge-edgeedge-edge", "face-vertex", "vertex-edge", "vertex-vertex"}) {
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
