#include <gtest/gtest.h>

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "exact/algebra/algebraic_number.hpp"
#include "tests/support/properties.hpp"

// Algebraic numbers by their laws: known roots of products, the order, and signs.

namespace touchstone::exact::algebraic_number_properties_test {
namespace {

using tests::expect_property;
using Numbers = std::vector<std::int64_t>;
/// Numerator and denominator of a root, to be made one.
using Fraction = std::pair<std::int16_t, std::uint16_t>;

Rational rational(const Fraction& fraction) {
  Rational number(fraction.first, fraction.second + 1);
  number.canonicalize();
  return number;
}

Polynomial linear(const Rational& root) {
  return Polynomial(Integer(-root.get_num()), root.get_den());
}

/// Up to six coefficients, as they come.
Polynomial polynomial(const Numbers& numbers) {
  std::vector<Integer> coefficients;
  for (std::size_t i = 0; i < numbers.size() && i < 6; ++i) {
    coefficients.emplace_back(static_cast<long>(numbers[i]));
  }
  if (coefficients.empty()) coefficients.emplace_back(0);
  return Polynomial(coefficients);
}

/// p(1 − t).
Polynomial reversed(const Polynomial& p) {
  const Polynomial flip(Integer(1), Integer(-1));
  Polynomial result;
  for (std::size_t i = p.degree() + 1; i-- > 0;) result = result * flip + Polynomial(p[i]);
  return result;
}

/// t² − a/b, irrational unless it is the square of a rational.
Polynomial square_root_of(const Rational& square) {
  return Polynomial(Integer(-square.get_num()), Integer(0), square.get_den());
}

std::vector<AlgebraicNumber> roots_of_all(const std::vector<Numbers>& all) {
  std::vector<AlgebraicNumber> roots;
  for (const Numbers& numbers : all) {
    const Polynomial p = polynomial(numbers);
    if (p.is_zero()) continue;
    for (AlgebraicNumber& root : roots_in_unit_interval(p)) roots.push_back(std::move(root));
    if (roots.size() >= 5) break;
  }
  while (roots.size() > 5) roots.pop_back();
  return roots;
}

TEST(AlgebraicNumberProperties, ProductsOfLinearFactorsHaveTheirRoots) {
  expect_property(1, 250, [](const std::vector<Fraction>& fractions) {
    Polynomial product(Integer(1));
    std::set<Rational> expected;
    for (std::size_t i = 0; i < fractions.size() && i < 7; ++i) {
      const Rational root = rational(fractions[i]);
      product = product * linear(root);
      if (root >= 0 && root <= 1) expected.insert(root);
    }
    const std::vector<AlgebraicNumber> roots = roots_in_unit_interval(product);
    RC_ASSERT(roots.size() == expected.size());
    RC_ASSERT(std::equal(roots.begin(), roots.end(), expected.begin(), expected.end()));
  });
}

/// Square roots of rationals, which a rational comparison of squares puts in order.
TEST(AlgebraicNumberProperties, ProductsOfQuadraticFactorsHaveTheirRootsInOrder) {
  expect_property(2, 250, [](const std::vector<Fraction>& fractions) {
    Polynomial product(Integer(1));
    std::set<Rational> squares;
    for (std::size_t i = 0; i < fractions.size() && i < 4; ++i) {
      const Rational square = rational(fractions[i]);
      product = product * square_root_of(square);
      if (square >= 0 && square <= 1) squares.insert(square);
    }
    std::vector<AlgebraicNumber> roots = roots_in_unit_interval(product);
    RC_ASSERT(roots.size() == squares.size());
    std::size_t i = 0;
    for (const Rational& square : squares) {
      RC_ASSERT(roots[i].is_root_of(square_root_of(square)));
      const DoubleInterval bounds = roots[i].enclosure();
      RC_ASSERT(Rational(bounds.lower) * bounds.lower <= square);
      RC_ASSERT(Rational(bounds.upper) * bounds.upper >= square);
      ++i;
    }
  });
}

TEST(AlgebraicNumberProperties, MirroringReversesTheRoots) {
  expect_property(3, 250, [](const Numbers& numbers) {
    const Polynomial p = polynomial(numbers);
    RC_PRE(!p.is_zero());
    const std::vector<AlgebraicNumber> roots = roots_in_unit_interval(p);
    const std::vector<AlgebraicNumber> mirrored = roots_in_unit_interval(reversed(p));
    RC_ASSERT(roots.size() == mirrored.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const AlgebraicNumber& other = mirrored[roots.size() - 1 - i];
      RC_ASSERT(other.is_root_of(reversed(p)));
      // 1 − α is within the mirrored enclosure of α.
      const RationalInterval bounds = roots[i].interval();
      RC_ASSERT(other >= Rational(1 - bounds.upper));
      RC_ASSERT(other <= Rational(1 - bounds.lower));
    }
  });
}

TEST(AlgebraicNumberProperties, AreTotallyOrdered) {
  expect_property(4, 80, [](const std::vector<Numbers>& all) {
    const std::vector<AlgebraicNumber> roots = roots_of_all(all);
    for (const AlgebraicNumber& a : roots) {
      RC_ASSERT(a == a);
      for (const AlgebraicNumber& b : roots) {
        RC_ASSERT((a <=> b) == (0 <=> (b <=> a)));
        // Disjoint enclosures tell the order too.
        if (a.enclosure().upper < b.enclosure().lower) RC_ASSERT(a < b);
        for (const AlgebraicNumber& c : roots) {
          if (a <= b && b <= c) RC_ASSERT(a <= c);
        }
      }
    }
  });
}

/// q(α) q'(α) has the product of the signs, and what vanishes at α adds nothing.
TEST(AlgebraicNumberProperties, SignsAreThoseOfARing) {
  expect_property(5, 200, [](const Numbers& of_root, const Numbers& a, const Numbers& b) {
    const Polynomial p = polynomial(of_root), q = polynomial(a), r = polynomial(b);
    RC_PRE(!p.is_zero());
    for (AlgebraicNumber& root : roots_in_unit_interval(p)) {
      const int sign = root.sign_of(q);
      RC_ASSERT(root.sign_of(p) == 0);
      RC_ASSERT(root.sign_of(q * r) == sign * root.sign_of(r));
      RC_ASSERT(root.sign_of(q + p * r) == sign);
      RC_ASSERT(root.sign_of(-q) == -sign);
      RC_ASSERT(root.is_root_of(q) == (sign == 0));
    }
  });
}

TEST(AlgebraicNumberProperties, RefiningChangesNothingButTheWidth) {
  expect_property(6, 200, [](const Numbers& numbers, std::uint8_t level) {
    const Polynomial p = polynomial(numbers);
    RC_PRE(!p.is_zero());
    for (const AlgebraicNumber& root : roots_in_unit_interval(p)) {
      AlgebraicNumber refined = root;
      refined.refine_to_level(level);
      RC_ASSERT(refined == root);
      RC_ASSERT(refined.enclosure() == root.enclosure());
      const RationalInterval before = root.interval(), after = refined.interval();
      RC_ASSERT(before.lower <= after.lower);
      RC_ASSERT(after.upper <= before.upper);
      RC_ASSERT(Rational(after.upper - after.lower) <= power_of_two(-long{level}));
    }
  });
}

}  // namespace
}  // namespace touchstone::exact::algebraic_number_properties_test
