#pragma once

/// \file
/// Scenes for tests of steps: meshes of a few random elements in any position, and all pairs that a
/// step examines, listed one by one.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/number.hpp"
#include "touchstone/step.hpp"

namespace touchstone::tests {

using fast::Edge;
using fast::Face;
using fast::IndexPair;
using Places = Eigen::MatrixX3d;
using NumberedPair = std::pair<ContactKind, IndexPair>;
using Pairs = std::vector<NumberedPair>;

// ---- Scenes -------------------------------------------------------------------------------------

/// A step with its parts.
struct Scene {
  Places start;
  Places end;
  std::vector<Edge> edges = {};  ///< all of them
  std::vector<Face> faces = {};
  std::vector<std::int32_t> points = {};
  std::vector<std::int32_t> groups = {};
  std::vector<std::array<std::int32_t, 2>> apart = {};
  std::function<bool(std::int32_t, std::int32_t)> can_collide = {};
  std::vector<double> radii = {};
  std::vector<fast::GroupSeparation> separations = {};
  std::vector<fast::Tetrahedron> tetrahedra = {};
  std::vector<Face> plane_triangles = {};

  [[nodiscard]] fast::Mesh elements() const {
    return {.edges = edges,
            .faces = faces,
            .points = points,
            .tetrahedra = tetrahedra,
            .plane_triangles = plane_triangles};
  }
  [[nodiscard]] fast::Step step(fast::StepOptions options = {}) const {
    options.groups = {
        .of_vertices = groups, .apart = apart, .radii = radii, .separations = separations};
    options.can_collide = can_collide;
    return fast::Step(start, end, elements(), options);
  }
};

/// The places of vertices: a coordinate of a vertex at an end of the step.
struct Shape {
  std::string name;
  std::function<double(Random&)> coordinate;
  /// The motion to be added to the start; empty if the end has independent coordinates.
  std::function<double(Random&)> motion;
  double separation;  ///< a separation that matters at this size
};

[[nodiscard]] inline std::vector<Shape> shapes() {
  const auto none = std::function<double(Random&)>();
  return {
      {"small integers", [](Random& r) { return r.between(0, 2); }, none, 1.0},
      {"coarse grid", [](Random& r) { return 0.125 * r.between(0, 9); }, none, 0.125},
      {"anywhere", [](Random& r) { return r.uniform(-1, 1); }, none, 0.1},
      {"small motion", [](Random& r) { return r.uniform(-1, 1); },
       [](Random& r) { return r.uniform(-0.2, 0.2); }, 0.01},
      {"coincident", [](Random& r) { return r.between(0, 1); }, none, 0.5},
      {"all scales", [](Random& r) { return r.finite_double() / 4; }, none, 1e300},
      {"huge", [](Random& r) { return 1e300 * r.between(-3, 3); }, none, 1e299},
      {"mixed ranges",
       [](Random& r) {
         const double x = r.uniform(-1, 1);
         const int range = r.between(0, 9);
         return range > 1 ? x : range == 0 ? std::copysign(1e300, x) : 1e-300 * x;
       },
       none, 0.1},
      {"subnormal",
       [](Random& r) { return std::numeric_limits<double>::denorm_min() * r.between(-4, 4); }, none,
       std::numeric_limits<double>::denorm_min()},
      {"one plane", [](Random& r) { return r.coin() ? 0.5 : r.between(0, 3); },
       [](Random& r) { return r.between(-2, 2); }, 0.5},
  };
}

[[nodiscard]] inline Edge ordered(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A mesh of few vertices: faces and edges of any of them, even with the same one twice, and
/// points.
[[nodiscard]] inline Scene random_scene(Random& random, const Shape& shape, int vertices) {
  Scene scene{.start = Places(vertices, 3), .end = Places(vertices, 3)};
  for (Eigen::Index i = 0; i < vertices; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      scene.start(i, axis) = shape.coordinate(random);
      scene.end(i, axis) =
          shape.motion ? scene.start(i, axis) + shape.motion(random) : shape.coordinate(random);
    }
  }
  const auto vertex = [&] { return random.between(0, vertices - 1); };
  const bool is_surface = random.coin();
  for (int i = is_surface ? random.between(0, vertices / 3) : 0; i > 0; --i) {
    scene.faces.push_back({vertex(), vertex(), vertex()});
  }
  scene.edges = fast::edges_of(scene.faces);
  for (int i = random.between(0, vertices / 4); i > 0; --i) {
    scene.edges.push_back({vertex(), vertex()});
  }
  for (int i = random.between(0, vertices); i > 0; --i) scene.points.push_back(vertex());
  if (random.coin()) {
    for (int i = 0; i < vertices; ++i) scene.groups.push_back(random.between(0, 3));
    const auto group = [&] { return scene.groups[static_cast<std::size_t>(vertex())]; };
    for (int i = 0; i < 3; ++i) scene.apart.push_back({group(), group()});
  }
  return scene;
}

/// Triangles, edges and points at random places in a cube, each of about this size and motion.
[[nodiscard]] inline Scene soup(Random& random, int count, double size) {
  Scene scene{.start = Places(6 * count, 3), .end = Places(6 * count, 3)};
  for (int i = 0; i < count; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double centre = random.uniform(-1, 1), motion = random.uniform(-size, size);
      for (int k = 6 * i; k < 6 * i + 6; ++k) {
        scene.start(k, axis) = centre + random.uniform(-size, size);
        scene.end(k, axis) = scene.start(k, axis) + motion + random.uniform(-size, size) / 8;
      }
    }
    const int shared = random.coin() ? 6 * i + 2 : random.between(0, 6 * i + 2);
    scene.faces.push_back({6 * i, 6 * i + 1, shared});
    scene.points.push_back(6 * i + 5);
  }
  scene.edges = fast::edges_of(scene.faces);
  for (int i = 0; i < count; ++i) scene.edges.push_back({6 * i + 3, 6 * i + 4});
  return scene;
}

/// A rule for pairs of vertices that lets about a third of them collide.
[[nodiscard]] inline std::function<bool(std::int32_t, std::int32_t)> random_rule(Random& random) {
  return [seed = random.between(0, 1 << 20)](std::int32_t a, std::int32_t b) {
    return ((std::min(a, b) + seed) * 31 + std::max(a, b)) % 3 == 0;
  };
}

/// Gives the groups of a scene radii and separations about as large as a length, and groups to its
/// vertices if they have none.
inline void add_thickness(Scene& scene, double length, Random& random) {
  if (scene.groups.empty()) {
    for (Eigen::Index i = 0; i < scene.start.rows(); ++i) {
      scene.groups.push_back(random.between(0, 3));
    }
  }
  const auto any = [&] {
    return random.coin() ? 0.25 * random.between(0, 4) * length : random.uniform(0, 1) * length;
  };
  const int which = random.between(0, 2);
  for (int i = 0; i < 4 && which != 0; ++i) scene.radii.push_back(any());
  for (std::int32_t a = 0; a < 4 && which != 1; ++a) {
    for (std::int32_t b = a; b < 4; ++b) {
      const auto is_used = [&](std::int32_t group) {
        return std::ranges::count(scene.groups, group) > 0;
      };
      if (random.between(0, 2) > 0 || !is_used(a) || !is_used(b)) continue;
      const auto groups = random.coin() ? std::array{a, b} : std::array{b, a};
      scene.separations.push_back({groups, any()});
    }
  }
}

/// A cell as a tetrahedron.
[[nodiscard]] inline Query cell_query(const Scene& scene, CellKind kind, std::size_t i) {
  fast::Tetrahedron points{};
  if (kind == CellKind::tetrahedron) {
    points = scene.tetrahedra.at(i);
  } else {
    std::ranges::copy(scene.plane_triangles.at(i), points.begin());
  }
  Query query;
  for (std::size_t k = 0; k < points.size(); ++k) {
    point_of(query, 0, k) = scene.start.row(points.at(k)).transpose();
    point_of(query, 1, k) = scene.end.row(points.at(k)).transpose();
  }
  return to_tetrahedron(kind, query);
}

/// Calls visit(kind, number, query) for all cells, in order.
template <class Visit>
void for_each_volume(const Scene& scene, const Visit& visit) {
  for (std::size_t i = 0; i < scene.tetrahedra.size(); ++i) {
    visit(CellKind::tetrahedron, i, cell_query(scene, CellKind::tetrahedron, i));
  }
  for (std::size_t i = 0; i < scene.plane_triangles.size(); ++i) {
    visit(CellKind::plane_triangle, i, cell_query(scene, CellKind::plane_triangle, i));
  }
}

/// Adds up to so many tetrahedra and triangles of the plane of any vertices; of those that are flat
/// or inverted at the start, one of `rare` stays.
inline void add_volumes(Scene& scene, int most, int rare, Random& random) {
  const auto vertices = static_cast<int>(scene.start.rows());
  const auto any = [&] { return random.between(0, vertices - 1); };
  const auto add = [&](auto& cells, CellKind kind, const auto& cell) {
    cells.push_back(cell);
    const auto start = [&] {
      return fast::inversion(CellKind::tetrahedron, cell_query(scene, kind, cells.size() - 1),
                             {.t_max = 0.0})
          .start;
    };
    if (start() < 0) std::swap(cells.back()[0], cells.back()[1]);
    if (start() <= 0 && random.between(1, rare) != 1) cells.pop_back();
  };
  for (int i = random.between(0, most); i > 0; --i) {
    add(scene.tetrahedra, CellKind::tetrahedron, fast::Tetrahedron{any(), any(), any(), any()});
    add(scene.plane_triangles, CellKind::plane_triangle, Face{any(), any(), any()});
    if (random.between(1, rare) == 1 && !scene.tetrahedra.empty()) {
      std::swap(scene.tetrahedra.back()[2], scene.tetrahedra.back()[3]);
    }
  }
}

// ---- All pairs one by one -----------------------------------------------------------------------

/// All pairs that a step examines, from its definition.
class AllPairs {
 public:
  explicit AllPairs(const Scene& scene) : scene_(scene) {
    std::vector<bool> has_edge(size(scene.start.rows()), false), is_named = has_edge;
    const auto set = [](std::vector<bool>& flags, auto&& vertices) {
      for (const std::int32_t i : vertices) flags[size(i)] = true;
    };
    for (const Edge& edge : scene.edges) set(has_edge, edge), set(is_named, edge);
    for (const Face& face : scene.faces) set(is_named, face);
    set(is_named, scene.points);
    for (std::int32_t i = 0; i < scene.start.rows(); ++i) {
      if (!is_named[size(i)]) continue;
      vertices_.push_back(i);
      if (!has_edge[size(i)]) points_.push_back(i);
    }
    for (std::size_t i = 0; i < scene.edges.size(); ++i) {
      if (!is_in_face(scene.edges[i])) bare_edges_.push_back(static_cast<std::int32_t>(i));
    }
    list();
  }

  [[nodiscard]] const Pairs& pairs() const { return pairs_; }

  [[nodiscard]] std::vector<std::int32_t> first(const NumberedPair& pair) const {
    if (pair.first == ContactKind::edge_edge) return of(scene_.edges[size(pair.second[0])]);
    return {pair.second[0]};
  }
  [[nodiscard]] std::vector<std::int32_t> second(const NumberedPair& pair) const {
    const std::int32_t number = pair.second[1];
    switch (pair.first) {
      case ContactKind::vertex_face:
        return of(scene_.faces[size(number)]);
      case ContactKind::edge_edge:
      case ContactKind::vertex_edge:
        return of(scene_.edges[size(number)]);
      case ContactKind::vertex_vertex:
        break;
    }
    return {number};
  }

  [[nodiscard]] std::vector<std::int32_t> vertices(const NumberedPair& pair) const {
    std::vector<std::int32_t> vertices = first(pair), others = second(pair);
    if (pair.first == ContactKind::vertex_edge) others.push_back(others[0]);
    if (pair.first == ContactKind::vertex_vertex) others.resize(3, others[0]);
    vertices.insert(vertices.end(), others.begin(), others.end());
    return vertices;
  }

  [[nodiscard]] Query query(const NumberedPair& pair) const {
    const std::vector<std::int32_t> vertices = this->vertices(pair);
    Query query;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      point_of(query, 0, i) = scene_.start.row(vertices[i]).transpose();
      point_of(query, 1, i) = scene_.end.row(vertices[i]).transpose();
    }
    return query;
  }

  /// The thickness, from its definition.
  [[nodiscard]] double thickness(const NumberedPair& pair) const {
    double result = 0.0;
    for (const std::int32_t a : first(pair)) {
      for (const std::int32_t b : second(pair)) {
        const auto two = ordered(group(a), group(b));
        const auto listed = std::ranges::find_if(scene_.separations, [&](const auto& one) {
          return ordered(one.groups[0], one.groups[1]) == two;
        });
        const bool has_radii = listed == scene_.separations.end() && !scene_.radii.empty();
        const double of_groups = listed != scene_.separations.end() ? listed->distance
                                 : has_radii
                                     ? scene_.radii[size(two[0])] + scene_.radii[size(two[1])]
                                     : 0.0;
        result = std::max(result, of_groups);
      }
    }
    return result;
  }

  /// True if the swept boxes are within the distance.
  [[nodiscard]] bool are_near(const NumberedPair& pair, double distance) const {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto [least_a, most_a] = range(first(pair), axis);
      const auto [least_b, most_b] = range(second(pair), axis);
      if (exact::Rational(least_a) - exact::Rational(most_b) > exact::Rational(distance))
        return false;
      if (exact::Rational(least_b) - exact::Rational(most_a) > exact::Rational(distance))
        return false;
    }
    return true;
  }

 private:
  template <class Number>
  static std::size_t size(Number number) {
    return static_cast<std::size_t>(number);
  }
  template <class Element>
  static std::vector<std::int32_t> of(const Element& element) {
    return {element.begin(), element.end()};
  }

  [[nodiscard]] bool is_in_face(const Edge& edge) const {
    return std::ranges::any_of(scene_.faces, [&](const Face& face) {
      const auto is_side = [&](std::size_t i) {
        return ordered(face[i], face[(i + 1) % 3]) == ordered(edge[0], edge[1]);
      };
      return is_side(0) || is_side(1) || is_side(2);
    });
  }

  [[nodiscard]] std::int32_t group(std::int32_t vertex) const {
    return scene_.groups.empty() ? 0 : scene_.groups[size(vertex)];
  }

  [[nodiscard]] bool may_meet(const NumberedPair& pair) const {
    bool some_meet = false;
    for (const std::int32_t a : first(pair)) {
      for (const std::int32_t b : second(pair)) {
        if (a == b) return false;
        const bool groups_meet =
            std::ranges::none_of(scene_.apart, [&](const std::array<std::int32_t, 2>& p) {
              return ordered(p[0], p[1]) == ordered(group(a), group(b));
            });
        some_meet |= groups_meet && (!scene_.can_collide || scene_.can_collide(a, b));
      }
    }
    return some_meet;
  }

  void add(ContactKind kind, std::int32_t a, std::int32_t b) {
    if (may_meet({kind, {a, b}})) pairs_.push_back({kind, {a, b}});
  }

  void list() {
    const auto faces = static_cast<std::int32_t>(scene_.faces.size());
    const auto edges = static_cast<std::int32_t>(scene_.edges.size());
    for (const std::int32_t vertex : vertices_) {
      for (std::int32_t face = 0; face < faces; ++face) add(ContactKind::vertex_face, vertex, face);
    }
    for (std::int32_t a = 0; a < edges; ++a) {
      for (std::int32_t b = a + 1; b < edges; ++b) add(ContactKind::edge_edge, a, b);
    }
    for (const std::int32_t point : points_) {
      for (const std::int32_t edge : bare_edges_) add(ContactKind::vertex_edge, point, edge);
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t k = i + 1; k < points_.size(); ++k) {
        add(ContactKind::vertex_vertex, points_[i], points_[k]);
      }
    }
  }

  [[nodiscard]] std::pair<double, double> range(const std::vector<std::int32_t>& vertices,
                                                Eigen::Index axis) const {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const std::int32_t vertex : vertices) {
      for (const Places* const places : {&scene_.start, &scene_.end}) {
        least = std::min(least, (*places)(vertex, axis));
        most = std::max(most, (*places)(vertex, axis));
      }
    }
    return {least, most};
  }

  const Scene& scene_;
  std::vector<std::int32_t> vertices_, points_, bare_edges_;
  Pairs pairs_;
};

}  // namespace touchstone::tests
