#pragma once

/// \file
/// The stages of the solver for curves, written once for lanes, with one query in each lane. Only
/// the kernels include this file (fast/certified/kernel_*.cpp).
///
/// 1. **Axis.** If on an axis all control points of one primitive are farther than the distance
///    beyond all of the other, no time is a contact, since each point is in the hull of its control
///    points. This is exact but for the difference, which is rounded and does not exceed the
///    distance if it is not beyond.
/// 2. **Direction.** Let v be a direction of a dual norm of at most n, and let v·w > n·reach for
///    all control points w of all corners and the control values of the distance. Then no time is a
///    contact: v·w_i(t) − n·reach(t) is in the hull of its control values. At distance 0 the
///    direction is the sum of all control points.
/// 3. **Bisection.** The same on pieces of time in ascending order, with a coordinate axis and with
///    the best direction of the middle. A piece without contact is skipped; a piece with one proved
///    contact ends the search (contact_proof.hpp); any other piece is halved. So there is no
///    contact before the last piece, and its only or first contact is the time of impact. At a
///    distance, a contact proved at the end of a piece bounds the time from above, and pieces
///    before it are skipped until the bounds meet.
///
/// The computed values have to exceed the bound of filters::CornerGap at the magnitude M of the
/// control values, and (|v|_1 + n) times their error (control_polygon.hpp).
///
/// Queries that are not proved within some steps go to the exact stage, as do those with numbers
/// that are not finite or too large, and those without a control polygon (Denominators).

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/certified/curves/contact_proof.hpp"
#include "fast/certified/curves/control_polygon.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/certified/stages/closest_point.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/separation_expressions.hpp"

namespace touchstone::fast::curved {

// ---- Axis ---------------------------------------------------------------------------------------

/// Stage 1 for one query at a time. False if a number is not finite or a weight is not positive.
template <class Lanes, ContactKind kind>
inline bool is_apart_on_axis(const Block& block, const double* numbers) {
  using Row = typename Lanes::Row;
  constexpr std::size_t firsts = kind == ContactKind::vertex_face ? 1 : 2;
  const std::size_t stride = block.numbers_of_point();
  Row least_a = Row::load(numbers), least_b = Row::load(numbers + firsts * stride);
  Row most_a = least_a, most_b = least_b, sum(0.0);
  for (std::size_t k = 0; k <= block.degree; ++k) {
    for (std::size_t i = 0; i < moving_points; ++i) {
      const double* const from = numbers + (k * moving_points + i) * stride;
      const bool is_last = k == block.degree && i + 1 == moving_points && !block.is_rational;
      const Row x = is_last ? Lanes::load_row_backwards(from) : Row::load(from);
      Row& least = i < firsts ? least_a : least_b;
      Row& most = i < firsts ? most_a : most_b;
      least = min(least, x);
      most = max(most, x);
      sum = sum + x;
    }
  }
  if (block.is_rational) {
    bool is_positive = true;
    double weights = 0.0;
    for (std::size_t i = 0; i < (block.degree + 1) * moving_points; ++i) {
      is_positive = is_positive & (numbers[4 * i + 3] > 0.0);
      weights += numbers[4 * i + 3];
    }
    if (!is_positive || !(weights - weights == 0.0)) return false;
  }
  const Row distance(block.separation.distance);
  const bool is_apart =
      kernel::axes_of((least_a - most_b > distance) | (least_b - most_a > distance)) != 0;
  return is_apart & kernel::is_finite_row(sum);
}

template <class Lanes>
void axis_stage(const Block& block, KernelList<std::uint32_t>& open) {
  open.count = 0;
  const std::size_t count = block.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double* const numbers = block.numbers.data() + i * block.numbers_of_query();
    const bool is_apart = block.kind == ContactKind::vertex_face
                              ? is_apart_on_axis<Lanes, ContactKind::vertex_face>(block, numbers)
                              : is_apart_on_axis<Lanes, ContactKind::edge_edge>(block, numbers);
    open.items[open.count] = static_cast<std::uint32_t>(i);
    open.count += is_apart ? 0 : 1;
  }
}

// ---- Direction ----------------------------------------------------------------------------------

/// Stage 2 for a direction of a dual norm of at most n.
template <bool separated, class Lanes, ContactKind kind>
inline auto separates(const ControlPolygons<Lanes, kind>& polygons,
                      const kernel::Vector<typename Lanes::Value>& v,
                      const typename Lanes::Value& n) {
  using Value = typename Lanes::Value;
  constexpr auto bound = filters::corner_gap_double;
  constexpr double least_bound = 2.0 * bound.underflow(greatest_magnitude);
  const Value greatest = max(kernel::greatest(v), n);
  const Value magnitude = Value::load(polygons.magnitude.data());
  const Value error = Value::load(polygons.error.data());
  // 4.0001 times the greatest component is above |v|_1 + n and the rounding of this line.
  const Value least =
      greatest * (magnitude * Value(bound.rounding()) + error * Value(4.0001)) + Value(least_bound);
  // A gap that is NaN is not above the bound; min would lose it.
  auto result = greatest <= Value(greatest_magnitude);
  for (std::size_t k = 0; k <= polygons.degree; ++k) {
    for (const auto& w : polygons.corners_at(k)) {
      if constexpr (separated) {
        const auto gap = filters::CornerGap::evaluate<Value>(
            {v[0], v[1], v[2], n, w[0], w[1], w[2], polygons.reach(k)}, {});
        result = result & (gap > least);
      } else {
        result = result & (filters::dot(v, w) > least);
      }
    }
  }
  return result;
}

/// Stage 2 for the coordinate axes. The two sums of numbers up to M and their errors are covered by
/// thrice the error and 2 u M.
template <bool separated, class Lanes, ContactKind kind>
inline auto separates_on_axis(const ControlPolygons<Lanes, kind>& polygons) {
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  constexpr std::size_t corners = ControlPolygons<Lanes, kind>::corners;
  const Value margin = Value::load(polygons.error.data()) * Value(3.0) +
                       Value::load(polygons.magnitude.data()) * Value(4.0 * unit_roundoff);
  Mask result = Mask::none();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Mask is_above = Mask::all(), is_below = Mask::all();
    for (std::size_t k = 0; k <= polygons.degree; ++k) {
      Value far = margin;
      if constexpr (separated) far = polygons.reach(k) + margin;
      const Value below = Value(0.0) - far;
      for (std::size_t i = 0; i < corners; ++i) {
        const Value w = polygons.at(k, axis * corners + i);
        is_above = is_above & (w > far);
        is_below = is_below & (w < below);
      }
    }
    result = result | is_above | is_below;
  }
  return result;
}

/// The sum of all control points: a direction for distance 0, where its length does not matter.
template <class Lanes, ContactKind kind>
inline kernel::Vector<typename Lanes::Value> sum_of_corners(
    const ControlPolygons<Lanes, kind>& polygons) {
  using Value = typename Lanes::Value;
  constexpr std::size_t corners = ControlPolygons<Lanes, kind>::corners;
  kernel::Vector<Value> sum{Value(0.0), Value(0.0), Value(0.0)};
  for (std::size_t k = 0; k <= polygons.degree; ++k) {
    for (std::size_t place = 0; place < 3 * corners; ++place) {
      sum[place / corners] = sum[place / corners] + polygons.at(k, place);
    }
  }
  return sum;
}

// ---- Bisection ----------------------------------------------------------------------------------

/// Queries whose time of impact is in a piece, until the lanes are full.
template <class Lanes>
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): numbers of lanes are aligned
struct Impacts {
  alignas(64) kernel::Numbers<Lanes> begin{};
  alignas(64) kernel::Numbers<Lanes> length{};
  DeterminantForms<Lanes> det{};  ///< at distance 0
  std::array<std::uint32_t, Lanes::width> index;
  std::size_t count = 0;
};

/// Stages 2 and 3 for the queries of a list.
template <class Lanes, ContactKind kind, Norm norm, bool separated>
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): numbers of lanes are aligned
class Search {
 public:
  static void run(const Block& block, const KernelList<std::uint32_t>& queries,
                  Denominators denominators, KernelOutput& output) {
    Search search(block, queries, denominators, output);
    for (std::size_t lane = 0; lane < width; ++lane) search.refill(lane);
    while (search.busy_ != 0) search.examine();
    search.enclose_found();
  }

 private:
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  using Polygons = ControlPolygons<Lanes, kind>;
  using Corners = typename Polygons::Corners;
  using Nearest = kernel::NearestPoint<Lanes, kind, norm>;
  static constexpr std::size_t width = Lanes::width;
  static constexpr std::size_t corners = Polygons::corners;

  static constexpr int most_steps = 300;
  /// The length of a piece at whose end a proved contact is enclosed.
  static constexpr double short_length = 0x1p-20;
  static constexpr double least_length = 0x1p-24;

  Search(const Block& block, const KernelList<std::uint32_t>& queries, Denominators denominators,
         KernelOutput& output)
      : block_(block), queries_(queries), output_(output), denominators_(denominators) {}

  // ---- Queries in lanes ----

  [[nodiscard]] const double* numbers_of(std::uint32_t index) const {
    return block_.numbers.data() + index * block_.numbers_of_query();
  }

  /// Puts the next query into a lane, if there is one.
  void refill(std::size_t lane) {
    busy_ &= ~(1U << lane);
    begin_[lane] = 0.0;
    length_[lane] = 1.0;
    while (waiting_ == 0) {
      if (next_ == queries_.count) return;
      load_some();
    }
    const auto place = static_cast<std::size_t>(__builtin_ctz(waiting_));
    waiting_ &= waiting_ - 1;
    whole_.take(lane, loaded_, place);
    index_[lane] = loaded_index_[place];
    upper_[lane] = 2.0;
    steps_[lane] = 0;
    busy_ |= 1U << lane;
  }

  /// Loads the next queries of the list. Those that neither stage 2 nor a contact at t = 0 decides
  /// wait.
  void load_some() {
    const std::size_t count = kernel::taken<Lanes>(next_, queries_.count);
    Rows<Lanes> rows{block_, {}};
    for (std::size_t lane = 0; lane < width; ++lane) {
      loaded_index_[lane] = queries_.items[next_ + (lane < count ? lane : count - 1)];
      rows.first[lane] = numbers_of(loaded_index_[lane]);
    }
    next_ += count;
    const Mask is_usual = Loading<Lanes, kind>::run(rows, denominators_, loaded_);
    const unsigned all = kernel::first_lanes<Lanes>(count), usual = is_usual.bits() & all;
    kernel::append_lanes<Lanes>(output_.undecided, loaded_index_, all & ~usual);
    if constexpr (separated) {
      const auto [u, v] = closest_point(Nearest(loaded_.corners_at(0)));
      const unsigned contacts = is_contact<norm>(loaded_, 0, u, v).bits() & usual;
      kernel::store_impacts<Lanes>(output_, loaded_index_, contacts, {Value(0.0), Value(0.0)},
                                   {u, v});
      waiting_ = usual & ~contacts;
    } else {
      const unsigned apart =
          separates<separated>(loaded_, sum_of_corners(loaded_), Value(0.0)).bits() & usual;
      kernel::append_lanes<Lanes>(output_.separated_in_direction, loaded_index_, apart);
      waiting_ = usual & ~apart;
    }
  }

  void undecided(std::size_t lane) {
    kernel::append<Lanes>(output_.undecided, index_[lane]);
    refill(lane);
  }

  /// Parameters in F's domain.
  static std::array<Value, 2> closest_point(const Nearest& nearest) {
    const Value zero(0.0), one(1.0);
    const Value u = max(min(nearest.u, one), zero), v = max(min(nearest.v, one), zero);
    if constexpr (kind == ContactKind::edge_edge) return {u, v};
    // Move to the side u + v = 1, a little inside. (A sum above 1 may round to 1: `rest` is its
    // error.)
    const Value sum = u + v, part = sum - u;
    const Value rest = (u - (sum - part)) + (v - part);
    const Value factor = select((sum - one) + rest > zero, Value(1.0 - 0x1p-50) / sum, one);
    return {u * factor, v * factor};
  }

  // ---- Pieces ----

  /// Examines the piece of each lane.
  void examine() {
    const Value begin = Value::load(begin_.data());
    const Value end = begin + Value::load(length_.data());
    restrict_to<separated>(whole_, begin, end, part_);
    unsigned apart = separates_on_axis<separated>(part_).bits() & busy_, contacts = 0;
    if (apart != busy_) {
      const Corners middle = corners_in_middle();
      const Value n(kernel::unit_length<double>);
      const Nearest nearest(denominators_ == Denominators::four ? with_one_factor(middle) : middle);
      apart |= separates<separated>(part_, nearest.direction, n).bits() & busy_;
      const unsigned open = busy_ & ~apart;
      if (open != 0) contacts = (separated ? contacts_at_end() : crossings(middle, open)) & open;
    }
    kernel::for_each_lane(busy_, [&](std::size_t lane) {
      if ((apart >> lane & 1U) != 0) {
        leave(lane);
      } else {
        const bool has_contact = (contacts >> lane & 1U) != 0;
        if constexpr (separated) {
          narrow(lane, has_contact);
        } else if (has_contact) {
          add_found(lane);
        } else {
          halve(lane);
        }
      }
    });
  }

  /// Skips a piece without contact. The next one is the second half of a halved piece: it has the
  /// greatest length of which its begin is a multiple.
  void leave(std::size_t lane) {
    const double begin = begin_[lane] + length_[lane];
    if (begin >= 1.0 || begin >= block_.t_limit) {
      kernel::append<Lanes>(output_.rejected, index_[lane]);
      refill(lane);
      return;
    }
    const auto multiple = static_cast<std::uint64_t>(begin / length_[lane]);
    length_[lane] *= static_cast<double>(multiple & (~multiple + 1));
    begin_[lane] = begin;
    if (++steps_[lane] > most_steps) undecided(lane);
  }

  void halve(std::size_t lane) {
    length_[lane] *= 0.5;
    if (length_[lane] < least_length || ++steps_[lane] > most_steps) undecided(lane);
  }

  /// The corners at the middle of the part times 2^degree and denominators, approximations.
  [[nodiscard]] Corners corners_in_middle() const {
    Corners result = part_.corners_at(0);
    double factor = 1.0;
    for (std::size_t k = 1; k <= part_.degree; ++k) {
      factor = factor * static_cast<double>(part_.degree - k + 1) / static_cast<double>(k);
      const Corners w = part_.corners_at(k);
      for (std::size_t i = 0; i < corners; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          result[i][axis] = result[i][axis] + w[i][axis] * Value(factor);
        }
      }
    }
    return result;
  }

  /// Corners with factors of their own, times others so that all have one factor. The directions of
  /// a triangle do not depend on factors. Four corners are λ_i w_i with w_0 − w_1 + w_2 − w_3 = 0,
  /// and det of all but λ_i w_i is, up to its sign, the product of the other λ times one number.
  static Corners with_one_factor(Corners w) {
    if constexpr (kind == ContactKind::edge_edge) {
      std::array<Value, corners> factor;
      Value greatest(0.0);
      for (std::size_t i = 0; i < corners; ++i) {
        factor[i] = abs(filters::dot(w[(i + 1) % corners],
                                     filters::cross(w[(i + 2) % corners], w[(i + 3) % corners])));
        greatest = max(greatest, factor[i]);
      }
      const Mask is_any = greatest > Value(0.0);
      for (std::size_t i = 0; i < corners; ++i) {
        const Value scale = select(is_any, factor[i] / greatest, Value(1.0));
        for (Value& x : w[i]) x = x * scale;
      }
    }
    return w;
  }

  // ---- Distance 0 ----

  struct Found;

  static Value determinant(const Corners& w) {
    return filters::dot(w[0], filters::cross(w[1], w[corners - 1]));
  }

  /// The open lanes with exactly one contact (theorem 1 of contact_proof.hpp), on the axis on which
  /// the polygon's normal in the middle is longest. Values without bounds come first: most pieces
  /// fail there.
  unsigned crossings(const Corners& middle, unsigned open) {
    const Corners first = part_.corners_at(0), last = part_.corners_at(part_.degree);
    const Value zero(0.0);
    Mask result = determinant(first) * determinant(last) < zero;
    if ((result.bits() & open) == 0) return 0;
    const auto normal = filters::cross(kernel::minus(middle[1], middle[0]),
                                       kernel::minus(middle[corners - 1], middle[0]));
    const Value x = abs(normal[0]), y = abs(normal[1]), z = abs(normal[2]);
    const Mask is_y = (y > x) & (y >= z), is_z = (z > x) & (z > y);
    for (const Corners* const w : {&first, &middle, &last}) {
      Mask is_positive = Mask::all(), is_negative = Mask::all();
      for (std::size_t i = 0; i < corners; ++i) {
        const auto c = filters::cross((*w)[i], (*w)[(i + 1) % corners]);
        const Value component = select(is_z, c[2], select(is_y, c[1], c[0]));
        is_positive = is_positive & (component > zero);
        is_negative = is_negative & (component < zero);
      }
      result = result & (is_positive | is_negative);
    }
    if ((result.bits() & open) == 0) return 0;
    return result.bits() & Crossing<Lanes, kind>(part_, is_y, is_z).is_proved(det_).bits();
  }

  /// Encloses the zeros of det by its signs on both sides of guesses.
  void enclose_crossings(const Found& found) {
    const Value time = found.begin + (found.end - found.begin) * guess_zeros(found_.det);
    const auto [lower, upper] = enclosure(found, time);
    const AtTime<Lanes, kind> before(found.rows, lower), after(found.rows, upper);
    const auto sign_before = before.determinant(), sign_after = after.determinant();
    const Mask from_above = Value::load(found_.det.coefficient[0].data()) > Value(0.0);
    const Mask is_begin = lower == found.begin, is_end = upper == found.end;
    const Mask falls =
        from_above & (is_begin | sign_before.is_positive) & (is_end | sign_after.is_negative);
    const Mask rises = (is_begin | sign_before.is_negative) & (is_end | sign_after.is_positive);
    report(falls.bits() | (rises.bits() & ~from_above.bits()), lower, upper,
           Nearest(before.places()));
  }

  // ---- A distance ----

  /// The lanes whose ends are contacts.
  unsigned contacts_at_end() {
    const auto [u, v] = closest_point(Nearest(part_.corners_at(part_.degree)));
    return is_contact<norm>(part_, part_.degree, u, v).bits();
  }

  /// Halves a piece, unless it is short and its end the bound of the time of impact.
  void narrow(std::size_t lane, bool ends_in_contact) {
    const double end = begin_[lane] + length_[lane];
    if (ends_in_contact) upper_[lane] = end;
    if (end != upper_[lane] || length_[lane] > short_length) {
      halve(lane);
    } else {
      add_found(lane);
    }
  }

  /// The greatest gap in a direction, approximations.
  struct Gap {
    kernel::Vector<Value> direction;
    Value size;

    explicit Gap(const AtTime<Lanes, kind>& at) {
      const Corners w = at.approximate();
      direction = Nearest(w).direction;
      size = filters::dot(direction, w[0]);
      for (std::size_t i = 1; i < corners; ++i) size = min(size, filters::dot(direction, w[i]));
      size = size - at.reach();
    }
  };

  /// Encloses the first contacts of pieces whose ends are contacts. The guess is by secants: the
  /// pieces are so short that the second one is enough.
  void enclose_approaches(const Found& found) {
    const Value length = found.end - found.begin;
    const Gap at_begin(AtTime<Lanes, kind>(found.rows, found.begin));
    const Gap at_end(AtTime<Lanes, kind>(found.rows, found.end));
    const Value slope = (at_end.size - at_begin.size) / length;
    const auto in_piece = [&](const Value& time) { return max(min(time, found.end), found.begin); };
    Value time = in_piece(found.begin - at_begin.size / slope);
    time = in_piece(time - Gap(AtTime<Lanes, kind>(found.rows, time)).size / slope);
    const auto [lower, upper] = enclosure(found, time);
    const Gap at_lower(AtTime<Lanes, kind>(found.rows, lower));
    const Value n(kernel::unit_length<double>);
    PreciseGap<Lanes, kind> before(found.rows, denominators_, n, found.begin, lower);
    const AtTime<Lanes, kind> after(found.rows, upper);
    const Nearest nearest(after.approximate());
    const auto [u, v] = closest_point(nearest);
    const Mask begins =
        (lower == found.begin) | before.is_positive(at_begin.direction, at_lower.direction);
    const Mask ends = (upper == found.end) | after.is_contact(norm, u, v);
    report((begins & ends).bits(), lower, upper, nearest);
  }

  // ---- Times of impact ----

  void add_found(std::size_t lane) {
    const std::size_t place = found_.count++;
    found_.index[place] = index_[lane];
    found_.begin[place] = begin_[lane];
    found_.length[place] = length_[lane];
    if constexpr (!separated) {
      found_.det.degree = det_.degree;
      for (std::size_t m = 0; m <= det_.degree; ++m) {
        found_.det.coefficient[m][place] = det_.coefficient[m][lane];
      }
    }
    if (found_.count == width) enclose_found();
    refill(lane);
  }

  struct Found {
    Rows<Lanes> rows;
    Value begin, end;
  };

  void enclose_found() {
    if (found_.count == 0) return;
    const Value begin = Value::load(found_.begin.data());
    Found found{{block_, {}}, begin, begin + Value::load(found_.length.data())};
    for (std::size_t lane = 0; lane < width; ++lane) {
      found.rows.first[lane] = numbers_of(found_.index[lane < found_.count ? lane : 0]);
    }
    if constexpr (separated) {
      enclose_approaches(found);
    } else {
      enclose_crossings(found);
    }
    found_.count = 0;
  }

  /// An interval around a guess, in the piece.
  [[nodiscard]] std::array<Value, 2> enclosure(const Found& found, const Value& time) const {
    const Value half_width = Value(0.4 * block_.toi_tolerance) * time;
    return {max(found.begin, time - half_width), min(found.end, time + half_width)};
  }

  /// Reports the enclosures that are proved, if they are narrow enough.
  void report(unsigned proved, const Value& lower, const Value& upper, const Nearest& nearest) {
    const Mask is_narrow = upper - lower <= Value(block_.toi_tolerance) * upper;
    const unsigned all = kernel::first_lanes<Lanes>(found_.count);
    const unsigned enclosed = proved & is_narrow.bits() & all;
    kernel::store_impacts<Lanes>(output_, found_.index, enclosed, {lower, upper},
                                 closest_point(nearest));
    kernel::append_lanes<Lanes>(output_.undecided, found_.index, all & ~enclosed);
  }

  Polygons loaded_;
  Polygons whole_{};  // idle lanes hold numbers
  Polygons part_;
  alignas(64) kernel::Numbers<Lanes> begin_;
  alignas(64) kernel::Numbers<Lanes> length_;
  alignas(64) kernel::Numbers<Lanes> upper_;  ///< a time of contact, or 2
  DeterminantForms<Lanes> det_;
  Impacts<Lanes> found_;

  const Block& block_;
  const KernelList<std::uint32_t>& queries_;
  KernelOutput& output_;
  std::size_t next_ = 0;                           ///< in the list
  std::array<std::uint32_t, width> loaded_index_;  ///< the lanes of `loaded_`
  std::array<std::uint32_t, width> index_;
  std::array<int, width> steps_;
  unsigned waiting_ = 0;  ///< the loaded lanes that have not been taken
  unsigned busy_ = 0;     ///< the lanes that have a query
  Denominators denominators_;
};

template <class Lanes, ContactKind kind>
inline void search_kind(const Block& block, const KernelList<std::uint32_t>& queries,
                        Denominators denominators, KernelOutput& output) {
  if (block.separation.distance == 0.0) {
    Search<Lanes, kind, Norm::l2, false>::run(block, queries, denominators, output);
  } else if (block.separation.norm == Norm::l2) {
    Search<Lanes, kind, Norm::l2, true>::run(block, queries, denominators, output);
  } else {
    Search<Lanes, kind, Norm::linf, true>::run(block, queries, denominators, output);
  }
}

/// Runs stages 2 and 3.
template <class Lanes>
void search(const Block& block, const KernelList<std::uint32_t>& queries, Denominators denominators,
            KernelOutput& output) {
  if (block.kind == ContactKind::vertex_face) {
    search_kind<Lanes, ContactKind::vertex_face>(block, queries, denominators, output);
  } else {
    search_kind<Lanes, ContactKind::edge_edge>(block, queries, denominators, output);
  }
}

}  // namespace touchstone::fast::curved

namespace touchstone::fast {

template <class Lanes>
constexpr CurvedKernel curved_kernel_on(InstructionSet instructions) {
  return {.instructions = instructions,
          .axis = curved::axis_stage<Lanes>,
          .search = curved::search<Lanes>,
          .product_then_sum = product_then_sum<Lanes>};
}

}  // namespace touchstone::fast
