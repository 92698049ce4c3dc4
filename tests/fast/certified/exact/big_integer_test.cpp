/// \file
/// The integers of the exact stage, of any size and of a fixed one, and forms of them in floating
/// and fixed point, against GMP's.

#include "fast/certified/exact/big_integer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fast/certified/exact/fixed_integer.hpp"
#include "fast/certified/exact/fixed_point_filter.hpp"
#include "fast/certified/exact/floating_point_filter.hpp"
#include "tests/support/polynomials.hpp"
#include "tests/support/random.hpp"
#include "touchstone/number.hpp"

namespace touchstone::fast::exact_stage::big_integer_test {
namespace {

using exact::Integer;
using exact::Rational;
using tests::Random;

constexpr std::array<int, 4> rounding_modes{FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

Integer power(unsigned bits) { return Integer(1) << bits; }

/// A number of 64 bits. (What GMP converts itself is `long`, which may have 32.)
template <class Whole>
Integer whole(Whole x) {
  return Integer(std::to_string(x));
}

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

/// The low bits of a value that fits, assembled from small parts.
template <std::size_t size>
FixedInteger<size> fixed(const Integer& value) {
  FixedInteger<size> result{}, part(std::int64_t{1});
  const Integer rest = abs(value);
  for (std::size_t bit = 0; bit + 1 < 64 * size; ++bit) {
    if (mpz_tstbit(rest.get_mpz_t(), static_cast<mp_bitcnt_t>(bit)) != 0) result += part;
    part += part;
  }
  return value < 0 ? -result : result;
}

/// An integer of any size up to so many bits (by default beyond the inline limbs); often with long
/// runs of equal bits.
Integer draw(Random& random, int most = 1500) {
  const auto bits =
      static_cast<unsigned>(random.between(0, 7) == 0 ? most : random.between(0, most));
  if (random.coin()) return random.integer<Integer>(bits);
  const Integer edge = power(bits) - 1;
  return random.coin() ? edge : -edge;
}

TEST(BigInteger, CalculatesAsGmpDoes) {
  Random random(1);
  constexpr std::uint64_t modulus = (std::uint64_t{1} << 61U) - 1;
  for (int i = 0; i < 3000; ++i) {
    const Integer a = draw(random), b = draw(random) + random.between(-1, 3);
    EXPECT_TRUE(big(a) + big(b) == big(a + b)) << a << ' ' << b;
    EXPECT_TRUE(big(a) - big(b) == big(a - b)) << a << ' ' << b;
    EXPECT_TRUE(big(a) * big(b) == big(a * b)) << a << ' ' << b;
    EXPECT_EQ((big(a) - big(b)).sign(), sgn(a - b));
    const Integer c = draw(random) * draw(random);
    EXPECT_TRUE(big(c).add_product(big(a), big(b)) == big(c + a * b)) << a << ' ' << b << ' ' << c;
    EXPECT_TRUE(big(c).subtract_product(big(a), big(b)) == big(c - a * b)) << a << ' ' << b;
    EXPECT_EQ(big(a * b).subtract_product(big(a), big(b)).sign(), 0);
    BigInteger sum = big(a), difference = big(a);
    const BigInteger &alias = sum, &other_alias = difference;
    sum += alias;
    difference -= other_alias;
    EXPECT_TRUE(sum == big(2 * a));
    EXPECT_EQ(difference.sign(), 0);
    const int shift = random.between(0, 200);
    const BigInteger shifted = big(a) << shift;
    EXPECT_TRUE(shifted == big(a << static_cast<unsigned>(shift)));
    EXPECT_TRUE(shifted >> shift == big(a));
    EXPECT_TRUE(big(a) >> 8 * shift == big(a / power(static_cast<unsigned>(8 * shift))));
    const Integer rest = ((a % whole(modulus)) + whole(modulus)) % whole(modulus);
    EXPECT_EQ(whole(big(a).residue(modulus)), rest) << a;
    if (b != 0) {
      EXPECT_TRUE(big(a * b).divided_exactly(big(b)) == big(a)) << a << ' ' << b;
    }
    if (a == 0) continue;
    EXPECT_EQ(big(a).bit_length(), static_cast<long>(mpz_sizeinbase(a.get_mpz_t(), 2)));
    EXPECT_EQ(big(a).trailing_zeros(), static_cast<long>(mpz_scan1(a.get_mpz_t(), 0)));
  }
  EXPECT_EQ(BigInteger().bit_length(), 0);
  EXPECT_TRUE(BigInteger(INT64_MIN) == big(-power(63)));
  EXPECT_TRUE(BigInteger(INT64_MAX) == big(power(63) - 1));
  EXPECT_EQ((-BigInteger(0)).sign(), 0);
}

TEST(BigInteger, ApproximatesWithinItsBounds) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Integer a = draw(random), b = draw(random);
    if (abs(a) > abs(b)) std::swap(a, b);
    if (b == 0) continue;
    const int bits = random.between(0, 3000);
    const BigInteger scaled = big(a) << bits, divisor = big(b), most = big(2 * b);
    const BigInteger error = approximate_quotient(big(a), divisor, bits) * divisor - scaled;
    EXPECT_TRUE((error - most).sign() * (error + most).sign() < 0) << a << ' ' << b;
    const Approximation near = big(b).approximation();
    const Rational value = Rational(near.significand) * exact::power_of_two(near.exponent);
    EXPECT_LE(abs(value - b), abs(Rational(b)) * exact::power_of_two(-52));
    EXPECT_GE(std::abs(near.significand), 0.5);
    EXPECT_LE(std::abs(near.significand), 1.0);
    const long shift = random.between(-80, 126) - big(a).bit_length();
    const Integer cut = shift >= 0 ? Integer(a << static_cast<unsigned>(shift))
                                   : Integer(a / power(static_cast<unsigned>(-shift)));
    const SignedWideLimb truncated = big(a).truncated(shift);
    const Integer upper = whole(static_cast<std::int64_t>(truncated >> 64U)) * power(64);
    EXPECT_EQ(Integer(upper + whole(static_cast<std::uint64_t>(truncated))), cut)
        << a << ' ' << shift;
  }
  EXPECT_EQ(approximate_quotient(5, 0, 10).sign(), 0);
  EXPECT_EQ(BigInteger(0).approximation().significand, 0.0);
}

TEST(BigInteger, DividesApproximationsBeyondTheRangeOfDoubles) {
  EXPECT_EQ(quotient({0.5, 9000}, {0.5, 9001}), 0.5);
  EXPECT_EQ(quotient({0.75, -9000}, {0.5, 0}), 0.0);
  EXPECT_EQ(quotient({0.75, 9000}, {-0.5, 0}), -std::numeric_limits<double>::max());
  EXPECT_EQ(quotient({0.75, 3}, {0.0, 0}), 0.0);
}

template <std::size_t a_size, std::size_t b_size>
void expect_products(Random& random) {
  constexpr int most_a = 64 * a_size - 1, most_b = 64 * b_size - 1;
  for (int i = 0; i < 500; ++i) {
    const Integer a = draw(random, most_a), b = draw(random, most_b);
    EXPECT_TRUE(fixed<a_size>(a) * fixed<b_size>(b) == (fixed<a_size + b_size>(a * b)))
        << a << ' ' << b;
    if constexpr (a_size == b_size) {
      const Integer c = a / 2, d = b / 2;
      EXPECT_TRUE(fixed<a_size>(c) + fixed<a_size>(d) == fixed<a_size>(c + d)) << c << ' ' << d;
      EXPECT_TRUE(fixed<a_size>(c) - fixed<a_size>(d) == fixed<a_size>(c - d)) << c << ' ' << d;
      EXPECT_EQ((fixed<a_size>(c) - fixed<a_size>(d)).sign(), sgn(c - d)) << c << ' ' << d;
    }
  }
}

TEST(FixedInteger, CalculatesAsGmpDoes) {
  Random random(1);
  expect_products<1, 1>(random);
  expect_products<2, 1>(random);
  expect_products<1, 2>(random);
  expect_products<2, 2>(random);
  expect_products<3, 2>(random);
  expect_products<7, 7>(random);
  for (int i = 0; i < 1000; ++i) {
    const Integer a = draw(random, 191), b = draw(random, 191);
    const auto x = static_cast<std::int64_t>(random.bits() >> 2U);
    const std::int64_t y = random.coin() ? (std::int64_t{1} << 62U) - 1 - x / 2 : 0;
    const Integer expected = a * whole(x) + b * whole(y);
    EXPECT_TRUE(blend(fixed<3>(a), x, fixed<3>(b), y) == fixed<4>(expected));
  }
}

TEST(FixedInteger, HoldsItsExtremes) {
  EXPECT_TRUE(FixedInteger<2>(std::int64_t{INT64_MIN}) == fixed<2>(-power(63)));
  const SignedWideLimb wide = -(SignedWideLimb{1} << 126U);
  EXPECT_TRUE(FixedInteger<2>(wide) == fixed<2>(-power(126)));
  EXPECT_TRUE(FixedInteger<3>(wide) == fixed<3>(-power(126)));
  EXPECT_EQ(FixedInteger<2>().sign(), 0);
  const Integer most = power(191) - 1, low = power(128) - 1;
  for (const std::int64_t factor : {INT64_MIN, INT64_MIN + 1, std::int64_t{-1}, INT64_MAX}) {
    for (const Integer& b : {most, Integer(-most), low, Integer(-low), Integer(0)}) {
      const Integer expected = b * whole(factor);
      EXPECT_TRUE(FixedInteger<1>(factor) * fixed<3>(b) == fixed<4>(expected)) << b;
      EXPECT_TRUE(fixed<3>(b) * FixedInteger<1>(factor) == fixed<4>(expected)) << b;
    }
  }
  EXPECT_TRUE(FixedInteger<1>(INT64_MIN) * FixedInteger<1>(INT64_MIN) == fixed<2>(power(126)));
}

TEST(FixedInteger, RoundsWithin50BitsInEveryMode) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Integer a = draw(random, 383);
    for (const int mode : rounding_modes) {
      std::fesetround(mode);
      const double rounded = fixed<6>(a).rounded();
      std::fesetround(FE_TONEAREST);
      EXPECT_LE(abs(Rational(rounded) - a), abs(Rational(a)) * exact::power_of_two(-50)) << a;
    }
  }
  EXPECT_EQ(FixedInteger<3>(std::int64_t{-5}).rounded(), -5.0);
  EXPECT_EQ(FixedInteger<3>(std::int64_t{0}).rounded(), 0.0);
  EXPECT_EQ(FixedInteger<1>(std::int64_t{INT64_MIN}).rounded(), -0x1p63);
}

// ---- Forms in floating point --------------------------------------------------------------------

using Time = BasicTime<std::int64_t>;

Time draw_time(Random& random) {
  const auto bits = static_cast<unsigned>(random.between(1, 61));
  const std::int64_t sum = std::int64_t{1} << bits;
  const std::int64_t y = std::abs(random.integer<std::int64_t>(bits)) % (sum + 1);
  return {sum - y, y};
}

/// The blossom of Σ c_k x^(n−k) y^k at these times, times n, by steps on integers.
Integer blossom_of(const std::vector<Integer>& c, const std::vector<Time>& times) {
  std::vector<Integer> b = c;
  if (b.size() > 2) {
    b.front() *= static_cast<long>(b.size() - 1);
    b.back() *= static_cast<long>(b.size() - 1);
  }
  for (const Time& t : times) {
    for (std::size_t i = 0; i + 1 < b.size(); ++i) {
      b[i] = b[i] * whole(t.x) + b[i + 1] * whole(t.y);
    }
    b.pop_back();
  }
  return b[0];
}

/// Coefficients of at most `bits` bits, which nearly vanish at the time in one case of two.
std::vector<std::int64_t> draw_form(Random& random, std::size_t degree, const Time& t) {
  std::vector<std::int64_t> c(degree + 1);
  if (random.coin()) {
    for (std::int64_t& x : c) x = random.integer<std::int64_t>(58);
    return c;
  }
  // (y₀ x − x₀ y) times a form of a lower degree, with small changes.
  const auto small = [](std::int64_t x) { return x >> 33U; };
  for (std::size_t i = 0; i < degree; ++i) {
    const auto factor = random.integer<std::int64_t>(24);
    c[i] += factor * small(t.y);
    c[i + 1] -= factor * small(t.x);
  }
  c[static_cast<std::size_t>(random.between(0, static_cast<int>(degree)))] += random.between(-1, 1);
  return c;
}

template <std::size_t count>
struct Drawn {
  explicit Drawn(Random& random) : at(draw_time(random)), other(draw_time(random)) {
    const auto c = draw_form(random, count - 1, at);
    for (std::size_t i = 0; i < count; ++i) {
      coefficients[i] = FixedInteger<2>(c[i]);
      integers.push_back(whole(c[i]));
    }
  }
  Time at, other;
  std::array<FixedInteger<2>, count> coefficients;
  std::vector<Integer> integers;
};

TEST(FilteredForm, SignsAreExactInEveryRoundingMode) {
  Random random(1);
  int zeros = 0;
  for (int i = 0; i < 4000; ++i) {
    std::fesetround(rounding_modes[static_cast<std::size_t>(i) % 4]);
    const Drawn<2> line(random);
    EXPECT_EQ(FilteredForm(line.coefficients).sign_at(line.at),
              sgn(blossom_of(line.integers, {line.at})));
    const Drawn<3> quadratic(random);
    const FilteredForm of_quadratic(quadratic.coefficients);
    const int sign = sgn(blossom_of(quadratic.integers, {quadratic.at, quadratic.at}));
    EXPECT_EQ(of_quadratic.sign_at(quadratic.at), sign);
    EXPECT_EQ(of_quadratic.sign(quadratic.at, quadratic.other),
              sgn(blossom_of(quadratic.integers, {quadratic.at, quadratic.other})));
    const Drawn<4> cubic(random);
    const FilteredForm of_cubic(cubic.coefficients);
    EXPECT_EQ(of_cubic.sign_at(cubic.at),
              sgn(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.at})));
    EXPECT_EQ(of_cubic.sign(cubic.at, cubic.at, cubic.other),
              sgn(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.other})));
    if (sign == 0) ++zeros;
  }
  std::fesetround(FE_TONEAREST);
  EXPECT_GT(zeros, 20);
}

TEST(FilteredForm, RoundedValuesAreWithinTheirBound) {
  Random random(2);
  int unsure = 0, near = 0;
  for (int i = 0; i < 4000; ++i) {
    const Drawn<4> cubic(random);
    std::fesetround(rounding_modes[static_cast<std::size_t>(i) % 4]);
    const RoundedBlossom rounded = FilteredForm(cubic.coefficients).rounded_value_at(cubic.at);
    std::fesetround(FE_TONEAREST);
    const Rational truth(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.at}));
    const Rational error = abs(Rational(rounded.value) - truth);
    EXPECT_LE(error, Rational(RoundedBlossom::rounding) * Rational(rounded.magnitude));
    if (rounded.sign() == 0) ++unsure;
    if (!rounded.is_near()) continue;
    ++near;
    EXPECT_LE(error, exact::power_of_two(-43) * abs(truth));
  }
  EXPECT_GT(unsure, 100);
  EXPECT_GT(near, 1000);
}

TEST(FilteredForm, TellsNothingOfWhatOverflows) {
  // 2^1000 − 2^1000 t and its negative, with weights up to 2^61.
  FixedInteger<16> large(std::int64_t{1});
  for (int i = 0; i < 1000; ++i) large += large;
  const Time middle{std::int64_t{1} << 60U, std::int64_t{1} << 60U};
  const FilteredForm<16, 2> line(std::array<FixedInteger<16>, 2>{large, -large});
  EXPECT_EQ(line.rounded_value_at(middle).sign(), 0);
  EXPECT_EQ(line.sign_at(middle), 0);
  const FilteredForm<16, 2> positive(std::array<FixedInteger<16>, 2>{large, large});
  EXPECT_EQ(positive.rounded_value_at(middle).sign(), 0);
  EXPECT_EQ(positive.sign_at(middle), 1);
}

// ---- Forms in fixed point -----------------------------------------------------------------------

constexpr std::int64_t one = std::int64_t{1} << FixedPointForm::fraction_bits;

/// A form, and Bernstein's coefficients of it. The greatest of them is in [2^59, 2^60), so that the
/// units are 1; they are whole numbers or, if the form's are, fractions.
struct RandomForm {
  std::vector<BigInteger> c;
  std::vector<Rational> b;
};

RandomForm random_form(Random& random, std::size_t degree) {
  RandomForm result;
  const bool is_whole = random.coin();
  Integer binomial = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    std::int64_t x = random.integer<std::int64_t>(is_whole ? 59 : 60);
    if (k == 0) x = std::abs(x) | (std::int64_t{1} << 59U);
    result.c.emplace_back(is_whole ? BigInteger(x) * big(binomial) : BigInteger(x));
    result.b.push_back(is_whole ? Rational(whole(x)) : Rational(whole(x)) / Rational(binomial));
    binomial = binomial * static_cast<long>(degree - k) / static_cast<long>(k + 1);
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
      return std::min(Rational(1), Rational((whole(t) + late) / whole(one)));
    };
    const auto expected = tests::bernstein_on(form.b, time(lower), time(upper));
    for (std::size_t k = 0; k <= degree; ++k) {
      EXPECT_LE(abs(whole(rough.coefficients()[k]) - expected[k]),
                static_cast<long>(2 + 6 * degree));
    }
  }
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::big_integer_test
