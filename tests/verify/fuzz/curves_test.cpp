#include "verify/fuzz/curves.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"
#include "verify/fuzz/plainness.hpp"

namespace touchstone::verify::fuzz::curves_test {
namespace {

bool collides(const AnyQuery& query) { return exact::decide(query.queries(), 0).collides(); }

/// A query on straight lines, with full significands near contact or of integers in degenerate
/// places, has the same verdict on curves, however fast it goes.
TEST(AtOtherSpeed, KeepsTheVerdict) {
  tests::Random random(1);
  int collisions = 0;
  const int count = tests::trials(200);
  for (int i = 0; i < count; ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const Query query =
        i % 4 < 2 ? tests::near_contact_query(random, kind) : tests::integer_query(random, 2);
    const std::size_t degree = 1 + static_cast<std::size_t>(i) % 5;
    const QueryShape shape{kind, degree, i % 3 == 0};
    const AnyQuery curves = at_other_speed(shape, query, 1 + static_cast<std::size_t>(i) % degree);
    ASSERT_EQ(curves.shape(), shape);
    EXPECT_EQ(collides(curves), exact::decide(kind, query).collides());
    collisions += collides(curves) ? 1 : 0;
  }
  EXPECT_GT(collisions, count / 8);
  EXPECT_LT(collisions, count - count / 8);
}

/// Of few bits, so that nothing is rounded.
TEST(OnCurves, KeepsTheVerdictOfIntegers) {
  tests::Random of_queries(2);
  generate::Random random(2);
  bool has_moved_on = false;
  for (int i = 0; i < tests::trials(200); ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const Query query = tests::integer_query(of_queries, 2);
    const AnyQuery curves = on_curves({kind, 3, i % 3 == 0}, query, random);
    EXPECT_EQ(collides(curves), exact::decide(kind, query).collides());
    // At another speed the middle control points are those of the ends.
    has_moved_on = has_moved_on || magnitudes(curves).size() > magnitudes({kind, query}).size() + 1;
  }
  EXPECT_TRUE(has_moved_on);
}

TEST(OfCurvedFamily, HasBothVerdictsInEveryShapeThatItCanBeRaisedTo) {
  generate::Random random(3);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    EXPECT_FALSE(of_curved_family({kind}, random));
    for (const QueryShape& shape : {QueryShape{kind, 2}, {kind, 3}, {kind, 5}, {kind, 2, true}}) {
      std::array<int, 2> verdicts{};
      for (int i = 0; i < 24; ++i) {
        const std::optional<AnyQuery> query = of_curved_family(shape, random);
        ASSERT_TRUE(query && query->shape() == shape && is_valid(*query));
        ++verdicts.at(collides(*query) ? 1 : 0);
      }
      EXPECT_GT(verdicts[0], 0);
      EXPECT_GT(verdicts[1], 0);
    }
  }
}

/// With a distance weights differ only where the oracle is fast.
TEST(OfNumbers, SharesWeightsWithADistance) {
  const auto has_different = [](const QueryShape& shape, const Separation& separation) {
    generate::Random random(4);
    for (int i = 0; i < 40; ++i) {
      const AnyQuery query = of_numbers(shape, separation, random);
      for (std::size_t j = 0; j <= shape.degree; ++j) {
        if (query.numbers()[16 * j + 3] != query.numbers()[16 * j + 15]) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has_different({.degree = 2, .is_rational = true}, {}));
  EXPECT_FALSE(has_different({.degree = 2, .is_rational = true}, {.distance = 0.25}));
  EXPECT_TRUE(has_different({.degree = 1, .is_rational = true}, {.distance = 0.25}));
}

TEST(IsDecidedSoon, ComparesCoordinatesOfCurvesWithTheDistance) {
  AnyQuery query({.degree = 2}, std::vector<double>(36, 1.0));
  const Separation separation{.distance = 0x1p-10};
  EXPECT_TRUE(is_decided_soon(query, separation));
  query.numbers()[7] = 0.0;
  query.numbers()[8] = 0x1p54;
  EXPECT_TRUE(is_decided_soon(query, separation));
  query.numbers()[8] = 0x1p55;
  EXPECT_FALSE(is_decided_soon(query, separation));
  EXPECT_TRUE(is_decided_soon(query, {}));
  EXPECT_TRUE(is_decided_soon({Kind::vertex_face, tests::over_triangle(1, 1, 0x1p99, -1).query},
                              separation));
}

}  // namespace
}  // namespace touchstone::verify::fuzz::curves_test
