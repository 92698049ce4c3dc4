#include "touchstone/curved_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::curved_step_test {
namespace {

using tests::Random;

/// Some triangles, a bare edge and some points, all moving on curves.
struct Scene {
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<std::int32_t> points;

  [[nodiscard]] CurvedVertices vertices() const { return {degree, is_rational, numbers}; }
  [[nodiscard]] MeshElements elements() const {
    return {.edges = edges, .faces = faces, .points = points};
  }
};

Scene random_scene(Random& random, std::size_t degree, bool is_rational) {
  Scene scene{.degree = degree,
              .is_rational = is_rational,
              .numbers = {},
              .faces = {},
              .edges = {},
              .points = {}};
  const int triangles = 6, vertices = 3 * triangles + 4;
  for (int vertex = 0; vertex < vertices; ++vertex) {
    const int body = vertex / 3;
    for (std::size_t k = 0; k <= degree; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const double place = axis == 0 ? body % 3 : axis == 1 ? body / 3 : 0;
        scene.numbers.push_back(place + 0.9 * random.uniform(-1, 1));
      }
      if (is_rational) scene.numbers.push_back(k == 1 ? 2.0 : 1.0);
    }
  }
  for (int i = 0; i < triangles; ++i) scene.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  scene.edges = edges_of(scene.faces);
  scene.edges.push_back({3 * triangles, 3 * triangles + 1});
  scene.points = {3 * triangles + 2, 3 * triangles + 3};
  return scene;
}

using Key = std::tuple<PairKind, std::int32_t, std::int32_t>;

/// All pairs without a common vertex that collide, by the oracle, with their times.
std::vector<std::pair<Key, exact::AlgebraicNumber>> truth(const Scene& scene,
                                                          const Separation& separation) {
  const std::size_t stride = scene.is_rational ? 4 : 3, size = (scene.degree + 1) * stride;
  std::vector<std::pair<Key, exact::AlgebraicNumber>> result;
  const auto decide = [&](PairKind kind, std::int32_t i, std::int32_t j,
                          const std::array<std::int32_t, 4>& vertices, std::size_t of_first) {
    for (std::size_t a = 0; a < of_first; ++a) {
      for (std::size_t b = of_first; b < 4; ++b) {
        if (vertices.at(a) == vertices.at(b)) return;
      }
    }
    CurvedQuery query;
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t k = 0; k <= scene.degree; ++k) {
        const double* const x =
            scene.numbers.data() + static_cast<std::size_t>(vertices.at(point)) * size + k * stride;
        query.at(point).control.push_back({x[0], x[1], x[2]});
        if (scene.is_rational) query.at(point).weights.push_back(x[3]);
      }
    }
    const exact::Decision decision = exact::decide(Step::kind_of(kind), query, separation);
    if (decision.toi) result.push_back({{kind, i, j}, *decision.toi});
  };
  const auto vertices = static_cast<std::int32_t>(scene.numbers.size() / size);
  const auto edges = static_cast<std::int32_t>(scene.edges.size());
  for (std::int32_t v = 0; v < vertices; ++v) {
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(scene.faces.size()); ++f) {
      const Face& face = scene.faces.at(static_cast<std::size_t>(f));
      decide(PairKind::vertex_face, v, f, {v, face[0], face[1], face[2]}, 1);
    }
  }
  for (std::int32_t a = 0; a < edges; ++a) {
    for (std::int32_t b = a + 1; b < edges; ++b) {
      const Edge &one = scene.edges.at(static_cast<std::size_t>(a)),
                 &other = scene.edges.at(static_cast<std::size_t>(b));
      decide(PairKind::edge_edge, a, b, {one[0], one[1], other[0], other[1]}, 2);
    }
  }
  const Edge& bare = scene.edges.back();
  for (const std::int32_t v : scene.points) {
    decide(PairKind::vertex_edge, v, edges - 1, {v, bare[0], bare[1], bare[0]}, 1);
  }
  decide(PairKind::vertex_vertex, scene.points[0], scene.points[1],
         {scene.points[0], scene.points[1], scene.points[1], scene.points[1]}, 1);
  return result;
}

Key key_of(const StepCollision& collision) {
  return {collision.kind, collision.pair[0], collision.pair[1]};
}

TEST(CurvedStep, HasTheCollisionsOfAllPairs) {
  Random random(97);
  int free = 0, collide = 0;
  for (int round = 0; round < 24; ++round) {
    const Scene scene =
        random_scene(random, 1 + static_cast<std::size_t>(round) % 3, round % 4 == 1);
    const Separation separation =
        round % 2 == 0 ? Separation{} : Separation{.distance = 0.05, .norm = Norm::l2};
    auto expected = truth(scene, separation);
    const CurvedStep step(scene.vertices(), scene.elements(),
                          {.separation = separation, .max_threads = 1 + round % 2});
    std::set<Key> found, keys;
    for (const StepCollision& collision : step.collisions()) found.insert(key_of(collision));
    for (const auto& [key, toi] : expected) keys.insert(key);
    EXPECT_EQ(found, keys) << round;
    EXPECT_EQ(step.is_free(), keys.empty());
    const auto earliest = step.earliest();
    ASSERT_EQ(earliest.has_value(), !keys.empty());
    if (!earliest) {
      ++free;
      continue;
    }
    ++collide;
    const auto first = std::ranges::min_element(
        expected, [](auto& a, auto& b) { return compare(a.second, b.second) < 0; });
    EXPECT_GE(exact::Rational(earliest->toi_upper), first->second);
    EXPECT_LE(exact::Rational(earliest->toi_lower), first->second);
    EXPECT_TRUE(std::ranges::any_of(earliest->pairs, [&](const StepCollision& collision) {
      return key_of(collision) == first->first;
    }));
  }
  EXPECT_GT(collide, 5);
  EXPECT_GT(free, 1);
}

TEST(CurvedStep, OfDegreeOneIsAStep) {
  Random random(98);
  for (int round = 0; round < 10; ++round) {
    const Scene scene = random_scene(random, 1, false);
    std::vector<double> before, after;
    for (std::size_t i = 0; i < scene.numbers.size(); i += 6) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        before.push_back(scene.numbers[i + axis]);
        after.push_back(scene.numbers[i + 3 + axis]);
      }
    }
    const Step straight(std::span<const double>(before), std::span<const double>(after),
                        scene.elements());
    const CurvedStep curved(scene.vertices(), scene.elements());
    std::set<Key> expected, found;
    for (const StepCollision& collision : straight.collisions()) expected.insert(key_of(collision));
    for (const StepCollision& collision : curved.collisions()) found.insert(key_of(collision));
    EXPECT_EQ(found, expected);
    const auto one = straight.earliest(), other = curved.earliest();
    ASSERT_EQ(one.has_value(), other.has_value());
    if (!one) continue;
    EXPECT_LE(std::max(one->toi_lower, other->toi_lower),
              std::min(one->toi_upper, other->toi_upper));
  }
}

TEST(CurvedStep, CountsNoLaterContacts) {
  // A vertex falls to a face at rest, at t = 1/2.
  const std::vector<double> numbers{1, 1, 1, 1, 1, 0, 1, 1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                    4, 0, 0, 4, 0, 0, 4, 0, 0,  0, 4, 0, 0, 4, 0, 0, 4, 0};
  const std::vector<Face> faces{{1, 2, 3}};
  const std::vector<std::int32_t> points{0};
  const CurvedVertices vertices{2, false, numbers};
  const MeshElements elements{.faces = faces, .points = points};
  EXPECT_FALSE(CurvedStep(vertices, elements, {.t_max = 0.5}).is_free());
  EXPECT_TRUE(CurvedStep(vertices, elements, {.t_max = 0.499}).is_free());
  EXPECT_EQ(CurvedStep(vertices, elements).earliest()->pairs.size(), 1U);
}

TEST(CurvedStep, RefusesWhatIsNoMotion) {
  std::vector<double> numbers(2 * 4 * 2, 1.0);
  const std::vector<std::int32_t> points{0, 1};
  const MeshElements elements{.points = points};
  EXPECT_NO_THROW(CurvedStep({1, true, numbers}, elements));
  EXPECT_THROW(CurvedStep({2, true, numbers}, elements), std::invalid_argument);
  EXPECT_THROW(CurvedStep({9, false, {}}, {}), std::invalid_argument);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    numbers[11] = bad;
    EXPECT_THROW(CurvedStep({1, true, numbers}, elements), std::domain_error);
  }
}

}  // namespace
}  // namespace touchstone::fast::curved_step_test
