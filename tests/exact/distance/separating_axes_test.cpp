#include "exact/distance/separating_axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::exact::separating_axes_test {
namespace {

using tests::over_triangle;
using tests::PosedQuery;
using Sort = Feature::Sort;

using Vector = std::array<Rational, 3>;

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector times(const Rational& x, const Vector& a) { return {x * a[0], x * a[1], x * a[2]}; }

std::vector<Vector> corners_at(const Motion& motion, const Rational& t) {
  std::vector<Vector> result(motion.corner_count);
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Form<1>& x = motion.corners.at(i).at(axis);
      result[i].at(axis) = x.c[0] * (1 - t) + x.c[1] * t;
    }
  }
  return result;
}

/// The direction of a feature as the format defines it.
Vector direction(const Feature& feature, const std::vector<Vector>& w) {
  Vector normal = cross(minus(w[1], w[0]), minus(w[2], w[0]));
  Vector unit{0, 0, 0};
  unit.at(feature.axis) = 1;
  switch (feature.sort) {
    case Sort::vertex:
      return w[feature.i];
    case Sort::edge: {
      const Vector e = minus(w[feature.j], w[feature.i]);
      return minus(times(dot(e, e), w[feature.i]), times(dot(w[feature.i], e), e));
    }
    case Sort::positive_face:
      return normal;
    case Sort::negative_face:
      return times(-1, normal);
    case Sort::positive_axis:
      return unit;
    case Sort::negative_axis:
      return times(-1, unit);
    default:
      return cross(unit, minus(w[feature.j], w[feature.i]));
  }
}

/// a·w > d‖a‖* for all corners, by the definition.
bool separates(const Motion& motion, const Vector& a, const std::vector<Vector>& w) {
  const Rational d(motion.distance);
  return std::ranges::all_of(w, [&](const Vector& corner) {
    const Rational value = dot(a, corner);
    if (motion.norm == Norm::linf) return value > d * (abs(a[0]) + abs(a[1]) + abs(a[2]));
    return sgn(value) > 0 && value * value > d * d * dot(a, a);
  });
}

PosedQuery small_query(tests::Random& random) {
  const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
  return tests::random_query(
      random, kind, random.coin() ? tests::Family::small_integers : tests::Family::near_contact);
}

TEST(Separators, HoldWhereTheirDirectionSeparates) {
  tests::Random random(31);
  std::set<Sort> seen;
  for (int repetition = 0; repetition < 200; ++repetition) {
    const PosedQuery posed = small_query(random);
    const double distance = random.between(0, 3) / 4.0;
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Motion motion = scale_uniformly(posed.kind, posed.query, {distance, norm});
      for (Separator& separator : separators(motion)) {
        for (int k = 0; k <= 6; ++k) {
          const Rational t(k, 6);
          const auto w = corners_at(motion, t);
          AlgebraicNumber time(t);
          const bool holds = separator.holds_at(time);
          ASSERT_EQ(holds, separates(motion, direction(separator.feature(), w), w)) << posed << t;
          if (holds) seen.insert(separator.feature().sort);
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 7U);
}

TEST(Separators, NoneIsLeftOutThatSeparatesSomewhere) {
  tests::Random random(32);
  for (int repetition = 0; repetition < 200; ++repetition) {
    const PosedQuery posed = small_query(random);
    const Motion motion =
        scale_uniformly(posed.kind, posed.query, {random.between(0, 3) / 4.0, Norm::linf});
    const std::vector<Separator> all = separators(motion);
    if (all.size() == 1 && all.front().is_trivial()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < motion.corner_count; ++i) {
        const std::size_t j = (i + 1) % motion.corner_count;
        const Feature feature{.sort = Sort::cross, .i = i, .j = j, .axis = axis};
        const auto w = corners_at(motion, Rational(1, 3));
        if (!separates(motion, direction(feature, w), w)) continue;
        // The separator, or a parallel one.
        const bool is_listed = std::ranges::any_of(all, [&](const Separator& other) {
          const Vector a = direction(other.feature(), w), b = direction(feature, w);
          return cross(a, b) == Vector{0, 0, 0} && dot(a, b) > 0;
        });
        EXPECT_TRUE(is_listed) << posed;
      }
    }
  }
}

TEST(Separators, OneThatHoldsThroughoutIsAlone) {
  const PosedQuery above = over_triangle(1, 1, 3, 2);
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    const auto all = separators(scale_uniformly(above.kind, above.query, {1.5, norm}));
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all.front().is_trivial());
    EXPECT_EQ(all.front().feature().sort,
              norm == Norm::l2 ? Sort::positive_face : Sort::positive_axis);
  }
}

TEST(Separator, EndsAtItsFirstRootAfterATimeAndBeginsAtTheLastBefore) {
  // Positive between 1/4 and 1/2 and above 3/4: (4t−1)(2t−1)(4t−3) as a form in (1−t), t.
  const std::vector<Integer> form{Integer(-3), Integer(13), Integer(-13), Integer(3)};
  Separator separator({}, {{form}});
  ASSERT_EQ(separator.polynomial(0), Polynomial(Integer(-1), Integer(4)) *
                                         Polynomial(Integer(-1), Integer(2)) *
                                         Polynomial(Integer(-3), Integer(4)));
  std::optional<AlgebraicNumber> none, bound(Rational(1, 2)), later(Rational(5, 8));
  AlgebraicNumber inside(Rational(3, 8)), above(Rational(7, 8));
  EXPECT_TRUE(separator.holds_at(inside));
  const auto end = separator.end_after(inside, none);
  ASSERT_TRUE(end.root);
  EXPECT_TRUE(*end.root == Rational(1, 2));
  EXPECT_FALSE(end.is_within_bound);
  EXPECT_TRUE(separator.end_after(inside, bound).is_within_bound);
  EXPECT_TRUE(separator.end_after(inside, later).is_within_bound);
  EXPECT_TRUE(*separator.begin_before(inside) == Rational(1, 4));
  EXPECT_FALSE(separator.end_after(above, none).root);
  EXPECT_TRUE(*separator.begin_before(above) == Rational(3, 4));
}

TEST(Separator, AGuardHasNoRoots) {
  const std::vector<Integer> falling{Integer(1), Integer(-1)};
  Separator separator({}, {{.form = falling, .is_guard = true}});
  AlgebraicNumber start(0), end(1);
  std::optional<AlgebraicNumber> none;
  EXPECT_TRUE(separator.holds_at(start));
  EXPECT_FALSE(separator.holds_at(end));
  EXPECT_FALSE(separator.end_after(start, none).root);
}

TEST(Farthest, IsTheOneThatHoldsLongest) {
  const auto until = [](int n, int d) {
    return Separator({.sort = Sort::vertex, .i = static_cast<std::size_t>(n)},
                     {{{Integer(n), Integer(n - d)}}});
  };
  std::vector<Separator> all;
  for (const int n : {1, 3, 2}) all.push_back(until(n, 4));
  const auto span = farthest(all, AlgebraicNumber(0));
  ASSERT_TRUE(span && span->end);
  EXPECT_EQ(span->separator->feature().i, 3U);
  EXPECT_TRUE(*span->end == Rational(3, 4));
  EXPECT_FALSE(farthest(all, *span->end));
  all.push_back(until(9, 4));
  EXPECT_FALSE(farthest(all, AlgebraicNumber(0))->end);
}

TEST(FirstContact, IsWhereTheLastSeparatorEnds) {
  const PosedQuery falling = over_triangle(1, 1, 3, -1);
  const auto first = end_of_separation(scale_uniformly(falling.kind, falling.query, {1, Norm::l2}));
  ASSERT_TRUE(first);
  EXPECT_TRUE(*first == Rational(1, 2));
  const PosedQuery above = over_triangle(1, 1, 3, 2);
  EXPECT_FALSE(end_of_separation(scale_uniformly(above.kind, above.query, {1, Norm::l2})));
}

}  // namespace
}  // namespace touchstone::exact::separating_axes_test
