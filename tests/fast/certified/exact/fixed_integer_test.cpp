#include "fast/certified/exact/fixed_integer.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <cstdint>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::exact_stage::fixed_integer_test {
namespace {

using exact::Integer;
using tests::Random;

/// The low bits of a value that fits, assembled from small parts.
template <std::size_t size>
FixedInteger<size> fixed(const Integer& value) {
  FixedInteger<size> result{}, power(std::int64_t{1});
  Integer rest = abs(value);
  for (std::size_t bit = 0; bit + 1 < 64 * size; ++bit) {
    if (mpz_tstbit(rest.get_mpz_t(), bit) != 0) result += power;
    power += power;
  }
  return value < 0 ? -result : result;
}

template <std::size_t size>
Integer draw(Random& random, unsigned spare_bits) {
  const auto most = static_cast<int>(64 * size - 1 - spare_bits);
  const auto bits = static_cast<unsigned>(random.between(0, most));
  if (random.coin()) return random.integer<Integer>(bits);
  const Integer edge = (Integer(1) << bits) - 1;
  return random.coin() ? edge : -edge;
}

template <std::size_t a_size, std::size_t b_size>
void expect_products(Random& random) {
  for (int i = 0; i < 500; ++i) {
    const Integer a = draw<a_size>(random, 0), b = draw<b_size>(random, 0);
    EXPECT_TRUE(fixed<a_size>(a) * fixed<b_size>(b) == (fixed<a_size + b_size>(a * b)))
        << a << ' ' << b;
  }
}

template <std::size_t size>
void expect_sums(Random& random) {
  for (int i = 0; i < 500; ++i) {
    const Integer a = draw<size>(random, 1), b = draw<size>(random, 1);
    EXPECT_TRUE(fixed<size>(a) + fixed<size>(b) == fixed<size>(a + b)) << a << ' ' << b;
    EXPECT_TRUE(fixed<size>(a) - fixed<size>(b) == fixed<size>(a - b)) << a << ' ' << b;
    EXPECT_EQ((fixed<size>(a) - fixed<size>(b)).sign(), sgn(a - b)) << a << ' ' << b;
  }
}

TEST(FixedInteger, MultipliesAsGmpDoes) {
  Random random(1);
  expect_products<1, 1>(random);
  expect_products<2, 1>(random);
  expect_products<1, 2>(random);
  expect_products<2, 2>(random);
  expect_products<3, 2>(random);
  expect_products<7, 7>(random);
}

TEST(FixedInteger, AddsAndSubtractsAsGmpDoes) {
  Random random(2);
  expect_sums<1>(random);
  expect_sums<2>(random);
  expect_sums<6>(random);
}

TEST(FixedInteger, BlendsWithWeights) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Integer a = draw<3>(random, 0), b = draw<3>(random, 0);
    const auto x = static_cast<std::int64_t>(random.bits() >> 2U);
    const std::int64_t y = random.coin() ? (std::int64_t{1} << 62U) - 1 - x / 2 : 0;
    const Integer expected = a * Integer(x) + b * Integer(y);
    EXPECT_TRUE(blend(fixed<3>(a), x, fixed<3>(b), y) == fixed<4>(expected));
  }
}

TEST(FixedInteger, HoldsTheExtremesOfItsConstructors) {
  EXPECT_TRUE(FixedInteger<2>(std::int64_t{INT64_MIN}) == fixed<2>(-(Integer(1) << 63U)));
  const SignedWideLimb wide = -(SignedWideLimb{1} << 126U);
  EXPECT_TRUE(FixedInteger<2>(wide) == fixed<2>(-(Integer(1) << 126U)));
  EXPECT_TRUE(FixedInteger<3>(wide) == fixed<3>(-(Integer(1) << 126U)));
  EXPECT_EQ(FixedInteger<2>().sign(), 0);
}

TEST(FixedInteger, MultipliesTwoLimbsAtTheirExtremes) {
  const Integer least = 1 - (Integer(1) << 127U);
  for (const Integer& a : {least, Integer(-least), Integer(-1), Integer(1)}) {
    for (const Integer& b : {least, Integer(-least), Integer(-1)}) {
      EXPECT_TRUE(fixed<2>(a) * fixed<2>(b) == fixed<4>(a * b)) << a << ' ' << b;
    }
  }
}

TEST(FixedInteger, MultipliesByALimbAtItsExtremes) {
  const Integer most = (Integer(1) << 191U) - 1, low = (Integer(1) << 128U) - 1;
  for (const std::int64_t factor : {INT64_MIN, INT64_MIN + 1, std::int64_t{-1}, INT64_MAX}) {
    for (const Integer& b : {most, Integer(-most), low, Integer(-low), Integer(0)}) {
      const Integer expected = b * Integer(static_cast<long>(factor));
      EXPECT_TRUE(FixedInteger<1>(factor) * fixed<3>(b) == fixed<4>(expected))
          << factor << ' ' << b;
      EXPECT_TRUE(fixed<3>(b) * FixedInteger<1>(factor) == fixed<4>(expected))
          << factor << ' ' << b;
    }
  }
  EXPECT_TRUE(FixedInteger<1>(INT64_MIN) * FixedInteger<1>(INT64_MIN) ==
              fixed<2>(Integer(1) << 126U));
}

TEST(FixedInteger, RoundsWithin50BitsInEveryMode) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Integer a = draw<6>(random, 0);
    for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      const double rounded = fixed<6>(a).rounded();
      std::fesetround(FE_TONEAREST);
      const exact::Rational error = exact::Rational(rounded) - a;
      EXPECT_LE(abs(error), abs(exact::Rational(a)) * exact::power_of_two(-50)) << a;
    }
  }
  EXPECT_EQ(FixedInteger<3>(std::int64_t{-5}).rounded(), -5.0);
  EXPECT_EQ(FixedInteger<3>(std::int64_t{0}).rounded(), 0.0);
  EXPECT_EQ(FixedInteger<1>(std::int64_t{INT64_MIN}).rounded(), -0x1p63);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::fixed_integer_test
