/// \file
/// The parts of the certified solver for curves against exact values.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "fast/certified/curves/stages.hpp"
#include "fast/certified/exact/curved_polygon.hpp"
#include "fast/platform/scalar_doubles.hpp"
#include "tests/support/polynomials.hpp"
#include "tests/support/random.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::curved_parts_test {
namespace {

using tests::Random;

/// One query in the one lane.
struct Lanes {
  using Value = fast::Value;
  using Mask = fast::Mask;
  static constexpr std::size_t width = 1;

  static std::array<Value, 3> load(const std::array<const double*, width>& rows) {
    return {Value(rows[0][0]), Value(rows[0][1]), Value(rows[0][2])};
  }
  static std::array<Value, 3> load_backwards(const std::array<const double*, width>& rows) {
    return load(rows);
  }
};
constexpr Kind kind = Kind::vertex_face;
using Polygons = curved::ControlPolygons<Lanes, kind>;

struct OneQuery {
  std::vector<double> numbers;
  Queries queries;
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
  result.queries = {{.degree = 2, .is_rational = is_rational}, result.numbers};
  return result;
}

curved::Block block_of(const Queries& queries) {
  return {queries, {.distance = 0.25, .norm = Norm::linf}};
}

bool load(const curved::Block& block, Polygons& polygons) {
  const curved::Rows<Lanes> rows{block, {block.numbers.data()}};
  const auto form = block.is_rational ? curved::Denominators::two : curved::Denominators::one;
  return curved::Loading<Lanes, kind>::run(rows, form, polygons).set;
}

/// The exact Bernstein coefficients at a place of a control point.
std::vector<mpq_class> exact_values(const curved::Block& block, std::size_t place) {
  const auto number = [&](std::size_t k, std::size_t point, std::size_t i) -> mpq_class {
    const std::size_t stride = block.numbers_of_point();
    if (i == 3 && !block.is_rational) return 1;
    return block.numbers[(k * moving_points + point) * stride + i];
  };
  const auto value = [&](std::size_t a, std::size_t b) -> mpq_class {
    if (place == 9) return block.separation.distance;
    const Corner& corner = vertex_face_corners.at(place % 3);
    return number(a, corner.plus, place / 3) - number(b, corner.minus, place / 3);
  };
  if (!block.is_rational) return {value(0, 0), value(1, 1), value(2, 2)};
  static constexpr std::array binomials{1, 2, 1};
  static constexpr std::array wide{1, 4, 6, 4, 1};
  std::vector<mpq_class> values(5);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      values[a + b] += mpq_class(binomials.at(a) * binomials.at(b)) / wide.at(a + b) *
                       number(a, 0, 3) * number(b, 1, 3) * value(a, b);
    }
  }
  return values;
}

TEST(ControlPolygon, HasItsErrorOnAnyPart) {
  Random random(94);
  for (int round = 0; round < 3000; ++round) {
    const double size = round % 3 == 0 ? 0x1p-1058 : 1.0;
    const OneQuery query = one_query(random, round % 2 == 1, size);
    const curved::Block block = block_of(query.queries);
    Polygons whole, part;
    ASSERT_TRUE(load(block, whole));
    double begin = round % 5 == 0 ? 0.0 : random.uniform(0, 1);
    double end = round % 7 == 0 ? 1.0 : random.uniform(0, 1);
    if (begin > end) std::swap(begin, end);
    curved::restrict_to<true>(whole, Value(begin), Value(end), part);
    for (std::size_t place = 0; place < Polygons::size; ++place) {
      const std::vector<mpq_class> of_whole = exact_values(block, place);
      const auto of_part = tests::bernstein_on(of_whole, begin, end);
      ASSERT_EQ(part.degree + 1, of_part.size());
      for (std::size_t k = 0; k <= part.degree; ++k) {
        const mpq_class bound = part.error[0];
        ASSERT_LE(abs(of_whole[k] - mpq_class(whole.at(k, place).x)), bound);
        ASSERT_LE(abs(of_part[k] - mpq_class(part.at(k, place).x)), bound);
        ASSERT_LE(std::abs(part.at(k, place).x), part.magnitude[0]);
      }
    }
  }
}

TEST(ControlPolygon, IsNoneOfNumbersThatAreNotUsual) {
  for (const double bad : {0x1p102, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (std::size_t place = 0; place < 36; ++place) {
      std::vector<double> numbers(36, 1.0);
      numbers[place] = bad;
      Polygons polygons;
      EXPECT_FALSE(load(block_of({{.degree = 2}, numbers}), polygons));
    }
  }
}

/// The coefficients of det are those of the exact form, within the error that the proof allows.
TEST(ContactProof, HasTheCoefficientsOfTheDeterminant) {
  Random random(97);
  int proved = 0;
  for (int round = 0; round < 2000; ++round) {
    OneQuery query = one_query(random, round % 2 == 1, 1.0);
    // A corner's normal along z, and a vertex that passes through the triangle.
    const std::size_t stride = query.queries.numbers_of_point();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        double* const x = query.numbers.data() + (k * moving_points + point) * stride;
        x[0] = 0.05 * x[0] + std::array{0.0, -1.0, 1.0, 0.0}.at(point);
        x[1] = 0.05 * x[1] + std::array{0.0, -1.0, -1.0, 1.0}.at(point);
        x[2] = 0.05 * x[2] + (point == 0 ? static_cast<double>(k) - 1.0 : 0.0);
      }
    }
    const curved::Block block = block_of(query.queries);
    Polygons polygons;
    ASSERT_TRUE(load(block, polygons));
    curved::DeterminantForms<Lanes> det;
    const curved::Crossing<Lanes, kind> crossing(polygons, Mask::none(), Mask::all());
    if (!crossing.is_proved(det).set) continue;
    ++proved;
    const auto motion = exact::scale(kind, to_curved(query.queries, 0), {});
    for (int i = 0; i <= 8; ++i) {
      const double t = 0.125 * i;
      mpq_class sum = 0, power = 1;
      for (std::size_t m = 0; m <= det.degree; ++m) {
        sum = sum * (1 - mpq_class(t)) + mpq_class(det.coefficient[m][0]) * power;
        power *= t;
      }
      // (That of 9 corners below 3 and weights below 4 is below 2^-30.)
      if (abs(sum) < 0x1p-30) continue;
      exact::AlgebraicNumber at{exact::Rational(t)};
      EXPECT_EQ(exact::sign_at(exact::determinant(motion), at), sgn(sum));
    }
    EXPECT_TRUE(exact::decide(query.queries, 0).collides());
  }
  EXPECT_GT(proved, 1000);
}

TEST(ContactProof, HasTheSignOfTheDeterminant) {
  Random random(95);
  for (int round = 0; round < 200; ++round) {
    const OneQuery query = one_query(random, round % 2 == 1, 1.0);
    const curved::Block block = block_of(query.queries);
    const double time = random.uniform(0, 1);
    exact::AlgebraicNumber at{exact::Rational(time)};
    const auto motion = exact::scale(kind, to_curved(query.queries, 0), {});
    const auto signs =
        curved::AtTime<Lanes, kind>({block, {block.numbers.data()}}, Value(time)).determinant();
    const int sign = exact::sign_at(exact::determinant(motion), at);
    EXPECT_EQ(signs.is_positive.set, sign > 0);
    EXPECT_EQ(signs.is_negative.set, sign < 0);
  }
}

/// Times a number.
bool is_multiple(const exact_stage::Polynomial& a, const exact_stage::Polynomial& b) {
  const auto place = static_cast<std::size_t>(
      std::ranges::find_if(b, [](const auto& x) { return x.sign() != 0; }) - b.begin());
  return a.size() == b.size() && a * b[place] == b * a[place];
}

/// For every choice of equal and different weights of the points.
TEST(CurvedPolygon, HasFactorsThatDivideTheDeterminant) {
  Random random(101);
  for (const Kind any : {Kind::vertex_face, Kind::edge_edge}) {
    for (int choice = 0; choice < 625; ++choice) {
      CurvedQuery query;
      int rest = choice;
      for (Trajectory& curve : query) {
        for (int k = 0; k < 3; ++k) {
          curve.control.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform()});
        }
        const double weight = rest % 5;
        if (weight > 0) curve.weights = {1, weight + 1, std::ldexp(weight + 2, 300)};
        rest /= 5;
      }
      for (const auto& [motion, factors] : exact_stage::motions_of(any, query)) {
        exact_stage::Polynomial left = determinant(motion, normal(motion));
        for (const exact_stage::Polynomial& factor : factors) {
          const exact_stage::Polynomial quotient = exact_stage::scaled_quotient(left, factor);
          ASSERT_TRUE(is_multiple(quotient * factor, left)) << choice;
          left = quotient;
        }
        EXPECT_LE(exact_stage::inner_polynomial(left).size(), 4U * 2U + 1U) << choice;
      }
    }
  }
}

TEST(CurvedPolygon, OnLinesIsTheQuery) {
  Random random(102);
  Query lines{};
  for (double& x : lines.coordinates) x = random.uniform(-1, 1);
  CurvedQuery query = to_curved(lines);
  query[2].weights = {3.0, 3.0};
  EXPECT_EQ(exact_stage::on_lines(query), lines);
  query[3].control.pop_back();
  lines.point(1, 3) = lines.point(0, 3);
  EXPECT_EQ(exact_stage::on_lines(query), lines);
  query[2].weights[1] = 4.0;
  EXPECT_FALSE(exact_stage::on_lines(query).has_value());
}

}  // namespace
}  // namespace touchstone::fast::curved_parts_test
