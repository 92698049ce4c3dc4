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

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "touchstone/algebraic_number.hpp"
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

  Form& operator+=(const Form& other) {
    for (std::size_t k = 0; k <= degree; ++k) c[k] += other.c[k];
    return *this;
  }
  Form& operator-=(const Form& other) {
    for (std::size_t k = 0; k <= degree; ++k) c[k] -= other.c[k];
    return *this;
  }
  friend Form operator+(Form a, const Form& b) { return a += b; }
  friend Form operator-(Form a, const Form& b) { return a -= b; }
  friend Form operator-(Form a) {
    for (Integer& x : a.c) x = -x;
    return a;
  }
};

/// sum += a b, by convolution.
template <std::size_t m, std::size_t n>
void add_product(Form<m + n>& sum, const Form<m>& a, const Form<n>& b) {
  for (std::size_t i = 0; i <= m; ++i) {
    for (std::size_t j = 0; j <= n; ++j) {
      mpz_addmul(sum.c[i + j].get_mpz_t(), a.c[i].get_mpz_t(), b.c[j].get_mpz_t());
    }
  }
}

/// sum −= a b.
template <std::size_t m, std::size_t n>
void subtract_product(Form<m + n>& sum, const Form<m>& a, const Form<n>& b) {
  for (std::size_t i = 0; i <= m; ++i) {
    for (std::size_t j = 0; j <= n; ++j) {
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

/// The constant 1 as a form: (1−t + t)^degree.
template <std::size_t degree>
[[nodiscard]] Form<degree> one() {
  if constexpr (degree == 0) {
    return {{Integer(1)}};
  } else {
    return one<degree - 1>() * Form<1>{{Integer(1), Integer(1)}};
  }
}

/// The same polynomial as a form of one higher degree: multiplied by (1−t) + t.
template <std::size_t degree>
[[nodiscard]] Form<degree + 1> raised(const Form<degree>& form) {
  Form<degree + 1> result;
  for (std::size_t k = 0; k <= degree; ++k) {
    result.c[k] += form.c[k];
    result.c[k + 1] += form.c[k];
  }
  return result;
}

/// factor · form.
template <std::size_t degree>
[[nodiscard]] Form<degree> multiple(Form<degree> form, const Integer& factor) {
  for (Integer& x : form.c) x *= factor;
  return form;
}

/// The polynomial of the form with these coefficients, in the monomial basis.
[[nodiscard]] Polynomial to_polynomial(std::span<const Integer> form);

template <std::size_t degree>
[[nodiscard]] Polynomial to_polynomial(const Form<degree>& form) {
  return to_polynomial(std::span<const Integer>(form.c));
}

/// Sign of a form at a number in [0,1]. The coefficients decide most cases: on (0,1) a form without
/// sign changes has the sign of its coefficients.
[[nodiscard]] int sign_at(std::span<const Integer> form, AlgebraicNumber& t);

template <std::size_t degree>
[[nodiscard]] int sign_at(const Form<degree>& form, AlgebraicNumber& t) {
  return sign_at(std::span<const Integer>(form.c), t);
}

/// The four moving points and the corners of a query, scaled to integers.
struct Motion {
  using Point = std::array<Form<1>, 3>;

  Kind kind;
  std::array<Point, moving_points> points;
  /// w_0..w_2 (vertex_face) or w_0..w_3 (edge_edge), in the order of touchstone::corners.
  std::array<Point, 4> corners;
  std::size_t corner_count;
  /// The minimum separation in units of the coordinates; 0 if each axis has its own unit.
  Integer distance = 0;
  Norm norm = Norm::l2;
};

/// Scales each axis by its own power of two.
/// \throws std::domain_error if a coordinate is NaN or infinite.
[[nodiscard]] Motion scale_to_integers(Kind kind, const Query& query);

/// Scales all axes and the distance by one power of two, which keeps angles and ratios of lengths.
/// Exact for all finite doubles, in every floating-point environment.
/// \throws std::domain_error if a coordinate is NaN or infinite; std::invalid_argument if the
/// separation is not valid.
[[nodiscard]] Motion scale_uniformly(Kind kind, const Query& query,
                                     const Separation& separation = {.distance = 0.0,
                                                                     .norm = Norm::l2});

/// Component `axis` of w_i × w_j as a function of time.
[[nodiscard]] Form<2> cross_component(const Motion& motion, std::size_t i, std::size_t j,
                                      std::size_t axis);

/// w_i · w_j, each axis still scaled by its own power of two: its sign is meaningful only where w_i
/// and w_j are parallel.
[[nodiscard]] Form<2> dot(const Motion& motion, std::size_t i, std::size_t j);

/// Component `axis` of the polygon's normal N = (w_1 − w_0) × (w_last − w_0).
[[nodiscard]] Form<2> normal_component(const Motion& motion, std::size_t axis);

/// det(w_0, w_1, w_last): zero iff the origin is in the polygon's plane.
[[nodiscard]] Form<3> determinant(const Motion& motion);

}  // namespace touchstone::exact
