#include "touchstone/derivation/rounding_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters::rounding_model_test {
namespace {

/// The bound on the rounding error in units of u, without second-order terms.
template <class Expression>
mpq_class first_order_units() {
  const mpq_class u = double_format.unit_roundoff();
  const mpq_class units = derive_bound(record<Expression>(), double_format).rounding() / u;
  const mpz_class whole = units.get_num() / units.get_den();
  // The remainder must be of second order: up to half the square of the units.
  EXPECT_LT(units - whole, whole * whole * u);
  return whole;
}

TEST(RoundingModel, FollowsABlendByHand) {
  for (const Format& format : {double_format, float_format}) {
    // At a vertex: a·1 is rounded (u), b·0 is 0, the sum is rounded: u + u (1 + u).
    const mpq_class u = format.unit_roundoff(), eta = power_of_two(format.least_exponent - 1);
    const DerivedBound bound = derive_bound(record<Blend>(), format);
    ASSERT_EQ(bound.coefficients.size(), 2U);
    EXPECT_EQ(bound.rounding(), 2 * u + u * u);
    EXPECT_EQ(bound.coefficients[0], 2 * eta * (1 + u));
    EXPECT_EQ(bound.greatest_x_exponent, format.greatest_exponent - 2);
  }
}

TEST(RoundingModel, FollowsDegreeTwoByHand) {
  const mpq_class u = double_format.unit_roundoff(), eta = power_of_two(-1075);
  const DerivedBound bound = derive_bound(record<researcher::Orientation>(), double_format);
  ASSERT_EQ(bound.coefficients.size(), 3U);
  // Differences are 2x large with an error of 2u x; products inherit 8u + 4u² and round 4 + 8u +
  // 4u²; the last difference has six terms left, because cx cy cancels.
  EXPECT_EQ(bound.rounding(), 30 * u + 48 * u * u + 32 * u * u * u + 8 * u * u * u * u);
  EXPECT_EQ(bound.coefficients[1], 0);
  EXPECT_EQ(bound.coefficients[0], 2 * eta * (1 + u));
}

TEST(RoundingModel, GivesTheBoundsOfTheOrdersOfOperations) {
  // Those that ship are in error_bounds.hpp, which is compared.
  EXPECT_EQ(first_order_units<PaperEdgeEdge>(), 24);
  EXPECT_EQ(first_order_units<PaperVertexFace>(), 28);
  EXPECT_EQ(first_order_units<PaperEdgeEdgeSeparated>(), 27);
  EXPECT_EQ(first_order_units<PaperVertexFaceSeparated>(), 33);
  EXPECT_EQ(first_order_units<ReleasedEdgeEdge>(), 42);
  EXPECT_EQ(first_order_units<ReleasedVertexFace>(), 49);
}

/// (a b) c of three measured coordinates.
struct TripleProduct {
  static constexpr std::string_view name = "triple_product";
  static constexpr std::size_t coordinates = 3;
  static constexpr std::size_t weights = 0;
  static constexpr std::array<std::size_t, 3> classes{0, 1, 2};

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& /*visit*/) {}

  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 3>& x,
                                   const std::array<Scalar, 0>& /*w*/) {
    return x[0] * x[1] * x[2];
  }
};
struct MeasuredTripleProduct : Measured<TripleProduct> {
  static constexpr std::string_view name = "measured_triple_product";
};

TEST(RoundingModel, FollowsUnderflowThroughDegreeThreeByHand) {
  const mpq_class u = double_format.unit_roundoff(), eta = power_of_two(-1075);
  const DerivedBound bound = derive_bound(record<TripleProduct>(), double_format);
  ASSERT_EQ(bound.coefficients.size(), 4U);
  // a b has the error u x² + η; times c that is u x³ + η x, rounded by u (x³ + u x³ + η x) + η.
  EXPECT_EQ(bound.coefficients[3], 2 * u + u * u);
  EXPECT_EQ(bound.coefficients[2], 0);
  EXPECT_EQ(bound.coefficients[1], eta * (1 + u));
  EXPECT_EQ(bound.coefficients[0], eta);
}

TEST(RoundingModel, TakesMeasuredCoordinatesForRoundedOnce) {
  const mpq_class u = double_format.unit_roundoff();
  const DerivedBound bound = derive_bound(record<MeasuredTripleProduct>(), double_format);
  mpq_class five_roundings(1);
  for (int i = 0; i < 5; ++i) five_roundings *= 1 + u;
  EXPECT_EQ(bound.rounding(), five_roundings - 1);
}

TEST(RoundingModel, KeepsTheErrorsOfValuesThatCancel) {
  // Each product has an error of u, and the difference rounds the sum of the errors, 2u.
  const mpq_class u = double_format.unit_roundoff();
  EXPECT_EQ(derive_bound(record<TwoErrors>(), double_format).rounding(), 2 * u + 2 * u * u);
}

/// x + x y: its error is not a multiple of a power of x.
struct Mixed : Blend {
  static constexpr std::string_view name = "mixed";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x,
                                   const std::array<Scalar, 2>& /*w*/) {
    return x[0] + x[0] * x[1];
  }
};

TEST(RoundingModel, RefusesMixedDegrees) {
  const ExpressionGraph graph = record<Mixed>();
  EXPECT_THROW(static_cast<void>(derive_bound(graph, double_format)), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::filters::rounding_model_test
