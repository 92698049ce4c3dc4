#pragma once

/// \file
/// The places of a step's vertices in integers, and directions that keep two primitives apart.
///
/// Space is enlarged by the power of two that brings all coordinates and distances D just below
/// 2^50. A coordinate at the start and at the end of an interval of time is then enclosed by
/// integers, and D is rounded up. Their sums and products are exact in 64 bits.
///
/// **Theorem.** Let d be a vector of integers. If d·a > d·b + D‖d‖₁ for all vertices a of one
/// primitive and b of the other, at the start and at the end, then there is no contact on the way:
/// for one sign every ±d·w_i is above D‖d‖₁ ≥ D‖d‖* (checker.hpp) at both ends, and linear in
/// between.
///
/// A coordinate axis keeps two primitives apart if that holds for ± its unit vector. The boxes
/// around their vertices show it, at the start and at the end.
///
/// **Theorem.** Every pair of primitives that no axis keeps apart is found. The boxes of the
/// primitives are the leaves of a tree, and every other node has two halves and the box around all
/// leaves below it. An axis that keeps the boxes of two nodes apart keeps every primitive below the
/// one apart from every primitive below the other. All other pairs of nodes are followed down to
/// the pairs of primitives.
///
/// *Thickness*: the D of two primitives may be more than that of the scene. Then vertices have
/// reaches ρ, and D ≤ (1 + 2^-50) (the scene's + ρ + σ) for some vertices of the two with the
/// reaches ρ and σ. The box of a primitive is enlarged by the greatest ρ of its vertices, rounded
/// up, and by 1: twice 1 is not less than the enlarged 2^-50 D and the rounding of D. So every pair
/// that no axis keeps apart by its D is found, and some others may be.

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace touchstone::checker {

/// A direction's components are below this.
inline constexpr std::int32_t max_direction = 1'024;

/// A vertex of the scene: x y z at t=0 and at t=1.
struct Motion {
  std::array<double, 3> start{};
  std::array<double, 3> end{};

  friend bool operator==(const Motion&, const Motion&) = default;
};

/// A vertex, an edge or a face of the scene.
struct Primitive {
  std::int32_t number = 0;
  /// The numbers of its vertices: a b c of a face, a b a of an edge, v v v of a vertex.
  std::array<std::int32_t, 3> vertices{};
};

/// Primitives in the order of their numbers.
using Primitives = std::vector<Primitive>;

/// The numbers x y z.
using Integers = std::array<std::int64_t, 3>;
using Direction = Integers;

struct Box {
  Integers lower{};
  Integers upper{};

  /// Grows to contain the other box.
  void include(const Box& other);
};

/// The boxes at the start and at the end of a motion.
struct MovingBox {
  Box start;
  Box end;

  void include(const MovingBox& other);
};

using TakePair = std::function<void(const Primitive&, const Primitive&)>;

/// How much more than the scene's D the distances of pairs are.
struct Thickness {
  /// The greatest of all pairs' D.
  double greatest = 0.0;
  /// Of each vertex; empty if there is no thickness.
  std::vector<double> reaches = {};
};

class Places {
 public:
  /// Encloses the vertices up to t=end. \pre finite coordinates and D; D ≥ 0, 0 ≤ end ≤ 1
  Places(const std::vector<Motion>& vertices, double distance, const mpq_class& end,
         const Thickness& thickness = {});

  /// Space is enlarged by 2^shift.
  [[nodiscard]] int shift() const { return shift_; }
  [[nodiscard]] const MovingBox& box(std::int32_t vertex) const {
    return vertices_[static_cast<std::size_t>(vertex)];
  }
  /// The distance of a pair, enlarged and rounded up.
  [[nodiscard]] std::int64_t enlarged(double distance) const;

  /// True if the direction keeps a above b by that distance at all times.
  [[nodiscard]] bool is_above(const Primitive& a, const Primitive& b, const Direction& d,
                              std::int64_t distance) const;
  /// True if a coordinate axis keeps them apart by that distance.
  [[nodiscard]] bool is_axis_between(const Primitive& a, const Primitive& b,
                                     std::int64_t distance) const;

  /// Calls take(a, b) for every a of `some` and b of `others` that no coordinate axis keeps apart
  /// by their distance, and with thickness possibly for more; if both are the same list, for every
  /// two of it, the smaller number first.
  /// \param comparisons_left the remaining comparisons of boxes
  /// \throws Rejection if they do not suffice.
  void find_near(const Primitives& some, const Primitives& others, std::int64_t& comparisons_left,
                 const TakePair& take) const;

  /// True if the boxes are more than D apart on an axis at both ends, in the same order.
  [[nodiscard]] bool is_axis_between(const MovingBox& a, const MovingBox& b) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_below(a, b, axis) || is_below(b, a, axis)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] MovingBox box_of(const Primitive& primitive) const;
  [[nodiscard]] bool is_below(const MovingBox& a, const MovingBox& b, std::size_t axis) const {
    return a.start.upper[axis] + distance_ < b.start.lower[axis] &&
           a.end.upper[axis] + distance_ < b.end.lower[axis];
  }

  /// The boxes of each vertex.
  std::vector<MovingBox> vertices_;
  /// Of each vertex, enlarged; empty without thickness.
  std::vector<std::int64_t> reaches_;
  int shift_;
  /// The scene's D.
  std::int64_t distance_;
};

}  // namespace touchstone::checker
