#include "touchstone/derivation/expression_graph.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "tests/filters/support.hpp"
#include "tests/support/messages.hpp"

namespace touchstone::filters::expression_graph_test {
namespace {

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

}  // namespace
}  // namespace touchstone::filters::expression_graph_test
