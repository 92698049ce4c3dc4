#pragma once

/// \file
/// Proofs of contact on curves, in lanes.
///
/// **Theorem 1** (d = 0). On an interval of time let det(w_0, w_1, w_last) have Bernstein
/// coefficients with exactly one change of sign, the first and the last not 0, and let for one axis
/// the components of w_i × w_{i+1} of all sides, in cyclic order, have positive coefficients only,
/// or negative ones only. Then exactly one time of the interval is a contact: the zero of det.
/// *Proof.* By Descartes' rule det has exactly one zero. The sum of the components is that of the
/// normal N times 1 (triangle) or 2 (parallelogram), so N ≠ 0, and by the rule at a fixed time
/// (docs/theory.md, section 2.1) det = 0 is a contact, and det ≠ 0 is none. ∎
///
/// **Theorem 2** (d > 0). If ‖F(t,u,v)‖ ≤ d for one (u,v) of the domain, t is a contact.
///
/// All are multiplied by the positive denominators. At distance 0 each corner may have factors of
/// its own (control_polygon.hpp): they change no sign in theorem 1, neither of det nor of a
/// component of w_i × w_{i+1}.
///
/// **Errors.** Let K be the degree of the corners, M their greatest magnitude, e their error and
/// u = 2^-53. Forms have the coefficients C(n,k) b_k, b_k the Bernstein coefficients. The sums of
/// the C(K,i) C(K,j) with i + j = m are C(2K,m), so the terms of a coefficient of the component
/// x y' − y x' add up to at most C(2K,m) · 2 M². With two factors scaled, a product, at most K + 1
/// sums twice and a difference they have at most K + 6 roundings. The errors of the corners change
/// it by at most C(2K,m) (4 M e + 2 e²). In all its error is at most
///
///     C(2K,m) (2 (K+8) u M² + 5 M e).
///
/// The terms of a coefficient of det add up to at most C(3K,m) · 6 M³, with at most 3 K + 6 more
/// roundings; with the errors of its factors its error is at most
///
///     C(3K,m) ((24 K + 100) u M³ + 22 M² e).
///
/// Underflow adds less than 2^-1040 to the first and 2^-900 to the second. The point
/// w_0 + (w_1 − w_0) u + (w_last − w_0) v has an error of at most δ = 24 u M + 6 e on each axis.
/// (Its terms are at most 2 M, its sums 5 M; e counts five times.)

#include <array>
#include <cstddef>

#include "fast/certified/curves/control_polygon.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "touchstone/filters/ball.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::curved {

// ---- Theorem 1 ----------------------------------------------------------------------------------

/// Σ c_k (1−t)^(n−k) t^k in each lane.
template <class Value, std::size_t most>
using Form = std::array<Value, most + 1>;

/// The coefficients of det; in each lane those of another query.
template <class Lanes>
struct DeterminantForms {
  static constexpr std::size_t most = 3 * greatest_corner_degree;
  alignas(64) std::array<kernel::Numbers<Lanes>, most + 1> coefficient;
  std::size_t degree = 0;
};

/// The lanes in which the coefficients c certainly have exactly one change of sign, given the signs
/// that are certain: those of the first, then at most one of any kind, then those of the last.
template <class Mask>
class OneChange {
 public:
  OneChange(const Mask& all, const Mask& none) : before_(all), after_(none) {}

  void add(const Mask& has_first_sign, const Mask& has_last_sign) {
    after_ = before_ | (after_ & has_last_sign);
    before_ = before_ & has_first_sign;
  }
  [[nodiscard]] const Mask& result() const { return after_; }

 private:
  Mask before_;  ///< all had the first sign
  Mask after_;   ///< one was passed over, and all after it had the last sign
};

/// Theorem 1 for an axis of each lane.
template <class Lanes, ContactKind kind>
class Crossing {
 public:
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  using Polygons = ControlPolygons<Lanes, kind>;

  /// \param is_y, is_z The lanes whose axis this is; it is x elsewhere.
  Crossing(const Polygons& polygons, const Mask& is_y, const Mask& is_z)
      : polygons_(polygons), degree_(polygons.degree), is_y_(is_y), is_z_(is_z) {
    for (std::size_t k = 0; k <= degree_; ++k) {
      const Value scale(binomial<Lanes>(degree_, k));
      for (std::size_t place = 0; place < 3 * corners; ++place) {
        x_[place][k] = polygons.at(k, place) * scale;
      }
    }
  }

  /// The lanes in which exactly one time is a contact.
  [[nodiscard]] Mask is_proved(DeterminantForms<Lanes>& det) const {
    Mask result = has_one_orientation();
    if (result.bits() != 0) result = result & changes_once(det);
    return result;
  }

 private:
  static constexpr std::size_t corners = Polygons::corners;
  static constexpr std::size_t most = greatest_corner_degree;
  using OfCorner = Form<Value, most>;
  using OfSide = Form<Value, 2 * most>;

  [[nodiscard]] Value magnitude() const { return Value::load(polygons_.magnitude.data()); }
  [[nodiscard]] Value error() const { return Value::load(polygons_.error.data()); }

  /// a b' − b a'.
  void cross(const OfCorner& a, const OfCorner& b, const OfCorner& a2, const OfCorner& b2,
             OfSide& result) const {
    for (std::size_t m = 0; m <= 2 * degree_; ++m) {
      const std::size_t least = m > degree_ ? m - degree_ : 0;
      Value plus = a[least] * b2[m - least], minus = b[least] * a2[m - least];
      for (std::size_t i = least + 1; i <= degree_ && i <= m; ++i) {
        plus = plus + a[i] * b2[m - i];
        minus = minus + b[i] * a2[m - i];
      }
      result[m] = plus - minus;
    }
  }

  /// Corner i on the axis `steps` after the lane's in cyclic order.
  [[nodiscard]] OfCorner chosen(std::size_t i, std::size_t steps) const {
    OfCorner result;
    const OfCorner& of_x = x_[(0 + steps) % 3 * corners + i];
    const OfCorner& of_y = x_[(1 + steps) % 3 * corners + i];
    const OfCorner& of_z = x_[(2 + steps) % 3 * corners + i];
    for (std::size_t k = 0; k <= degree_; ++k) {
      result[k] = select(is_z_, of_z[k], select(is_y_, of_y[k], of_x[k]));
    }
    return result;
  }

  [[nodiscard]] Mask has_one_orientation() const {
    std::array<std::array<OfCorner, 2>, corners> plane;
    for (std::size_t i = 0; i < corners; ++i) plane[i] = {chosen(i, 1), chosen(i, 2)};
    const double sums = 2.0 * (static_cast<double>(degree_) + 8.0) * unit_roundoff;
    const Value bound =
        magnitude() * (magnitude() * Value(sums) + error() * Value(5.0)) * Value(above);
    Mask is_positive = Mask::all(), is_negative = Mask::all();
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t j = (i + 1) % corners;
      OfSide side;
      cross(plane[i][0], plane[i][1], plane[j][0], plane[j][1], side);
      for (std::size_t m = 0; m <= 2 * degree_; ++m) {
        const Value least = (bound + Value(0x1p-1040)) * Value(binomial<Lanes>(2 * degree_, m));
        is_positive = is_positive & (side[m] > least);
        is_negative = is_negative & (side[m] < Value(0.0) - least);
      }
      if ((is_positive | is_negative).bits() == 0) break;
    }
    return is_positive | is_negative;
  }

  [[nodiscard]] Mask changes_once(DeterminantForms<Lanes>& det) const {
    Form<Value, 3 * most> sum;
    det.degree = 3 * degree_;
    for (std::size_t m = 0; m <= det.degree; ++m) sum[m] = Value(0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t y = (axis + 1) % 3 * corners, z = (axis + 2) % 3 * corners;
      OfSide side;
      cross(x_[y + 1], x_[z + 1], x_[y + corners - 1], x_[z + corners - 1], side);
      const OfCorner& first = x_[axis * corners];
      for (std::size_t i = 0; i <= degree_; ++i) {
        for (std::size_t j = 0; j <= 2 * degree_; ++j) {
          sum[i + j] = sum[i + j] + first[i] * side[j];
        }
      }
    }
    const double sums = (24.0 * static_cast<double>(degree_) + 100.0) * unit_roundoff;
    const Value square = magnitude() * magnitude();
    const Value bound = square * (magnitude() * Value(sums) + error() * Value(22.0)) * Value(above);
    const Value zero(0.0);
    const Mask begins_above = sum[0] > zero;
    OneChange<Mask> change(Mask::all(), Mask::none());
    Mask ends = Mask::all();
    for (std::size_t m = 0; m <= det.degree; ++m) {
      const Value least = (bound + Value(0x1p-900)) * Value(binomial<Lanes>(det.degree, m));
      const Value turned = select(begins_above, sum[m], zero - sum[m]);
      const Mask has_first_sign = turned > least, has_last_sign = turned < zero - least;
      if (m == 0) ends = ends & has_first_sign;
      if (m == det.degree) ends = ends & has_last_sign;
      change.add(has_first_sign, has_last_sign);
      sum[m].store(det.coefficient[m].data());
    }
    return ends & change.result();
  }

  /// Covers the roundings of a bound.
  static constexpr double above = 1.0 + 0x1p-40;

  const Polygons& polygons_;
  std::size_t degree_;
  Mask is_y_, is_z_;
  std::array<OfCorner, 3 * corners> x_;
};

// ---- The zero of det ----------------------------------------------------------------------------

/// Zeros in (0,1) of forms that have different signs at 0 and 1, approximations: secants (Illinois)
/// and bisection.
template <class Lanes>
inline typename Lanes::Value guess_zeros(const DeterminantForms<Lanes>& form) {
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  const Value zero(0.0), one(1.0), half(0.5);
  const auto value = [&](const Value& y) {
    const Value rest = one - y;
    Value sum = zero, power = one;
    for (std::size_t k = 0; k <= form.degree; ++k) {
      sum = sum * rest + Value::load(form.coefficient[k].data()) * power;
      power = power * y;
    }
    return sum;
  };
  Value lower = zero, upper = one, at_lower = value(zero), at_upper = value(one);
  const Mask begins_above = at_lower > zero;
  for (int step = 0; step < 60; ++step) {
    const Mask is_wide = upper - lower > Value(0x1p-50) * upper;
    if (is_wide.bits() == 0) break;
    Value y = lower - at_lower * (upper - lower) / (at_upper - at_lower);
    const Mask is_inside = (y > lower) & (y < upper);
    const Value middle = half * (lower + upper);
    y = step % 3 == 2 ? middle : select(is_inside, y, middle);
    const Value at = value(y);
    // The other end counts half, so that both move. An exact zero ends the search.
    const Mask is_zero = at == zero;
    const Mask is_before = select(begins_above, at, zero - at) > zero;
    lower = select(is_wide & (is_before | is_zero), y, lower);
    upper = select(is_wide, select(is_before, upper, y), upper);
    at_lower = select(is_wide, select(is_before, at, at_lower * half), at_lower);
    at_upper = select(is_wide, select(is_before, at_upper * half, at), at_upper);
  }
  return half * (lower + upper);
}

/// A level of de Casteljau's algorithm on the first coefficients.
template <class Ball>
inline void blend(std::array<Ball, greatest_degree + 1>& x, std::size_t count,
                  const Time<Ball>& time) {
  for (std::size_t k = 0; k < count; ++k) x[k] = x[k] * time.rest + x[k + 1] * time.t;
}

/// The value of the Bernstein coefficients x at a time.
template <class Ball>
inline Ball value_at(std::array<Ball, greatest_degree + 1> x, std::size_t degree,
                     const Time<Ball>& time) {
  for (std::size_t level = degree; level > 0; --level) blend(x, level, time);
  return x[0];
}

/// Queries at a time of each lane, computed from their own numbers with error bounds
/// (touchstone/filters/ball.hpp).
template <class Lanes, ContactKind kind>
class AtTime {
 public:
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  using Ball = filters::BallOf<Value>;
  using Polygons = ControlPolygons<Lanes, kind>;
  static constexpr std::size_t corners = Polygons::corners;

  AtTime(const Rows<Lanes>& rows, const Value& time) : rows_(rows) {
    const Time<Ball> at(Ball({time, Value(0.0)}));
    const std::array<std::array<Ball, 4>, moving_points> points{place(0, at), place(1, at),
                                                                place(2, at), place(3, at)};
    reach_ = Ball(rows.block.separation.distance);
    if (rows.block.is_rational) reach_ = reach_ * points[0][3] * points[3][3];
    for (std::size_t i = 0; i < moving_points; ++i) weight_[i] = points[i][3].center.high;
    for (std::size_t i = 0; i < corners; ++i) {
      const auto &a = points[Polygons::points_of_corner[i].plus],
                 &b = points[Polygons::points_of_corner[i].minus];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        w_[i][axis] = rows.block.is_rational ? a[axis] * b[3] - b[axis] * a[3] : a[axis] - b[axis];
      }
    }
  }

  /// The signs of det that are certain. (With coordinates up to greatest_magnitude and weights up
  /// to 2^30 the corners are below 2^161, det below 2^486.)
  struct Signs {
    Mask is_positive, is_negative;
  };
  [[nodiscard]] Signs determinant() const {
    const auto &a = w_[0], &b = w_[1], &c = w_[corners - 1];
    const Ball det = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0]);
    const Mask is_usual = greatest_ <= Value(greatest_magnitude);
    return {filters::is_positive(det) & is_usual, filters::is_positive(-det) & is_usual};
  }

  /// Theorem 2, by the point (u,v) of the domain.
  [[nodiscard]] Mask is_contact(Norm norm, const Value& u, const Value& v) const {
    const Ball of_u({u, Value(0.0)}), of_v({v, Value(0.0)});
    Mask result = greatest_ <= Value(greatest_magnitude);
    Ball square;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Ball &first = w_[0][axis], &second = w_[1][axis], &last = w_[corners - 1][axis];
      const Ball x = first + (second - first) * of_u + (last - first) * of_v;
      square = square + x * x;
      if (norm == Norm::linf) {
        result = result & filters::is_positive(reach_ - x) & filters::is_positive(reach_ + x);
      }
    }
    return norm == Norm::linf ? result : result & filters::is_positive(reach_ * reach_ - square);
  }

  /// The corners without denominators, approximations.
  [[nodiscard]] typename Polygons::Corners places() const {
    typename Polygons::Corners result = approximate();
    if (!rows_.block.is_rational) return result;
    for (std::size_t i = 0; i < corners; ++i) {
      const Corner& corner = Polygons::points_of_corner[i];
      const Value factor = weight_[corner.plus] * weight_[corner.minus];
      for (Value& x : result[i]) x = x / factor;
    }
    return result;
  }
  /// The corners and the distance, approximations.
  [[nodiscard]] Value reach() const { return reach_.center.high; }
  [[nodiscard]] typename Polygons::Corners approximate() const {
    typename Polygons::Corners result;
    for (std::size_t i = 0; i < corners; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) result[i][axis] = w_[i][axis].center.high;
    }
    return result;
  }

 private:
  /// Weighted coordinates and the weight of a point.
  std::array<Ball, 4> place(std::size_t point, const Time<Ball>& time) {
    const std::size_t degree = rows_.block.degree, size = rows_.block.is_rational ? 4 : 3;
    std::array<std::array<Ball, greatest_degree + 1>, 4> row;
    for (std::size_t k = 0; k <= degree; ++k) {
      const kernel::Vector<Value> x = rows_.x(k, point);
      greatest_ = max(greatest_, kernel::greatest(x));
      for (std::size_t axis = 0; axis < 3; ++axis) row[axis][k] = Ball({x[axis], Value(0.0)});
      if (!rows_.block.is_rational) continue;
      row[3][k] = Ball({rows_.weight(k, point), Value(0.0)});
      for (std::size_t axis = 0; axis < 3; ++axis) row[axis][k] = row[axis][k] * row[3][k];
    }
    std::array<Ball, 4> result;
    for (std::size_t i = 0; i < size; ++i) result[i] = value_at(row[i], degree, time);
    return result;
  }

  const Rows<Lanes>& rows_;
  Value greatest_ = Value(0.0);
  std::array<std::array<Ball, 3>, corners> w_;
  std::array<Value, moving_points> weight_;
  Ball reach_;  ///< the distance times the denominators
};

// ---- A distance ---------------------------------------------------------------------------------

/// **Theorem 3.** Let v(t) be linear on [a,b] between two directions of a dual norm of at most n,
/// and let all v(t)·w_i(t) − n·reach(t) have positive Bernstein coefficients. Then no time of [a,b]
/// is a contact: norms are convex, so v(t) has a dual norm of at most n as well.
///
/// Computed from the queries' own numbers with error bounds. The coefficients are C(m,k) times
/// Bernstein's.
template <class Lanes, ContactKind kind>
class PreciseGap {
 public:
  using Value = typename Lanes::Value;
  using Mask = kernel::MaskOf<Value>;
  using Ball = filters::BallOf<Value>;
  using Direction = kernel::Vector<Value>;
  using Polygons = ControlPolygons<Lanes, kind>;
  static constexpr std::size_t corners = Polygons::corners;

  PreciseGap(const Rows<Lanes>& rows, Denominators denominators, const Value& n, const Value& a,
             const Value& b)
      : rows_(rows),
        degree_(rows.block.degree),
        gap_degree_(denominators == Denominators::one ? degree_ : 2 * degree_),
        reach_(Ball({n, Value(0.0)}) * Ball(rows.block.separation.distance)),
        a_(Ball({a, Value(0.0)})),
        b_(Ball({b, Value(0.0)})) {
    constexpr std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
    weights_ = {on_part([&](std::size_t k) { return weight(k, 0); }),
                on_part([&](std::size_t k) { return weight(k, second); })};
  }

  /// Theorem 3 for the directions at a and b.
  [[nodiscard]] Mask is_positive(const Direction& at_a, const Direction& at_b) {
    const auto along_a = along(at_a), along_b = along(at_b);
    Mask result = greatest_ <= Value(greatest_magnitude);
    for (std::size_t i = 0; i < corners; ++i) {
      const Coefficients of_a = gap(along_a, i), of_b = gap(along_b, i);
      for (std::size_t m = 0; m <= gap_degree_ + 1; ++m) {
        const Ball sum = m == 0                 ? of_a[0]
                         : m == gap_degree_ + 1 ? of_b[gap_degree_]
                                                : of_a[m] + of_b[m - 1];
        result = result & filters::is_positive(sum);
      }
    }
    return result;
  }

 private:
  using Row = std::array<Ball, greatest_degree + 1>;
  using Coefficients = std::array<Ball, greatest_corner_degree + 1>;

  /// v·x of each point times its weight, on [a,b].
  [[nodiscard]] std::array<Row, moving_points> along(const Direction& v) {
    std::array<Row, moving_points> result;
    for (std::size_t point = 0; point < moving_points; ++point) {
      result[point] = on_part([&](std::size_t k) { return projection(v, k, point); });
    }
    return result;
  }

  /// The coefficients of v·w_i − n·reach.
  [[nodiscard]] Coefficients gap(const std::array<Row, moving_points>& along, std::size_t i) const {
    const Row &plus = along[Polygons::points_of_corner[i].plus],
              &minus = along[Polygons::points_of_corner[i].minus];
    const Row &of_first = weights_[0], &of_second = weights_[1];
    Coefficients result;
    for (std::size_t k = 0; k <= degree_; ++k) {
      const Ball above = plus[k] - reach_ * of_first[k];
      const double scale = binomial<Lanes>(degree_, k);
      if (gap_degree_ == degree_) {
        result[k] = (above - minus[k]) * Ball(scale);
        continue;
      }
      for (std::size_t j = 0; j <= degree_; ++j) {
        const Ball term = above * of_second[j] - of_first[k] * minus[j];
        result[k + j] = result[k + j] + term * Ball(scale * binomial<Lanes>(degree_, j));
      }
    }
    return result;
  }

  [[nodiscard]] Ball weight(std::size_t k, std::size_t point) const {
    return Ball({rows_.weight(k, point), Value(0.0)});
  }

  [[nodiscard]] Ball projection(const Direction& v, std::size_t k, std::size_t point) {
    const kernel::Vector<Value> x = rows_.x(k, point);
    greatest_ = max(greatest_, kernel::greatest(x));
    Ball sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum = sum + Ball({v[axis], Value(0.0)}) * Ball({x[axis], Value(0.0)});
    }
    return rows_.block.is_rational ? sum * weight(k, point) : sum;
  }

  /// The Bernstein coefficients on [a,b] of those on [0,1]: the polar form.
  template <class At>
  [[nodiscard]] Row on_part(const At& at) const {
    Row x, result;
    for (std::size_t k = 0; k <= degree_; ++k) x[k] = at(k);
    for (std::size_t times_b = degree_; times_b > 0; --times_b) {
      result[times_b] = value_at(x, times_b, b_);
      blend(x, times_b, a_);
    }
    result[0] = x[0];
    return result;
  }

  const Rows<Lanes>& rows_;
  std::size_t degree_;
  std::size_t gap_degree_;
  Ball reach_;  ///< n times the distance
  Time<Ball> a_, b_;
  std::array<Row, 2> weights_;
  Value greatest_ = Value(0.0);
};

/// The lanes in which control point k, the first or the last, is a contact, by the point (u,v).
/// \param u, v In the domain.
template <Norm norm, class Lanes, ContactKind kind>
inline auto is_contact(const ControlPolygons<Lanes, kind>& polygons, std::size_t k,
                       const typename Lanes::Value& u, const typename Lanes::Value& v) {
  using Value = typename Lanes::Value;
  const auto w = polygons.corners_at(k);
  const Value error = Value::load(polygons.error.data());
  const Value delta =
      Value::load(polygons.magnitude.data()) * Value(24.0 * unit_roundoff * 1.0001) +
      error * Value(6.0);
  kernel::Vector<Value> x;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    x[axis] = w[0][axis] + (w[1][axis] - w[0][axis]) * u + (w.back()[axis] - w[0][axis]) * v;
  }
  const Value most = kernel::greatest(x);
  // A bound below the distance times the denominator; 2^-50 covers these and later roundings.
  const Value reach = (polygons.reach(k) - error) * Value(1.0 - 0x1p-50);
  if constexpr (norm == Norm::linf) {
    return (most + delta) * Value(1.0 + 0x1p-50) < reach;
  } else {
    // |x + δ|² ≤ |x|² + 2 √3 δ |x| + 3 δ², and |x| ≤ √3 · most.
    const Value change = delta * (most * Value(6.0) + delta * Value(3.0));
    const Value square = (filters::dot(x, x) + change) * Value(1.0 + 0x1p-49) + Value(0x1p-1000);
    return (square < reach * reach) & (reach > Value(0.0));
  }
}

}  // namespace touchstone::fast::curved
