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

 private:
  using Row = typename Lanes::Row;
  using RowMask = typename Lanes::RowMask;
  static constexpr std::size_t word_size = Marks<Lanes>::word_size;

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
    std::array<Row, query_points> rows;
    for (std::size_t k = 0; k + 1 < query_points; ++k) rows[k] = Row::load(points[k]);
    rows[7] = Source::may_read_behind ? Row::load(points[7]) : Row::load_backwards(points[7]);
    const Sides start = sides(rows[0], rows[1], rows[2], rows[3], distance);
    const Sides end = sides(rows[4], rows[5], rows[6], rows[7], distance);
    const Row sum =
        ((rows[0] + rows[1]) + (rows[2] + rows[3])) + ((rows[4] + rows[5]) + (rows[6] + rows[7]));
    // Without && because the branch is unpredictable.
    const bool on_one_side = ((start.above & end.above) | (start.below & end.below)).any();
    return on_one_side & sum.is_finite();
  }

  /// The axes on which the first primitive is above the second by more than the distance, and those
  /// on which it is below.
  struct Sides {
    RowMask above;
    RowMask below;
  };

  static Sides sides(const Row& a, const Row& b, const Row& c, const Row& d, const Row& distance) {
    if constexpr (kind == Kind::vertex_face) {
      return sides_of(a, a, max(max(b, c), d), min(min(b, c), d), distance);
    } else {
      return sides_of(min(a, b), max(a, b), max(c, d), min(c, d), distance);
    }
  }

  static Sides sides_of(const Row& least_a, const Row& greatest_a, const Row& greatest_b,
                        const Row& least_b, const Row& distance) {
    if constexpr (separated) {
      return {least_a - greatest_b > distance, least_b - greatest_a > distance};
    } else {
      return {least_a > greatest_b, greatest_a < least_b};
    }
  }
};

}  // namespace touchstone::fast::kernel
