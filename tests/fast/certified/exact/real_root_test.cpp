#include "fast/certified/exact/real_root.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/polynomial.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::exact_stage::real_root_test {
namespace {

using Quadratic = Form<BigInteger, 2>;

/// a + b t + c t² as a form: t = y/(x+y).
Quadratic in_time(std::int64_t a, std::int64_t b, std::int64_t c) {
  return {a, 2 * a + b, a + b + c};
}

Polynomial polynomial(const Quadratic& form) { return {form.begin(), form.end()}; }

/// a + b t + c t² + d t³, without roots at t=0 and t=1.
Polynomial cubic(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  return inner_polynomial(Polynomial{a, 3 * a + b, 3 * a + 2 * b + c, a + b + c + d});
}

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

/// (m − n t)(x+y), a root at m/n.
Quadratic root_at(std::int64_t m, std::int64_t n) { return in_time(m, -n, 0); }

double value(const Dyadic& t) {
  return std::ldexp(t.numerator.approximation().significand,
                    static_cast<int>(t.numerator.approximation().exponent - t.exponent));
}

/// The doubles around all roots, from visit_roots.
std::vector<BitInterval> roots(const Polynomial& f) {
  std::vector<BitInterval> result;
  visit_roots(squarefree(f), [&](Instant& instant) {
    result.push_back(
        enclose(instant.guess(), 1, [&](std::uint64_t bits) { return instant.is_above(bits); }));
    return false;
  });
  return result;
}

void expect_roots(const Polynomial& f, const std::vector<double>& expected) {
  const auto found = roots(f);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LE(std::bit_cast<double>(found[i].lower), expected[i]);
    EXPECT_GE(std::bit_cast<double>(found[i].upper), expected[i]);
    EXPECT_EQ(found[i].upper - found[i].lower, 1U);
  }
}

TEST(AlgebraicInstant, FindsAllRootsInOrder) {
  constexpr double third = 1.0 / 3.0;
  expect_roots(cubic(-3, 32, -64, 0), {1.0 / 8.0, 3.0 / 8.0});
  expect_roots(cubic(-3, 44, -192, 256), {1.0 / 8.0, 0.25, 3.0 / 8.0});
  expect_roots(cubic(-1, 0, 2, 0), {std::sqrt(0.5)});
  expect_roots(cubic(1, 0, 2, 0), {});
  // Multiple ones once.
  expect_roots(cubic(1, -6, 9, 0), {third});          // (1−3t)²
  expect_roots(cubic(1, -9, 27, -27), {third});       // (1−3t)³
  expect_roots(cubic(1, -8, 21, -18), {third, 0.5});  // (1−3t)²(1−2t)
  const Polynomial a = polynomial(in_time(1, 0, -2)), b = polynomial(in_time(2, -9, 9));
  expect_roots(inner_polynomial(a * a * b * polynomial(in_time(1, 1, 1))),
               {third, 2.0 / 3.0, std::sqrt(0.5)});
  // None at the ends.
  expect_roots(cubic(0, 1, -1, 0), {});     // t(1−t)
  expect_roots(cubic(0, 1, -3, 2), {0.5});  // t(1−t)(1−2t)
  // (1 − 2^70 t)(1 − 2^35 t)
  const BigInteger one = 1, steep = one << 70, flat = one << 35;
  expect_roots({one, BigInteger(2) - steep - flat, one - steep - flat + steep * flat},
               {0x1p-70, 0x1p-35});
}

TEST(AlgebraicInstant, KnowsSignsAndZerosOfOtherForms) {
  // (1 − 2t²): irrational, √½ = 0.70710678…
  Instant root(cubic(1, 0, -2, 0), {0, 0}, {1, 0});
  EXPECT_EQ(root.sign_of(in_time(1, 0, -2)), 0);
  EXPECT_EQ(root.sign_of(in_time(-3, 0, 6)), 0);
  EXPECT_EQ(root.sign_of(in_time(0, 0, 0)), 0);
  EXPECT_EQ(root.sign_of(root_at(70710678, 100000000)), -1);
  EXPECT_EQ(root.sign_of(root_at(70710679, 100000000)), 1);
  EXPECT_EQ(root.sign_of(root_at(33461, 47321)), 1);   // 2·33461² = 47321² + 1
  EXPECT_EQ(root.sign_of(root_at(13860, 19601)), -1);  // 2·13860² = 19601² − 1
  EXPECT_NEAR(root.quotient_of(in_time(0, 1, 0), in_time(1, 0, 0)), std::sqrt(0.5), 0x1p-46);
  // f = (1−3t)(2−3t); q = (2−3t)(1+t) shares only the other root.
  Instant first(cubic(2, -9, 9, 0), {0, 0}, {1, 1});
  EXPECT_EQ(first.sign_of(in_time(2, -1, -3)), 1);
  EXPECT_EQ(first.sign_of(in_time(1, -2, -3)), 0);  // (1−3t)(1+t)
}

TEST(AlgebraicInstant, KnowsADyadicRootExactly) {
  Instant root(cubic(5, -16, 0, 0), {0, 0}, {1, 0});
  EXPECT_FALSE(root.is_above(bits_of(0.3125)));
  EXPECT_TRUE(root.is_above(bits_of(std::nextafter(0.3125, 0.0))));
  EXPECT_EQ(root.sign_of(root_at(5, 16)), 0);
  EXPECT_EQ(root.sign_of(root_at(5000001, 16000000)), 1);
}

TEST(AlgebraicInstant, SplitsBetweenTheEndsAndQuicklyTowardsThem) {
  Dyadic lower{0, 0}, upper{1, 0};
  int steps = 0;
  for (; value(upper) > 0x1p-1000; ++steps) upper = split(lower, upper);
  EXPECT_LE(steps, 12);
  lower = {1, 1};
  upper = {1, 0};
  for (int i = 0; i < 60; ++i) {
    const Dyadic middle = split(lower, upper);
    EXPECT_LT(value(lower), value(middle));
    EXPECT_LT(value(middle), value(upper));
    (i % 2 == 0 ? lower : upper) = middle;
    if (value(upper) - value(lower) < 0x1p-50) break;
  }
}

TEST(AlgebraicInstant, TellsRootsThatAreHardlyApart) {
  // (3t − 1)² = 2^-400, and a double root near both.
  const BigInteger large = BigInteger(1) << 400;
  const Quadratic square = in_time(1, -6, 9);
  const Polynomial pair = polynomial(square) * large - polynomial(in_time(1, 0, 0));
  expect_roots(pair, {1.0 / 3.0, 1.0 / 3.0});
  Instant start(Dyadic{0, 0});
  auto first = first_root_after(start, {1, 0}, pair);
  ASSERT_TRUE(first.has_value());
  Instant third(cubic(1, -3, 0, 0), {0, 0}, {1, 0});
  EXPECT_EQ(compare(*first, third), -1);
  auto second = first_root_after(third, {1, 0}, in_time(2, -3, 0));
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(compare(*second, third), 1);
  expect_roots(polynomial(square), {1.0 / 3.0});
}

/// The logarithm of the interval's length to the base of 2, rounded up.
long length(const Instant& root) {
  return ((root.upper().numerator << root.lower().exponent) -
          (root.lower().numerator << root.upper().exponent))
             .bit_length() -
         root.lower().exponent - root.upper().exponent;
}

/// Numbers out of the range of doubles were guessed as 0, and narrowing took minutes. Found by the
/// fuzzer.
TEST(AlgebraicInstant, NarrowsQuicklyBesideAnEnd) {
  // (2t − 1)² = 2^-1080: roots 2^-541 from 1/2.
  const BigInteger large = BigInteger(1) << 1080;
  const Polynomial pair{large - 1, BigInteger(-2) * (large + 1), large - 1};
  const Dyadic half{1, 1};
  for (const auto& [lower, upper] :
       {std::pair{Dyadic{0, 0}, half}, std::pair{half, Dyadic{1, 0}}}) {
    Instant root(pair, lower, upper);
    for (int i = 0; i < 3; ++i) root.narrow();
    EXPECT_EQ(compare(root.lower(), root.upper()), -1);
    EXPECT_LT(length(root), -600);
    EXPECT_LT(std::max(root.lower().exponent, root.upper().exponent), 1500);
  }
}

TEST(AlgebraicInstant, NarrowsByTwiceAsManyBitsEachTime) {
  Instant root(cubic(1, 0, -2, 0), {0, 0}, {1, 0});  // √½
  for (int i = 0; i < 10; ++i) root.narrow();
  EXPECT_LT(length(root), -10000);
  EXPECT_GT(length(root), -30000);
}

TEST(AlgebraicInstant, ComparesRootsThatAreHardlyApart) {
  const BigInteger large = BigInteger(1) << 20000;
  const Polynomial f = polynomial(in_time(1, 0, -2)) * large;  // 1 − 2t², t = √½
  for (const int sign : {1, -1}) {
    Polynomial other = f;
    other += polynomial(in_time(1, 0, 0)) * BigInteger(sign);
    Instant a(f, {0, 0}, {1, 0}), b(other, {0, 0}, {1, 0});
    EXPECT_EQ(compare(a, b), -sign);
    EXPECT_EQ(compare(b, a), sign);
    EXPECT_GT(length(a), -100000);
  }
}

TEST(AlgebraicInstant, NarrowsQuicklyBesideAnyTime) {
  // (3t − 1)² 2^20000 = t: a root about 2^-10000 after 1/3, from a lower end just before 1/3.
  const BigInteger large = BigInteger(1) << 20000;
  const Polynomial pair = polynomial(in_time(1, -6, 9)) * large - polynomial(in_time(0, 1, 0));
  const long exponent = 12000;
  BigInteger third = 0;
  for (long k = 0; k < exponent; k += 2) third = (third << 2) + BigInteger(1);
  Instant root(pair, {third, exponent}, {1, 1});
  for (int i = 0; i < 8; ++i) root.narrow();
  EXPECT_LT(length(root), -11000);
}

TEST(AlgebraicInstant, ComparesInstants) {
  Instant a(cubic(1, 0, -2, 0), {0, 0}, {1, 0});   // √½
  Instant b(cubic(-3, 0, 6, 0), {1, 1}, {3, 2});   // the same
  Instant c(cubic(-7, 10, 0, 0), {0, 0}, {1, 0});  // 7/10
  Instant d(Dyadic{3, 2});
  EXPECT_EQ(compare(a, b), 0);
  EXPECT_EQ(compare(a, c), 1);
  EXPECT_EQ(compare(c, a), -1);
  EXPECT_EQ(compare(a, d), -1);
  EXPECT_EQ(compare(d, c), 1);
  EXPECT_EQ(compare(d, d), 0);
}

TEST(AlgebraicInstant, FindsTheFirstRootLaterThanATime) {
  const Quadratic f = in_time(2, -9, 9);             // roots at 1/3 and 2/3
  Instant half(cubic(1, 0, -2, 0), {0, 0}, {1, 0});  // √½, where f > 0
  EXPECT_FALSE(first_root_after(half, {1, 0}, f).has_value());
  Instant start(Dyadic{0, 0});
  auto third = first_root_after(start, {1, 0}, f);
  ASSERT_TRUE(third.has_value());
  EXPECT_EQ(third->sign_of(root_at(1, 3)), 0);
  EXPECT_FALSE(first_root_after(start, {1, 2}, f).has_value());
  auto end = first_root_after(start, {1, 2}, in_time(1, -4, 0));  // at the limit itself
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(compare(end->lower(), {1, 2}), 0);
}

// ---- Between doubles ----------------------------------------------------------------------------

/// Finds a number α given by the smallest double that is not below it.
BitInterval found(std::uint64_t ceiling, double guess, std::uint64_t step, int& questions) {
  return enclose(guess, step, [&](std::uint64_t bits) {
    ++questions;
    return bits < ceiling;
  });
}

TEST(DoubleSearch, EnclosesWhateverTheGuess) {
  tests::Random random(1);
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
  tests::Random random(2);
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
}  // namespace touchstone::fast::exact_stage::real_root_test
