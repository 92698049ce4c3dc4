#include "fast/certified/exact/enclosing_doubles.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::fast::exact_stage::enclosing_doubles_test {
namespace {

using tests::Random;

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

/// Finds a number α given by the smallest double that is not below it.
BitInterval found(std::uint64_t ceiling, double guess, std::uint64_t step, int& questions) {
  return enclose(guess, step, [&](std::uint64_t bits) {
    ++questions;
    return bits < ceiling;
  });
}

TEST(DoubleSearch, EnclosesWhateverTheGuess) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t ceiling = i == 0   ? 1
                                  : i == 1 ? bits_of_one
                                           : 1 + random.bits() % bits_of_one;
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

TEST(BinaryFraction, IsTheDouble) {
  Random random(2);
  using Limits = std::numeric_limits<double>;
  std::vector<double> numbers{0.0, -0.0, 1.0, -12.0, Limits::denorm_min(), -Limits::max()};
  while (numbers.size() < 10000) numbers.push_back(random.finite_double());
  for (const double x : numbers) {
    const auto [numerator, exponent] = binary_fraction(x);
    EXPECT_EQ(std::ldexp(static_cast<double>(numerator), exponent), x);
    EXPECT_LT(std::abs(numerator), std::int64_t{1} << 53);
    EXPECT_GE(exponent, -1074);
    const BinaryFraction odd = odd_fraction(x);
    EXPECT_EQ(std::ldexp(static_cast<double>(odd.numerator), odd.exponent), x);
    EXPECT_EQ(std::abs(odd.numerator % 2), x == 0.0 ? 0 : 1);
  }
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::enclosing_doubles_test
