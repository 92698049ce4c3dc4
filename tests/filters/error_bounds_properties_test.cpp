#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "filters/error_bounds.hpp"
#include "filters/expressions.hpp"
#include "tests/support/properties.hpp"

// A filter is right if what it calls certain is true. Coordinates are any doubles that the bound
// admits: subnormals, the greatest, and those that RapidCheck finds simple.

namespace touchstone::filters::error_bounds_properties_test {
namespace {

using tests::expect_property;

int sign(double x) { return static_cast<int>(x > 0.0) - static_cast<int>(x < 0.0); }

/// Bits as a coordinate: any finite double, brought into range by its exponent; or a small integer.
double coordinate(std::uint64_t bits, double greatest) {
  const auto integer = static_cast<std::int64_t>(bits / 8 % 256) - 128;
  if (bits % 8 == 0) return static_cast<double>(integer);
  double x = std::bit_cast<double>(bits);
  if (!std::isfinite(x)) x = std::copysign(0x1p1000, x);
  return std::clamp(x, -greatest, greatest);
}

/// Coordinates of one magnitude, so that they cancel: 53 bits each at the given exponent.
double near_coordinate(std::uint64_t bits, int exponent) {
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(bits >> 10U)) - 0x1p53, exponent);
}

/// A parameter in [0,1] and what is left to 1, both exact.
std::array<double, 2> parameter(std::uint32_t bits) {
  const double x = std::min(1.0, std::ldexp(static_cast<double>(bits), -31));
  return {1.0 - x, x};
}

std::array<double, 6> edge_weights(std::uint32_t t, std::uint32_t u, std::uint32_t v) {
  const auto [s, t1] = parameter(t);
  const auto [u0, u1] = parameter(u);
  const auto [v0, v1] = parameter(v);
  return {s, t1, u0, u1, v0, v1};
}

/// u and v are halved where their sum is beyond 1.
std::array<double, 5> face_weights(std::uint32_t t, std::uint32_t u, std::uint32_t v) {
  const auto [s, t1] = parameter(t);
  double x = parameter(u)[1], y = parameter(v)[1];
  if (x + y > 1.0) {
    x /= 2.0;
    y /= 2.0;
  }
  return {s, t1, 1.0 - x - y, x, y};
}

template <std::size_t count>
std::array<mpq_class, count> rational(const std::array<double, count>& numbers) {
  std::array<mpq_class, count> result;
  for (std::size_t i = 0; i < count; ++i) result[i] = mpq_class(numbers[i]);
  return result;
}

/// The computed value is within the bound of the truth, and beyond the bound it has the true sign.
template <class Expression>
void check(const ErrorBound<double, 1>& bound,
           const std::array<double, Expression::coordinates>& coordinates,
           const std::array<double, Expression::weights>& weights) {
  double x_max = 0.0;
  for (const double x : coordinates) x_max = std::max(x_max, std::abs(x));
  RC_PRE(x_max <= bound.greatest_x);
  const double computed = Expression::evaluate(coordinates, weights);
  const mpq_class truth = Expression::evaluate(rational(coordinates), rational(weights));
  RC_ASSERT(std::isfinite(computed));
  RC_ASSERT(abs(mpq_class(mpq_class(computed) - truth)) <= mpq_class(bound(x_max)));
  if (std::abs(computed) > bound(x_max)) RC_ASSERT(sign(computed) == sgn(truth));
}

using Bits = std::array<std::uint64_t, 8>;

std::array<double, 8> any_coordinates(const Bits& bits, double greatest) {
  std::array<double, 8> result{};
  for (std::size_t i = 0; i < 8; ++i) result.at(i) = coordinate(bits.at(i), greatest);
  return result;
}

std::array<double, 8> near_coordinates(const Bits& bits, int exponent) {
  std::array<double, 8> result{};
  for (std::size_t i = 0; i < 8; ++i) result.at(i) = near_coordinate(bits.at(i), exponent);
  return result;
}

TEST(ErrorBoundsProperties, SignsOfEdgesAreNeverWrong) {
  expect_property(1, 1500, [](const Bits& bits, std::uint32_t t, std::uint32_t u, std::uint32_t v) {
    check<EdgeEdge>(edge_edge_double, any_coordinates(bits, edge_edge_double.greatest_x),
                    edge_weights(t, u, v));
  });
}

TEST(ErrorBoundsProperties, SignsOfFacesAreNeverWrong) {
  expect_property(2, 1500, [](const Bits& bits, std::uint32_t t, std::uint32_t u, std::uint32_t v) {
    check<VertexFace>(vertex_face_double, any_coordinates(bits, vertex_face_double.greatest_x),
                      face_weights(t, u, v));
  });
}

/// From subnormals (exponent −1074 and up) to the greatest that the bound admits.
TEST(ErrorBoundsProperties, SignsAreNeverWrongWhereCoordinatesCancel) {
  expect_property(
      3, 1500,
      [](const Bits& bits, std::uint16_t where, std::uint32_t t, std::uint32_t u, std::uint32_t v) {
        const int exponent = -1074 + where % (1074 + 966);
        check<EdgeEdge>(edge_edge_double, near_coordinates(bits, exponent), edge_weights(t, u, v));
        check<VertexFace>(vertex_face_double, near_coordinates(bits, exponent),
                          face_weights(t, u, v));
      });
}

/// A power of two changes nothing but the exponent, where nothing is subnormal.
TEST(ErrorBoundsProperties, ComputedValuesScaleWithTheCoordinates) {
  expect_property(4, 1000,
                  [](const Bits& bits, std::int8_t exponent, std::uint32_t t, std::uint32_t u,
                     std::uint32_t v) {
                    const std::array<double, 8> one = near_coordinates(bits, -53);
                    const std::array<double, 8> other = near_coordinates(bits, -53 + exponent);
                    const auto weights = edge_weights(t, u, v);
                    RC_ASSERT(EdgeEdge::evaluate(other, weights) ==
                              std::ldexp(EdgeEdge::evaluate(one, weights), exponent));
                  });
}

}  // namespace
}  // namespace touchstone::filters::error_bounds_properties_test
