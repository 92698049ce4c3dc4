#include "examples/simulation/tumbling.hpp"

#include <gtest/gtest.h>

#include "tests/support/folder_test.hpp"
#include "verify/data/dataset.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::simulation::tumbling_test {
namespace {

class Tumbling : public tests::FolderTest {};

TEST_F(Tumbling, RecordsQueriesThatAreSolvedRightly) {
  const TumblingResult result = tumble({.steps = 120, .folder = path("recorded")});
  EXPECT_GT(result.impacts, 3);
  EXPECT_LT(result.worst_change, 1e-9);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto index = static_cast<std::size_t>(kind);
    const auto source = verify::data::open_dataset(
        path(kind == Kind::vertex_face ? "recorded/tumbling-vf.npy" : "recorded/tumbling-ee.npy"));
    EXPECT_EQ(source->shape(), (QueryShape{.kind = kind, .degree = 3}));
    const auto certified =
        verify::solvers::solver_in_process(verify::solvers::find_method("certified"), {});
    const auto judged = verify::jobs::certify(*source, {.solvers = {certified.get()}});
    const auto& method = judged.methods.at(0);
    EXPECT_EQ(judged.queries, result.queries.at(index));
    EXPECT_EQ(judged.collisions, result.collisions.at(index));
    EXPECT_EQ(method.judgement.queries, judged.queries);
    EXPECT_TRUE(verify::judge::keeps(method.judgement, method.promise));
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
