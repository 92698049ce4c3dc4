#include "touchstone/filters/error_bounds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "tests/filters/support.hpp"
#include "touchstone/derivation/gappa.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/filters/separation_expressions.hpp"

// (tests/transcripts/derive.md compares the header with what the derivation writes.)
namespace touchstone::filters::error_bounds_test {
namespace {

/// A shipped bound, with its expression and precision.
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

  /// Fails unless the computed value is finite and within the bound of the truth.
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

  /// Runs the test on inputs whose coordinates have random magnitudes, and any sign.
  template <class Magnitude>
  static void expect_within_bound_for(const Magnitude& magnitude) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 2000; ++i) {
      Inputs inputs;
      for (std::size_t j = 0; j < Expression::coordinates; ++j) {
        const auto x = static_cast<double>(magnitude(random));
        inputs.coordinates.push_back(random() % 2 == 0 ? x : -x);
      }
      const int bits = std::array{0, 1, 3, Limits::digits}.at(random() % 4);
      inputs.weights = random_weights<Expression>(random, bits);
      expect_within_bound(inputs);
    }
  }
};

using Bounds = ::testing::Types<
    Shipped<EdgeEdge, double, edge_edge_double>, Shipped<EdgeEdge, float, edge_edge_float>,
    Shipped<VertexFace, double, vertex_face_double>, Shipped<VertexFace, float, vertex_face_float>,
    Shipped<EdgeEdgeSeparated, double, edge_edge_separated_double>,
    Shipped<EdgeEdgeSeparated, float, edge_edge_separated_float>,
    Shipped<VertexFaceSeparated, double, vertex_face_separated_double>,
    Shipped<VertexFaceSeparated, float, vertex_face_separated_float>,
    Shipped<QuadraticEdgeEdgeSeparated, double, quadratic_edge_edge_separated_double>,
    Shipped<QuadraticVertexFaceSeparated, double, quadratic_vertex_face_separated_double>,
    Shipped<CubicEdgeEdgeSeparated, double, cubic_edge_edge_separated_double>,
    Shipped<CubicVertexFaceSeparated, double, cubic_vertex_face_separated_double>,
    Shipped<ComponentSum, double, component_sum_double>,
    Shipped<Position, double, position_double>>;
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

TYPED_TEST(EveryBound, HoldsAtAllMagnitudes) {
  using Number = typename TestFixture::Scalar;
  using Of = std::numeric_limits<Number>;
  using Random = std::mt19937_64;
  static constexpr Number greatest = TypeParam::bound.greatest_x;
  const auto normal = [](Random& random, int exponent, int range) {
    const Number fraction = std::ldexp(static_cast<Number>(random() >> 40U), -24);
    return std::ldexp(1 + fraction,
                      exponent + static_cast<int>(random() % static_cast<unsigned>(range)));
  };
  // Zeros of both signs; among subnormals, across their border, and all at once; without overflow.
  const int least = TypeParam::format.least_exponent;
  this->expect_within_bound_for([](Random& /*random*/) { return Number(0); });
  this->expect_within_bound_for([](Random& random) {
    const auto multiple = static_cast<Number>(random() % (random() % 2 == 0 ? 4 : 1000));
    return multiple * Of::denorm_min();
  });
  this->expect_within_bound_for(
      [&](Random& random) { return normal(random, std::ilogb(Of::min()) - 4, 8); });
  this->expect_within_bound_for(
      [&](Random& random) { return normal(random, least, std::ilogb(greatest) - 1 - least); });
  this->expect_within_bound_for([](Random& random) {
    return random() % 2 == 0 ? greatest : std::nextafter(greatest, Number(0));
  });
}

// ---- Bounds of differences of coordinates and of products, by classes if there are any ----------

/// A difference of two doubles: exact, rounded, and as a pair.
struct Difference {
  mpq_class exact;
  DoubleDouble<double> pair;

  Difference(double a, double b)
      : exact(mpq_class(a) - mpq_class(b)), pair(exact_difference(a, b)) {}
};

/// The rounded differences in double.
struct InDouble {
  using Number = double;
  static double of(const Difference& x) { return x.pair.high; }
  static double of(double weight) { return weight; }
  static mpq_class truth(const Difference& x) { return x.exact; }
  static mpq_class exactly(double x) { return {x}; }
  static double high(double x) { return x; }
};

/// Doubles that are not differences: the rounded value is the truth.
struct InDoubleItself : InDouble {
  static mpq_class truth(const Difference& x) { return {x.pair.high}; }
};

/// The exact differences in double-double.
struct InDoubleDouble {
  using Number = DoubleDouble<double>;
  static Number of(const Difference& x) { return x.pair; }
  static Number of(double weight) { return {weight, 0}; }
  static mpq_class truth(const Difference& x) { return x.exact; }
  static mpq_class exactly(const Number& x) { return mpq_class(x.high) + mpq_class(x.low); }
  static double high(const Number& x) { return x.high; }
};

/// A shipped bound: its expression, the expression that the solvers run, and its arithmetic.
template <class Of, class Run, class Computing, std::size_t of_degree,
          const ErrorBound<double, of_degree>& constant>
struct ShippedByClasses {
  using Recorded = Of;
  using Expression = Run;
  using Arithmetic = Computing;
  static constexpr std::size_t degree = of_degree;
  static constexpr const ErrorBound<double, of_degree>& bound = constant;
  static constexpr bool is_double = std::is_base_of_v<InDouble, Computing>;
  static constexpr const Format& format = is_double ? double_format : double_double_format;
  /// The part of the bound that errors of random inputs reach.
  static constexpr double least_part = is_double ? 1.0 / 50 : 1.0 / 200;
};

/// The sizes of the numbers before subtraction: random exponents for each class.
struct Sizes {
  std::array<int, 3> least;
  std::array<int, 3> greatest;
  int motion = 0;  ///< the exponent of the numbers' distance, if they are to be near each other
};

template <class T>
class EveryBoundByClasses : public ::testing::Test {
 protected:
  using Expression = typename T::Expression;
  using Arithmetic = typename T::Arithmetic;
  static constexpr std::size_t count = Expression::coordinates;

  /// The results of one test.
  struct Found {
    double worst = 0;  ///< the greatest error, as a part of the bound
    int rounded = 0;   ///< differences that are not doubles
  };

  /// ± 1.… · 2^exponent, with a random number of bits.
  double number(int exponent) {
    const double fraction =
        std::ldexp(static_cast<double>(random_() >> (12U + random_() % 52)), -52);
    return (random_() % 2 == 0 ? 1 : -1) * std::ldexp(1 + fraction, exponent);
  }

  int between(int least, int greatest) {
    return least + static_cast<int>(random_() % static_cast<unsigned>(greatest - least + 1));
  }

  /// The class of a coordinate; the first for all if there are no classes.
  static std::size_t class_of([[maybe_unused]] std::size_t coordinate) {
    if constexpr (requires { Expression::classes; }) return Expression::classes.at(coordinate);
    return 0;
  }

  /// Numbers and their differences, of the sizes of each coordinate's class.
  std::vector<Difference> differences(const Sizes& sizes) {
    std::array<int, 3> scale{};
    for (std::size_t i = 0; i < 3; ++i)
      scale.at(i) = between(sizes.least.at(i), sizes.greatest.at(i));
    std::vector<Difference> result;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t of = class_of(i);
      const int exponent =
          random_() % 2 == 0 ? scale.at(of) : between(sizes.least.at(of), sizes.greatest.at(of));
      const double a = number(exponent);
      const double b =
          sizes.motion != 0 ? a + number(sizes.motion) : number(exponent - between(0, 60));
      result.emplace_back(a, b);
    }
    return result;
  }

  /// The greatest magnitudes of the rounded differences of each class, multiplied in each order.
  static std::vector<double> leading_terms(const std::vector<Difference>& x) {
    std::array<double, T::degree> magnitude{};
    for (std::size_t i = 0; i < count; ++i) {
      double& greatest = magnitude.at(class_of(i));
      greatest = std::max(greatest, std::abs(x[i].pair.high));
    }
    const double rounding = T::bound.rounding();
    if constexpr (T::degree == 1) {
      return {magnitude[0] * rounding};
    } else if constexpr (!requires { Expression::classes; }) {
      return {magnitude[0] * magnitude[0] * rounding};
    } else if constexpr (T::degree == 2) {
      return {magnitude[0] * magnitude[1] * rounding, rounding * magnitude[1] * magnitude[0]};
    } else {
      return {magnitude[0] * magnitude[1] * magnitude[2] * rounding,
              (magnitude[0] * rounding) * (magnitude[1] * magnitude[2])};
    }
  }

  static double greatest_magnitude(const std::vector<Difference>& x) {
    double greatest = 0;
    for (const Difference& difference : x) {
      greatest = std::max(greatest, std::abs(difference.pair.high));
    }
    return greatest;
  }

  template <std::size_t... i, std::size_t... j>
  static std::pair<typename Arithmetic::Number, mpq_class> values(
      const std::vector<Difference>& x, [[maybe_unused]] const std::vector<double>& w,
      std::index_sequence<i...> /*inputs*/, std::index_sequence<j...> /*weights*/) {
    using Number = typename Arithmetic::Number;
    return {Expression::evaluate(std::array<Number, count>{Arithmetic::of(x[i])...},
                                 std::array<Number, sizeof...(j)>{Arithmetic::of(w[j])...}),
            Expression::evaluate(std::array<mpq_class, count>{Arithmetic::truth(x[i])...},
                                 std::array<mpq_class, sizeof...(j)>{mpq_class(w[j])...})};
  }

  void expect_within_bound(const std::vector<Difference>& x, Found& found) {
    const std::vector<double> w = random_weights<Expression>(random_, between(0, 53));
    const auto [computed, exact] = values(x, w, std::make_index_sequence<count>(),
                                          std::make_index_sequence<Expression::weights>());
    const mpq_class error = abs(Arithmetic::exactly(computed) - exact);
    for (const double leading : leading_terms(x)) {
      const double bound = leading + T::bound.underflow(greatest_magnitude(x));
      ASSERT_TRUE(std::isfinite(bound));
      ASSERT_LE(error, mpq_class(bound));
      // Solvers see only the high part of a pair: beyond the bound it has the sign of the truth.
      const double high = Arithmetic::high(computed);
      ASSERT_TRUE(std::abs(high) <= bound || sgn(exact) == (high > 0 ? 1 : -1));
      if (bound > 0) found.worst = std::max(found.worst, mpq_class(error / bound).get_d());
    }
    for (const Difference& difference : x) found.rounded += difference.pair.low != 0 ? 1 : 0;
  }

  Found expect_within_bound_for(const Sizes& sizes) {
    Found found;
    for (int i = 0; i < 3000; ++i) {
      expect_within_bound(differences(sizes), found);
      if (HasFatalFailure()) break;
    }
    return found;
  }

 private:
  std::mt19937_64 random_{9};
};

using BoundsByClasses = ::testing::Types<
    ShippedByClasses<MeasuredProjectedGap, ProjectedGap, InDouble, 2,
                     measured_projected_gap_double>,
    ShippedByClasses<MeasuredDeterminantEnd, DeterminantEnd, InDouble, 3,
                     measured_determinant_end_double>,
    ShippedByClasses<MeasuredDeterminantMiddle, DeterminantMiddle, InDouble, 3,
                     measured_determinant_middle_double>,
    ShippedByClasses<MeasuredOrientationEnd, OrientationEnd, InDouble, 3,
                     measured_orientation_end_double>,
    ShippedByClasses<MeasuredOrientationMiddle, OrientationMiddle, InDouble, 3,
                     measured_orientation_middle_double>,
    ShippedByClasses<DeterminantEnd, DeterminantEnd, InDoubleDouble, 3,
                     determinant_end_double_double>,
    ShippedByClasses<MeasuredAdvancedGap, AdvancedGap, InDouble, 2, measured_advanced_gap_double>,
    ShippedByClasses<AdvancedGap, AdvancedGap, InDoubleDouble, 2, advanced_gap_double_double>,
    ShippedByClasses<CornerGap, CornerGap, InDoubleItself, 2, corner_gap_double>,
    ShippedByClasses<SquaredLength, SquaredLength, InDoubleItself, 2, squared_length_double>,
    ShippedByClasses<LengthDefect, LengthDefect, InDoubleDouble, 2, length_defect_double_double>,
    ShippedByClasses<ContactComponent, ContactComponent, InDoubleDouble, 1,
                     contact_component_double_double>>;
TYPED_TEST_SUITE(EveryBoundByClasses, BoundsByClasses);

TYPED_TEST(EveryBoundByClasses, IsProvedByGappa) {
  const ExpressionGraph graph = record<typename TypeParam::Recorded>();
  EXPECT_TRUE(gappa_proves(graph, TypeParam::format, GappaGoal::rounding,
                           mpq_class(TypeParam::bound.rounding())));
}

TYPED_TEST(EveryBoundByClasses, HoldsForAllMagnitudesAndIsNotFarFromTheError) {
  constexpr int far = TypeParam::is_double ? 300 : 90;
  // Differences up to 2^100; the first class of orientations and gaps are directions, up to 2^204.
  constexpr bool has_direction = TypeParam::Expression::coordinates != DeterminantEnd::coordinates;
  constexpr int first = has_direction ? 202 : 98;
  const int all = std::ilogb(TypeParam::bound.greatest_x) - 2;
  struct Row {
    Sizes sizes;
    double least_part;  ///< of the bound, that errors reach: so much smaller ones would not pass
  };
  const double near = TypeParam::least_part;
  for (const auto& [sizes, least_part] :
       {// Inputs of one magnitude come nearest to the bound.
        Row{{{0, 0, 0}, {0, 0, 0}}, near},
        // Classes of very different magnitudes.
        Row{{{far, 0, -far}, {far + 2, 2, 2 - far}}, near},
        Row{{{-far, far, 0}, {2 - far, far + 2, 2}}, near},
        Row{{{0, -far, far}, {2, 2 - far, far + 2}}, near},
        // Products of two underflow, of three, and of one subnormal class with a large one.
        Row{{{-545, -545, -545}, {-480, -480, -480}}, 0.0},
        Row{{{-370, -370, -370}, {-310, -310, -310}}, 0.0},
        Row{{{60, -1074, -1074}, {62, -1020, -40}}, 0.0},
        // The greatest magnitudes of the solver, and of all.
        Row{{{first, 98, 98}, {first, 98, 98}}, near},
        Row{{{all, all, all}, {all, all, all}}, near}}) {
    EXPECT_GT(this->expect_within_bound_for(sizes).worst, least_part);
  }
  static_cast<void>(this->expect_within_bound_for({{-1074, -1074, -1074}, {-1020, -1020, -1020}}));
}

TYPED_TEST(EveryBoundByClasses, HoldsForRoundedDifferencesAndExactOnes) {
  const auto mixed = this->expect_within_bound_for({{-20, -20, -20}, {20, 20, 20}});
  EXPECT_GT(mixed.rounded, static_cast<int>(1000 * TypeParam::Expression::coordinates));
  const auto near = this->expect_within_bound_for({{20, 20, 20}, {22, 22, 22}, -10});
  EXPECT_EQ(near.rounded, 0) << "near each other and far from the origin";
}

}  // namespace
}  // namespace touchstone::filters::error_bounds_test
