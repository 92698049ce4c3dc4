#pragma once

/// \file
/// The enclosure of the time of impact with a minimum separation D > 0 (docs/theory.md,
/// section 6.10), for queries that the stages refinement and conservative advancement followed
/// until just before the contact.
///
/// **Theorem.** The time of impact is in [lower,upper] if there is no contact in [0,lower] (the
/// theorem of moving_polygon.hpp, on the interval from the time up to which this is known) and
/// contact at `upper`: some (u,v) of the domain with ‖F(upper,u,v)‖ ≤ D. The closest point's
/// parameters are tried.
///
/// The two times are so close that the last coefficient and F need double-double.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/closest_point.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_polygon.hpp"
#include "touchstone/filters/double_double.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/separation_expressions.hpp"

namespace touchstone::fast::kernel {

/// A query without contact in [0, begin], and with one close to `time` or before.
struct Approach {
  std::uint32_t index;
  double begin;
  double time;
};
using Approaches = KernelList<Approach>;

/// Calls the function with the norm as its template argument.
template <class Function>
inline void with_norm(Norm norm, const Function& function) {
  if (norm == Norm::linf) {
    function.template operator()<Norm::linf>();
  } else {
    function.template operator()<Norm::l2>();
  }
}

/// Proofs in double-double, from the points themselves.
template <class Lanes, ContactKind kind, Norm norm>
class PreciseProof {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Vector = std::array<Value, 3>;
  using Precise = filters::DoubleDouble<Value>;

  /// \param magnitude The greatest of all differences of points.
  PreciseProof(const std::array<Vector, query_points>& points, const Value& magnitude,
               double distance)
      : magnitude_(max(magnitude, Value(distance))), points_(points), distance_(distance) {}

  /// D.
  [[nodiscard]] Value distance() const { return Value(distance_); }

  /// The least c·w − D n of all corners at a time, less its bound.
  [[nodiscard]] Value least_gap(const Vector& c, const Value& time) const {
    const Value bound = magnitude_ * Value(unit_length<double> * gap_bound.rounding()) +
                        Value(gap_bound.underflow(greatest_size));
    const std::array<Precise, 2> weights{filters::exact_difference(Value(1.0), time), exact(time)};
    Value least(0x1p1000);
    for (const auto& [plus, minus] : corner_points) {
      std::array<Precise, filters::AdvancedGap::coordinates> x;
      x.fill(exact(Value(0.0)));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = exact(c[axis]);
        x[4 + axis] = filters::exact_difference(points_[plus][axis], points_[minus][axis]);
        x[10 + axis] = filters::exact_difference(points_[4 + plus][axis], points_[4 + minus][axis]);
      }
      x[3] = exact(Value(unit_length<double>));
      x[16] = exact(Value(distance_));
      least = min(least, filters::AdvancedGap::evaluate<Precise>(x, weights).high);
    }
    return least - bound * Value(1.001);
  }

  /// The lanes with ‖F(time,u,v)‖ ≤ D. \pre (u,v) is in the domain.
  [[nodiscard]] Mask is_within(const Value& time, const Value& u, const Value& v) const {
    const std::array<Precise, 4> weights{filters::exact_difference(Value(1.0), time), exact(time),
                                         exact(u), exact(v)};
    const Value error = magnitude_ * Value(1.001 * component_bound.rounding()) +
                        Value(component_bound.underflow(greatest_size));
    std::array<Precise, 3> x;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x[axis] = filters::ContactComponent::evaluate<Precise>(coordinates(axis), weights);
    }
    if constexpr (norm == Norm::l2) return is_short(x, error);
    Mask result = Mask::all();
    for (const Precise& component : x) {
      const Mask is_negative = component.high < Value(0.0);
      const Precise zero = exact(Value(0.0)), mirrored = zero - component;
      const Precise size{select(is_negative, mirrored.high, component.high),
                         select(is_negative, mirrored.low, component.low)};
      // The error of this difference is small relative to the difference itself.
      result = result & ((exact(Value(distance_)) - size).high > error);
    }
    return result;
  }

 private:
  static constexpr auto gap_bound = filters::advanced_gap_double_double;
  static constexpr auto component_bound = filters::contact_component_double_double;
  static constexpr auto defect_bound = filters::length_defect_double_double;
  static constexpr double greatest_size = 0x1p104;

  using Pair = std::array<std::size_t, 2>;
  static constexpr std::size_t corners = kind == ContactKind::vertex_face ? 3 : 4;
  static constexpr std::array<Pair, corners> corner_points = [] {
    if constexpr (kind == ContactKind::vertex_face) {
      return std::array<Pair, 3>{{{0, 1}, {0, 2}, {0, 3}}};
    } else {
      return std::array<Pair, 4>{{{0, 2}, {1, 2}, {1, 3}, {0, 3}}};
    }
  }();
  /// r, p, q of touchstone/filters/polynomial_expressions.hpp.
  static constexpr std::array<Pair, 3> vectors =
      kind == ContactKind::vertex_face ? std::array<Pair, 3>{{{0, 1}, {2, 1}, {3, 1}}}
                                       : std::array<Pair, 3>{{{0, 2}, {0, 1}, {3, 2}}};

  static Precise exact(const Value& x) { return {x, Value(0.0)}; }

  /// The coordinates of ContactComponent with D = 0.
  [[nodiscard]] std::array<Precise, 7> coordinates(std::size_t axis) const {
    std::array<Precise, 7> x;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [plus, minus] = vectors[i];
      x[i] = filters::exact_difference(points_[plus][axis], points_[minus][axis]);
      x[3 + i] = filters::exact_difference(points_[4 + plus][axis], points_[4 + minus][axis]);
    }
    x[6] = exact(Value(0.0));
    return x;
  }

  /// The lanes with |y| ≤ D, where y is the exact vector, from which x differs by at most `error`
  /// on each axis. If D² − |x|² ≥ 4 D error + 4 error², then |x| ≤ D and |y| ≤ |x| + √3 error, so
  /// that
  /// |y|² ≤ |x|² + 2√3 D error + 3 error² ≤ D².
  [[nodiscard]] Mask is_short(const std::array<Precise, 3>& x, const Value& error) const {
    const Value size =
        max(max(abs(x[0].high), abs(x[1].high)), max(abs(x[2].high), Value(distance_)));
    const Value bound = size * size * Value(1.001 * defect_bound.rounding()) +
                        Value(defect_bound.underflow(greatest_size)) +
                        Value(4.01) * error * (Value(distance_) + error);
    const Value defect =
        filters::LengthDefect::evaluate<Precise>({x[0], x[1], x[2], exact(Value(distance_))}, {})
            .high;
    return defect > bound;
  }

  Value magnitude_;
  const std::array<Vector, query_points>& points_;
  double distance_;
};

/// The closest parameters exactly in F's domain that are multiples of 2^-52, so that 1 − u is
/// exact.
template <ContactKind kind, class Value>
inline std::array<Value, 2> in_domain(const Value& u, const Value& v) {
  const Value zero(0.0), one(1.0);
  const Value inside_u = to_exact(max(min(u, one), zero));
  const Value inside_v = to_exact(max(min(v, one), zero));
  return {inside_u, kind == ContactKind::vertex_face ? min(inside_v, one - inside_u) : inside_v};
}

/// Searches the enclosures of the times of impact of `width` queries.
template <class Lanes, ContactKind kind, Norm norm>
class Arrival {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Polygon = MovingPolygon<Lanes, kind, norm>;
  using Nearest = typename Polygon::Nearest;

  struct Found {
    Value lower;
    Value upper;
    Value u;
    Value v;
    Value corrected;  ///< estimate of the time of impact from the values of the proof
    Mask proved;

    /// This enclosure in the lanes in which it is proved, the other one elsewhere.
    [[nodiscard]] Found or_else(const Found& other) const {
      return {select(proved, lower, other.lower),
              select(proved, upper, other.upper),
              select(proved, u, other.u),
              select(proved, v, other.v),
              other.corrected,
              proved | other.proved};
    }
  };

  Arrival(const Polygon& polygon, const PreciseProof<Lanes, kind, norm>& precise,
          const Value& begin, const Value& half_width)
      : polygon_(polygon), precise_(precise), begin_(begin), half_width_(half_width) {}

  /// The time corrected by two steps of Newton's method; 0 stays 0.
  [[nodiscard]] Value corrected(Value time) const {
    const Mask is_start = time <= Value(0.0);
    for (int i = 0; i < 2; ++i) {
      const Nearest nearest(polygon_.corners_at(time));
      const auto seen =
          polygon_.predict(polygon_.project(nearest.direction), nearest.u, nearest.v, time);
      const Mask is_better = seen.is_near & (seen.time > begin_) & (seen.time <= Value(1.0));
      time = select(is_better, seen.time, time);
    }
    return select(is_start, Value(0.0), min(time, Value(1.0)));
  }

  /// \pre time is in [0,1].
  template <Norm norm_of_witness>
  [[nodiscard]] Found around(const Value& time) const {
    const Value margin = time * half_width_;
    const Value lower = max(time - margin, begin_);
    const Nearest at_begin(polygon_.corners_at(begin_)), at_lower(polygon_.corners_at(lower));
    const auto of_begin = polygon_.project(at_begin.direction);
    const auto of_lower = polygon_.project(at_lower.direction);
    const Value gap = precise_.least_gap(at_lower.direction, lower);
    const Value start = Polygon::Projections::at_point(of_lower.start, at_lower.u, at_lower.v);
    const Value end = Polygon::Projections::at_point(of_lower.end, at_lower.u, at_lower.v);
    const Value rate = start - end;
    // The contact may end within the margin, but not before the polygon has moved by D/2.
    const Value through = precise_.distance() * Value(0.5) / rate;
    const Value upper =
        min(time + select(rate > Value(0.0), min(margin, through), margin), Value(1.0));
    const Mask is_start = upper == Value(0.0);
    const Mask is_free = is_start | (polygon_.begins_apart(of_begin, of_lower, begin_, lower, 2.0) &
                                     (gap > Value(0.0)));
    const NearestPoint<Lanes, kind, norm_of_witness> at_upper(polygon_.corners_at(upper));
    const auto [u, v] = in_domain<kind>(at_upper.u, at_upper.v);
    const Value seen = min(max(lower + gap / rate, begin_), Value(1.0));
    return {lower,
            upper,
            u,
            v,
            select(is_start, time, seen),
            is_free & precise_.is_within(upper, u, v)};
  }

 private:
  Polygon polygon_;
  PreciseProof<Lanes, kind, norm> precise_;
  Value begin_;
  Value half_width_;
};

template <class Lanes, ContactKind kind, Norm norm, class Source>
class DistanceEnclosure {
 public:
  /// \param unproved The queries without an enclosure.
  static void run(const KernelInput& input, const Approaches& approaches, Indices& unproved,
                  KernelOutput& output) {
    for (std::size_t first = 0; first < approaches.count; first += Lanes::width) {
      enclose(input, approaches.items.data() + first, taken<Lanes>(first, approaches.count),
              unproved, output);
    }
  }

 private:
  using Value = typename Lanes::Value;

  static void enclose(const KernelInput& input, const Approach* approaches, std::size_t count,
                      Indices& unproved, KernelOutput& output) {
    std::array<std::uint32_t, Lanes::width> indices;
    alignas(sizeof(Numbers<Lanes>)) std::array<Numbers<Lanes>, 2> rows;
    for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
      const Approach& approach = approaches[lane < count ? lane : count - 1];
      indices[lane] = approach.index;
      rows[0][lane] = approach.begin;
      rows[1][lane] = approach.time;
    }
    const auto points = load<Lanes, Source>(input, indices.data(), Lanes::width);
    const PolygonVectors<Value, kind> vectors(points);
    const double distance = input.separation.distance;
    const Arrival<Lanes, kind, norm> arrival(
        MovingPolygon<Lanes, kind, norm>(vectors.vectors, vectors.magnitude, distance),
        PreciseProof<Lanes, kind, norm>(points, vectors.magnitude * Value(2.0), distance),
        Value::load(rows[0].data()), Value(0.4 * input.toi_tolerance));
    auto found = arrival.template around<norm>(arrival.corrected(Value::load(rows[1].data())));
    if (valid_bits(found.proved, count) != first_lanes<Lanes>(count)) {
      // Other points may have the same distance in L∞, and are easier to find in L2.
      found = found.or_else(arrival.template around<Norm::l2>(found.corrected));
    }
    const unsigned proved = valid_bits(found.proved, count);
    store_impacts<Lanes>(output, indices, proved, {found.lower, found.upper}, {found.u, found.v});
    append_lanes<Lanes>(unproved, indices, first_lanes<Lanes>(count) & ~proved);
  }
};

}  // namespace touchstone::fast::kernel
