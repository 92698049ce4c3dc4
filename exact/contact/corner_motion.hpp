#pragma once

/// \file
/// A query as integers, and the polynomials in time that decide it.
///
/// Each axis is multiplied by its own power of two that makes its eight coordinates integers: a
/// linear map of space with positive diagonal, which changes no root of F and keeps the (t,u,v) of
/// a contact. Where angles and distances matter, all axes have the same power of two.
///
/// A polynomial of degree n in time is held as a *form*, Σ c_k (1−t)^(n−k) t^k: a point that moves
/// from a to b is the form (a, b), products are convolutions, and the c_k are the polynomial's
/// Bernstein coefficients on [0,1] times binomials, so their signs bound the sign on all of [0,1].
/// A Bézier curve of degree k is a form of degree k: its control points times binomials.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/number.hpp"
#include "touchstone/polynomial.hpp"
#include "touchstone/query.hpp"

namespace touchstone::exact {

/// Σ c_k (1−t)^(degree−k) t^k.
template <std::size_t degree>
struct Form {
  std::array<Integer, degree + 1> c;

  [[nodiscard]] bool is_zero() const {
    return std::ranges::all_of(c, [](const Integer& x) { return sgn(x) == 0; });
  }
};

/// A form whose degree is known at run time. Without coefficients it is zero, of any degree.
struct CurvedForm {
  std::vector<Integer> c;

  [[nodiscard]] bool is_zero() const {
    return std::ranges::all_of(c, [](const Integer& x) { return sgn(x) == 0; });
  }
};

template <class F>
concept AnyForm = requires(F form) {
  { form.is_zero() } -> std::same_as<bool>;
  form.c;
};

/// Gives a form without coefficients this number of them.
template <std::size_t degree>
void make_room(Form<degree>&, std::size_t) {}
inline void make_room(CurvedForm& form, std::size_t size) {
  if (form.c.empty()) form.c.resize(size);
}

template <AnyForm F>
F& operator+=(F& a, const F& b) {
  make_room(a, b.c.size());
  for (std::size_t k = 0; k < b.c.size(); ++k) a.c[k] += b.c[k];
  return a;
}
template <AnyForm F>
F& operator-=(F& a, const F& b) {
  make_room(a, b.c.size());
  for (std::size_t k = 0; k < b.c.size(); ++k) a.c[k] -= b.c[k];
  return a;
}
template <AnyForm F>
[[nodiscard]] F operator+(F a, const F& b) {
  a += b;
  return a;
}
/// The difference, without a copy of a, whose integers would grow.
template <AnyForm F>
[[nodiscard]] F operator-(const F& a, const F& b) {
  F difference;
  if (a.c.empty() || b.c.empty()) {
    difference += a;
    difference -= b;
    return difference;
  }
  make_room(difference, a.c.size());
  for (std::size_t k = 0; k < a.c.size(); ++k) difference.c[k] = a.c[k] - b.c[k];
  return difference;
}
template <AnyForm F>
[[nodiscard]] F operator-(F a) {
  for (Integer& x : a.c) x = -x;
  return a;
}

/// sum += a b, by convolution. The degree of the sum is that of the product.
template <AnyForm Sum, AnyForm A, AnyForm B>
void add_product(Sum& sum, const A& a, const B& b) {
  if (a.c.empty() || b.c.empty()) return;
  make_room(sum, a.c.size() + b.c.size() - 1);
  for (std::size_t i = 0; i < a.c.size(); ++i) {
    for (std::size_t j = 0; j < b.c.size(); ++j) {
      mpz_addmul(sum.c[i + j].get_mpz_t(), a.c[i].get_mpz_t(), b.c[j].get_mpz_t());
    }
  }
}

/// sum −= a b.
template <AnyForm Sum, AnyForm A, AnyForm B>
void subtract_product(Sum& sum, const A& a, const B& b) {
  if (a.c.empty() || b.c.empty()) return;
  make_room(sum, a.c.size() + b.c.size() - 1);
  for (std::size_t i = 0; i < a.c.size(); ++i) {
    for (std::size_t j = 0; j < b.c.size(); ++j) {
      mpz_submul(sum.c[i + j].get_mpz_t(), a.c[i].get_mpz_t(), b.c[j].get_mpz_t());
    }
  }
}

template <std::size_t m, std::size_t n>
[[nodiscard]] Form<m + n> operator*(const Form<m>& a, const Form<n>& b) {
  Form<m + n> product;
  add_product(product, a, b);
  return product;
}
[[nodiscard]] inline CurvedForm operator*(const CurvedForm& a, const CurvedForm& b) {
  CurvedForm product;
  add_product(product, a, b);
  return product;
}

/// The constant 1 as a form: (1−t + t)^degree.
template <std::size_t degree>
[[nodiscard]] Form<degree> one() {
  if constexpr (degree == 0) {
    return {{Integer(1)}};
  } else {
    return one<degree - 1>() * Form<1>{{Integer(1), Integer(1)}};
  }
}

/// factor · form.
template <AnyForm F>
[[nodiscard]] F multiple(F form, const Integer& factor) {
  for (Integer& x : form.c) x *= factor;
  return form;
}

/// The polynomial of the form with these coefficients, in the monomial basis.
[[nodiscard]] Polynomial to_polynomial(std::span<const Integer> form);

template <AnyForm F>
[[nodiscard]] Polynomial to_polynomial(const F& form) {
  return to_polynomial(std::span<const Integer>(form.c));
}

/// Sign of a form at a number in [0,1]. The coefficients decide most cases: on (0,1) a form without
/// sign changes has the sign of its coefficients.
[[nodiscard]] int sign_at(std::span<const Integer> form, AlgebraicNumber& t);

template <AnyForm F>
[[nodiscard]] int sign_at(const F& form, AlgebraicNumber& t) {
  return sign_at(std::span<const Integer>(form.c), t);
}

/// Motion on straight lines: a coordinate is a form of degree 1.
struct Straight {
  template <std::size_t n>
  using Form = exact::Form<n>;
  /// The constant 1, made once.
  struct Denominator {
    [[nodiscard]] static const Form<1>& form() {
      static const Form<1> one = exact::one<1>();
      return one;
    }
    [[nodiscard]] static std::span<const Polynomial> factors() { return {}; }
  };
};

/// Motion on curves: all coordinates are forms of one degree k, and a form of degree n for straight
/// lines becomes one of degree n k.
struct Curved {
  template <std::size_t n>
  using Form = CurvedForm;
  struct Denominator {
    CurvedForm value{{Integer(1)}};
    /// The points' own denominators that are no constants, each once. They are positive on [0,1].
    std::vector<Polynomial> of_points = {};
    [[nodiscard]] const Form<1>& form() const { return value; }
    [[nodiscard]] std::span<const Polynomial> factors() const { return of_points; }
  };
};

/// The four moving points and the corners of a query, scaled to integers, times a common
/// denominator that is positive on [0,1]: it moves no zero of F, and the corners stay those of a
/// triangle or parallelogram.
template <class Order>
struct MotionOf {
  template <std::size_t n>
  using Form = typename Order::template Form<n>;
  using Point = std::array<Form<1>, 3>;

  ContactKind kind;
  std::array<Point, moving_points> points;
  /// w_0..w_2 (vertex_face) or w_0..w_3 (edge_edge), in the order of touchstone::corners.
  std::array<Point, 4> corners;
  std::size_t corner_count;
  /// The minimum separation in units of the coordinates; 0 if each axis has its own unit.
  Integer distance = 0;
  Norm norm = Norm::l2;
  typename Order::Denominator denominator = {};

  /// The distance times the denominator, as the corners are.
  [[nodiscard]] Form<1> reach() const { return multiple(denominator.form(), distance); }
};
using Motion = MotionOf<Straight>;

/// Sets the corners from the points.
template <class Order>
void set_corners(MotionOf<Order>& motion) {
  motion.corner_count = 0;
  for (const Corner& corner : corners(motion.kind)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion.corners[motion.corner_count][axis] =
          motion.points[corner.plus][axis] - motion.points[corner.minus][axis];
    }
    ++motion.corner_count;
  }
}

/// Scales all axes and the distance by one power of two, which keeps angles and ratios of lengths.
/// Exact for all finite doubles, in every floating-point environment.
/// \throws std::domain_error if a coordinate is NaN or infinite; std::invalid_argument if the
/// separation is not valid.
[[nodiscard]] Motion scale_uniformly(ContactKind kind, const Query& query,
                                     const Separation& separation = {.distance = 0.0,
                                                                     .norm = Norm::l2});

/// \throws as of a Query, and std::domain_error if a weight is not positive, std::invalid_argument
/// if the query is not valid.
[[nodiscard]] MotionOf<Curved> scale_uniformly(ContactKind kind, const CurvedQuery& query,
                                               const Separation& separation);

/// As scale_uniformly of the same query, but if the distance is 0, each axis is scaled by its own
/// power of two.
[[nodiscard]] Motion scale(ContactKind kind, const Query& query, const Separation& separation = {});
[[nodiscard]] MotionOf<Curved> scale(ContactKind kind, const CurvedQuery& query,
                                     const Separation& separation = {});

/// Component `axis` of w_i × w_j as a function of time.
template <class Order>
[[nodiscard]] auto cross_component(const MotionOf<Order>& motion, std::size_t i, std::size_t j,
                                   std::size_t axis) {
  const auto &a = motion.corners[i], &b = motion.corners[j];
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  auto result = a[y] * b[z];
  subtract_product(result, a[z], b[y]);
  return result;
}

/// w_i · w_j, each axis still scaled by its own power of two: its sign is meaningful only where w_i
/// and w_j are parallel.
template <class Order>
[[nodiscard]] auto dot(const MotionOf<Order>& motion, std::size_t i, std::size_t j) {
  const auto &a = motion.corners[i], &b = motion.corners[j];
  auto sum = a[0] * b[0];
  for (std::size_t axis = 1; axis < 3; ++axis) add_product(sum, a[axis], b[axis]);
  return sum;
}

/// Component `axis` of the polygon's normal N = (w_1 − w_0) × (w_last − w_0).
template <class Order>
[[nodiscard]] auto normal_component(const MotionOf<Order>& motion, std::size_t axis) {
  const std::size_t last = motion.corner_count - 1;
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  const auto edge = [&](std::size_t corner, std::size_t k) {
    return motion.corners[corner][k] - motion.corners[0][k];
  };
  auto result = edge(1, y) * edge(last, z);
  subtract_product(result, edge(1, z), edge(last, y));
  return result;
}

/// det(w_0, w_1, w_last): zero iff the origin is in the polygon's plane.
template <class Order>
[[nodiscard]] auto determinant(const MotionOf<Order>& motion) {
  const std::size_t last = motion.corner_count - 1;
  auto sum = cross_component(motion, 0, 1, 0) * motion.corners[last][0];
  for (std::size_t axis = 1; axis < 3; ++axis) {
    add_product(sum, cross_component(motion, 0, 1, axis), motion.corners[last][axis]);
  }
  return sum;
}

}  // namespace touchstone::exact
