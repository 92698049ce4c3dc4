/// \file
/// The derivation of bounds: expressions as graphs, the catalogue, both models of rounding, and the
/// bounds that ship.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "tests/support/messages.hpp"
#include "touchstone/derivation/bound_table.hpp"
#include "touchstone/derivation/catalogue.hpp"
#include "touchstone/derivation/expression_graph.hpp"
#include "touchstone/derivation/published_model.hpp"
#include "touchstone/derivation/rounding_model.hpp"
#include "touchstone/derivation/shipped_bound.hpp"
#include "touchstone/filters/error_bound.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters::derivation_test {
namespace {

// ---- Expressions as graphs ----------------------------------------------------------------------

TEST(ExpressionGraph, EvaluatesLikeTheTemplate) {
  // The recorded operations in double give the bits of the template.
  std::mt19937_64 random(1);
  const ExpressionGraph graph = record<VertexFace>();
  for (int i = 0; i < 100; ++i) {
    Inputs inputs{{}, random_weights<VertexFace>(random, 53)};
    for (int j = 0; j < 8; ++j) inputs.coordinates.push_back(static_cast<double>(random()));
    std::vector<double> values;
    for (const auto& [operation, left, right] : graph.nodes) {
      switch (operation) {
        case Operation::coordinate:
          values.push_back(inputs.coordinates.at(left));
          break;
        case Operation::weight:
          values.push_back(inputs.weights.at(left));
          break;
        case Operation::add:
          values.push_back(values[left] + values[right]);
          break;
        case Operation::subtract:
          values.push_back(values[left] - values[right]);
          break;
        case Operation::multiply:
          values.push_back(values[left] * values[right]);
      }
    }
    EXPECT_EQ(values.at(graph.result), (computed_value<VertexFace, double>(inputs)));
  }
}

/// x w0 w1, with both weights of one group: not affine in it.
struct Square : Blend {
  static constexpr std::string_view name = "square";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 2>& w) {
    return x[0] * w[0] * w[1];
  }
};

/// The same, hidden in sums.
struct HiddenSquare : Blend {
  static constexpr std::string_view name = "hidden_square";
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 2>& w) {
    return (x[0] * w[0] + x[1]) * (w[1] + w[1]);
  }
};

/// An expression that declares three weights but has groups of two.
struct Miscounted : Blend {
  static constexpr std::string_view name = "miscounted";
  static constexpr std::size_t weights = 3;
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 3>& w) {
    return x[0] * w[0];
  }
};

/// The area of a parallelogram whose sides' coordinates have the given classes.
template <std::size_t... classes_of_coordinates>
struct Area {
  static constexpr std::string_view name = "area";
  static constexpr std::size_t coordinates = 4;
  static constexpr std::size_t weights = 0;
  static constexpr std::array<std::size_t, sizeof...(classes_of_coordinates)> classes{
      classes_of_coordinates...};

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& /*visit*/) {}

  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 4>& x,
                                   const std::array<Scalar, 0>& /*w*/) {
    return x[0] * x[3] - x[1] * x[2];
  }
};

/// A sum of coordinates of two classes, hidden in weights.
struct MixedSum : Blend {
  static constexpr std::string_view name = "mixed_sum";
  static constexpr std::array<std::size_t, 2> classes{0, 1};
};

template <class Expression>
std::string refusal() {
  return tests::message_of<std::invalid_argument>([] { (void)record<Expression>(); });
}

TEST(ExpressionGraph, RefusesWhatBreaksTheRules) {
  EXPECT_EQ(refusal<Square>(),
            "expression square: a product has weights of one group on both sides");
  EXPECT_EQ(refusal<HiddenSquare>(),
            "expression hidden_square: a product has weights of one group on both sides");
  EXPECT_EQ(refusal<Miscounted>(),
            "expression miscounted: its groups do not hold exactly its weights");
  EXPECT_EQ(refusal<Blend>(), "");
}

TEST(ExpressionGraph, RefusesClassesThatItsProductsDoNotHave) {
  EXPECT_EQ((refusal<Area<0, 0, 1, 1>>()), "");
  EXPECT_EQ((refusal<Area<7, 7, 2, 2>>()), "") << "classes are names";
  EXPECT_EQ((refusal<Area<0, 0, 0, 0>>()),
            "expression area: a product has coordinates of one class on both sides");
  EXPECT_EQ((refusal<Area<0, 1, 1, 0>>()),
            "expression area: a product has coordinates of one class on both sides");
  EXPECT_EQ((refusal<Area<0, 2, 1, 1>>()), "expression area: a sum adds terms of other classes");
  EXPECT_EQ((refusal<Area<0, 1, 0, 1>>()), "") << "x and y instead of sides";
  EXPECT_EQ((refusal<Area<0, 0, 1>>()), "expression area: its classes are not one a coordinate");
  EXPECT_EQ((refusal<Area<0, 0, 1, 1, 1>>()),
            "expression area: its classes are not one a coordinate");
  EXPECT_EQ(refusal<MixedSum>(), "expression mixed_sum: a sum adds terms of other classes");
}

// ---- The catalogue and its table ----------------------------------------------------------------

TEST(Catalogue, HoldsEachExpressionOnce) {
  std::set<std::string> names;
  for (const CatalogueEntry& entry : catalogue()) {
    EXPECT_TRUE(names.insert(entry.graph.name).second) << entry.graph.name;
  }
  EXPECT_EQ(names.size(), 26U);
}

TEST(Catalogue, NamesOrdersThatItHolds) {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.published) {
      EXPECT_EQ(find_expression(entry.published->order).graph.name, entry.published->order);
    }
  }
  EXPECT_THROW(static_cast<void>(find_expression("nonsense")), std::invalid_argument);
}

TEST(Catalogue, EvaluatesWhatItRecorded) {
  std::mt19937_64 random(1);
  const Inputs inputs{{1, -2, 3, 5, 8, -13, 21, 34}, random_weights<EdgeEdge>(random, 10)};
  const CatalogueEntry& entry = find_expression("edge_edge");
  EXPECT_EQ(entry.evaluators.in_double(inputs), (computed_value<EdgeEdge, double>(inputs)));
  EXPECT_EQ(entry.evaluators.in_float(inputs),
            static_cast<double>(computed_value<EdgeEdge, float>(inputs)));
  EXPECT_EQ(entry.evaluators.in_rationals(inputs), exact_value<EdgeEdge>(inputs));
  const auto [high, low] = entry.evaluators.in_double_double(inputs);
  EXPECT_EQ(mpq_class(high) + mpq_class(low), exact_value<EdgeEdge>(inputs)) << "of few bits";
}

// What a table says, and its missing columns, are in tests/transcripts/derive.md.

DeriveOptions quick() {
  DeriveOptions options;
  options.models = {Model::observed};
  options.search.evaluations = 2'000;
  return options;
}

TEST(BoundTable, GivesTheSameInAnyNumberOfThreads) {
  DeriveOptions one = quick(), many = one;
  one.threads = 1;
  many.threads = 5;
  const DeriveResult a = derive(one), b = derive(many);
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].observed->units, b.rows.at(i).observed->units);
  }
}

// ---- The published model ------------------------------------------------------------------------

/// Seven digits of a number in [1e-6, 1e-5), rounded up as in the publication.
std::string seven_digits_up(const mpq_class& x) {
  const mpq_class scaled = x * 1'000'000 * 1'000'000;
  mpz_class up;
  mpz_cdiv_q(up.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const std::string digits = up.get_str();
  return digits.substr(0, 1) + "." + digits.substr(1) + "e-06";
}

template <class Expression>
void expect_constants(double in_double, const char* in_float) {
  const mpq_class units = published_model_units(record<Expression>());
  EXPECT_EQ(mpq_class(units * double_format.unit_roundoff()), mpq_class(in_double));
  EXPECT_EQ(seven_digits_up(units * float_format.unit_roundoff()), in_float);
}

TEST(PublishedModel, GivesThePublishedConstants) {
  expect_constants<PaperEdgeEdge>(6.217248937900877e-15, "3.337861e-06");
  expect_constants<PaperVertexFace>(6.661338147750939e-15, "3.576279e-06");
  expect_constants<PaperEdgeEdgeSeparated>(7.105427357601002e-15, "3.814698e-06");
  expect_constants<PaperVertexFaceSeparated>(7.549516567451064e-15, "4.053116e-06");
}

TEST(PublishedModel, DependsOnTheOrderOfOperations) {
  EXPECT_EQ(published_model_units(record<PaperEdgeEdge>()), 56);
  EXPECT_EQ(published_model_units(record<ReleasedEdgeEdge>()), 84);
}

TEST(PublishedModel, FollowsABlendByHand) {
  // Two products below 1, each with an error of u; a sum below 2 with half an ulp of 2u.
  EXPECT_EQ(published_model_units(record<Blend>()), 4);
}

// ---- Our model ----------------------------------------------------------------------------------

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

// ---- Bounds that ship ---------------------------------------------------------------------------

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
}  // namespace touchstone::filters::derivation_test
