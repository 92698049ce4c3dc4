#pragma once

/// \file
/// Stage 1, axis (docs/theory.md, section 6.2).
///
/// **Theorem.** If on some coordinate axis all corners w_i are on the same side of 0 at t=0, and on
/// that side at t=1, there is no contact: they move linearly, so they are always on that side. With
/// a minimum separation D, they have to be farther than D from 0.
///
/// The corners are the differences of the two primitives' points, so the test compares coordinates.
/// No error bound is needed: signs of differences are comparisons, and a rounded difference greater
/// than D comes from an exact one greater than D, because rounding is monotone and D is a double.
///
/// **Up to a time.** If only contacts up to a time T < 1 count, the queries that no axis separates
/// are tested again with the points at T in place of those at t=1 (one query here, several in the
/// lanes of the stage direction). Let u = 2^-53 and m the greatest magnitude of a coordinate on the
/// axis. A position (1 − T) x0 + T x1 has an error of at most u m / 2 by the rounding of 1 − T and
/// of (2 u + u²) m + 2^-1074 by that of two products and a sum. The difference of two positions has
/// to exceed D by `slack`, 8 u m + 2^-1070, which is more than twice these errors, and monotone
/// rounding does the rest. Where positions might overflow, slack is infinite.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/lanes.hpp"

namespace touchstone::fast::kernel {

/// The axes on which the first primitive is above the second by more than the distance, and those
/// on which it is below.
template <class X>
struct Sides {
  MaskOf<X> above;
  MaskOf<X> below;
};

template <bool by_distance, class X>
inline Sides<X> sides_of(const X& least_a, const X& greatest_a, const X& greatest_b,
                         const X& least_b, const X& distance) {
  if constexpr (by_distance) {
    return {least_a - greatest_b > distance, least_b - greatest_a > distance};
  } else {
    return {least_a > greatest_b, greatest_a < least_b};
  }
}

/// The sides of four points: coordinates of one axis or rows of all three.
template <ContactKind kind, bool by_distance, class X>
inline Sides<X> sides(const X& a, const X& b, const X& c, const X& d, const X& distance) {
  if constexpr (kind == ContactKind::vertex_face) {
    return sides_of<by_distance>(a, a, max(max(b, c), d), min(min(b, c), d), distance);
  } else {
    return sides_of<by_distance>(min(a, b), max(a, b), max(c, d), min(c, d), distance);
  }
}

template <class X>
inline MaskOf<X> on_one_side(const Sides<X>& start, const Sides<X>& end) {
  return (start.above & end.above) | (start.below & end.below);
}

/// The sum, which is not finite if one number is not.
template <class X>
inline X sum_of(const std::array<X, query_points>& x) {
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

/// The axes that separate a query up to a time.
template <ContactKind kind, bool separated, class X>
inline MaskOf<X> separating_until(const std::array<X, query_points>& points, const X& distance,
                                  double time) {
  const X of_start(1.0 - time), of_end(time);
  X least = points[0], most = points[0];
  for (std::size_t k = 1; k < query_points; ++k) {
    least = min(least, points[k]);
    most = max(most, points[k]);
  }
  const X magnitude = max(most, X(0.0) - least);
  const X slack = magnitude * X(0x1p50) * X(0x1p-100) + X(0x1p-1070);
  std::array<X, moving_points> x;
  for (std::size_t k = 0; k < moving_points; ++k) {
    x[k] = points[k] * of_start + points[moving_points + k] * of_end;
  }
  return on_one_side(sides<kind, separated>(points[0], points[1], points[2], points[3], distance),
                     sides<kind, true>(x[0], x[1], x[2], x[3], distance + slack));
}

/// The test up to a time for queries in lanes.
template <class Value, bool separated, ContactKind kind>
inline MaskOf<Value> is_separated_until(const std::array<Vector<Value>, query_points>& points,
                                        double distance, double time) {
  const Value zero(0.0);
  MaskOf<Value> apart = zero < zero;
  Value nothing(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<Value, query_points> x;
    for (std::size_t k = 0; k < query_points; ++k) x[k] = points[k][axis];
    apart = apart | separating_until<kind, separated>(x, Value(distance), time);
    const Value sum = sum_of(x);
    nothing = nothing + (sum - sum);
  }
  return apart & (nothing <= zero);
}

template <class Lanes, bool separated, ContactKind kind, class Source>
class AxisStage {
 public:
  /// \param open The queries that no axis separates; for several queries, on the whole [0,1].
  static void run(const KernelInput& input, Indices& open) {
    if constexpr (Source::is_one) {
      open.items[0] = 0;
      open.count = is_free(input) ? 0 : 1;
    } else {
      find_open(input, open);
    }
  }

 private:
  using Row = typename Lanes::Row;
  using Rows = std::array<Row, query_points>;
  static constexpr std::size_t word_size = Marks<Lanes>::word_size;

  /// True if an axis separates the only query.
  static bool is_free(const KernelInput& input) {
    const Rows rows = load_rows(Source::points(input, 0));
    const Row distance(input.separation.distance);
    if (is_separated(rows, distance)) return true;
    if (input.t_limit == 1.0) return false;
    const auto axes = separating_until<kind, separated>(rows, distance, input.t_limit);
    return axes_of(axes) != 0 && is_finite_row(sum_of(rows));
  }

  static void find_open(const KernelInput& input, Indices& open) {
    Marks<Lanes> marks(input.count);
    constexpr std::size_t words = Source::places_at_once;
    std::size_t first = 0;
    for (; first + words * word_size <= input.count; first += words * word_size) {
      mark_open<words>(input, first, word_size, marks);
    }
    for (; first < input.count; first += word_size) {
      const std::size_t rest = input.count - first;
      mark_open<1>(input, first, rest < word_size ? rest : word_size, marks);
    }
    open.count = 0;
    marks.for_each([&](std::size_t i) { append<Lanes>(open, static_cast<std::uint32_t>(i)); });
  }

  /// Marks the queries that no axis separates: `count` in each of some words.
  template <std::size_t word_count>
  static void mark_open(const KernelInput& input, std::size_t first, std::size_t count,
                        Marks<Lanes>& marks) {
    std::array<std::uint64_t, word_count> words{};
    const Row distance(input.separation.distance);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < word_count; ++k) {
        const Points points = Source::points(input, first + k * word_size + i);
        words[k] |= std::uint64_t{!is_separated(load_rows(points), distance)} << i;
      }
    }
    for (std::size_t k = 0; k < word_count; ++k) {
      marks.set_word(first + k * word_size, words[k]);
    }
  }

  static Rows load_rows(const Points& points) {
    Rows rows;
    for (std::size_t k = 0; k + 1 < query_points; ++k) rows[k] = Row::load(points[k]);
    rows[7] = Source::may_read_behind ? Row::load(points[7]) : Lanes::load_row_backwards(points[7]);
    return rows;
  }

  /// True if an axis separates the query. False for coordinates that are not finite, which later
  /// stages report.
  static bool is_separated(const Rows& rows, const Row& distance) {
    const auto axes =
        on_one_side(sides<kind, separated>(rows[0], rows[1], rows[2], rows[3], distance),
                    sides<kind, separated>(rows[4], rows[5], rows[6], rows[7], distance));
    // No && because the branch is unpredictable.
    const bool on_some_axis = axes_of(axes) != 0;
    return on_some_axis & is_finite_row(sum_of(rows));
  }
};

}  // namespace touchstone::fast::kernel
