#pragma once

/// \file
/// Where the vertices of a step are, in integers, and which primitives no axis keeps apart.
///
/// Space is enlarged by the power of two that brings all coordinates and the distance D just below
/// 2^50. A coordinate at the start and at the end of a stretch of time is then enclosed by
/// integers, as is D. Their sums and products below are exact.
///
/// **Theorem.** Let d be a vector of integers. If d·a > d·b + D‖d‖₁ for all vertices a of one
/// primitive and b of the other, at the start and at the end, then there is no contact on the way:
/// for one sign every ±d·w_i is above D‖d‖₁ ≥ D‖d‖* (checker.hpp) at both ends, and linear in
/// between.
///
/// **Which pairs are met.** The boxes of the primitives at both ends are the leaves of a tree, and
/// every node has the box around its leaves. An axis that keeps the boxes of two nodes apart keeps
/// every primitive below the one apart from every primitive below the other. All other pairs of
/// nodes are followed down to the pairs of primitives.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <vector>

#include "exact/checker/certificate.hpp"

namespace touchstone::checker {

/// A direction's components are below this.
inline constexpr std::int32_t max_direction = 1'024;

/// x y z at t=0, then at t=1.
using Motion = std::array<double, 6>;
/// The numbers of its vertices: a b c of a face, a b a of an edge, v v v of a vertex.
using Primitive = std::array<std::int32_t, 3>;
using Direction = std::array<std::int64_t, 3>;

/// Primitives by their numbers.
using Elements = std::map<std::int32_t, Primitive>;
using Element = Elements::value_type;

class Places {
 public:
  /// On the way from t=0 to t=end. \pre finite coordinates and D; D ≥ 0, 0 ≤ end ≤ 1
  Places(const std::vector<Motion>& vertices, double distance, const mpq_class& end) {
    double greatest = distance;
    for (const Motion& x : vertices) {
      for (const double c : x) greatest = std::max(greatest, std::abs(c));
    }
    int exponent = 0;  // greatest < 2^exponent
    std::frexp(greatest, &exponent);
    const auto enlarged = [shift = 50 - exponent](mpq_class x) {
      shift < 0 ? x >>= mp_bitcnt_t(-shift) : x <<= mp_bitcnt_t(shift);
      mpz_class result;
      mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
      return result.get_si();
    };
    distance_ = -enlarged(-mpq_class(distance));
    for (const Motion& x : vertices) {
      Bounds& bounds = bounds_.emplace_back();
      for (std::size_t k = 0; k < 6; ++k) {
        const mpq_class start = x.at(k % 3), c = k < 3 ? start : start + end * (x.at(k) - start);
        bounds.lower[k] = enlarged(c);
        bounds.upper[k] = -enlarged(-c);
      }
    }
  }

  /// Does the direction keep a above b all the time?
  [[nodiscard]] bool is_above(const Primitive& a, const Primitive& b, const Direction& d) const {
    // No product exceeds 2^60, and no side of the comparison below reaches 2^63.
    const std::int64_t reach = distance_ * (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]));
    // The least d·x at a time, 0 or 1; or −d·x.
    const auto least = [&](std::int32_t vertex, std::int64_t sign, std::size_t time) {
      const Bounds& x = bounds_[std::size_t(vertex)];
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += sign * d[k] * (sign * d[k] < 0 ? x.upper : x.lower)[3 * time + k];
      }
      return sum;
    };
    for (std::size_t n = 0; n < 18; ++n) {
      const std::int64_t above = least(a[n % 3], 1, n / 9), below = least(b[n / 3 % 3], -1, n / 9);
      if (above <= reach - below) return false;
    }
    return true;
  }

  /// Calls take(a, b) for every a of `some` and b of `others` that no coordinate axis keeps apart;
  /// if both are the same list, for every two of it, the smaller number first.
  /// \param comparisons_left how often boxes may still be compared
  /// \throws Rejection if that is not often enough.
  template <class Take>
  void find_near(const Elements& some, const Elements& others, std::int64_t& comparisons_left,
                 const Take& take) const {
    const bool is_same = &some == &others;
    const Tree first = tree_of(some);
    const Tree second = is_same ? Tree() : tree_of(others);
    const Tree& other = is_same ? first : second;
    if (first.empty() || other.empty()) return;
    std::vector<std::array<std::size_t, 2>> waiting{{first.size() - 1, other.size() - 1}};
    while (!waiting.empty()) {
      const auto [i, j] = waiting.back();
      waiting.pop_back();
      const Node &a = first[i], &b = other[j];
      const bool is_itself = is_same && i == j;
      if (--comparisons_left < 0) reject("the search for pairs takes too many comparisons");
      if (!is_itself && is_axis_between(a, b)) continue;
      if (a.element != nullptr && b.element != nullptr) {
        const bool is_first = !is_same || a.element->first < b.element->first;
        if (!is_itself) take(*(is_first ? a : b).element, *(is_first ? b : a).element);
      } else if (is_itself) {
        waiting.push_back({a.left, a.left});
        waiting.push_back({a.left, a.right});
        waiting.push_back({a.right, a.right});
      } else if (b.element != nullptr || (a.element == nullptr && a.count >= b.count)) {
        waiting.push_back({a.left, j});
        waiting.push_back({a.right, j});
      } else {
        waiting.push_back({i, b.left});
        waiting.push_back({i, b.right});
      }
    }
  }

 private:
  /// Of x y z at the start, then at the end.
  using Integers = std::array<std::int64_t, 6>;
  struct Bounds {
    Integers lower, upper;
  };
  /// A node of a tree: a leaf has an element, another node has two children, which stand before it.
  struct Node : Bounds {
    const Element* element = nullptr;
    std::size_t left = 0;
    std::size_t right = 0;
    std::size_t count = 1;  ///< of leaves
  };
  /// The last node is the root.
  using Tree = std::vector<Node>;

  [[nodiscard]] Node leaf_of(const Element& element) const {
    Node leaf{bounds_[std::size_t(element.second[0])], &element};
    for (const std::int32_t vertex : element.second) include(leaf, bounds_[std::size_t(vertex)]);
    return leaf;
  }

  static void include(Bounds& box, const Bounds& other) {
    for (std::size_t k = 0; k < 6; ++k) {
      box.lower[k] = std::min(box.lower[k], other.lower[k]);
      box.upper[k] = std::max(box.upper[k], other.upper[k]);
    }
  }

  [[nodiscard]] Tree tree_of(const Elements& elements) const {
    std::vector<Node> leaves;
    for (const Element& element : elements) leaves.push_back(leaf_of(element));
    Tree tree;
    tree.reserve(2 * leaves.size());
    if (!leaves.empty()) add_node(tree, leaves.begin(), leaves.end());
    return tree;
  }

  using Leaf = std::vector<Node>::iterator;

  /// Adds the tree of some leaves, which are divided in two halves along the axis and at the end
  /// where they spread most.
  static std::size_t add_node(Tree& tree, Leaf first, Leaf last) {
    Node node = *first;
    if (last - first > 1) {
      for (auto leaf = first; leaf != last; ++leaf) include(node, *leaf);
      std::size_t widest = 0;
      const auto spread = [&](std::size_t k) { return node.upper[k] - node.lower[k]; };
      for (std::size_t k = 1; k < 6; ++k) widest = spread(k) > spread(widest) ? k : widest;
      const auto middle = first + (last - first) / 2;
      const auto place = [&](const Node& leaf) { return leaf.lower[widest] + leaf.upper[widest]; };
      std::ranges::nth_element(first, middle, last, {}, place);
      node.element = nullptr;
      node.count = std::size_t(last - first);
      node.left = add_node(tree, first, middle);
      node.right = add_node(tree, middle, last);
    }
    tree.push_back(node);
    return tree.size() - 1;
  }

  /// Are the boxes more than D apart on an axis, at the start and at the end, in the same order?
  [[nodiscard]] bool is_axis_between(const Bounds& a, const Bounds& b) const {
    const auto is_below = [&](const Bounds& x, const Bounds& y, std::size_t k) {
      return x.upper[k] + distance_ < y.lower[k] && x.upper[k + 3] + distance_ < y.lower[k + 3];
    };
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_below(a, b, k) || is_below(b, a, k)) return true;
    }
    return false;
  }

  std::vector<Bounds> bounds_;
  std::int64_t distance_ = 0;
};

}  // namespace touchstone::checker
