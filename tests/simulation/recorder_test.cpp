#include "examples/simulation/recorder.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/tumbling.hpp"
#include "examples/simulation/world.hpp"
#include "tests/support/folder_test.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::simulation::recorder_test {
namespace {

class Recorded : public tests::FolderTest, public testing::WithParamInterface<bool> {};

INSTANTIATE_TEST_SUITE_P(Formats, Recorded, testing::Bool(),
                         [](const auto& of) { return of.param ? "Npy" : "Csv"; });

class RecordedPart : public tests::FolderTest {};

/// Records `motions` times that a box falls onto a wedge.
void record(Recorder& recorder, int motions, std::size_t limit = SIZE_MAX) {
  const World world(make_scene("wedge"));
  Eigen::VectorXd end = world.start();
  for (Eigen::Index i = 2; i < end.size(); i += 3) {
    if (!world.is_held(i)) end[i] -= 0.05;
  }
  CollisionDetector detector({.recorder = &recorder, .record_limit = limit});
  for (int i = 0; i < motions; ++i) (void)detector.step_size(world.step(world.start(), end));
  recorder.close();
}

TEST_P(Recorded, QueriesComeBackWithTheTruth) {
  Recorder recorder({.folder = path("recorded"), .name = "wedge", .as_npy = GetParam()});
  record(recorder, 1);
  EXPECT_GT(recorder.collisions(Kind::edge_edge), 0);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::uint64_t queries = 0, collisions = 0;
    const std::string file = path("recorded") + "/" + std::string(to_string(kind)) + "/wedge" +
                             (GetParam() ? ".npy" : ".csv");
    const auto source = verify::data::open_dataset(file, {});
    while (const auto query = source->next()) {
      ++queries;
      ASSERT_TRUE(query->collides.has_value());
      EXPECT_EQ(*query->collides, exact::decide(query->query.queries(), 0).collides());
      if (*query->collides) ++collisions;
    }
    EXPECT_EQ(queries, recorder.queries(kind));
    EXPECT_EQ(collisions, recorder.collisions(kind));
  }
}

/// The queries of two motions: all, or at most `limit` of each motion and kind.
std::vector<Query> recorded(const std::string& folder, Kind kind, std::size_t limit) {
  Recorder recorder({.folder = folder, .name = "wedge", .as_npy = true});
  record(recorder, 2, limit);
  const std::string file = folder + "/" + std::string(to_string(kind)) + "/wedge.npy";
  std::vector<Query> queries;
  const auto source = verify::data::open_dataset(file, {});
  while (const auto query = source->next()) queries.push_back(query->query.straight());
  return queries;
}

TEST_F(RecordedPart, IsSoManyOfEachMotionEvenlySpread) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const std::vector<Query> all = recorded(path("all"), kind, SIZE_MAX);
    const std::size_t of_motion = all.size() / 2;
    ASSERT_GT(of_motion, 8);
    const std::vector<Query> some = recorded(path("some"), kind, 4);
    ASSERT_EQ(some.size(), 8);
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(some[i], all[i / 4 * of_motion + i % 4 * of_motion / 4]) << i;
    }
  }
}

// ---- Of a tumbling body -------------------------------------------------------------------------

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
}  // namespace touchstone::simulation::recorder_test
