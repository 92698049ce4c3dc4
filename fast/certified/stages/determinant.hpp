#pragma once

/// \file
/// Stage 3, determinant (docs/theory.md, section 6.4).
///
/// **Theorem.** det = r·(p×q) vanishes at each contact. On an interval of times it stays in the
/// hull of its Bernstein coefficients there. So there is no contact if all of them are beyond their
/// error bound on one side of 0. If they certainly change sign exactly once, det has exactly one
/// zero in the interval (Descartes' rule of signs).
///
/// This stage tests [0,1], in one pass with the stage direction. Later stages use the test on parts
/// of it.

#include <array>
#include <cstddef>

#include "fast/certified/stages/axis.hpp"
#include "fast/certified/stages/direction.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"

namespace touchstone::fast::kernel {

/// The error bound of det from the magnitudes of r, p and q. \param shift that of a value or of
/// coefficients
template <bool separated, class Value>
inline Value determinant_bound(const std::array<Value, 3>& magnitudes,
                               typename Value::Scalar rounding, typename Value::Scalar underflow,
                               const Value& distance, typename Value::Scalar shift) {
  return widened<separated>(magnitudes[0], rounding, distance, shift) * magnitudes[1] *
             magnitudes[2] * Value(rounding) +
         Value(underflow);
}
template <bool separated, class Value>
inline Value determinant_bound(const std::array<Value, 3>& magnitudes, const Value& distance,
                               typename Value::Scalar shift) {
  using Format = FormatOf<Value>;
  return determinant_bound<separated>(magnitudes, Format::determinant.rounding(),
                                      Format::determinant.underflow(Format::limits.difference),
                                      distance, shift);
}
template <bool separated, class Value>
inline Value determinant_bound(const Ends<Value>& unit, const Value& distance) {
  return determinant_bound<separated>(
      std::array<Value, 3>{magnitude(unit[r]), magnitude(unit[p]), magnitude(unit[q])}, distance,
      shift_of_coefficients<typename Value::Scalar>);
}

/// N = p × q at both ends, and twice its middle Bernstein coefficient.
template <class Value>
struct Normals {
  Vector<Value> a;
  Vector<Value> b;
  Vector<Value> twice_ab;

  explicit Normals(const Ends<Value>& at)
      : a(filters::cross(at[p][0], at[q][0])),
        b(filters::cross(at[p][1], at[q][1])),
        twice_ab(filters::normal_middle(at[p][0], at[p][1], at[q][0], at[q][1])) {}

  /// The normal in the middle of the interval, up to a factor.
  [[nodiscard]] Vector<Value> middle() const {
    const Vector<Value> sum = filters::add(filters::add(a, b), twice_ab);
    constexpr auto scale = FormatOf<Value>::normal_scale;
    if constexpr (scale == 1) return sum;
    return {sum[0] * Value(scale), sum[1] * Value(scale), sum[2] * Value(scale)};
  }
};

/// d0, 3 d1, 3 d2, d3 of the Bernstein coefficients of det.
template <class Value>
inline std::array<Value, 4> determinant_coefficients(const Ends<Value>& at,
                                                     const Normals<Value>& n) {
  return {filters::dot(at[r][0], n.a),
          filters::determinant_middle(at[r][0], at[r][1], n.a, n.twice_ab),
          filters::determinant_middle(at[r][1], at[r][0], n.b, n.twice_ab),
          filters::dot(at[r][1], n.b)};
}

/// Proved properties of det on an interval.
template <class Value>
struct DeterminantTest {
  MaskOf<Value> one_sided;     ///< no zero
  MaskOf<Value> crosses_once;  ///< one zero

  DeterminantTest(const std::array<Value, 4>& c, const Value& bound) {
    const Value minus_bound = Value(0) - bound;
    one_sided = (min(min(c[0], c[1]), min(c[2], c[3])) > bound) |
                (max(max(c[0], c[1]), max(c[2], c[3])) < minus_bound);
    const MaskOf<Value> rises =
        (c[0] < minus_bound) & (c[3] > bound) & ((c[1] < minus_bound) | (c[2] > bound));
    const MaskOf<Value> falls =
        (c[0] > bound) & (c[3] < minus_bound) & ((c[1] > bound) | (c[2] < minus_bound));
    crosses_once = rises | falls;
  }
};

/// The stages direction and determinant, and before them the stage axis for several queries up to
/// t_limit, if it is less than 1 and they were not tested before.
/// \param mixed The queries that none of them decides.
template <class Lanes, bool separated, ContactKind kind, class Source>
inline void direction_and_determinant_stage(const KernelInput& input, const Indices& open,
                                            Indices& mixed, KernelOutput& output) {
  using Value = typename Lanes::Value;
  Marks<Lanes> unbounded(open.count), of_direction(open.count), of_determinant(open.count),
      of_neither(open.count);
  const Value distance(input.separation.distance);
  const bool has_end = !Source::is_one && !input.axis_is_done && input.t_limit < 1.0;
  for (std::size_t first = 0; first < open.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, open.count);
    const auto points = load<Lanes, Source>(input, open.items.data() + first, count);
    unsigned valid = first_lanes<Lanes>(count);
    if (has_end) {
      valid &= ~is_separated_until<Value, separated, kind>(points, input.separation.distance,
                                                           input.t_limit)
                    .bits();
      if (valid == 0) continue;
    }
    const DirectionTest<Value, separated, kind> direction(points, distance);
    const unsigned bits = valid & direction.bounded.bits();
    const unsigned apart = direction.apart.bits();
    unsigned one_sided = 0;
    // Several queries are hardly ever all apart.
    if (!Source::is_one || (bits & ~apart) != 0) {
      const Ends<Value> at = vectors_of<kind>(points);
      one_sided = DeterminantTest<Value>(determinant_coefficients(at, Normals(at)),
                                         determinant_bound<separated>(at, distance))
                      .one_sided.bits();
    }
    unbounded.add(first, valid & ~bits);
    of_direction.add(first, bits & apart);
    of_determinant.add(first, bits & ~apart & one_sided);
    of_neither.add(first, bits & ~apart & ~one_sided);
  }
  append_marked(output.undecided, open, unbounded);
  append_marked(output.separated_in_direction, open, of_direction);
  append_marked(output.one_sided, open, of_determinant);
  mixed.count = 0;
  append_marked(mixed, open, of_neither);
}

}  // namespace touchstone::fast::kernel
