#include "exact/contact/contact_conditions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <variant>

#include "tests/support/queries.hpp"

namespace touchstone::exact::contact_conditions_test {
namespace {

using tests::over_triangle;
using tests::PosedQuery;

std::optional<ContactConditions> near_at(const PosedQuery& posed, const Separation& separation,
                                         const Rational& t) {
  AlgebraicNumber time(t);
  return find_near_contact(scale_uniformly(posed.kind, posed.query, separation), time);
}

template <class Place>
void expect_place(const std::optional<ContactConditions>& found, const Place& expected) {
  ASSERT_TRUE(found);
  ASSERT_TRUE(std::holds_alternative<Place>(found->place)) << found->place.index();
  EXPECT_EQ(std::get<Place>(found->place), expected);
}

TEST(FindContact, ATriangleOrASegment) {
  AlgebraicNumber half(Rational(1, 2)), start(0);
  const PosedQuery inside = over_triangle(1, 1, 1, -1);
  const Motion motion = scale_uniformly(inside.kind, inside.query);
  expect_place(find_contact(motion, half), TriangleContact{{0, 1, 2}, 2});
  EXPECT_FALSE(find_contact(motion, start));
  const auto needle = tests::vertex_face({1, 0, 1, 0, 0, 0, 4, 0, 0, 2, 0, 0},
                                         {1, 0, -1, 0, 0, 0, 4, 0, 0, 2, 0, 0});
  expect_place(find_contact(scale_uniformly(needle.kind, needle.query), half),
               SegmentContact{{0, 1}});
}

TEST(FindNearContact, TheNearestPartInL2) {
  const Separation five{.distance = 5, .norm = Norm::l2};
  expect_place(near_at(over_triangle(0, -3, 4, 4), five, 0), VertexContact{0});
  expect_place(near_at(over_triangle(2, -3, 4, 4), five, 0), EdgeContact{{0, 1}});
  const Separation one{.distance = 1, .norm = Norm::l2};
  expect_place(near_at(over_triangle(1, 1, 1, 1), one, 0), FaceContact{});
  EXPECT_FALSE(near_at(over_triangle(2, -3, 4.5, 4), five, 0));
  EXPECT_FALSE(near_at(over_triangle(1, 1, 1.5, 1), one, 0));
  // At the distance, near the face's plane and outside its side; near a side's line and beyond its
  // end.
  EXPECT_FALSE(near_at(over_triangle(2, -3, 0.5, 0), one, 0));
  EXPECT_FALSE(near_at(over_triangle(-3, 0, 0.5, 0), one, 0));
}

TEST(FindNearContact, ACubeInLinf) {
  const Separation four{.distance = 4, .norm = Norm::linf};
  expect_place(near_at(over_triangle(2, -3, 4, 4), four, 0), AxesContact{});
  EXPECT_FALSE(near_at(over_triangle(2, -3, 4.5, 4), four, 0));
  EXPECT_FALSE(near_at(over_triangle(2, -4.5, 4, 4), four, 0));
}

TEST(FindNearContact, ItsConditionsAreSplitBySign) {
  // The height 3 − 4t is the distance 1 at t = 1/2.
  const PosedQuery falling = over_triangle(1, 1, 3, -1);
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    AlgebraicNumber half(Rational(1, 2));
    const auto found = near_at(falling, {1, norm}, Rational(1, 2));
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->zero.empty());
    EXPECT_FALSE(found->nonzero.empty());
    for (const Polynomial& p : found->zero) EXPECT_EQ(half.sign_of(p), 0);
    for (const Polynomial& p : found->nonzero) EXPECT_NE(half.sign_of(p), 0);
    const auto inside = near_at(falling, {1, norm}, Rational(3, 4));
    ASSERT_TRUE(inside);
  }
}

}  // namespace
}  // namespace touchstone::exact::contact_conditions_test
