#include "fast/distance/proximity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "fast/distance/exact_distance.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::fast::proximity_test {
namespace {

using tests::Random;

TEST(Proximity, LeavesOutNoneThatIsNearAndMostThatAreNot) {
  Random random(2400);
  std::size_t near = 0, listed = 0, all = 0;
  for (int round = 0; round < tests::trials(20); ++round) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      for (const Norm norm : {Norm::l2, Norm::linf}) {
        for (const double distance : {0.0, 0.25, 1.0}) {
          std::vector<Query> queries;
          for (int i = 0; i < 200; ++i) {
            const tests::Family family = tests::all_families[static_cast<std::size_t>(i) % 4];
            queries.push_back(tests::random_query(random, kind, family).query);
          }
          const Separation separation{.distance = distance, .norm = norm};
          std::vector<Query> at_rest = queries;
          const auto found = perhaps_within(kind, at_rest, separation);
          for (const CertifiedKernel* const kernel : certified_kernels()) {
            at_rest = queries;
            auto same = perhaps_within(kind, at_rest, separation, *kernel);
            EXPECT_TRUE(std::ranges::is_permutation(same, found));
          }
          for (std::size_t i = 0; i < queries.size(); ++i) {
            if (exact_distance(kind, queries[i], 0.0, norm).lower > distance) continue;
            ++near;
            EXPECT_TRUE(std::ranges::count(found, i) == 1);
          }
          listed += found.size();
          all += queries.size();
        }
      }
    }
  }
  EXPECT_GT(near, all / 10);
  EXPECT_LT(listed, near + all / 10);
}

}  // namespace
}  // namespace touchstone::fast::proximity_test
