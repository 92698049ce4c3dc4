#include "fast/step/codimensional.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace touchstone::fast {
namespace {

/// Sets the flags of the vertices of the elements.
template <class Element>
void mark(std::vector<std::uint8_t>& flags, std::span<const Element> elements) {
  for (const Element& element : elements) {
    for (const std::int32_t vertex : element) flags[static_cast<std::size_t>(vertex)] = 1;
  }
}

Edge ordered(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Those of some vertices that have no edge, in the same order.
std::vector<std::int32_t> points_without_edge(std::size_t vertices,
                                              std::span<const std::int32_t> some,
                                              std::span<const Edge> edges) {
  std::vector<std::uint8_t> has_edge(vertices);
  mark(has_edge, edges);
  std::vector<std::int32_t> result;
  std::ranges::copy_if(some, std::back_inserter(result), [&](std::int32_t vertex) {
    return has_edge[static_cast<std::size_t>(vertex)] == 0;
  });
  return result;
}

}  // namespace

std::vector<std::int32_t> edges_without_face(const Mesh& mesh) {
  std::size_t vertices = 0;
  for (const Face& face : mesh.faces) {
    vertices = std::max(vertices, static_cast<std::size_t>(std::ranges::max(face)) + 1);
  }
  const auto for_each_side = [&](const auto& use) {
    for (const auto& [a, b, c] : mesh.faces) {
      for (const auto& [lesser, greater] : {ordered(a, b), ordered(b, c), ordered(c, a)}) {
        use(static_cast<std::size_t>(lesser), greater);
      }
    }
  };
  // The greater vertices of sides, in a list for each lesser one.
  std::vector<std::size_t> begins(vertices + 1);
  for_each_side([&](std::size_t lesser, std::int32_t /*greater*/) { ++begins[lesser + 1]; });
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<std::int32_t> greater_ones(begins.back());
  std::vector<std::size_t> next = begins;
  for_each_side(
      [&](std::size_t lesser, std::int32_t greater) { greater_ones[next[lesser]++] = greater; });
  const auto list_of = [&](std::size_t lesser) {
    return std::span(greater_ones).subspan(begins[lesser], next[lesser] - begins[lesser]);
  };
  for (std::size_t lesser = 0; lesser < vertices; ++lesser) std::ranges::sort(list_of(lesser));
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    const auto [lesser, greater] = ordered(mesh.edges[i][0], mesh.edges[i][1]);
    const auto from = static_cast<std::size_t>(lesser);
    if (from >= vertices || !std::ranges::binary_search(list_of(from), greater)) {
      result.push_back(static_cast<std::int32_t>(i));
    }
  }
  return result;
}

std::vector<std::int32_t> vertices_of(std::size_t vertices, const Mesh& mesh) {
  std::vector<std::uint8_t> is_named(vertices);
  mark(is_named, std::span(mesh.edges));
  mark(is_named, std::span(mesh.faces));
  for (const std::int32_t point : mesh.points) is_named[static_cast<std::size_t>(point)] = 1;
  std::vector<std::int32_t> result;
  result.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    if (is_named[i] != 0) result.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

Codimensional codimensional(std::size_t vertices, std::span<const std::int32_t> of_elements,
                            const Mesh& mesh) {
  Codimensional result{.points = points_without_edge(vertices, of_elements, mesh.edges),
                       .edges = {}};
  if (!result.points.empty()) result.edges = edges_without_face(mesh);
  return result;
}

}  // namespace touchstone::fast
