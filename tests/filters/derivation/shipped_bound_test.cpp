#include "filters/derivation/shipped_bound.hpp"

#include <gtest/gtest.h>

#include "filters/error_bound.hpp"
#include "tests/filters/support.hpp"
#include "tests/filters/worked_example/orientation.hpp"

namespace touchstone::filters {
namespace {

mpq_class value(const std::vector<mpq_class>& coefficients, const mpq_class& x) {
  mpq_class result;
  for (std::size_t i = coefficients.size(); i-- > 0;) result = result * x + coefficients[i];
  return result;
}

/// The bound as it runs, in Scalar, is nowhere below the one that is proved.
template <class Scalar, std::size_t degree>
void expect_covers(const DerivedBound& proved, const Format& format) {
  const std::vector<mpq_class> shipped = shipped_coefficients(proved, format);
  ErrorBound<Scalar, degree> bound{.coefficients = {},
                                   .greatest_x = std::ldexp(Scalar(1), proved.greatest_x_exponent)};
  for (std::size_t i = 0; i <= degree; ++i) {
    bound.coefficients.at(i) = static_cast<Scalar>(shipped.at(i).get_d());
    ASSERT_EQ(mpq_class(static_cast<double>(bound.coefficients.at(i))), shipped.at(i));
  }
  std::mt19937_64 random(1);
  const auto range = static_cast<std::uint64_t>(proved.greatest_x_exponent - format.least_exponent);
  for (int i = 0; i < 20000; ++i) {
    const Scalar fraction = std::ldexp(static_cast<Scalar>(random() >> 40U), -24);
    const Scalar x =
        std::ldexp(1 + fraction, format.least_exponent + static_cast<int>(random() % range));
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

/// A coordinate as it is: no error at all.
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

TEST(ShippedBound, IsDeclaredWithExactLiterals) {
  EXPECT_EQ(error_bound_declaration(record<EdgeEdge>(), float_format),
            "/// edge_edge in float: 10 u x and underflow.\n"
            "inline constexpr ErrorBound<float, 1> edge_edge_float{\n"
            "    .coefficients = {{0x1.8p-147F, 0x1.40000cp-21F}},\n"
            "    .greatest_x = 0x1p+125F,\n"
            "};\n");
}

}  // namespace
}  // namespace touchstone::filters
