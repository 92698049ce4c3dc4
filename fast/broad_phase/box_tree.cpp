#include "fast/broad_phase/box_tree.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {
namespace {

namespace tbb = oneapi::tbb;

/// A subtree of so many groups is built by one task.
constexpr std::size_t groups_of_task = 64;

/// The greatest double that is not above bound + distance. An infinite bound stays.
double sum_rounded_down(double bound, double distance) {
  const double sum = bound + distance;
  if (sum == Box::infinity) return std::min(bound, std::numeric_limits<double>::max());
  // To take the greater summand away again is exact [dekker1971], so this compares sum and exact sum.
  const bool rounded_up =
      std::abs(bound) >= distance ? sum - bound > distance : sum - distance > bound;
  return rounded_up ? std::nextafter(sum, -Box::infinity) : sum;
}

/// A task may run in a thread with a floating-point environment of its own.
template <class Work>
auto strictly(const Work& work) {
  return [&work] {
    const StrictFloatingPoint strict;
    work();
  };
}

/// A primitive on its way into a group.
struct Seed {
  std::array<float, 3> centre;
  std::int32_t index;
};

/// The axis along which the centres spread most.
std::size_t widest_axis(std::span<const Seed> seeds) {
  std::array<float, 3> least = seeds.front().centre, greatest = least;
  for (const Seed& seed : seeds) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], seed.centre[axis]);
      greatest[axis] = std::max(greatest[axis], seed.centre[axis]);
    }
  }
  std::size_t widest = 0;
  for (const std::size_t axis : {1U, 2U}) {
    if (greatest[axis] - least[axis] > greatest[widest] - least[widest]) widest = axis;
  }
  return widest;
}

void set_lane(Group& group, std::size_t lane, const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    group.lower[axis][lane] = box.lower[axis];
    group.upper[axis][lane] = box.upper[axis];
  }
}

/// Fills the parts of a tree.
class Builder {
 public:
  Builder(const MovingVertices& vertices, std::span<const Primitive> primitives,
          std::span<Group> groups, std::span<BoxTree::Node> nodes, std::span<std::uint32_t> leaves)
      : vertices_(vertices),
        primitives_(primitives),
        groups_(groups),
        nodes_(nodes),
        leaves_(leaves),
        seeds_(primitives.size()) {}

  void build() {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, seeds_.size()), [this](const auto& range) {
      const StrictFloatingPoint strict;
      for (std::size_t i = range.begin(); i < range.end(); ++i) seeds_[i] = seed(i);
    });
    build(0, 0, groups_.size());
  }

 private:
  [[nodiscard]] Seed seed(std::size_t i) const {
    const Box box = swept_box(vertices_, primitives_[i]);
    Seed result{.centre = {}, .index = static_cast<std::int32_t>(i)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Halved first: the sum may be beyond the greatest double.
      result.centre[axis] = static_cast<float>(0.5 * box.lower[axis] + 0.5 * box.upper[axis]);
    }
    return result;
  }

  [[nodiscard]] std::span<Seed> seeds_of(std::size_t first_group, std::size_t end_group) {
    const std::size_t first = first_group * Group::capacity;
    const std::size_t end = std::min(end_group * Group::capacity, seeds_.size());
    return std::span(seeds_).subspan(first, end - first);
  }

  /// Builds the subtree over these groups with node number `root` at its top.
  void build(std::size_t root, std::size_t first, std::size_t end) {
    if (end - first == 1) {
      build_leaf(root, first);
      return;
    }
    const std::size_t middle = first + (end - first) / 2;
    const std::size_t left = root + 1, right = left + 2 * (middle - first) - 1;
    split(first, middle, end);
    const auto build_left = [&] { build(left, first, middle); };
    const auto build_right = [&] { build(right, middle, end); };
    if (end - first > groups_of_task) {
      tbb::parallel_invoke(strictly(build_left), strictly(build_right));
    } else {
      build_left();
      build_right();
    }
    BoxTree::Node& node = nodes_[root];
    node.box = nodes_[left].box;
    node.box.include(nodes_[right].box);
    node.behind = static_cast<std::uint32_t>(root + 2 * (end - first) - 1);
    node.group = BoxTree::Node::inner;
  }

  /// The seeds of the groups before the middle become those with the smaller centres. Equal centres
  /// go by index, so that nothing depends on the order before.
  void split(std::size_t first, std::size_t middle, std::size_t end) {
    const std::span<Seed> seeds = seeds_of(first, end);
    const std::size_t axis = widest_axis(seeds);
    const auto nth =
        seeds.begin() + static_cast<std::ptrdiff_t>((middle - first) * Group::capacity);
    std::nth_element(seeds.begin(), nth, seeds.end(), [axis](const Seed& a, const Seed& b) {
      return std::tie(a.centre[axis], a.index) < std::tie(b.centre[axis], b.index);
    });
  }

  void build_leaf(std::size_t leaf, std::size_t number) {
    const std::span<Seed> seeds = seeds_of(number, number + 1);
    std::ranges::sort(seeds, {}, &Seed::index);
    Group& group = groups_[number];
    Box around;
    group.size = seeds.size();
    for (std::size_t lane = 0; lane < Group::capacity; ++lane) {
      Box box;
      if (lane < seeds.size()) {
        group.indices[lane] = seeds[lane].index;
        group.primitives[lane] = primitives_[static_cast<std::size_t>(seeds[lane].index)];
        box = swept_box(vertices_, group.primitives[lane]);
      }
      set_lane(group, lane, box);
      around.include(box);
    }
    nodes_[leaf] = {.box = around,
                    .behind = static_cast<std::uint32_t>(leaf + 1),
                    .group = static_cast<std::uint32_t>(number)};
    leaves_[number] = static_cast<std::uint32_t>(leaf);
  }

  const MovingVertices& vertices_;
  std::span<const Primitive> primitives_;
  std::span<Group> groups_;
  std::span<BoxTree::Node> nodes_;
  std::span<std::uint32_t> leaves_;
  std::vector<Seed> seeds_;
};

}  // namespace

void Box::include(const Box& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(lower[axis], other.lower[axis]);
    upper[axis] = std::max(upper[axis], other.upper[axis]);
  }
}

Box widened(const Box& box, double distance) {
  Box result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = -sum_rounded_down(-box.lower[axis], distance);
    result.upper[axis] = sum_rounded_down(box.upper[axis], distance);
  }
  return result;
}

Box swept_box(const MovingVertices& vertices, const Primitive& primitive) {
  Box box;
  for (const std::int32_t index : primitive) {
    const MovingVertex& vertex = vertices[static_cast<std::size_t>(index)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min({box.lower[axis], vertex.start[axis], vertex.end[axis]});
      box.upper[axis] = std::max({box.upper[axis], vertex.start[axis], vertex.end[axis]});
    }
  }
  return box;
}

Box Group::box(std::size_t lane) const {
  return {.lower = {lower[0][lane], lower[1][lane], lower[2][lane]},
          .upper = {upper[0][lane], upper[1][lane], upper[2][lane]}};
}

BoxTree::BoxTree(const MovingVertices& vertices, std::span<const Primitive> primitives)
    : groups_((primitives.size() + Group::capacity - 1) / Group::capacity),
      nodes_(groups_.empty() ? 0 : 2 * groups_.size() - 1),
      leaves_(groups_.size()) {
  if (primitives.empty()) return;
  Builder(vertices, primitives, groups_, nodes_, leaves_).build();
}

}  // namespace touchstone::fast
