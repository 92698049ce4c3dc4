#include "filters/error_bounds.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "filters/derivation/catalogue.hpp"
#include "filters/derivation/gappa.hpp"
#include "tests/filters/support.hpp"

namespace touchstone::filters {
namespace {

TEST(ErrorBounds, StandAsTheDerivationGivesThem) {
  std::ifstream file(TOUCHSTONE_SOURCE_DIR "/filters/error_bounds.hpp", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, error_bounds_header())
      << "write it anew: touchstone derive --emit filters/error_bounds.hpp";
}

/// A bound that ships, with the expression and precision that it is for.
template <class Tested, class Number, const ErrorBound<Number, 1>& constant>
struct Shipped {
  using Expression = Tested;
  using Scalar = Number;
  static constexpr const ErrorBound<Number, 1>& bound = constant;
  static constexpr const Format& format =
      std::is_same_v<Number, double> ? double_format : float_format;
};

template <class T>
class EveryBound : public ::testing::Test {
 protected:
  using Expression = typename T::Expression;
  using Scalar = typename T::Scalar;
  using Limits = std::numeric_limits<Scalar>;

  /// Fails unless the computed value is finite and as near to the truth as the bound says.
  static void expect_within_bound(const Inputs& inputs) {
    const Scalar computed = computed_value<Expression, Scalar>(inputs);
    ASSERT_TRUE(std::isfinite(computed)) << ::testing::PrintToString(inputs.coordinates);
    const auto bound = T::bound(static_cast<Scalar>(greatest_coordinate(inputs)));
    ASSERT_TRUE(std::isfinite(bound));
    const mpq_class error =
        abs(mpq_class(static_cast<double>(computed)) - exact_value<Expression>(inputs));
    EXPECT_LE(error, mpq_class(static_cast<double>(bound)))
        << ::testing::PrintToString(inputs.coordinates) << ::testing::PrintToString(inputs.weights);
  }

  /// Runs the test on inputs whose coordinates a function of a random number gives.
  template <class Coordinate>
  static void expect_within_bound_for(const Coordinate& coordinate) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 2000; ++i) {
      Inputs inputs;
      for (std::size_t j = 0; j < Expression::coordinates; ++j) {
        inputs.coordinates.push_back(static_cast<double>(coordinate(random)));
      }
      const int bits = std::array{0, 1, 3, Limits::digits}.at(random() % 4);
      inputs.weights = random_weights<Expression>(random, bits);
      expect_within_bound(inputs);
    }
  }

  static Scalar sign(std::mt19937_64& random) { return random() % 2 == 0 ? Scalar(1) : Scalar(-1); }
};

using Bounds = ::testing::Types<
    Shipped<EdgeEdge, double, edge_edge_double>, Shipped<EdgeEdge, float, edge_edge_float>,
    Shipped<VertexFace, double, vertex_face_double>, Shipped<VertexFace, float, vertex_face_float>,
    Shipped<EdgeEdgeSeparated, double, edge_edge_separated_double>,
    Shipped<EdgeEdgeSeparated, float, edge_edge_separated_float>,
    Shipped<VertexFaceSeparated, double, vertex_face_separated_double>,
    Shipped<VertexFaceSeparated, float, vertex_face_separated_float>>;
TYPED_TEST_SUITE(EveryBound, Bounds);

TYPED_TEST(EveryBound, IsProvedByGappa) {
  const ExpressionGraph graph = record<typename TypeParam::Expression>();
  const Format& format = TypeParam::format;
  const mpq_class rounding(static_cast<double>(TypeParam::bound.coefficients[1]));
  mpq_class underflow(static_cast<double>(TypeParam::bound.coefficients[0]));
  underflow /= power_of_two(format.least_exponent - 1);
  EXPECT_TRUE(gappa_proves(graph, format, GappaGoal::rounding, rounding));
  EXPECT_TRUE(gappa_proves(graph, format, GappaGoal::underflow, underflow));
}

TYPED_TEST(EveryBound, HoldsAmongSubnormalsAndZeros) {
  using Number = typename TestFixture::Scalar;
  this->expect_within_bound_for([](std::mt19937_64& random) {
    const auto multiple = static_cast<Number>(random() % (random() % 2 == 0 ? 4 : 1000));
    return TestFixture::sign(random) * multiple * TestFixture::Limits::denorm_min();
  });
}

TYPED_TEST(EveryBound, HoldsAcrossTheBorderOfSubnormals) {
  using Number = typename TestFixture::Scalar;
  this->expect_within_bound_for([](std::mt19937_64& random) {
    const Number fraction = std::ldexp(static_cast<Number>(random() >> 40U), -24);
    return TestFixture::sign(random) * (1 + fraction) *
           std::ldexp(TestFixture::Limits::min(), static_cast<int>(random() % 8) - 4);
  });
}

TYPED_TEST(EveryBound, HoldsAtAllMagnitudesAtOnce) {
  using Number = typename TestFixture::Scalar;
  const int greatest = std::ilogb(TypeParam::bound.greatest_x) - 1;
  const int least = TypeParam::format.least_exponent;
  this->expect_within_bound_for([=](std::mt19937_64& random) {
    const Number fraction = std::ldexp(static_cast<Number>(random() >> 40U), -24);
    const auto range = static_cast<std::uint64_t>(greatest - least);
    return TestFixture::sign(random) *
           std::ldexp(1 + fraction, least + static_cast<int>(random() % range));
  });
}

TYPED_TEST(EveryBound, HoldsAtTheGreatestCoordinateWithoutOverflow) {
  using Number = typename TestFixture::Scalar;
  this->expect_within_bound_for([](std::mt19937_64& random) {
    const Number below = std::nextafter(TypeParam::bound.greatest_x, Number(0));
    return TestFixture::sign(random) * (random() % 2 == 0 ? TypeParam::bound.greatest_x : below);
  });
}

TYPED_TEST(EveryBound, TakesZerosOfBothSigns) {
  this->expect_within_bound_for([](std::mt19937_64& random) {
    return random() % 2 == 0 ? typename TestFixture::Scalar(0) : -typename TestFixture::Scalar(0);
  });
}

}  // namespace
}  // namespace touchstone::filters
