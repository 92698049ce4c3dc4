#include "touchstone/derivation/rounding_model.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace touchstone::filters {
namespace {

using Monomial = std::vector<std::size_t>;
using Terms = std::map<Monomial, mpq_class>;
/// Coefficients by power of x.
using ErrorPolynomial = std::vector<mpq_class>;

ExactValue from_terms(const Terms& terms) {
  ExactValue value;
  for (const auto& [monomial, coefficient] : terms) {
    if (coefficient != 0) value.terms.push_back({monomial, coefficient});
  }
  return value;
}

ExactValue sum(const ExactValue& a, const ExactValue& b, int sign) {
  Terms terms;
  for (const auto& [monomial, coefficient] : a.terms) terms[monomial] += coefficient;
  for (const auto& [monomial, coefficient] : b.terms) terms[monomial] += sign * coefficient;
  return from_terms(terms);
}

ExactValue product(const ExactValue& a, const ExactValue& b) {
  Terms terms;
  for (const ExactValue::Term& term_a : a.terms) {
    for (const ExactValue::Term& term_b : b.terms) {
      Monomial monomial;
      std::ranges::merge(term_a.monomial, term_b.monomial, std::back_inserter(monomial));
      terms[monomial] += term_a.coefficient * term_b.coefficient;
    }
  }
  return from_terms(terms);
}

/// The degree of a node, which does not depend on the vertex, even if its value vanishes there.
std::vector<std::size_t> degrees(const ExpressionGraph& graph) {
  std::vector<std::size_t> result;
  for (const Node& node : graph.nodes) {
    switch (node.operation) {
      case Operation::coordinate:
        result.push_back(1);
        break;
      case Operation::weight:
        result.push_back(0);
        break;
      case Operation::multiply:
        result.push_back(result[node.left] + result[node.right]);
        break;
      case Operation::add:
      case Operation::subtract:
        if (result[node.left] != result[node.right]) {
          throw std::invalid_argument("expression " + graph.name +
                                      ": a sum adds terms of different degrees");
        }
        result.push_back(result[node.left]);
    }
  }
  return result;
}

ErrorPolynomial operator+(const ErrorPolynomial& a, const ErrorPolynomial& b) {
  ErrorPolynomial result = a.size() >= b.size() ? a : b;
  const ErrorPolynomial& shorter = a.size() >= b.size() ? b : a;
  for (std::size_t i = 0; i < shorter.size(); ++i) result[i] += shorter[i];
  return result;
}

ErrorPolynomial operator*(const ErrorPolynomial& a, const ErrorPolynomial& b) {
  ErrorPolynomial result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

/// magnitude · x^degree
ErrorPolynomial at_most(const mpq_class& magnitude, std::size_t degree) {
  ErrorPolynomial result(degree + 1);
  result.back() = magnitude;
  return result;
}

/// Errors and magnitudes of all nodes at one vertex.
class VertexAnalysis {
 public:
  VertexAnalysis(const ExpressionGraph& graph, const std::vector<int>& weights,
                 const Format& format)
      : unit_roundoff_{format.unit_roundoff()},
        underflow_(power_of_two(format.least_exponent - 1)),
        degrees_(degrees(graph)),
        values_(expand(graph, weights)) {
    for (const Node& node : graph.nodes) errors_.push_back(error_of(node, errors_.size()));
  }

  [[nodiscard]] const ErrorPolynomial& error(std::size_t place) const { return errors_[place]; }

  /// An upper bound of the computed value.
  [[nodiscard]] ErrorPolynomial computed(std::size_t place) const {
    return magnitude(place) + errors_[place];
  }

 private:
  [[nodiscard]] ErrorPolynomial magnitude(std::size_t place) const {
    return at_most(values_[place].magnitude(), degrees_[place]);
  }

  [[nodiscard]] ErrorPolynomial error_of(const Node& node, std::size_t place) const {
    const auto [operation, left, right] = node;
    if (operation == Operation::coordinate || operation == Operation::weight) return {0};
    const bool multiplies = operation == Operation::multiply;
    const ErrorPolynomial inherited = multiplies ? errors_[left] * magnitude(right) +
                                                       magnitude(left) * errors_[right] +
                                                       errors_[left] * errors_[right]
                                                 : errors_[left] + errors_[right];
    const ErrorPolynomial rounding = at_most(unit_roundoff_, 0) * (magnitude(place) + inherited);
    const ErrorPolynomial underflow = multiplies ? at_most(underflow_, 0) : at_most(0, 0);
    return inherited + rounding + underflow;
  }

  mpq_class unit_roundoff_;
  mpq_class underflow_;
  std::vector<std::size_t> degrees_;
  std::vector<ExactValue> values_;
  std::vector<ErrorPolynomial> errors_;
};

mpq_class evaluate(const ErrorPolynomial& polynomial, const mpq_class& x) {
  mpq_class result;
  for (std::size_t i = polynomial.size(); i-- > 0;) result = result * x + polynomial[i];
  return result;
}

/// Keeps the larger coefficient of each power.
void raise(ErrorPolynomial& bound, const ErrorPolynomial& other) {
  bound.resize(std::max(bound.size(), other.size()));
  for (std::size_t i = 0; i < other.size(); ++i) bound[i] = std::max(bound[i], other[i]);
}

}  // namespace

mpq_class power_of_two(int exponent) {
  mpq_class result(1);
  if (exponent >= 0) {
    result <<= static_cast<unsigned long>(exponent);
  } else {
    result >>= static_cast<unsigned long>(-exponent);
  }
  return result;
}

mpq_class power_of_two_below(const mpq_class& x) {
  mpq_class result(1);
  while (result > x) result /= 2;
  while (2 * result <= x) result *= 2;
  return result;
}

mpq_class Format::unit_roundoff() const { return power_of_two(-digits); }

std::size_t ExactValue::degree() const {
  std::size_t result = 0;
  for (const Term& term : terms) result = std::max(result, term.monomial.size());
  return result;
}

mpq_class ExactValue::magnitude() const {
  mpq_class result;
  for (const Term& term : terms) result += abs(term.coefficient);
  return result;
}

std::vector<ExactValue> expand(const ExpressionGraph& graph, const std::vector<int>& weights) {
  std::vector<ExactValue> values;
  for (const auto& [operation, left, right] : graph.nodes) {
    switch (operation) {
      case Operation::coordinate:
        values.push_back(from_terms({{{left}, 1}}));
        break;
      case Operation::weight:
        values.push_back(from_terms({{{}, weights[left]}}));
        break;
      case Operation::add:
        values.push_back(sum(values[left], values[right], 1));
        break;
      case Operation::subtract:
        values.push_back(sum(values[left], values[right], -1));
        break;
      case Operation::multiply:
        values.push_back(product(values[left], values[right]));
    }
  }
  return values;
}

DerivedBound derive_bound(const ExpressionGraph& graph, const Format& format) {
  ErrorPolynomial error, largest;
  for (const std::vector<int>& weights : graph.weight_vertices()) {
    const VertexAnalysis analysis(graph, weights, format);
    raise(error, analysis.error(graph.result));
    for (std::size_t place = 0; place < graph.nodes.size(); ++place) {
      raise(largest, analysis.computed(place));
    }
  }
  DerivedBound bound{.coefficients = error, .greatest_x_exponent = format.greatest_exponent};
  // A limit strictly below half the overflow threshold, for any intermediate rounding.
  const mpq_class limit = power_of_two(format.greatest_exponent - 1);
  while (evaluate(largest, power_of_two(bound.greatest_x_exponent)) >= limit) {
    --bound.greatest_x_exponent;
  }
  return bound;
}

}  // namespace touchstone::filters
