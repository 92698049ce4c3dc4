#pragma once

/// \file
/// Stage 4, orientation (docs/theory.md, section 6.5).
///
/// **Theorem.** Let d be a fixed direction and o_i = d·(w_i × w_{i+1}) the orientations of
/// consecutive corners. If 0 = Σ λ_i w_i with barycentric λ ≥ 0, each o_i is a nonnegative multiple
/// of d·N, so at a contact they all have one sign:
///
/// 1. If two of them keep opposite signs on an interval of times, there is no contact in it.
/// 2. If all of them keep one sign (not 0), so does d·N, the sum of three of them or of two
///    opposite ones. Hence N ≠ 0, and each zero of det in the interval is a contact of the
///    interiors of the primitives.
///
/// They are quadratic in t and stay in the hull of their Bernstein coefficients. d is the normal in
/// the middle of the interval. This stage tests [0,1]; only_zero.hpp and bisection.hpp test parts
/// of it.

#include <array>
#include <cstddef>

#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"

namespace touchstone::fast::kernel {

/// An orientation as ± x · (d × y).
struct Orientation {
  Place x;
  Place y;
  bool negative;
};

/// The orientations, proportional to the barycentric v, u, 1−u−v or v, u, 1−u, 1−v in this order.
template <ContactKind kind>
consteval auto orientations() {
  if constexpr (kind == ContactKind::vertex_face) {
    return std::array<Orientation, 3>{{{r, p, false}, {r, q, true}, {a, e, true}}};
  } else {
    return std::array<Orientation, 4>{{{r, p, false}, {r, q, true}, {a, q, true}, {e, p, false}}};
  }
}

/// The inputs of the queries' bounds: the bound of det, and for each orientation the product of its
/// vectors' magnitudes.
template <class Value, ContactKind kind>
struct Bounds {
  Value determinant;
  std::array<Value, orientations<kind>().size()> orientation_scale;
};

template <ContactKind kind, bool separated, class Value>
inline Bounds<Value, kind> bounds_of(const Ends<Value>& unit, const Value& distance) {
  constexpr auto all_orientations = orientations<kind>();
  using Scalar = typename Value::Scalar;
  constexpr Scalar rounding = FormatOf<Value>::orientation.rounding();
  Bounds<Value, kind> bounds{determinant_bound<separated>(unit, distance), {}};
  for (std::size_t i = 0; i < all_orientations.size(); ++i) {
    const auto [x, y, is_negative] = all_orientations[i];
    bounds.orientation_scale[i] =
        widened<separated>(magnitude(unit[x]), rounding, distance, shift_of_coefficients<Scalar>) *
        magnitude(unit[y]);
  }
  return bounds;
}

/// Proved properties of the orientations on an interval.
template <class Value>
struct OrientationTest {
  MaskOf<Value> opposed;  ///< two keep opposite signs
  MaskOf<Value> agree;    ///< all keep one sign
};

template <ContactKind kind, class Value>
inline OrientationTest<Value> test_orientations(const Vector<Value>& d, const Ends<Value>& at,
                                                const Bounds<Value, kind>& bounds) {
  using Format = FormatOf<Value>;
  using Mask = MaskOf<Value>;
  constexpr auto underflow = Format::orientation.underflow(Format::limits.direction);
  constexpr auto all_orientations = orientations<kind>();
  const Value scale = greatest(d) * Value(Format::orientation.rounding());
  Mask any_positive = Mask::none(), any_negative = Mask::none();
  Mask all_positive = Mask::all(), all_negative = Mask::all();
  for (std::size_t i = 0; i < all_orientations.size(); ++i) {
    const auto [x, y, is_negative] = all_orientations[i];
    const Vector<Value> d_y_a = filters::cross(d, at[y][0]), d_y_b = filters::cross(d, at[y][1]);
    const Value o_a = filters::dot(at[x][0], d_y_a), o_b = filters::dot(at[x][1], d_y_b);
    const Value o_ab = filters::orientation_middle(at[x][0], at[x][1], d_y_a, d_y_b);
    const Value bound = scale * bounds.orientation_scale[i] + Value(underflow);
    const Mask above = min(min(o_a, o_b), o_ab) > bound;
    const Mask below = max(max(o_a, o_b), o_ab) < Value(0) - bound;
    const Mask positive = is_negative ? below : above;
    const Mask negative = is_negative ? above : below;
    any_positive = any_positive | positive;
    any_negative = any_negative | negative;
    all_positive = all_positive & positive;
    all_negative = all_negative & negative;
  }
  return {any_positive & any_negative, all_positive | all_negative};
}

/// Proved properties on an interval.
template <class Value>
struct Examination {
  std::array<Value, 4> coefficients;  ///< of det
  DeterminantTest<Value> determinant;
  OrientationTest<Value> orientation;

  [[nodiscard]] MaskOf<Value> has_no_contact() const {
    return determinant.one_sided | orientation.opposed;
  }
  [[nodiscard]] MaskOf<Value> has_contact() const {
    return determinant.crosses_once & orientation.agree;
  }
};

/// \param at The vectors at the ends of the interval.
template <ContactKind kind, class Value>
inline Examination<Value> examine(const Ends<Value>& at, const Bounds<Value, kind>& bounds) {
  const Normals<Value> normals(at);
  const std::array<Value, 4> coefficients = determinant_coefficients(at, normals);
  return {coefficients,
          {coefficients, bounds.determinant},
          test_orientations<kind>(normals.middle(), at, bounds)};
}

/// The size of a query.
template <class Value>
inline Value size_of(const Ends<Value>& unit) {
  return max(max(magnitude(unit[r]), magnitude(unit[p])), magnitude(unit[q]));
}

/// The factor of the distance that must not exceed a query's size, or the widened bounds prove too
/// little.
inline constexpr double greatest_shift = 0x1p16;

/// The lanes whose distance is too large a shift.
template <bool separated, class Value>
inline unsigned far_lanes(const KernelInput& input, const Ends<Value>& unit) {
  if constexpr (!separated) return 0;
  return (Value(input.separation.distance * greatest_shift) > size_of(unit)).bits();
}

/// \param contacts The queries whose time of impact is the only zero of det.
/// \param zeros The queries of which only that zero can be a contact.
/// \param undecided The queries of which nothing is proved.
/// \param far The queries whose distance is too large a shift.
template <class Lanes, bool separated, ContactKind kind, class Source>
inline void orientation_stage(const KernelInput& input, const Indices& mixed, Crossings& contacts,
                              Crossings& zeros, Indices& undecided, Indices& far,
                              KernelOutput& output) {
  using Value = typename Lanes::Value;
  Marks<Lanes> of_contacts(mixed.count), of_rejected(mixed.count), of_zeros(mixed.count),
      of_rest(mixed.count), of_far(mixed.count);
  Intervals<Lanes> intervals;
  for (std::size_t first = 0; first < mixed.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, mixed.count);
    const Ends<Value> unit =
        vectors_of<kind>(load<Lanes, Source>(input, mixed.items.data() + first, count));
    const Examination<Value> found =
        examine<kind>(unit, bounds_of<kind, separated>(unit, Value(input.separation.distance)));
    intervals.store(first, Value(0.0), Value(1.0), found.coefficients);
    const unsigned contact = valid_bits(found.has_contact(), count);
    const unsigned rejected = valid_bits(found.has_no_contact(), count) & ~contact;
    const unsigned zero = valid_bits(found.determinant.crosses_once, count) & ~contact & ~rejected;
    const unsigned rest = first_lanes<Lanes>(count) & ~contact & ~rejected & ~zero;
    const unsigned is_far = far_lanes<separated>(input, unit);
    of_contacts.add(first, contact & ~is_far);
    of_rejected.add(first, rejected);
    of_zeros.add(first, zero);
    of_rest.add(first, rest & ~is_far);
    of_far.add(first, (contact | rest) & is_far);
  }
  const auto crossing = [&](std::size_t place) {
    return intervals.crossing(place, mixed.items[place]);
  };
  of_contacts.for_each([&](std::size_t place) { append<Lanes>(contacts, crossing(place)); });
  of_zeros.for_each([&](std::size_t place) { append<Lanes>(zeros, crossing(place)); });
  append_marked(output.rejected, mixed, of_rejected);
  append_marked(undecided, mixed, of_rest);
  append_marked(far, mixed, of_far);
}

}  // namespace touchstone::fast::kernel
