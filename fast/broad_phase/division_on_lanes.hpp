#pragma once

/// \file
/// Division of seeds in two, by rank, along the axis of the greatest spread of their centres.
/// The template for sixteen lanes is included by one file per instruction set (search_*.cpp), like
/// search_on_lanes.hpp.
///
/// The result depends on comparisons of coordinates and on a few scalar operations, which are the
/// same for all instruction sets. Seeds keep their order on either side. The result is therefore
/// the same everywhere.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/seeds.hpp"

namespace touchstone::fast::division {

/// Divides seeds. \tparam Lanes as in search_on_lanes.hpp
template <class Lanes>
class Division {
 public:
  explicit Division(const SeedPart& part) : part_(part) {}

  void run(std::size_t rank) {
    choose_axis();
    cut(rank);
    move();
  }

 private:
  using Value = typename Lanes::Value;
  static constexpr std::size_t lanes = 16;

  // ---- The axis ----

  /// Sets the axis, and the least and the greatest coordinate there.
  void choose_axis() {
    float widest = -1.0F;
    for (const float* const coordinates : part_.seeds.centres) {
      const auto [lower, upper] = range(coordinates);
      if (upper - lower > widest) {
        widest = upper - lower;
        coordinates_ = coordinates;
        lower_ = lower;
        upper_ = upper;
      }
    }
  }

  struct Range {
    float lower;
    float upper;
  };

  [[nodiscard]] Range range(const float* coordinates) const {
    Value lower = Value::load(coordinates + (part_.count - lanes)), upper = lower;
    for (std::size_t i = 0; i + lanes <= part_.count; i += lanes) {
      const Value some = Value::load(coordinates + i);
      lower = min(lower, some);
      upper = max(upper, some);
    }
    alignas(64) std::array<float, lanes> lowest;
    alignas(64) std::array<float, lanes> uppermost;
    lower.store(lowest.data());
    upper.store(uppermost.data());
    Range result{lowest[0], uppermost[0]};
    for (std::size_t i = 1; i < lanes; ++i) {
      result.lower = lowest[i] < result.lower ? lowest[i] : result.lower;
      result.upper = uppermost[i] > result.upper ? uppermost[i] : result.upper;
    }
    return result;
  }

  // ---- The cut ----

  [[nodiscard]] std::size_t count_below(float pivot) const {
    std::int32_t count = 0;
    for (std::size_t i = 0; i < part_.count; ++i) count += coordinates_[i] < pivot ? 1 : 0;
    return static_cast<std::size_t>(count);
  }

  /// Sets the cut: `rank` seeds are below the pivot or among the first ones at it. The first few
  /// pivots are interpolated (by the Illinois method), which suffices unless the coordinates are of
  /// very different size; the others bisect the remaining floats. \pre 0 < rank < count
  void cut(std::size_t rank) {
    static constexpr int interpolated = 8;
    // Fewer than `rank` are below `from` and more below `to`, by these numbers or by halves of
    // them.
    float from = lower_, to = float_after(upper_);
    auto missing = static_cast<double>(rank);
    auto excess = static_cast<double>(part_.count - rank);
    std::size_t below = 0;
    bool was_below = false;
    for (int attempt = 0; float_after(from) < to; ++attempt) {
      pivot_ = attempt < interpolated ? between(from, to, missing / (missing + excess))
                                      : float_at(middle(order_of(from), order_of(to)));
      const std::size_t count = count_below(pivot_);
      at_pivot_ = 0;
      if (count == rank) return;
      const bool is_below = count < rank;
      const bool is_again = attempt > 0 && is_below == was_below;
      was_below = is_below;
      if (is_below) {
        from = pivot_;
        below = count;
        missing = static_cast<double>(rank - count);
        if (is_again) excess /= 2.0;
      } else {
        to = pivot_;
        excess = static_cast<double>(count - rank);
        if (is_again) missing /= 2.0;
      }
    }
    pivot_ = from;
    at_pivot_ = rank - below;
  }

  static std::int32_t middle(std::int64_t a, std::int64_t b) {
    return static_cast<std::int32_t>((a + b) / 2);
  }

  /// A float strictly between two that are not neighbours, at about that part of the way.
  static float between(float from, float to, double part) {
    const float pivot = from + (to - from) * static_cast<float>(part);
    if (!(pivot > from)) return float_after(from);
    return pivot < to ? pivot : float_before(to);
  }

  // ---- Moving ----

  /// Moves the seeds before the cut to the front, over seeds already read, and the others to the
  /// second buffer.
  void move() {
    const Value pivot(pivot_);
    std::size_t in_front = 0, behind = 0;
    for (std::size_t i = 0; i < part_.count; i += lanes) {
      const std::size_t rest = part_.count - i;
      const unsigned valid = rest < lanes ? (1U << rest) - 1U : 0xFFFFU;
      const Value coordinates = Value::load(coordinates_ + i);
      unsigned front = (pivot > coordinates).bits() & valid;
      if (at_pivot_ > 0) front |= first_at_pivot((pivot == coordinates).bits() & valid);
      const unsigned back = valid & ~front;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float* const from = part_.seeds.centres[axis];
        const auto words = Lanes::load_words(from + i);
        Lanes::write(from + in_front, words, front);
        Lanes::write(part_.scratch.centres[axis] + behind, words, back);
      }
      const auto words = Lanes::load_words(part_.seeds.numbers + i);
      Lanes::write(part_.seeds.numbers + in_front, words, front);
      Lanes::write(part_.scratch.numbers + behind, words, back);
      in_front += static_cast<std::size_t>(__builtin_popcount(front));
      behind += static_cast<std::size_t>(__builtin_popcount(back));
    }
  }

  /// The first of the lanes at the pivot, as many as are still needed.
  unsigned first_at_pivot(unsigned equal) {
    unsigned result = 0;
    for (; equal != 0 && at_pivot_ > 0; equal &= equal - 1) {
      result |= equal & (0U - equal);
      --at_pivot_;
    }
    return result;
  }

  const SeedPart& part_;
  const float* coordinates_ = nullptr;  ///< on the axis
  float lower_ = 0.0F;
  float upper_ = 0.0F;
  float pivot_ = 0.0F;
  std::size_t at_pivot_ = 0;
};

template <class Lanes>
void divide(const SeedPart& part, std::size_t rank) {
  Division<Lanes>(part).run(rank);
}

}  // namespace touchstone::fast::division
