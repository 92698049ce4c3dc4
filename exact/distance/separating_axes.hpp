#pragma once

/// \file
/// Directions that keep a polygon away from a ball, and the times at which they do.
///
/// P(t) = conv{w_i(t)} is the polygon of corners, d the distance that counts as contact. A direction
/// a separates P from the ball of radius d strictly iff a·w_k > d‖a‖* for every corner k, ‖·‖* the
/// dual norm: |a| for l2, |a_x| + |a_y| + |a_z| for linf. While the distance is above d, one of
/// finitely many does, each polynomial in t and named by a *feature*:
///
///   - l2: the nearest point x of P lies inside a vertex, an edge or the face, whose direction is
///     parallel to x, and x·w_k ≥ |x|² > d|x|. The directions are
///
///         vertex i:    w_i
///         edge i, j:   |e|² w_i − (w_i·e) e,  e = w_j − w_i   (|e|² times the point of its line
///                                                               nearest to the origin)
///         face:        ±N,  N = (w_1 − w_0) × (w_2 − w_0)
///
///     Each edge of the polygon is a side of it: where the polygon has no area, its sides cover it,
///     so the diagonals of an edge-edge query are not needed.
///   - linf: P misses the cube [−d,d]³ iff 0 is not in cube ⊕ −P. For d > 0 that is a polytope with
///     volume, so the normal of one of its facets separates 0 from it strictly. A facet is the sum of
///     the faces of both that are extreme in its direction: a side of the cube and anything, P itself
///     and anything, or an edge of each. The normals are
///
///         axis k:        ±e_k
///         face:          ±N
///         cross k, i, j: e_k × (w_j − w_i),  i and j neighbours
///
///     This holds for P a segment or a point too: its sides then are all its edges. For d = 0 the
///     distance is still above some d' > 0, and the direction for d' serves.
///
/// In integer polynomials, all of which have to be positive for a feature to hold:
///   - l2: a·w_k and (a·w_k)² − d²|a|². For k = i of vertex i these say |w_i|² − d² > 0; for k = i, j
///     of edge i, j, where a·w_k = V = |e|²|w_i|² − (w_i·e)² and |a|² = |e|² V, V − d²|e|² > 0. In
///     time the second of a pair ends first: where a·w_k gets to 0 it is not positive. So the first is
///     a *guard*, which has to be asked where a walk begins, but whose roots are never needed.
///   - linf: a·w_k − d(σ·a) for every vector σ of signs.
///
/// So the times at which P is farther than d are a finite union of open sets. **The walk**: from
/// t = 0, while some feature holds at t, go to where the one that does so longest ends. Every step
/// goes to a later root of finitely many polynomials, so it ends: at the first time of contact or
/// with a feature that holds to the end of time.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/algebra/number.hpp"
#include "exact/algebra/polynomial.hpp"
#include "exact/contact/corner_motion.hpp"

namespace touchstone::exact {

/// The name of a direction as above.
struct Feature {
  enum class Sort : std::uint8_t {
    vertex,
    edge,
    positive_face,
    negative_face,
    positive_axis,
    negative_axis,
    cross
  };

  Sort sort = Sort::vertex;
  std::size_t i = 0;     ///< corner, of a vertex, edge or cross
  std::size_t j = 0;     ///< corner, of an edge or cross
  std::size_t axis = 0;  ///< of an axis or cross

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// A feature that holds at some times, with those of its polynomials that are not positive
/// throughout by the signs of their forms' coefficients.
class Separator {
 public:
  /// A form that is to be positive.
  struct Condition {
    std::vector<Integer> form;
    bool is_guard = false;
  };

  Separator(const Feature& feature, std::vector<Condition> conditions);

  [[nodiscard]] const Feature& feature() const { return feature_; }

  /// Does it hold at all times by those signs?
  [[nodiscard]] bool is_trivial() const { return values_.empty(); }

  [[nodiscard]] std::size_t size() const { return values_.size(); }
  /// Coefficients of a form that is to be positive (exact/contact/corner_motion.hpp).
  [[nodiscard]] const std::vector<Integer>& form(std::size_t n) const {
    return values_[n].condition.form;
  }
  /// The same as a polynomial.
  const Polynomial& polynomial(std::size_t n);

  /// Does it hold at this time?
  bool holds_at(AlgebraicNumber& t);

  /// Up to where it holds from t on, excluded: the first root after t, none if there is no such.
  /// \pre holds_at(t)
  struct End {
    std::optional<AlgebraicNumber> root;
    /// Is it not after the bound that was given? Then `root` may be missing or a later one.
    bool is_within_bound = false;
  };
  /// \param bound If one is given, which is after t, ends that are not after it need not be found.
  End end_after(AlgebraicNumber& t, std::optional<AlgebraicNumber>& bound);

  /// The last root before t, none if there is no such: from where on it holds, excluded.
  /// \pre holds_at(t)
  std::optional<AlgebraicNumber> begin_before(AlgebraicNumber& t);

 private:
  struct Value {
    Condition condition;
    std::optional<Polynomial> polynomial;
    std::optional<std::vector<AlgebraicNumber>> roots;
  };
  /// None of a guard.
  std::vector<AlgebraicNumber>& roots(std::size_t n);
  bool is_over_before(const AlgebraicNumber& t, const AlgebraicNumber& bound);

  Feature feature_;
  std::vector<Value> values_;
};

/// All separators of the motion's distance and norm that may hold at some time, the cheaper ones
/// first; or a single one that is trivial.
[[nodiscard]] std::vector<Separator> separators(const Motion& motion);

/// A separator that holds at a time, and up to where it does.
struct Span {
  Separator* separator = nullptr;
  std::optional<AlgebraicNumber> end;
};

/// Of the separators that hold at a time the one that does so longest, the first of several; none if
/// none holds.
[[nodiscard]] std::optional<Span> farthest(std::vector<Separator>& separators, AlgebraicNumber t);

/// The first time in [0,1] at which the polygon is within the motion's distance, by the walk.
/// \pre the motion is scaled uniformly.
[[nodiscard]] std::optional<AlgebraicNumber> first_contact(const Motion& motion);

}  // namespace touchstone::exact
