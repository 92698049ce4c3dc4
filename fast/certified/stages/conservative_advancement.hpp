#pragma once

/// \file
/// Stage 8, conservative advancement (docs/theory.md, section 6.10), for a minimum separation
/// D > 0 that is large compared with rounding: the stage follows the moving polygon from t=0, in
/// lanes.
///
/// [0,begin] has no contact. An interval [begin,end] is examined by the theorem of
/// moving_polygon.hpp, with the directions of the polygon's closest points at both ends. If it
/// provably has no contact, the search continues at `end`; otherwise it is halved. Newton's method
/// predicts the contact from the closest point's velocity, so that steps can be nearly as long as
/// the time to it. Close to the contact, distance_enclosure.hpp encloses the time of impact.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/distance_enclosure.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_polygon.hpp"

namespace touchstone::fast::kernel {

/// The polygons of `width` queries in memory.
template <class Lanes>
struct PolygonRows {
  using Value = typename Lanes::Value;
  static constexpr std::size_t magnitude_row = 18;

  alignas(sizeof(Numbers<Lanes>)) std::array<Numbers<Lanes>, magnitude_row + 1> row;

  template <ContactKind kind>
  void store(const PolygonVectors<Value, kind>& polygon) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          polygon.vectors[i][end][axis].store(row[6 * i + 3 * end + axis].data());
        }
      }
    }
    polygon.magnitude.store(row[magnitude_row].data());
  }

  template <ContactKind kind, Norm norm>
  [[nodiscard]] MovingPolygon<Lanes, kind, norm> polygon(double distance) const {
    std::array<std::array<Vector<Value>, 2>, 3> vectors;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          vectors[i][end][axis] = Value::load(row[6 * i + 3 * end + axis].data());
        }
      }
    }
    return {vectors, Value::load(row[magnitude_row].data()), distance};
  }
};

template <class Lanes>
using PolygonLanes = std::array<PolygonRows<Lanes>, groups_of_block<Lanes>>;

/// Follows `width` queries at once, each at its own time; a lane that is finished takes the next
/// query.
template <class Lanes, ContactKind kind, Norm norm>
class Advance {
 public:
  Advance(const KernelInput& input, const Indices& queries, const PolygonLanes<Lanes>& polygons,
          Approaches& approaches, KernelOutput& output)
      : input_(input),
        queries_(queries),
        polygons_(polygons),
        approaches_(approaches),
        output_(output) {}

  void run() {
    for (std::size_t lane = 0; lane < width; ++lane) take(lane);
    while (active_ != 0) step();
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Polygon = MovingPolygon<Lanes, kind, norm>;
  using Nearest = typename Polygon::Nearest;
  static constexpr std::size_t width = Lanes::width;

  static constexpr double most_steps = 60;
  /// The fraction of the time to the predicted contact that a step advances.
  static constexpr double part_of_way = 1.0 - 0x1p-10;
  /// The contact is close if the remaining time is at most this part of its time, or the gap at
  /// most this number of bounds.
  static constexpr double near_in_time = 0x1p-12;
  static constexpr double near_in_bounds = 0x1p12;

  void take(std::size_t lane) {
    active_ &= ~(1U << lane);
    if (next_ == queries_.count) return;
    const PolygonRows<Lanes>& from = polygons_[next_ / width];
    const std::size_t place = next_ % width;
    for (std::size_t i = 0; i < lanes_.row.size(); ++i) lanes_.row[i][lane] = from.row[i][place];
    index_[lane] = queries_.items[next_++];
    for (Numbers<Lanes>& row : state_) row[lane] = 0.0;
    active_ |= 1U << lane;
  }

  /// The state of a lane's query, as rows of `state_`: the end `begin` of [0, begin], which has no
  /// contact; the end of the interval to examine; the best direction at `begin`, and the closest
  /// point's parameters.
  enum State : std::size_t { begin, end, steps, parameter_u, parameter_v, direction };

  [[nodiscard]] Value load(State row) const { return Value::load(state_[row].data()); }

  /// Examines [begin, end]; at first the time 0.
  void step() {
    const Polygon polygon = lanes_.template polygon<kind, norm>(input_.separation.distance);
    const Value a = load(begin), b = load(end);
    const Mask is_first = load(steps) == Value(0.0);
    const Nearest nearest(polygon.corners_at(b));
    Vector<Value> c_a;
    for (std::size_t k = 0; k < 3; ++k) {
      c_a[k] = select(is_first, nearest.direction[k], Value::load(state_[direction + k].data()));
    }
    const auto of_a = polygon.project(c_a), of_b = polygon.project(nearest.direction);
    const Mask apart = polygon.begins_apart(of_a, of_b, a, b, 1.0) & polygon.ends_apart(of_b, b);
    const Value u = select(apart | is_first, nearest.u, load(parameter_u));
    const Value v = select(apart | is_first, nearest.v, load(parameter_v));
    const auto ahead = polygon.predict(of_b, nearest.u, nearest.v, b);
    const auto behind = polygon.predict(of_a, u, v, a);
    for (std::size_t k = 0; k < 3; ++k) {
      select(apart, nearest.direction[k], c_a[k]).store(state_[direction + k].data());
    }
    u.store(state_[parameter_u].data());
    v.store(state_[parameter_v].data());
    const Mask is_near = select_mask(apart, ahead.is_near, behind.is_near);
    go_on(apart,
          {select(apart, ahead.gap, behind.gap), select(apart, ahead.time, behind.time), is_near},
          polygon.bound());
  }

  static Mask select_mask(const Mask& mask, const Mask& a, const Mask& b) {
    return select(mask, select(a, Value(1.0), Value(0.0)), select(b, Value(1.0), Value(0.0))) >
           Value(0.5);
  }

  /// \param seen The contact as predicted from the end of the time without contact.
  void go_on(const Mask& apart, const typename Polygon::Prediction& seen, const Value& bound) {
    const Value one(1.0), a = load(begin), b = load(end), step = load(steps);
    const Value from = select(apart, b, a);
    const Mask is_ahead = seen.is_near & (seen.time > from);
    const Value on_way = from + (seen.time - from) * Value(part_of_way);
    const Value whole = select(is_ahead & (on_way < one), on_way, one);
    const Value half = a + (b - a) * Value(0.5);
    const Mask is_shorter = is_ahead & (on_way < a + (b - a) * Value(0.875));
    const Value next = to_exact(select(apart, whole, select(is_shorter, on_way, half)));
    const Mask is_first = step == Value(0.0), is_in_contact = seen.gap <= Value(0.0);
    const Mask is_close = is_ahead & (seen.time <= one + Value(near_in_time)) &
                          ((seen.time - from <= seen.time * Value(near_in_time)) |
                           (seen.gap <= bound * Value(near_in_bounds)) | (next <= from));
    const Value apart_value = select(apart, one, Value(0.0));
    const Mask fails = apart_value < Value(0.5);
    const Mask arrives = is_close & select_mask(is_first, apart, Mask::all());
    const Mask contact_at_start = is_first & fails & is_in_contact;
    const Mask is_over = apart & (b >= Value(input_.t_limit));
    const Mask is_hopeless = (is_first & fails) | (next <= from) | (step >= Value(most_steps));
    from.store(state_[begin].data());
    next.store(state_[end].data());
    (step + one).store(state_[steps].data());
    finish(is_over.bits() & active_, (arrives | contact_at_start).bits() & active_,
           is_hopeless.bits() & active_, select(contact_at_start, Value(0.0), seen.time));
  }

  void finish(unsigned over, unsigned arrived, unsigned hopeless, const Value& time) {
    alignas(sizeof(Numbers<Lanes>)) Numbers<Lanes> times;
    time.store(times.data());
    for_each_lane(over | arrived | hopeless, [&](std::size_t lane) {
      if ((over >> lane & 1U) != 0) {
        append<Lanes>(output_.rejected, index_[lane]);
      } else if ((arrived >> lane & 1U) != 0) {
        append<Lanes>(approaches_, Approach{index_[lane], state_[begin][lane], times[lane]});
      } else {
        append<Lanes>(output_.undecided, index_[lane]);
      }
      take(lane);
    });
  }

  PolygonRows<Lanes> lanes_{};
  alignas(sizeof(Numbers<Lanes>)) std::array<Numbers<Lanes>, 8> state_{};
  std::array<std::uint32_t, width> index_{};
  unsigned active_ = 0;   ///< the lanes that hold a query
  std::size_t next_ = 0;  ///< index of the next query
  const KernelInput& input_;
  const Indices& queries_;
  const PolygonLanes<Lanes>& polygons_;
  Approaches& approaches_;
  KernelOutput& output_;
};

template <class Lanes, ContactKind kind, Norm norm, class Source>
inline void advancement_stage(const KernelInput& input, const Indices& far, KernelOutput& output) {
  PolygonLanes<Lanes> polygons;
  for (std::size_t first = 0; first < far.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, far.count);
    polygons[first / Lanes::width].store(PolygonVectors<typename Lanes::Value, kind>(
        load<Lanes, Source>(input, far.items.data() + first, count)));
  }
  Approaches approaches;
  approaches.count = 0;
  Advance<Lanes, kind, norm>(input, far, polygons, approaches, output).run();
  DistanceEnclosure<Lanes, kind, norm, Source>::run(input, approaches, output.undecided, output);
}

}  // namespace touchstone::fast::kernel
