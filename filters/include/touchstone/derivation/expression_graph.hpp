#pragma once

/// \file
/// An expression as a graph of its operations, recorded by running its template on a scalar
/// that records operations. All derivations start from this graph.

#if __cplusplus <= 201703L
#error "Touchstone needs C++20: compile with -std=c++20"
#include <touchstone_needs_cxx20>  // as in touchstone/cxx20.hpp, which this module does not use
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::filters {

enum class Operation : std::uint8_t { coordinate, weight, add, subtract, multiply };

/// A value of the graph. Operands precede their results.
struct Node {
  Operation operation;
  std::size_t left = 0;   ///< the input's number, or the first operand's place in the graph
  std::size_t right = 0;  ///< the second operand's place
};

/// The vertices of a group of weights: for each vertex the values of the group's weights.
using GroupVertices = std::vector<std::vector<int>>;

/// The operations of an expression, in an order in which they can run.
struct ExpressionGraph {
  std::string name;
  std::size_t coordinates = 0;
  std::vector<GroupVertices> groups;
  std::vector<Node> nodes;
  std::size_t result = 0;  ///< place of the expression's value

  /// The group that a weight belongs to.
  [[nodiscard]] std::size_t group_of(std::size_t weight) const;

  /// All combinations of the groups' vertices, each as the values of all weights.
  [[nodiscard]] std::vector<std::vector<int>> weight_vertices() const;
};

/// A recording scalar: each operation adds a node to the graph and returns a reference to it.
class Recorded {
 public:
  Recorded(ExpressionGraph& graph, Node node) : graph_(&graph), place_(graph.nodes.size()) {
    graph.nodes.push_back(node);
  }

  [[nodiscard]] std::size_t place() const { return place_; }

  friend Recorded operator+(const Recorded& a, const Recorded& b) {
    return {*a.graph_, {Operation::add, a.place_, b.place_}};
  }
  friend Recorded operator-(const Recorded& a, const Recorded& b) {
    return {*a.graph_, {Operation::subtract, a.place_, b.place_}};
  }
  friend Recorded operator*(const Recorded& a, const Recorded& b) {
    return {*a.graph_, {Operation::multiply, a.place_, b.place_}};
  }

 private:
  ExpressionGraph* graph_;
  std::size_t place_;
};

/// Throws std::invalid_argument, naming the expression, unless the groups hold exactly its weights
/// and no product has weights of one group on both sides, as the derivations assume.
void require_multiaffine(const ExpressionGraph& graph, std::size_t weights);

/// Throws std::invalid_argument, naming the expression, unless each coordinate has a class, each
/// product of coordinates in its value has at most one of each class, and all have the same
/// classes. With x_i the greatest magnitude of class i, the x^k of the rounding error may then be
/// read as x_1 ⋯ x_k (rounding_model.hpp has the proof).
void require_classes(const ExpressionGraph& graph, std::span<const std::size_t> classes);

/// The graph of an expression (touchstone/filters/expressions.hpp has the rules).
/// \throws std::invalid_argument if it breaks the rules for expressions.
template <class Expression>
[[nodiscard]] ExpressionGraph record() {
  ExpressionGraph graph;
  graph.name = Expression::name;
  graph.coordinates = Expression::coordinates;
  Expression::visit_groups([&](const auto& group) {
    GroupVertices& vertices = graph.groups.emplace_back();
    for (const auto& vertex : group) vertices.emplace_back(vertex.begin(), vertex.end());
  });
  const auto inputs = [&]<std::size_t... number>([[maybe_unused]] Operation operation,
                                                 std::index_sequence<number...> /*numbers*/) {
    return std::array<Recorded, sizeof...(number)>{Recorded(graph, {operation, number})...};
  };
  const auto x = inputs(Operation::coordinate, std::make_index_sequence<Expression::coordinates>());
  const auto w = inputs(Operation::weight, std::make_index_sequence<Expression::weights>());
  graph.result = Expression::evaluate(x, w).place();
  require_multiaffine(graph, Expression::weights);
  if constexpr (requires { Expression::classes; }) require_classes(graph, Expression::classes);
  return graph;
}

}  // namespace touchstone::filters
