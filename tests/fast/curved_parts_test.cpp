/// \file
/// The parts of the certified solver for curves against exact values.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/curved/contact_proof.hpp"
#include "fast/curved/control_polygon.hpp"
#include "fast/curved/curved_search.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::curved_parts_test {
namespace {

using curved::ControlPoints;
using curved::ControlPolygon;
using tests::Random;

struct OneQuery {
  std::vector<double> numbers;
  CurvedQueries queries;
};

/// One rational or polynomial query of degree 2, with weights in common to a primitive.
OneQuery one_query(Random& random, bool is_rational, double size) {
  OneQuery result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::array weights{random.uniform(0.5, 2), random.uniform(0.5, 2)};
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (int axis = 0; axis < 3; ++axis) result.numbers.push_back(size * random.uniform(-1, 1));
      if (is_rational) result.numbers.push_back(weights.at(point == 0 ? 0 : 1));
    }
  }
  result.queries = {2, is_rational, result.numbers};
  return result;
}

/// The exact control values of corner i on an axis, on a part of the time.
std::vector<mpq_class> exact_values(const ControlPoints& points, std::size_t i, std::size_t axis,
                                    bool is_rational) {
  const Corner& corner = curved::corner_of(Kind::vertex_face, i);
  const auto difference = [&](std::size_t a, std::size_t b) -> mpq_class {
    return mpq_class(points.x(a, corner.plus, axis)) - mpq_class(points.x(b, corner.minus, axis));
  };
  if (!is_rational) return {difference(0, 0), difference(1, 1), difference(2, 2)};
  static constexpr std::array binomials{1, 2, 1};
  static constexpr std::array wide{1, 4, 6, 4, 1};
  std::vector<mpq_class> values(5);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      values[a + b] += mpq_class(binomials.at(a) * binomials.at(b)) / wide.at(a + b) *
                       mpq_class(points.weight(a, 0)) * mpq_class(points.weight(b, 1)) *
                       difference(a, b);
    }
  }
  return values;
}

void halve(std::vector<mpq_class>& values, bool takes_second) {
  std::vector<mpq_class> first;
  std::vector<mpq_class> row = values;
  for (std::size_t k = 0; k < values.size(); ++k) {
    first.push_back(row[0]);
    for (std::size_t j = 0; j + k + 1 < values.size(); ++j) row[j] = (row[j] + row[j + 1]) / 2;
  }
  values = takes_second ? row : first;
}

TEST(ControlPolygon, HasItsErrorAfterAnyHalvings) {
  Random random(94);
  for (int round = 0; round < 300; ++round) {
    const bool is_rational = round % 2 == 1;
    const double size = round % 3 == 0 ? 0x1p-1058 : 1.0;
    const OneQuery query = one_query(random, is_rational, size);
    const ControlPoints points(Kind::vertex_face, query.queries, 0);
    ControlPolygon polygon;
    ASSERT_EQ(curved::load<Kind::vertex_face>(points, 0.0, polygon), curved::Loaded::yes);
    std::array<std::vector<mpq_class>, 12> exact;
    for (std::size_t place = 0; place < 12; ++place) {
      exact.at(place) = exact_values(points, place % 4, place / 4, is_rational);
    }
    for (int level = 0; level < 12; ++level) {
      for (std::size_t place = 0; place < 12; ++place) {
        for (std::size_t k = 0; k <= polygon.degree; ++k) {
          const mpq_class error = abs(exact.at(place)[k] - mpq_class(polygon.w.at(k).at(place)));
          ASSERT_LE(error, mpq_class(polygon.error));
          ASSERT_LE(std::abs(polygon.w.at(k).at(place)), polygon.magnitude);
        }
      }
      ControlPolygon first, second;
      curved::halve(polygon, first, second);
      const bool takes_second = random.coin();
      polygon.assign(takes_second ? second : first);
      for (auto& values : exact) halve(values, takes_second);
    }
  }
}

TEST(ContactProof, CountsChangesOfSign) {
  const auto form = [](const std::vector<double>& centers) {
    curved::BallForm result;
    for (const double x : centers) result.push_back(curved::Ball({x, 0.0}, 0.25));
    return result;
  };
  EXPECT_TRUE(curved::changes_once(form({1, -1})));
  EXPECT_TRUE(curved::changes_once(form({-1, -2, 0, 3})));
  EXPECT_TRUE(curved::changes_once(form({-1, 0.1, 3})));
  EXPECT_FALSE(curved::changes_once(form({1, 1})));
  EXPECT_FALSE(curved::changes_once(form({0, 1})));
  EXPECT_FALSE(curved::changes_once(form({1, 0, 0, -1})));
  EXPECT_FALSE(curved::changes_once(form({1, -1, 1, -1})));
  EXPECT_FALSE(curved::changes_once(form({1, -1, 1})));
  EXPECT_EQ(curved::common_sign(form({1, 2})), 1);
  EXPECT_EQ(curved::common_sign(form({-1, -2})), -1);
  EXPECT_EQ(curved::common_sign(form({-1, 0})), 0);
}

TEST(ContactProof, HasTheSignOfTheDeterminant) {
  Random random(95);
  for (int round = 0; round < 200; ++round) {
    const OneQuery query = one_query(random, round % 2 == 1, 1.0);
    const ControlPoints points(Kind::vertex_face, query.queries, 0);
    const double time = random.uniform(0, 1);
    exact::AlgebraicNumber at{exact::Rational(time)};
    const auto motion = exact::scale(Kind::vertex_face, query.queries.query(0), {});
    EXPECT_EQ(curved::determinant_sign<Kind::vertex_face>(points, time),
              exact::sign_at(exact::determinant(motion), at));
  }
}

/// The directions of a search prove nothing of a piece with a contact, whatever they are.
TEST(CurvedSearch, SeparatesNoContact) {
  Random random(96);
  for (int round = 0; round < 2000; ++round) {
    // The last corner is the negative of the first: the origin is in the triangle at the middle.
    ControlPolygon polygon;
    polygon.degree = 2;
    polygon.magnitude = 1.0;
    polygon.error = 0x1p-52;
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.reach.at(k) = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 4; ++i) {
          polygon.w.at(k).at(4 * axis + i) = i == 0   ? random.uniform(-1, 1)
                                             : i == 1 ? -polygon.w.at(2 - k).at(4 * axis)
                                                      : 0.5;
        }
      }
    }
    const curved::Separator any{
        {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, 2.0};
    EXPECT_FALSE(curved::separates(polygon, any));
    curved::Separator no_direction = any;
    no_direction.v.at(static_cast<std::size_t>(round) % 3) = std::nan("");
    EXPECT_FALSE(curved::separates(polygon, no_direction));
  }
}

TEST(CurvedPolygon, AtRestIsThePlaceAtATime) {
  CurvedQuery query;
  for (Trajectory& curve : query) curve.control = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}};
  query[1] = {.control = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .weights = {1, 1, 2}};
  const Query at = exact_stage::at_rest(query, 0.5);
  EXPECT_EQ(at.at(0, 0, 0), 1.5);
  EXPECT_EQ(at.at(1, 0, 1), 0.5);
  EXPECT_DOUBLE_EQ(at.at(0, 1, 0), 0.6);
  EXPECT_DOUBLE_EQ(at.at(0, 1, 1), 0.8);
  EXPECT_TRUE(exact_stage::is_valid(query));
  query[1].weights[0] = 0.0;
  EXPECT_FALSE(exact_stage::is_valid(query));
}

}  // namespace
}  // namespace touchstone::fast::curved_parts_test
