#include "touchstone/ipc_toolkit_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::adapters::ipc_toolkit_step_test {
namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXi;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Scenes -------------------------------------------------------------------------------------

/// A collision mesh and a step of it. All coordinates are multiples of 2^-6, so that differences
/// are exact.
struct Scene {
  ipc::CollisionMesh mesh;
  MatrixXd start;
  MatrixXd end;
};

template <class Element>
MatrixXi matrix(const std::vector<Element>& elements) {
  MatrixXi result(static_cast<Eigen::Index>(elements.size()),
                  static_cast<Eigen::Index>(std::tuple_size_v<Element>));
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index k = 0; k < result.cols(); ++k) {
      result(i, k) = elements[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  return result;
}

/// A few faces (in three dimensions), edges and codimensional vertices, that move by about `motion`
/// in a cube with sides of about 2, and mostly a rule for the pairs that can collide.
Scene random_scene(Random& random, int dim, int motion) {
  const int vertices = random.between(6, 14);
  const auto place = [&](int most) { return 0x1p-6 * random.between(-most, most); };
  MatrixXd start(vertices, dim), end(vertices, dim);
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    start.reshaped()[i] = place(64);
    end.reshaped()[i] = start.reshaped()[i] + place(motion);
  }
  std::vector<fast::Face> faces;
  for (int i = dim == 3 ? random.between(0, 4) : 0; i > 0; --i) {
    const int a = random.between(0, vertices - 5);
    faces.push_back({a, a + random.between(1, 2), a + random.between(3, 4)});
  }
  std::vector<fast::Edge> edges = fast::edges_of(faces);
  for (int i = random.between(1, 5); i > 0; --i) {
    const int a = random.between(0, vertices - 4), b = a + random.between(1, 3);
    const bool is_new = std::ranges::none_of(edges, [&](const fast::Edge& edge) {
      return edge == fast::Edge{a, b} || edge == fast::Edge{b, a};
    });
    if (is_new) edges.push_back({a, b});
  }
  Scene scene{ipc::CollisionMesh(start, matrix(edges), matrix(faces)), start, end};
  if (random.between(0, 3) == 0) return scene;
  scene.mesh.can_collide = [seed = random.between(0, 1 << 20)](std::size_t i, std::size_t j) {
    return ((std::min(i, j) + static_cast<std::size_t>(seed)) * 31 + std::max(i, j)) % 3 == 0;
  };
  return scene;
}

// ---- All pairs one by one -----------------------------------------------------------------------

using Vertices = std::vector<int>;

template <class Row>
Vertices of(const Row& row) {
  return {row.begin(), row.end()};
}

struct Pair {
  Kind kind;
  Vertices first;
  Vertices second;
};

bool can_collide(const ipc::CollisionMesh& mesh, const Vertices& first, const Vertices& second) {
  bool some_can = false;
  for (const int i : first) {
    for (const int j : second) {
      if (i == j) return false;
      some_can |= mesh.can_collide(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    }
  }
  return some_can;
}

/// The pairs that can collide, as the toolkit defines them.
std::vector<Pair> all_pairs(const ipc::CollisionMesh& mesh) {
  std::vector<Pair> result;
  const auto add = [&](Kind kind, const Vertices& first, const Vertices& second) {
    if (can_collide(mesh, first, second)) result.push_back({kind, first, second});
  };
  const MatrixXi &edges = mesh.edges(), &faces = mesh.faces();
  const Vertices codimensional = of(mesh.codim_vertices());
  const auto is_of_face = [&](const Vertices& edge) {
    return std::ranges::any_of(faces.rowwise(), [&](const auto& face) {
      return std::ranges::count_if(face, [&](int i) { return i == edge[0] || i == edge[1]; }) == 2;
    });
  };
  for (int i = 0; i < static_cast<int>(mesh.num_vertices()); ++i) {
    for (const auto& face : faces.rowwise()) add(Kind::vertex_face, {i}, of(face));
    if (mesh.dim() == 3) continue;
    for (const auto& edge : edges.rowwise()) add(Kind::vertex_face, {i}, of(edge));
  }
  for (Eigen::Index i = 0; mesh.dim() == 3 && i < edges.rows(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      add(Kind::edge_edge, of(edges.row(i)), of(edges.row(k)));
    }
    if (is_of_face(of(edges.row(i)))) continue;
    for (const int vertex : codimensional) add(Kind::vertex_face, {vertex}, of(edges.row(i)));
  }
  for (const int i : codimensional) {
    for (const int j : codimensional) {
      if (i < j) add(Kind::vertex_face, {i}, {j});
    }
  }
  return result;
}

/// The swept boxes are within the distance.
bool are_near(const Scene& scene, const Pair& pair, double distance) {
  for (Eigen::Index axis = 0; axis < scene.start.cols(); ++axis) {
    const auto range = [&](const Vertices& vertices) {
      std::pair<double, double> result{infinity, -infinity};
      for (const int i : vertices) {
        for (const double x : {scene.start(i, axis), scene.end(i, axis)}) {
          result = {std::min(result.first, x), std::max(result.second, x)};
        }
      }
      return result;
    };
    const auto [low, high] = range(pair.first);
    const auto [other_low, other_high] = range(pair.second);
    if (low - other_high > distance || other_low - high > distance) return false;
  }
  return true;
}

Query query_of(const Pair& pair, const MatrixXd& start, const MatrixXd& end) {
  Vertices vertices = pair.first;
  vertices.insert(vertices.end(), pair.second.begin(), pair.second.end());
  // A missing vertex of a face is its first one again.
  vertices.resize(moving_points, pair.second[0]);
  Query query{};
  for (std::size_t i = 0; i < moving_points; ++i) {
    for (Eigen::Index k = 0; k < start.cols(); ++k) {
      query.point(0, i)[k] = start(vertices[i], k);
      query.point(1, i)[k] = end(vertices[i], k);
    }
  }
  return query;
}

/// The least time of the pairs by the narrow phase; infinity if there is none.
double first_by_narrow_phase(const Scene& scene, double min_distance, double rescaling) {
  const NarrowPhaseCCD narrow_phase(rescaling);
  double first = infinity;
  for (const Pair& pair : all_pairs(scene.mesh)) {
    if (!are_near(scene, pair, min_distance)) continue;
    double toi = infinity;
    (void)narrow_phase.query_ccd(pair.kind, query_of(pair, scene.start, scene.end), toi,
                                 min_distance);
    first = std::min(first, toi);
  }
  return first;
}

/// The exact time at which the first pair comes within the distance.
std::optional<exact::AlgebraicNumber> first_by_oracle(const Scene& scene, double min_distance) {
  std::optional<exact::AlgebraicNumber> first;
  for (const Pair& pair : all_pairs(scene.mesh)) {
    const exact::Decision decision =
        exact::decide(pair.kind, query_of(pair, scene.start, scene.end),
                      {.distance = min_distance, .norm = Norm::l2});
    if (decision.collides() && (!first || *decision.toi <= *first)) first = decision.toi;
  }
  return first;
}

// ---- Tests --------------------------------------------------------------------------------------

struct Seen {
  int free = 0, limited = 0, at_start = 0;
};

class IpcStep : public testing::TestWithParam<int> {
 protected:
  /// Calls test(scene, min_distance) for many steps of this dimension.
  template <class Test>
  void for_each_scene(const Test& test) const {
    Random random(5300 + static_cast<unsigned>(GetParam()));
    for (int round = 0; round < tests::trials(300); ++round) {
      const Scene scene = random_scene(random, GetParam(), round % 2 == 0 ? 8 : 64);
      const double min_distance = random.coin() ? 0.0 : 0x1p-6 * random.between(1, 4);
      test(scene, min_distance);
      if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
  }
};

TEST_P(IpcStep, GoesAsFarAsTheNarrowPhaseOfEachPairAllows) {
  Seen seen;
  for_each_scene([&](const Scene& scene, double min_distance) {
    for (const double rescaling : {0.0, 0.8, 1.0}) {
      const NarrowPhaseCCD narrow_phase(rescaling);
      const double first = first_by_narrow_phase(scene, min_distance, rescaling);
      const double step = adapters::compute_collision_free_stepsize(
          scene.mesh, scene.start, scene.end, min_distance, nullptr, narrow_phase);
      // (What is left of a distance is rounded in either of two ways.)
      EXPECT_NEAR(step, std::min(first, 1.0), 1e-11 * step) << rescaling;
      EXPECT_EQ(adapters::is_step_collision_free(scene.mesh, scene.start, scene.end, min_distance,
                                                 nullptr, narrow_phase),
                first == infinity);
      ++(first == infinity ? seen.free : first == 0.0 ? seen.at_start : seen.limited);
    }
  });
  EXPECT_GT(std::min({seen.free, seen.limited, seen.at_start}), tests::trials(40));
}

/// Without rescaling, a step ends at the first contact.
TEST_P(IpcStep, EndsWhereTheOracleSaysThatContactIs) {
  Seen seen;
  for_each_scene([&](const Scene& scene, double min_distance) {
    const NarrowPhaseCCD narrow_phase(1.0);
    const std::optional<exact::AlgebraicNumber> first = first_by_oracle(scene, min_distance);
    EXPECT_EQ(adapters::is_step_collision_free(scene.mesh, scene.start, scene.end, min_distance,
                                               nullptr, narrow_phase),
              !first);
    if (!first) return;
    const double step = adapters::compute_collision_free_stepsize(
        scene.mesh, scene.start, scene.end, min_distance, nullptr, narrow_phase);
    const double exact = first->enclosure().upper;
    EXPECT_LE(step, exact);
    EXPECT_GE(step, exact * (1.0 - 1e-11));
    ++(step == 0.0 ? seen.at_start : seen.limited);
  });
  EXPECT_GT(std::min(seen.at_start, seen.limited), tests::trials(15));
}

TEST_P(IpcStep, FindsIntersectionsWhereTheOracleDoes) {
  Seen seen;
  for_each_scene([&](const Scene& scene, double) {
    const ipc::CollisionMesh& mesh = scene.mesh;
    bool expected = false;
    for (const auto& edge : mesh.edges().rowwise()) {
      for (const auto& other : (mesh.dim() == 3 ? mesh.faces() : mesh.edges()).rowwise()) {
        if (!can_collide(mesh, of(edge), of(other))) continue;
        // A vertex on its way along the edge.
        const Pair pair{Kind::vertex_face, {edge[0]}, of(other)};
        Query query = query_of(pair, scene.start, scene.start);
        for (Eigen::Index k = 0; k < scene.start.cols(); ++k) {
          query.point(1, 0)[k] = scene.start(edge[1], k);
        }
        expected = expected || exact::decide(pair.kind, query).collides();
      }
    }
    EXPECT_EQ(adapters::has_intersections(mesh, scene.start), expected);
    ++(expected ? seen.limited : seen.free);
  });
  EXPECT_GT(std::min(seen.free, seen.limited), tests::trials(30));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, IpcStep, testing::Values(2, 3), [](const auto& dimension) {
  return std::to_string(dimension.param) + "D";
});

TEST(IpcStepErrors, NameWhatIsWrong) {
  Random random(5310);
  const Scene scene = random_scene(random, 3, 8);
  const auto step = [&](const ipc::CollisionMesh& mesh, const MatrixXd& start, const MatrixXd& end,
                        double min_distance, double rescaling) {
    struct : NarrowPhaseCCD {
    } narrow_phase;
    narrow_phase.conservative_rescaling = rescaling;
    (void)adapters::compute_collision_free_stepsize(mesh, start, end, min_distance, nullptr,
                                                    narrow_phase);
  };
  const MatrixXd &start = scene.start, &end = scene.end;
  EXPECT_NO_THROW(step(scene.mesh, start, end, 0.0, 0.8));
  EXPECT_THROW(step(scene.mesh, start, end, -1.0, 0.8), std::invalid_argument);
  EXPECT_THROW(step(scene.mesh, start, end, 0.0, 1.5), std::invalid_argument);
  EXPECT_THROW(step(scene.mesh, start.leftCols(2), end, 0.0, 0.8), std::invalid_argument);
  EXPECT_THROW(step(scene.mesh, start, end.topRows(3), 0.0, 0.8), std::invalid_argument);
  MatrixXd bad = end;
  bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(step(scene.mesh, start, bad, 0.0, 0.8), std::domain_error);
  EXPECT_THROW((void)adapters::has_intersections(scene.mesh, bad), std::domain_error);
  ipc::CollisionMesh above_ground = scene.mesh;
  above_ground.planes.emplace_back(Eigen::Vector3d::UnitZ(), 2.0);
  EXPECT_THROW(step(above_ground, start, end, 0.0, 0.8), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::adapters::ipc_toolkit_step_test
