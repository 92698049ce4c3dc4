#include "examples/simulation/tumbling.hpp"

#include <gtest/gtest.h>

#include "tests/support/folder_test.hpp"
#include "verify/data/curved_query_file.hpp"
#include "verify/jobs/certify_curves.hpp"

namespace touchstone::simulation::tumbling_test {
namespace {

class Tumbling : public tests::FolderTest {};

TEST_F(Tumbling, RecordsQueriesThatAreSolvedRightly) {
  const TumblingResult result = tumble({.steps = 120, .folder = path("recorded")});
  EXPECT_GT(result.impacts, 3);
  EXPECT_LT(result.worst_change, 1e-9);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto index = static_cast<std::size_t>(kind);
    const auto file = verify::data::read_curved_queries(
        path(kind == Kind::vertex_face ? "recorded/tumbling-vf.npy" : "recorded/tumbling-ee.npy"));
    const auto judged = verify::jobs::certify_curves(kind, file.queries(), {});
    EXPECT_EQ(file.degree, 3U);
    EXPECT_EQ(judged.queries, result.queries.at(index));
    EXPECT_EQ(judged.collide, result.collisions.at(index));
    EXPECT_TRUE(judged.wrong.empty());
  }
  EXPECT_GT(result.collisions[0] + result.collisions[1], 0U);
}

TEST_F(Tumbling, IsTheSameWithoutFiles) {
  const TumblingResult with = tumble({.steps = 60, .folder = path("recorded")});
  const TumblingResult without = tumble({.steps = 60});
  EXPECT_EQ(with.queries, without.queries);
  EXPECT_EQ(with.collisions, without.collisions);
}

}  // namespace
}  // namespace touchstone::simulation::tumbling_test
