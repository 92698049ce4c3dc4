#pragma once

/// \file
/// Proofs of contact on curves, in numbers with error bounds (touchstone/filters/ball.hpp).
///
/// **Theorem 1** (d = 0). On an interval of time let det(w_0, w_1, w_last) have Bernstein
/// coefficients with exactly one change of sign, the first and the last not 0, and let for one axis
/// the components of w_i × w_{i+1} of all sides, in cyclic order, have positive coefficients only,
/// or negative ones only. Then exactly one time of the interval is a contact: the zero of det.
/// *Proof.* By Descartes' rule det has exactly one zero. The sum of the components is that of the
/// normal N times 1 (triangle) or 2 (parallelogram), so N ≠ 0, and by the rule at a fixed time
/// (docs/theory.md, section 2.1) det = 0 is a contact, and det ≠ 0 is none. ∎
///
/// **Theorem 2** (d > 0). If ‖F(t,u,v)‖ ≤ d for one (u,v) of the domain, t is a contact.
///
/// All are multiplied by the positive denominators. Coefficients are sums of products of control
/// values times binomials: forms, as in docs/theory.md, section 2.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "fast/curved/control_polygon.hpp"
#include "touchstone/filters/ball.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::curved {

using filters::Ball;

/// Σ c_k (1−t)^(n−k) t^k.
using BallForm = std::vector<Ball>;

[[nodiscard]] inline int sign_of(const Ball& x) {
  return (filters::is_positive(x) ? 1 : 0) - (filters::is_positive(-x) ? 1 : 0);
}

inline void add_product(BallForm& sum, const BallForm& a, const BallForm& b) {
  sum.resize(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] = sum[i + j] + a[i] * b[j];
  }
}

[[nodiscard]] inline BallForm difference_of_products(const BallForm& a, const BallForm& b,
                                                     const BallForm& c, const BallForm& d) {
  BallForm first, second;
  add_product(first, a, b);
  add_product(second, c, d);
  for (std::size_t k = 0; k < first.size(); ++k) first[k] = first[k] - second[k];
  return first;
}

/// A corner's coordinates as forms.
using BallVector = std::array<BallForm, 3>;

[[nodiscard]] inline BallVector corner_forms(const ControlPolygon& polygon, std::size_t corner) {
  BallVector result;
  double binomial = 1.0;
  for (std::size_t k = 0; k <= polygon.degree; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Ball value({polygon.at(k, axis, corner), 0.0}, polygon.error);
      result[axis].push_back(value * Ball(binomial));
    }
    binomial = binomial * static_cast<double>(polygon.degree - k) / static_cast<double>(k + 1);
  }
  return result;
}

/// Component `axis` of a × b.
[[nodiscard]] inline BallForm cross_form(const BallVector& a, const BallVector& b,
                                         std::size_t axis) {
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  return difference_of_products(a[y], b[z], a[z], b[y]);
}

/// The sign of all coefficients; 0 if they differ or are uncertain.
[[nodiscard]] inline int common_sign(const BallForm& form) {
  const int sign = sign_of(form.front());
  for (const Ball& c : form) {
    if (sign_of(c) != sign) return 0;
  }
  return sign;
}

/// True if the coefficients certainly have exactly one change of sign: at most one that is
/// uncertain, between those of the first sign and those of the last.
[[nodiscard]] inline bool changes_once(const BallForm& form) {
  const int first = sign_of(form.front()), last = sign_of(form.back());
  if (first * last >= 0) return false;
  std::size_t of_first = 0, of_last = 0;
  while (sign_of(form[of_first]) == first) ++of_first;
  while (sign_of(form[form.size() - 1 - of_last]) == last) ++of_last;
  return of_first + of_last + 1 >= form.size();
}

/// det(w_0, w_1, w_last).
[[nodiscard]] inline BallForm determinant_form(const std::array<BallVector, 4>& w) {
  BallForm det;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_product(det, w[0][axis], cross_form(w[1], w[3], axis));
  }
  return det;
}

/// Theorem 1 for an axis. Place 3 has the last corner. \param det Receives the coefficients.
template <Kind kind>
[[nodiscard]] inline bool has_one_contact(const ControlPolygon& polygon, std::size_t axis,
                                          BallForm& det) {
  const std::array<BallVector, 4> w{corner_forms(polygon, 0), corner_forms(polygon, 1),
                                    corner_forms(polygon, 2), corner_forms(polygon, 3)};
  constexpr std::size_t sides = kind == Kind::vertex_face ? 3 : 4;
  int sign = 0;
  for (std::size_t i = 0; i < sides; ++i) {
    const int of_side = common_sign(cross_form(w[i], w[(i + 1) % sides], axis));
    if (of_side == 0 || (i > 0 && of_side != sign)) return false;
    sign = of_side;
  }
  det = determinant_form(w);
  return changes_once(det);
}

/// The sign of det at a time, from the query's own numbers; 0 if it is uncertain. (With coordinates
/// up to greatest_magnitude and weights up to 2^30 the corners are below 2^161, det below 2^486.)
template <Kind kind>
[[nodiscard]] inline int determinant_sign(const ControlPoints& points, double time) {
  const Ball t(time), rest = Ball(1.0) - t;
  bool is_usual = true;
  // Weighted coordinates and the weight, by de Casteljau's algorithm.
  const auto place = [&](std::size_t point) {
    std::array<std::array<Ball, 4>, greatest_degree + 1> row;
    for (std::size_t k = 0; k <= points.degree(); ++k) {
      const Ball weight(points.weight(k, point));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = points.x(k, point, axis);
        is_usual = is_usual && std::abs(x) <= greatest_magnitude;
        row[k][axis] = Ball(x) * weight;
      }
      row[k][3] = weight;
    }
    for (std::size_t level = points.degree(); level > 0; --level) {
      for (std::size_t k = 0; k < level; ++k) {
        for (std::size_t i = 0; i < 4; ++i) row[k][i] = row[k][i] * rest + row[k + 1][i] * t;
      }
    }
    return row[0];
  };
  const std::array all{place(0), place(1), place(2), place(3)};
  if (!is_usual) return 0;
  const auto corner = [&](std::size_t i) {
    const auto &a = all[corner_of(kind, i).plus], &b = all[corner_of(kind, i).minus];
    return std::array{a[0] * b[3] - b[0] * a[3], a[1] * b[3] - b[1] * a[3],
                      a[2] * b[3] - b[2] * a[3]};
  };
  const auto a = corner(0), b = corner(1), c = corner(3);
  return sign_of(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                 a[2] * (b[0] * c[1] - b[1] * c[0]));
}

/// Theorem 2 at the end of the polygon's interval, or at its start. \param u, v In the domain.
[[nodiscard]] inline bool is_contact(const ControlPolygon& polygon, std::size_t k, double u,
                                     double v, Norm norm) {
  std::array<Ball, 3> x;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto corner = [&](std::size_t i) {
      return Ball({polygon.at(k, axis, i), 0.0}, polygon.error);
    };
    x[axis] = corner(0) + (corner(1) - corner(0)) * Ball(u) + (corner(3) - corner(0)) * Ball(v);
  }
  const Ball reach({polygon.reach[k], 0.0}, polygon.error);
  if (norm == Norm::l2) {
    return filters::is_positive(reach * reach - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
  }
  return std::ranges::all_of(x, [&](const Ball& component) {
    return filters::is_positive(reach - filters::abs(component));
  });
}

}  // namespace touchstone::fast::curved
