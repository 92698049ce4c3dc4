#include "verify/jobs/check_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "touchstone/oracle.hpp"
#include "verify/generate/workload.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::jobs::check_step_test {
namespace {

/// Two patches that move through each other, as frames.
struct Frames {
  explicit Frames(std::uint64_t seed)
      : moving(generate::moving_patches({.seed = seed, .cells = 8})) {
    const auto rows = static_cast<Eigen::Index>(moving.vertices.size());
    mesh.vertices.resize(rows, 3);
    after.resize(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const fast::MovingVertex& vertex = moving.vertices[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k < 3; ++k) {
        mesh.vertices(i, k) = vertex.start.at(static_cast<std::size_t>(k));
        after(i, k) = vertex.end.at(static_cast<std::size_t>(k));
      }
    }
    mesh.faces = moving.faces;
    mesh.edges = moving.edges;
  }

  [[nodiscard]] StepCheck check(const StepCheckOptions& options = {}) const {
    std::optional<fast::Step> step;
    return check_step(step, mesh, mesh.vertices, after, options);
  }

  mesh::MovingMesh moving;
  mesh::Mesh mesh;
  mesh::Vertices after;
};

/// The pairs of a kind in contact, by the oracle.
std::vector<fast::IndexPair> touching_pairs(const mesh::MovingMesh& mesh, Kind kind) {
  const auto pairs = mesh::find_candidates(mesh, kind);
  const auto queries = mesh::queries_of(mesh, mesh::candidates_of(mesh, kind, pairs));
  std::vector<fast::IndexPair> colliding;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (exact::decide(kind, queries[i]).collides()) colliding.push_back(pairs[i]);
  }
  std::ranges::sort(colliding);
  return colliding;
}

std::vector<fast::IndexPair> pairs_of(const std::vector<fast::StepCollision>& collisions,
                                      fast::PairKind kind) {
  std::vector<fast::IndexPair> pairs;
  for (const fast::StepCollision& collision : collisions) {
    if (collision.kind == kind) pairs.push_back(collision.pair);
  }
  return pairs;
}

TEST(CheckStep, FindsWhatTheOracleCallsCollisionsInOrder) {
  const Frames frames(11);
  const StepCheck check = frames.check();
  ASSERT_TRUE(check.collisions.has_value());
  const auto vertex_face = touching_pairs(frames.moving, Kind::vertex_face);
  const auto edge_edge = touching_pairs(frames.moving, Kind::edge_edge);
  ASSERT_FALSE(edge_edge.empty());
  EXPECT_EQ(pairs_of(*check.collisions, fast::PairKind::vertex_face), vertex_face);
  EXPECT_EQ(pairs_of(*check.collisions, fast::PairKind::edge_edge), edge_edge);
  EXPECT_EQ(counts_of(*check.collisions), (PairCounts{vertex_face.size(), edge_edge.size(), 0, 0}));
  EXPECT_EQ(check.candidates,
            (PairCounts{mesh::find_candidates(frames.moving, Kind::vertex_face).size(),
                        mesh::find_candidates(frames.moving, Kind::edge_edge).size(), 0, 0}));
  EXPECT_FALSE(check.is_free);
}

TEST(CheckStep, GivesTheSameAfterOtherStepsOfTheMesh) {
  const Frames frames(12);
  for (const StepQuestion question :
       {StepQuestion::all, StepQuestion::earliest, StepQuestion::free}) {
    for (const auto alpha : {std::optional<double>(), std::optional(0.5)}) {
      const StepCheckOptions options{.question = question, .alpha = alpha};
      std::optional<fast::Step> step;
      (void)check_step(step, frames.mesh, frames.after, frames.mesh.vertices, options);
      const StepCheck later =
          check_step(step, frames.mesh, frames.mesh.vertices, frames.after, options);
      const StepCheck fresh = frames.check(options);
      EXPECT_EQ(later.candidates, fresh.candidates);
      EXPECT_EQ(later.is_free, fresh.is_free);
      EXPECT_EQ(later.earliest, fresh.earliest);
      EXPECT_EQ(later.collisions, fresh.collisions);
      EXPECT_EQ(later.free_alpha, fresh.free_alpha);
    }
  }
}

TEST(CheckStep, OfAMeshAtRestIsFree) {
  const Frames frames(11);
  std::optional<fast::Step> step;
  const StepCheck check =
      check_step(step, frames.mesh, frames.mesh.vertices, frames.mesh.vertices, {});
  EXPECT_TRUE(check.is_free);
  EXPECT_TRUE(check.collisions && check.collisions->empty());
  EXPECT_FALSE(check.earliest);
}

}  // namespace
}  // namespace touchstone::verify::jobs::check_step_test
