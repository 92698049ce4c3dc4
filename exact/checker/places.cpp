#include "exact/checker/places.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {
namespace {

/// All enlarged lengths are at most 2^50.
constexpr int bits_of_lengths = 50;

/// The least number whose power of two is above all coordinates and the greatest distance.
int exponent_of_scene(const std::vector<Motion>& vertices, double distance) {
  double greatest = distance;
  for (const Motion& vertex : vertices) {
    for (const double x : vertex.start) greatest = std::max(greatest, std::abs(x));
    for (const double x : vertex.end) greatest = std::max(greatest, std::abs(x));
  }
  int exponent = 0;
  std::frexp(greatest, &exponent);
  return exponent;
}

/// The greatest integer that is not above x · 2^shift. It is a double: lengths have 50 bits. (GMP's
/// integers for it are `long`, which has 32 bits on Windows.)
std::int64_t rounded_down(mpq_class x, int shift) {
  if (shift < 0) {
    x >>= static_cast<mp_bitcnt_t>(-shift);
  } else {
    x <<= static_cast<mp_bitcnt_t>(shift);
  }
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return static_cast<std::int64_t>(result.get_d());
}

std::int64_t rounded_up(const mpq_class& x, int shift) { return -rounded_down(-x, shift); }

/// The least d·x of all x in the box.
std::int64_t least(const Direction& d, const Box& box) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += d[k] * (d[k] < 0 ? box.upper[k] : box.lower[k]);
  return sum;
}

/// The greatest d·x of all x in the box.
std::int64_t greatest(const Direction& d, const Box& box) {
  return -least({-d[0], -d[1], -d[2]}, box);
}

// ---- The search for pairs -----------------------------------------------------------------------

/// A node of a tree. A leaf has a primitive; another node has two halves, which stand before it.
struct Node {
  MovingBox box;
  const Primitive* primitive = nullptr;
  std::size_t left = 0;
  std::size_t right = 0;
  /// The number of leaves below it.
  std::size_t count = 1;
};

/// The nodes, the root last.
using Tree = std::vector<Node>;
using Leaf = std::vector<Node>::iterator;

/// The length of a box on an axis, at the start and at the end in sum.
std::int64_t length(const MovingBox& box, std::size_t axis) {
  return box.start.upper[axis] - box.start.lower[axis] + box.end.upper[axis] - box.end.lower[axis];
}

/// Four times the middle of a box on an axis.
std::int64_t middle(const MovingBox& box, std::size_t axis) {
  return box.start.lower[axis] + box.start.upper[axis] + box.end.lower[axis] + box.end.upper[axis];
}

/// Adds the tree of some leaves: they are divided in halves by their middles, on the axis on which
/// the box around them is longest. \returns the number of its root.
std::size_t add_tree(Tree& tree, Leaf first, Leaf last) {
  Node node = *first;
  if (last - first > 1) {
    for (auto leaf = first; leaf != last; ++leaf) node.box.include(leaf->box);
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (length(node.box, axis) > length(node.box, longest)) longest = axis;
    }
    const auto half = first + (last - first) / 2;
    const auto place = [longest](const Node& leaf) { return middle(leaf.box, longest); };
    std::ranges::nth_element(first, half, last, {}, place);
    node.primitive = nullptr;
    node.left = add_tree(tree, first, half);
    node.right = add_tree(tree, half, last);
    node.count = static_cast<std::size_t>(last - first);
  }
  tree.push_back(node);
  return tree.size() - 1;
}

/// The search for the pairs of two trees, or of one.
class Search {
 public:
  Search(const Places& places, const Tree& tree, const Tree& other, std::int64_t& comparisons_left,
         const TakePair& take)
      : places_(places),
        tree_(tree),
        other_(other),
        comparisons_left_(comparisons_left),
        take_(take) {}

  /// Finds the pairs of two primitives below one node. \pre both trees are the same
  void find_within(const Node& node) {
    if (node.primitive != nullptr) return;
    find_within(tree_[node.left]);
    find_within(tree_[node.right]);
    find_between(tree_[node.left], tree_[node.right]);
  }

  /// Finds the pairs of a primitive below a node of the tree and one below a node of the other.
  void find_between(const Node& a, const Node& b) {
    if (--comparisons_left_ < 0) reject("the search for pairs takes too many comparisons");
    if (places_.is_axis_between(a.box, b.box)) return;
    if (a.primitive != nullptr && b.primitive != nullptr) {
      take_(*a.primitive, *b.primitive);
    } else if (a.count >= b.count) {
      find_between(tree_[a.left], b);
      find_between(tree_[a.right], b);
    } else {
      find_between(a, other_[b.left]);
      find_between(a, other_[b.right]);
    }
  }

 private:
  const Places& places_;
  const Tree& tree_;
  const Tree& other_;
  std::int64_t& comparisons_left_;
  const TakePair& take_;
};

}  // namespace

void Box::include(const Box& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = std::min(lower[k], other.lower[k]);
    upper[k] = std::max(upper[k], other.upper[k]);
  }
}

void MovingBox::include(const MovingBox& other) {
  start.include(other.start);
  end.include(other.end);
}

Places::Places(const std::vector<Motion>& vertices, double distance, const mpq_class& end,
               const Thickness& thickness)
    : vertices_(vertices.size()),
      shift_(bits_of_lengths - exponent_of_scene(vertices, std::max(distance, thickness.greatest))),
      distance_(enlarged(distance)) {
  const int shift = shift_;
  for (const double reach : thickness.reaches) reaches_.push_back(enlarged(reach) + 1);
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    MovingBox& box = vertices_[n];
    for (std::size_t k = 0; k < 3; ++k) {
      const mpq_class at_start = vertices[n].start[k];
      const mpq_class at_end = at_start + end * (vertices[n].end[k] - at_start);
      box.start.lower[k] = rounded_down(at_start, shift);
      box.start.upper[k] = rounded_up(at_start, shift);
      box.end.lower[k] = rounded_down(at_end, shift);
      box.end.upper[k] = rounded_up(at_end, shift);
    }
  }
}

std::int64_t Places::enlarged(double distance) const { return rounded_up(distance, shift_); }

bool Places::is_above(const Primitive& a, const Primitive& b, const Direction& d,
                      std::int64_t distance) const {
  // No product exceeds 2^60, and no side of the comparisons below reaches 2^63.
  const std::int64_t reach = distance * (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]));
  for (const std::int32_t v : a.vertices) {
    for (const std::int32_t w : b.vertices) {
      const MovingBox& above = vertices_[static_cast<std::size_t>(v)];
      const MovingBox& below = vertices_[static_cast<std::size_t>(w)];
      if (least(d, above.start) <= greatest(d, below.start) + reach) return false;
      if (least(d, above.end) <= greatest(d, below.end) + reach) return false;
    }
  }
  return true;
}

bool Places::is_axis_between(const Primitive& a, const Primitive& b, std::int64_t distance) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Direction d{};
    d[axis] = 1;
    if (is_above(a, b, d, distance) || is_above(b, a, d, distance)) return true;
  }
  return false;
}

MovingBox Places::box_of(const Primitive& primitive) const {
  MovingBox box = vertices_[static_cast<std::size_t>(primitive.vertices[0])];
  std::int64_t reach = 0;
  for (const std::int32_t vertex : primitive.vertices) {
    box.include(vertices_[static_cast<std::size_t>(vertex)]);
    if (!reaches_.empty()) reach = std::max(reach, reaches_[static_cast<std::size_t>(vertex)]);
  }
  for (Box* const place : {&box.start, &box.end}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place->lower[axis] -= reach;
      place->upper[axis] += reach;
    }
  }
  return box;
}

void Places::find_near(const Primitives& some, const Primitives& others,
                       std::int64_t& comparisons_left, const TakePair& take) const {
  const auto tree_of = [&](const Primitives& primitives) {
    std::vector<Node> leaves;
    leaves.reserve(primitives.size());
    for (const Primitive& primitive : primitives) leaves.push_back({box_of(primitive), &primitive});
    Tree tree;
    tree.reserve(2 * leaves.size());
    add_tree(tree, leaves.begin(), leaves.end());
    return tree;
  };
  if (some.empty() || others.empty()) return;
  const Tree tree = tree_of(some);
  if (&some != &others) {
    const Tree other = tree_of(others);
    Search(*this, tree, other, comparisons_left, take).find_between(tree.back(), other.back());
    return;
  }
  const TakePair take_in_order = [&](const Primitive& a, const Primitive& b) {
    if (a.number < b.number) {
      take(a, b);
    } else {
      take(b, a);
    }
  };
  Search(*this, tree, tree, comparisons_left, take_in_order).find_within(tree.back());
}

}  // namespace touchstone::checker
