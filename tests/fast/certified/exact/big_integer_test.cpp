#include "fast/certified/exact/big_integer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::exact_stage::big_integer_test {
namespace {

using exact::Integer;
using tests::Random;

BigInteger big(const Integer& value) {
  BigInteger result;
  Integer rest = abs(value);
  for (long shift = 0; rest != 0; shift += 30) {
    const Integer digit = rest % 1073741824;
    result += BigInteger(digit.get_si()) << shift;
    rest /= 1073741824;
  }
  return value < 0 ? -result : result;
}

/// An integer of any size from zero to beyond the inline limbs; often with long runs of equal bits.
Integer draw(Random& random) {
  const auto bits = static_cast<unsigned>(random.between(0, 1500));
  if (random.coin()) return random.integer<Integer>(bits);
  return (Integer(1) << bits) - random.between(-2, 2);
}

TEST(BigInteger, AddsSubtractsAndMultipliesAsGmpDoes) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Integer a = draw(random), b = draw(random);
    EXPECT_TRUE(big(a) + big(b) == big(a + b)) << a << ' ' << b;
    EXPECT_TRUE(big(a) - big(b) == big(a - b)) << a << ' ' << b;
    EXPECT_TRUE(big(a) * big(b) == big(a * b)) << a << ' ' << b;
    EXPECT_EQ((big(a) - big(b)).sign(), sgn(a - b));
  }
}

TEST(BigInteger, ShiftsAndMeasuresBits) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Integer a = draw(random);
    const int shift = random.between(0, 200);
    const BigInteger shifted = big(a) << shift;
    EXPECT_TRUE(shifted == big(a << static_cast<unsigned>(shift)));
    EXPECT_TRUE(shifted >> shift == big(a));
    EXPECT_TRUE(big(a) >> 8 * shift == big(a / (Integer(1) << static_cast<unsigned>(8 * shift))));
    if (a == 0) continue;
    EXPECT_EQ(big(a).bit_length(), static_cast<long>(mpz_sizeinbase(a.get_mpz_t(), 2)));
    EXPECT_EQ(big(a).trailing_zeros(), static_cast<long>(mpz_scan1(a.get_mpz_t(), 0)));
  }
  EXPECT_EQ(BigInteger().bit_length(), 0);
}

TEST(BigInteger, TakesItselfAsOperand) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Integer value = draw(random);
    BigInteger sum = big(value), difference = big(value);
    const BigInteger &alias = sum, &other_alias = difference;
    sum += alias;
    difference -= other_alias;
    EXPECT_TRUE(sum == big(2 * value));
    EXPECT_EQ(difference.sign(), 0);
  }
}

TEST(BigInteger, HoldsTheExtremesOfItsConstructor) {
  EXPECT_TRUE(BigInteger(INT64_MIN) == big(-(Integer(1) << 63U)));
  EXPECT_TRUE(BigInteger(INT64_MAX) == big((Integer(1) << 63U) - 1));
  EXPECT_EQ(BigInteger(0).sign(), 0);
  EXPECT_EQ((-BigInteger(0)).sign(), 0);
}

TEST(BigInteger, DividesMultiplesExactly) {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Integer a = draw(random), b = draw(random);
    if (b == 0) continue;
    EXPECT_TRUE(big(a * b).divided_exactly(big(b)) == big(a)) << a << ' ' << b;
  }
}

TEST(BigInteger, ApproximatesQuotients) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Integer a = draw(random), b = draw(random);
    if (abs(a) > abs(b)) std::swap(a, b);
    if (b == 0) continue;
    const int bits = random.between(0, 3000);
    const BigInteger scaled = big(a) << bits, divisor = big(b), most = big(2 * b);
    const BigInteger error = approximate_quotient(big(a), divisor, bits) * divisor - scaled;
    EXPECT_TRUE((error - most).sign() * (error + most).sign() < 0) << a << ' ' << b;
  }
  EXPECT_EQ(approximate_quotient(5, 0, 10).sign(), 0);
}

TEST(BigInteger, TakesResiduesAndDropsFractions) {
  Random random(6);
  constexpr std::uint64_t modulus = (std::uint64_t{1} << 61U) - 1;
  for (int i = 0; i < 2000; ++i) {
    const Integer a = draw(random);
    const Integer rest = ((a % Integer(modulus)) + Integer(modulus)) % Integer(modulus);
    EXPECT_EQ(big(a).residue(modulus), rest.get_ui()) << a;
    const long shift = random.between(-80, 62) - big(a).bit_length();
    if (shift + big(a).bit_length() > 62) continue;
    const Integer cut = shift >= 0 ? Integer(a << static_cast<unsigned>(shift))
                                   : Integer(a / (Integer(1) << static_cast<unsigned>(-shift)));
    EXPECT_EQ(big(a).truncated(shift), cut.get_si()) << a << ' ' << shift;
  }
}

TEST(BigInteger, ApproximatesWithin52Bits) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const Integer a = draw(random);
    const Approximation near = big(a).approximation();
    if (a == 0) {
      EXPECT_EQ(near.significand, 0.0);
      continue;
    }
    const exact::Rational value =
        exact::Rational(near.significand) * exact::power_of_two(near.exponent);
    EXPECT_LE(abs(value - a), abs(exact::Rational(a)) * exact::power_of_two(-52));
    EXPECT_GE(std::abs(near.significand), 0.5);
    EXPECT_LE(std::abs(near.significand), 1.0);
  }
}

TEST(BigInteger, DividesApproximationsBeyondTheRangeOfDoubles) {
  EXPECT_EQ(quotient({0.5, 9000}, {0.5, 9001}), 0.5);
  EXPECT_EQ(quotient({0.75, -9000}, {0.5, 0}), 0.0);
  EXPECT_EQ(quotient({0.75, 9000}, {-0.5, 0}), -std::numeric_limits<double>::max());
  EXPECT_EQ(quotient({0.75, 3}, {0.0, 0}), 0.0);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::big_integer_test
