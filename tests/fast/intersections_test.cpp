#include "touchstone/intersections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "exact/contact/triangle_intersection.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::fast::intersections_test {
namespace {

using exact::RationalPoint;
using exact::RationalTriangle;
using tests::Random;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Found = std::vector<Intersection>;
using ContactKind = IntersectionKind;

Rows rows(std::initializer_list<std::array<double, 3>> points) {
  Rows result(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index i = 0;
  for (const auto& [x, y, z] : points) result.row(i++) << x, y, z;
  return result;
}

/// A mesh at rest.
struct Mesh {
  Rows vertices;
  std::vector<Face> faces = {};
  std::vector<Edge> edges = {};
  std::vector<std::int32_t> points = {};

  [[nodiscard]] fast::Mesh elements() const {
    return {.edges = edges, .faces = faces, .points = points};
  }
  [[nodiscard]] Found intersections(const IntersectionOptions& options = {}) const {
    return fast::intersections(vertices, elements(), options);
  }
};

// ---- Beside the oracle --------------------------------------------------------------------------

/// Two elements, by their vertices: the last one is repeated for an edge or a point.
using Pair = std::array<std::array<std::int32_t, 3>, 2>;

/// A power of two of which all coordinates are multiples: with integers the oracle is fast.
exact::Rational unit_of(const Rows& vertices) {
  exact::Rational unit = 1;
  for (const double x : vertices.reshaped()) {
    if (x == 0.0) continue;
    int exponent = 0;
    static_cast<void>(std::frexp(x, &exponent));
    unit = std::min(unit, exact::power_of_two(std::max(exponent - 53, -1074)));
  }
  return unit;
}

/// In units.
RationalTriangle hull_of(const Rows& vertices, const exact::Rational& unit,
                         const std::array<std::int32_t, 3>& corners) {
  RationalTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = vertices(corners[i], static_cast<Eigen::Index>(axis));
      result[i][axis] = exact::Rational(x) / unit;
    }
  }
  return result;
}

bool contains(const RationalTriangle& triangle, const RationalPoint& x) {
  return !exact::intersection_of({x, x, x}, triangle).empty();
}

/// 0, 1 or 2: what contains all these points of a triangle, a corner, an edge or only all of it.
int dimension_around(const RationalTriangle& triangle, const std::vector<RationalPoint>& points) {
  const std::vector<RationalPoint> corners = exact::intersection_of(triangle, triangle);
  const auto is_around = [&](const RationalPoint& p, const RationalPoint& q) {
    return std::ranges::all_of(points, [&](const RationalPoint& x) {
      return contains({p, q, q}, x);
    });
  };
  int dimension = 2;
  for (const RationalPoint& p : corners) {
    for (const RationalPoint& q : corners) {
      if (is_around(p, q)) dimension = std::min(dimension, p == q ? 0 : 1);
    }
  }
  return dimension;
}

PointEnclosure enclosure_of(const RationalPoint& x, const exact::Rational& unit) {
  PointEnclosure result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = exact::round_down(x[axis] * unit);
    result.upper[axis] = exact::round_up(x[axis] * unit);
  }
  return result;
}

/// The kind and the place by rational arithmetic; none if they do not intersect.
std::optional<std::pair<ContactKind, std::array<PointEnclosure, 2>>> truth_of(const Rows& vertices,
                                                                              const Pair& pair) {
  const exact::Rational unit = unit_of(vertices);
  const RationalTriangle a = hull_of(vertices, unit, pair[0]);
  const RationalTriangle b = hull_of(vertices, unit, pair[1]);
  const std::set<std::int32_t> of_a(pair[0].begin(), pair[0].end());
  const std::set<std::int32_t> of_b(pair[1].begin(), pair[1].end());
  std::vector<std::int32_t> common;
  std::ranges::set_intersection(of_a, of_b, std::back_inserter(common));
  const std::vector<RationalPoint> corners = exact::intersection_of(a, b);
  const bool are_duplicates = of_a == of_b;
  const bool is_common =
      !common.empty() && std::ranges::all_of(corners, [&](const RationalPoint& x) {
        return contains(
            hull_of(vertices, unit, {common[0], common[common.size() / 2], common.back()}), x);
      });
  if (corners.empty() || (is_common && !are_duplicates)) return std::nullopt;
  const std::array place{enclosure_of(std::ranges::min(corners), unit),
                         enclosure_of(std::ranges::max(corners), unit)};
  if (are_duplicates) return std::pair(ContactKind::duplicates, place);
  if (corners.size() > 2) {
    return std::pair(common.size() == 2 ? ContactKind::folded_faces : ContactKind::coplanar_overlap,
                     place);
  }
  const int in_a = dimension_around(a, corners), in_b = dimension_around(b, corners);
  if (corners.size() == 2) {
    return std::pair(in_a + in_b == 2 ? ContactKind::edges_overlap : ContactKind::edge_through_face,
                     place);
  }
  static constexpr std::array<std::array<ContactKind, 3>, 3> of_point{
      {{ContactKind::vertices_coincide, ContactKind::vertex_on_edge, ContactKind::vertex_in_face},
       {ContactKind::vertex_on_edge, ContactKind::edges_cross, ContactKind::edge_through_face},
       {ContactKind::vertex_in_face, ContactKind::edge_through_face,
        ContactKind::edge_through_face}}};
  return std::pair(of_point[static_cast<std::size_t>(in_a)][static_cast<std::size_t>(in_b)], place);
}

/// A pair as a mesh, with its edges and points as such or as faces that name a vertex twice.
Mesh mesh_of(const Rows& vertices, const Pair& pair, bool are_faces) {
  Mesh mesh{.vertices = vertices};
  if (are_faces) {
    mesh.faces.assign(pair.begin(), pair.end());
    return mesh;
  }
  for (const auto& [a, b, c] : pair) {
    if (a == b && b == c) {
      mesh.points.push_back(a);
    } else if (b == c) {
      mesh.edges.push_back({a, b});
    } else {
      mesh.faces.push_back({a, b, c});
    }
  }
  if (mesh.edges.empty()) return mesh;
  for (const Edge& edge : edges_of(mesh.faces)) mesh.edges.push_back(edge);
  return mesh;
}

/// An element whose vertices are partly those of `others`.
std::array<std::int32_t, 3> random_element(Random& random, std::int32_t first,
                                           std::span<const std::int32_t> others) {
  std::array<std::int32_t, 3> result{first, first + 1, first + 2};
  const int common = random.between(0, static_cast<int>(others.size()));
  for (std::size_t i = 0; std::cmp_less(i, common); ++i) result[i] = others[i];
  std::ranges::rotate(result, result.begin() + random.between(0, 2));
  if (random.coin()) std::swap(result[0], result[1]);
  const int corners = std::min(3, random.between(1, 10));
  for (std::size_t i = static_cast<std::size_t>(corners); i < 3; ++i) result[i] = result[i - 1];
  return result;
}

class Trial {
 public:
  explicit Trial(Random& random) {
    pair_[0] = random_element(random, 0, {});
    std::set<std::int32_t> different(pair_[0].begin(), pair_[0].end());
    const std::vector<std::int32_t> others(different.begin(), different.end());
    pair_[1] = random_element(random, 3, others);
    vertices_.resize(6, 3);
    // A point or an edge that is named twice is one element.
    different.insert(pair_[1].begin(), pair_[1].end());
    are_faces_ = random.between(0, 3) == 0 || different.size() < 3;
    const int greatest = random.between(1, 4);
    for (double& x : vertices_.reshaped()) x = random.between(-greatest, greatest);
    if (random.between(0, 5) == 0) {
      for (double& x : vertices_.reshaped()) x = random.few_bit_double(53, -52, -51);
    }
    if (random.between(0, 3) == 0) {  // inside the first element
      vertices_.row(random.between(3, 5)) =
          (vertices_.row(0) + vertices_.row(1) + 2.0 * vertices_.row(2)) / 4.0;
    }
    // Coplanar pairs, and neighbouring doubles.
    if (random.between(0, 3) == 0) vertices_.col(random.between(0, 2)).setConstant(1.0);
    if (random.between(0, 3) == 0) vertices_.col(0) = vertices_.col(1) * 3.0 + vertices_.col(2);
    if (random.between(0, 3) == 0) {
      double& x = vertices_(random.between(0, 5), random.between(0, 2));
      x = std::nextafter(x, x + random.between(-1, 1));
    }
    static constexpr std::array<int, 8> exponents{0, 0, -1000, 1000, -1074, 1018, -300, 400};
    const int exponent = exponents[static_cast<std::size_t>(random.between(0, 7))];
    for (double& x : vertices_.reshaped()) x = std::ldexp(x, exponent);
    // Too much for one scale.
    if (random.between(0, 39) == 0) vertices_.col(random.between(0, 2)) *= 0x1p-1000;
  }

  /// Expects the truth, and returns the kind.
  [[nodiscard]] std::optional<ContactKind> run() const {
    const Found found = mesh().intersections();
    const auto truth = truth_of(vertices_, pair_);
    EXPECT_EQ(found.size(), truth ? 1U : 0U) << text();
    if (!truth) return std::nullopt;
    if (found.size() == 1) {
      EXPECT_EQ(found[0].kind, truth->first) << text() << to_string(found[0].kind);
      EXPECT_EQ(found[0].place, truth->second) << text();
    }
    return truth->first;
  }
  [[nodiscard]] Mesh mesh() const { return mesh_of(vertices_, pair_, are_faces_); }

 private:
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out << std::hexfloat << vertices_ << '\n';
    for (const auto& [a, b, c] : pair_) out << a << ' ' << b << ' ' << c << '\n';
    return out.str();
  }

  Rows vertices_;
  Pair pair_;
  bool are_faces_;
};

TEST(Intersections, OfTwoElementsAreThoseOfRationalArithmetic) {
  Random random(540);
  std::array<int, intersection_kinds> seen{};
  const int count = tests::soak_trials(10000, 100);
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    const Trial trial(random);
    if (const auto kind = trial.run()) ++seen.at(static_cast<std::size_t>(*kind));
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    EXPECT_GT(seen[kind], tests::trials(20)) << to_string(static_cast<ContactKind>(kind));
  }
}

/// A mesh of few vertices of small whole numbers, so that elements have common vertices, are
/// coplanar, folded over each other, and touch; and what is asked of it.
struct Asked {
  Mesh mesh;
  std::vector<std::int32_t> groups = {};
  std::vector<std::array<std::int32_t, 2>> apart = {};
  bool weld = false;
  IntersectingPairs pairs = IntersectingPairs::all;

  explicit Asked(Random& random) {
    const int vertices = random.between(4, 12), greatest = random.between(1, 3);
    mesh.vertices.resize(vertices, 3);
    for (double& x : mesh.vertices.reshaped()) x = random.between(-greatest, greatest);
    if (random.between(0, 2) == 0) mesh.vertices.col(random.between(0, 2)).setConstant(5.0);
    const auto any = [&] { return random.between(0, vertices - 1); };
    for (int i = random.between(0, 5); i > 0; --i) mesh.faces.push_back({any(), any(), any()});
    mesh.edges = edges_of(mesh.faces);
    for (int i = random.between(0, 3); i > 0; --i) mesh.edges.push_back({any(), any()});
    for (int i = random.between(0, 3); i > 0; --i) mesh.points.push_back(any());
    for (int i = 0; i < vertices; ++i) groups.push_back(random.between(0, 2));
    for (int i = random.between(0, 2); i > 0; --i) {
      apart.push_back(
          {groups[static_cast<std::size_t>(any())], groups[static_cast<std::size_t>(any())]});
    }
    weld = random.between(0, 2) == 0;
    if (random.coin()) pairs = IntersectingPairs::edges_with_faces;
  }

  [[nodiscard]] IntersectionOptions options() const {
    return {.pairs = pairs, .groups = {.of_vertices = groups, .apart = apart}, .weld = weld};
  }

  /// The intersections of all pairs, one by one.
  [[nodiscard]] Found truth() const {
    Found expected;
    const std::vector<Element> elements = this->elements();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (std::size_t k = i + 1; k < elements.size(); ++k) {
        const Element &a = elements[i], &b = elements[k];
        if (!is_asked(a, b)) continue;
        const auto truth = truth_of(mesh.vertices, {a.corners, b.corners});
        if (!truth) continue;
        expected.push_back({.elements = {a.kind, b.kind},
                            .numbers = {a.number, b.number},
                            .kind = truth->first,
                            .place = truth->second});
      }
    }
    return expected;
  }

 private:
  using Corners = std::array<std::int32_t, 3>;
  /// The last corner is repeated for an edge or a point.
  struct Element {
    PrimitiveKind kind;
    std::int32_t number;
    Corners corners;
  };

  [[nodiscard]] std::int32_t group(std::int32_t vertex) const {
    return groups[static_cast<std::size_t>(vertex)];
  }
  /// The first vertex at its place, of its group, if they are welded.
  [[nodiscard]] std::int32_t welded(std::int32_t vertex) const {
    std::int32_t first = 0;
    while (group(first) != group(vertex) || mesh.vertices.row(first) != mesh.vertices.row(vertex)) {
      ++first;
    }
    return weld ? first : vertex;
  }

  /// Faces, edges of none (all edges to be asked about with faces), points of neither, of which the
  /// first is named; an edge from a vertex to itself is its vertex.
  [[nodiscard]] std::vector<Element> elements() const {
    std::vector<Element> result;
    std::set<Edge> edges;
    std::set<std::int32_t> taken, points(mesh.points.begin(), mesh.points.end());
    const auto add = [&](PrimitiveKind kind, auto number, const Corners& corners) {
      result.push_back({kind, static_cast<std::int32_t>(number), corners});
      taken.insert(corners.begin(), corners.end());
    };
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const auto [a, b, c] = mesh.faces[i];
      const Corners corners{welded(a), welded(b), welded(c)};
      add(PrimitiveKind::face, i, corners);
      if (pairs != IntersectingPairs::all) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        edges.insert(tests::ordered(corners[k], corners[(k + 1) % 3]));
      }
    }
    for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
      const auto [a, b] = mesh.edges[i];
      const Edge edge = tests::ordered(welded(a), welded(b));
      if (edge[0] == edge[1]) points.insert(std::min(a, b));
      if (edge[0] == edge[1] || !edges.insert(edge).second) continue;
      add(PrimitiveKind::edge, i, {edge[0], edge[1], edge[1]});
    }
    for (const std::int32_t i : points) {
      const std::int32_t vertex = welded(i);
      if (!taken.contains(vertex)) add(PrimitiveKind::point, i, {vertex, vertex, vertex});
    }
    return result;
  }

  [[nodiscard]] bool is_asked(const Element& a, const Element& b) const {
    bool some_meet = false, share_vertex = false;
    for (const std::int32_t i : a.corners) {
      for (const std::int32_t k : b.corners) {
        share_vertex |= i == k;
        some_meet |= std::ranges::none_of(apart, [&](const auto& two) {
          return tests::ordered(two[0], two[1]) == tests::ordered(group(i), group(k));
        });
      }
    }
    if (!some_meet || pairs == IntersectingPairs::all) return some_meet;
    return a.kind == PrimitiveKind::face && b.kind == PrimitiveKind::edge && !share_vertex;
  }
};

TEST(Intersections, OfAMeshAreThoseOfRationalArithmetic) {
  Random random(542);
  std::map<IntersectingPairs, std::size_t> count;
  for (int i = 0; i < tests::trials(400); ++i) {
    const Asked asked(random);
    const Found found = asked.mesh.intersections(asked.options());
    ASSERT_EQ(found, asked.truth()) << i;
    EXPECT_EQ(has_intersections(asked.mesh.vertices, asked.mesh.elements(), asked.options()),
              !found.empty());
    count[asked.pairs] += found.size();
    IntersectionOptions some = asked.options();
    some.most = static_cast<std::size_t>(random.between(0, 3));
    const auto first = std::span(found).first(std::min(some.most, found.size()));
    ASSERT_EQ(asked.mesh.intersections(some), Found(first.begin(), first.end())) << i;
  }
  for (const auto& [pairs, found] : count) EXPECT_GT(found, tests::trials(100U));
}

// Two corners are between the same doubles on the x axis: the one of the greater y is the least.
TEST(Intersections, HaveTheCornersOfAnAreaInTheirExactOrder) {
  const double before_1 = 1 - 0x1p-53;
  const Mesh mesh{rows({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, -1, 0}, {before_1, 2, 0}, {5, 0, 0}}),
                  {{0, 1, 2}, {3, 4, 5}}};
  const auto place = mesh.intersections().at(0).place;
  EXPECT_EQ(place, truth_of(mesh.vertices, {mesh.faces[0], mesh.faces[1]})->second);
  EXPECT_EQ(place[0].lower, (std::array{before_1, 1.0, 0.0}));
  EXPECT_EQ(place[1].upper, (std::array{2.0, 0.0, 0.0}));
}

TEST(Intersections, OfEdgesWithFacesAreByDefaultOfTheirOwnEdges) {
  Random random(546);
  std::size_t count = 0;
  for (int i = 0; i < 100; ++i) {
    Mesh mesh = Asked(random).mesh;
    mesh.edges = edges_of(mesh.faces);
    const IntersectionOptions options{.pairs = IntersectingPairs::edges_with_faces};
    const Found found = mesh.intersections(options);
    mesh.edges.clear();
    EXPECT_EQ(mesh.intersections(options), found);
    count += found.size();
  }
  EXPECT_GT(count, 20U);
}

// ---- The filter ---------------------------------------------------------------------------------

/// Pairs of triangles in one mesh, each with vertices of its own.
class FilterTrial {
 public:
  /// With that number of common vertices.
  FilterTrial(Random& random, int common) {
    const int pairs = random.between(1, 20), vertices = 6 - common;
    mesh_.vertices.resize(static_cast<Eigen::Index>(pairs * vertices), 3);
    for (int pair = 0; pair < pairs; ++pair) {
      const int first = pair * vertices;
      place(random, mesh_.vertices.middleRows(first, vertices));
      Face a{first, first + 1, first + 2}, b{first + 3, first + 4, first + 5};
      for (std::size_t i = 0; i < 3; ++i) b[i] -= std::cmp_less(i, common) ? 3 : common;
      for (Face* const face : {&a, &b}) {
        std::ranges::rotate(*face, face->begin() + random.between(0, 2));
        if (random.coin()) std::swap((*face)[0], (*face)[1]);
        mesh_.faces.push_back(*face);
        rows_.push_back({(*face)[0], (*face)[1], (*face)[2], 0});
      }
      pairs_.push_back({2 * pair, 2 * pair + 1});
    }
  }

  /// Numbers of pairs, and whether they certainly cross, or intersect with edge_through_face.
  using Numbers = std::vector<std::pair<std::int32_t, bool>>;

  /// The pairs that a kernel does not leave out.
  [[nodiscard]] Numbers left_by(const TriangleKernel& kernel) const {
    std::vector<PlaceAtRest> places;
    for (const auto& row : mesh_.vertices.rowwise()) places.push_back({row[0], row[1], row[2]});
    const auto sorted = std::make_unique<SortedPairs>();
    const auto filtered = std::make_unique<FilteredPairs>();
    kernel.sort(rows_.data(), pairs_, *sorted);
    for (std::size_t list = 0; list < 3; ++list) {
      kernel.filter(places.data(), list, std::span(sorted->lists[list]).first(sorted->count[list]),
                    *filtered);
    }
    Numbers result;
    const auto add = [&](const IndexPair& pair, bool crosses) {
      result.emplace_back(pair[0] / 2, crosses);
    };
    for (std::size_t i = 0; i < sorted->count[3]; ++i) add(sorted->lists[3][i].pair, false);
    for (std::size_t i = 0; i < filtered->open_count; ++i) add(filtered->open[i], false);
    for (std::size_t i = 0; i < filtered->crossing_count; ++i) add(filtered->crossing[i], true);
    std::ranges::sort(result);
    return result;
  }
  /// Those that intersect.
  [[nodiscard]] Numbers truth() const {
    Numbers result;
    for (const auto& [a, b] : pairs_) {
      const auto truth = truth_of(mesh_.vertices, {mesh_.faces[static_cast<std::size_t>(a)],
                                                   mesh_.faces[static_cast<std::size_t>(b)]});
      if (truth) result.emplace_back(a / 2, truth->first == ContactKind::edge_through_face);
    }
    return result;
  }
  /// True if no pair is left out that intersects, and those that cross do.
  static bool agree(const Numbers& left, const Numbers& truth) {
    return std::ranges::all_of(truth,
                               [&](const auto& one) {
                                 return std::ranges::any_of(left, [&](const auto& other) {
                                   return other.first == one.first;
                                 });
                               }) &&
           std::ranges::all_of(left, [&](const auto& one) {
             return !one.second || std::ranges::find(truth, one) != truth.end();
           });
  }
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }

 private:
  /// Small whole numbers, doubles, nearly coplanar ones, or coplanar ones of which one is nearly on
  /// a line with two others.
  template <class Places>
  static void place(Random& random, Places&& places) {
    const int greatest = random.between(1, 4), kind = random.between(0, 4);
    for (double& x : places.reshaped()) {
      x = kind % 4 == 0 ? random.few_bit_double(53, -52, -51) : random.between(-greatest, greatest);
    }
    if (kind == 2 || kind == 3) places.col(2) = places.col(0) * 0.1 + places.col(1) * 0.3;
    if (kind == 3) places.col(2) *= 1.0 + 0x1p-52 * random.between(-2, 2);
    if (kind == 4) {
      const auto row = [&] { return random.between(0, static_cast<int>(places.rows()) - 1); };
      const int a = row(), b = row();
      const double part = 0.1 * random.between(1, 9);
      places.row(row()) = places.row(a) + part * (places.row(b) - places.row(a));
      places.col(2).setZero();
    }
  }

  Mesh mesh_;
  std::vector<ElementRow> rows_;
  std::vector<IndexPair> pairs_;
};

TEST(TriangleFilter, LeavesWhatIntersectsAndTheSameOnAllInstructionSets) {
  Random random(543);
  for (int common = 0; common < 3; ++common) {
    std::size_t pairs = 0, left = 0, crossing = 0, intersecting = 0;
    for (int i = 0; i < tests::soak_trials(60, 100); ++i) {
      const FilterTrial trial(random, common);
      const FilterTrial::Numbers found = trial.left_by(*triangle_kernels()[0]);
      for (const TriangleKernel* const kernel : triangle_kernels()) {
        ASSERT_EQ(trial.left_by(*kernel), found) << to_string(kernel->instructions);
      }
      const FilterTrial::Numbers truth = trial.truth();
      ASSERT_TRUE(FilterTrial::agree(found, truth)) << common;
      pairs += trial.size();
      left += found.size();
      intersecting += truth.size();
      for (const auto& [number, is_certain] : found) crossing += is_certain ? 1 : 0;
    }
    EXPECT_GT(intersecting, pairs / 50) << common;
    EXPECT_GT(pairs - left, (pairs - intersecting) / 3) << common;
    EXPECT_EQ(crossing > intersecting / 20, common < 2) << common;
  }
}

TEST(TriangleFilter, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().triangle_filter) {
    Random random(544);
    bool is_found = false;
    for (int i = 0; i < 3000 && !is_found; ++i) {
      const FilterTrial trial(random, i % 3);
      const FilterTrial::Numbers left = trial.left_by(*fault.part);
      // (The truth takes longer.)
      is_found =
          left != trial.left_by(*triangle_kernels()[0]) && !FilterTrial::agree(left, trial.truth());
    }
    EXPECT_TRUE(is_found) << fault.name;
  }
}

// ---- Steps and options --------------------------------------------------------------------------

/// Those of a step at its start, of groups that can collide.
TEST(Intersections, OfAStepsStart) {
  const Mesh mesh{rows({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 1}}),
                  {{0, 1, 2}, {3, 4, 5}}};
  Rows lifted = mesh.vertices;
  lifted.bottomRows(3).col(2).array() += 5.0;
  const Step meeting(mesh.vertices, lifted, mesh.elements()), free(lifted, lifted, mesh.elements());
  const Step of_groups(mesh.vertices, lifted, mesh.elements(),
                       {.groups = {.of_vertices = {0, 0, 0, 1, 1, 1}, .apart = {{0, 1}}}});
  EXPECT_EQ(meeting.intersections_at_start(), mesh.intersections());
  EXPECT_EQ(mesh.intersections().size(), 1U);
  EXPECT_FALSE(meeting.starts_free());
  EXPECT_TRUE(free.starts_free());
  EXPECT_TRUE(of_groups.starts_free());
}

TEST(Intersections, AreTheSameInAnyNumberOfThreadsAndFloatingPointState) {
  Random random(545);
  const tests::Scene soup = tests::soup(random, 100, 0.3);
  const Mesh mesh{soup.start, soup.faces, soup.edges, soup.points};
  const Found found = mesh.intersections({.max_threads = 1});
  EXPECT_GT(found.size(), 50U);
  EXPECT_EQ(mesh.intersections({.max_threads = 3}), found);
  Found without = mesh.intersections({.places = false});
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(without.at(i).place, decltype(without[i].place){});
    without[i].place = found[i].place;
  }
  EXPECT_EQ(without, found);
  const Rows rounded = mesh.vertices.cast<float>().cast<double>();
  EXPECT_EQ(intersections(rounded.cast<float>(), mesh.elements()),
            intersections(rounded, mesh.elements()));
}

TEST(Intersections, AreNotDefects) {
  const Mesh mesh{
      .vertices = rows(
          {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {7, 7, 7}, {0, -0.0, 0}, {0x1p-1074, 0, 0}}),
      .faces = {{0, 1, 2}, {0, 1, 3}, {0, 0, 3}, {3, 0, 6}}};
  const MeshDefects defects = mesh_defects(mesh.vertices, mesh.elements());
  EXPECT_EQ(defects.degenerate_faces, (std::vector<std::int32_t>{0, 2}));
  EXPECT_EQ(defects.degenerate_edges, (std::vector<std::int32_t>{}));
  EXPECT_EQ(defects.duplicated_vertices, (std::vector<IndexPair>{{5, 0}}));
  EXPECT_EQ(defects.unreferenced_vertices, (std::vector<std::int32_t>{4, 5}));
  EXPECT_EQ(mesh_defects(mesh.vertices, {.edges = {{0, 1}, {0, 5}, {2, 2}}}).degenerate_edges,
            (std::vector<std::int32_t>{1, 2}));
}

TEST(Intersections, OfBadInputAreRefused) {
  using tests::message_of;
  Mesh mesh{.vertices = Rows::Zero(4, 3), .faces = {{0, 1, 4}}};
  EXPECT_EQ(message_of<std::out_of_range>([&] { (void)mesh.intersections(); }),
            "face 0: vertex 4, but there are 4");
  mesh.faces.pop_back();
  EXPECT_THROW((void)mesh.intersections({.max_threads = -1}), std::invalid_argument);
  EXPECT_THROW((void)intersections(Rows(mesh.vertices).leftCols(2), mesh.elements()),
               std::invalid_argument);
  mesh.faces.push_back({3, 1, 2});
  const std::atomic<bool> stop = true;
  EXPECT_THROW((void)mesh.intersections({.stop = &stop}), Stopped);
  mesh.vertices(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)mesh.intersections(), std::domain_error);
  EXPECT_THROW((void)mesh_defects(mesh.vertices, mesh.elements()), std::domain_error);
  EXPECT_TRUE(intersections(Rows(0, 3), {}).empty());
}

// ---- Faults -------------------------------------------------------------------------------------

TEST(Intersections, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().intersections) {
    Random random(541);
    bool is_found = false;
    for (int i = 0; i < 20000 && !is_found; ++i) {
      const Mesh mesh = Trial(random).mesh();
      const IntersectionOptions options{
          .pairs = i % 4 == 0 ? IntersectingPairs::edges_with_faces : IntersectingPairs::all,
          .max_threads = 1};
      is_found = fault.part(Motion(mesh.vertices, mesh.vertices), mesh.elements(), options) !=
                 mesh.intersections(options);
    }
    EXPECT_TRUE(is_found) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::intersections_test
