#include "verify/judge/terms.hpp"

#include <gtest/gtest.h>

#include "tests/support/queries.hpp"

namespace touchstone::verify::judge::terms_test {
namespace {

using fast::Terms;

/// A vertex that falls from that height onto a triangle.
base::AnyQuery falling(double height) {
  return {Kind::vertex_face, tests::over_triangle(1, 1, height, -2).query};
}

TEST(Terms, TheStartIsApartByMoreThanSeparationAndDistance) {
  const auto apart = [](double distance, double height, double separation) {
    return admits({.starts_apart = distance}, falling(height), {separation, Norm::l2});
  };
  EXPECT_FALSE(apart(0, 0, 0));
  EXPECT_TRUE(apart(0, 0x1p-1000, 0));
  EXPECT_FALSE(apart(0, 1, 1));
  EXPECT_TRUE(apart(0, 1, 0.5));
  EXPECT_FALSE(apart(0.5, 1, 0.5));
  EXPECT_TRUE(apart(0.25, 1, 0.5));
}

TEST(Terms, FloatCoordinatesAreRounded) {
  const Terms terms{.float_coordinates = true};
  const base::AnyQuery query = falling(0.1), asked = as_asked(terms, query);
  EXPECT_NE(asked, query);
  EXPECT_EQ(as_asked(terms, asked), asked);
  EXPECT_FALSE(admits(terms, query, {}));
  EXPECT_TRUE(admits(terms, asked, {}));
  const base::AnyQuery huge = as_asked(terms, falling(1e300));
  EXPECT_FALSE(is_finite(huge.numbers()));
  EXPECT_FALSE(admits(terms, huge, {}));
}

TEST(Terms, CurvesStartAtTheirFirstControlPointsAndAreAnsweredByDegree) {
  const Query line = falling(0.5).straight();
  std::vector<double> numbers(line.coordinates.begin(), line.coordinates.end());
  numbers.insert(numbers.end(), line.coordinates.begin() + 12, line.coordinates.end());
  const base::AnyQuery curve({.kind = Kind::vertex_face, .degree = 2}, numbers);
  EXPECT_FALSE(admits({}, curve, {}));
  EXPECT_FALSE(admits({.least_degree = 3, .most_degree = 8}, curve, {}));
  const Terms terms{.least_degree = 1, .most_degree = 2, .starts_apart = 0.25};
  EXPECT_TRUE(admits(terms, curve, {0.125, Norm::l2}));
  EXPECT_FALSE(admits(terms, curve, {0.25, Norm::l2}));
  EXPECT_TRUE(terms.answers(QueryShape{.degree = 1}));
  EXPECT_FALSE(terms.answers(QueryShape{.degree = 2, .is_rational = true}));
}

TEST(Terms, ElementsStartWithAPositiveVolume) {
  const Terms terms{.kinds = {false, false, true}, .starts_apart = 0.0};
  const Query resting = tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0x1p-1000},
                                      {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1});
  Query flat = resting;
  flat.at(0, 3, 2) = 0.0;
  EXPECT_TRUE(admits(terms, {Kind::tetrahedron, resting}, {}));
  EXPECT_FALSE(admits(terms, {Kind::tetrahedron, flat}, {}));
  EXPECT_FALSE(admits(terms, {Kind::plane_triangle, resting}, {}));
  EXPECT_FALSE(admits({}, {Kind::tetrahedron, resting}, {}));
}

TEST(Terms, NameTheKindsWhereTheyAreNotBothAboutContact) {
  EXPECT_EQ(to_text({.kinds = {true, true, true}}), "");
  EXPECT_EQ(to_text({.kinds = {true, false}}), ", vertex-face alone");
  const Terms of_elements{.kinds = {false, false, true, true}};
  EXPECT_EQ(to_text(of_elements), ", tetrahedron and plane-triangle alone");
  EXPECT_EQ(as_options(of_elements), " --kinds tetrahedron --kinds plane-triangle");
}

}  // namespace
}  // namespace touchstone::verify::judge::terms_test
