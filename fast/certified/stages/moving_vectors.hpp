#pragma once

/// \file
/// The vectors in determinant and orientations, in lanes, and their bounds with a minimum
/// separation.
///
/// F = r − u p − v q (touchstone/filters/polynomial_expressions.hpp): r, p, q and, for the
/// orientations of corners, two more. They move linearly on each interval of times.
///
/// **With a minimum separation** D, "no contact" must be proved for the polygon shifted by every x
/// with ‖x‖ ≤ D: r becomes r − x, as does the corresponding vector in an orientation. Let |·| be
/// the greatest magnitude of a component. A determinant of three vectors with components ±1 is at
/// most 4, so the shift changes det by at most D ‖N‖₁ ≤ 4 D |p| |q|, and an orientation x·(d × y)
/// by at most 4 D |d| |y|. The computed middle coefficients are three times the Bernstein
/// coefficients of det and twice those of an orientation, and their changes are multiplied
/// likewise. `widened` adds these to the bounds, 12 for all coefficients (docs/theory.md, section
/// 6.9).

#include <array>
#include <cstddef>

#include "fast/certified/stages/lanes.hpp"

namespace touchstone::fast::kernel {

/// The moving vectors of a query, by their places: r, p, q, and for the orientations
/// vertex_face: a = f1 − v, e = f2 − f1; edge_edge: a = eb0 − ea1, e = eb1 − ea0.
enum Place : std::size_t { r, p, q, a, e };
inline constexpr std::size_t vector_count = 5;

/// The points whose differences they are.
template <ContactKind kind>
consteval std::array<std::array<std::size_t, 2>, vector_count> ends_of_vectors() {
  if constexpr (kind == ContactKind::vertex_face) return {{{0, 1}, {2, 1}, {3, 1}, {2, 0}, {3, 2}}};
  return {{{0, 2}, {0, 1}, {3, 2}, {2, 1}, {3, 0}}};
}

/// The moving vectors at both ends of an interval.
template <class Value>
using Ends = std::array<std::array<Vector<Value>, 2>, vector_count>;

/// The moving vectors of queries at t=0 and t=1, from their points.
template <ContactKind kind, class Coordinate>
inline Ends<DifferenceOf<Coordinate>> vectors_of(
    const std::array<Vector<Coordinate>, query_points>& x) {
  constexpr auto ends = ends_of_vectors<kind>();
  Ends<DifferenceOf<Coordinate>> at;
  for (std::size_t i = 0; i < vector_count; ++i) {
    for (std::size_t end = 0; end < 2; ++end) {
      at[i][end] = minus(x[4 * end + ends[i][0]], x[4 * end + ends[i][1]]);
    }
  }
  return at;
}

/// Vectors that move from their first value at 0 to their second at 1, at the ends of [begin, end].
template <class Value>
inline Ends<Value> between(const Ends<Value>& unit, const Value& begin, const Value& end) {
  const Value one(1), before_begin = one - begin, before_end = one - end;
  Ends<Value> at;
  for (std::size_t i = 0; i < vector_count; ++i) {
    at[i] = {filters::at_time(unit[i][0], unit[i][1], before_begin, begin),
             filters::at_time(unit[i][0], unit[i][1], before_end, end)};
  }
  return at;
}

/// The increased magnitude of r, or of the corresponding vector, with which a polynomial's bound
/// also covers the shift by the distance. `rounding` is the factor of the magnitudes in the bound,
/// `shift` the factor of the distance.
template <bool separated, class Value>
inline Value widened(const Value& magnitude, typename Value::Scalar rounding, const Value& distance,
                     typename Value::Scalar shift) {
  if constexpr (separated) return magnitude + distance * Value(shift / rounding);
  return magnitude;
}
template <class Scalar>
inline constexpr Scalar shift_of_value = Scalar(4.001);
template <class Scalar>
inline constexpr Scalar shift_of_coefficients = Scalar(12.001);

}  // namespace touchstone::fast::kernel
