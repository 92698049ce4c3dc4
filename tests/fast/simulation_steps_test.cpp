/// \file
/// Whole steps of public simulations: the broad phase finds as many candidates as were published,
/// all labelled pairs among them, and the collisions, of one or of all candidates, are exactly the
/// pairs that the published labels call true.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "fast/candidates.hpp"
#include "tests/support/simulation_steps.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast::simulation_steps_test {
namespace {

using tests::SimulationStep;
using Pairs = std::vector<IndexPair>;

struct Published {
  ContactKind kind;
  std::size_t candidates, collisions;
};
struct PublishedStep {
  std::string_view scene;
  std::array<Published, 2> kinds;

  friend std::ostream& operator<<(std::ostream& out, const PublishedStep& one) {
    return out << one.scene;
  }
};

constexpr auto published = std::to_array<PublishedStep>({
    {"cloth-ball",
     {{{ContactKind::vertex_face, 1'655'541, 19'032},
       {ContactKind::edge_edge, 5'197'332, 94'822}}}},
    {"armadillo-rollers",
     {{{ContactKind::vertex_face, 2'031'902, 4'650}, {ContactKind::edge_edge, 5'068'080, 19'308}}}},
    {"cloth-funnel",
     {{{ContactKind::vertex_face, 7'319, 27}, {ContactKind::edge_edge, 33'770, 107}}}},
});

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

/// Compares the label of one query in `stride` with the oracle.
constexpr std::size_t stride = 97;

Pairs labelled_true(const SimulationStep& step, ContactKind kind) {
  const tests::LabelledPairs& labelled = step.labelled(kind);
  Pairs result;
  for (std::size_t i = 0; i < labelled.pairs.size(); ++i) {
    if (labelled.collides[i]) result.push_back(labelled.pairs[i]);
    if (i % stride != 0) continue;
    const Query query =
        query_of(step.vertices, step.candidates(kind, labelled.pairs), labelled.pairs[i]);
    EXPECT_EQ(exact::decide(kind, query).collides(), labelled.collides[i]) << i;
  }
  return sorted(result);
}

class SimulationSteps : public ::testing::TestWithParam<PublishedStep> {};

TEST_P(SimulationSteps, HaveThePublishedCandidatesAndCollisions) {
  const std::filesystem::path folder = tests::simulation_folder();
  if (folder.empty()) GTEST_SKIP() << "public data missing";
  const SimulationStep scene = tests::load_simulation_step(folder, GetParam().scene);
  const Step step(scene.vertices, {.edges = scene.edges, .faces = scene.faces, .points = {}});
  const std::vector<StepCollision> all = step.collisions();
  for (const auto& [kind, candidates, expected] : GetParam().kinds) {
    SCOPED_TRACE(std::string(to_string(kind)));
    const Pairs truth = labelled_true(scene, kind);
    EXPECT_EQ(truth.size(), expected);
    const Pairs found = sorted(kind == ContactKind::vertex_face
                                   ? vertex_face_candidates(scene.vertices, scene.faces)
                                   : edge_edge_candidates(scene.vertices, scene.edges));
    EXPECT_EQ(found.size(), candidates);
    for (const IndexPair& pair : scene.labelled(kind).pairs) {
      EXPECT_TRUE(std::ranges::binary_search(found, pair));
    }
    EXPECT_TRUE(std::ranges::includes(found, truth));
    Pairs of_step;
    for (const StepCollision& one : all) {
      if (decided_as(one.kind) == kind) of_step.push_back(one.pair);
    }
    EXPECT_EQ(sorted(of_step), truth);
  }
  const std::optional<StepImpact> first = step.earliest();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->toi_lower, std::ranges::min(all, {}, &StepCollision::toi_lower).toi_lower);
  EXPECT_EQ(first->toi_upper, std::ranges::min(all, {}, &StepCollision::toi_upper).toi_upper);
  EXPECT_FALSE(step.is_free());
}

INSTANTIATE_TEST_SUITE_P(Public, SimulationSteps, ::testing::ValuesIn(published),
                         [](const auto& tested) {
                           std::string name(tested.param.scene);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace touchstone::fast::simulation_steps_test
