#include "fast/certified/exact/polynomial.hpp"

#include <gtest/gtest.h>

#include "tests/fast/certified/forms.hpp"

namespace touchstone::fast::exact_stage::polynomial_test {
namespace {

using tests::cubic;
using tests::in_time;
using tests::polynomial;

TEST(Polynomial, CalculatesAsFunctionsOfTimeDo) {
  const Polynomial a = polynomial(in_time(1, -2, 0)), b = polynomial(in_time(3, 1, -4));
  EXPECT_EQ(a - b, polynomial(in_time(-2, -3, 4)));
  EXPECT_EQ(-a, polynomial(in_time(-1, 2, 0)));
  EXPECT_EQ(a * 5, polynomial(in_time(5, -10, 0)));
  EXPECT_EQ(b << 2, polynomial(in_time(12, 4, -16)));
  Polynomial sum = a;
  EXPECT_EQ(sum += b, polynomial(in_time(4, -1, -4)));
  // (1 − 2t)(3 + t − 4t²) = 3 − 5t − 6t² + 8t³, as a form of degree 4.
  EXPECT_EQ(a * b, (Polynomial{3, 7, -3, -7, 0}));
}

TEST(Polynomial, LosesItsRootsAtTheEnds) {
  EXPECT_EQ(inner_polynomial(Polynomial{0, 0, 4, -8, 0}), (Polynomial{1, -2}));
  EXPECT_EQ(inner_polynomial(Polynomial{0, 1, 0, -3, -2}), (Polynomial{1, -2}));  // (x+y)²
  EXPECT_EQ(inner_polynomial(Polynomial{5, 5}).size(), 1U);
  EXPECT_TRUE(inner_polynomial(Polynomial{0, 0}).empty());
}

TEST(Polynomial, FindsCommonDivisors) {
  const Polynomial both = inner_polynomial(in_time(2, -9, 9));  // (1−3t)(2−3t)
  const Polynomial other = cubic(1, -8, 21, -18);               // (1−3t)²(1−2t)
  EXPECT_EQ(common_divisor(both, other).size(), 2U);
  EXPECT_EQ(common_divisor(both, inner_polynomial(in_time(1, 0, -2))).size(), 1U);
  EXPECT_EQ(common_divisor(other, other).size(), 4U);
  EXPECT_EQ(squarefree(other).size(), 3U);
  EXPECT_EQ(squarefree(both).size(), 3U);
}

TEST(Polynomial, DividesByAFactor) {
  const Polynomial a = polynomial(in_time(1, -2, 0)), b = polynomial(in_time(3, 1, -4));
  ASSERT_EQ(b.back().sign(), 0);
  EXPECT_EQ(scaled_quotient(a * Polynomial{1, 1}, {1, 1}), a);
  EXPECT_EQ(scaled_quotient(b * Polynomial{5, 3}, {5, 3}), b * 3);
}

TEST(Polynomial, FindsCommonDivisorsOfDegreeEight) {
  const Polynomial a = polynomial(in_time(1, 0, -2)), b = polynomial(in_time(2, -9, 9));
  const Polynomial f = a * a * b * polynomial(in_time(1, 1, 1));
  EXPECT_EQ(common_divisor(f, a * b * b).size(), 5U);  // a b
  EXPECT_EQ(squarefree(f).size(), 7U);
}

TEST(Polynomial, SeesThatThereIsNoCommonFactor) {
  const Polynomial both = inner_polynomial(in_time(2, -9, 9));  // (1−3t)(2−3t)
  EXPECT_TRUE(surely_coprime(both, inner_polynomial(in_time(1, 0, -2))));
  EXPECT_FALSE(surely_coprime(both, cubic(1, -8, 21, -18)));
  EXPECT_TRUE(surely_coprime({1}, both));
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::polynomial_test
