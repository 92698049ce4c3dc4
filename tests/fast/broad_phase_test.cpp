#include "touchstone/broad_phase.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process_memory.hpp"
#include "tests/support/random.hpp"
#include "tests/support/simulation_steps.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::broad_phase_test {
namespace {

using exact::Rational;
using tests::Random;
using Places = Eigen::MatrixX3d;
using Pairs = std::vector<IndexPair>;

constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// A step of a mesh.
struct Scene {
  Places start;
  Places end;
  std::vector<Face> faces;

  [[nodiscard]] MovingVertices vertices() const { return {start, end}; }
  [[nodiscard]] std::vector<Edge> edges() const { return edges_of(faces); }
};

/// Triangles at any place, each with its own motion; some share vertices.
Scene soup(Random& random, int faces, const std::function<double(std::size_t)>& centre,
           const std::function<double(std::size_t)>& offset) {
  Scene scene{.start = Places(3 * faces, 3), .end = Places(3 * faces, 3), .faces = {}};
  for (int face = 0; face < faces; ++face) {
    const std::array<double, 3> place{centre(0), centre(1), centre(2)};
    for (int corner = 0; corner < 3; ++corner) {
      for (const std::size_t axis : {0U, 1U, 2U}) {
        const Eigen::Index row = 3 * face + corner, column = static_cast<Eigen::Index>(axis);
        scene.start(row, column) = place[axis] + offset(axis);
        scene.end(row, column) = place[axis] + offset(axis);
      }
    }
    const int other = random.between(0, 3 * face + 2);
    scene.faces.push_back({3 * face, random.coin() ? 3 * face + 1 : other, 3 * face + 2});
  }
  return scene;
}

struct Shape {
  std::string name;
  std::function<Scene(Random&, int)> make;
};

std::vector<Shape> shapes() {
  const auto within = [](Random& random, double size) {
    return [&random, size](std::size_t) { return random.uniform(-size, size); };
  };
  const auto nowhere = [](std::size_t) { return 0.0; };
  return {
      {"sparse", [=](Random& r, int n) { return soup(r, n, within(r, 1), within(r, 0.05)); }},
      {"dense", [=](Random& r, int n) { return soup(r, n, nowhere, within(r, 1)); }},
      {"one cell",
       [=](Random& r, int n) {
         return soup(
             r, n, [](std::size_t) { return 1.0; }, within(r, 1e-15));
       }},
      {"long and thin",
       [=](Random& r, int n) {
         return soup(r, n, within(r, 1), [&r](std::size_t axis) {
           return r.uniform(-1, 1) * (axis == 0 ? 1e3 : 1e-3);
         });
       }},
      {"coplanar",
       [=](Random& r, int n) {
         return soup(
             r, n, [&r](std::size_t axis) { return axis == 2 ? 0.5 : r.uniform(-1, 1); },
             [&r](std::size_t axis) { return axis == 2 ? 0.0 : r.uniform(-0.1, 0.1); });
       }},
      {"grid",
       [=](Random& r, int n) {
         return soup(
             r, n, [&r](std::size_t) { return r.between(0, 9); },
             [&r](std::size_t) { return r.between(0, 1); });
       }},
      {"coarse grid",
       [=](Random& r, int n) {
         return soup(
             r, n, [&r](std::size_t) { return 0.125 * r.between(0, 30); },
             [&r](std::size_t) { return 0.125 * r.between(0, 1); });
       }},
      {"one giant",
       [=](Random& r, int n) {
         Scene scene = soup(r, n, within(r, 1), within(r, 0.02));
         scene.start.topRows(3) *= 1e300;
         return scene;
       }},
      {"all scales",
       [=](Random& r, int n) {
         return soup(r, n, nowhere, [&r](std::size_t) { return r.finite_double(); });
       }},
      {"subnormal",
       [=](Random& r, int n) {
         return soup(
             r, n, [&r](std::size_t) { return tiniest * r.between(-40, 40); },
             [&r](std::size_t) { return tiniest * r.between(0, 5); });
       }},
  };
}

/// Separations that matter to a scene of this shape.
std::vector<double> separations() { return {0.0, 0.125, 0.1, 5 * tiniest, 1e-16, 1e308, greatest}; }

/// Least and greatest coordinate on an axis of some vertices.
std::pair<double, double> range(const Scene& scene, std::span<const std::int32_t> vertices,
                                Eigen::Index axis) {
  double least = scene.start(vertices[0], axis), most = least;
  for (const std::int32_t vertex : vertices) {
    for (const double x : {scene.start(vertex, axis), scene.end(vertex, axis)}) {
      least = x < least ? x : least;
      most = x > most ? x : most;
    }
  }
  return {least, most};
}

/// True if the swept boxes are within a distance on every axis, exactly.
bool near(const Scene& scene, std::span<const std::int32_t> a, std::span<const std::int32_t> b,
          double distance) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto [least_a, most_a] = range(scene, a, axis);
    const auto [least_b, most_b] = range(scene, b, axis);
    if (distance == 0.0) {
      if (least_a > most_b || least_b > most_a) return false;
    } else if (Rational(least_a) - Rational(most_b) > Rational(distance) ||
               Rational(least_b) - Rational(most_a) > Rational(distance)) {
      return false;
    }
  }
  return true;
}

Pairs all_vertex_face(const Scene& scene, double distance) {
  Pairs result;
  for (std::int32_t vertex = 0; vertex < scene.start.rows(); ++vertex) {
    for (std::size_t i = 0; i < scene.faces.size(); ++i) {
      const Face& face = scene.faces[i];
      if (std::ranges::count(face, vertex) == 0 && near(scene, {&vertex, 1}, face, distance)) {
        result.push_back({vertex, static_cast<std::int32_t>(i)});
      }
    }
  }
  return result;
}

Pairs all_edge_edge(const Scene& scene, double distance) {
  Pairs result;
  const std::vector<Edge> edges = scene.edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Edge &a = edges[i], &b = edges[j];
      const bool apart = a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1];
      if (apart && near(scene, a, b, distance)) {
        result.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
  }
  return result;
}

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

Pairs found_vertex_face(const Scene& scene, const BroadPhaseOptions& options = {}) {
  return sorted(vertex_face_candidates(scene.vertices(), scene.faces, options));
}

Pairs found_edge_edge(const Scene& scene, const BroadPhaseOptions& options = {}) {
  return sorted(edge_edge_candidates(scene.vertices(), scene.edges(), options));
}

TEST(BroadPhase, FindsExactlyAllPairsWithinTheSeparation) {
  Random random(10);
  for (const Shape& shape : shapes()) {
    for (const double separation : separations()) {
      const Scene scene = shape.make(random, 12 + random.between(0, 8));
      const BroadPhaseOptions options{.separation = {.distance = separation}};
      EXPECT_EQ(found_vertex_face(scene, options), all_vertex_face(scene, separation))
          << shape.name << ' ' << separation;
      EXPECT_EQ(found_edge_edge(scene, options), all_edge_edge(scene, separation))
          << shape.name << ' ' << separation;
    }
  }
}

TEST(BroadPhase, FindsExactlyAllPairsOfLargerMeshes) {
  Random random(11);
  for (const Shape& shape : shapes()) {
    const Scene scene = shape.make(random, 150);
    EXPECT_EQ(found_vertex_face(scene), all_vertex_face(scene, 0)) << shape.name;
    EXPECT_EQ(found_edge_edge(scene), all_edge_edge(scene, 0)) << shape.name;
  }
}

TEST(BroadPhase, ShapesHaveCandidatesAndOthers) {
  Random random(12);
  for (const Shape& shape : shapes()) {
    const Scene scene = shape.make(random, 60);
    const std::size_t edges = scene.edges().size();
    EXPECT_GT(found_edge_edge(scene).size(), 0U) << shape.name;
    EXPECT_LT(found_edge_edge(scene).size(), edges * (edges - 1) / 2) << shape.name;
  }
}

/// A resting triangle in x ≤ 1, and a resting vertex at x.
Scene vertex_beside_triangle(double x) {
  Scene scene{.start = Places(4, 3), .end = {}, .faces = {{1, 2, 3}}};
  scene.start << x, 0.25, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0;
  scene.end = scene.start;
  return scene;
}

TEST(BroadPhase, BoxesInContactAreCandidatesAndTheNextDoubleIsNot) {
  EXPECT_EQ(found_vertex_face(vertex_beside_triangle(1)), (Pairs{{0, 0}}));
  EXPECT_EQ(found_vertex_face(vertex_beside_triangle(std::nextafter(1, 2))), Pairs{});
  EXPECT_EQ(found_vertex_face(vertex_beside_triangle(-tiniest)), Pairs{});
  for (const double separation : {0.5, 0.1, 0.3, 1e-16, tiniest, 7.0, 1e300}) {
    const BroadPhaseOptions options{.separation = {.distance = separation}};
    double x = 1 + separation;
    while (Rational(x) - 1 > Rational(separation)) x = std::nextafter(x, 0);
    while (Rational(std::nextafter(x, greatest)) - 1 <= Rational(separation)) {
      x = std::nextafter(x, greatest);
    }
    EXPECT_EQ(found_vertex_face(vertex_beside_triangle(x), options), (Pairs{{0, 0}})) << separation;
    EXPECT_EQ(found_vertex_face(vertex_beside_triangle(std::nextafter(x, greatest)), options),
              Pairs{})
        << separation;
  }
}

TEST(BroadPhase, EachAxisSeparates) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.5, 2.5}) {
      Scene scene = vertex_beside_triangle(0.25);
      scene.start(0, axis) = scene.end(0, axis) = side;
      EXPECT_EQ(found_vertex_face(scene), Pairs{});
      EXPECT_EQ(found_vertex_face(scene, {.separation = {.distance = 2.5}}), (Pairs{{0, 0}}));
    }
  }
}

TEST(BroadPhase, BoxesAreAroundBothTimes) {
  Scene scene = vertex_beside_triangle(3);
  scene.end(0, 0) = -2;
  EXPECT_EQ(found_vertex_face(scene), (Pairs{{0, 0}}));
  scene.end(0, 0) = 2;
  EXPECT_EQ(found_vertex_face(scene), Pairs{});
}

TEST(BroadPhase, LeavesOutPairsThatShareAVertex) {
  Scene scene{.start = Places::Zero(5, 3), .end = Places::Zero(5, 3), .faces = {}};
  scene.faces = {{0, 1, 2}, {2, 3, 4}};
  EXPECT_EQ(found_vertex_face(scene), (Pairs{{0, 1}, {1, 1}, {3, 0}, {4, 0}}));
  const std::vector<Edge> edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 4}};
  EXPECT_EQ(sorted(edge_edge_candidates(scene.vertices(), edges)),
            (Pairs{{0, 2}, {0, 3}, {0, 4}, {1, 3}, {1, 4}, {2, 4}}));
}

// In units of the huge primitive all others are 0 in float, so that doubles decide each pair.
TEST(BroadPhase, AHugePrimitiveAmongTinyOnesIsFoundWithEachOfThem) {
  static constexpr int tiny = tests::trials(2'000);
  Scene scene{.start = Places::Zero(3 * tiny + 3, 3), .end = {}, .faces = {}};
  for (int i = 0; i < tiny; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      scene.start(3 * i + corner, 0) = 1e-20 * i;
      scene.start(3 * i + corner, 1) = 1e-30 * corner;
    }
    scene.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.start.bottomRows(3).setConstant(-1e300);
  scene.start.bottomRows(1).setConstant(1e300);
  scene.faces.push_back({3 * tiny, 3 * tiny + 1, 3 * tiny + 2});
  scene.end = scene.start;
  const Pairs pairs = found_vertex_face(scene);
  ASSERT_EQ(pairs.size(), 3U * tiny);
  for (std::int32_t i = 0; i < 3 * tiny; ++i) {
    EXPECT_EQ(pairs[static_cast<std::size_t>(i)], (IndexPair{i, tiny}));
  }
}

TEST(BroadPhase, DoesNotDependOnTheThreads) {
  Random random(14);
  for (const Shape& shape : shapes()) {
    const Scene scene = shape.make(random, 400);
    const BroadPhaseOptions alone{.max_threads = 1};
    const Pairs vertex_face = vertex_face_candidates(scene.vertices(), scene.faces, alone);
    const Pairs edge_edge = edge_edge_candidates(scene.vertices(), scene.edges(), alone);
    for (const int threads : {0, 2, 1'000'000}) {
      const BroadPhaseOptions options{.max_threads = threads};
      EXPECT_EQ(vertex_face_candidates(scene.vertices(), scene.faces, options), vertex_face);
      EXPECT_EQ(edge_edge_candidates(scene.vertices(), scene.edges(), options), edge_edge);
    }
  }
}

TEST(BroadPhase, EndsWhenItIsToStop) {
  const std::atomic<bool> stop = true;
  const MovingVertices vertices(Eigen::MatrixX3d::Zero(6, 3), Eigen::MatrixX3d::Ones(6, 3));
  const BroadPhaseOptions options{.stop = &stop};
  EXPECT_THROW((void)vertex_face_candidates(vertices, std::vector<Face>{{0, 1, 2}}, options),
               Stopped);
  EXPECT_THROW((void)edge_edge_candidates(vertices, std::vector<Edge>{{0, 1}, {2, 3}}, options),
               Stopped);
}

TEST(BroadPhase, MayBeCalledFromTasks) {
  Random random(15);
  const Scene scene = shapes().front().make(random, 300);
  const Pairs expected = found_edge_edge(scene);
  std::vector<Pairs> found(20);
  oneapi::tbb::parallel_for(std::size_t{0}, found.size(),
                            [&](std::size_t i) { found[i] = found_edge_edge(scene); });
  for (const Pairs& pairs : found) EXPECT_EQ(pairs, expected);
}

TEST(BroadPhase, SwappingTheTimesChangesNothing) {
  Random random(16);
  for (const Shape& shape : shapes()) {
    const Scene scene = shape.make(random, 100);
    const Scene swapped{.start = scene.end, .end = scene.start, .faces = scene.faces};
    EXPECT_EQ(found_vertex_face(scene), found_vertex_face(swapped)) << shape.name;
    EXPECT_EQ(found_edge_edge(scene), found_edge_edge(swapped)) << shape.name;
  }
}

TEST(BroadPhase, PermutingVerticesAndFacesPermutesTheCandidates) {
  Random random(17);
  for (const Shape& shape : shapes()) {
    const Scene scene = shape.make(random, 80);
    const auto permutation = [&random](auto size) {
      std::vector<std::int32_t> result(static_cast<std::size_t>(size));
      std::iota(result.begin(), result.end(), 0);
      for (std::size_t i = result.size(); i > 1; --i) {
        std::swap(result[i - 1], result[random.bits() % i]);
      }
      return result;
    };
    const auto vertex_to = permutation(scene.start.rows()),
               face_to = permutation(scene.faces.size());
    Scene other = scene;
    for (std::size_t i = 0; i < vertex_to.size(); ++i) {
      other.start.row(vertex_to[i]) = scene.start.row(static_cast<Eigen::Index>(i));
      other.end.row(vertex_to[i]) = scene.end.row(static_cast<Eigen::Index>(i));
    }
    for (std::size_t i = 0; i < face_to.size(); ++i) {
      Face& face = other.faces[static_cast<std::size_t>(face_to[i])];
      for (std::size_t k = 0; k < 3; ++k) {
        face[k] = vertex_to[static_cast<std::size_t>(scene.faces[i][k])];
      }
    }
    Pairs expected = found_vertex_face(scene);
    for (auto& [vertex, face] : expected) {
      vertex = vertex_to[static_cast<std::size_t>(vertex)];
      face = face_to[static_cast<std::size_t>(face)];
    }
    EXPECT_EQ(found_vertex_face(other), sorted(expected)) << shape.name;
    EXPECT_EQ(found_edge_edge(other).size(), found_edge_edge(scene).size()) << shape.name;
  }
}

TEST(BroadPhase, OfNothingIsNothing) {
  const Scene scene{.start = Places(0, 3), .end = Places(0, 3), .faces = {}};
  EXPECT_EQ(found_vertex_face(scene), Pairs{});
  EXPECT_EQ(found_edge_edge(scene), Pairs{});
  Scene without_faces = vertex_beside_triangle(0);
  without_faces.faces.clear();
  EXPECT_EQ(found_vertex_face(without_faces), Pairs{});
}

/// The message of an exception of that type, or "".
template <class Error>
std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BroadPhase, NamesTheVertexThatIsNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Scene scene = vertex_beside_triangle(0);
    scene.end(2, 1) = -bad;
    EXPECT_EQ(message<std::domain_error>([&] { (void)found_vertex_face(scene); }),
              "vertex 2: a coordinate is not finite");
    EXPECT_EQ(message<std::domain_error>([&] { (void)found_edge_edge(scene); }),
              "vertex 2: a coordinate is not finite");
  }
}

TEST(BroadPhase, NamesThePrimitiveWithAnIndexOutOfRange) {
  const MovingVertices vertices = vertex_beside_triangle(0).vertices();
  const std::vector<Face> faces{{0, 1, 2}, {1, 2, 4}};
  EXPECT_EQ(message<std::out_of_range>([&] { (void)vertex_face_candidates(vertices, faces); }),
            "face 1: vertex 4, but there are 4");
  const std::vector<Edge> edges{{-1, 2}};
  EXPECT_EQ(message<std::out_of_range>([&] { (void)edge_edge_candidates(vertices, edges); }),
            "edge 0: vertex -1, but there are 4");
}

/// Unconnected edges that all have the same swept box: every pair is a candidate.
std::pair<MovingVertices, std::vector<Edge>> crowd(std::int32_t count) {
  Places points(2 * count, 3);
  std::vector<Edge> edges;
  for (std::int32_t i = 0; i < count; ++i) {
    points.row(2 * i) << 0, 0, 0;
    points.row(2 * i + 1) << 1, 1, 1;
    edges.push_back({2 * i, 2 * i + 1});
  }
  return {MovingVertices(points, points), edges};
}

TEST(BroadPhase, CountsCandidatesThatAreTooMany) {
  const auto [vertices, edges] = crowd(400);
  static constexpr std::uint64_t all = 400U * 399U / 2U;
  EXPECT_EQ(edge_edge_candidates(vertices, edges, {.max_candidates = all}).size(), all);
  for (const int threads : {1, 0}) {
    for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, all / 2, all - 1}) {
      try {
        static_cast<void>(edge_edge_candidates(vertices, edges,
                                               {.max_threads = threads, .max_candidates = most}));
        ADD_FAILURE() << most;
      } catch (const TooManyCandidates& error) {
        EXPECT_EQ(error.count(), all);
        EXPECT_EQ(error.what(), std::string("79800 candidates are too many for the memory"));
      }
    }
  }
  EXPECT_TRUE(edge_edge_candidates(vertices, {}, {.max_candidates = 0}).empty());
}

#ifndef TOUCHSTONE_SANITIZED
TEST(BroadPhase, CountsCandidatesThatDoNotFitIntoMemory) {
  // 18 million pairs of eight bytes each, and room for 64 MiB.
  const auto search = [] {
    const auto [vertices, edges] = crowd(6000);
    const rlim_t limit = tests::process_memory().address_space + (std::uint64_t{64} << 20U);
    const rlimit limits{.rlim_cur = limit, .rlim_max = limit};
    ::setrlimit(RLIMIT_AS, &limits);
    try {
      static_cast<void>(edge_edge_candidates(vertices, edges, {.max_threads = 1}));
    } catch (const TooManyCandidates& error) {
      _exit(error.count() == 6000U * 5999U / 2U ? 0 : 1);
    }
    _exit(2);
  };
  // A process that does not fork this one, which would inherit the locks of other tests.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(search(), ::testing::ExitedWithCode(0), "");
}
#endif

TEST(EdgesOf, GoByTheirLargerVertexThenByTheSmaller) {
  const std::vector<Face> faces{{3, 1, 0}, {1, 3, 4}, {2, 0, 1}};
  EXPECT_EQ(edges_of(faces),
            (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {1, 4}, {3, 4}}));
  EXPECT_EQ(edges_of({}), std::vector<Edge>{});
  const std::vector<Face> degenerate{{5, 5, 2}, {7, 7, 7}};
  EXPECT_EQ(edges_of(degenerate), (std::vector<Edge>{{2, 5}}));
}

// ---- The public data ----------------------------------------------------------------------------

struct Published {
  std::string_view scene;
  Kind kind;
  std::size_t candidates;
  std::ptrdiff_t collisions;
};

constexpr auto published = std::to_array<Published>({
    {"cloth-ball", Kind::vertex_face, 1'655'541, 19'032},
    {"cloth-ball", Kind::edge_edge, 5'197'332, 94'822},
    {"armadillo-rollers", Kind::vertex_face, 2'031'902, 4'650},
    {"armadillo-rollers", Kind::edge_edge, 5'068'080, 19'308},
    {"cloth-funnel", Kind::vertex_face, 7'319, 27},
    {"cloth-funnel", Kind::edge_edge, 33'770, 107},
});

/// Compares the label of one query in `stride` with the oracle.
constexpr std::size_t stride = 97;

void expect_as_published(const tests::SimulationStep& step, const Published& expected) {
  const tests::LabelledPairs& labelled = step.labelled(expected.kind);
  EXPECT_EQ(std::ranges::count(labelled.collides, true), expected.collisions);
  const Pairs found =
      sorted(expected.kind == Kind::vertex_face ? vertex_face_candidates(step.vertices, step.faces)
                                                : edge_edge_candidates(step.vertices, step.edges));
  EXPECT_EQ(found.size(), expected.candidates);
  for (std::size_t i = 0; i < labelled.pairs.size(); ++i) {
    EXPECT_TRUE(std::ranges::binary_search(found, labelled.pairs[i])) << i;
    if (i % stride != 0) continue;
    const Query query =
        query_of(step.vertices, step.candidates(expected.kind, labelled.pairs), labelled.pairs[i]);
    EXPECT_EQ(exact::decide(expected.kind, query).collides(), labelled.collides[i]) << i;
  }
}

TEST(PublicSteps, HaveThePublishedCandidatesAndLabelsPairByPair) {
  const auto folder = tests::simulation_folder();
  if (folder.empty()) GTEST_SKIP() << "public data missing";
  for (const Published& expected : published) {
    SCOPED_TRACE(std::string(expected.scene) + " " + std::string(to_string(expected.kind)));
    expect_as_published(tests::load_simulation_step(folder, expected.scene), expected);
  }
}

}  // namespace
}  // namespace touchstone::fast::broad_phase_test
