#include "touchstone/number.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/support/random.hpp"
#include "tests/support/rows.hpp"

namespace touchstone::exact::number_test {
namespace {

using tests::Random;
using Limits = std::numeric_limits<double>;

/// MPFR as an emulation of binary64, with its range and its subnormals.
class Binary64 {
 public:
  Binary64() : saved_least_(mpfr_get_emin()), saved_greatest_(mpfr_get_emax()) {
    // MPFR's significands are in [1/2, 1).
    mpfr_set_emin(-1073);
    mpfr_set_emax(1024);
    mpfr_init2(value_, Limits::digits);
  }
  Binary64(const Binary64&) = delete;
  Binary64& operator=(const Binary64&) = delete;
  Binary64(Binary64&&) = delete;
  Binary64& operator=(Binary64&&) = delete;
  ~Binary64() {
    mpfr_clear(value_);
    mpfr_set_emin(saved_least_);
    mpfr_set_emax(saved_greatest_);
  }

  double round(const Rational& x, mpfr_rnd_t mode) {
    const int inexact = mpfr_set_q(value_, x.get_mpq_t(), mode);
    mpfr_subnormalize(value_, inexact, mode);
    return mpfr_get_d(value_, MPFR_RNDN);
  }

 private:
  mpfr_t value_;
  mpfr_exp_t saved_least_, saved_greatest_;
};

/// Compares all three roundings of x with MPFR's, and no zero is negative.
void expect_roundings(Binary64& binary64, const Rational& x) {
  const auto expect = [&](double found, mpfr_rnd_t mode) {
    EXPECT_EQ(found, binary64.round(x, mode)) << x;
    EXPECT_FALSE(found == 0.0 && std::signbit(found)) << x;
  };
  expect(round_down(x), MPFR_RNDD);
  expect(round_up(x), MPFR_RNDU);
  expect(round_to_nearest(x), MPFR_RNDN);
}

Rational random_rational(Random& random, int least_exponent, int greatest_exponent) {
  const auto bits = [&] { return static_cast<unsigned>(random.between(1, 200)); };
  Rational x(random.integer<Integer>(bits()), abs(random.integer<Integer>(bits())) + 1);
  x.canonicalize();
  return x * power_of_two(random.between(least_exponent, greatest_exponent));
}

/// The rational halfway between two doubles.
Rational middle(double a, double b) { return (Rational(a) + Rational(b)) / 2; }

TEST(Rounding, AgreesWithMpfr) {
  Random random(11);
  Binary64 binary64;
  // The ends of the range, and ties.
  const Rational tiny = power_of_two(-5000), half = power_of_two(-1075), top(Limits::max()),
                 half_step = power_of_two(970), least = power_of_two(-9000);
  const double odd = std::nextafter(1.0, 2.0), below = std::nextafter(1.0, 0.0);
  for (const Rational& x : std::initializer_list<Rational>{
           0, tiny, half, half - tiny, half + tiny, 3 * half, 5 * half,
           middle(std::nextafter(Limits::min(), 0.0), Limits::min()), middle(below, 1.0),
           middle(1.0, odd), middle(odd, std::nextafter(odd, 2.0)), top + least,
           top + half_step - least, top + half_step, power_of_two(100000)}) {
    expect_roundings(binary64, x);
    expect_roundings(binary64, -x);
  }
  for (int round = 0; round < 2000; ++round) {
    // At all magnitudes, around the ends of the range, very near doubles, and half-way.
    expect_roundings(binary64, random_rational(random, -1300, 1200));
    expect_roundings(binary64, random_rational(random, -1100, -1000));
    expect_roundings(binary64, random_rational(random, 960, 1060));
    const double x = random.finite_double();
    const double y = std::nextafter(x, random.coin() ? Limits::max() : Limits::lowest());
    const Rational offset = power_of_two(-random.between(1, 3000)) * random.between(-1, 1);
    for (const Rational& near : {Rational(x), middle(x, y)}) {
      expect_roundings(binary64, near + offset);
      expect_roundings(binary64, near);
    }
  }
}

/// GMP's own reading of "numerator/denominator".
Rational fraction(const std::string& text) {
  Rational x(text, 10);
  x.canonicalize();
  return x;
}

TEST(RationalFromDecimal, HasTheValueWritten) {
  for (const std::string& row :
       tests::split("0 0|-0 0|-0.000e-7 0|7 7|+7 7|-7 -7|007 7|12. 12|.5 1/2|-.25 -1/4|0.1 1/10|"
                    "-1.25E-3 -1/800|1.25e+3 1250|+1.25e3 1250|5.e1 50|1e0 1|1e-0 1|1e007 10000000|"
                    "123.456e-2 123456/100000|100e-2 1|-3e00000000000000002 -300|"
                    "-3e-00000000000000002 -3/100",
                    "|")) {
    const auto words = tests::split(row, " ");
    EXPECT_EQ(rational_from_decimal(words.at(0)), fraction(words.at(1))) << row;
  }
  EXPECT_EQ(rational_from_decimal("2.500e-1").get_den(), 4);
  // It reads no further than the view.
  EXPECT_EQ(rational_from_decimal(std::string_view("12345e3").substr(1, 4)), 2345);
}

TEST(RationalFromDecimal, AgreesWithStrtodAfterRounding) {
  Random random(16);
  for (int round = 0; round < 2000; ++round) {
    std::string text = random.coin() ? "-" : "";
    const int before = random.between(0, 30), after = random.between(1, 60);
    for (int i = 0; i < before; ++i) text += static_cast<char>('0' + random.between(0, 9));
    text += '.';
    for (int i = 0; i < after; ++i) text += static_cast<char>('0' + random.between(0, 9));
    text += 'e' + std::to_string(random.between(-345, 320));
    EXPECT_EQ(round_to_nearest(rational_from_decimal(text)), std::strtod(text.c_str(), nullptr))
        << text;
  }
}

TEST(RationalFromDecimal, OtherTextsAreErrors) {
  for (const std::string& text : tests::split(
           "| |1 | 1|+|-|.|-.|e5|.e5|1e|1e+|1e-|--1|+-1|1.2.3|1,5|0x10|1/2|nan|NaN|inf|"
           "-inf|1e5.|1e5e5|1d5|1_0|1e 5|1 e5|1.5f|1\n|１|1e--5|1'0|$1|1e1e|0b1|- 1|1e10001|"
           "1e-10001|0e10001|1e999999999|1e9999999999|1e-99999999999999999999|"
           "1e18446744073709551617",
           "|")) {
    EXPECT_THROW(static_cast<void>(rational_from_decimal(text)), std::invalid_argument) << text;
  }
  using namespace std::string_view_literals;
  EXPECT_THROW(static_cast<void>(rational_from_decimal("1\0"sv)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(rational_from_decimal("1\0002"sv)), std::invalid_argument);
}

TEST(RationalFromDecimal, HasAnyNumberOfDigitsAndExponentsToTenThousand) {
  Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, 10000);
  EXPECT_EQ(rational_from_decimal("1e10000"), Rational(power));
  EXPECT_EQ(rational_from_decimal("1e-10000"), Rational(Integer(1), power));
  const std::string nines(20000, '9');
  const Rational x = rational_from_decimal("0." + nines);
  mpz_ui_pow_ui(power.get_mpz_t(), 10, 20000);
  EXPECT_EQ(x, Rational(Integer(power - 1), power));
  EXPECT_EQ(rational_from_decimal(nines + "." + nines), Rational(power - 1) + x);
}

}  // namespace
}  // namespace touchstone::exact::number_test
