#include "touchstone/derivation/expression_graph.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

namespace touchstone::filters {
namespace {

[[noreturn]] void refuse(const ExpressionGraph& graph, const std::string& reason) {
  throw std::invalid_argument("expression " + graph.name + ": " + reason);
}

bool intersect(const std::set<std::size_t>& a, const std::set<std::size_t>& b) {
  return std::ranges::any_of(a, [&](std::size_t group) { return b.contains(group); });
}

}  // namespace

std::size_t ExpressionGraph::group_of(std::size_t weight) const {
  std::size_t group = 0;
  for (std::size_t end = groups.at(0).at(0).size(); end <= weight;) {
    end += groups.at(++group).at(0).size();
  }
  return group;
}

std::vector<std::vector<int>> ExpressionGraph::weight_vertices() const {
  std::vector<std::vector<int>> combinations{{}};
  for (const GroupVertices& group : groups) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& prefix : combinations) {
      for (const std::vector<int>& vertex : group) {
        longer.push_back(prefix);
        longer.back().insert(longer.back().end(), vertex.begin(), vertex.end());
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

void require_multiaffine(const ExpressionGraph& graph, std::size_t weights) {
  const std::size_t grouped = std::transform_reduce(
      graph.groups.begin(), graph.groups.end(), std::size_t{0}, std::plus<>(),
      [](const GroupVertices& group) { return group.empty() ? 0 : group.front().size(); });
  if (grouped != weights) refuse(graph, "its groups do not hold exactly its weights");
  std::vector<std::set<std::size_t>> used;  // the groups that a node depends on
  for (const Node& node : graph.nodes) {
    std::set<std::size_t>& groups = used.emplace_back();
    if (node.operation == Operation::weight) groups.insert(graph.group_of(node.left));
    if (node.operation == Operation::weight || node.operation == Operation::coordinate) continue;
    if (node.operation == Operation::multiply && intersect(used[node.left], used[node.right])) {
      refuse(graph, "a product has weights of one group on both sides");
    }
    groups = used[node.left];
    groups.insert(used[node.right].begin(), used[node.right].end());
  }
}

void require_classes(const ExpressionGraph& graph, std::span<const std::size_t> classes) {
  if (classes.size() != graph.coordinates) refuse(graph, "its classes are not one a coordinate");
  std::vector<std::set<std::size_t>> held;  // the classes in each product of a node's value
  for (const Node& node : graph.nodes) {
    std::set<std::size_t>& of_node = held.emplace_back();
    switch (node.operation) {
      case Operation::coordinate:
        of_node.insert(classes[node.left]);
        break;
      case Operation::weight:
        break;
      case Operation::multiply:
        of_node = held[node.left];
        of_node.insert(held[node.right].begin(), held[node.right].end());
        if (of_node.size() != held[node.left].size() + held[node.right].size()) {
          refuse(graph, "a product has coordinates of one class on both sides");
        }
        break;
      case Operation::add:
      case Operation::subtract:
        if (held[node.left] != held[node.right]) refuse(graph, "a sum adds terms of other classes");
        of_node = held[node.left];
    }
  }
}

}  // namespace touchstone::filters
