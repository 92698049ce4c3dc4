#pragma once

/// \file
/// Polynomials in t and vectors of them, for moving points and their products, in power form
/// with ordinary rounding, as in the methods that use them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// c[i] is the coefficient of tⁱ.
template <std::size_t Degree>
struct Polynomial {
  std::array<double, Degree + 1> c{};

  /// The value at t, by Horner's rule.
  [[nodiscard]] double operator()(double t) const {
    double value = c[Degree];
    for (std::size_t i = Degree; i > 0; --i) value = value * t + c[i - 1];
    return value;
  }
};

template <std::size_t Degree>
using VectorPolynomial = std::array<Polynomial<Degree>, 3>;

/// A point or vector that moves linearly.
using LinearMotion = VectorPolynomial<1>;

/// a + sign·b
template <std::size_t A, std::size_t B>
[[nodiscard]] Polynomial<std::max(A, B)> combine(const Polynomial<A>& a, const Polynomial<B>& b,
                                                 double sign) {
  Polynomial<std::max(A, B)> result;
  for (std::size_t i = 0; i <= A; ++i) result.c[i] = a.c[i];
  for (std::size_t i = 0; i <= B; ++i) result.c[i] += sign * b.c[i];
  return result;
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Polynomial<std::max(A, B)> operator+(const Polynomial<A>& a, const Polynomial<B>& b) {
  return combine(a, b, 1.0);
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Polynomial<std::max(A, B)> operator-(const Polynomial<A>& a, const Polynomial<B>& b) {
  return combine(a, b, -1.0);
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Polynomial<A + B> operator*(const Polynomial<A>& a, const Polynomial<B>& b) {
  Polynomial<A + B> result;
  for (std::size_t i = 0; i <= A; ++i) {
    for (std::size_t j = 0; j <= B; ++j) result.c[i + j] += a.c[i] * b.c[j];
  }
  return result;
}

template <std::size_t A>
[[nodiscard]] Polynomial<A> operator*(double factor, const Polynomial<A>& a) {
  return Polynomial<0>{{factor}} * a;
}

template <std::size_t A, std::size_t B>
[[nodiscard]] VectorPolynomial<std::max(A, B)> operator-(const VectorPolynomial<A>& a,
                                                         const VectorPolynomial<B>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <std::size_t A, std::size_t B>
[[nodiscard]] VectorPolynomial<A + B> cross(const VectorPolynomial<A>& a,
                                            const VectorPolynomial<B>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <std::size_t A, std::size_t B>
[[nodiscard]] Polynomial<A + B> dot(const VectorPolynomial<A>& a, const VectorPolynomial<B>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <std::size_t A>
[[nodiscard]] Polynomial<2 * A> squared_norm(const VectorPolynomial<A>& a) {
  return dot(a, a);
}

/// A point of the query as a function of time.
[[nodiscard]] inline LinearMotion motion_of(const Query& query, std::size_t point) {
  LinearMotion result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double start = query.at(0, point, axis);
    result[axis] = {{start, query.at(1, point, axis) - start}};
  }
  return result;
}

/// The four points of a query.
[[nodiscard]] inline std::array<LinearMotion, moving_points> motions_of(const Query& query) {
  return {motion_of(query, 0), motion_of(query, 1), motion_of(query, 2), motion_of(query, 3)};
}

/// The coefficients, the highest power's first.
template <std::size_t Degree>
[[nodiscard]] std::array<double, Degree + 1> descending(const Polynomial<Degree>& polynomial) {
  std::array<double, Degree + 1> result = polynomial.c;
  std::ranges::reverse(result);
  return result;
}

/// The coefficients, the highest power's first, without the leading ones that are exactly
/// 0; none if all are.
[[nodiscard]] inline std::span<const double> without_leading_zeros(
    std::span<const double> coefficients) {
  const auto first = std::ranges::find_if(coefficients, [](double c) { return c != 0.0; });
  return {first, coefficients.end()};
}

}  // namespace touchstone::baselines
