#include "touchstone/filters/double_double.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/filters/ball.hpp"

namespace touchstone::filters::double_double_test {
namespace {

using Pair = DoubleDouble<double>;

constexpr double u = 0x1p-53;

/// Ten times as many trials in the soak.
int trials(int usual) { return tests::soak_trials(usual, 10); }

/// A double whose product_error is a fused operation.
struct Fused {
  double x;

  explicit Fused(double value) : x(value) {}
  friend Fused operator+(const Fused& a, const Fused& b) { return Fused(a.x + b.x); }
  friend Fused operator-(const Fused& a, const Fused& b) { return Fused(a.x - b.x); }
  friend Fused operator*(const Fused& a, const Fused& b) { return Fused(a.x * b.x); }
  friend Fused product_error(const Fused& a, const Fused& b, const Fused& product) {
    return Fused(std::fma(a.x, b.x, -product.x));
  }
};

// ---- Inputs -------------------------------------------------------------------------------------

class Numbers : public tests::Random {
 public:
  using tests::Random::Random;

  std::uint64_t below(std::uint64_t end) { return bits() % end; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  double sign() { return coin() ? 1 : -1; }

  /// A significand in [1,2): of all bits, of few bits, or next to a power of two.
  double significand() {
    const auto all = static_cast<double>(bits() >> 12U);
    switch (below(4)) {
      case 0:
        return 1 + std::ldexp(static_cast<double>(below(8)), -52);
      case 1:
        return 2 - std::ldexp(static_cast<double>(1 + below(8)), -52);
      case 2:
        return 1 + std::ldexp(static_cast<double>(below(64)), -6) +
               std::ldexp(static_cast<double>(below(64)), -52);
      default:
        return 1 + std::ldexp(all, -52);
    }
  }

  double number(int exponent) { return sign() * std::ldexp(significand(), exponent); }

  /// A normalised pair; the low part is at most half a last place, often just that, or 0.
  Pair pair(int exponent) {
    const double high = number(exponent);
    const int below_high = one_in(2) ? 53 : between(53, 70);
    const double low = one_in(6) ? 0.0 : std::ldexp(number(0), exponent - below_high - 1);
    return exact_sum(high, low);
  }

  /// −a, or a pair near it: the first bit of their sum is at a random place, below the high part or
  /// below the low part.
  Pair nearly_opposite(const Pair& a) {
    const int exponent = std::ilogb(a.high);
    if (one_in(16)) return {-a.high, -a.low};
    if (one_in(3)) {
      // The high parts differ by at most three last places, so that the low parts matter.
      const double high = -a.high + std::ldexp(static_cast<double>(between(-3, 3)), exponent - 52);
      return exact_sum(high, std::ldexp(number(0), exponent - 54));
    }
    const double difference = std::ldexp(number(0), exponent - between(1, 107));
    const Pair high = exact_sum(-a.high, difference);
    return exact_sum(high.high, high.low - a.low);
  }
};

// ---- Exactness ----------------------------------------------------------------------------------

mpq_class value(const Pair& a) { return mpq_class(a.high) + mpq_class(a.low); }

/// Two numbers of all sorts: near each other, opposite, ties, of very different size, subnormal.
std::pair<double, double> two_numbers(Numbers& numbers) {
  const int exponent = numbers.one_in(4) ? numbers.between(-1074, 900) : numbers.between(-30, 30);
  const double a = numbers.number(exponent);
  switch (numbers.below(6)) {
    case 0:  // a tie: half a last place of a
      return {a, numbers.sign() * std::ldexp(1.0, exponent - 53)};
    case 1:
      return {a, -std::nextafter(a, numbers.sign() * 1e300)};
    case 2:
      return {a, numbers.number(numbers.between(-1074, 900))};
    case 3:
      return {a, 0.0};
    default:
      return {a, numbers.number(std::max(exponent + numbers.between(-110, 110), -1074))};
  }
}

TEST(DoubleDouble, SumsAndDifferencesOfDoublesAreExact) {
  Numbers numbers(1);
  for (int i = 0; i < trials(200'000); ++i) {
    auto [a, b] = two_numbers(numbers);
    if (std::abs(a) < std::abs(b)) std::swap(a, b);
    ASSERT_EQ(value(sum_of_ordered(a, b)), mpq_class(a) + mpq_class(b)) << a << " " << b;
    if (numbers.one_in(2)) std::swap(a, b);
    const Pair sum = exact_sum(a, b), difference = exact_difference(a, b);
    ASSERT_EQ(value(sum), mpq_class(a) + mpq_class(b)) << a << " " << b;
    ASSERT_EQ(value(difference), mpq_class(a) - mpq_class(b)) << a << " " << b;
    ASSERT_EQ(sum.high, a + b);
    ASSERT_EQ(difference.high, a - b);
    // The smaller comes first, but is a multiple of the other's last place.
    const double larger = numbers.number(0);
    const double multiple = std::ldexp(static_cast<double>(numbers.below(1U << 30U)), -52);
    ASSERT_EQ(value(sum_of_ordered(multiple, larger)), mpq_class(multiple) + mpq_class(larger));
  }
  EXPECT_NE(value(sum_of_ordered(1.0, 0x1p60 + 0x1p10)), mpq_class(0x1p60 + 0x1p10) + 1)
      << "a test of nothing: the order does not matter";
}

/// Two numbers whose product neither overflows nor loses bits by underflow.
std::pair<double, double> two_factors(Numbers& numbers) {
  const int exponent = numbers.between(-480, 490);
  return {numbers.number(exponent), numbers.number(numbers.one_in(2) ? -exponent : exponent)};
}

TEST(DoubleDouble, ErrorsOfProductsAreExact) {
  Numbers numbers(3);
  int rounded = 0;
  for (int i = 0; i < trials(200'000); ++i) {
    const auto [a, b] = two_factors(numbers);
    const mpq_class error = mpq_class(a) * mpq_class(b) - mpq_class(a * b);
    ASSERT_EQ(mpq_class(product_error(a, b, a * b)), error) << a << " " << b;
    ASSERT_EQ(mpq_class(product_error(Fused(a), Fused(b), Fused(a * b)).x), error);
    rounded += error != 0 ? 1 : 0;
  }
  EXPECT_GT(rounded, trials(100'000));
  for (const double factor : {0x1.fffffffffffffp989, 0x1p990, -0x1p990}) {
    const double small = 0x1.fffffffffffffp20;
    EXPECT_EQ(mpq_class(product_error(factor, small, factor * small)),
              mpq_class(factor) * mpq_class(small) - mpq_class(factor * small));
  }
}

// ---- Relative errors ----------------------------------------------------------------------------

/// The sloppy sum: the low parts are added in one rounding. Wrong if the high parts cancel.
Pair sloppy_sum(const Pair& a, const Pair& b) {
  const Pair high = exact_sum(a.high, b.high);
  return sum_of_ordered(high.high, high.low + (a.low + b.low));
}

/// A product without the cross term of the second factor's low part.
Pair careless_product(const Pair& a, const Pair& b) {
  const double product = a.high * b.high;
  return sum_of_ordered(product, product_error(a.high, b.high, product) + a.low * b.high);
}

Pair fused_product(const Pair& a, const Pair& b) {
  const auto product = DoubleDouble<Fused>{Fused(a.high), Fused(a.low)} *
                       DoubleDouble<Fused>{Fused(b.high), Fused(b.low)};
  return {product.high.x, product.low.x};
}

/// The greatest relative error found, in units of u². Fails unless results are normalised.
template <class Operation, class GroundTruth>
double worst_error(const Operation& operation, const GroundTruth& truth, bool cancels) {
  Numbers numbers(4);
  double worst = 0;
  for (int i = 0; i < trials(300'000); ++i) {
    const int exponent = numbers.between(-8, 8);
    const Pair a = numbers.pair(exponent);
    const Pair b = cancels && numbers.one_in(2)
                       ? numbers.nearly_opposite(a)
                       : numbers.pair(numbers.one_in(4) ? numbers.between(-120, 120)
                                                        : exponent + numbers.between(-2, 2));
    const Pair computed = operation(a, b);
    EXPECT_EQ(computed.high + computed.low, computed.high);
    const mpq_class correct = truth(value(a), value(b));
    const double error = mpq_class(value(computed) - correct).get_d();
    if (error != 0) worst = std::max(worst, std::abs(error / correct.get_d()) / (u * u));
  }
  return worst;
}

void expect_between(double worst, double least, double most) {
  EXPECT_LE(worst, most);
  EXPECT_GT(worst, least) << "inputs that prove nothing";
}

TEST(DoubleDouble, SumsAndDifferencesAreNearTheTruthWhateverCancels) {
  const auto sum = [](const Pair& a, const Pair& b) { return a + b; };
  // The difference of a and −b, because sums cancel.
  const auto difference = [](const Pair& a, const Pair& b) { return a - Pair{-b.high, -b.low}; };
  expect_between(worst_error(sum, std::plus<>(), true), 1.0, 3.0);
  expect_between(worst_error(difference, std::plus<>(), true), 1.0, 3.0);
  EXPECT_GT(worst_error(sloppy_sum, std::plus<>(), true), 1e6);
}

TEST(DoubleDouble, ProductsAreNearTheTruth) {
  const auto product = [](const Pair& a, const Pair& b) { return a * b; };
  const double worst = worst_error(product, std::multiplies<>(), false);
  expect_between(worst, 2.0, 5.0);
  EXPECT_EQ(worst_error(fused_product, std::multiplies<>(), false), worst)
      << "the error term is exact either way";
  EXPECT_GT(worst_error(careless_product, std::multiplies<>(), false), 1e6);
}

// ---- Underflow ----------------------------------------------------------------------------------

mpq_class two_to(int exponent) {
  return exponent < 0 ? mpq_class(1) / two_to(-exponent)
                      : mpq_class(mpz_class(1) << static_cast<mp_bitcnt_t>(exponent));
}

TEST(DoubleDouble, SumsDoNotKnowUnderflow) {
  Numbers numbers(6);
  for (int i = 0; i < trials(50'000); ++i) {
    const int exponent = numbers.between(-1074, -960);
    const Pair a = numbers.pair(exponent);
    const Pair b =
        numbers.one_in(2) ? numbers.nearly_opposite(a) : numbers.pair(numbers.between(-1074, -960));
    for (const Pair& other : {b, Pair{-b.high, -b.low}}) {
      const mpq_class truth = value(a) + value(other), error = abs(value(a + other) - truth);
      ASSERT_LE(error, abs(truth) * two_to(-103));
      ASSERT_EQ(value(a - Pair{-other.high, -other.low}), value(a + other));
    }
  }
}

/// The greatest error beyond the relative one, in units of η = 2^-1075, of products of magnitude
/// from 2^least to 2^greatest.
template <class Product>
double worst_underflow(const Product& product, int least, int greatest) {
  Numbers numbers(7);
  double worst = 0;
  for (int i = 0; i < trials(50'000); ++i) {
    const int of_product = numbers.between(least, greatest);
    const int of_a = numbers.between(std::max(of_product, -1074), 40);
    const Pair a = numbers.pair(of_a), b = numbers.pair(std::max(of_product - of_a, -1074));
    const mpq_class truth = value(a) * value(b);
    const mpq_class beyond = abs(value(product(a, b)) - truth) - abs(truth) * two_to(-103);
    worst = std::max(worst, mpq_class(beyond * two_to(1075)).get_d());
  }
  return worst;
}

TEST(DoubleDouble, ProductsLoseNoMoreByUnderflowThanTheDerivationCounts) {
  const auto by_halves = [](const Pair& a, const Pair& b) { return a * b; };
  // The ranges of the argument: near and below the subnormals, halves with lost bits, no lost bits.
  for (const auto& [least, greatest] : {std::pair(-1090, -1020), {-1025, -990}, {-1000, -960}}) {
    const double halves = worst_underflow(by_halves, least, greatest);
    const double fused = worst_underflow(fused_product, least, greatest);
    EXPECT_LE(std::max(halves, fused), 8.0) << least;
  }
  EXPECT_GT(worst_underflow(by_halves, -1090, -1020), 0.5) << "nothing underflows";
  EXPECT_LE(worst_underflow(by_halves, -900, -800), 0.0) << "nothing should underflow here";
}

// ---- Balls --------------------------------------------------------------------------------------

constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// A ball and a number in it, often at its end.
struct Member {
  Ball ball;
  mpq_class number;
};

double random_double(tests::Random& random, int least_exponent, int greatest_exponent) {
  if (random.between(0, 9) == 0) return 0.0;
  const double x = random.uniform(0.5, 1) * (random.coin() ? 1 : -1);
  const double coarse = random.between(0, 3) == 0 ? std::round(8 * x) / 8 : x;
  return std::ldexp(coarse, random.between(least_exponent, greatest_exponent));
}

Member random_member(tests::Random& random, int least_exponent, int greatest_exponent) {
  const double high = random_double(random, least_exponent, greatest_exponent);
  const double low = high * random_double(random, -60, -54);
  Member result{Ball(exact_sum(high, low)), 0};
  if (random.coin()) {
    result.ball.radius =
        std::abs(random_double(random, least_exponent - 110, greatest_exponent - 40));
  }
  const mpq_class part(random.between(0, 2) == 0 ? 1.0 : random.uniform(0, 1));
  const mpq_class offset = part * mpq_class(result.ball.radius);
  result.number = value(result.ball.center) + (random.coin() ? offset : mpq_class(-offset));
  return result;
}

bool holds(const Ball& ball, const mpq_class& number) {
  return abs(mpq_class(number - value(ball.center))) <= mpq_class(ball.radius);
}

TEST(Ball, HoldsSumsDifferencesAndProductsOfItsNumbers) {
  tests::Random random(2100);
  for (int i = 0; i < tests::trials(100'000); ++i) {
    // Similar magnitudes, so that sums cancel; and all magnitudes, subnormal ones too.
    const int exponent = random.coin() ? random.between(-4, 4) : random.between(-1070, 480);
    const Member a = random_member(random, exponent, exponent + 2);
    Member b = random_member(random, exponent, exponent + 2);
    if (random.between(0, 5) == 0) b = {-a.ball, mpq_class(-a.number)};
    ASSERT_TRUE(holds(a.ball + b.ball, a.number + b.number));
    ASSERT_TRUE(holds(a.ball - b.ball, a.number - b.number));
    ASSERT_TRUE(holds(a.ball * b.ball, a.number * b.number));
    ASSERT_TRUE(holds(-a.ball, -a.number));
    ASSERT_TRUE(holds(abs(a.ball), abs(a.number)));
    ASSERT_TRUE(!is_positive(a.ball) || a.number > 0);
  }
}

TEST(Ball, IsNarrow) {
  tests::Random random(2101);
  for (int i = 0; i < tests::trials(10'000); ++i) {
    const Ball a(random.uniform(1, 2)), b(random.uniform(1, 2));
    const Ball c = a * b * a + b * b * a;
    EXPECT_LE(c.radius, 0x1p-98 * c.center.high);
    EXPECT_TRUE(is_positive(c));
    EXPECT_TRUE(is_positive(c - Ball(c.center.high * (1 - 0x1p-51))));
  }
}

TEST(Ball, KeepsZero) {
  const Ball a(0.1), zero(0.0), little(tiniest);
  EXPECT_TRUE(is_exact_zero(a - a));
  EXPECT_TRUE(is_exact_zero(a * zero));
  EXPECT_TRUE(is_exact_zero(zero * a + (a - a)));
  EXPECT_FALSE(is_exact_zero(little * little));
  EXPECT_FALSE(is_positive(little * little));
  EXPECT_FALSE(is_positive(zero));
  EXPECT_TRUE(is_positive(little));
  EXPECT_FALSE(is_positive(a * a - a * a));
}

}  // namespace
}  // namespace touchstone::filters::double_double_test
