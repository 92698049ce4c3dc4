#include "touchstone/algebraic_number.hpp"

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>
#include <CGAL/polynomial_utils.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/polynomial.hpp"

// Polynomials beside their values and CGAL's polynomials; their roots beside those of CGAL's
// algebraic kernel.

namespace touchstone::exact::algebraic_number_test {
namespace {

using tests::Random;
using Kernel = CGAL::Algebraic_kernel_d_1<CGAL::Gmpz>;
using CgalRoot = Kernel::Algebraic_real_1;

/// Σ c_i t^i.
Polynomial polynomial(const std::vector<Integer>& c) { return Polynomial(c); }

Polynomial power(const Polynomial& p, int exponent) {
  Polynomial result(Integer(1));
  for (int i = 0; i < exponent; ++i) result = result * p;
  return result;
}

/// A primitive polynomial of degree 1 with this root.
Polynomial factor(const Rational& root) { return polynomial({-root.get_num(), root.get_den()}); }

/// A random polynomial of exactly this degree.
Polynomial random_polynomial(Random& random, int degree, unsigned bits) {
  std::vector<Integer> c;
  for (int i = 0; i <= degree; ++i) c.push_back(random.integer<Integer>(bits));
  if (sgn(c.back()) == 0) c.back() = 1;
  return polynomial(c);
}

Kernel::Polynomial_1 to_cgal(const Polynomial& p) {
  std::vector<CGAL::Gmpz> c;
  for (const Integer& x : p.coefficients()) c.emplace_back(x.get_mpz_t());
  return {c.begin(), c.end()};
}

Polynomial from_cgal(const Kernel::Polynomial_1& p) {
  std::vector<Integer> c;
  for (const CGAL::Gmpz& x : p) c.emplace_back(x.mpz());
  return polynomial(c);
}

// ---- Polynomials --------------------------------------------------------------------------------

Rational random_rational(Random& random, unsigned bits) {
  Rational x(random.integer<Integer>(bits), abs(random.integer<Integer>(bits)) + 1);
  x.canonicalize();
  return x;
}

/// p(x) as the sum of its terms.
Rational value(const Polynomial& p, const Rational& x) {
  Rational sum = 0, term = 1;
  for (const Integer& c : p.coefficients()) {
    sum += c * term;
    term *= x;
  }
  return sum;
}

DyadicCell random_cell(Random& random, int greatest_level) {
  const auto level = static_cast<unsigned long>(random.between(0, greatest_level));
  return {random.integer<Integer>(static_cast<unsigned>(level) + 1), level};
}

Rational inside(const DyadicCell& cell, const Rational& y) {
  return cell.lower() + y * (cell.upper() - cell.lower());
}

/// The normal form of a polynomial ≠ 0, content 1 and a positive leading coefficient, without the
/// functions under test.
Polynomial normal(const Polynomial& p) {
  Integer content = 0;
  for (const Integer& c : p.coefficients()) content = gcd(content, c);
  if (sgn(p.leading()) < 0) content = -content;
  std::vector<Integer> c = p.coefficients();
  for (Integer& entry : c) entry /= content;
  return polynomial(c);
}

TEST(Polynomial, PrintsItsTermsWithoutLeadingZeros) {
  for (const auto& [p, text] : {std::pair(polynomial({5, -1, 3}), "3 t^2 - t + 5"),
                                {polynomial({0, 1, 0, -1, 0}), "-t^3 + t"},
                                {polynomial({-1}), "-1"},
                                {polynomial({}), "0"},
                                {polynomial({1, 2, 3}) - polynomial({0, 0, 3}), "2 t + 1"}}) {
    std::ostringstream out;
    out << p;
    EXPECT_EQ(out.str(), text);
  }
}

/// Arithmetic on polynomials agrees with arithmetic on their values.
TEST(Polynomial, AddsMultipliesAndDerivesAsValuesDo) {
  Random random(20);
  EXPECT_EQ(derivative(polynomial({5, -1, 3})), polynomial({-1, 6}));
  for (int round = 0; round < 500; ++round) {
    const auto draw = [&] { return random_polynomial(random, random.between(0, 6), 60); };
    const Polynomial p = draw(), q = draw();
    const Rational x = random_rational(random, 20);
    EXPECT_EQ(value(p + q, x), value(p, x) + value(q, x));
    EXPECT_EQ(value(p - q, x), value(p, x) - value(q, x));
    EXPECT_EQ(value(-p, x), -value(p, x));
    EXPECT_EQ(value(p * q, x), value(p, x) * value(q, x));
    EXPECT_EQ(derivative(p + q), derivative(p) + derivative(q));
    EXPECT_EQ(derivative(p * q), derivative(p) * q + p * derivative(q));
    EXPECT_EQ(sign_at(p, x), sgn(value(p, x)));
    EXPECT_EQ(sign_at(p * factor(x), x), 0);
  }
  // One part in 2^1000.
  const Rational root(1, 3), least = power_of_two(-1000);
  EXPECT_EQ(sign_at(factor(root), root + least), 1);
  EXPECT_EQ(sign_at(factor(root), root - least), -1);
  EXPECT_EQ(sign_at(power(factor(root), 2), root + least), 1);
}

/// A polynomial with known roots, which has no other real root.
struct Factored {
  Polynomial p;
  std::vector<Rational> roots;  ///< each repeated by its multiplicity
};

Factored random_factored(Random& random) {
  Factored result{Polynomial(random.integer<Integer>(8) * 2 + 1), {}};
  for (int factors = random.between(1, 4); factors > 0; --factors) {
    const Rational root = random_rational(random, 5) / 8;
    const int multiplicity = random.between(1, 3);
    result.p = result.p * power(factor(root), multiplicity);
    result.roots.insert(result.roots.end(), static_cast<std::size_t>(multiplicity), root);
  }
  for (int pairs = random.between(0, 2); pairs > 0; --pairs) {
    // (at − b)² + c² with c ≠ 0.
    const Polynomial real = random_polynomial(random, 1, 4);
    result.p = result.p * (real * real + Polynomial(Integer(random.between(1, 9))));
  }
  return result;
}

TEST(Cell, SignsAreRightAndSeenOnceItIsSmall) {
  Random random(24);
  int with_roots = 0, proofs = 0;
  for (int round = 0; round < 1300; ++round) {
    const Factored f = random_factored(random);
    // Roots have denominators below 2^9: at most one end of a cell of level 200 is a root.
    const bool is_small = round % 4 == 0;
    const DyadicCell cell =
        is_small ? DyadicCell{random.integer<Integer>(200), 200} : random_cell(random, 5);
    const auto roots = std::ranges::count_if(
        f.roots, [&](const Rational& root) { return cell.lower() < root && root < cell.upper(); });
    const int changes = sign_changes(bernstein_form(f.p, cell)), sign = sign_on(f.p, cell);
    EXPECT_GE(changes, roots);
    EXPECT_EQ((changes - roots) % 2, 0);
    with_roots += roots > 0 ? 1 : 0;
    if (roots > 0) {
      EXPECT_EQ(sign, 0);
      EXPECT_EQ(sign_on(f.p * f.p, cell), 0);
    }
    EXPECT_TRUE(sign != 0 || roots > 0 || !is_small);
    if (sign == 0) continue;
    ++proofs;
    for (int k = 1; k < 16; ++k) EXPECT_EQ(sgn(value(f.p, inside(cell, Rational(k) / 16))), sign);
  }
  EXPECT_GT(with_roots, 100);
  EXPECT_GT(proofs, 100);
  // Roots at the ends do not count.
  const Polynomial hump = polynomial({0, 1, -1});
  EXPECT_EQ(sign_on(hump, {}), 1);
  EXPECT_EQ(sign_on(-hump, {}), -1);
  EXPECT_EQ(sign_on(hump * hump, {}), 1);
  EXPECT_EQ(sign_on(Polynomial(), {}), 0);
  EXPECT_EQ(sign_on(polynomial({-3}), {}), -1);
}

TEST(Factors, ArePrimitivePartsDivisorsAndSquarefreePartsOfCgal) {
  Random random(28);
  const auto draw = [&](int degree, unsigned bits) {
    return random_polynomial(random, random.between(0, degree), bits);
  };
  const auto expect_divisor = [](const Polynomial& p, const Polynomial& q) {
    const Polynomial divisor = from_cgal(CGAL::gcd_up_to_constant_factor(to_cgal(p), to_cgal(q)));
    for (const auto& [a, b] : {std::pair(p, q), {q, p}}) {
      EXPECT_EQ(greatest_common_divisor(a, b), divisor.is_zero() ? divisor : normal(divisor));
    }
  };
  // Some are zero or constants; some lose their leading coefficients, or all, modulo 2^31 − 1, or
  // gain a common root.
  const Polynomial zero, shared = polynomial({-1, 2}), other = polynomial({5, 7}),
                         prime = polynomial({2147483647}), line = polynomial({0, 1}),
                         loses = prime * line + polynomial({1});
  for (const auto& [p, q] : {std::pair(zero, polynomial({4, -6})),
                             {zero, zero},
                             {shared, polynomial({2})},
                             {polynomial({-6}), polynomial({4})},
                             {shared * loses, shared * loses * other},
                             {loses * shared, loses * other},
                             {loses, other},
                             {shared * prime, shared * other},
                             {line, line + prime}}) {
    expect_divisor(p, q);
  }
  for (int round = 0; round < 500; ++round) {
    const Polynomial common = draw(4, 30), p = common * draw(4, 30);
    expect_divisor(p, common * draw(4, 30));
    EXPECT_EQ(primitive_part(p * polynomial({-60})), normal(p));
    const Polynomial a = draw(3, 12), b = draw(3, 12), product = a * b * b;
    EXPECT_EQ(squarefree_part(product),
              normal(from_cgal(CGAL::make_square_free(to_cgal(product)))));
    const Polynomial divided = normal(a);
    EXPECT_EQ(exact_quotient(b * divided, divided), b);
    if (divided.degree() > 0) {
      EXPECT_EQ(exact_quotient(b * -divided, -divided), b);
    }
  }
  EXPECT_EQ(quotient_if_exact(line + prime, line), std::nullopt);
  EXPECT_EQ(exact_quotient(other, polynomial({-1})), -other);
  EXPECT_TRUE(exact_quotient(zero, other).is_zero());
}

// ---- Roots --------------------------------------------------------------------------------------

/// A root in [0,1], and CGAL's.
struct Known {
  AlgebraicNumber number;
  CgalRoot expected;

  /// The sign of the difference to a rational number.
  [[nodiscard]] int minus(const Rational& x) const {
    return static_cast<int>(Kernel().compare_1_object()(expected, CGAL::Gmpq(x.get_mpq_t())));
  }
  /// True if these numbers, as the ends of an interval, are this one or enclose it strictly.
  [[nodiscard]] bool is_within(const Rational& lower, const Rational& upper) const {
    if (lower == upper) return minus(lower) == 0;
    return minus(lower) > 0 && minus(upper) < 0;
  }
  [[nodiscard]] bool is_isolated() const {
    const auto [lower, upper] = number.interval();
    return is_within(lower, upper);
  }
};

/// Expects the double itself if the number is one, and its two neighbours if not.
void expect_tight(const Known& known) {
  const auto [lower, upper] = known.number.enclosure();
  EXPECT_TRUE(known.is_within(Rational(lower), Rational(upper))) << lower << ' ' << upper;
  EXPECT_TRUE(lower == upper || upper == std::nextafter(lower, HUGE_VAL)) << lower << ' ' << upper;
}

std::vector<Known> known_roots(const Polynomial& p) {
  const std::vector<AlgebraicNumber> roots = roots_in_unit_interval(p);
  std::vector<std::pair<CgalRoot, Kernel::Multiplicity_type>> expected;
  Kernel().solve_1_object()(to_cgal(p), CGAL::Gmpq(0), CGAL::Gmpq(1), std::back_inserter(expected));
  EXPECT_EQ(roots.size(), expected.size()) << p;
  std::vector<Known> result;
  for (std::size_t i = 0; i < std::min(roots.size(), expected.size()); ++i) {
    result.push_back({roots[i], expected[i].first});
    EXPECT_TRUE(result.back().is_isolated()) << p;
  }
  return result;
}

Rational fraction(long numerator, long denominator) { return Rational(numerator) / denominator; }

/// A polynomial whose one root ≥ 0 is the root of this degree of r.
Polynomial radical(const Rational& r, int degree) {
  return polynomial({r.get_den()}) * power(polynomial({0, 1}), degree) - polynomial({r.get_num()});
}

const Polynomial& without_real_roots() {
  static const Polynomial result = polynomial({1, 1, 1});
  return result;
}

/// The root of p, not yet known to be rational.
Known hidden(const Polynomial& p) { return known_roots(p * without_real_roots()).at(0); }

/// A product of factors with few roots, so that equal ones come from different factors, some of
/// them several times, and of some without a root in [0,1].
Polynomial random_product(Random& random) {
  Polynomial p(Integer(-random.between(1, 9)));
  for (int factors = random.between(1, 4); factors > 0; --factors) {
    const Rational r = fraction(random.between(0, 12), random.between(9, 12));
    p = p * power(radical(r, random.between(1, 3)), random.between(1, 3));
  }
  if (random.coin()) p = p * without_real_roots();
  if (random.coin()) p = p * (polynomial({1, 2}) * polynomial({-4, 3}));  // −1/2 and 4/3
  return p;
}

/// Polynomials with roots at the ends or just beyond them, none, or some close together.
std::vector<Polynomial> hard_polynomials() {
  std::vector<Polynomial> all;
  for (const int multiplicity : {1, 2, 3}) {
    all.push_back(power(polynomial({0, 1, -1}), multiplicity) * polynomial({-1, 3}));
  }
  const Rational just = power_of_two(-300);
  for (const Polynomial& p :
       {polynomial({1}), polynomial({-7}), factor(-just), factor(1 + just),
        factor(-just) * factor(1 + just), without_real_roots(), polynomial({1, 0, 1}),
        polynomial({-3, 0, 2}), polynomial({1, 3, 2}), factor(just) * factor(1 - just)}) {
    all.push_back(p);
  }
  // ((3t−1)² − ε²)((3t−2)² + δ²)(2t−5): two roots at 1/3 ± ε/3, and two that are not real near 2/3.
  for (const unsigned bits : {10U, 100U, 1000U, 5000U}) {
    const Integer whole = Integer(1) << bits;
    const auto pair = [&](long root, long sign) {
      return power(polynomial({-root * whole, 3 * whole}), 2) + polynomial({sign});
    };
    all.push_back(pair(1, -1) * pair(2, 1) * polynomial({-5, 2}));
  }
  // (3t−1)³ = ±ε²(3t−1) has three roots or one; so does the same equation about 1/2, a midpoint.
  const Integer whole = Integer(1) << 300U;
  for (const long n : {2L, 3L, 7L}) {
    const Polynomial p = polynomial({-whole, n * whole});
    for (const int sign : {1, -1}) all.push_back(p * (p * p + polynomial({sign})));
  }
  // (3t − 1)³ − 2^−300: one root, just above 1/3 + 2^−102, where the secant guesses badly.
  all.push_back(polynomial({whole}) * power(polynomial({-1, 3}), 3) - polynomial({1}));
  // Mignotte's polynomials t^n − 2(at − 1)²: two roots next to 1/a, about a^(−n/2) apart.
  for (int degree = 3; degree <= 6; ++degree) {
    for (const int a : {3, 100, 1001}) {
      all.push_back(power(polynomial({0, 1}), degree) -
                    polynomial({2}) * power(polynomial({-1, a}), 2));
    }
  }
  return all;
}

TEST(AlgebraicNumber, IsComparedEnclosedAndRefinedAsItsValue) {
  std::vector<Polynomial> polynomials = hard_polynomials();
  Random random(43);
  for (int round = 0; round < 100; ++round) polynomials.push_back(random_product(random));
  for (int round = 0; round < 300; ++round) {
    const Polynomial p = random_polynomial(random, random.between(1, 6), 12);
    polynomials.push_back(round % 3 == 0 ? p * p : p);
  }
  std::vector<Known> numbers;
  for (const Polynomial& p : polynomials) {
    std::ranges::move(known_roots(p), std::back_inserter(numbers));
  }
  EXPECT_GT(numbers.size(), 280U);
  for (Known& known : numbers) {
    AlgebraicNumber& number = known.number;
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
      EXPECT_TRUE(known.is_isolated());
      Known other = known;
      other.number.refine_to_level(static_cast<unsigned long>(level));
      const auto [below, above] = other.number.interval();
      EXPECT_LE(Rational(above - below), power_of_two(-level));
      EXPECT_TRUE(other.is_isolated());
      EXPECT_TRUE(before.lower <= lower && upper <= before.upper);
      if (!number.rational()) {
        EXPECT_EQ(sign_at(number.polynomial(), lower) * sign_at(number.polynomial(), upper), -1);
      }
    }
  }
}

TEST(AlgebraicNumber, TakesAnyPositiveWidthAndNoOtherAndNoZeroPolynomial) {
  EXPECT_THROW(static_cast<void>(roots_in_unit_interval(Polynomial())), std::invalid_argument);
  for (AlgebraicNumber number :
       {hidden(radical(fraction(1, 2), 2)).number, AlgebraicNumber(Rational(1, 3))}) {
    number.refine(1);
    number.refine(Rational("123456789123456789/7"));
    number.refine(fraction(1, 3));
    EXPECT_TRUE(number.interval().upper - number.interval().lower <= fraction(1, 3));
    EXPECT_THROW(number.refine(0), std::invalid_argument);
    EXPECT_THROW(number.refine(-1), std::invalid_argument);
    EXPECT_THROW(number.refine(-power_of_two(-100)), std::invalid_argument);
  }
}

TEST(AlgebraicNumber, RecognisesEveryDyadicNumber) {
  for (const int level : {1, 2, 3, 5, 10, 53, 64, 200, 1074}) {
    for (const Rational& value :
         {Rational(power_of_two(-level)), Rational(1 - power_of_two(-level))}) {
      AlgebraicNumber number = hidden(factor(value)).number;
      number.refine_to_level(static_cast<unsigned long>(level) + 2);
      EXPECT_EQ(number.rational(), value) << level;
    }
  }
}

/// Polynomials p and q: they share a factor, q is almost a multiple of p, or both.
TEST(AlgebraicNumber, HasSignsAtRootsThatAreSharedOrAlmostShared) {
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
    for (auto& [number, expected] : known_roots(p)) {
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
TEST(AlgebraicNumber, IsComparedWithOthers) {
  Random random(53);
  std::vector<Known> numbers;
  const auto take = [&](const Polynomial& p) {
    std::ranges::move(known_roots(p), std::back_inserter(numbers));
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

// ---- Quotients ----------------------------------------------------------------------------------

TEST(EncloseQuotient, WaitsForADenominatorToShowItsSign) {
  // The denominator is ±1 at α but vanishes 2^−300 from it.
  const Rational r = fraction(1, 2);
  const AlgebraicNumber alpha = hidden(radical(r, 2)).number;
  const Polynomial large = polynomial({Integer(1) << 300}) * radical(r, 2);
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
