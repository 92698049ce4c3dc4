#include "fast/broad_phase/box_tree.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::box_tree_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// Vertices at random places, and a primitive of three of them for each.
struct Cloud {
  explicit Cloud(int count, std::uint64_t seed)
      : vertices(places(count, seed), places(count, ~seed)) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      primitives.push_back({i, random.between(0, count - 1), random.between(0, count - 1)});
    }
  }

  static Eigen::MatrixX3d places(int count, std::uint64_t seed) {
    Random random(seed);
    Eigen::MatrixX3d result(count, 3);
    for (double& x : result.reshaped()) x = random.uniform(-1, 1);
    return result;
  }

  MovingVertices vertices;
  std::vector<Primitive> primitives;
};

bool contains(const Box& outer, const Box& inner) {
  Box both = outer;
  both.include(inner);
  return both == outer;
}

Box cube(double lower, double upper) {
  return {.lower = {lower, lower, lower}, .upper = {upper, upper, upper}};
}

TEST(Box, IsMadeEmptyAndGrows) {
  Box box;
  EXPECT_FALSE(box.overlaps(box));
  EXPECT_FALSE(box.overlaps(cube(-greatest, greatest)));
  box.include({.lower = {0, 1, 2}, .upper = {3, 4, 5}});
  box.include({.lower = {1, 0, 3}, .upper = {2, 5, 4}});
  EXPECT_EQ(box, (Box{.lower = {0, 0, 2}, .upper = {3, 5, 5}}));
}

TEST(Box, OverlapsWhatTouchesItAndNothingBeyond) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Box other = cube(0, 1);
    other.lower[axis] = 1;
    other.upper[axis] = 2;
    EXPECT_TRUE(cube(0, 1).overlaps(other) && other.overlaps(cube(0, 1)));
    other.lower[axis] = std::nextafter(1, 2);
    EXPECT_FALSE(cube(0, 1).overlaps(other) || other.overlaps(cube(0, 1)));
  }
}

TEST(Widened, IsTheNearestDoubleInsideTheExactSum) {
  Random random(1);
  const auto random_double = [&random] {
    return random.coin() ? random.finite_double() : random.few_bit_double(53, -60, -45);
  };
  for (int i = 0; i < 20'000; ++i) {
    const double bound = random_double(), distance = std::abs(random_double());
    const Box box = widened(cube(bound, bound), distance);
    const Rational exact = Rational(bound) + Rational(distance);
    EXPECT_LE(Rational(box.upper[0]), exact) << bound << ' ' << distance;
    const double next = std::nextafter(box.upper[0], Box::infinity);
    EXPECT_TRUE(std::isinf(next) || Rational(next) > exact) << bound << ' ' << distance;
    EXPECT_EQ(-box.lower[0], widened(cube(-bound, -bound), distance).upper[0]);
    EXPECT_EQ(box, cube(box.lower[0], box.upper[0]));
  }
}

TEST(Widened, HoldsAtTheEndsOfTheRange) {
  EXPECT_EQ(widened(cube(-greatest, greatest), greatest), cube(-greatest, greatest));
  EXPECT_EQ(widened(cube(-greatest, greatest), tiniest), cube(-greatest, greatest));
  EXPECT_EQ(widened(cube(greatest, -greatest), greatest), cube(0, 0));
  EXPECT_EQ(widened(cube(0, 0), tiniest), cube(-tiniest, tiniest));
  EXPECT_EQ(widened(cube(-1, 1), 0), cube(-1, 1));
  EXPECT_EQ(widened(Box{}, greatest), Box{});
}

TEST(SweptBox, IsAroundAllPlacesAtBothTimes) {
  Eigen::MatrixX3d start(3, 3), end(3, 3);
  start << 0, 1, 2, 3, 4, 5, -9, -9, -9;
  end << 1, -1, 2, 3, 4, 7, 9, 9, 9;
  const MovingVertices vertices(start, end);
  EXPECT_EQ(swept_box(vertices, {0, 1, 1}), (Box{.lower = {0, -1, 2}, .upper = {3, 4, 7}}));
  EXPECT_EQ(swept_box(vertices, {0, 0, 0}), (Box{.lower = {0, -1, 2}, .upper = {1, 1, 2}}));
  EXPECT_EQ(swept_box(vertices, {0, 1, 2}), cube(-9, 9));
}

TEST(ShareVertex, LooksAtEveryPlace) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      Primitive a{1, 2, 3}, b{4, 5, 6};
      EXPECT_FALSE(share_vertex(a, b));
      a[i] = b[j];
      EXPECT_TRUE(share_vertex(a, b));
    }
  }
}

TEST(BoxTree, HasEveryPrimitiveInOneGroupUnderNodesThatHoldIt) {
  for (const int count : {1, 7, 8, 9, 64, 65, 1000, 4001}) {
    const Cloud cloud(count, 3);
    const BoxTree tree(cloud.vertices, cloud.primitives);
    std::vector<int> found;
    ASSERT_EQ(tree.nodes().size(), 2 * tree.groups().size() - 1);
    for (std::size_t i = 0; i < tree.groups().size(); ++i) {
      const Group& group = tree.groups()[i];
      const BoxTree::Node& leaf = tree.nodes()[tree.leaf(i)];
      EXPECT_EQ(leaf.group, i);
      EXPECT_EQ(group.size == Group::capacity, i + 1 < tree.groups().size() || count % 8 == 0);
      for (std::size_t lane = 0; lane < group.size; ++lane) {
        const auto index = static_cast<std::size_t>(group.indices[lane]);
        found.push_back(group.indices[lane]);
        EXPECT_EQ(group.primitives[lane], cloud.primitives[index]);
        EXPECT_EQ(group.box(lane), swept_box(cloud.vertices, cloud.primitives[index]));
        EXPECT_TRUE(contains(leaf.box, group.box(lane)));
        EXPECT_TRUE(lane == 0 || group.indices[lane - 1] < group.indices[lane]);
      }
      for (std::size_t lane = group.size; lane < Group::capacity; ++lane) {
        EXPECT_EQ(group.box(lane), Box{});
      }
    }
    std::ranges::sort(found);
    ASSERT_EQ(found.size(), cloud.primitives.size());
    for (int i = 0; i < count; ++i) EXPECT_EQ(found[static_cast<std::size_t>(i)], i);
  }
}

TEST(BoxTree, HasNodesThatHoldAllUpToTheOneBehind) {
  const Cloud cloud(3000, 4);
  const BoxTree tree(cloud.vertices, cloud.primitives);
  for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
    const BoxTree::Node& node = tree.nodes()[i];
    ASSERT_GT(node.behind, i);
    ASSERT_LE(node.behind, tree.nodes().size());
    EXPECT_EQ(node.behind == i + 1, node.group != BoxTree::Node::inner);
    Box around;
    for (std::size_t below = i + 1; below < node.behind; ++below) {
      around.include(tree.nodes()[below].box);
      EXPECT_LE(tree.nodes()[below].behind, node.behind);
    }
    EXPECT_EQ(node.group == BoxTree::Node::inner ? node.box : Box{}, around);
  }
}

TEST(BoxTree, OfNothingIsEmpty) {
  const Cloud cloud(0, 5);
  const BoxTree tree(cloud.vertices, cloud.primitives);
  EXPECT_TRUE(tree.groups().empty() && tree.nodes().empty());
  for_each_overlapping(tree, 0, cube(-1, 1), [](const auto&, const auto&) { FAIL(); });
}

TEST(BoxTree, DoesNotDependOnTheThreads) {
  const Cloud cloud(5000, 6);
  const BoxTree tree(cloud.vertices, cloud.primitives);
  oneapi::tbb::task_arena alone(1);
  const BoxTree other = alone.execute([&] { return BoxTree(cloud.vertices, cloud.primitives); });
  ASSERT_EQ(tree.groups().size(), other.groups().size());
  for (std::size_t i = 0; i < tree.groups().size(); ++i) {
    EXPECT_EQ(tree.groups()[i].indices, other.groups()[i].indices);
  }
}

TEST(ForEachOverlapping, MeetsExactlyTheLaterGroupsThatOverlap) {
  const Cloud cloud(1500, 7);
  const BoxTree tree(cloud.vertices, cloud.primitives);
  Random random(8);
  for (std::size_t first = 0; first < tree.groups().size(); ++first) {
    Box box;
    for (const double x : {random.uniform(-1, 1), random.uniform(-1, 1)}) box.include(cube(x, x));
    std::vector<const Group*> expected, met;
    for (std::size_t i = first; i < tree.groups().size(); ++i) {
      if (tree.nodes()[tree.leaf(i)].box.overlaps(box)) expected.push_back(&tree.groups()[i]);
    }
    for_each_overlapping(tree, tree.leaf(first), box,
                         [&](const BoxTree::Node& leaf, const Group& group) {
                           EXPECT_EQ(&tree.groups()[leaf.group], &group);
                           met.push_back(&group);
                         });
    EXPECT_EQ(met, expected);
  }
}

TEST(Group, TellsTheLanesThatOverlapABox) {
  // Coordinates of few values: bounds are often equal, and zeros have either sign.
  static constexpr std::array<double, 7> values{-greatest, -1, -tiniest, -0.0, 0.0, 1, greatest};
  Random random(9);
  const auto random_box = [&random] {
    Box box;
    for (int i = 0; i < 2; ++i) {
      Box point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point.lower[axis] = point.upper[axis] =
            values[static_cast<std::size_t>(random.between(0, 6))];
      }
      box.include(point);
    }
    return box;
  };
  for (int i = 0; i < 20'000; ++i) {
    Group group{};
    std::array<Box, Group::capacity> boxes;
    for (std::size_t lane = 0; lane < Group::capacity; ++lane) {
      if (lane < 6) boxes[lane] = random_box();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        group.lower[axis][lane] = boxes[lane].lower[axis];
        group.upper[axis][lane] = boxes[lane].upper[axis];
      }
    }
    const Box box = random_box();
    const unsigned lanes = group.overlapping(box);
    for (std::size_t lane = 0; lane < Group::capacity; ++lane) {
      EXPECT_EQ((lanes >> lane) & 1U, boxes[lane].overlaps(box) ? 1U : 0U);
    }
    EXPECT_EQ(lanes >> Group::capacity, 0U);
  }
}

}  // namespace
}  // namespace touchstone::fast::box_tree_test
