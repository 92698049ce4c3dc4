/// \file
/// Whole steps of public simulations: the collisions, found in one or among all candidates of the
/// broad phase, are exactly the pairs that the published labels call true.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "fast/broad_phase.hpp"
#include "fast/certified.hpp"
#include "fast/step.hpp"
#include "tests/support/simulation_steps.hpp"

namespace touchstone::fast::simulation_steps_test {
namespace {

using tests::SimulationStep;

std::vector<IndexPair> all_candidates(const SimulationStep& step, Kind kind) {
  return kind == Kind::vertex_face ? vertex_face_candidates(step.vertices, step.faces)
                                   : edge_edge_candidates(step.vertices, step.edges);
}

std::vector<IndexPair> labelled_true(const SimulationStep& step, Kind kind) {
  const tests::LabelledPairs& labelled = step.labelled(kind);
  std::vector<IndexPair> result;
  for (std::size_t i = 0; i < labelled.pairs.size(); ++i) {
    if (labelled.collides[i]) result.push_back(labelled.pairs[i]);
  }
  std::ranges::sort(result);
  return result;
}

class SimulationSteps : public ::testing::TestWithParam<std::string_view> {};

TEST_P(SimulationSteps, CollideWhereTheirLabelsSayAndNowhereElse) {
  const std::filesystem::path folder = tests::simulation_folder();
  if (folder.empty()) GTEST_SKIP() << "public data missing";
  const SimulationStep step = tests::load_simulation_step(folder, GetParam());
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<IndexPair> pairs = all_candidates(step, kind);
    const Candidates candidates = step.candidates(kind, pairs);
    std::vector<IndexPair> colliding;
    std::optional<EarliestImpact> least;
    for (const Collision& collision : collisions(step.vertices, candidates)) {
      ASSERT_EQ(collision.result.verdict, Verdict::yes);
      colliding.push_back(pairs.at(collision.candidate));
      const auto [lower, upper] = std::pair(collision.result.toi_lower, collision.result.toi_upper);
      if (!least) least = EarliestImpact{.toi_lower = lower, .toi_upper = upper};
      least = EarliestImpact{.toi_lower = std::min(least->toi_lower, lower),
                             .toi_upper = std::min(least->toi_upper, upper)};
    }
    std::ranges::sort(colliding);
    EXPECT_EQ(colliding, labelled_true(step, kind)) << to_string(kind);
    const std::optional<EarliestImpact> first = earliest(step.vertices, candidates);
    ASSERT_TRUE(first && least);
    EXPECT_EQ(first->toi_lower, least->toi_lower);
    EXPECT_EQ(first->toi_upper, least->toi_upper);
  }
}

TEST_P(SimulationSteps, AreDecidedAsAWhole) {
  const std::filesystem::path folder = tests::simulation_folder();
  if (folder.empty()) GTEST_SKIP() << "public data missing";
  const SimulationStep scene = tests::load_simulation_step(folder, GetParam());
  const Step step(scene.vertices, {.edges = scene.edges, .faces = scene.faces, .points = {}});
  const std::vector<StepCollision> collisions = step.collisions();
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<IndexPair> colliding;
    for (const StepCollision& one : collisions) {
      if (Step::kind_of(one.kind) == kind) colliding.push_back(one.pair);
    }
    std::ranges::sort(colliding);
    EXPECT_EQ(colliding, labelled_true(scene, kind)) << to_string(kind);
  }
  const std::optional<StepImpact> first = step.earliest();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->toi_lower,
            std::ranges::min(collisions, {}, &StepCollision::toi_lower).toi_lower);
  EXPECT_EQ(first->toi_upper,
            std::ranges::min(collisions, {}, &StepCollision::toi_upper).toi_upper);
  EXPECT_FALSE(step.is_free());
}

INSTANTIATE_TEST_SUITE_P(Public, SimulationSteps, ::testing::ValuesIn(tests::simulation_scenes),
                         [](const auto& scene) {
                           std::string name(scene.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace touchstone::fast::simulation_steps_test
