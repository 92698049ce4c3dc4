#include "fast/certified/exact/fixed_point_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/number.hpp"

namespace touchstone::fast::exact_stage::fixed_point_filter_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr std::int64_t one = std::int64_t{1} << FixedPointForm::fraction_bits;

/// Bernstein's coefficients on [lower, upper] by de Casteljau's steps without rounding.
std::vector<Rational> exact_coefficients(const std::vector<std::int64_t>& c, const Rational& lower,
                                         const Rational& upper) {
  std::vector<Rational> b;
  Rational binomial = 1;
  const std::size_t degree = c.size() - 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    b.emplace_back(Rational(c[k]) / binomial);
    binomial *= Rational(static_cast<long>(degree - k), static_cast<long>(k + 1));
  }
  std::vector<Rational> result;
  for (std::size_t k = 0; k <= degree; ++k) {
    std::vector<Rational> x = b;
    for (std::size_t left = degree; left > 0; --left) {
      const Rational& t = left > k ? lower : upper;
      for (std::size_t i = 0; i < left; ++i) x[i] = (1 - t) * x[i] + t * x[i + 1];
    }
    result.push_back(x[0]);
  }
  return result;
}

TEST(FixedPointForm, IsWithinItsBound) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const auto degree = static_cast<std::size_t>(random.between(0, 24));
    std::vector<std::int64_t> c(degree + 1);
    for (auto& x : c) x = random.integer<std::int64_t>(60);
    c[0] = std::abs(c[0]) | (std::int64_t{1} << 59U);  // so that the units are 1
    const std::vector<BigInteger> form(c.begin(), c.end());
    std::int64_t lower = std::abs(random.integer<std::int64_t>(60));
    std::int64_t upper = random.coin() ? one : std::abs(random.integer<std::int64_t>(60));
    if (lower > upper) std::swap(lower, upper);
    const FixedPointForm rough(form, lower, upper);
    // True times may be up to a unit later.
    const Rational late = random.coin() ? Rational(0) : Rational(9, 10);
    const auto time = [&](std::int64_t t) {
      return std::min(Rational(1), Rational((Rational(t) + late) / Rational(one)));
    };
    const auto expected = exact_coefficients(c, time(lower), time(upper));
    for (std::size_t k = 0; k <= degree; ++k) {
      EXPECT_LE(abs(Rational(rough.coefficients()[k]) - expected[k]), 2 + 3 * degree);
    }
  }
}

TEST(FixedPointForm, TakesNumbersOfAnySize) {
  const BigInteger large = BigInteger(1) << 3000;
  const std::vector<BigInteger> form{large, BigInteger(0) - large - large - large};
  EXPECT_EQ(FixedPointForm(form, 0, one).signs()->changes, 1);
  EXPECT_EQ(FixedPointForm(form, 0, one / 5).signs()->changes, 0);
  EXPECT_EQ(FixedPointForm(form, one / 5, one / 5).first_sign(), 1);
  EXPECT_EQ(FixedPointForm(form, one / 3, one / 3).first_sign(), -1);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::fixed_point_filter_test
