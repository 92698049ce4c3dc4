#include "fast/certified/exact/enclosing_doubles.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/support/random.hpp"

namespace touchstone::fast::exact_stage::enclosing_doubles_test {
namespace {

using tests::Random;

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

/// A number α given by the smallest double that is not below it.
BitInterval found(std::uint64_t ceiling, double guess, std::uint64_t step, int& questions) {
  return enclose(guess, step, [&](std::uint64_t bits) {
    ++questions;
    return bits < ceiling;
  });
}

TEST(DoubleSearch, EnclosesWhateverTheGuess) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t ceiling = 1 + random.bits() % bits_of_one;
    const double guess =
        random.coin() ? random.finite_double() : std::bit_cast<double>(random.bits() % bits_of_one);
    const std::uint64_t step = std::uint64_t{1} << (random.bits() % 40U);
    int questions = 0;
    const BitInterval cell = found(ceiling, guess, step, questions);
    EXPECT_LT(cell.lower, ceiling);
    EXPECT_LE(ceiling, cell.upper);
    EXPECT_LE(cell.upper - cell.lower, step);
    EXPECT_LE(cell.upper, bits_of_one);
    EXPECT_LE(questions, 130);
  }
}

TEST(DoubleSearch, EnclosesTheEnds) {
  int questions = 0;
  const BitInterval first = found(1, 1.0, 1, questions);
  EXPECT_EQ(first.lower, bits_of_zero);
  EXPECT_EQ(first.upper, 1U);
  const BitInterval last = found(bits_of_one, 0.0, 1, questions);
  EXPECT_EQ(last.lower, bits_of_one - 1);
  EXPECT_EQ(last.upper, bits_of_one);
}

TEST(DoubleSearch, AsksLittleWhereTheGuessIsGood) {
  for (const double alpha : {0.5, 0.3, 1e-7, 1.0}) {
    int questions = 0;
    static_cast<void>(found(bits_of(alpha), alpha, 1, questions));
    EXPECT_LE(questions, 3);
    questions = 0;
    static_cast<void>(found(bits_of(alpha) - 3, alpha, 16, questions));
    EXPECT_LE(questions, 2);
  }
}

TEST(DoubleSearch, TakesAnyGuessIntoTheInterval) {
  EXPECT_EQ(unit_bits(0.25), bits_of(0.25));
  EXPECT_EQ(unit_bits(2.0), bits_of_one);
  EXPECT_EQ(unit_bits(std::numeric_limits<double>::infinity()), bits_of_one);
  EXPECT_EQ(unit_bits(-0.0), bits_of_zero);
  EXPECT_EQ(unit_bits(-1.0), bits_of_zero);
  EXPECT_EQ(unit_bits(std::numeric_limits<double>::quiet_NaN()), bits_of_zero);
}

TEST(DoubleSearch, TakesDoublesApart) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const auto x = std::bit_cast<double>(random.bits() % (bits_of_one + 1));
    const DyadicDouble value = dyadic(bits_of(x));
    EXPECT_EQ(std::ldexp(static_cast<double>(value.numerator), -value.exponent), x);
    EXPECT_EQ(value.numerator % 2, 1);
    EXPECT_GE(value.exponent, 0);
  }
  EXPECT_EQ(dyadic(bits_of_zero).numerator, 0);
  const DyadicDouble least = dyadic(1);
  EXPECT_EQ(least.numerator, 1);
  EXPECT_EQ(least.exponent, 1074);
  const DyadicDouble one = dyadic(bits_of_one);
  EXPECT_EQ(one.numerator, 1);
  EXPECT_EQ(one.exponent, 0);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::enclosing_doubles_test
