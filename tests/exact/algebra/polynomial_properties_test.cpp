#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exact/algebra/polynomial.hpp"
#include "tests/support/properties.hpp"

// The algebra of exact/algebra/polynomial.hpp by its laws: no second implementation is asked.

namespace touchstone::exact::polynomial_properties_test {
namespace {

using tests::expect_property;
using Numbers = std::vector<std::int64_t>;

Integer integer(std::int64_t number) { return {static_cast<long>(number)}; }

/// The first of the numbers as coefficients; every third one is squared, so that sizes differ.
Polynomial polynomial(const Numbers& numbers, std::size_t most = 6) {
  std::vector<Integer> coefficients{0};
  for (std::size_t i = 0; i < numbers.size() && i < most; ++i) {
    const Integer number = integer(numbers[i]);
    if (i == 0) coefficients.clear();
    coefficients.push_back(i % 3 == 2 ? Integer(number * number * number) : number);
  }
  return Polynomial(coefficients);
}

/// A rational number, of either sign, often a small one.
Rational rational(std::int64_t numerator, std::uint32_t denominator) {
  Rational number(integer(numerator), Integer(static_cast<unsigned long>(denominator)) + 1);
  number.canonicalize();
  return number;
}

/// p(x), by Horner's rule.
Rational value(const Polynomial& p, const Rational& x) {
  Rational result = 0;
  for (std::size_t i = p.degree() + 1; i-- > 0;) result = result * x + p[i];
  return result;
}

DyadicCell cell(std::uint16_t index, std::uint8_t level) { return {index, level % 20U}; }

TEST(PolynomialProperties, FormARing) {
  expect_property(1, 400, [](const Numbers& a, const Numbers& b, const Numbers& c) {
    const Polynomial p = polynomial(a), q = polynomial(b), r = polynomial(c);
    const Polynomial zero, one{Integer(1)};
    RC_ASSERT(p + q == q + p);
    RC_ASSERT((p + q) + r == p + (q + r));
    RC_ASSERT(p + zero == p);
    RC_ASSERT(p + (-p) == zero);
    RC_ASSERT(p - q == p + (-q));
    RC_ASSERT(p * q == q * p);
    RC_ASSERT((p * q) * r == p * (q * r));
    RC_ASSERT(p * one == p);
    RC_ASSERT(p * (q + r) == p * q + p * r);
  });
}

TEST(PolynomialProperties, EvaluationIsAHomomorphism) {
  expect_property(2, 400, [](const Numbers& a, const Numbers& b, std::int64_t n, std::uint32_t d) {
    const Polynomial p = polynomial(a), q = polynomial(b);
    const Rational x = rational(n, d);
    RC_ASSERT(value(p + q, x) == value(p, x) + value(q, x));
    RC_ASSERT(value(p - q, x) == value(p, x) - value(q, x));
    RC_ASSERT(value(p * q, x) == value(p, x) * value(q, x));
    RC_ASSERT(sign_at(p * q, x) == sign_at(p, x) * sign_at(q, x));
    RC_ASSERT(sign_at(p, x) == sgn(value(p, x)));
  });
}

TEST(PolynomialProperties, DerivativeIsADerivation) {
  expect_property(3, 400, [](const Numbers& a, const Numbers& b) {
    const Polynomial p = polynomial(a), q = polynomial(b);
    RC_ASSERT(derivative(p + q) == derivative(p) + derivative(q));
    RC_ASSERT(derivative(p * q) == derivative(p) * q + p * derivative(q));
  });
}

/// Seen from a cell, and from there from a cell of it, is seen from the smaller cell.
TEST(PolynomialProperties, CellsOfCellsAreCells) {
  expect_property(4, 300,
                  [](const Numbers& a, std::uint16_t index, std::uint8_t level, std::uint16_t inner,
                     std::uint8_t inner_level) {
                    const Polynomial p = polynomial(a);
                    const DyadicCell outer = cell(index, level), part = cell(inner, inner_level);
                    const Polynomial seen(local_coefficients(p, outer));
                    RC_PRE(seen.degree() == p.degree());
                    const DyadicCell both{outer.index * (Integer(1) << part.level) + part.index,
                                          outer.level + part.level};
                    RC_ASSERT(local_coefficients(seen, part) == local_coefficients(p, both));
                  });
}

TEST(PolynomialProperties, BernsteinFormsAddAndTellSignsAtBothEnds) {
  expect_property(5, 300, [](const Numbers& a, std::uint16_t index, std::uint8_t level) {
    const Polynomial p = polynomial(a);
    const DyadicCell where = cell(index, level);
    const std::vector<Integer> form = bernstein_form(p, where);
    RC_ASSERT(sgn(form.front()) == sign_at(p, where.lower()));
    RC_ASSERT(sgn(form.back()) == sign_at(p, where.upper()));
    const std::vector<Integer> opposite = bernstein_form(-p, where);
    for (std::size_t i = 0; i < form.size(); ++i) RC_ASSERT(opposite[i] == -form[i]);
    RC_ASSERT(sign_on(p, where) == -sign_on(-p, where));
  });
}

TEST(PolynomialProperties, DivisorsObeyTheirLaws) {
  expect_property(6, 200, [](const Numbers& a, const Numbers& b, const Numbers& c) {
    const Polynomial p = polynomial(a, 4), q = polynomial(b, 4), r = polynomial(c, 3);
    RC_PRE(!p.is_zero() && !q.is_zero() && !r.is_zero());
    const Polynomial g = greatest_common_divisor(p, q);
    RC_ASSERT(g == greatest_common_divisor(q, p));
    RC_ASSERT(g == greatest_common_divisor(p, q + p * r));
    RC_ASSERT(greatest_common_divisor(p * r, q * r) == primitive_part(g * r));
    RC_ASSERT(exact_quotient(p, g) * g == p);
    RC_ASSERT(greatest_common_divisor(exact_quotient(p, g), exact_quotient(q, g)).degree() == 0U);
    RC_ASSERT(exact_quotient(p * r, r) == p);
  });
}

TEST(PolynomialProperties, SquarefreePartForgetsMultiplicityOnly) {
  expect_property(7, 200, [](const Numbers& a, const Numbers& b) {
    const Polynomial p = polynomial(a, 4), q = polynomial(b, 3);
    RC_PRE(!p.is_zero() && !q.is_zero());
    const Polynomial once = squarefree_part(p * q);
    RC_ASSERT(squarefree_part(p * q * q * p * q) == once);
    RC_ASSERT(squarefree_part(once) == once);
    RC_ASSERT(greatest_common_divisor(once, derivative(once)).degree() == 0U);
  });
}

}  // namespace
}  // namespace touchstone::exact::polynomial_properties_test
