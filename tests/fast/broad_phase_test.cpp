#include "touchstone/broad_phase.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/messages.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "touchstone/number.hpp"

namespace touchstone::fast::broad_phase_test {
namespace {

using exact::Rational;
using tests::Places;
using tests::Random;
using tests::Scene;
using Pairs = std::vector<IndexPair>;

constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

Pairs found_vertex_face(const Scene& scene, const BroadPhaseOptions& options = {}) {
  return sorted(vertex_face_candidates({scene.start, scene.end}, scene.faces, options));
}

Pairs found_edge_edge(const Scene& scene, const BroadPhaseOptions& options = {}) {
  return sorted(edge_edge_candidates({scene.start, scene.end}, scene.edges, options));
}

/// Every vertex counts, and all may meet.
Scene of_all_vertices(Scene scene) {
  scene.points.resize(static_cast<std::size_t>(scene.start.rows()));
  std::iota(scene.points.begin(), scene.points.end(), 0);
  scene.groups.clear();
  scene.apart.clear();
  return scene;
}

/// A small scene of a shape, or a large one: triangles and edges with a size and motion of their
/// own.
Scene scene_of(Random& random, const tests::Shape& shape, bool is_large) {
  if (!is_large) {
    return of_all_vertices(tests::random_scene(random, shape, random.between(1, 24)));
  }
  Scene scene = tests::soup(random, 60, 0.1);
  for (Places* const places : {&scene.start, &scene.end}) {
    for (double& x : places->reshaped()) {
      if (random.between(0, 3) == 0) x = shape.coordinate(random);
    }
  }
  return of_all_vertices(scene);
}

class BroadPhaseOn : public testing::TestWithParam<tests::Shape> {};

/// The pairs whose swept boxes are within the distance, one by one.
TEST_P(BroadPhaseOn, FindsExactlyAllPairsWithinTheSeparation) {
  Random random(10);
  std::size_t found = 0, others = 0;
  for (const double separation :
       {0.0, 0.125, 0.1, 5 * tiniest, 1e-16, GetParam().separation, 1e308, greatest}) {
    for (const bool is_large : {false, false, false, true}) {
      const Scene scene = scene_of(random, GetParam(), is_large);
      std::map<ContactKind, Pairs> near;
      for (const tests::AllPairs all(scene); const tests::NumberedPair& pair : all.pairs()) {
        const bool is_near = all.are_near(pair, separation);
        if (is_near) near[pair.first].push_back(pair.second);
        ++(is_near ? found : others);
      }
      const BroadPhaseOptions options{.separation = {.distance = separation}};
      EXPECT_EQ(found_vertex_face(scene, options), sorted(near[ContactKind::vertex_face]))
          << separation;
      EXPECT_EQ(found_edge_edge(scene, options), sorted(near[ContactKind::edge_edge]))
          << separation;
    }
  }
  EXPECT_GT(found, 100U);
  EXPECT_GT(others, 100U);
}

TEST(BroadPhase, GivesTheSamePairsInOneOrderWithAnyThreads) {
  Random random(14);
  const Scene scene = tests::soup(random, 10'000, 0.03);
  const Motion vertices{scene.start, scene.end};
  const Pairs vertex_face = vertex_face_candidates(vertices, scene.faces, {.max_threads = 1}),
              edge_edge = edge_edge_candidates(vertices, scene.edges, {.max_threads = 1});
  for (const int threads : {0, 2, 1'000'000}) {
    const BroadPhaseOptions options{.max_threads = threads};
    EXPECT_EQ(vertex_face_candidates(vertices, scene.faces, options), vertex_face);
    EXPECT_EQ(edge_edge_candidates(vertices, scene.edges, options), edge_edge);
  }
}

std::vector<tests::Shape> all_shapes() {
  std::vector<tests::Shape> all = tests::shapes();
  all.push_back({"one cell", [](Random& r) { return 1.0 + r.uniform(-1e-15, 1e-15); }, {}, 1e-16});
  // Gaps of the separation, and of one more or less spacing of doubles.
  all.push_back({"by one bit",
                 [](Random& r) {
                   const double x = 0.1 * r.between(0, 3);
                   return std::nextafter(x, x + r.between(-1, 1));
                 },
                 {},
                 0.3});
  all.push_back({"far and near",
                 [](Random& r) { return r.uniform(-1, 1) * (r.coin() ? 1e3 : 1e-3); },
                 {},
                 1e-3});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Shapes, BroadPhaseOn, testing::ValuesIn(all_shapes()),
                         [](const auto& tested) {
                           std::string name = tested.param.name;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

TEST(BroadPhase, EndsWhenItIsToStop) {
  const std::atomic<bool> stop = true;
  const Motion vertices(Eigen::MatrixX3d::Zero(6, 3), Eigen::MatrixX3d::Ones(6, 3));
  const BroadPhaseOptions options{.stop = &stop};
  EXPECT_THROW((void)vertex_face_candidates(vertices, std::vector<Face>{{0, 1, 2}}, options),
               Stopped);
  EXPECT_THROW((void)edge_edge_candidates(vertices, std::vector<Edge>{{0, 1}, {2, 3}}, options),
               Stopped);
}

TEST(BroadPhase, MayBeCalledFromTasks) {
  Random random(15);
  const Scene scene = tests::soup(random, 150, 0.2);
  const Pairs expected = found_edge_edge(scene);
  std::vector<Pairs> found(20);
  oneapi::tbb::parallel_for(std::size_t{0}, found.size(),
                            [&](std::size_t i) { found[i] = found_edge_edge(scene); });
  for (const Pairs& pairs : found) EXPECT_EQ(pairs, expected);
}

/// (With the messages of steps: step_test.cpp.)
TEST(BroadPhase, RefusesWhatIsNotFiniteAndIndicesOutOfRange) {
  Random random(17);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Scene scene = tests::soup(random, 2, 0.1);
    scene.end(2, 1) = -bad;
    EXPECT_THROW((void)found_vertex_face(scene), std::domain_error);
    EXPECT_THROW((void)found_edge_edge(scene), std::domain_error);
  }
  Scene scene = tests::soup(random, 2, 0.1);
  scene.faces = {{0, 1, 2}, {1, 2, 12}};
  scene.edges = {{-1, 2}};
  EXPECT_THROW((void)found_vertex_face(scene), std::out_of_range);
  EXPECT_THROW((void)found_edge_edge(scene), std::out_of_range);
}

/// Unconnected edges that all have the same swept box: every pair is a candidate.
std::pair<Motion, std::vector<Edge>> crowd(std::int32_t count) {
  Places points(2 * count, 3);
  std::vector<Edge> edges;
  for (std::int32_t i = 0; i < count; ++i) {
    points.row(2 * i) << 0, 0, 0;
    points.row(2 * i + 1) << 1, 1, 1;
    edges.push_back({2 * i, 2 * i + 1});
  }
  return {Motion(points, points), edges};
}

TEST(BroadPhase, CountsCandidatesThatAreTooMany) {
  const auto [vertices, edges] = crowd(400);
  static constexpr std::uint64_t all = 400U * 399U / 2U;
  EXPECT_EQ(edge_edge_candidates(vertices, edges, {.max_candidates = all}).size(), all);
  for (const int threads : {1, 0}) {
    for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, all / 2, all - 1}) {
      const BroadPhaseOptions options{.max_threads = threads, .max_candidates = most};
      EXPECT_EQ(tests::message_of<TooManyCandidates>(
                    [&] { (void)edge_edge_candidates(vertices, edges, options); }),
                "79800 candidates are too many for the memory");
    }
  }
  EXPECT_TRUE(edge_edge_candidates(vertices, {}, {.max_candidates = 0}).empty());
}

TEST(EdgesOf, GoByTheirLargerVertexThenByTheSmaller) {
  Random random(16);
  for (const int largest : {3, 2047, 2048, 1 << 20, std::numeric_limits<int>::max()}) {
    std::vector<Face> many(500);
    std::set<std::array<std::int32_t, 2>> sides;  // the larger vertex first
    for (Face& face : many) {
      for (std::int32_t& vertex : face)
        vertex = random.between(largest - 3, largest) >> random.between(0, 30);
      const auto& [a, b, c] = face;
      for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        if (u != v) sides.insert({std::max(u, v), std::min(u, v)});
      }
    }
    std::vector<Edge> expected;
    for (const auto& [larger, smaller] : sides) expected.push_back({smaller, larger});
    EXPECT_EQ(edges_of(many), expected);
  }
}

}  // namespace
}  // namespace touchstone::fast::broad_phase_test
