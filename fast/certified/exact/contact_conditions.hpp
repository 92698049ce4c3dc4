#pragma once

/// \file
/// Conditions under which a moving polygon contains the origin, as signs of polynomials in
/// time; for any integer type, and for coordinates of any degree.
///
/// F = r − u p − v q, where for vertex_face r = v − f0, p = f1 − f0, q = f2 − f0 and Ω is the
/// triangle u, v ≥ 0, u + v ≤ 1; for edge_edge r = ea0 − eb0, p = ea0 − ea1, q = eb1 − eb0 and Ω is
/// the unit square. r, p and q move linearly, or on curves: no proof uses a degree. Contact at time
/// t: some (u,v) ∈ Ω has r = u p + v q. Let N = p × q, U = r × q, V = p × r and D = r · N.
///
/// **Theorem 1** (a fixed time). Let `bounds` be U, V and N−U−V (triangle), or U, V, N−U and N−V
/// (square).
///   - N ≠ 0, say N_k ≠ 0: contact iff D = 0 and every bound's component k is 0 or has N_k's sign.
///   - N = 0: contact iff U = V = 0 and w_i · w_j ≤ 0 for the two ends of some side of the polygon
///     with the corners w, the last side left out.
/// Proof. If r = u p + v q then D = 0, U = u N and V = v N; so with N ≠ 0 there is at most one
/// (u,v), it is U_k/N_k, V_k/N_k, and the bounds say that it lies in Ω. Conversely D = 0 with N ≠ 0
/// puts r into the plane of p and q. If N = 0, then r = u p + v q implies U = V = 0. N = U = V = 0
/// means that r, p and q, and hence the corners, lie on one line through the origin. These sides
/// are a path on that line through all corners and cover the segment between the outermost ones,
/// hence the polygon; and a side on a line through the origin contains it iff the product of its
/// ends is not positive. ∎
///
/// **Theorem 2** (the first contact). The first time of contact in [0,1], if it exists, is 0 or a
/// root of one of the `events`:
///   - D ≢ 0: D.
///   - D ≡ 0, N_k ≢ 0: N_k and the components k of the bounds.
///   - D ≡ 0, N ≡ 0, a component of U or V ≢ 0: that component.
///   - D ≡ N ≡ U ≡ V ≡ 0: w_i · w_j for every side but the last.
/// (Events that are identically zero are left out.) Proof. In the first and third case every
/// contact is at a root of the event, by theorem 1 (N = 0 implies D = 0). In the others no sign in
/// theorem 1 changes between neighbouring roots of the events, so the answer is the same at all
/// times strictly between them. The set of times of contact is closed, so if it contains such an
/// interval, it contains its lower end. ∎
///
/// Times are pairs (x,y) with t = y/(x+y), and polynomials of degree n are forms Σ c_k x^(n−k) y^k:
/// a point that moves from a to b is the form (a,b), a product is a convolution, and the signs of
/// c_k bound the number of roots in [0,1] (Descartes: as many positive roots y/x as sign changes,
/// or fewer by an even number).

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// Σ c_k x^(degree−k) y^k.
template <class Number, std::size_t degree>
using Form = std::array<Number, degree + 1>;

/// The coordinates of a moving vector, a form for each axis.
template <class Number>
using MovingVector = std::array<Form<Number, 1>, 3>;

template <class Number>
using Square = decltype(Number() * Number());
template <class Number>
using Cube = decltype(Square<Number>() * Number());

/// r, p and q, whose coordinates are forms of one degree. For numbers of fixed size the greatest
/// coordinate must be at most a quarter of the type's maximum; then all values below fit into
/// Square and Cube. (With coordinates up to 2^b, two products add up to 2^(2b+1), a coefficient of
/// N, U, V or a bound to 2^(2b+2), of a product of corners to 6·2^2b, and one of D, three
/// determinants of vectors of length up to √3·2^b, to 16·2^3b.)
template <class Linear>
struct MotionOf {
  ContactKind kind = ContactKind::vertex_face;
  std::array<Linear, 3> r, p, q;
  /// The exponent of the unit of each axis; only guesses use it.
  std::array<int, 3> unit{};
};
/// The motion on straight lines.
template <class Number>
using Motion = MotionOf<Form<Number, 1>>;

template <class AnyForm>
[[nodiscard]] bool is_zero(const AnyForm& form) {
  return std::ranges::all_of(form, [](const auto& c) { return c.sign() == 0; });
}

// Sums and differences of forms and of vectors of forms.
template <class Part, std::size_t size>
std::array<Part, size>& operator+=(std::array<Part, size>& a, const std::array<Part, size>& b) {
  for (std::size_t k = 0; k < size; ++k) a[k] += b[k];
  return a;
}
template <class Part, std::size_t size>
std::array<Part, size>& operator-=(std::array<Part, size>& a, const std::array<Part, size>& b) {
  for (std::size_t k = 0; k < size; ++k) a[k] -= b[k];
  return a;
}
template <class Part, std::size_t size>
[[nodiscard]] std::array<Part, size> operator-(std::array<Part, size> a,
                                               const std::array<Part, size>& b) {
  return a -= b;
}

template <class A, std::size_t a_size, class B, std::size_t b_size>
[[nodiscard]] auto operator*(const std::array<A, a_size>& a, const std::array<B, b_size>& b) {
  std::array<decltype(A() * B()), a_size + b_size - 1> product;
  for (std::size_t k = 0; k < product.size(); ++k) {
    std::size_t i = k < b_size ? 0 : k - b_size + 1;
    product[k] = a[i] * b[k - i];
    while (++i < a_size && i <= k) product[k] += a[i] * b[k - i];
  }
  return product;
}

/// The form of a product of two coordinates.
template <class Linear>
using Quadratic = decltype(Linear() * Linear());

/// The sign pattern of a form's coefficients on an interval.
struct IntervalSigns {
  int changes = 0;  ///< sign changes, without zeros
  int first = 0;    ///< the sign next to the lower end; 0 if all are 0
  int last = 0;     ///< the sign next to the upper end
};

[[nodiscard]] inline IntervalSigns interval_signs(std::span<const int> coefficients) {
  IntervalSigns result;
  for (const int sign : coefficients) {
    if (sign == 0) continue;
    if (result.first == 0) result.first = sign;
    if (sign == -result.last) ++result.changes;
    result.last = sign;
  }
  return result;
}

/// Component k of a × b.
template <class Linear>
[[nodiscard]] Quadratic<Linear> cross(const std::array<Linear, 3>& a,
                                      const std::array<Linear, 3>& b, std::size_t k) {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  return a[i] * b[j] - a[j] * b[i];
}

/// a · b, of vectors of any forms.
template <class A, class B>
[[nodiscard]] auto dot(const std::array<A, 3>& a, const std::array<B, 3>& b) {
  auto sum = a[0] * b[0];
  sum += a[1] * b[1];
  sum += a[2] * b[2];
  return sum;
}

template <class Number>
using MovingNormal = std::array<Form<Square<Number>, 2>, 3>;

/// N.
template <class Linear>
[[nodiscard]] std::array<Quadratic<Linear>, 3> normal(const MotionOf<Linear>& motion) {
  return {cross(motion.p, motion.q, 0), cross(motion.p, motion.q, 1), cross(motion.p, motion.q, 2)};
}

/// D.
template <class Linear>
[[nodiscard]] auto determinant(const MotionOf<Linear>& motion,
                               const std::array<Quadratic<Linear>, 3>& normal) {
  return dot(normal, motion.r);
}

/// Component k of N and of its bounds, which begin with U and V.
template <class AnyForm>
struct Bounds {
  AnyForm n;
  std::array<AnyForm, 4> bound;
  std::size_t count = 0;  ///< of bounds
};

/// Theorem 1 at a time with D = 0 and n ≠ 0, where n is this component of N: true if every bound
/// has the sign of n or is 0. `sign_of` gives the sign of a form at that time.
template <class AnyForm, class SignOf>
[[nodiscard]] bool is_in_bounds(const Bounds<AnyForm>& in, int sign_of_n, SignOf&& sign_of) {
  for (std::size_t i = 0; i < in.count; ++i) {
    if (sign_of(in.bound[i]) * sign_of_n < 0) return false;
  }
  return true;
}

template <class Linear>
[[nodiscard]] Bounds<Quadratic<Linear>> bounds(const MotionOf<Linear>& motion,
                                               const Quadratic<Linear>& n, std::size_t k) {
  const auto u = cross(motion.r, motion.q, k), v = cross(motion.p, motion.r, k);
  if (motion.kind == ContactKind::vertex_face) {
    return {n, {u, v, n - u - v, {}}, 3};
  }
  return {n, {u, v, n - u, n - v}, 4};
}

/// A corner of the polygon.
template <class Linear>
struct MovingCorner {
  std::array<Linear, 3> w;
  bool u = false, v = false;  ///< its parameters, 0 or 1
};

/// The corners in cyclic order.
template <class Linear>
[[nodiscard]] std::vector<MovingCorner<Linear>> moving_corners(const MotionOf<Linear>& motion) {
  const auto u_corner = motion.r - motion.p, v_corner = motion.r - motion.q;
  std::vector<MovingCorner<Linear>> result{{motion.r, false, false}, {u_corner, true, false}};
  if (motion.kind == ContactKind::edge_edge) {
    result.push_back({u_corner - motion.q, true, true});
  }
  result.push_back({v_corner, false, true});
  return result;
}

/// (u,v) = (u/denominator, v/denominator); (0,0) if the denominator is 0.
template <class AnyForm>
struct ContactForms {
  AnyForm u, v, denominator;
};
/// The parameters of a motion.
template <class Linear>
using ContactOf = ContactForms<Quadratic<Linear>>;

/// (u,v) of the origin on the side from a to b, which is on a line through it: the origin divides
/// the side in the ratio w_a·(w_a − w_b) to w_b·(w_b − w_a).
template <class Linear>
[[nodiscard]] ContactOf<Linear> contact_on_side(const MovingCorner<Linear>& a,
                                                const MovingCorner<Linear>& b) {
  const auto side = b.w - a.w;
  const auto weight_a = dot(b.w, side), weight_b = dot(a.w - b.w, a.w), sum = dot(side, side);
  const auto weighted = [&](bool at_a, bool at_b) {
    if (at_a == at_b) return at_a ? sum : sum - sum;
    return at_a ? weight_a : weight_b;
  };
  return {weighted(a.u, b.u), weighted(a.v, b.v), sum};
}

/// Theorem 1 for N = 0.
template <class Linear, class SignOf>
[[nodiscard]] std::optional<ContactOf<Linear>> contact_on_line(const MotionOf<Linear>& motion,
                                                               SignOf&& sign_of) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (sign_of(cross(motion.r, motion.q, k)) != 0) return std::nullopt;
    if (sign_of(cross(motion.p, motion.r, k)) != 0) return std::nullopt;
  }
  const auto corner = moving_corners(motion);
  // A side of length 0 can be the first that contains the origin only if it is the first side, from
  // (0,0): if both ends of another side are 0, the side before it ends there.
  for (std::size_t i = 0; i + 1 < corner.size(); ++i) {
    const auto &a = corner[i], &b = corner[i + 1];
    if (sign_of(dot(a.w, b.w)) <= 0) return contact_on_side(a, b);
  }
  return std::nullopt;
}

/// Theorem 1 at a time with D = 0. `sign_of` gives the sign of a quadratic form at that time.
template <class Linear, class SignOf>
[[nodiscard]] std::optional<ContactOf<Linear>> contact_in_plane(
    const MotionOf<Linear>& motion, const std::array<Quadratic<Linear>, 3>& normal,
    SignOf&& sign_of) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int orientation = sign_of(normal[k]);
    if (orientation == 0) continue;
    const auto in = bounds(motion, normal[k], k);
    if (!is_in_bounds(in, orientation, sign_of)) return std::nullopt;
    return ContactOf<Linear>{in.bound[0], in.bound[1], in.n};
  }
  return contact_on_line(motion, sign_of);
}

/// The events of theorem 2 for D ≡ 0.
template <class Linear>
[[nodiscard]] std::vector<Quadratic<Linear>> events_in_plane(
    const MotionOf<Linear>& motion, const std::array<Quadratic<Linear>, 3>& normal) {
  std::vector<Quadratic<Linear>> events;
  const auto add = [&](const Quadratic<Linear>& form) {
    if (!is_zero(form)) events.push_back(form);
    return !events.empty();
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (!add(normal[k])) continue;
    const auto in = bounds(motion, normal[k], k);
    for (std::size_t i = 0; i < in.count; ++i) add(in.bound[i]);
    return events;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (add(cross(motion.r, motion.q, k)) || add(cross(motion.p, motion.r, k))) return events;
  }
  const auto corner = moving_corners(motion);
  for (std::size_t i = 0; i + 1 < corner.size(); ++i) {
    add(dot(corner[i].w, corner[i + 1].w));
  }
  return events;
}

}  // namespace touchstone::fast::exact_stage
