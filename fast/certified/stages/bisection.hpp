#pragma once

/// \file
/// Stage 6, bisection (docs/theory.md, section 6.7).
///
/// Intervals of time are examined in ascending order (orientation.hpp). An interval without contact
/// is skipped. A proved contact ends the search: there is none before, and the zero of det in the
/// interval is the only one there, so it is the time of impact. Any other interval is halved.
/// Queries whose intervals become too short or too numerous remain for the exact stage.

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"

namespace touchstone::fast::kernel {

/// The moving vectors of `width` queries and their bounds, in memory.
template <class Lanes, ContactKind kind>
struct MovingLanes {
  using Value = typename Lanes::Value;
  static constexpr std::size_t orientation_count = orientations<kind>().size();
  static constexpr std::size_t rows = 6 * vector_count + 1 + orientation_count;

  /// x, y, z of each vector at t=0, then at t=1; the bound of det; the orientations' scales.
  alignas(sizeof(Numbers<Lanes>)) std::array<Numbers<Lanes>, rows> row;

  void store(const Ends<Value>& unit, const Bounds<Value, kind>& bounds) {
    for (std::size_t i = 0; i < vector_count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        unit[i][0][k].store(row[6 * i + k].data());
        unit[i][1][k].store(row[6 * i + 3 + k].data());
      }
    }
    bounds.determinant.store(row[6 * vector_count].data());
    for (std::size_t i = 0; i < orientation_count; ++i) {
      bounds.orientation_scale[i].store(row[6 * vector_count + 1 + i].data());
    }
  }

  [[nodiscard]] Value load(std::size_t i) const { return Value::load(row[i].data()); }

  [[nodiscard]] Ends<Value> unit() const {
    Ends<Value> result;
    for (std::size_t i = 0; i < vector_count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        result[i][0][k] = load(6 * i + k);
        result[i][1][k] = load(6 * i + 3 + k);
      }
    }
    return result;
  }

  [[nodiscard]] Bounds<Value, kind> bounds() const {
    Bounds<Value, kind> result{load(6 * vector_count), {}};
    for (std::size_t i = 0; i < orientation_count; ++i) {
      result.orientation_scale[i] = load(6 * vector_count + 1 + i);
    }
    return result;
  }
};

/// Queries to bisect, lane by lane.
template <class Lanes, ContactKind kind>
struct Moving {
  const Indices* indices;
  std::array<MovingLanes<Lanes, kind>, groups_of_block<Lanes>> groups;
};

/// \param bounds of queries from their vectors
template <class Lanes, ContactKind kind, class Source, class Input, class MakeBounds>
inline void load_moving(const Input& input, const Indices& indices, Moving<Lanes, kind>& moving,
                        const MakeBounds& bounds) {
  moving.indices = &indices;
  for (std::size_t first = 0; first < indices.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, indices.count);
    const auto unit =
        vectors_of<kind>(load<Lanes, Source>(input, indices.items.data() + first, count));
    moving.groups[first / Lanes::width].store(unit, bounds(unit));
  }
}
template <class Lanes, bool separated, ContactKind kind, class Source>
inline void load_moving(const KernelInput& input, const Indices& indices,
                        Moving<Lanes, kind>& moving) {
  using Value = typename Lanes::Value;
  load_moving<Lanes, kind, Source>(input, indices, moving, [&](const Ends<Value>& unit) {
    return bounds_of<kind, separated>(unit, Value(input.separation.distance));
  });
}

/// What is proved of contacts on an interval, from the vectors at its ends.
template <ContactKind kind>
struct ExamineContacts {
  template <class Value>
  [[nodiscard]] static Examination<Value> on(const Ends<Value>& at,
                                             const Bounds<Value, kind>& bounds) {
    return examine<kind>(at, bounds);
  }
};

/// Runs `width` queries at a time, each with its own interval; a lane that is finished takes the
/// next query.
/// \tparam Examine as ExamineContacts, with its own proofs of "no contact" and of "one, at the only
/// zero of det"
template <class Lanes, ContactKind kind, class Examine = ExamineContacts<kind>>
class Bisection {
 public:
  Bisection(double t_limit, const Moving<Lanes, kind>& moving, Crossings& contacts,
            Indices& rejected, Indices& hopeless)
      : t_limit_(t_limit),
        moving_(moving),
        contacts_(contacts),
        rejected_(rejected),
        hopeless_(hopeless) {}

  void run() {
    for (std::size_t lane = 0; lane < width; ++lane) take(lane);
    while (active_ != 0) step();
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  static constexpr std::size_t width = Lanes::width;

  /// Intervals are not halved below `least_length`, and at most `most_steps` of them are examined:
  /// beyond these limits the exact stage is faster.
  static constexpr double least_length = 0x1p-12;
  /// The limit if the sign of det at an end of the interval is uncertain, so that no part at this
  /// end can be decided.
  static constexpr double least_length_at_zero = 0x1p-1;
  static constexpr double most_steps = 150;

  // ---- Lanes ----

  /// Assigns the next query to the lane, if there is one.
  void take(std::size_t lane) {
    active_ &= ~(1U << lane);
    if (next_ == moving_.indices->count) return;
    const MovingLanes<Lanes, kind>& lanes = moving_.groups[next_ / width];
    const std::size_t from = next_ % width;
    for (std::size_t i = 0; i < lanes.row.size(); ++i) lanes_.row[i][lane] = lanes.row[i][from];
    index_[lane] = moving_.indices->items[next_++];
    begin_[lane] = 0.0;
    length_[lane] = 0.5;
    steps_[lane] = 0.0;
    active_ |= 1U << lane;
  }

  static Value load(const Numbers<Lanes>& row) { return Value::load(row.data()); }

  void step() {
    const Value begin = load(begin_), length = load(length_);
    const auto found = Examine::on(between(lanes_.unit(), begin, begin + length), lanes_.bounds());
    const unsigned contact = found.has_contact().bits() & active_;
    if (contact != 0) keep_contacts(contact, begin, length, found.coefficients);
    const auto& c = found.coefficients;
    const Mask is_at_zero = min(abs(c[0]), abs(c[3])) <= lanes_.bounds().determinant;
    advance(found.has_no_contact(), contact,
            select(is_at_zero, Value(least_length_at_zero), Value(least_length)));
  }

  // ---- The next interval ----

  /// Goes on to the next interval in lanes without contact, and to the first half in the others;
  /// finished lanes take other queries.
  void advance(const Mask& rejected, unsigned contact, const Value& least) {
    const Value begin = load(begin_), length = load(length_), end = begin + length;
    // The next interval is as long as its dyadic position allows, at most twice this one.
    const Value doubled = length + length, places = end / doubled, shift(0x1p52);
    const Mask can_double = ((places + shift) - shift) == places;
    const Value steps = load(steps_) + Value(1.0);
    const Value next_length =
        select(rejected, select(can_double, doubled, length), length * Value(0.5));
    const unsigned over = (rejected & (end >= Value(t_limit_))).bits() & active_ & ~contact;
    const Mask is_short = (next_length < least) & (next_length < length);
    const Mask is_hopeless = is_short | (steps > Value(most_steps));
    const unsigned hopeless = is_hopeless.bits() & active_ & ~contact & ~over;
    select(rejected, end, begin).store(begin_.data());
    next_length.store(length_.data());
    steps.store(steps_.data());
    for_each_lane(over | contact | hopeless, [&](std::size_t lane) {
      if ((over >> lane & 1U) != 0) append<Lanes>(rejected_, index_[lane]);
      if ((hopeless >> lane & 1U) != 0) append<Lanes>(hopeless_, index_[lane]);
      take(lane);
    });
  }

  void keep_contacts(unsigned lanes, const Value& begin, const Value& length,
                     const std::array<Value, 4>& coefficients) {
    Intervals<Lanes> intervals;
    intervals.store(0, begin, length, coefficients);
    for_each_lane(lanes, [&](std::size_t lane) {
      append<Lanes>(contacts_, intervals.crossing(lane, index_[lane]));
    });
  }

  MovingLanes<Lanes, kind> lanes_{};
  alignas(sizeof(Numbers<Lanes>)) Numbers<Lanes> begin_{};
  alignas(sizeof(Numbers<Lanes>)) Numbers<Lanes> length_{};
  alignas(sizeof(Numbers<Lanes>)) Numbers<Lanes> steps_{};
  std::array<std::uint32_t, width> index_{};
  unsigned active_ = 0;   ///< the lanes that hold a query
  std::size_t next_ = 0;  ///< index of the next query
  double t_limit_;
  const Moving<Lanes, kind>& moving_;
  Crossings& contacts_;
  Indices& rejected_;
  Indices& hopeless_;
};

}  // namespace touchstone::fast::kernel
