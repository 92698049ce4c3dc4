/// \file
/// The zeros of polynomials.

#include "verify/baselines/rpoly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::baselines::rpoly_test {
namespace {

using Complex = std::complex<double>;
using tests::Random;

/// The coefficients of c Π (x − z), from the highest power down. \pre conjugates come in pairs.
std::vector<double> with_zeros(const std::vector<Complex>& zeros, double c = 1.0) {
  std::vector<Complex> product{c};
  for (const Complex& zero : zeros) {
    product.emplace_back(0.0);
    for (std::size_t i = product.size() - 1; i > 0; --i) product[i] -= zero * product[i - 1];
  }
  std::vector<double> result(product.size());
  std::ranges::transform(product, result.begin(), [](const Complex& x) { return x.real(); });
  return result;
}

/// The greatest distance of an expected zero from the nearest remaining zero found.
double worst_distance(const std::vector<Complex>& expected, const Zeros& found) {
  std::vector<Complex> left;
  for (const Zero& zero : found) left.emplace_back(zero.re, zero.im);
  if (left.size() != expected.size()) return 1e300;
  double worst = 0.0;
  for (const Complex& zero : expected) {
    const auto nearest = std::ranges::min_element(
        left, {}, [&](const Complex& other) { return std::abs(other - zero); });
    worst = std::max(worst, std::abs(*nearest - zero));
    left.erase(nearest);
  }
  return worst;
}

TEST(Rpoly, FindsRandomZeros) {
  Random random(3);
  for (int i = 0; i < 3000; ++i) {
    std::vector<Complex> zeros;
    const auto degree = static_cast<std::size_t>(random.between(1, 6));
    while (zeros.size() < degree) {
      const Complex z(random.uniform(-2.0, 2.0), random.uniform(0.1, 2.0));
      if (degree - zeros.size() >= 2 && random.coin()) {
        zeros.push_back(z);
        zeros.push_back(std::conj(z));
      } else {
        zeros.emplace_back(z.real());
      }
    }
    double separation = 1.0;
    for (std::size_t a = 0; a < zeros.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        separation = std::min(separation, std::abs(zeros[a] - zeros[b]));
      }
    }
    if (separation < 0.2) continue;
    const double scale = std::ldexp(1.0, random.between(-40, 40));
    EXPECT_LT(worst_distance(zeros, zeros_of(with_zeros(zeros, scale))), 1e-9);
  }
}

TEST(Rpoly, HasNoZerosToGiveForNoPolynomial) {
  EXPECT_EQ(zeros_of(std::vector{0.0, 1.0, 2.0}).count, 0U);
  EXPECT_EQ(zeros_of(std::vector{5.0}).count, 0U);
  EXPECT_THROW((void)zeros_of({}), std::invalid_argument);
  EXPECT_THROW((void)zeros_of(std::vector<double>(10, 1.0)), std::invalid_argument);
}

TEST(Rpoly, EndsOnCoefficientsOfAllMagnitudes) {
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    std::array<double, 7> coefficients{};
    std::ranges::generate(coefficients, [&] { return random.finite_double(); });
    EXPECT_LE(zeros_of(coefficients).count, 6U);
  }
}

}  // namespace
}  // namespace touchstone::baselines::rpoly_test
