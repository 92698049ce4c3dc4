#pragma once

/// \file
/// Zeros of the determinant that are alone in an interval of times, and their approximation, which
/// has no error bound.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/lanes.hpp"

namespace touchstone::fast::kernel {

/// An interval [begin, begin + length] with exactly one zero of det and no contact before it.
struct Crossing {
  std::uint32_t index;
  double begin;
  double length;
  /// d0, 3 d1, 3 d2, d3 of the Bernstein coefficients there.
  std::array<double, 4> determinant;
};
using Crossings = KernelList<Crossing>;

/// Intervals of a list of queries, with the coefficients of det, in memory.
template <class Lanes>
class Intervals {
 public:
  using Value = typename Lanes::Value;

  /// The crossings from place `first` on, a multiple of the width.
  void store(std::size_t first, const Value& begin, const Value& length,
             const std::array<Value, 4>& coefficients) {
    Rows& rows = groups_[first / Lanes::width];
    begin.store(rows[0].data());
    length.store(rows[1].data());
    for (std::size_t i = 0; i < 4; ++i) coefficients[i].store(rows[2 + i].data());
  }

  [[nodiscard]] Crossing crossing(std::size_t place, std::uint32_t index) const {
    const Rows& rows = groups_[place / Lanes::width];
    const std::size_t lane = place % Lanes::width;
    return {index,
            rows[0][lane],
            rows[1][lane],
            {rows[2][lane], rows[3][lane], rows[4][lane], rows[5][lane]}};
  }

 private:
  using Rows = std::array<Numbers<Lanes>, 6>;
  alignas(sizeof(Numbers<Lanes>)) std::array<Rows, groups_of_block<Lanes>> groups_;
};

/// det on an interval as a rising cubic of s ∈ [0,1].
template <class Value>
struct Cubic {
  std::array<Value, 4> c;  ///< d0, 3 d1, 3 d2, d3

  [[nodiscard]] Value at(const Value& s) const {
    const Value m = Value(1.0) - s;
    return m * m * (c[0] * m + c[1] * s) + s * s * (c[2] * m + c[3] * s);
  }
  [[nodiscard]] Value slope(const Value& s) const {
    const Value m = Value(1.0) - s, three(3.0);
    const Value first = c[1] - three * c[0], second = c[2] - c[1], third = three * c[3] - c[2];
    return m * m * first + (m * s + m * s) * second + s * s * third;
  }

  [[nodiscard]] Value magnitude() const {
    return max(max(abs(c[0]), abs(c[1])), max(abs(c[2]), abs(c[3])));
  }

  /// The zero by Newton's method, with bisection if a step would leave the interval. A lane stops
  /// after a step of at most `enough`, so its result does not depend on the other lanes.
  [[nodiscard]] Value zero(double enough) const {
    using Mask = MaskOf<Value>;
    constexpr int most_steps = 8;
    Value low(0.0), high(1.0), s = c[0] / (c[0] - c[3]);
    Mask moves = Mask::all();
    for (int i = 0; i < most_steps && moves.bits() != 0; ++i) {
      const Value value = at(s);
      const Mask before = value < Value(0.0);
      low = select(before, s, low);
      high = select(before, high, s);
      const Value newton = s - value / slope(s);
      const Value next =
          select((newton >= low) & (newton <= high), newton, (low + high) * Value(0.5));
      const Value step = abs(next - s);
      s = select(moves, next, s);
      moves = moves & (step > Value(enough));
    }
    return s;
  }
};

/// The crossings of `width` queries, lane by lane. Lanes beyond `count` repeat the last.
template <class Lanes>
struct CrossingLanes {
  using Value = typename Lanes::Value;

  std::array<std::uint32_t, Lanes::width> indices;
  Value begin{0.0};
  Value length{0.0};
  Value sign{0.0};  ///< the sign with which det rises
  Cubic<Value> cubic{};

  CrossingLanes(const Crossing* crossings, std::size_t count) {
    alignas(64) std::array<Numbers<Lanes>, 7> rows;
    for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
      const Crossing& crossing = crossings[lane < count ? lane : count - 1];
      indices[lane] = crossing.index;
      rows[0][lane] = crossing.begin;
      rows[1][lane] = crossing.length;
      rows[2][lane] = crossing.determinant[0] < 0 ? 1.0 : -1.0;
      for (std::size_t i = 0; i < 4; ++i) rows[3 + i][lane] = crossing.determinant[i];
    }
    begin = Value::load(rows[0].data());
    length = Value::load(rows[1].data());
    sign = Value::load(rows[2].data());
    for (std::size_t i = 0; i < 4; ++i) cubic.c[i] = sign * Value::load(rows[3 + i].data());
  }
};

}  // namespace touchstone::fast::kernel
