#include "fast/broad_phase/body_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::fast::body_tree_test {
namespace {

/// The bodies of primitives in a group of a level, from their vertices.
std::set<std::int32_t> bodies_below(const PrimitiveGroups& groups,
                                    const std::vector<std::int32_t>& of_vertices, std::size_t level,
                                    std::size_t group, std::size_t lane) {
  std::set<std::int32_t> result;
  std::size_t first = group * group_size + lane, count = 1;  // of primitives, if the level is 0
  for (std::size_t i = 0; i < level; ++i) first *= group_size, count *= group_size;
  for (std::size_t i = first; i < std::min(first + count, groups.size()); ++i) {
    const GroupMembers& members = groups.members()[i / group_size];
    for (const IndexLanes& corner : members.vertices) {
      result.insert(of_vertices[static_cast<std::size_t>(corner[i % group_size])]);
    }
  }
  return result;
}

TEST(BodyTree, NamesTheOneBodyOfEachNodeOrThatItIsMixed) {
  tests::Random random(192);
  static constexpr int vertices = 1500;
  Eigen::MatrixX3d places(vertices, 3);
  std::vector<std::int32_t> of_vertices;
  std::vector<Edge> edges;
  for (int i = 0; i < vertices; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) places(i, axis) = random.uniform(-1, 1);
    // One body for each half of space, and a few vertices of a third.
    of_vertices.push_back(random.between(0, 200) == 0 ? 2 : places(i, 0) > 0 ? 1 : 0);
    edges.push_back({i, random.between(0, 3) == 0 ? random.between(0, i) : i});
  }
  const FloatBounds bounds(MovingVertices(places, places));
  const PrimitiveGroups groups(bounds, std::span<const Edge>(edges));
  const BodyTree tree(groups, of_vertices);
  int pure = 0, mixed = 0;
  std::size_t nodes = groups.size();
  for (std::size_t level = 0; level < 3; ++level) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const std::set<std::int32_t> expected =
          bodies_below(groups, of_vertices, level, i / group_size, i % group_size);
      const std::int32_t body = tree.bodies(level, i / group_size)[i % group_size];
      EXPECT_EQ(body, expected.size() == 1 ? *expected.begin() : BodyTree::mixed);
      ++(body == BodyTree::mixed ? mixed : pure);
    }
    nodes = (nodes + group_size - 1) / group_size;
  }
  EXPECT_GT(pure, 100);
  EXPECT_GT(mixed, 100);
}

TEST(BodyTree, OfNothingIsEmpty) {
  const Eigen::MatrixX3d none(0, 3);
  const FloatBounds bounds(MovingVertices(none, none));
  const std::vector<Edge> edges;
  const BodyTree tree(PrimitiveGroups(bounds, std::span<const Edge>(edges)), {});
  SUCCEED();
}

}  // namespace
}  // namespace touchstone::fast::body_tree_test
