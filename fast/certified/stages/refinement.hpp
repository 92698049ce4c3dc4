#pragma once

/// \file
/// Stage 7, refinement: the enclosure of the time of impact (docs/theory.md, section 6.8).
///
/// The time of impact is the only zero of det in an interval (crossing.hpp). Newton's method
/// approximates it. An enclosure of the requested width around it, clipped to the interval, is
/// correct if det, in double-double, has the signs of the interval's ends at its own ends, beyond
/// the error bound. If not, a second enclosure is tried around the zero of the line through these
/// two values.
///
/// **With a minimum separation** D, let b be the greatest change of det by a shift of D
/// (moving_vectors.hpp). det, det + b and det − b cross zero once each on an interval on which the
/// coefficients of det, with widened bounds, change sign once. So there is no contact up to a time
/// at which det is still more than b away from 0, and the zero of det is a contact, at distance 0.
/// If the enclosure holds with bounds widened by b, it contains the time of impact. If not, the
/// time of impact is earlier by more than the width of the enclosure: det proves only a time up to
/// which there is no contact, and distance_enclosure.hpp continues from there.

#include <array>
#include <cstddef>

#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/distance_enclosure.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"
#include "touchstone/filters/double_double.hpp"
#include "touchstone/filters/error_bounds.hpp"

namespace touchstone::fast::kernel {

/// An upper bound of the underflow part of an error: negligible in any scene.
inline constexpr double double_double_underflow =
    filters::determinant_end_double_double.underflow(StageFormat<double>::limits.difference);
static_assert(StageFormat<double>::limits.difference <=
              filters::determinant_end_double_double.greatest_x);
/// The factor of the bounds of det that also covers a part of det at t=0 (fast/cells/stages.hpp).
inline constexpr double kept_growth = 5.0;

/// det in double-double, at any time; less the part of det at t=0 that is to be kept, if any
/// (fast/cells/stages.hpp has the bound).
template <class Value, bool separated, ContactKind kind>
class PreciseDeterminant {
 public:
  PreciseDeterminant(const std::array<Vector<Value>, query_points>& x, const Value& distance,
                     double kept)
      : distance_(distance), kept_(kept) {
    constexpr auto ends = ends_of_vectors<kind>();
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Precise difference =
              filters::exact_difference(x[4 * end + ends[i][0]][k], x[4 * end + ends[i][1]][k]);
          coordinates_[9 * end + 3 * i + k] = difference;
          magnitudes_[i] = max(magnitudes_[i], abs(difference.high));
        }
      }
    }
    bound_ =
        determinant_bound<separated>(magnitudes_, filters::determinant_end_double_double.rounding(),
                                     double_double_underflow, distance, shift_of_value<double>);
    if (kept_ == 0.0) return;
    bound_ = bound_ * Value(kept_growth);
    of_start_ = evaluate(Value(0.0)) * Precise{Value(kept_), Value(0.0)};
  }

  [[nodiscard]] Value at(const Value& time) const {
    const Precise value = evaluate(time);
    return kept_ == 0.0 ? value.high : (value - of_start_).high;
  }

  [[nodiscard]] const Value& bound() const { return bound_; }
  /// The bound of det if computed in double, from its coefficients on any interval.
  [[nodiscard]] Value rough_bound() const {
    return determinant_bound<separated>(magnitudes_, distance_, shift_of_value<double>);
  }

 private:
  using Precise = filters::DoubleDouble<Value>;

  TOUCHSTONE_INLINE_CALLS [[nodiscard]] Precise evaluate(const Value& time) const {
    const Precise end{time, Value(0.0)};
    const Precise start = filters::exact_difference(Value(1.0), time);
    return filters::DeterminantEnd::evaluate<Precise>(coordinates_,
                                                      {start, end, start, end, start, end});
  }

  std::array<Precise, filters::DeterminantEnd::coordinates> coordinates_;
  std::array<Value, 3> magnitudes_{Value(0.0), Value(0.0), Value(0.0)};
  Value distance_;
  Value bound_;
  double kept_;
  Precise of_start_{Value(0.0), Value(0.0)};
};

/// u and v of the contact at a time, from the orientations, which are proportional to the
/// barycentric coordinates.
template <ContactKind kind, class Value>
inline std::array<Value, 2> contact(const std::array<Vector<Value>, query_points>& x,
                                    const Value& time) {
  constexpr auto ends = ends_of_vectors<kind>();
  constexpr auto all_orientations = orientations<kind>();
  std::array<Vector<Value>, vector_count> at;
  for (std::size_t i = 0; i < vector_count; ++i) {
    at[i] = filters::at_time(minus(x[ends[i][0]], x[ends[i][1]]),
                             minus(x[4 + ends[i][0]], x[4 + ends[i][1]]), Value(1.0) - time, time);
  }
  const Vector<Value> d = filters::cross(at[p], at[q]);
  std::array<Value, all_orientations.size()> o;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const auto [first, second, is_negative] = all_orientations[i];
    const Value value = filters::dot(at[first], filters::cross(d, at[second]));
    o[i] = max(is_negative ? Value(0.0) - value : value, Value(0.0));
  }
  const Value one(1.0);
  if constexpr (kind == ContactKind::vertex_face) {
    const Value sum = o[0] + o[1] + o[2];
    const Value u = min(o[1] / sum, one);
    return {u, min(o[0] / sum, one - u)};
  } else {
    return {min(o[1] / (o[1] + o[2]), one), min(o[0] / (o[0] + o[3]), one)};
  }
}

template <class Lanes, bool separated, ContactKind kind, class Source>
class Refinement {
 public:
  /// \param unproved The queries without an enclosure.
  template <class Input, class Output>
  static void run(const Input& input, const Crossings& crossings, Indices& unproved,
                  Output& output) {
    Approaches approaches;
    approaches.count = 0;
    for (std::size_t first = 0; first < crossings.count; first += Lanes::width) {
      refine_lanes(input, crossings.items.data() + first, taken<Lanes>(first, crossings.count),
                   approaches, unproved, output);
    }
    if constexpr (separated) {
      with_norm(input.separation.norm, [&]<Norm norm>() {
        DistanceEnclosure<Lanes, kind, norm, Source>::run(input, approaches, unproved, output);
      });
    }
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Determinant = PreciseDeterminant<Value, separated, kind>;
  using PointsOfLanes = std::array<Vector<Value>, query_points>;
  using Numbered = std::array<std::uint32_t, Lanes::width>;

  /// The determinant of contacts, or of a volume.
  static Determinant determinant_of(const KernelInput& input, const PointsOfLanes& points) {
    return {points, Value(input.separation.distance), 0.0};
  }
  static Determinant determinant_of(const CellInput& input, const PointsOfLanes& points) {
    return {points, Value(0.0), input.kept_volume};
  }

  static void store(KernelOutput& output, const Numbered& indices, unsigned lanes,
                    const std::array<Value, 2>& enclosure, const PointsOfLanes& points,
                    const Value& time) {
    store_impacts<Lanes>(output, indices, lanes, enclosure, contact<kind>(points, time));
  }
  static void store(CellOutput& output, const Numbered& indices, unsigned lanes,
                    const std::array<Value, 2>& enclosure, const PointsOfLanes& /*points*/,
                    const Value& /*time*/) {
    alignas(64) std::array<Numbers<Lanes>, 2> rows;
    enclosure[0].store(rows[0].data());
    enclosure[1].store(rows[1].data());
    for_each_lane(lanes, [&](std::size_t lane) {
      append<Lanes>(output.inversions,
                    KernelInversion{indices[lane], rows[0][lane], rows[1][lane]});
    });
  }

  template <class Input, class Output>
  static void refine_lanes(const Input& input, const Crossing* crossings, std::size_t count,
                           Approaches& approaches, Indices& unproved, Output& output) {
    const CrossingLanes<Lanes> lanes(crossings, count);
    const PointsOfLanes points = load<Lanes, Source>(input, lanes.indices.data(), Lanes::width);
    const Determinant determinant = determinant_of(input, points);
    const Value half_width(0.4 * input.toi_tolerance);
    const Value zero = lanes.cubic.zero(0x1p-26);
    const Value newton = lanes.begin + lanes.length * zero;
    if constexpr (separated) {
      const Mask can_do =
          lanes.cubic.slope(zero) * newton * half_width > determinant.bound() * lanes.length;
      if (valid_bits(can_do, count) == 0) {
        keep_approaches(lanes, determinant, zero, first_lanes<Lanes>(count), approaches);
        return;
      }
    }
    Enclosure found(determinant, lanes, newton, half_width);
    if (valid_bits(found.proved, count) != first_lanes<Lanes>(count)) {
      found = found.or_else(Enclosure(determinant, lanes, found.corrected(), half_width));
    }
    const unsigned proved = valid_bits(found.proved, count);
    store(output, lanes.indices, proved, {found.lower, found.upper}, points, found.toi);
    if constexpr (separated) {
      keep_approaches(lanes, determinant, zero, first_lanes<Lanes>(count) & ~proved, approaches);
    } else {
      append_lanes<Lanes>(unproved, lanes.indices, first_lanes<Lanes>(count) & ~proved);
    }
  }

  /// The time up to which det proves that there is no contact: its value there is less than −b by
  /// more than the bound of its coefficients and the error of their sum. The weights of the sum add
  /// up to 1, with a rounding error of 12 u, less than 2^-48; and the error of the time is up to 3
  /// · 2^-53, in which det changes by 18 · 2^-53 coefficients for an interval of length 1.
  static void keep_approaches(const CrossingLanes<Lanes>& lanes, const Determinant& determinant,
                              const Value& zero, unsigned bits, Approaches& approaches) {
    const Value bound = determinant.rough_bound() +
                        lanes.cubic.magnitude() * (Value(0x1p-48) + Value(0x1p-48) / lanes.length);
    const Value s = zero - Value(2.0) * bound / lanes.cubic.slope(zero);
    const Mask proved =
        (s > Value(0.0)) & (s <= Value(1.0)) & (lanes.cubic.at(s) < Value(0.0) - bound);
    const Value begin = select(proved, to_exact(lanes.begin + lanes.length * s), lanes.begin);
    alignas(sizeof(Numbers<Lanes>)) Numbers<Lanes> begins;
    begin.store(begins.data());
    for_each_lane(bits, [&](std::size_t lane) {
      append<Lanes>(approaches, Approach{lanes.indices[lane], begins[lane], begins[lane]});
    });
  }

  /// An interval around an approximation of the zero, with det at its ends.
  struct Enclosure {
    Value toi;
    Value lower;
    Value upper;
    Value at_lower;  ///< det there, made rising
    Value at_upper;
    Mask proved;  ///< the zero is in it

    Enclosure(const Determinant& determinant, const CrossingLanes<Lanes>& lanes,
              const Value& around, const Value& half_width)
        : toi(around),
          lower(max(around - around * half_width, lanes.begin)),
          upper(min(around + around * half_width, lanes.begin + lanes.length)),
          at_lower(lanes.sign * determinant.at(lower)),
          at_upper(lanes.sign * determinant.at(upper)),
          proved((at_lower < Value(0.0) - determinant.bound()) & (at_upper > determinant.bound())) {
    }

    /// The zero of the line through det's values at the ends.
    [[nodiscard]] Value corrected() const {
      const Value rise = at_upper - at_lower;
      return select(rise > Value(0.0), lower - at_lower * (upper - lower) / rise, toi);
    }

    /// This enclosure in the lanes in which it is proved, the other one elsewhere.
    [[nodiscard]] Enclosure or_else(const Enclosure& other) const {
      Enclosure result = other;
      result.toi = select(proved, toi, other.toi);
      result.lower = select(proved, lower, other.lower);
      result.upper = select(proved, upper, other.upper);
      result.proved = proved | other.proved;
      return result;
    }
  };
};

}  // namespace touchstone::fast::kernel
