#include "verify/generate/workload.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "touchstone/oracle.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::generate::workload_test {
namespace {

std::vector<Query> patch_queries(const mesh::MovingMesh& mesh, Kind kind) {
  const auto pairs = mesh::find_candidates(mesh, kind);
  return mesh::queries_of(mesh, mesh::candidates_of(mesh, kind, pairs));
}

TEST(Workload, PatchesHaveEnoughCandidatesOfWhichSomePerCentCollideWithAnySeed) {
  static constexpr std::size_t asked = 2000;
  for (const std::uint64_t seed : {0U, 1U, 2021U, 4711U, 0xFFFFFFFFU}) {
    const mesh::MovingMesh mesh = moving_patches({.seed = seed});
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const auto queries = patch_queries(mesh, kind);
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

TEST(Workload, EndContactsAreAtTheEnd) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const double scale : {0.01, 1.0, 1000.0}) {
      for (const bool two_decimals : {false, true}) {
        const data::QueryGroup group =
            end_contacts(kind, {.scale = scale, .two_decimals = two_decimals, .count = 50});
        ASSERT_EQ(group.queries().size(), 50U);
        double greatest = 0.0;
        for (const Query& query : group.queries().straight()) {
          const exact::Decision truth = exact::decide(kind, query);
          ASSERT_TRUE(truth.collides());
          for (const double x : query.coordinates) {
            greatest = std::max(greatest, std::abs(x));
            if (two_decimals) {
              EXPECT_EQ(std::stod(fmt::format("{:.6g}", x)), x) << "a short decimal";
            }
          }
        }
        EXPECT_LE(greatest, scale);
        EXPECT_GT(greatest, 0.9 * scale);
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::generate::workload_test
