#include "touchstone/derivation/worst_case.hpp"

#include <gtest/gtest.h>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters::worst_case_test {
namespace {

/// Checks the result of the search about its worst input in rationals; returns its constant in
/// units of u.
template <class Expression, class Scalar>
double checked_worst_case(const Format& format, int degree, std::uint64_t evaluations) {
  const ExpressionGraph graph = record<Expression>();
  const WorstCase worst = search_worst_case(graph, evaluators<Expression>(), format,
                                            {.seed = 11, .evaluations = evaluations});
  const mpq_class error =
      abs(mpq_class(static_cast<double>(computed_value<Expression, Scalar>(worst.inputs))) -
          exact_value<Expression>(worst.inputs));
  mpq_class scale = format.unit_roundoff();
  for (int i = 0; i < degree; ++i) scale *= mpq_class(greatest_coordinate(worst.inputs));
  EXPECT_NEAR(mpq_class(error / scale).get_d(), worst.units, 1e-12);
  EXPECT_LE(error / scale, derive_bound(graph, format).rounding() / format.unit_roundoff());
  for (const double x : worst.inputs.coordinates) EXPECT_EQ(static_cast<double>(Scalar(x)), x);
  for (const double w : worst.inputs.weights) EXPECT_EQ(static_cast<double>(Scalar(w)), w);
  return worst.units;
}

template <class Expression>
class Search : public ::testing::Test {};
using Expressions =
    ::testing::Types<EdgeEdge, VertexFace, EdgeEdgeSeparated, VertexFaceSeparated, PaperEdgeEdge,
                     PaperVertexFace, PaperEdgeEdgeSeparated, PaperVertexFaceSeparated,
                     ReleasedEdgeEdge, ReleasedVertexFace>;
TYPED_TEST_SUITE(Search, Expressions);

TYPED_TEST(Search, NeverExceedsTheBoundAndComesNearIt) {
  const double units = derive_bound(record<TypeParam>(), double_format).rounding().get_d() * 0x1p53;
  EXPECT_GT((checked_worst_case<TypeParam, double>(double_format, 1, 40'000)), units / 6);
  EXPECT_GT((checked_worst_case<TypeParam, float>(float_format, 1, 40'000)), units / 6);
}

TEST(WorstCase, FindsMoreThanHalfOfTheTightestBounds) {
  EXPECT_GT((checked_worst_case<EdgeEdge, double>(double_format, 1, 200'000)), 5.5);
  EXPECT_GT((checked_worst_case<Blend, double>(double_format, 1, 50'000)), 1.6);
  EXPECT_GT((checked_worst_case<researcher::Orientation, double>(double_format, 2, 50'000)), 9);
}

TEST(WorstCase, MeasuresCoordinatesToo) {
  // The weights are just below 1, so that a coordinate times its weight is rounded.
  const double units = checked_worst_case<MeasuredProjectedGap, double>(double_format, 2, 40'000);
  EXPECT_GT(units, 34.0 / 6);
  const WorstCase worst =
      search_worst_case(record<MeasuredProjectedGap>(), evaluators<MeasuredProjectedGap>(),
                        double_format, {.seed = 11, .evaluations = 1'000});
  for (const double weight : worst.inputs.weights) {
    EXPECT_GT(weight, 0.9);
    EXPECT_LE(weight, 1.0);
  }
}

/// Evaluators that count their calls.
std::uint64_t counted = 0;
TEST(WorstCase, KeepsToItsBudget) {
  Evaluators counting = evaluators<EdgeEdge>();
  counting.in_double = [](const Inputs& inputs) {
    ++counted;
    return computed_value<EdgeEdge, double>(inputs);
  };
  for (const std::uint64_t budget : {1U, 150U, 201U, 10'000U}) {
    counted = 0;
    static_cast<void>(search_worst_case(record<EdgeEdge>(), counting, double_format,
                                        {.seed = 1, .evaluations = budget}));
    EXPECT_EQ(counted, budget);
  }
}

/// Blend in another order of operations.
struct OtherBlend : Blend {
  template <class Scalar>
  static constexpr Scalar evaluate(const std::array<Scalar, 2>& x, const std::array<Scalar, 2>& w) {
    return x[0] + (x[1] - x[0]) * w[1];
  }
};

TEST(WorstCase, FindsThatABoundIsOfAnotherOrderOfOperations) {
  Evaluators other = evaluators<Blend>();
  other.in_double = evaluators<OtherBlend>().in_double;
  const WorstCase worst =
      search_worst_case(record<Blend>(), other, double_format, {.seed = 1, .evaluations = 50'000});
  EXPECT_GT(worst.units, 2.5) << "the bound of the graph is 2 u";
}

}  // namespace
}  // namespace touchstone::filters::worst_case_test
