#include "fast/step/pair_classes.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace touchstone::fast {
namespace {

/// The vertices that a vertex has edges to, as far as they matter.
struct Neighbours {
  static constexpr std::int32_t none = -1;

  std::array<std::int32_t, 2> first{none, none};
  /// More than two, or itself.
  bool many = false;

  void add(std::int32_t vertex) {
    for (std::int32_t& known : first) {
      if (known == none) known = vertex;
      if (known == vertex) return;
    }
    many = true;
  }

  /// 3 stands for more.
  [[nodiscard]] int count() const {
    if (many) return 3;
    return (first[0] == none ? 0 : 1) + (first[1] == none ? 0 : 1);
  }
};

std::vector<Neighbours> neighbours_of(std::size_t vertices, std::span<const Edge> edges) {
  std::vector<Neighbours> result(vertices);
  const auto of = [&](std::int32_t vertex) -> Neighbours& {
    return result[static_cast<std::size_t>(vertex)];
  };
  for (const auto& [a, b] : edges) {
    if (a == b) {
      of(a).many = true;
    } else {
      of(a).add(b);
      of(b).add(a);
    }
  }
  return result;
}

std::vector<bool> used_vertices(std::size_t vertices, const MeshElements& elements) {
  std::vector<bool> used(vertices);
  const auto mark = [&used](std::int32_t vertex) { used[static_cast<std::size_t>(vertex)] = true; };
  for (const Edge& edge : elements.edges) std::ranges::for_each(edge, mark);
  for (const Face& face : elements.faces) std::ranges::for_each(face, mark);
  std::ranges::for_each(elements.points, mark);
  return used;
}

/// An edge, the smaller vertex first.
Edge ordered(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Calls use(edge, third vertex) for the three sides of each face.
template <class Use>
void for_each_side(std::span<const Face> faces, const Use& use) {
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      use(ordered(face[i], face[(i + 1) % 3]), face[(i + 2) % 3]);
    }
  }
}

std::vector<std::int32_t> edges_in_no_face(const MeshElements& elements) {
  std::vector<Edge> sides;
  sides.reserve(3 * elements.faces.size());
  for_each_side(elements.faces,
                [&](const Edge& side, std::int32_t /*third*/) { sides.push_back(side); });
  std::ranges::sort(sides);
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < elements.edges.size(); ++i) {
    const auto [a, b] = elements.edges[i];
    if (!std::ranges::binary_search(sides, ordered(a, b))) {
      result.push_back(static_cast<std::int32_t>(i));
    }
  }
  return result;
}

/// Finds the folds.
class Folds {
 public:
  Folds(std::span<const Neighbours> neighbours, const MeshElements& elements)
      : elements_(elements), is_end_(neighbours.size()) {
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      if (neighbours[i].count() != 2) continue;
      const auto [a, b] = neighbours[i].first;
      tips_.push_back({.base = ordered(a, b), .vertex = static_cast<std::int32_t>(i)});
      is_end_[static_cast<std::size_t>(a)] = is_end_[static_cast<std::size_t>(b)] = true;
    }
    std::ranges::sort(tips_, [](const Tip& x, const Tip& y) {
      return std::tie(x.base, x.vertex) < std::tie(y.base, y.vertex);
    });
  }

  [[nodiscard]] std::vector<IndexPair> find() {
    std::vector<IndexPair> result;
    if (tips_.empty()) return result;
    for_each_side(elements_.faces, [this](const Edge& side, std::int32_t third) {
      for (Tip& tip : over(side)) tip.is_told_of |= tip.vertex != third;
    });
    for (std::size_t i = 0; i < elements_.edges.size(); ++i) {
      for (const Tip& tip : over(ordered(elements_.edges[i][0], elements_.edges[i][1]))) {
        if (!tip.is_told_of) result.push_back({tip.vertex, static_cast<std::int32_t>(i)});
      }
    }
    std::ranges::sort(result);
    return result;
  }

 private:
  /// A vertex with two neighbours, and these.
  struct Tip {
    Edge base;
    std::int32_t vertex;
    bool is_told_of = false;
  };

  std::span<Tip> over(const Edge& base) {
    const auto is_end = [this](std::int32_t vertex) {
      return is_end_[static_cast<std::size_t>(vertex)];
    };
    if (!is_end(base[0]) || !is_end(base[1])) return {};
    const auto found = std::ranges::equal_range(tips_, base, {}, &Tip::base);
    return {found.begin(), found.end()};
  }

  const MeshElements& elements_;
  std::vector<Tip> tips_;
  std::vector<bool> is_end_;
};

/// The hubs, and the ends of lone edges.
void find_leaves(std::span<const Neighbours> neighbours, const MeshElements& elements,
                 PairClasses& classes) {
  const auto of = [&](std::int32_t vertex) { return neighbours[static_cast<std::size_t>(vertex)]; };
  // The place of a hub among those found, by its vertex.
  std::vector<std::pair<std::int32_t, Hub>> hubs;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i].count() != 1) continue;
    const auto leaf = static_cast<std::int32_t>(i);
    const std::int32_t hub = neighbours[i].first[0];
    if (of(hub).count() == 1) {
      if (leaf < hub) classes.lone_ends.push_back({leaf, hub});
    } else {
      hubs.push_back({hub, {.leaves = {leaf}, .edges = {}}});
    }
  }
  if (hubs.empty()) return;
  std::ranges::stable_sort(hubs, {}, [](const auto& hub) { return hub.first; });
  std::size_t last = 0;
  for (std::size_t i = 1; i < hubs.size(); ++i) {
    if (hubs[i].first == hubs[last].first) {
      hubs[last].second.leaves.push_back(hubs[i].second.leaves.front());
    } else {
      std::swap(hubs[++last], hubs[i]);
    }
  }
  hubs.resize(last + 1);
  for (std::size_t place = 0; place < classes.bare_edges.size(); ++place) {
    const auto [a, b] = elements.edges[static_cast<std::size_t>(classes.bare_edges[place])];
    const auto add_to = [&](std::int32_t end) {
      const auto found =
          std::ranges::lower_bound(hubs, end, {}, [](const auto& hub) { return hub.first; });
      if (found == hubs.end() || found->first != end) return;
      found->second.edges.push_back(static_cast<std::int32_t>(place));
    };
    add_to(a);
    if (a != b) add_to(b);
  }
  for (auto& [vertex, hub] : hubs) {
    if (hub.edges.size() > 1) classes.hubs.push_back(std::move(hub));
  }
}

}  // namespace

PairClasses pair_classes(std::size_t vertices, const MeshElements& elements) {
  PairClasses classes;
  const std::vector<Neighbours> neighbours = neighbours_of(vertices, elements.edges);
  const std::vector<bool> used = used_vertices(vertices, elements);
  bool has_leaves = false;
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!used[i]) continue;
    classes.vertices.push_back(static_cast<std::int32_t>(i));
    const int count = neighbours[i].count();
    if (count == 0) classes.isolated.push_back(static_cast<std::int32_t>(i));
    has_leaves |= count == 1;
  }
  if (!classes.isolated.empty() || has_leaves) classes.bare_edges = edges_in_no_face(elements);
  find_leaves(neighbours, elements, classes);
  classes.folds = Folds(neighbours, elements).find();
  return classes;
}

}  // namespace touchstone::fast
