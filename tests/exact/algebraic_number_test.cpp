#include "touchstone/algebraic_number.hpp"

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/polynomials.hpp"
#include "tests/support/random.hpp"

namespace touchstone::exact::algebraic_number_test {
namespace {

using tests::polynomial;
using tests::power;
using tests::Random;
using tests::random_polynomial;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_subnormal = std::numeric_limits<double>::denorm_min();

Rational power(const Rational& x, int exponent) {
  Rational result = 1;
  for (int i = 0; i < exponent; ++i) result *= x;
  return result;
}

Rational fraction(long numerator, long denominator) { return Rational(numerator) / denominator; }

const Polynomial& without_real_roots() {
  static const Polynomial result = polynomial({1, 1, 1});
  return result;
}

// ---- Numbers that are known exactly -------------------------------------------------------------
//
// Roots α ≥ 0 of rational numbers. The rationals α⁶, the keys, have the same order.

/// A polynomial with exactly one root α ≥ 0, which is simple; it is negative below α and positive
/// above.
struct Factor {
  Polynomial p;
  Rational key;
};

Factor linear(const Rational& r) { return {tests::factor(r), power(r, 6)}; }
/// \pre r > 0, as −√r would be another root otherwise.
Factor square_root(const Rational& r) {
  return {polynomial({-r.get_num(), 0, r.get_den()}), power(r, 3)};
}
Factor cube_root(const Rational& r) {
  return {polynomial({-r.get_num(), 0, 0, r.get_den()}), power(r, 2)};
}

/// A factor of few values, so that equal numbers come from different factors; some are squares and
/// cubes.
Factor random_factor(Random& random) {
  static const std::array radicands{fraction(1, 64), fraction(1, 8), fraction(1, 4),
                                    fraction(4, 9),  fraction(1, 2), fraction(8, 27),
                                    fraction(3, 7),  fraction(1, 1), fraction(5, 4)};
  const Rational& r = radicands[static_cast<std::size_t>(random.between(0, 8))];
  switch (random.between(0, 3)) {
    case 0:
      return linear(fraction(random.between(0, 12), random.between(9, 12)));
    case 1:
      return linear(r);
    case 2:
      return square_root(r);
    default:
      return cube_root(r);
  }
}

/// A number, and the sign of its difference to a rational one by other means.
struct Known {
  AlgebraicNumber number;
  std::function<int(const Rational&)> minus;
};

Known with_key(const AlgebraicNumber& number, const Rational& key) {
  return {number, [key](const Rational& x) { return sgn(x) < 0 ? 1 : cmp(key, power(x, 6)); }};
}

/// True if these numbers, as the ends of an interval, are the known one or enclose it strictly.
bool encloses(const Rational& lower, const Rational& upper, const Known& known) {
  if (lower == upper) return known.minus(lower) == 0;
  return known.minus(lower) > 0 && known.minus(upper) < 0;
}

bool is_isolated(const Known& known) {
  const auto [lower, upper] = known.number.interval();
  return encloses(lower, upper, known);
}

/// Expects the double itself if the number is one, and its two neighbours if not.
void expect_tight(const Known& known) {
  const auto [lower, upper] = known.number.enclosure();
  EXPECT_TRUE(encloses(Rational(lower), Rational(upper), known)) << lower << ' ' << upper;
  EXPECT_TRUE(lower == upper || upper == std::nextafter(lower, infinity)) << lower << ' ' << upper;
}

/// The roots in [0,1] of a polynomial, which have these keys, ascending.
std::vector<Known> known_roots(const Polynomial& p, const std::vector<Rational>& keys) {
  const std::vector<AlgebraicNumber> roots = roots_in_unit_interval(p);
  EXPECT_EQ(roots.size(), keys.size()) << p;
  std::vector<Known> result;
  for (std::size_t i = 0; i < std::min(roots.size(), keys.size()); ++i) {
    result.push_back(with_key(roots[i], keys[i]));
  }
  return result;
}

/// The roots in [0,1] of a product of random factors.
std::vector<Known> random_known_roots(Random& random) {
  Polynomial p(Integer(-random.between(1, 9)));
  std::vector<Rational> keys;
  for (int factors = random.between(1, 4); factors > 0; --factors) {
    const Factor factor = random_factor(random);
    p = p * (power(factor.p, random.between(1, 3)));
    if (factor.key <= 1) keys.push_back(factor.key);
  }
  if (random.coin()) p = p * (without_real_roots());
  if (random.coin()) p = p * (polynomial({1, 2}) * polynomial({-4, 3}));  // −1/2 and 4/3
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return known_roots(p, keys);
}

/// The one root in [0,1] of factor · (t² + t + 1), not yet known to be rational.
Known hidden(const Factor& factor) {
  return known_roots(factor.p * without_real_roots(), {factor.key}).at(0);
}

/// A polynomial with all its roots in [0,1], which are rational.
struct Listed {
  Polynomial p;
  std::vector<Rational> roots;
};

std::vector<Listed> listed() {
  std::vector<Listed> all;
  for (const int multiplicity : {1, 2, 3}) {
    all.push_back({power(polynomial({0, 1, -1}), multiplicity) * polynomial({-1, 3}),
                   {0, fraction(1, 3), 1}});
  }
  const Rational just = power_of_two(-300);
  for (const Polynomial& p :
       {polynomial({1}), polynomial({-7}), linear(-just).p, linear(1 + just).p,
        linear(-just).p * linear(1 + just).p, without_real_roots(), polynomial({1, 0, 1}),
        polynomial({-3, 0, 2}), polynomial({1, 3, 2})}) {
    all.push_back({p, {}});
  }
  all.push_back({linear(just).p * linear(1 - just).p, {just, 1 - just}});
  // ((3t−1)² − ε²)((3t−2)² + δ²)(2t−5): two roots at 1/3 ± ε/3, and two that are not real near 2/3.
  for (const unsigned bits : {10U, 100U, 1000U, 5000U}) {
    const Integer whole = Integer(1) << bits;
    const auto pair = [&](long root, long sign) {
      return power(polynomial({-root * whole, 3 * whole}), 2) + polynomial({sign});
    };
    const Rational middle(1, 3), distance(Integer(1), Integer(3 * whole));
    all.push_back(
        {pair(1, -1) * pair(2, 1) * polynomial({-5, 2}), {middle - distance, middle + distance}});
  }
  // (3t−1)³ = ±ε²(3t−1) has three roots or one; so does the same equation about 1/2, a midpoint.
  const Integer whole = Integer(1) << 300U;
  for (const long n : {2L, 3L, 7L}) {
    const Polynomial factor = polynomial({-whole, n * whole}), square = factor * factor;
    const Rational middle(1, n), distance(Integer(1), Integer(n * whole));
    all.push_back(
        {factor * (square - polynomial({1})), {middle - distance, middle, middle + distance}});
    all.push_back({factor * (square + polynomial({1})), {middle}});
  }
  // (3t − 1)³ − 2^−300: one root, just above 1/3 + 2^−102, where the secant guesses badly.
  all.push_back({polynomial({whole}) * power(polynomial({-1, 3}), 3) - polynomial({1}),
                 {fraction(1, 3) + power_of_two(-100) / 3}});
  return all;
}

std::vector<Known> listed_roots(const Listed& one) {
  std::vector<Rational> keys;
  for (const Rational& root : one.roots) keys.push_back(power(root, 6));
  std::vector<Known> result = known_roots(one.p, keys);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i].number, one.roots[i]);
  return result;
}

TEST(RootsInUnitInterval, OfZeroAreNone) {
  EXPECT_THROW(static_cast<void>(roots_in_unit_interval(Polynomial())), std::invalid_argument);
}

// ---- Refinement ---------------------------------------------------------------------------------

TEST(Refine, TakesAnyPositiveWidthAndNoOther) {
  for (AlgebraicNumber number :
       {hidden(square_root(fraction(1, 2))).number, AlgebraicNumber(Rational(1, 3))}) {
    number.refine(1);
    number.refine(Rational("123456789123456789/7"));
    number.refine(fraction(1, 3));
    EXPECT_TRUE(number.interval().upper - number.interval().lower <= fraction(1, 3));
    EXPECT_THROW(number.refine(0), std::invalid_argument);
    EXPECT_THROW(number.refine(-1), std::invalid_argument);
    EXPECT_THROW(number.refine(-power_of_two(-100)), std::invalid_argument);
  }
}

TEST(Refine, RecognisesEveryDyadicNumber) {
  for (const int level : {1, 2, 3, 5, 10, 53, 64, 200, 1074}) {
    for (const Rational& value :
         {Rational(power_of_two(-level)), Rational(1 - power_of_two(-level))}) {
      AlgebraicNumber number = hidden(linear(value)).number;
      number.refine_to_level(static_cast<unsigned long>(level) + 2);
      EXPECT_EQ(number.rational(), value) << level;
    }
  }
}

// ---- Against CGAL's algebraic kernel ------------------------------------------------------------

using Kernel = CGAL::Algebraic_kernel_d_1<CGAL::Gmpz>;
using CgalRoot = Kernel::Algebraic_real_1;

Kernel::Polynomial_1 to_cgal(const Polynomial& p) {
  std::vector<CGAL::Gmpz> c;
  for (const Integer& x : p.coefficients()) c.emplace_back(x.get_mpz_t());
  return {c.begin(), c.end()};
}

CGAL::Gmpq to_cgal(const Rational& x) { return {x.get_mpq_t()}; }

/// CGAL's roots in [0,1], ascending.
std::vector<CgalRoot> cgal_roots(const Polynomial& p) {
  std::vector<std::pair<CgalRoot, Kernel::Multiplicity_type>> roots;
  Kernel().solve_1_object()(to_cgal(p), CGAL::Gmpq(0), CGAL::Gmpq(1), std::back_inserter(roots));
  std::vector<CgalRoot> result;
  result.reserve(roots.size());
  for (const auto& [root, multiplicity] : roots) result.push_back(root);
  return result;
}

struct Pair {
  AlgebraicNumber number;
  CgalRoot expected;
};

Known known(const Pair& pair) {
  return {pair.number, [root = pair.expected](const Rational& x) {
            return static_cast<int>(Kernel().compare_1_object()(root, to_cgal(x)));
          }};
}

std::vector<Pair> paired_roots(const Polynomial& p) {
  const std::vector<AlgebraicNumber> roots = roots_in_unit_interval(p);
  const std::vector<CgalRoot> expected = cgal_roots(p);
  EXPECT_EQ(roots.size(), expected.size()) << p;
  std::vector<Pair> result;
  for (std::size_t i = 0; i < std::min(roots.size(), expected.size()); ++i) {
    result.push_back({roots[i], expected[i]});
    EXPECT_TRUE(is_isolated(known(result.back()))) << p;
  }
  return result;
}

/// Roots of the listed polynomials, of products of factors, of random polynomials and their
/// squares, and of Mignotte's polynomials t^n − 2(at − 1)²: two next to 1/a, about a^(−n/2) apart.
std::vector<Known> numbers() {
  std::vector<Known> result;
  for (const Listed& one : listed()) {
    std::ranges::move(listed_roots(one), std::back_inserter(result));
  }
  for (Random random(44); result.size() < 180;) {
    std::ranges::move(random_known_roots(random), std::back_inserter(result));
  }
  const auto take = [&](const Polynomial& p) {
    const std::vector<Pair> roots = paired_roots(p);
    std::ranges::transform(roots, std::back_inserter(result), known);
    return roots.size();
  };
  Random random(51);
  for (int round = 0; round < 300; ++round) {
    const Polynomial p = random_polynomial(random, random.between(1, 6), 12);
    take(round % 3 == 0 ? p * p : p);
  }
  EXPECT_GT(result.size(), 280U);
  for (int degree = 3; degree <= 6; ++degree) {
    for (const int a : {3, 100, 1001}) {
      EXPECT_GE(
          take(power(polynomial({0, 1}), degree) - polynomial({2}) * power(polynomial({-1, a}), 2)),
          2U);
    }
  }
  return result;
}

TEST(AlgebraicNumber, IsComparedEnclosedAndRefinedAsItsValue) {
  Random random(43);
  for (Known& known : numbers()) {
    AlgebraicNumber& number = known.number;
    EXPECT_TRUE(is_isolated(known));
    expect_tight(known);
    EXPECT_TRUE(number.rational() || (known.minus(0) != 0 && known.minus(1) != 0));
    std::vector<Rational> others{-3, 0, 1, 2, number.interval().lower, number.interval().upper};
    for (int n = 1; n < 12; ++n) others.push_back(fraction(n, 12));
    for (const Rational& r : {fraction(1, 64), fraction(2, 3), fraction(4, 9), fraction(3, 7)}) {
      others.push_back(r);
      others.emplace_back(r + power_of_two(-200));
    }
    for (const Rational& other : others) {
      const int expected = known.minus(other);
      EXPECT_TRUE((number <=> other) == (expected <=> 0)) << other;
      EXPECT_TRUE((other <=> number) == (0 <=> expected)) << other;
      EXPECT_EQ(number == other, expected == 0);
    }
    int level = 0;
    for (int round = 0; round < 8; ++round) {
      level += random.between(0, 180);
      const Rational width = power_of_two(-level) * fraction(random.between(1, 99), 50);
      const RationalInterval before = number.interval();
      number.refine(width);
      const auto [lower, upper] = number.interval();
      EXPECT_LE(Rational(upper - lower), width);
      EXPECT_TRUE(is_isolated(known));
      Known other = known;
      other.number.refine_to_level(static_cast<unsigned long>(level));
      const auto [below, above] = other.number.interval();
      EXPECT_LE(Rational(above - below), power_of_two(-level));
      EXPECT_TRUE(is_isolated(other));
      EXPECT_TRUE(before.lower <= lower && upper <= before.upper);
      if (!number.rational()) {
        EXPECT_EQ(sign_at(number.polynomial(), lower) * sign_at(number.polynomial(), upper), -1);
      }
    }
  }
}

/// Polynomials p and q: they share a factor, q is almost a multiple of p, or both.
TEST(AgainstCgal, SignsAtRootsThatAreSharedOrAlmostShared) {
  Random random(52);
  const Polynomial scale = polynomial({Integer(1) << 200});
  const auto draw = [&](int least, int most) {
    return random_polynomial(random, random.between(least, most), 8);
  };
  std::array<int, 3> zeros{}, others{};
  for (int round = 0; round < 450; ++round) {
    const auto form = static_cast<std::size_t>(round % 3);
    const Polynomial shared = draw(form == 0 ? 0 : 1, 2), own = draw(1, 3);
    const Polynomial rest = random.coin() ? polynomial({random.coin() ? 1 : -1}) : draw(1, 3);
    const Polynomial p = form == 1 ? own : shared * own;
    const Polynomial q = form == 0   ? shared * draw(1, 3)
                         : form == 1 ? scale * own * draw(0, 2) + rest
                                     : shared * (scale * own + rest);
    for (auto& [number, expected] : paired_roots(p)) {
      const int sign = Kernel().sign_at_1_object()(to_cgal(q), expected);
      EXPECT_EQ(number.is_root_of(q), sign == 0);
      EXPECT_EQ(number.sign_of(q), sign) << p << q;
      ++(sign == 0 ? zeros : others).at(form);
    }
  }
  EXPECT_GT(zeros[0], 10);
  EXPECT_GT(zeros[2], 10);
  for (const int count : others) EXPECT_GT(count, 30);
}

/// Numbers of which some are equal, and some within 2^-190 of each other.
TEST(AgainstCgal, Comparisons) {
  Random random(53);
  std::vector<Pair> numbers;
  const auto take = [&](const Polynomial& p) {
    for (Pair& pair : paired_roots(p)) numbers.push_back(std::move(pair));
  };
  for (int round = 0; round < 25; ++round) {
    const Polynomial common = random_polynomial(random, 2, 4);
    for (int partner = 0; partner < 2; ++partner) take(common * random_polynomial(random, 2, 4));
    take(polynomial({(Integer(1) << 200) + 1}) * common + polynomial({2}));
  }
  const auto compare = Kernel().compare_1_object();
  int equal = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int expected = compare(numbers[i].expected, numbers[j].expected);
      const AlgebraicNumber &a = numbers[i].number, &b = numbers[j].number;
      EXPECT_TRUE((a <=> b) == (expected <=> 0));
      EXPECT_EQ(a == b, expected == 0);
      equal += expected == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(equal, 5);
}

// ---- Enclosures ---------------------------------------------------------------------------------

/// Doubles of all magnitudes in [0,1].
std::vector<double> doubles() {
  Random random(59);
  std::vector<double> samples{1.0,
                              0.5,
                              0.1,
                              std::nextafter(1.0, 0.0),
                              0x1.8p-1060,
                              0x1p-1070,
                              least_subnormal,
                              std::ldexp(1.0 + 0x1p-30, -600),
                              0x1p-1022};
  for (int i = 0; i < 60; ++i) samples.push_back(random.uniform());
  while (samples.size() < 120) {
    const double x = std::abs(random.finite_double());
    if (x <= 1.0) samples.push_back(x);
  }
  return samples;
}

/// Numbers at and very near doubles, where one double lies inside a cell, and beyond all doubles.
std::vector<Factor> factors_of_enclosures() {
  std::vector<Factor> result{linear(1 - power_of_two(-60)), linear(power_of_two(-1100)),
                             linear(power_of_two(-1075)), square_root(power_of_two(-3000)),
                             cube_root(power_of_two(-4000)),
                             // Between subnormal numbers, and between normal ones far below 1.
                             square_root(power_of_two(-2139)), square_root(power_of_two(-2045)),
                             linear(3 * power_of_two(-1075)), cube_root(power_of_two(-3100)),
                             square_root(power_of_two(-1200) * (1 + power_of_two(-30))),
                             linear(power_of_two(-600) * (1 + power_of_two(-53)))};
  for (const double x : doubles()) result.push_back(linear(Rational(x)));
  for (const double x : {0.5, 0.1, 0x1p-1022, 0x1.8p-1060, 0x1.fffffffffffffp-1}) {
    for (const long distance : {1100L, 3000L}) {
      result.push_back(linear(Rational(x) - power_of_two(-distance)));
      result.push_back(linear(Rational(x) + power_of_two(-distance)));
    }
  }
  // Cells are refined to the levels 64, 128, …: these magnitudes are where such a cell is about as
  // wide as two or four steps between doubles.
  Random random(63);
  for (const int level : {64, 128, 256, 512, 1024}) {
    for (int binade = 50 - level; binade <= 56 - level; ++binade) {
      for (int round = 0; round < 6; ++round) {
        const double x = std::ldexp(random.uniform(1.0, 2.0), binade);
        const Rational a(x), step = Rational(std::nextafter(x, 1.0)) - a;
        for (const Rational& r : {a, Rational(a + step / 3), Rational(a - step / 3)}) {
          result.push_back(linear(r));
        }
        result.push_back(square_root(a * a + step * a));
        result.push_back(square_root(a * a - step * a));
      }
    }
  }
  return result;
}

TEST(Enclosure, IsTheDoubleOrItsTwoNeighbours) {
  for (const Factor& factor : factors_of_enclosures()) expect_tight(hidden(factor));
  for (const double x : doubles()) {
    EXPECT_EQ(AlgebraicNumber(Rational(x)).enclosure(), (DoubleInterval{x, x}));
  }
  EXPECT_EQ(AlgebraicNumber(Rational(0)).enclosure(), (DoubleInterval{0.0, 0.0}));
}

// ---- Quotients ----------------------------------------------------------------------------------

TEST(EncloseQuotient, WaitsForADenominatorToShowItsSign) {
  // The denominator is ±1 at α but vanishes 2^−300 from it.
  const Rational r = fraction(1, 2);
  const AlgebraicNumber alpha = hidden(square_root(r)).number;
  const Polynomial large = polynomial({Integer(1) << 300}) * square_root(r).p;
  for (const int one : {1, -1}) {
    const Polynomial denominator = large + polynomial({one});
    const auto [lower, upper] =
        enclose_quotient(polynomial({0, 1}), denominator, alpha, power_of_two(-40));
    EXPECT_LE(Rational(upper - lower), power_of_two(-40));
    EXPECT_TRUE(one > 0 ? alpha >= lower && alpha <= upper
                        : alpha <= Rational(-lower) && alpha >= Rational(-upper));
  }
}

}  // namespace
}  // namespace touchstone::exact::algebraic_number_test
