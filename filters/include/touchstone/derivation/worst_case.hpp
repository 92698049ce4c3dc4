#pragma once

/// \file
/// A search for an expression's input of greatest error, which shows how tight its bound is.
///
/// It draws random inputs and climbs from the best of them, repeatedly until the budget is spent.
/// The exact value is computed in rationals: coordinates are drawn between 2^-32 and 2, weights are
/// fractions over a power of two.
///
/// The relative rounding error is largest just above a power of two. Hence most coordinates are
/// drawn there, and the climb tries changes of all kinds: last bits, sign, magnitude, another
/// weight. The weights of measured coordinates (groups of one vertex,
/// touchstone/filters/polynomial_expressions.hpp) are drawn just below 1: a coordinate times its
/// weight is then the exact value that is rounded, not greater than the coordinate.

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "touchstone/derivation/expression_graph.hpp"
#include "touchstone/derivation/rounding_model.hpp"
#include "touchstone/filters/double_double.hpp"

namespace touchstone::filters {

/// The inputs of an expression. Values of float are held in double; those of double_double have a
/// double's digits.
struct Inputs {
  std::vector<double> coordinates;
  std::vector<double> weights;
};

/// Ways to run an expression on inputs.
struct Evaluators {
  double (*in_double)(const Inputs& inputs);
  double (*in_float)(const Inputs& inputs);  ///< the inputs must be floats
  DoubleDouble<double> (*in_double_double)(const Inputs& inputs);
  mpq_class (*in_rationals)(const Inputs& inputs);
};

struct WorstCaseOptions {
  std::uint64_t seed = 2021;
  std::uint64_t evaluations = 200'000;  ///< of the expression, in total
};

/// The worst input found.
struct WorstCase {
  Inputs inputs;
  /// |computed − exact| there, as a multiple of u x^k: x the greatest magnitude of its coordinates,
  /// k the expression's degree.
  double units = 0;
};

/// Runs an expression on the inputs, each converted to the scalar by `convert`.
template <class Expression, class Convert>
[[nodiscard]] auto evaluate_with(const Inputs& inputs, const Convert& convert) {
  using Scalar = std::invoke_result_t<Convert, double>;
  const auto all = [&]<std::size_t... i>([[maybe_unused]] const std::vector<double>& values,
                                         std::index_sequence<i...> /*numbers*/) {
    return std::array<Scalar, sizeof...(i)>{convert(values[i])...};
  };
  return Expression::evaluate(
      all(inputs.coordinates, std::make_index_sequence<Expression::coordinates>()),
      all(inputs.weights, std::make_index_sequence<Expression::weights>()));
}

/// The evaluators of an expression, compiled under the flags of the file that calls this.
template <class Expression>
[[nodiscard]] Evaluators evaluators() {
  return {[](const Inputs& inputs) {
            return evaluate_with<Expression>(inputs, [](double x) { return x; });
          },
          [](const Inputs& inputs) {
            return static_cast<double>(
                evaluate_with<Expression>(inputs, [](double x) { return static_cast<float>(x); }));
          },
          [](const Inputs& inputs) {
            return evaluate_with<Expression>(inputs, [](double x) {
              return DoubleDouble<double>{x, 0};
            });
          },
          [](const Inputs& inputs) {
            return evaluate_with<Expression>(inputs, [](double x) { return mpq_class(x); });
          }};
}

/// The worst input that the search finds. It depends on the arguments alone.
[[nodiscard]] WorstCase search_worst_case(const ExpressionGraph& graph,
                                          const Evaluators& evaluators, const Format& format,
                                          const WorstCaseOptions& options);

}  // namespace touchstone::filters
