#include "verify/jobs/step_bench.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "touchstone/oracle.hpp"
#include "verify/generate/workload.hpp"
#include "verify/jobs/check_step.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::jobs::step_bench_test {
namespace {

/// The oracle's results for the candidates of a kind.
struct Expected {
  std::size_t candidates = 0;
  std::size_t collisions = 0;
  double earliest_lower = 2.0;
  double earliest_upper = 2.0;
};

Expected expected(const mesh::MovingMesh& mesh, ContactKind kind) {
  const std::vector<Query> candidates = mesh::candidates_of(mesh, kind);
  Expected all{.candidates = candidates.size()};
  for (const Query& query : candidates) {
    const exact::Decision verdict = exact::decide(kind, query);
    if (!verdict.collides()) continue;
    ++all.collisions;
    const auto [lower, upper] = verdict.toi->enclosure();
    all.earliest_lower = std::min(all.earliest_lower, lower);
    all.earliest_upper = std::min(all.earliest_upper, upper);
  }
  return all;
}

TEST(StepBench, FindsTheCollisionsAndTheEarliestOne) {
  const mesh::MovingMesh mesh = generate::moving_patches({.seed = 11, .cells = 8});
  std::vector<double> told;
  const StepResult result =
      bench_step(mesh, {.repetitions = 3, .threads = 2, .on_progress = [&](double fraction) {
                          told.push_back(fraction);
                        }});
  EXPECT_EQ(told, (std::vector<double>{1.0 / 3.0, 2.0 / 3.0, 1.0}));
  const Expected vertices = expected(mesh, ContactKind::vertex_face);
  const Expected edges = expected(mesh, ContactKind::edge_edge);
  EXPECT_EQ(result.name, "patches");
  EXPECT_EQ(result.vertices, mesh.vertices.size());
  EXPECT_EQ(result.edges, mesh.edges.size());
  EXPECT_EQ(result.faces, mesh.faces.size());
  EXPECT_EQ(result.vertex_face.candidates, vertices.candidates);
  EXPECT_EQ(result.vertex_face.collisions, vertices.collisions);
  EXPECT_EQ(result.edge_edge.candidates, edges.candidates);
  EXPECT_EQ(result.edge_edge.collisions, edges.collisions);
  ASSERT_GT(edges.collisions, 0U);
  ASSERT_TRUE(result.earliest);
  EXPECT_LE(result.earliest->toi_lower, std::min(vertices.earliest_upper, edges.earliest_upper));
  EXPECT_GE(result.earliest->toi_upper, std::min(vertices.earliest_lower, edges.earliest_lower));
  EXPECT_LE(result.earliest->toi_upper - result.earliest->toi_lower, 1e-11);
  EXPECT_TRUE(result.earliest_agrees);
  EXPECT_FALSE(result.interrupted);
  ASSERT_EQ(result.times.size(), 2U);
  EXPECT_EQ(result.times[0].threads, 1);
  EXPECT_EQ(result.times[1].threads, 2);
  for (const StepTimes& times : result.times) {
    for (const WorkTime& time : times.parts) {
      EXPECT_GT(time.wall, 0.0);
      EXPECT_GT(time.processor, 0.0);
    }
  }
}

TEST(StepBench, AStopLeavesTheRestOut) {
  const std::atomic<bool> stop = true;
  const StepResult result =
      bench_step(generate::moving_patches({.seed = 1, .cells = 4}), {.stop = &stop});
  EXPECT_TRUE(result.interrupted);
  EXPECT_TRUE(result.times.empty());
  EXPECT_TRUE(result.earliest_agrees);
  EXPECT_THROW(
      (void)bench_step(generate::moving_patches({.seed = 1, .cells = 1}), {.repetitions = 0}),
      std::invalid_argument);
}

// ---- Steps of frames ----------------------------------------------------------------------------

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

  mesh::MovingMesh moving;
  mesh::Mesh mesh;
  mesh::Vertices after;
};

// The collisions are compared with the oracle in tests/fast/step_test.cpp and step_bench_test.cpp,
// and shown in tests/transcripts/step.md.

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
      step.reset();
      const StepCheck fresh =
          check_step(step, frames.mesh, frames.mesh.vertices, frames.after, options);
      EXPECT_FALSE(fresh.is_free);
      EXPECT_EQ(later.candidates, fresh.candidates);
      EXPECT_EQ(later.is_free, fresh.is_free);
      EXPECT_EQ(later.earliest, fresh.earliest);
      EXPECT_EQ(later.collisions, fresh.collisions);
      EXPECT_EQ(later.free_alpha, fresh.free_alpha);
    }
  }
}

TEST(CheckStep, ListsWhatCollidesOfAFewCandidatesAlone) {
  const Frames frames(12);
  const auto check = [&](StepQuestion question, std::uint64_t most) {
    std::optional<fast::Step> step;
    return check_step(step, frames.mesh, frames.mesh.vertices, frames.after,
                      {.question = question, .most_candidates = most});
  };
  EXPECT_FALSE(check(StepQuestion::earliest, 0).is_free);
  const PairCounts candidates = *check(StepQuestion::all, 1'000'000).candidates;
  const auto count = std::accumulate(candidates.begin(), candidates.end(), std::uint64_t{0});
  EXPECT_FALSE(check(StepQuestion::all, count).is_free);
  EXPECT_THROW((void)check(StepQuestion::all, count - 1), std::runtime_error);
}

}  // namespace
}  // namespace touchstone::verify::jobs::step_bench_test
