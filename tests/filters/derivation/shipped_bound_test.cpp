#include "touchstone/derivation/shipped_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "touchstone/filters/error_bound.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters::shipped_bound_test {
namespace {

mpq_class value(const std::vector<mpq_class>& coefficients, const mpq_class& x) {
  mpq_class result;
  for (std::size_t i = coefficients.size(); i-- > 0;) result = result * x + coefficients[i];
  return result;
}

/// The bound as it ships: its coefficients are of type Scalar.
template <class Scalar, std::size_t degree>
ErrorBound<Scalar, degree> shipped(const DerivedBound& proved, const Format& format) {
  const std::vector<mpq_class> coefficients = shipped_coefficients(proved, format);
  ErrorBound<Scalar, degree> bound{.coefficients = {},
                                   .greatest_x = std::ldexp(Scalar(1), proved.greatest_x_exponent)};
  for (std::size_t i = 0; i <= degree; ++i) {
    bound.coefficients.at(i) = static_cast<Scalar>(coefficients.at(i).get_d());
    EXPECT_EQ(mpq_class(static_cast<double>(bound.coefficients.at(i))), coefficients.at(i));
  }
  return bound;
}

/// Expects the shipped bound, in Scalar, to be nowhere below the proved one.
template <class Scalar, std::size_t degree>
void expect_covers(const DerivedBound& proved, const Format& format) {
  const auto bound = shipped<Scalar, degree>(proved, format);
  const int least = format_of_bounds(format).least_exponent;
  std::mt19937_64 random(1);
  const auto range = static_cast<std::uint64_t>(proved.greatest_x_exponent - least);
  for (int i = 0; i < 20000; ++i) {
    const Scalar fraction = std::ldexp(static_cast<Scalar>(random() >> 40U), -24);
    const Scalar x = std::ldexp(1 + fraction, least + static_cast<int>(random() % range));
    ASSERT_GE(mpq_class(static_cast<double>(bound(x))),
              value(proved.coefficients, mpq_class(static_cast<double>(x))))
        << x;
  }
}

TEST(ShippedBound, CoversTheProvedOneInItsOwnArithmetic) {
  expect_covers<double, 1>(derive_bound(record<EdgeEdge>(), double_format), double_format);
  expect_covers<float, 1>(derive_bound(record<EdgeEdge>(), float_format), float_format);
  expect_covers<double, 1>(derive_bound(record<PaperVertexFace>(), double_format), double_format);
  expect_covers<float, 1>(derive_bound(record<PaperVertexFace>(), float_format), float_format);
  expect_covers<double, 2>(derive_bound(record<researcher::Orientation>(), double_format),
                           double_format);
  expect_covers<float, 2>(derive_bound(record<researcher::Orientation>(), float_format),
                          float_format);
  expect_covers<double, 3>(derive_bound(record<MeasuredDeterminantEnd>(), double_format),
                           double_format);
  expect_covers<double, 3>(derive_bound(record<DeterminantEnd>(), double_double_format),
                           double_double_format);
}

/// The proved bound for three classes of exact magnitudes.
mpq_class value(const DerivedBound& proved, const std::array<mpq_class, 3>& x) {
  std::vector<mpq_class> lower = proved.coefficients;
  lower.back() = 0;
  return proved.rounding() * x[0] * x[1] * x[2] + value(lower, *std::ranges::max_element(x));
}

/// The number of random magnitudes at which the bound, with classes in double, is below the proved
/// one. The exact values of the coordinates are greater by the largest possible amount.
int failures_by_classes(const ErrorBound<double, 3>& bound, const DerivedBound& proved) {
  std::mt19937_64 random(2);
  const auto magnitude = [&] {
    const double fraction = std::ldexp(static_cast<double>(random() >> 40U), -24);
    return std::ldexp(1 + fraction, static_cast<int>(random() % 1500) - 1200);
  };
  int failures = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::array<double, 3> x{magnitude(), magnitude(), magnitude()};
    std::array<mpq_class, 3> exact;
    for (std::size_t k = 0; k < 3; ++k) exact.at(k) = mpq_class(x.at(k)) / (1 - mpq_class(0x1p-53));
    const mpq_class truth = value(proved, exact);
    const double c = bound.rounding(), underflow = bound.underflow(*std::ranges::max_element(x));
    for (const double computed :
         {x[0] * x[1] * x[2] * c + underflow, c * x[2] * x[1] * x[0] + underflow,
          (x[0] * c) * (x[1] * x[2]) + underflow, (x[2] * x[0]) * (x[1] * c) + underflow}) {
      failures += mpq_class(computed) < truth ? 1 : 0;
    }
  }
  return failures;
}

TEST(ShippedBound, CoversTheProvedOneByClassesInAnyOrder) {
  const DerivedBound end = derive_bound(record<MeasuredDeterminantEnd>(), double_format);
  EXPECT_EQ(failures_by_classes(shipped<double, 3>(end, double_format), end), 0);
  const DerivedBound pairs = derive_bound(record<DeterminantEnd>(), double_double_format);
  EXPECT_EQ(failures_by_classes(shipped<double, 3>(pairs, double_double_format), pairs), 0);
}

TEST(ShippedBound, WouldNotCoverItWithoutItsMargins) {
  const DerivedBound proved = derive_bound(record<MeasuredDeterminantEnd>(), double_format);
  ErrorBound<double, 3> bound = shipped<double, 3>(proved, double_format);
  bound.coefficients[3] = std::nextafter(proved.rounding().get_d(), 1.0);
  EXPECT_GT(failures_by_classes(bound, proved), 100);
  bound = shipped<double, 3>(proved, double_format);
  for (std::size_t j = 0; j < 3; ++j) bound.coefficients.at(j) = 0;
  EXPECT_GT(failures_by_classes(bound, proved), 100);
}

TEST(ShippedBound, IsHardlyLargerThanTheProvedOne) {
  for (const Format& format : {double_format, float_format}) {
    const DerivedBound proved = derive_bound(record<EdgeEdge>(), format);
    const std::vector<mpq_class> shipped = shipped_coefficients(proved, format);
    EXPECT_GT(shipped.at(1), proved.coefficients.at(1));
    EXPECT_LE(shipped.at(1), proved.coefficients.at(1) * (1 + 9 * format.unit_roundoff()));
    EXPECT_LE(shipped.at(0), proved.coefficients.at(0) + power_of_two(format.least_exponent + 1));
  }
}

/// A coordinate itself: no error.
struct Nothing : Blend {
  static constexpr std::string_view name = "nothing";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x,
                                   const std::array<Scalar, 2>& /*w*/) {
    return x[0];
  }
};

TEST(ShippedBound, TakesAnExpressionWithoutErrors) {
  const DerivedBound proved = derive_bound(record<Nothing>(), double_format);
  EXPECT_EQ(shipped_coefficients(proved, double_format).back(), 0);
}

}  // namespace
}  // namespace touchstone::filters::shipped_bound_test
