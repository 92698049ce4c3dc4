#include "touchstone/polynomial.hpp"

#include <CGAL/polynomial_utils.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::exact::polynomial_test {
namespace {

using tests::Random;
using Coefficients = std::vector<Integer>;

/// Σ c_i t^i.
Polynomial polynomial(const Coefficients& c) { return Polynomial(c); }

CGAL::Polynomial<Integer> to_cgal(const Polynomial& p) {
  return {p.coefficients().begin(), p.coefficients().end()};
}

Polynomial from_cgal(const CGAL::Polynomial<Integer>& p) {
  return polynomial({p.begin(), p.end()});
}

Polynomial power(const Polynomial& p, int exponent) {
  Polynomial result(Integer(1));
  for (int i = 0; i < exponent; ++i) result = result * p;
  return result;
}

/// A primitive polynomial of degree 1 with this root.
Polynomial factor(const Rational& root) { return polynomial({-root.get_num(), root.get_den()}); }

/// A random polynomial of exactly this degree.
Polynomial random_polynomial(Random& random, int degree, unsigned bits) {
  Coefficients c;
  for (int i = 0; i <= degree; ++i) c.push_back(random.integer<Integer>(bits));
  if (sgn(c.back()) == 0) c.back() = 1;
  return polynomial(c);
}

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
  Coefficients c = p.coefficients();
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

TEST(DyadicCell, HasItsEnds) {
  EXPECT_EQ(DyadicCell{}.lower(), 0);
  EXPECT_EQ(DyadicCell{}.upper(), 1);
  EXPECT_EQ((DyadicCell{.index = 6, .level = 3}.lower()), Rational(3, 4));
  EXPECT_EQ((DyadicCell{.index = 6, .level = 3}.upper()), Rational(7, 8));
  EXPECT_EQ((DyadicCell{.index = -1, .level = 1}.lower()), Rational(-1, 2));
  EXPECT_EQ((DyadicCell{.index = 0, .level = 2000}.upper()), power_of_two(-2000));
}

/// Σ c_j (1−y)^(n−j) y^j.
Rational bernstein_value(const Coefficients& c, const Rational& y) {
  Polynomial sum;
  for (std::size_t j = 0; j < c.size(); ++j) {
    sum = sum + polynomial({c[j]}) * power(polynomial({0, 1}), static_cast<int>(j)) *
                    power(polynomial({1, -1}), static_cast<int>(c.size() - 1 - j));
  }
  return value(sum, y);
}

TEST(Cell, FormsAreThePolynomialSeenFromIt) {
  Random random(22);
  for (int round = 0; round < 300; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 6), 50);
    const DyadicCell cell = random_cell(random, 40);
    const Coefficients a = local_coefficients(p, cell), c = bernstein_form(p, cell);
    ASSERT_EQ(a.size(), p.degree() + 1);
    ASSERT_EQ(c.size(), p.degree() + 1);
    const Rational scale = power_of_two(static_cast<long>(cell.level * p.degree()));
    // Two polynomials of degree n with a common ratio at n+1 points have it at all points.
    Rational ratio = 0;
    for (std::size_t k = 0; k <= p.degree(); ++k) {
      const Rational y = Rational(k) / (p.degree() + 1), expected = value(p, inside(cell, y));
      EXPECT_EQ(value(polynomial(a), y), Rational(scale * expected));
      const Rational form = bernstein_value(c, y);
      EXPECT_EQ(sgn(form), sgn(expected));
      if (sgn(expected) == 0) continue;
      if (sgn(ratio) == 0) ratio = form / expected;
      EXPECT_EQ(Rational(form / expected), ratio);
    }
    EXPECT_GT(ratio, 0);
  }
}

TEST(SignChanges, LeaveZerosOut) {
  const std::vector<std::pair<Coefficients, int>> cases{
      {{}, 0},         {{0, 0}, 0},
      {{5}, 0},        {{1, 2, 3}, 0},
      {{-1, -2}, 0},   {{1, -1}, 1},
      {{1, 0, 1}, 0},  {{1, 0, -1}, 1},
      {{0, 1, 0}, 0},  {{0, -1, 0, 2}, 1},
      {{1, -1, 1}, 2}, {{-3, 0, 2, 2}, 1},
      {{-1, 1}, 1},    {{1, -1, 0, -1, 1, -1}, 3}};
  for (const auto& [coefficients, expected] : cases) {
    EXPECT_EQ(sign_changes(coefficients), expected);
  }
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
  for (int round = 0; round < 500; ++round) {
    const Polynomial common = draw(4, 30), p = common * draw(4, 30), q = common * draw(4, 30);
    const Polynomial divisor =
        normal(from_cgal(CGAL::gcd_up_to_constant_factor(to_cgal(p), to_cgal(q))));
    EXPECT_EQ(greatest_common_divisor(p, q), divisor);
    EXPECT_EQ(greatest_common_divisor(q, p), divisor);
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
  const Polynomial p = polynomial({3, 0, -5});
  EXPECT_EQ(exact_quotient(p, polynomial({1})), p);
  EXPECT_EQ(exact_quotient(p, polynomial({-1})), -p);
  EXPECT_TRUE(exact_quotient(Polynomial(), polynomial({1, 1})).is_zero());
}

TEST(Factors, HaveTheirKnownPowers) {
  Random random(29);
  const std::array factors{polynomial({-1, 3}), polynomial({-1, 0, 2}), polynomial({1, 1, 1}),
                           polynomial({0, 1}), polynomial({-3, 7, 0, 5})};
  for (int round = 0; round < 300; ++round) {
    Polynomial p(Integer(random.between(1, 50))), q(Integer(-random.between(1, 50))),
        divisor(Integer(1)), squarefree = divisor;
    for (const Polynomial& f : factors) {
      const int in_p = random.between(0, 3), in_q = random.between(0, 5);
      p = p * power(f, in_p);
      q = q * power(f, in_q);
      divisor = divisor * power(f, std::min(in_p, in_q));
      squarefree = squarefree * power(f, std::min(1, in_q));
    }
    EXPECT_EQ(greatest_common_divisor(p, q), divisor);
    EXPECT_EQ(squarefree_part(q), squarefree);
  }
}

TEST(GreatestCommonDivisor, OfZeroOfConstantsAndWhereItsPrimeFails) {
  // Some lose their leading coefficients, or all, modulo 2^31 − 1, or gain a common root.
  const Integer prime = 2147483647;
  const Polynomial zero, p = polynomial({4, -6}), one = polynomial({1}),
                         loses = polynomial({1, prime}), shared = polynomial({-1, 2}),
                         other = polynomial({5, 7});
  const std::vector<std::array<Polynomial, 3>> cases{
      {zero, p, polynomial({-2, 3})},
      {p, zero, polynomial({-2, 3})},
      {zero, zero, zero},
      {p, polynomial({2}), one},
      {polynomial({-6}), polynomial({4}), one},
      {shared * loses, shared * loses * other, shared * loses},
      {loses * shared, loses * other, loses},
      {loses, other, one},
      {shared * polynomial({prime}), shared * other, shared},
      {polynomial({0, 1}), polynomial({prime, 1}), one}};
  for (const auto& [a, b, expected] : cases) {
    EXPECT_EQ(greatest_common_divisor(a, b), expected) << a << ", " << b;
  }
}

TEST(PseudoRemainder, IsTheRemainderTimesAPositiveNumber) {
  Random random(32);
  for (int round = 0; round < 500; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 7), 30),
                     q = random_polynomial(random, random.between(1, 5), 30);
    // Long division over the rationals.
    std::vector<Rational> expected(p.coefficients().begin(), p.coefficients().end());
    for (std::size_t i = expected.size(); i-- > q.degree();) {
      const Rational ratio = expected[i] / q.leading();
      for (std::size_t j = 0; j <= q.degree(); ++j) {
        expected[i - q.degree() + j] -= ratio * q.coefficients()[j];
      }
    }
    expected.resize(q.degree());
    Coefficients actual = pseudo_remainder(p, q).coefficients();
    ASSERT_LE(actual.size(), expected.size());
    actual.resize(expected.size());
    Rational scale = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(sgn(actual[i]), sgn(expected[i]));
      if (sgn(expected[i]) == 0) continue;
      if (sgn(scale) == 0) scale = actual[i] / expected[i];
      EXPECT_EQ(Rational(actual[i] / expected[i]), scale);
    }
    EXPECT_TRUE(pseudo_remainder(p * q, q).is_zero());
  }
  EXPECT_TRUE(pseudo_remainder(Polynomial(), polynomial({1, 1})).is_zero());
}

}  // namespace
}  // namespace touchstone::exact::polynomial_test
