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
/// **Up to a time.** Where only contacts up to a time T < 1 count, the queries that no axis
/// separates are tested again, with the points at T in place of those at t=1. Let u = 2^-53 and m
/// the greatest magnitude of a coordinate on the axis. A position (1 − T) x0 + T x1 has an error of
/// at most u m / 2 by the rounding of 1 − T and of (2 u + u²) m + 2^-1074 by that of two products
/// and a sum. The difference of two positions has to exceed D by `slack`, 8 u m + 2^-1070, which is
/// more than twice these errors, and monotone rounding does the rest. Where positions might
/// overflow, slack is infinite.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/lanes.hpp"

namespace touchstone::fast::kernel {

template <class Lanes, bool separated, Kind kind, class Source>
class AxisStage {
 public:
  /// \param open The queries that no axis separates.
  static void run(const KernelInput& input, Indices& open) {
    if constexpr (Source::is_one) {
      const bool is_free = is_separated(Source::points(input, 0), Row(input.separation.distance));
      open.items[0] = 0;
      open.count = is_free ? 0 : 1;
    } else {
      find_open(input, open);
    }
    if (input.t_limit < 1.0) keep_open_until(input, open);
  }

 private:
  using Row = typename Lanes::Row;
  using RowMask = typename Lanes::RowMask;
  static constexpr std::size_t word_size = Marks<Lanes>::word_size;

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
        words[k] |= std::uint64_t{!is_separated(points, distance)} << i;
      }
    }
    for (std::size_t k = 0; k < word_count; ++k) {
      marks.set_word(first + k * word_size, words[k]);
    }
  }

  /// True if an axis separates the query. False for coordinates that are not finite, which later
  /// stages report.
  static bool is_separated(const Points& points, const Row& distance) {
    const Rows rows = load_rows(points);
    const Sides start = sides<separated>(rows[0], rows[1], rows[2], rows[3], distance);
    const Sides end = sides<separated>(rows[4], rows[5], rows[6], rows[7], distance);
    return is_separated(start, end, rows);
  }

  using Rows = std::array<Row, query_points>;

  static Rows load_rows(const Points& points) {
    Rows rows;
    for (std::size_t k = 0; k + 1 < query_points; ++k) rows[k] = Row::load(points[k]);
    rows[7] = Source::may_read_behind ? Row::load(points[7]) : Row::load_backwards(points[7]);
    return rows;
  }

  // ---- Up to a time ----

  /// Keeps the queries that no axis separates up to t_limit.
  static void keep_open_until(const KernelInput& input, Indices& open) {
    const Row distance(input.separation.distance);
    const Row of_start(1.0 - input.t_limit), of_end(input.t_limit);
    std::size_t count = 0;
    for (std::size_t i = 0; i < open.count; ++i) {
      const std::uint32_t index = open.items[i];
      open.items[count] = index;
      const Points points = Source::points(input, index);
      count += std::size_t{!is_separated_until(points, distance, of_start, of_end)};
    }
    open.count = count;
  }

  /// \param of_start, of_end the weights of the points at t=0 and at t=1
  static bool is_separated_until(const Points& points, const Row& distance, const Row& of_start,
                                 const Row& of_end) {
    const Rows rows = load_rows(points);
    Row least = rows[0], most = rows[0];
    for (std::size_t k = 1; k < query_points; ++k) {
      least = min(least, rows[k]);
      most = max(most, rows[k]);
    }
    const Row magnitude = max(most, Row(0.0) - least);
    const Row slack = magnitude * Row(0x1p50) * Row(0x1p-100) + Row(0x1p-1070);
    std::array<Row, moving_points> x;
    for (std::size_t k = 0; k < moving_points; ++k) {
      x[k] = rows[k] * of_start + rows[moving_points + k] * of_end;
    }
    const Sides start = sides<separated>(rows[0], rows[1], rows[2], rows[3], distance);
    const Sides end = sides<true>(x[0], x[1], x[2], x[3], distance + slack);
    return is_separated(start, end, rows);
  }

  // ---- Sides of an axis ----

  /// The axes on which the first primitive is above the second by more than the distance, and those
  /// on which it is below.
  struct Sides {
    RowMask above;
    RowMask below;
  };

  static bool is_separated(const Sides& start, const Sides& end, const Rows& rows) {
    const Row sum =
        ((rows[0] + rows[1]) + (rows[2] + rows[3])) + ((rows[4] + rows[5]) + (rows[6] + rows[7]));
    // Without && because the branch is unpredictable.
    const bool on_one_side = ((start.above & end.above) | (start.below & end.below)).any();
    return on_one_side & sum.is_finite();
  }

  template <bool by_distance>
  static Sides sides(const Row& a, const Row& b, const Row& c, const Row& d, const Row& distance) {
    if constexpr (kind == Kind::vertex_face) {
      return sides_of<by_distance>(a, a, max(max(b, c), d), min(min(b, c), d), distance);
    } else {
      return sides_of<by_distance>(min(a, b), max(a, b), max(c, d), min(c, d), distance);
    }
  }

  template <bool by_distance>
  static Sides sides_of(const Row& least_a, const Row& greatest_a, const Row& greatest_b,
                        const Row& least_b, const Row& distance) {
    if constexpr (by_distance) {
      return {least_a - greatest_b > distance, least_b - greatest_a > distance};
    } else {
      return {least_a > greatest_b, greatest_a < least_b};
    }
  }
};

}  // namespace touchstone::fast::kernel
