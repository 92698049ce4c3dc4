#pragma once

/// \file
/// Stage 5, the only zero of the determinant (docs/theory.md, section 6.6).
///
/// If det certainly has exactly one zero on [0,1], only that zero can be a contact. Newton's method
/// approximates it without an error bound. On a short interval around it the tests of
/// orientation.hpp are repeated. If det certainly changes sign once there, the zero is in the
/// interval, and the orientations decide: opposite signs reject the query, equal ones prove that
/// the zero is the time of impact.

#include <array>
#include <cstddef>

#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/moving_vectors.hpp"
#include "fast/certified/stages/orientation.hpp"

namespace touchstone::fast::kernel {

/// Half the lengths of the two intervals. The second is tried if the first is too long; if both
/// are, bisection would not end.
inline constexpr std::array<double, 2> halves_around_zero{0x1p-10, 0x1p-32};

/// The time rounded to a multiple of 2^-44, so that it and 1 minus it are exact.
template <class Value>
inline Value to_short(const Value& time) {
  const Value shift(0x1p8);
  return (time + shift) - shift;
}

/// Tests one of the intervals. \param unclear The queries whose zero is in it but whose
/// orientations prove nothing. \param undecided The queries whose zero may be outside.
template <class Lanes, bool separated, ContactKind kind, class Source>
inline void zero_stage(const KernelInput& input, double half, const Crossings& zeros,
                       Crossings& contacts, Crossings& unclear, Indices& undecided, Indices& far,
                       KernelOutput& output) {
  using Value = typename Lanes::Value;
  Marks<Lanes> of_contacts(zeros.count), of_rejected(zeros.count), of_unclear(zeros.count),
      of_rest(zeros.count), of_far(zeros.count);
  Intervals<Lanes> intervals;
  Indices all;
  all.count = zeros.count;
  for (std::size_t i = 0; i < zeros.count; ++i) all.items[i] = zeros.items[i].index;
  for (std::size_t first = 0; first < zeros.count; first += Lanes::width) {
    const std::size_t count = taken<Lanes>(first, zeros.count);
    const Value zero = CrossingLanes<Lanes>(zeros.items.data() + first, count).cubic.zero(half);
    const Value begin = to_short(max(zero - Value(half), Value(0.0)));
    const Value end = to_short(min(zero + Value(half), Value(1.0)));
    const Ends<Value> unit =
        vectors_of<kind>(load<Lanes, Source>(input, all.items.data() + first, count));
    const Examination<Value> found =
        examine<kind>(between(unit, begin, end),
                      bounds_of<kind, separated>(unit, Value(input.separation.distance)));
    intervals.store(first, begin, end - begin, found.coefficients);
    const auto is_late = begin >= Value(input.t_limit);
    const unsigned here = valid_bits(found.determinant.crosses_once, count);
    const unsigned rejected = here & (found.orientation.opposed | is_late).bits();
    const unsigned contact = here & ~rejected & found.orientation.agree.bits();
    const unsigned is_far = far_lanes<separated>(input, unit) & first_lanes<Lanes>(count);
    of_contacts.add(first, contact & ~is_far);
    of_rejected.add(first, rejected);
    of_unclear.add(first, here & ~contact & ~rejected & ~is_far);
    of_rest.add(first, first_lanes<Lanes>(count) & ~here & ~is_far);
    of_far.add(first, is_far & ~rejected);
  }
  of_contacts.for_each([&](std::size_t place) {
    append<Lanes>(contacts, intervals.crossing(place, all.items[place]));
  });
  of_unclear.for_each([&](std::size_t place) { append<Lanes>(unclear, zeros.items[place]); });
  append_marked(output.rejected, all, of_rejected);
  append_marked(undecided, all, of_rest);
  append_marked(far, all, of_far);
}

/// Tests both intervals. \param hopeless The queries that bisection would not decide either.
template <class Lanes, bool separated, ContactKind kind, class Source>
inline void zero_stages(const KernelInput& input, const Crossings& zeros, Crossings& contacts,
                        Indices& undecided, Indices& hopeless, Indices& far, KernelOutput& output) {
  Crossings unclear, still_unclear;
  zero_stage<Lanes, separated, kind, Source>(input, halves_around_zero[0], zeros, contacts, unclear,
                                             undecided, far, output);
  zero_stage<Lanes, separated, kind, Source>(input, halves_around_zero[1], unclear, contacts,
                                             still_unclear, hopeless, far, output);
  for (std::size_t i = 0; i < still_unclear.count; ++i) {
    append<Lanes>(hopeless, still_unclear.items[i].index);
  }
}

}  // namespace touchstone::fast::kernel
