#include "exact/algebra/positivity.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::exact::positivity_test {
namespace {

using Outcome = BisectionProof::Outcome;

/// (den t − num)² + epsilon, with its least value at num/den.
Polynomial near_double_root(long num, long den, const Rational& epsilon) {
  const Polynomial factor(Integer(-num), Integer(den));
  std::vector<Integer> c = (factor * factor).coefficients();
  for (Integer& x : c) x *= epsilon.get_den();
  c.front() += epsilon.get_num();
  return Polynomial(c);
}

BisectionProof on_unit_interval(const Polynomial& p, unsigned long limit = bisection_limit) {
  return prove_positive(bernstein_coefficients(p, {0, 1}), limit);
}

TEST(BernsteinCoefficients, AreThoseOfTheInterval) {
  // t² on [1/2, 1] has the coefficients 1/4, 1/2, 1.
  const Polynomial square(Integer(0), Integer(0), Integer(1));
  const auto c = bernstein_coefficients(square, {Rational(1, 2), 1});
  EXPECT_EQ(c.at(1), 2 * c.at(0));
  EXPECT_EQ(c.at(2), 4 * c.at(0));
  EXPECT_GT(c.at(0), 0);
  // The form 1 (1−t)² + 2 (1−t) t + 1 t² is the constant 1.
  const auto constant = bernstein_coefficients({Integer(1), Integer(2), Integer(1)});
  EXPECT_EQ(constant, std::vector<Integer>(3, constant.front()));
}

TEST(BernsteinCoefficients, EndAtTheValuesAndSumToThePolynomial) {
  tests::Random random(11);
  for (int repetition = 0; repetition < 200; ++repetition) {
    std::vector<Integer> a(static_cast<std::size_t>(random.between(1, 6)));
    for (Integer& x : a) x = random.integer<Integer>(40);
    const Polynomial p(a);
    const Rational lower(random.between(1, 50), 101), upper(random.between(51, 100), 101);
    const auto c = bernstein_coefficients(p, {lower, upper});
    EXPECT_EQ(sgn(c.front()), sign_at(p, lower));
    EXPECT_EQ(sgn(c.back()), sign_at(p, upper));
    if (p.degree() != 1) continue;
    // A linear function keeps the ratio of its values at the ends.
    const Rational at_lower = p[0] + p[1] * lower, at_upper = p[0] + p[1] * upper;
    EXPECT_EQ(Rational(c.front()) * at_upper, Rational(c.back()) * at_lower);
  }
}

TEST(CommonSign, IsStrict) {
  EXPECT_EQ(common_sign({Integer(1), Integer(5)}), 1);
  EXPECT_EQ(common_sign({Integer(-1), Integer(-5)}), -1);
  EXPECT_EQ(common_sign({Integer(1), Integer(0), Integer(5)}), 0);
  EXPECT_EQ(common_sign({Integer(0)}), 0);
  EXPECT_EQ(common_sign({Integer(1), Integer(-1)}), 0);
}

TEST(ProvePositive, TakesNoBisectionWhereAllCoefficientsArePositive) {
  const BisectionProof proof = prove_positive({Integer(3), Integer(1), Integer(2)});
  EXPECT_EQ(proof.outcome, Outcome::positive);
  EXPECT_EQ(proof.depth, 0U);
}

TEST(ProvePositive, RefutesAtEndsAndInside) {
  EXPECT_EQ(prove_positive({Integer(0), Integer(1)}).outcome, Outcome::refuted);
  EXPECT_EQ(prove_positive({Integer(1), Integer(0)}).outcome, Outcome::refuted);
  // A double root at 1/2, found by the first bisection; one at 3/8; negative values near 1/3.
  EXPECT_EQ(on_unit_interval(near_double_root(1, 2, 0)).outcome, Outcome::refuted);
  EXPECT_EQ(on_unit_interval(near_double_root(3, 8, 0)).outcome, Outcome::refuted);
  EXPECT_EQ(on_unit_interval(near_double_root(1, 3, -power_of_two(-60))).outcome, Outcome::refuted);
}

TEST(ProvePositive, GoesAsDeepAsTheGapIsSmallAndSaysWhere) {
  EXPECT_EQ(on_unit_interval(near_double_root(1, 3, 0)).outcome, Outcome::too_deep);
  for (const long bits : {20L, 100L, 220L}) {
    const BisectionProof proof = on_unit_interval(near_double_root(1, 3, power_of_two(-bits)));
    ASSERT_EQ(proof.outcome, Outcome::positive) << bits;
    EXPECT_NEAR(static_cast<double>(proof.depth), static_cast<double>(bits) / 2, 4.0);
    const DyadicCell deepest{proof.index, proof.depth};
    const Rational width = deepest.upper() - deepest.lower();
    EXPECT_LE(abs(deepest.lower() - Rational(1, 3)), 4 * width);
  }
  const Polynomial deep = near_double_root(1, 3, power_of_two(-400));
  EXPECT_EQ(on_unit_interval(deep).outcome, Outcome::too_deep);
  EXPECT_EQ(on_unit_interval(deep, 300).outcome, Outcome::positive);
}

}  // namespace
}  // namespace touchstone::exact::positivity_test
