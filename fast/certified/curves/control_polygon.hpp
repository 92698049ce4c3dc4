#pragma once

/// \file
/// The corners of queries on curves by their control points, in lanes, one query a lane: in doubles
/// with a bound of their errors.
///
/// With numerators a_i ω_i and b_j φ_j of degree k, the corner a − b times both denominators is the
/// curve of degree 2k with the control points
///
///     Σ_{i+j=m} α_ij ω_i φ_j (a_i − b_j),   α_ij = C(k,i) C(k,j) / C(2k,m),   Σ α_ij = 1.
///
/// If the weights of both are equal, one denominator is enough: degree k, ω_m (a_m − b_m); without
/// weights a_m − b_m. If the points of a primitive have common weights, as on a rigid body, all
/// corners have the same factor. The distance is multiplied by it, and its control values follow.
/// Otherwise each corner has its own positive factor, which does not matter at distance 0: the
/// proofs there depend only on signs of v·w_i, of components of w_i × w_j and of det.
///
/// **Errors.** Let M be the greatest magnitude of a term without its α, u = 2^-53. A control value
/// is computed by at most k + 6 roundings of terms whose magnitudes add up to at most M: its error
/// is at most (k + 7) u M while nothing underflows; 2^-1060 covers underflow (no weight is
/// subnormal).
///
/// **A part of the time.** The control point j of a curve of degree K on [a,b] is its polar form
/// at K − j times a and j times b: K levels of x (1−t) + y t with t = a or b. A level rounds 1 − t,
/// two products and a sum: at most 3 u M (1 + u)^2 and an underflow. It keeps the errors of x and y
/// below the greater of both, because it is a convex combination. So the error on a part is that
/// on [0,1] plus at most 4 K (u M + 2^-1060), and no value exceeds M (1 + 2^-45).

#include <array>
#include <cstddef>
#include <utility>

#include "fast/certified/kernel.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast::curved {

inline constexpr double unit_roundoff = 0x1p-53;
inline constexpr double underflow = 0x1p-1060;
/// The greatest control value: no cube overflows. Greater ones are left to the exact stage.
inline constexpr double greatest_magnitude = 0x1p100;

// ---- Polygons -----------------------------------------------------------------------------------

/// Polygons in memory. A control point has the coordinates of corner i on an axis at place
/// axis · corners + i, then the distance.
template <class Lanes, ContactKind kind>
struct ControlPolygons {
  using Value = typename Lanes::Value;
  using Row = kernel::Numbers<Lanes>;
  static constexpr std::size_t corners = kind == ContactKind::vertex_face ? 3 : 4;
  static constexpr std::size_t size = 3 * corners + 1;
  using Corners = std::array<kernel::Vector<Value>, corners>;

  /// The points whose difference a corner is. (A copy that is local to the kernel.)
  static constexpr std::array<Corner, corners> points_of_corner = [] {
    std::array<Corner, corners> result{};
    for (std::size_t i = 0; i < corners; ++i) {
      result[i] = kind == ContactKind::vertex_face ? vertex_face_corners[i] : edge_edge_corners[i];
    }
    return result;
  }();

  alignas(sizeof(Row)) std::array<std::array<Row, size>, greatest_corner_degree + 1> point;
  alignas(sizeof(Row)) Row magnitude;  ///< M: of all values
  alignas(sizeof(Row)) Row error;      ///< of all values
  std::size_t degree = 0;

  [[nodiscard]] Value at(std::size_t k, std::size_t place) const {
    return Value::load(point[k][place].data());
  }
  [[nodiscard]] Value reach(std::size_t k) const { return at(k, size - 1); }
  void set(std::size_t k, std::size_t place, const Value& value) {
    value.store(point[k][place].data());
  }

  /// Copies a lane of another.
  void take(std::size_t lane, const ControlPolygons& from, std::size_t lane_of_other) {
    degree = from.degree;
    for (std::size_t k = 0; k <= degree; ++k) {
      for (std::size_t i = 0; i < size; ++i) point[k][i][lane] = from.point[k][i][lane_of_other];
    }
    magnitude[lane] = from.magnitude[lane_of_other];
    error[lane] = from.error[lane_of_other];
  }

  [[nodiscard]] Corners corners_at(std::size_t k) const {
    Corners result;
    for (std::size_t i = 0; i < corners; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) result[i][axis] = at(k, axis * corners + i);
    }
    return result;
  }
};

// ---- Loading ------------------------------------------------------------------------------------

/// The numbers of `width` queries of a block.
template <class Lanes>
struct Rows {
  using Value = typename Lanes::Value;
  const Block& block;
  std::array<const double*, Lanes::width> first;

  [[nodiscard]] std::array<const double*, Lanes::width> addresses(std::size_t offset) const {
    std::array<const double*, Lanes::width> result;
    for (std::size_t lane = 0; lane < Lanes::width; ++lane) result[lane] = first[lane] + offset;
    return result;
  }
  [[nodiscard]] std::size_t offset(std::size_t k, std::size_t point) const {
    return (k * moving_points + point) * block.numbers_of_point();
  }
  [[nodiscard]] kernel::Vector<Value> x(std::size_t k, std::size_t point) const {
    const auto rows = addresses(offset(k, point));
    // Nothing is read after the last number of the array.
    const bool is_last = k == block.degree && point + 1 == moving_points && !block.is_rational;
    const auto x = is_last ? Lanes::load_backwards(rows) : Lanes::load(rows);
    return {x[0], x[1], x[2]};
  }
  [[nodiscard]] Value weight(std::size_t k, std::size_t point) const {
    if (!block.is_rational) return Value(1.0);
    return Lanes::load_backwards(addresses(offset(k, point) + 1))[2];
  }
};

/// i out of n ≤ 3 · greatest_corner_degree, by Pascal's triangle. (A copy that is local to the
/// kernel.)
template <class Lanes>
inline double binomial(std::size_t n, std::size_t i) {
  constexpr std::size_t size = 3 * greatest_corner_degree + 1;
  static constexpr auto rows = [] {
    std::array<std::array<double, size>, size> result{};
    for (std::size_t row = 0; row < size; ++row) {
      result[row][0] = 1.0;
      for (std::size_t k = 1; k <= row; ++k) {
        result[row][k] = result[row - 1][k - 1] + result[row - 1][k];
      }
    }
    return result;
  }();
  return rows[n][i];
}

/// Loads polygons.
template <class Lanes, ContactKind kind>
class Loading {
 public:
  using Value = typename Lanes::Value;
  using Polygons = ControlPolygons<Lanes, kind>;
  using Mask = kernel::MaskOf<Value>;

  /// The lanes whose numbers are finite and not too large. The others are undefined.
  static Mask run(const Rows<Lanes>& rows, Denominators denominators, Polygons& to) {
    Loading loading(rows, to);
    if (denominators == Denominators::one) {
      loading.subtract();
      return loading.finish(3.0);
    }
    loading.multiply(denominators == Denominators::four);
    return loading.finish(static_cast<double>(rows.block.degree) + 7.0);
  }

 private:
  Loading(const Rows<Lanes>& rows, Polygons& to)
      : rows_(rows), to_(to), distance_(rows.block.separation.distance) {}

  using Point = std::array<kernel::Vector<Value>, moving_points>;

  [[nodiscard]] Point point(std::size_t k) const {
    return {rows_.x(k, 0), rows_.x(k, 1), rows_.x(k, 2), rows_.x(k, 3)};
  }

  /// Notes a term for M. A term that is not finite makes the sum NaN.
  void note(const Value& term) {
    greatest_ = max(greatest_, abs(term));
    not_finite_ = not_finite_ + (term - term);
  }

  /// The corners a − b times weight(a, b), of control points that may differ.
  template <class Weight, class Take>
  void for_each_corner(const Point& of_plus, const Point& of_minus, const Weight& weight,
                       const Take& take) {
    constexpr std::size_t corners = Polygons::corners;
    for (std::size_t i = 0; i < corners; ++i) {
      const Corner& corner = Polygons::points_of_corner[i];
      const Value of_corner = weight(corner.plus, corner.minus);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Value term = (of_plus[corner.plus][axis] - of_minus[corner.minus][axis]) * of_corner;
        note(term);
        take(axis * corners + i, term);
      }
    }
    const Value reach = distance_ * weight(0, moving_points - 1);
    note(reach);
    take(Polygons::size - 1, reach);
  }

  void subtract() {
    to_.degree = rows_.block.degree;
    for (std::size_t k = 0; k <= to_.degree; ++k) {
      const Point x = point(k);
      const Value weight = rows_.weight(k, 0);
      for_each_corner(
          x, x, [&](std::size_t, std::size_t) { return weight; },
          [&](std::size_t place, const Value& term) { to_.set(k, place, term); });
    }
  }

  /// \param has_own True if each point has its own weights.
  void multiply(bool has_own) {
    const std::size_t degree = rows_.block.degree;
    to_.degree = 2 * degree;
    for (std::size_t m = 0; m <= to_.degree; ++m) {
      for (std::size_t place = 0; place < Polygons::size; ++place) to_.set(m, place, Value(0.0));
    }
    for (std::size_t i = 0; i <= degree; ++i) {
      const Point of_plus = point(i);
      for (std::size_t j = 0; j <= degree; ++j) {
        const Value alpha(binomial<Lanes>(degree, i) * binomial<Lanes>(degree, j) /
                          binomial<Lanes>(2 * degree, i + j));
        const Value common = rows_.weight(i, 0) * rows_.weight(j, moving_points - 1);
        for_each_corner(
            of_plus, point(j),
            [&](std::size_t plus, std::size_t minus) {
              return has_own ? rows_.weight(i, plus) * rows_.weight(j, minus) : common;
            },
            [&](std::size_t place, const Value& term) {
              to_.set(i + j, place, to_.at(i + j, place) + term * alpha);
            });
      }
    }
  }

  Mask finish(double roundings) {
    const Value magnitude = greatest_ * Value(1.0 + 0x1p-44);
    const auto levels = 4.0 * static_cast<double>(to_.degree);
    magnitude.store(to_.magnitude.data());
    (magnitude * Value((roundings + levels) * unit_roundoff) + Value((1.0 + levels) * underflow))
        .store(to_.error.data());
    // NaN compares false.
    return (magnitude <= Value(greatest_magnitude)) & (not_finite_ <= Value(0.0));
  }

  const Rows<Lanes>& rows_;
  Polygons& to_;
  Value distance_;
  Value greatest_ = Value(0.0);
  Value not_finite_ = Value(0.0);
};

// ---- Parts of the time --------------------------------------------------------------------------

/// A time, and 1 minus it.
template <class Value>
struct Time {
  Value t, rest;

  explicit Time(const Value& time) : t(time), rest(Value(1.0) - time) {}
};

/// One level of the polar form. (By recursion over the degree, so that all values stay in
/// registers.)
template <std::size_t degree, class Value>
inline std::array<Value, degree> blended(const std::array<Value, degree + 1>& x,
                                         const Time<Value>& time) {
  std::array<Value, degree> result;
  for (std::size_t j = 0; j < degree; ++j) result[j] = x[j] * time.rest + x[j + 1] * time.t;
  return result;
}

template <std::size_t degree, class Value>
inline Value value_at(const std::array<Value, degree + 1>& x, const Time<Value>& time) {
  if constexpr (degree == 0) {
    return x[0];
  } else {
    return value_at<degree - 1>(blended<degree>(x, time), time);
  }
}

/// The polar forms of x, of which `degree` times are left, on [a,b].
template <std::size_t degree, class Value, class Take>
inline void restrict_row(const std::array<Value, degree + 1>& x, const Time<Value>& a,
                         const Time<Value>& b, const Take& take) {
  take(degree, value_at<degree>(x, b));
  if constexpr (degree > 0) restrict_row<degree - 1>(blended<degree>(x, a), a, b, take);
}

template <std::size_t degree, bool separated, class Lanes, ContactKind kind>
inline void restrict_degree(const ControlPolygons<Lanes, kind>& whole,
                            const Time<typename Lanes::Value>& begin,
                            const Time<typename Lanes::Value>& end,
                            ControlPolygons<Lanes, kind>& part) {
  using Value = typename Lanes::Value;
  constexpr std::size_t size = ControlPolygons<Lanes, kind>::size - (separated ? 0 : 1);
  for (std::size_t place = 0; place < size; ++place) {
    std::array<Value, degree + 1> x;
    for (std::size_t k = 0; k <= degree; ++k) x[k] = whole.at(k, place);
    restrict_row<degree>(x, begin, end,
                         [&](std::size_t k, const Value& value) { part.set(k, place, value); });
  }
}

/// The polygons on [begin, end] of each lane, with the bounds of `whole`.
template <bool separated, class Lanes, ContactKind kind>
inline void restrict_to(const ControlPolygons<Lanes, kind>& whole,
                        const typename Lanes::Value& begin, const typename Lanes::Value& end,
                        ControlPolygons<Lanes, kind>& part) {
  part.degree = whole.degree;
  part.magnitude = whole.magnitude;
  part.error = whole.error;
  const Time a(begin), b(end);
  [&]<std::size_t... degree>(std::index_sequence<degree...> /*degrees*/) {
    static_cast<void>((
        (whole.degree == degree && (restrict_degree<degree, separated>(whole, a, b, part), true)) ||
        ...));
  }
  (std::make_index_sequence<greatest_corner_degree + 1>());
}

}  // namespace touchstone::fast::curved
