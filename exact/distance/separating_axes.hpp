#pragma once

/// \file
/// Directions that separate a polygon from a ball, and the times at which they do.
///
/// P(t) = conv{w_i(t)} is the polygon of corners, d the distance of the query. A direction a
/// separates P from the ball of radius d strictly iff a·w_k > d‖a‖* for every corner k, ‖·‖* the
/// dual norm: |a| for l2, |a_x| + |a_y| + |a_z| for linf. While the distance is above d, one of
/// finitely many directions separates. Each is polynomial in t and named by a *feature*:
///
///   - l2: the nearest point x of P lies inside a vertex, an edge or the face, whose direction is
///     parallel to x, and x·w_k ≥ |x|² > d|x|. The directions are
///
///         vertex i:    w_i
///         edge i, j:   |e|² w_i − (w_i·e) e,  e = w_j − w_i   (|e|² times the point of its line
///                                                               nearest to the origin)
///         face:        ±N,  N = (w_1 − w_0) × (w_2 − w_0)
///
///     Each edge of the polygon is a side of it: if the polygon has no area, its sides cover it, so
///     the diagonals of an edge-edge query are not needed.
///   - linf: P misses the cube [−d,d]³ iff 0 is not in cube ⊕ −P. For d > 0 that is a polytope with
///     volume, so the normal of one of its facets separates 0 from it strictly. A facet is the sum
///     of the extreme faces of the two summands in its direction: a side of the cube and any face
///     of P, P itself and any face of the cube, or an edge of each. The normals are
///
///         axis k:        ±e_k
///         face:          ±N
///         cross k, i, j: e_k × (w_j − w_i),  i and j neighbours
///
///     This also holds if P is a segment or a point: its sides are then all its edges. For d = 0
///     the distance is still above some d' > 0, and the direction for d' serves.
///
/// A feature holds iff all of these integer polynomials are positive:
///   - l2: a·w_k and (a·w_k)² − d²|a|². For k = i of vertex i these say |w_i|² − d² > 0; for k = i,
///     j of edge i, j, where a·w_k = V = |e|²|w_i|² − (w_i·e)² and |a|² = |e|² V, V − d²|e|² > 0.
///     The second of a pair stops being positive first: where a·w_k reaches 0 it is not positive.
///     So the first is a *guard*: it must be evaluated at the beginning of an interval, but its
///     roots are never needed.
///   - linf: a·w_k − d(σ·a) for every vector σ of signs.
///
/// Hence the times at which P is farther than d are a finite union of open sets. **The search**:
/// from t = 0, while some feature holds at t, go to the end of the one that holds longest. Every
/// step goes to a later root of finitely many polynomials, so the search terminates: at the first
/// time of contact, or with a feature that holds up to t = 1.

#include <cstddef>
#include <optional>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/number.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::exact {

/// A feature that holds at some times, with its polynomials. Forms with positive coefficients only
/// are left out, because they are positive throughout.
class Separator {
 public:
  /// A form that must be positive.
  struct Condition {
    std::vector<Integer> form;
    bool is_guard = false;
  };

  Separator(const Feature& feature, std::vector<Condition> conditions);

  [[nodiscard]] const Feature& feature() const { return feature_; }

  /// True if all of its polynomials are positive by their coefficients.
  [[nodiscard]] bool is_trivial() const { return values_.empty(); }

  [[nodiscard]] std::size_t size() const { return values_.size(); }
  /// Coefficients of a form that must be positive (exact/contact/corner_motion.hpp).
  [[nodiscard]] const std::vector<Integer>& form(std::size_t n) const {
    return values_[n].condition.form;
  }
  /// The same as a polynomial.
  const Polynomial& polynomial(std::size_t n);

  /// True if the feature holds at this time.
  bool holds_at(AlgebraicNumber& t);

  /// The end of the open interval on which it holds from t on: the first root after t, if there is
  /// one.
  /// \pre holds_at(t)
  struct End {
    std::optional<AlgebraicNumber> root;
    /// True if the end is not after the given bound. `root` may then be missing or a later one.
    bool is_within_bound = false;
  };
  /// \param bound A time after t, or empty. An end that is not after it need not be found.
  End end_after(AlgebraicNumber& t, std::optional<AlgebraicNumber>& bound);

  /// The beginning of that interval: the last root before t, if there is one.
  /// \pre holds_at(t)
  std::optional<AlgebraicNumber> begin_before(AlgebraicNumber& t);

 private:
  struct Value {
    Condition condition;
    std::optional<Polynomial> polynomial;
    std::optional<std::vector<AlgebraicNumber>> roots;
  };
  /// The roots of a form; empty for a guard.
  std::vector<AlgebraicNumber>& roots(std::size_t n);
  bool is_over_before(const AlgebraicNumber& t, const AlgebraicNumber& bound);

  Feature feature_;
  std::vector<Value> values_;
};

/// All separators of the motion's distance and norm that may hold at some time, the cheaper ones
/// first; or a single one that is trivial.
template <class Order>
[[nodiscard]] std::vector<Separator> separators(const MotionOf<Order>& motion);

/// A separator that holds at a time, and the end of its interval.
struct Span {
  Separator* separator = nullptr;
  std::optional<AlgebraicNumber> end;
};

/// The separator that holds longest among those that hold at a time, the first if there are
/// several; empty if none holds.
[[nodiscard]] std::optional<Span> farthest(std::vector<Separator>& separators, AlgebraicNumber t);

/// The first time in [0,1] at which no direction separates, by the search above; empty if some
/// direction separates at every time.
/// \pre the motion is scaled uniformly.
template <class Order>
[[nodiscard]] std::optional<AlgebraicNumber> end_of_separation(const MotionOf<Order>& motion);

}  // namespace touchstone::exact
