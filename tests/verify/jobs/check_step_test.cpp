#include "verify/jobs/check_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <optional>

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

// The collisions are compared with the oracle in tests/fast/step_test.cpp and step_bench_test.cpp.

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
      EXPECT_FALSE(fresh.is_free);
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
