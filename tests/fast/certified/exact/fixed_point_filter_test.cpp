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
std::vector<Rational> exact_coefficients(const std::vector<Rational>& b, const Rational& lower,
                                         const Rational& upper) {
  const std::size_t degree = b.size() - 1;
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

/// A form, and Bernstein's coefficients of it. The greatest of them is in [2^59, 2^60), so that the
/// units are 1; they are whole numbers or, if the form's are, fractions.
struct RandomForm {
  std::vector<BigInteger> c;
  std::vector<Rational> b;
};

RandomForm random_form(Random& random, std::size_t degree) {
  RandomForm result;
  const bool is_whole = random.coin();
  std::int64_t binomial = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    std::int64_t x = random.integer<std::int64_t>(is_whole ? 59 : 60);
    if (k == 0) x = std::abs(x) | (std::int64_t{1} << 59U);
    result.c.emplace_back(is_whole ? BigInteger(x) * BigInteger(binomial) : BigInteger(x));
    result.b.push_back(is_whole ? Rational(x) : Rational(x) / Rational(binomial));
    const auto left = static_cast<std::int64_t>(degree - k);
    const exact::Integer next = exact::Integer(binomial) * left / static_cast<std::int64_t>(k + 1);
    binomial = next.get_si();
  }
  return result;
}

TEST(FixedPointForm, IsWithinItsBound) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const std::size_t degree = i % 1500 == 0 ? FixedPointForm::largest_degree
                                             : static_cast<std::size_t>(random.between(0, 24));
    const RandomForm form = random_form(random, degree);
    std::int64_t lower = std::abs(random.integer<std::int64_t>(60));
    std::int64_t upper = random.coin() ? one : std::abs(random.integer<std::int64_t>(60));
    if (lower > upper) std::swap(lower, upper);
    if (random.between(0, 4) == 0) lower = 0;
    if (random.between(0, 4) == 0) upper = lower;
    const FixedPointForm rough(form.c, lower, upper);
    // True times may be up to a unit later.
    const Rational late = random.coin() ? Rational(0) : Rational(9, 10);
    const auto time = [&](std::int64_t t) {
      return std::min(Rational(1), Rational((Rational(t) + late) / Rational(one)));
    };
    const auto expected = exact_coefficients(form.b, time(lower), time(upper));
    for (std::size_t k = 0; k <= degree; ++k) {
      EXPECT_LE(abs(Rational(rough.coefficients()[k]) - expected[k]), 2 + 6 * degree);
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
