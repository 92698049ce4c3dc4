#include "touchstone/derivation/published_model.hpp"

#include <vector>

#include "touchstone/derivation/rounding_model.hpp"

namespace touchstone::filters {
namespace {

struct ValueAndError {
  mpq_class value;
  mpq_class error;
};

ValueAndError rounded(const mpq_class& value, const mpq_class& error) {
  return {value, error + power_of_two_below(value)};
}

}  // namespace

mpq_class published_model_units(const ExpressionGraph& graph) {
  std::vector<ValueAndError> nodes;
  for (const auto& [operation, left, right] : graph.nodes) {
    if (operation == Operation::coordinate || operation == Operation::weight) {
      nodes.push_back({1, 0});
      continue;
    }
    const ValueAndError &a = nodes[left], &b = nodes[right];
    nodes.push_back(operation == Operation::multiply
                        ? rounded(a.value * b.value, a.value * b.error + b.value * a.error)
                        : rounded(a.value + b.value, a.error + b.error));
  }
  return nodes[graph.result].error;
}

}  // namespace touchstone::filters
