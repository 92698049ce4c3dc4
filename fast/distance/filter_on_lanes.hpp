#pragma once

/// \file
/// The filter of distances in L2 (filtered_distance.hpp), written once for lanes, with one
/// query in each lane. Only the kernels include this file, one file for each instruction set
/// (filter_*.cpp).
///
/// The nearest feature of each lane is guessed in doubles. Corners are rotated so that it begins at
/// the first: vertex 0, side 0 1, or the face. Each of the three is then evaluated for all lanes if
/// one lane needs it. The first double to compare with is the root of the quotient, the second
/// its neighbour on the side of the distance. Queries that these two do not decide remain open, and
/// so do special ones: with coincident points, or with a size that would need scaling.
///
/// `Lanes` is a type of the file of one instruction set, in an anonymous namespace, with Value and
/// Mask as in fast/certified/stages/lanes.hpp. No other file may link code from here.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "fast/distance/filter_kernel.hpp"
#include "fast/distance/polygon_features.hpp"
#include "touchstone/filters/ball.hpp"

namespace touchstone::fast::distance_filter {

template <class Lanes, ContactKind kind>
class Filter {
 public:
  static void run(const Query* queries, std::size_t count, double t, Distance* results) {
    for (std::size_t first = 0; first < count; first += width) {
      const std::size_t taken = count - first < width ? count - first : width;
      answer(queries + first, taken, t, results + first);
    }
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Number = filters::BallOf<Value>;
  using Polygon = polygon::Polygon<Number>;
  using Guess = polygon::Polygon<Value>;
  using Numbers = std::array<double, Lanes::width>;

  static constexpr std::size_t width = Lanes::width;
  static constexpr std::size_t corner_count = kind == ContactKind::vertex_face ? 3 : 4;

  TOUCHSTONE_INLINE_CALLS static void answer(const Query* queries, std::size_t count, double t,
                                             Distance* results) {
    const Polygon p = polygon_at(queries, count, t);
    const Filter filter(p);
    const Value guess = filter.guess();
    const Mask above = filter.is_beyond(guess), below = filter.is_within(guess);
    alignas(64) Numbers first, second;
    guess.store(first.data());
    const unsigned goes_up = above.bits();
    for (std::size_t i = 0; i < width; ++i)
      second[i] = neighbour(first[i], (goes_up >> i & 1U) != 0);
    const Value other = Value::load(second.data());
    Mask is_proved = Mask::none();
    if (goes_up != 0) is_proved = above & filter.is_within(other);
    if (below.bits() != 0) is_proved = is_proved | (below & filter.is_beyond(other));
    const unsigned sure = is_proved.bits();
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_sure = (sure >> i & 1U) != 0 && is_plain(queries[i]);
      const bool is_up = (goes_up >> i & 1U) != 0;
      results[i].lower = is_sure ? (is_up ? first[i] : second[i]) : open_distance.lower;
      results[i].upper = is_sure ? (is_up ? second[i] : first[i]) : open_distance.upper;
    }
  }

  /// The next double or the one before. \pre x is positive, or the result is not used.
  static double neighbour(double x, bool is_up) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return std::bit_cast<double>(is_up ? bits + 1 : bits - 1);
  }

  // ---- Queries ----

  /// True if its coordinates need no scaling and its corners are different.
  static bool is_plain(const Query& query) {
    constexpr double usual = 0x1p64;
    double greatest = 0.0;
    for (const double coordinate : query.coordinates) {
      const double x = __builtin_fabs(coordinate);
      greatest = x > greatest ? x : greatest;
    }
    if (!(greatest <= usual && greatest >= 1.0 / usual)) return false;
    const auto same = [&](std::size_t a, std::size_t b) {
      bool result = true;
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          result = result && query.at(end, a, axis) == query.at(end, b, axis);
        }
      }
      return result;
    };
    if (kind == ContactKind::edge_edge) return !same(0, 1) && !same(2, 3);
    return !same(1, 2) && !same(2, 3) && !same(3, 1);
  }

  static Polygon polygon_at(const Query* queries, std::size_t count, double t) {
    std::array<std::array<std::array<Value, 3>, moving_points>, 2> x;
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          alignas(64) Numbers lanes;
          for (std::size_t i = 0; i < width; ++i) {
            lanes[i] = queries[i < count ? i : count - 1].at(end, point, axis);
          }
          x[end][point][axis] = Value::load(lanes.data());
        }
      }
    }
    const Number weight_of_end(t);
    const Number weight_of_start(filters::exact_difference(Value(1.0), Value(t)));
    constexpr auto of_kind = corners_of_kind();
    Polygon result;
    result.count = corner_count;
    for (std::size_t i = 0; i < corner_count; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at_end = [&](std::size_t end) {
          return Number(filters::exact_difference(x[end][of_kind[i].plus][axis],
                                                  x[end][of_kind[i].minus][axis]));
        };
        Number& to = result.corner[i][axis];
        if (t == 0.0) {
          to = at_end(0);
        } else if (t == 1.0) {
          to = at_end(1);
        } else {
          to = weight_of_start * at_end(0) + weight_of_end * at_end(1);
        }
      }
    }
    return result;
  }

  static constexpr std::array<Corner, corner_count> corners_of_kind() {
    if constexpr (kind == ContactKind::vertex_face) {
      return vertex_face_corners;
    } else {
      return edge_edge_corners;
    }
  }

  // ---- The nearest feature ----

  static Number chosen(const Mask& mask, const Number& a, const Number& b) {
    return {{select(mask, a.center.high, b.center.high), select(mask, a.center.low, b.center.low)},
            select(mask, a.radius, b.radius)};
  }

  explicit Filter(const Polygon& p) {
    guess_feature(p);
    rotate(p);
    const Mask is_vertex = kind_of_feature_ == Value(0.0), is_side = kind_of_feature_ == Value(1.0);
    const Mask is_face = kind_of_feature_ == Value(2.0);
    if (is_face.bits() != 0) set_face();
    if (is_side.bits() != 0) set_side(is_side);
    if (is_vertex.bits() != 0) set_vertex(is_vertex);
  }

  /// kind_of_feature_: 0 vertex, 1 side, 2 face; first_: its first corner.
  void guess_feature(const Polygon& p) {
    Guess guess;
    guess.count = corner_count;
    for (std::size_t i = 0; i < corner_count; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        guess.corner[i][axis] = p.corner[i][axis].center.high;
      }
    }
    const Value zero(0.0);
    Value least(0x1p1000);
    kind_of_feature_ = first_ = zero;
    const auto consider = [&](const Mask& may_be, const Value& square, double feature,
                              std::size_t first) {
      const Mask is_nearer = may_be & (square < least);
      least = select(is_nearer, square, least);
      kind_of_feature_ = select(is_nearer, Value(feature), kind_of_feature_);
      first_ = select(is_nearer, Value(static_cast<double>(first)), first_);
    };
    for (std::size_t i = 0; i < corner_count; ++i) {
      consider(Mask::all(), filters::dot(guess.corner[i], guess.corner[i]), 0.0, i);
      const auto side = polygon::side(guess, i);
      consider((side.from < zero) & (side.to > zero), side.area / side.square, 1.0, i);
    }
    const auto face = polygon::face(guess);
    Mask is_inside = face.square > polygon::square_of_thin_normal(guess);
    for (std::size_t i = 0; i < corner_count; ++i) is_inside = is_inside & (face.turns[i] >= zero);
    kind_of_feature_ = select(is_inside, Value(2.0), kind_of_feature_);
    first_ = select(is_inside, zero, first_);
  }

  void rotate(const Polygon& p) {
    polygon_ = p;
    for (std::size_t first = 1; first < corner_count; ++first) {
      const Mask here = first_ == Value(static_cast<double>(first));
      if (here.bits() == 0) continue;
      for (std::size_t i = 0; i < corner_count; ++i) {
        const auto& from = p.corner[(first + i) % corner_count];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          polygon_.corner[i][axis] = chosen(here, from[axis], polygon_.corner[i][axis]);
        }
      }
    }
  }

  void set_face() {
    const auto face = polygon::face(polygon_);
    value_ = face.height * face.height;
    square_ = face.square;
    is_attained_ = Mask::all();
    for (std::size_t i = 0; i < corner_count; ++i) {
      is_attained_ = is_attained_ & is_positive(face.turns[i]);
    }
    for (Number& other : others_) other = value_ + value_;
  }

  void set_side(const Mask& here) {
    const auto side = polygon::side(polygon_, 0);
    value_ = chosen(here, side.area, value_);
    square_ = chosen(here, side.square, square_);
    is_attained_ = chosen_mask(here, is_positive(-side.from) & is_positive(side.to), is_attained_);
    others_[0] = chosen(here, side.area + side.area, others_[0]);
    for (std::size_t k = 2; k < corner_count; ++k) {
      const Number other = filters::dot(side.m, filters::cross(polygon_.corner[k], side.e));
      others_[k - 1] = chosen(here, other, others_[k - 1]);
    }
  }

  void set_vertex(const Mask& here) {
    const auto& w = polygon_.corner;
    value_ = chosen(here, filters::dot(w[0], w[0]), value_);
    square_ = chosen(here, Number(1.0), square_);
    is_attained_ = here | is_attained_;
    for (std::size_t k = 1; k < corner_count; ++k) {
      others_[k - 1] = chosen(here, filters::dot(w[0], w[k]), others_[k - 1]);
    }
  }

  static Mask chosen_mask(const Mask& mask, const Mask& a, const Mask& b) {
    return select(mask, select(a, Value(1.0), Value(0.0)), select(b, Value(1.0), Value(0.0))) >
           Value(0.0);
  }

  // ---- Comparing ----

  [[nodiscard]] Value guess() const { return sqrt(value_.center.high / square_.center.high); }

  /// Theorem 2 of polygon_features.hpp.
  [[nodiscard]] Mask is_beyond(const Value& s) const {
    const Number threshold = squared(s) * square_;
    Mask result = is_positive(value_ - threshold);
    const Number least = threshold * value_;
    for (const Number& other : others_) {
      result = result & (is_positive(other - value_) |
                         (is_positive(other) & is_positive(other * other - least)));
    }
    return result;
  }

  /// Theorem 1.
  [[nodiscard]] Mask is_within(const Value& s) const {
    return is_attained_ & is_positive(squared(s) * square_ - value_);
  }

  static Number squared(const Value& s) {
    const Number exact(filters::DoubleDouble<Value>{s, Value(0.0)});
    return exact * exact;
  }

  Value kind_of_feature_;
  Value first_;
  Polygon polygon_;  ///< rotated
  Number value_, square_;
  Mask is_attained_ = Mask::none();
  std::array<Number, corner_count - 1> others_;
};

template <class Lanes>
void filter(ContactKind kind, const Query* queries, std::size_t count, double t,
            Distance* results) {
  if (kind == ContactKind::vertex_face) {
    Filter<Lanes, ContactKind::vertex_face>::run(queries, count, t, results);
  } else {
    Filter<Lanes, ContactKind::edge_edge>::run(queries, count, t, results);
  }
}

}  // namespace touchstone::fast::distance_filter

namespace touchstone::fast {

template <class Lanes>
constexpr DistanceKernel distance_kernel_on(InstructionSet instructions) {
  return {.instructions = instructions,
          .filter = distance_filter::filter<Lanes>,
          .product_then_sum = product_then_sum<Lanes>};
}

}  // namespace touchstone::fast
