#include "exact/algebra/polynomial.hpp"

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

/// Σ c_j (1−y)^(n−j) y^j.
Rational bernstein_value(const Coefficients& c, const Rational& y) {
  Rational sum = 0;
  for (std::size_t j = 0; j < c.size(); ++j) {
    Rational term = c[j];
    for (std::size_t i = 0; i < j; ++i) term *= y;
    for (std::size_t i = j + 1; i < c.size(); ++i) term *= 1 - y;
    sum += term;
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

/// Remainder of p under division by q over the rationals, by long division: coefficients of
/// degrees 0 to deg q − 1.
std::vector<Rational> rational_remainder(const Polynomial& p, const Polynomial& q) {
  std::vector<Rational> rest(p.coefficients().begin(), p.coefficients().end());
  const Coefficients& divisor = q.coefficients();
  const std::size_t n = divisor.size() - 1;
  for (std::size_t i = rest.size(); i-- > n;) {
    const Rational ratio = rest[i] / divisor[n];
    for (std::size_t j = 0; j <= n; ++j) rest[i - n + j] -= ratio * divisor[j];
  }
  rest.resize(n);
  return rest;
}

bool divides(const Polynomial& q, const Polynomial& p) {
  if (q.degree() == 0) return true;
  return std::ranges::all_of(rational_remainder(p, q),
                             [](const Rational& c) { return sgn(c) == 0; });
}

/// True if the content is 1 and the leading coefficient positive.
bool is_normal(const Polynomial& p) {
  Integer content = 0;
  for (const Integer& c : p.coefficients()) content = gcd(content, c);
  return content == 1 && sgn(p.leading()) > 0;
}

/// The normal form of a polynomial ≠ 0, without the functions under test.
Polynomial normal(const Polynomial& p) {
  Integer content = 0;
  for (const Integer& c : p.coefficients()) content = gcd(content, c);
  if (sgn(p.leading()) < 0) content = -content;
  Coefficients c = p.coefficients();
  for (Integer& entry : c) entry /= content;
  return polynomial(c);
}

TEST(Polynomial, PrintsItsTerms) {
  const auto text = [](const Polynomial& p) {
    std::ostringstream out;
    out << p;
    return out.str();
  };
  EXPECT_EQ(text(polynomial({5, -1, 3})), "3 t^2 - t + 5");
  EXPECT_EQ(text(polynomial({0, 1, 0, -1})), "-t^3 + t");
  EXPECT_EQ(text(polynomial({-1})), "-1");
  EXPECT_EQ(text(Polynomial()), "0");
}

TEST(Polynomial, HasNoLeadingZeros) {
  EXPECT_EQ(polynomial({1, 2, 0, 0}), polynomial({1, 2}));
  EXPECT_EQ(polynomial({1, 2, 0, 0}).degree(), 1U);
  EXPECT_EQ(polynomial({}), Polynomial());
  EXPECT_TRUE((polynomial({1, 2}) - polynomial({1, 2})).is_zero());
  EXPECT_EQ((polynomial({1, 2, 3}) - polynomial({0, 0, 3})).degree(), 1U);
}

TEST(Polynomial, HasADerivative) {
  EXPECT_EQ(derivative(polynomial({5, -1, 3})), polynomial({-1, 6}));
  EXPECT_TRUE(derivative(polynomial({7})).is_zero());
}

/// Arithmetic on polynomials agrees with arithmetic on their values.
TEST(Polynomial, AddsMultipliesAndDerivesAsValuesDo) {
  Random random(20);
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
  }
}

TEST(DyadicCell, HasItsEnds) {
  EXPECT_EQ(DyadicCell{}.lower(), 0);
  EXPECT_EQ(DyadicCell{}.upper(), 1);
  const DyadicCell cell{.index = 6, .level = 3};
  EXPECT_EQ(cell.lower(), Rational(3, 4));
  EXPECT_EQ(cell.upper(), Rational(7, 8));
  EXPECT_EQ((DyadicCell{.index = -1, .level = 1}.lower()), Rational(-1, 2));
  EXPECT_EQ((DyadicCell{.index = 0, .level = 2000}.upper()), power_of_two(-2000));
}

TEST(SignAt, IsTheSignOfTheValue) {
  Random random(21);
  for (int round = 0; round < 500; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 7), 40);
    const Rational x = random_rational(random, 20);
    EXPECT_EQ(sign_at(p, x), sgn(value(p, x)));
    EXPECT_EQ(sign_at(p * factor(x), x), 0);
  }
  EXPECT_EQ(sign_at(Polynomial(Integer(0)), Rational(3, 7)), 0);
}

TEST(SignAt, SeesAValueOfOnePartInTwoToTheThousand) {
  const Rational root(1, 3), x = root + power_of_two(-1000);
  EXPECT_EQ(sign_at(factor(root), x), 1);
  EXPECT_EQ(sign_at(factor(root), root - power_of_two(-1000)), -1);
  EXPECT_EQ(sign_at(power(factor(root), 2), x), 1);
}

TEST(LocalCoefficients, AreThePolynomialSeenFromTheCell) {
  Random random(22);
  for (int round = 0; round < 300; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 6), 50);
    const DyadicCell cell = random_cell(random, 40);
    const Coefficients a = local_coefficients(p, cell);
    ASSERT_EQ(a.size(), p.degree() + 1);
    const Rational scale = power_of_two(static_cast<long>(cell.level * p.degree()));
    for (std::size_t y = 0; y <= p.degree(); ++y) {
      const Rational expected = scale * value(p, inside(cell, y));
      Rational sum = 0, term = 1;
      for (std::size_t i = 0; i < a.size(); ++i, term *= y) sum += a[i] * term;
      EXPECT_EQ(sum, expected);
    }
  }
}

TEST(BernsteinForm, IsThePolynomialTimesOnePositiveNumber) {
  Random random(23);
  for (int round = 0; round < 300; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 6), 50);
    const DyadicCell cell = random_cell(random, 40);
    const Coefficients c = bernstein_form(p, cell);
    ASSERT_EQ(c.size(), p.degree() + 1);
    // Two polynomials of degree n with a common ratio at n+1 points have it at all points.
    Rational ratio = 0;
    for (std::size_t k = 0; k <= p.degree(); ++k) {
      const Rational y = Rational(k) / (p.degree() + 1);
      const Rational expected = value(p, inside(cell, y)), form = bernstein_value(c, y);
      EXPECT_EQ(sgn(form), sgn(expected));
      if (sgn(expected) == 0) continue;
      if (sgn(ratio) == 0) ratio = form / expected;
      EXPECT_EQ(Rational(form / expected), ratio);
    }
    EXPECT_GT(ratio, 0);
  }
}

TEST(SignChanges, LeavesZerosOut) {
  const std::vector<std::pair<Coefficients, int>> cases{
      {{}, 0},         {{0}, 0},           {{5}, 0},
      {{0, 0, 0}, 0},  {{1, 2, 3}, 0},     {{-1, -2}, 0},
      {{1, -1}, 1},    {{-1, 1}, 1},       {{1, 0, 1}, 0},
      {{1, 0, -1}, 1}, {{0, 1, 0}, 0},     {{0, -1, 0, 0, 2, 0}, 1},
      {{1, -1, 1}, 2}, {{-3, 0, 2, 2}, 1}, {{1, -1, 0, -1, 1, -1}, 3}};
  for (const auto& [coefficients, expected] : cases) {
    EXPECT_EQ(sign_changes(coefficients), expected);
  }
}

/// A polynomial with known roots, which has no other real root.
struct Factored {
  Polynomial p;
  std::vector<Rational> roots;  // each repeated by its multiplicity
};

Factored random_factored(Random& random) {
  Factored result{Polynomial(random.integer<Integer>(8) * 2 + 1), {}};
  for (int factors = random.between(1, 4); factors > 0; --factors) {
    const Rational root = random_rational(random, 5) / 8;
    const int multiplicity = random.between(1, 3);
    result.p = result.p * (power(factor(root), multiplicity));
    result.roots.insert(result.roots.end(), static_cast<std::size_t>(multiplicity), root);
  }
  for (int pairs = random.between(0, 2); pairs > 0; --pairs) {
    // (at − b)² + c² with c ≠ 0.
    const Polynomial real = random_polynomial(random, 1, 4);
    result.p = result.p * (real * real + Polynomial(Integer(random.between(1, 9))));
  }
  return result;
}

int roots_inside(const Factored& f, const DyadicCell& cell) {
  return static_cast<int>(std::ranges::count_if(
      f.roots, [&](const Rational& root) { return cell.lower() < root && root < cell.upper(); }));
}

TEST(BernsteinForm, SignChangesBoundTheRootsAndHaveTheirParity) {
  Random random(24);
  int cells_with_roots = 0;
  for (int round = 0; round < 1000; ++round) {
    const Factored f = random_factored(random);
    const DyadicCell cell = random_cell(random, 4);
    const int changes = sign_changes(bernstein_form(f.p, cell)), roots = roots_inside(f, cell);
    EXPECT_GE(changes, roots);
    EXPECT_EQ((changes - roots) % 2, 0);
    cells_with_roots += roots > 0 ? 1 : 0;
  }
  EXPECT_GT(cells_with_roots, 100);
}

TEST(SignOn, IsNeverWrong) {
  Random random(25);
  int proofs = 0;
  for (int round = 0; round < 1000; ++round) {
    const Factored f = random_factored(random);
    const DyadicCell cell = random_cell(random, 5);
    const int sign = sign_on(f.p, cell);
    if (sign == 0) continue;
    ++proofs;
    EXPECT_EQ(roots_inside(f, cell), 0);
    for (int k = 1; k < 16; ++k) EXPECT_EQ(sgn(value(f.p, inside(cell, Rational(k) / 16))), sign);
  }
  EXPECT_GT(proofs, 100);
}

TEST(SignOn, ProvesTheSignOnceTheCellIsSmall) {
  Random random(26);
  for (int round = 0; round < 300; ++round) {
    const Factored f = random_factored(random);
    const DyadicCell cell{random.integer<Integer>(200), 200};
    // Roots have denominators below 2^9: at most one end of a cell of level 200 is a root.
    if (roots_inside(f, cell) == 0) {
      EXPECT_EQ(sign_on(f.p, cell), sgn(value(f.p, inside(cell, Rational(1, 2)))));
    } else {
      EXPECT_EQ(sign_on(f.p * f.p, cell), 0);
    }
  }
}

TEST(SignOn, RootsAtTheEndsDoNotCount) {
  const Polynomial hump = polynomial({0, 1, -1});  // t(1−t)
  EXPECT_EQ(sign_on(hump, {}), 1);
  EXPECT_EQ(sign_on(-hump, {}), -1);
  EXPECT_EQ(sign_on(hump * hump, {}), 1);
}

TEST(SignOn, ProvesNothingOfZeroAndOfASignChange) {
  EXPECT_EQ(sign_on(Polynomial(Integer(0)), {}), 0);
  EXPECT_EQ(sign_on(polynomial({-1, 2}), {}), 0);
  EXPECT_EQ(sign_on(power(polynomial({-1, 3}), 2), {}), 0);
  EXPECT_EQ(sign_on(Polynomial(Integer(-3)), {}), -1);
}

TEST(PrimitivePart, DividesByTheContentAndFixesTheSign) {
  EXPECT_EQ(primitive_part(polynomial({6, -9, -3})), polynomial({-2, 3, 1}));
  EXPECT_EQ(primitive_part(polynomial({2, 4})), polynomial({1, 2}));
  EXPECT_EQ(primitive_part(polynomial({-5})), polynomial({1}));
  EXPECT_EQ(primitive_part(polynomial({0, 0, -7})), polynomial({0, 0, 1}));
  EXPECT_EQ(primitive_part(polynomial({3, 2})), polynomial({3, 2}));
  EXPECT_TRUE(primitive_part(Polynomial(Integer(0))).is_zero());
  Random random(27);
  for (int round = 0; round < 200; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 6), 10);
    EXPECT_EQ(primitive_part(p * Polynomial(Integer(-60))), normal(p));
  }
}

TEST(GreatestCommonDivisor, AgreesWithCgal) {
  Random random(28);
  for (int round = 0; round < 500; ++round) {
    const Polynomial common = random_polynomial(random, random.between(0, 4), 30);
    const Polynomial p = common * random_polynomial(random, random.between(0, 4), 30),
                     q = common * random_polynomial(random, random.between(0, 4), 30);
    const Polynomial expected =
        normal(from_cgal(CGAL::gcd_up_to_constant_factor(to_cgal(p), to_cgal(q))));
    EXPECT_EQ(greatest_common_divisor(p, q), expected);
    EXPECT_EQ(greatest_common_divisor(q, p), expected);
  }
}

TEST(GreatestCommonDivisor, FindsTheSharedPowersOfKnownFactors) {
  Random random(29);
  const std::array factors{polynomial({-1, 3}), polynomial({-1, 0, 2}), polynomial({1, 1, 1}),
                           polynomial({0, 1}), polynomial({-3, 7, 0, 5})};
  for (int round = 0; round < 300; ++round) {
    Polynomial p(Integer(random.between(1, 50))), q(Integer(-random.between(1, 50))),
        expected(Integer(1));
    for (const Polynomial& f : factors) {
      const int in_p = random.between(0, 3), in_q = random.between(0, 3);
      p = p * (power(f, in_p));
      q = q * (power(f, in_q));
      expected = expected * (power(f, std::min(in_p, in_q)));
    }
    EXPECT_EQ(greatest_common_divisor(p, q), expected);
  }
}

TEST(GreatestCommonDivisor, OfZeroAndOfConstants) {
  const Polynomial zero(Integer(0)), p = polynomial({4, -6});
  EXPECT_EQ(greatest_common_divisor(zero, p), polynomial({-2, 3}));
  EXPECT_EQ(greatest_common_divisor(p, zero), polynomial({-2, 3}));
  EXPECT_TRUE(greatest_common_divisor(zero, zero).is_zero());
  EXPECT_EQ(greatest_common_divisor(p, polynomial({2})), polynomial({1}));
  EXPECT_EQ(greatest_common_divisor(polynomial({-6}), polynomial({4})), polynomial({1}));
}

TEST(GreatestCommonDivisor, IsRightWhereItsPrimeFails) {
  // These lose their leading coefficients, or all, modulo 2^31 − 1, or gain a common root.
  const Integer prime = 2147483647;
  const Polynomial loses_degree = polynomial({1, prime});
  const Polynomial shared = polynomial({-1, 2}), other = polynomial({5, 7});
  EXPECT_EQ(greatest_common_divisor(shared * loses_degree, shared * loses_degree * other),
            shared * loses_degree);
  EXPECT_EQ(greatest_common_divisor(loses_degree * shared, loses_degree * other), loses_degree);
  EXPECT_EQ(greatest_common_divisor(loses_degree, other), polynomial({1}));
  EXPECT_EQ(greatest_common_divisor(shared * polynomial({prime}), shared * other), shared);
  EXPECT_EQ(greatest_common_divisor(polynomial({0, 1}), polynomial({prime, 1})), polynomial({1}));
}

TEST(SquarefreePart, ReducesHighMultiplicitiesToOne) {
  Random random(30);
  const std::array factors{polynomial({-1, 3}), polynomial({-1, 0, 2}), polynomial({1, 1, 1}),
                           polynomial({0, 1}), polynomial({-1, 1})};
  for (int round = 0; round < 200; ++round) {
    Polynomial p(Integer(-random.between(1, 50))), expected(Integer(1));
    for (const Polynomial& f : factors) {
      const int multiplicity = random.between(0, 5);
      p = p * (power(f, multiplicity));
      if (multiplicity > 0) expected = expected * (f);
    }
    EXPECT_EQ(squarefree_part(p), expected);
  }
}

TEST(SquarefreePart, OfRandomPolynomialsAgreesWithCgal) {
  Random random(31);
  for (int round = 0; round < 200; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 3), 12),
                     q = random_polynomial(random, random.between(0, 3), 12);
    const Polynomial product = p * q * q;
    EXPECT_EQ(squarefree_part(product),
              normal(from_cgal(CGAL::make_square_free(to_cgal(product)))));
  }
}

TEST(SquarefreePart, KeepsWhatIsSquarefree) {
  EXPECT_EQ(squarefree_part(polynomial({-8})), polynomial({1}));
  EXPECT_EQ(squarefree_part(polynomial({4, -2})), polynomial({-2, 1}));
  EXPECT_EQ(squarefree_part(polynomial({-2, 0, 4})), polynomial({-1, 0, 2}));
}

TEST(PseudoRemainder, IsTheRemainderTimesAPositiveNumber) {
  Random random(32);
  for (int round = 0; round < 500; ++round) {
    const Polynomial p = random_polynomial(random, random.between(0, 7), 30),
                     q = random_polynomial(random, random.between(1, 5), 30);
    const std::vector<Rational> expected = rational_remainder(p, q);
    const Polynomial remainder = pseudo_remainder(p, q);
    Coefficients actual = remainder.coefficients();
    ASSERT_LE(actual.size(), expected.size());
    actual.resize(expected.size());
    Rational scale = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(sgn(actual[i]), sgn(expected[i]));
      if (sgn(expected[i]) == 0) continue;
      if (sgn(scale) == 0) scale = actual[i] / expected[i];
      EXPECT_EQ(Rational(actual[i] / expected[i]), scale);
    }
  }
}

TEST(PseudoRemainder, OfAMultipleIsZero) {
  Random random(33);
  for (int round = 0; round < 100; ++round) {
    const Polynomial q = random_polynomial(random, random.between(1, 5), 30);
    EXPECT_TRUE(pseudo_remainder(q * random_polynomial(random, 3, 30), q).is_zero());
  }
  EXPECT_TRUE(pseudo_remainder(Polynomial(Integer(0)), polynomial({1, 1})).is_zero());
}

TEST(ExactQuotient, UndoesMultiplication) {
  Random random(34);
  for (int round = 0; round < 300; ++round) {
    const Polynomial q = normal(random_polynomial(random, random.between(0, 5), 30)),
                     expected = random_polynomial(random, random.between(0, 5), 30);
    ASSERT_TRUE(is_normal(q));
    EXPECT_EQ(exact_quotient(expected * q, q), expected);
    if (q.degree() > 0) {
      EXPECT_EQ(exact_quotient(expected * -q, -q), expected);
    }
    EXPECT_TRUE(divides(q, expected * q));
  }
  EXPECT_TRUE(exact_quotient(Polynomial(Integer(0)), polynomial({1, 1})).is_zero());
}

TEST(ExactQuotient, DividesByBothUnits) {
  const Polynomial p = polynomial({3, 0, -5});
  EXPECT_EQ(exact_quotient(p, polynomial({1})), p);
  EXPECT_EQ(exact_quotient(p, polynomial({-1})), -p);
}

}  // namespace
}  // namespace touchstone::exact::polynomial_test
