#pragma once

/// \file
/// The exact number of instants of contact of a query. It shares only polynomials and
/// algebraic numbers with the oracle.

#include <array>
#include <cstddef>
#include <vector>

#include "tests/support/queries.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::tests {

namespace root_count {

using exact::Polynomial;
using Vector = std::array<Polynomial, 3>;

[[nodiscard]] inline Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline Polynomial dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The corners w_i(t).
[[nodiscard]] inline std::vector<Vector> moving_corners(const PosedQuery& posed) {
  std::vector<Vector> result;
  for (const Corner& corner : corners(posed.kind)) {
    Vector& w = result.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::size_t end) {
        return exact::Integer(posed.query.at(end, corner.plus, axis) -
                              posed.query.at(end, corner.minus, axis));
      };
      w.at(axis) = Polynomial(at(0), exact::Integer(at(1) - at(0)));
    }
  }
  return result;
}

}  // namespace root_count

/// The number of times t in [0,1] of contact.
/// \pre integer coordinates below 2^50; the primitives do not move in a common plane, and are not
/// degenerate at a contact.
[[nodiscard]] inline int count_contacts(const PosedQuery& posed) {
  using root_count::cross, root_count::dot, root_count::minus;
  const auto w = root_count::moving_corners(posed);
  const auto normal = cross(minus(w[1], w[0]), minus(w[2], w[0]));
  int count = 0;
  for (exact::AlgebraicNumber& t : exact::roots_in_unit_interval(dot(normal, w[0]))) {
    bool is_inside = true;
    for (std::size_t i = 0; i < w.size(); ++i) {
      is_inside = is_inside && t.sign_of(dot(normal, cross(w[i], w[(i + 1) % w.size()]))) >= 0;
    }
    count += is_inside ? 1 : 0;
  }
  return count;
}

/// A query of independent integer coordinates in [−1000, 1000]: general position, large
/// deformation.
[[nodiscard]] inline PosedQuery deforming_query(Random& random, ContactKind kind) {
  PosedQuery posed{kind, {}};
  for (double& x : posed.query.coordinates) x = random.between(-1000, 1000);
  return posed;
}

}  // namespace touchstone::tests
