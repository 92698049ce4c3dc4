#include "touchstone/polynomial.hpp"

#include <CGAL/polynomial_utils.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/support/polynomials.hpp"
#include "tests/support/random.hpp"

namespace touchstone::exact::polynomial_test {
namespace {

using tests::factor;
using tests::polynomial;
using tests::power;
using tests::Random;
using tests::random_polynomial;
using Coefficients = std::vector<Integer>;

CGAL::Polynomial<Integer> to_cgal(const Polynomial& p) {
  return {p.coefficients().begin(), p.coefficients().end()};
}

Polynomial from_cgal(const CGAL::Polynomial<Integer>& p) {
  return polynomial({p.begin(), p.end()});
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

}  // namespace
}  // namespace touchstone::exact::polynomial_test
