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
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/ipc_toolkit.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::adapters::ipc_toolkit_step_test {
namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXi;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Pairs --------------------------------------------------------------------------------------

struct Said {
  bool collision = false;
  double toi = -1.0;
};

/// The answer about a pair of these points, in two or three dimensions.
Said ask(const ipc::NarrowPhaseCCD& ccd, ContactKind kind, const Query& query,
         double min_distance = 0.0, double tmax = 1.0, Eigen::Index dim = 3) {
  const auto point = [&](std::size_t end, std::size_t i) {
    return ipc::VectorMax3d(point_of(query, end, i).head(dim));
  };
  std::array<ipc::VectorMax3d, 4> p, q;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = point(0, i), q[i] = point(1, i);
  Said said;
  switch (kind) {
    case ContactKind::vertex_face:
      said.collision = ccd.point_triangle_ccd(p[0], p[1], p[2], p[3], q[0], q[1], q[2], q[3],
                                              said.toi, min_distance, tmax);
      break;
    case ContactKind::edge_edge:
      said.collision = ccd.edge_edge_ccd(p[0], p[1], p[2], p[3], q[0], q[1], q[2], q[3], said.toi,
                                         min_distance, tmax);
      break;
    case ContactKind::vertex_edge:
      said.collision =
          ccd.point_edge_ccd(p[0], p[1], p[2], q[0], q[1], q[2], said.toi, min_distance, tmax);
      break;
    case ContactKind::vertex_vertex:
      said.collision = ccd.point_point_ccd(p[0], p[1], q[0], q[1], said.toi, min_distance, tmax);
  }
  return said;
}

/// The same about a vertex and a face.
Said ask_face(const ipc::NarrowPhaseCCD& ccd, const Query& query, double min_distance = 0.0,
              double tmax = 1.0) {
  return ask(ccd, ContactKind::vertex_face, query, min_distance, tmax);
}

/// A vertex that falls by two from a height onto a face.
Query falling(double height) {
  return {{1, 1, height, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, height - 2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
}

TEST(IpcAdapter, LeavesItsPartOfTheDistance) {
  const NarrowPhaseCCD ccd(0.75);
  // From 1 to 1/4 at 3/8, from 1 to 1/2 + 1/8 at 3/16.
  EXPECT_NEAR(ask_face(ccd, falling(1)).toi, 0.375, 1e-12);
  EXPECT_LT(ask_face(ccd, falling(1)).toi, 0.375);
  EXPECT_NEAR(ask_face(ccd, falling(1), 0.5).toi, 0.1875, 1e-12);
  EXPECT_FALSE(ask_face(ccd, falling(1), 0.0, 0.25).collision);
  EXPECT_EQ(ask_face(ccd, falling(1), 0.0, 0.25).toi, infinity);
  EXPECT_NEAR(ask_face(NarrowPhaseCCD(1.0), falling(1)).toi, 0.5, 1e-12);
}

TEST(IpcAdapter, IsInContactAtZeroExactlyWhereItIs) {
  const NarrowPhaseCCD ccd;
  EXPECT_TRUE(ask_face(ccd, falling(0)).collision);
  EXPECT_EQ(ask_face(ccd, falling(0)).toi, 0.0);
  EXPECT_EQ(ask_face(ccd, falling(0.5), 0.5).toi, 0.0);
  EXPECT_GT(ask_face(ccd, falling(std::nextafter(0.5, 1.0)), 0.5).toi, 0.0);
  // The distance sqrt(2) is between two neighbouring doubles.
  const Query away{{-1, -1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const double below =
      std::sqrt(2.0) * std::sqrt(2.0) > 2.0 ? std::nextafter(std::sqrt(2.0), 0.0) : std::sqrt(2.0);
  EXPECT_GT(ask_face(ccd, away, below).toi, 0.0);
  EXPECT_EQ(ask_face(ccd, away, std::nextafter(below, 2.0)).toi, 0.0);
}

/// The time is positive for every start without contact, and before the exact impact.
TEST(IpcAdapter, NeverStalls) {
  const NarrowPhaseCCD ccd;
  for (double height = 1.0; height > 1e-300; height *= 0x1p-20) {
    const Said said = ask_face(ccd, falling(height));
    EXPECT_TRUE(said.collision);
    EXPECT_NEAR(said.toi / (0.8 * height / 2.0), 1.0, 1e-9) << height;
  }
}

TEST(IpcAdapter, StopsWhatIsNotFinite) {
  const Said said = ask_face(NarrowPhaseCCD(), falling(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(said.collision);
  EXPECT_EQ(said.toi, 0.0);
}

/// Bad arguments are refused for all points: also at distance 0, in contact, or not finite.
TEST(IpcAdapter, RefusesBadArgumentsAndLeavesTheTime) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(NarrowPhaseCCD(2.0)), std::invalid_argument);
  const NarrowPhaseCCD ccd;
  for (const double height : {0.0, 1.0, nan}) {
    const Query query = falling(height);
    for (const double min_distance : {-1.0, -1e-300, nan, infinity}) {
      EXPECT_THROW(ask_face(ccd, query, min_distance), std::invalid_argument);
    }
    for (const double tmax : {-0.5, 1.5, nan}) {
      EXPECT_THROW(ask_face(ccd, query, 0.0, tmax), std::invalid_argument);
    }
  }
  double toi = 7.0;
  const Eigen::Vector2d p(0, 0), q(2, 0);
  const Eigen::Vector3d r(1, 1, 1), s(1, -1, 1);
  EXPECT_THROW(ccd.point_point_ccd(p, r, p, s, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_point_ccd(p, q, p, s, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_edge_ccd(r, p, q, s, p, q, toi), std::invalid_argument);
  EXPECT_THROW(ccd.point_point_ccd(p, q, p, q, toi, -1.0), std::invalid_argument);
  EXPECT_EQ(toi, 7.0);
}

// ---- Scenes -------------------------------------------------------------------------------------

/// A collision mesh and a step of it. All coordinates are multiples of 2^-6, so that differences
/// are exact.
struct Scene {
  ipc::CollisionMesh mesh;
  MatrixXd start;
  MatrixXd end;
  tests::Scene step;  ///< the same in three dimensions
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
  Scene scene{ipc::CollisionMesh(start, matrix(edges), matrix(faces)), start, end, {}};
  scene.step.start = scene.step.end = tests::Places::Zero(vertices, 3);
  scene.step.start.leftCols(dim) = start;
  scene.step.end.leftCols(dim) = end;
  scene.step.edges = edges;
  scene.step.faces = faces;
  for (const int i : scene.mesh.codim_vertices()) scene.step.points.push_back(i);
  if (random.between(0, 3) == 0) return scene;
  scene.step.can_collide = tests::random_rule(random);
  scene.mesh.can_collide = [rule = scene.step.can_collide](std::size_t i, std::size_t j) {
    return rule(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
  };
  return scene;
}

// ---- All pairs one by one -----------------------------------------------------------------------

using Vertices = std::vector<int>;

template <class Row>
Vertices of(const Row& row) {
  return {row.begin(), row.end()};
}

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

/// The pairs that can collide, as the toolkit defines them: those of a step, and in two dimensions
/// each vertex with each edge, not edges with edges.
tests::Pairs pairs_of(const Scene& scene, const tests::AllPairs& all) {
  if (scene.mesh.dim() == 3) return all.pairs();
  tests::Pairs result;
  std::ranges::copy_if(all.pairs(), std::back_inserter(result),
                       [](const auto& pair) { return pair.first == ContactKind::vertex_vertex; });
  for (std::int32_t i = 0; i < scene.start.rows(); ++i) {
    for (std::int32_t k = 0; k < scene.mesh.edges().rows(); ++k) {
      if (!can_collide(scene.mesh, {i}, of(scene.mesh.edges().row(k)))) continue;
      result.push_back({ContactKind::vertex_edge, {i, k}});
    }
  }
  return result;
}

/// The least time of the pairs by the narrow phase; infinity if there is none.
double first_by_narrow_phase(const Scene& scene, double min_distance, double rescaling) {
  const NarrowPhaseCCD narrow_phase(rescaling);
  double first = infinity;
  const tests::AllPairs all(scene.step);
  for (const tests::NumberedPair& pair : pairs_of(scene, all)) {
    if (!all.are_near(pair, min_distance)) continue;
    const Said said = ask(narrow_phase, pair.first, all.query(pair), min_distance, 1.0,
                          static_cast<Eigen::Index>(scene.mesh.dim()));
    EXPECT_EQ(said.collision, said.toi < infinity);
    first = std::min(first, said.toi);
  }
  return first;
}

/// The exact time at which the first pair comes within the distance.
std::optional<exact::AlgebraicNumber> first_by_oracle(const Scene& scene, double min_distance) {
  std::optional<exact::AlgebraicNumber> first;
  const tests::AllPairs all(scene.step);
  for (const tests::NumberedPair& pair : pairs_of(scene, all)) {
    const exact::Decision decision = exact::decide(decided_as(pair.first), all.query(pair),
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
        // A vertex on its way along the edge. (A missing vertex of a face is its first one again.)
        Vertices vertices{edge[0]};
        std::ranges::copy(other, std::back_inserter(vertices));
        vertices.resize(moving_points, other[0]);
        Query query{};
        for (const std::size_t end : {0U, 1U}) {
          for (std::size_t i = 0; i < moving_points; ++i) {
            point_of(query, end, i) = scene.step.start.row(vertices[i]).transpose();
          }
        }
        point_of(query, 1, 0) = scene.step.start.row(edge[1]).transpose();
        expected = expected || exact::decide(ContactKind::vertex_face, query).collides();
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
