#include "examples/simulation/recorder.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "exact/oracle.hpp"
#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/world.hpp"
#include "tests/support/folder_test.hpp"
#include "verify/data/dataset.hpp"

namespace touchstone::simulation::recorder_test {
namespace {

class Recorded : public tests::FolderTest, public testing::WithParamInterface<bool> {};

INSTANTIATE_TEST_SUITE_P(Formats, Recorded, testing::Bool(),
                         [](const auto& of) { return of.param ? "Npy" : "Csv"; });

TEST_P(Recorded, QueriesComeBackWithTheTruth) {
  const World world(make_scene("wedge"));
  Eigen::VectorXd end = world.start();
  for (Eigen::Index i = 2; i < end.size(); i += 3) {
    if (!world.is_held(i)) end[i] -= 0.05;
  }
  Recorder recorder({.folder = path("recorded"), .name = "wedge", .as_npy = GetParam()});
  CollisionDetector detector({.recorder = &recorder});
  (void)detector.step_size(world.step(world.start(), end));
  recorder.close();
  EXPECT_GT(recorder.collisions(Kind::edge_edge), 0);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::uint64_t queries = 0, collisions = 0;
    const std::string file = path("recorded") + "/" + std::string(to_string(kind)) + "/wedge" +
                             (GetParam() ? ".npy" : ".csv");
    const auto source = verify::data::open_dataset(file, {});
    while (const auto query = source->next()) {
      ++queries;
      ASSERT_TRUE(query->collides.has_value());
      EXPECT_EQ(*query->collides, exact::decide(kind, query->query).collides());
      if (*query->collides) ++collisions;
    }
    EXPECT_EQ(queries, recorder.queries(kind));
    EXPECT_EQ(collisions, recorder.collisions(kind));
  }
}

TEST_P(Recorded, NoMoreThanTheLimit) {
  Recorder recorder({.folder = path("recorded"), .name = "some", .as_npy = GetParam(), .limit = 3});
  for (int i = 0; i < 5; ++i) recorder.add(Kind::vertex_face, {});
  recorder.close();
  EXPECT_EQ(recorder.queries(Kind::vertex_face), 3);
  EXPECT_EQ(recorder.collisions(Kind::vertex_face), 3);
  EXPECT_EQ(recorder.queries(Kind::edge_edge), 0);
}

}  // namespace
}  // namespace touchstone::simulation::recorder_test
