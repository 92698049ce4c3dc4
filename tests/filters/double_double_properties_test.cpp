#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "filters/double_double.hpp"
#include "tests/support/properties.hpp"

// Double-doubles by their laws: those that hold exactly, and those that hold up to the errors that the
// header derives.

namespace touchstone::filters::double_double_properties_test {
namespace {

using tests::expect_property;
using Number = DoubleDouble<double>;

/// A double of magnitude between 2^-150 and 2^200, or 0.
double double_of(std::int64_t significand, std::int8_t exponent) {
  return std::ldexp(static_cast<double>(significand), exponent);
}

/// A normalised pair of about that size.
Number number(std::int64_t high, std::int64_t low, std::int8_t exponent) {
  return exact_sum(double_of(high, exponent), std::ldexp(double_of(low, exponent), -60));
}

mpq_class exact(const Number& x) { return mpq_class(x.high) + mpq_class(x.low); }

bool same(const Number& a, const Number& b) { return a.high == b.high && a.low == b.low; }

bool is_normalised(const Number& x) { return x.high + x.low == x.high; }

/// 2^-103 of a number's magnitude.
mpq_class error_of(const mpq_class& x) {
  mpq_class result = abs(x);
  mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), 103);
  return result;
}

Number negative(const Number& x) { return {-x.high, -x.low}; }

Number scaled(const Number& x, int exponent) {
  return {std::ldexp(x.high, exponent), std::ldexp(x.low, exponent)};
}

TEST(DoubleDoubleProperties, SumsOfDoublesAreExactInEitherOrder) {
  expect_property(1, 3000, [](std::int64_t m, std::int8_t k, std::int64_t n, std::int8_t l) {
    const double a = double_of(m, k), b = double_of(n, l);
    const Number sum = exact_sum(a, b);
    RC_ASSERT(exact(sum) == mpq_class(a) + mpq_class(b));
    RC_ASSERT(same(sum, exact_sum(b, a)));
    RC_ASSERT(is_normalised(sum));
    RC_ASSERT(same(exact_difference(a, -b), sum));
    if (std::abs(a) >= std::abs(b)) RC_ASSERT(same(sum_of_ordered(a, b), sum));
  });
}

TEST(DoubleDoubleProperties, SignsAndPowersOfTwoPassThrough) {
  expect_property(
      2, 2000,
      [](std::int64_t m, std::int64_t p, std::int8_t k, std::int64_t n, std::int64_t q,
         std::int8_t l, std::int8_t exponent) {
        const Number a = number(m, p, k), b = number(n, q, l);
        RC_ASSERT(same(negative(a) + negative(b), negative(a + b)));
        RC_ASSERT(same(a - b, a + negative(b)));
        RC_ASSERT(same(negative(a) * b, negative(a * b)));
        RC_ASSERT(same(scaled(a, exponent) + scaled(b, exponent), scaled(a + b, exponent)));
        RC_ASSERT(same(scaled(a, exponent) * b, scaled(a * b, exponent)));
      });
}

TEST(DoubleDoubleProperties, SumsAndProductsCommute) {
  expect_property(3, 2000,
                  [](std::int64_t m, std::int64_t p, std::int8_t k, std::int64_t n, std::int64_t q,
                     std::int8_t l) {
                    const Number a = number(m, p, k), b = number(n, q, l);
                    RC_ASSERT(same(a + b, b + a));
                    RC_ASSERT(same(a * b, b * a));
                    RC_ASSERT(is_normalised(a + b));
                    RC_ASSERT(is_normalised(a * b));
                  });
}

/// Two sums in either order differ by no more than the four roundings, each of what it rounds.
TEST(DoubleDoubleProperties, SumsAssociateUpToTheirErrors) {
  expect_property(
      4, 2000,
      [](std::int64_t m, std::int64_t n, std::int64_t o, std::int8_t k, std::int8_t l,
         std::int8_t j) {
        const Number a = number(m, n, k), b = number(n, o, l), c = number(o, m, j);
        const mpq_class left = exact((a + b) + c), right = exact(a + (b + c));
        const mpq_class allowed =
            error_of(exact(a + b)) + error_of(exact(b + c)) + error_of(left) + error_of(right);
        RC_ASSERT(abs(mpq_class(left - right)) <= 2 * allowed);
        RC_ASSERT(abs(mpq_class(left - (exact(a) + exact(b) + exact(c)))) <= 2 * allowed);
      });
}

TEST(DoubleDoubleProperties, ProductsDistributeUpToTheirErrors) {
  expect_property(5, 2000,
                  [](std::int64_t m, std::int64_t n, std::int64_t o, std::int8_t k, std::int8_t l,
                     std::int8_t j) {
                    const Number a = number(m, n, k / 2), b = number(n, o, l / 2),
                                 c = number(o, m, j / 2);
                    const mpq_class truth = exact(a) * (exact(b) + exact(c));
                    const mpq_class parts =
                        abs(mpq_class(exact(a) * exact(b))) + abs(mpq_class(exact(a) * exact(c)));
                    RC_ASSERT(abs(mpq_class(exact(a * b + a * c) - truth)) <=
                              error_of(parts) + 2 * error_of(truth) + error_of(error_of(parts)));
                    RC_ASSERT(abs(mpq_class(exact(a * (b + c)) - truth)) <= 3 * error_of(truth));
                  });
}

}  // namespace
}  // namespace touchstone::filters::double_double_properties_test
