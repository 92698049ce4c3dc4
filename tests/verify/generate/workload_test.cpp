#include "verify/generate/workload.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "touchstone/oracle.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::generate::workload_test {
namespace {

TEST(Workload, PatchesHaveEnoughCandidatesOfWhichSomePerCentCollideWithAnySeed) {
  static constexpr std::size_t asked = 2000;
  for (const std::uint64_t seed : {0U, 1U, 2021U, 4711U, 0xFFFFFFFFU}) {
    const mesh::MovingMesh mesh = moving_patches({.seed = seed});
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      const std::vector<Query> queries = mesh::candidates_of(mesh, kind);
      EXPECT_GE(queries.size(), 100'000U) << seed << to_string(kind);
      EXPECT_LE(queries.size(), 1'000'000U) << seed << to_string(kind);
      std::size_t collisions = 0;
      for (const std::size_t i : jobs::spread_sample(queries.size(), asked)) {
        collisions += exact::decide(kind, queries[i]).collides() ? 1U : 0U;
      }
      EXPECT_GE(collisions, asked / 200) << seed << to_string(kind);
      EXPECT_LE(collisions, asked / 5) << seed << to_string(kind);
    }
  }
}

TEST(Workload, PatchesHaveCells) {
  EXPECT_THROW((void)moving_patches({.cells = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::generate::workload_test
