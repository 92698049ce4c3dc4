#pragma once

/// \file
/// The stages in floating point of the solver for curves: pieces of time in ascending order.
///
/// **Theorem 1** (a piece). Let v be a direction of a dual norm of at most n, and let
/// v·w > n·reach for all control points w of all corners and the control values of the distance.
/// Then no time of the piece is a contact: v·w_i(t) − n·reach(t) is in the hull of its control
/// values.
///
/// The first piece is [0,1]. A piece without contact is left behind; a piece with a proved contact
/// ends the search (contact_proof.hpp); another piece is halved. So nothing before the last piece
/// is a contact, and its only contact, or its first, is the time of impact. What is not proved
/// within some steps goes to the exact stage.
///
/// The computed values have to exceed the bound of filters::CornerGap at the magnitude M of the
/// control values, and (|v|_1 + n) times their error.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "fast/certified/stages/closest_point.hpp"
#include "fast/curved/contact_proof.hpp"
#include "fast/curved/control_polygon.hpp"
#include "fast/platform/scalar_doubles.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/separation_expressions.hpp"

namespace touchstone::fast::curved {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of what it includes

/// A query in the one lane of the parts of the certified solver.
struct OneLane {
  using Value = fast::Value;
  using Mask = fast::Mask;
  static constexpr std::size_t width = 1;
};

using Direction = std::array<double, 3>;

/// A direction with a bound of its dual norm and its greatest component.
struct Separator {
  Direction v{};
  double norm = 0.0;
};

/// Theorem 1.
inline bool separates(const ControlPolygon& polygon, const Separator& separator) {
  constexpr auto bound = filters::corner_gap_double;
  const auto& [v, n] = separator;
  const double greatest =
      std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::max(std::abs(v[2]), n));
  if (!(greatest <= greatest_magnitude)) return false;
  // 4.0001 times the greatest component is above |v|_1 + n and the rounding of this line.
  const double error = greatest * (polygon.magnitude * bound.rounding() + polygon.error * 4.0001) +
                       2.0 * bound.underflow(greatest_magnitude);
  for (std::size_t k = 0; k <= polygon.degree; ++k) {
    const CornerRow& w = polygon.w[k];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto gap = filters::CornerGap::evaluate<double>(
          {v[0], v[1], v[2], n, w[i], w[4 + i], w[8 + i], polygon.reach[k]}, {});
      if (!(gap > error)) return false;  // also NaN
    }
  }
  return true;
}

/// True if a coordinate axis separates: theorem 1 for a unit vector. The two sums of numbers up to
/// M and their errors are covered by thrice the error and 2 u M.
inline bool separates_on_axis(const ControlPolygon& polygon) {
  const double margin = 3.0 * polygon.error + 4.0 * unit_roundoff * polygon.magnitude;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool is_above = true, is_below = true;
    for (std::size_t k = 0; k <= polygon.degree; ++k) {
      const double far = polygon.reach[k] + margin;
      for (std::size_t i = 4 * axis; i < 4 * axis + 4; ++i) {
        is_above = is_above && polygon.w[k][i] > far;
        is_below = is_below && polygon.w[k][i] < -far;
      }
    }
    if (is_above || is_below) return true;
  }
  return false;
}

/// The sum of all control points: a direction for distance 0, where its length does not matter.
inline Separator sum_of_corners(const ControlPolygon& polygon) {
  Separator result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k <= polygon.degree; ++k) {
      for (std::size_t i = 4 * axis; i < 4 * axis + 4; ++i) result.v[axis] += polygon.w[k][i];
    }
  }
  return result;
}

/// The place and direction of the polygon with these corners.
template <Kind kind, Norm norm>
inline kernel::NearestPoint<OneLane, kind, norm> nearest_at(const CornerRow& row) {
  using Nearest = kernel::NearestPoint<OneLane, kind, norm>;
  typename Nearest::Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) corners[i][axis] = Value(row[4 * axis + i]);
  }
  return Nearest(corners);
}

/// The best direction at the time of these corners.
template <Kind kind, Norm norm>
inline Separator separator_at(const CornerRow& corners) {
  const auto nearest = nearest_at<kind, norm>(corners);
  return {{nearest.direction[0].x, nearest.direction[1].x, nearest.direction[2].x},
          kernel::unit_length<double>};
}

/// An interval of time and the query on it.
struct Piece {
  ControlPolygon polygon;
  double begin;
  double length;

  [[nodiscard]] double end() const { return begin + length; }
};

/// What the stages in floating point find; `undecided` goes to the exact stage.
template <Kind kind, Norm norm>
class Search {
 public:
  Search(const ControlPoints& points, const CertifiedOptions& options)
      : points_(points), options_(options), has_distance_(options.separation.distance > 0.0) {}

  CertifiedResult run() {
    const double distance = options_.separation.distance;
    if (points_.is_rational() ? is_apart_on_axis<kind, true>(points_.row(), distance)
                              : is_apart_on_axis<kind, false>(points_.row(), distance)) {
      return free_of_contact(Stage::axis);
    }
    Piece& whole = pieces_[0];
    if (load<kind>(points_, distance, whole.polygon) != Loaded::yes) return undecided();
    if (!has_distance_ && separates(whole.polygon, sum_of_corners(whole.polygon))) {
      return free_of_contact(Stage::direction);
    }
    if (has_distance_ && is_contact_at(whole.polygon, 0)) {
      return contact(0.0, 0.0, whole.polygon.w[0]);
    }
    whole.begin = 0.0;
    whole.length = 1.0;
    count_ = 1;
    for (int step = 0; step < most_steps && count_ > 0; ++step) {
      if (const auto result = examine()) return *result;
    }
    return count_ == 0 ? free_of_contact(Stage::bisection) : undecided();
  }

 private:
  static constexpr int most_steps = 200;
  static constexpr std::size_t most_levels = 20;
  static constexpr int most_halvings = 100;

  static CertifiedResult undecided() { return {.verdict = Verdict::undecided}; }
  static CertifiedResult free_of_contact(Stage stage) {
    return {.verdict = Verdict::no, .stage = stage};
  }

  CertifiedResult contact(double lower, double upper, const CornerRow& corners) const {
    const auto nearest = nearest_at<kind, norm>(corners);
    // The contact counts if it is not after t_max.
    if (upper > options_.t_max) return undecided();
    return {
        .verdict = Verdict::yes,
        .stage = Stage::bisection,
        .toi_lower = lower,
        .toi_upper = upper,
        .u = std::clamp(nearest.u.x, 0.0, 1.0),
        .v = std::clamp(nearest.v.x, 0.0,
                        kind == Kind::edge_edge ? 1.0 : 1.0 - std::clamp(nearest.u.x, 0.0, 1.0))};
  }

  /// Is the time with these control points certainly a contact at the distance?
  [[nodiscard]] bool is_contact_at(const ControlPolygon& polygon, std::size_t k) const {
    const auto nearest = nearest_at<kind, norm>(polygon.w[k]);
    const double u = std::clamp(nearest.u.x, 0.0, 1.0);
    const double v = std::clamp(nearest.v.x, 0.0, 1.0);
    if (kind == Kind::vertex_face && u + v > 1.0) {
      // On the side between, a little inside.
      constexpr double inside = 1.0 - 0x1p-50;
      return is_contact(polygon, k, u / (u + v) * inside, v / (u + v) * inside, norm);
    }
    return is_contact(polygon, k, u, v, norm);
  }

  /// Examines the first of the pieces that are left.
  std::optional<CertifiedResult> examine() {
    Piece& piece = pieces_[--count_];
    // Contacts after t_max do not count.
    if (piece.begin >= options_.t_max && piece.begin > 0.0) {
      count_ = 0;
      return std::nullopt;
    }
    if (separates_on_axis(piece.polygon)) return std::nullopt;
    Piece& first = pieces_[count_ + 1];
    halve(piece.polygon, first.polygon, second_);
    // The direction that is best in the middle.
    if (separates(piece.polygon, separator_at<kind, norm>(second_.w[0]))) return std::nullopt;
    if (has_distance_) {
      if (is_contact_at(piece.polygon, piece.polygon.degree)) return narrowed_by_distance(piece);
    } else if (const auto result = crossing(piece, second_.w[0])) {
      return result;
    }
    if (count_ == most_levels) return undecided();
    first.begin = piece.begin;
    piece.length = first.length = 0.5 * piece.length;
    piece.begin += piece.length;
    piece.polygon.assign(second_);
    count_ += 2;
    return std::nullopt;
  }

  // ---- Distance 0 ----

  static double determinant_at(const ControlPolygon& p, std::size_t k) {
    const auto x = [&](std::size_t i) {
      return filters::Vector3<double>{p.at(k, 0, i), p.at(k, 1, i), p.at(k, 2, i)};
    };
    return filters::dot(x(0), filters::cross(x(1), x(3)));
  }

  /// The axis on which the normal of the polygon with these corners is longest.
  static std::size_t longest_axis(const CornerRow& w) {
    filters::Vector3<double> a, b;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      a[axis] = w[4 * axis + 1] - w[4 * axis];
      b[axis] = w[4 * axis + 3] - w[4 * axis];
    }
    const auto n = filters::cross(a, b);
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (std::abs(n[axis]) > std::abs(n[longest])) longest = axis;
    }
    return longest;
  }

  /// The time of impact of a piece with one contact, if that is proved.
  std::optional<CertifiedResult> crossing(const Piece& piece, const CornerRow& middle) {
    const std::size_t last = piece.polygon.degree;
    const double at_begin = determinant_at(piece.polygon, 0);
    if (at_begin * determinant_at(piece.polygon, last) >= 0.0) return std::nullopt;
    // Without bounds first: most pieces fail here.
    const std::size_t axis = longest_axis(middle);
    if (!has_one_orientation(piece.polygon.w[0], axis) || !has_one_orientation(middle, axis) ||
        !has_one_orientation(piece.polygon.w[last], axis)) {
      return std::nullopt;
    }
    BallForm det;
    if (!has_one_contact<kind>(piece.polygon, axis, det)) return std::nullopt;
    return narrowed(piece, det);
  }

  /// Do the components of w_i × w_{i+1} of these corners appear to have one sign?
  static bool has_one_orientation(const CornerRow& w, std::size_t axis) {
    constexpr std::size_t sides = kind == Kind::vertex_face ? 3 : 4;
    const std::size_t y = 4 * ((axis + 1) % 3), z = 4 * ((axis + 2) % 3);
    bool is_positive = true, is_negative = true;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t j = (i + 1) % sides;
      const double component = w[y + i] * w[z + j] - w[z + i] * w[y + j];
      is_positive = is_positive && component > 0.0;
      is_negative = is_negative && component < 0.0;
    }
    return is_positive || is_negative;
  }

  /// A zero in (0,1) of the form, an approximation: bisection and secants.
  static double guess_zero(const BallForm& form) {
    const auto value = [&](double y) {
      double sum = 0.0, power = 1.0;
      const double rest = 1.0 - y;
      for (const Ball& c : form) {
        sum = sum * rest + c.center.high * power;
        power *= y;
      }
      return sum;
    };
    double lower = 0.0, upper = 1.0, at_lower = value(0.0), at_upper = value(1.0);
    for (int step = 0; step < 60 && upper - lower > 0x1p-50 * upper; ++step) {
      double y = lower - at_lower * (upper - lower) / (at_upper - at_lower);
      if (step % 3 == 2 || !(y > lower && y < upper)) y = 0.5 * (lower + upper);
      const double at = value(y);
      if (at == 0.0) return y;
      if ((at > 0.0) == (at_lower > 0.0)) {
        // The other end counts half (Illinois), so that both move.
        lower = y;
        at_lower = at;
        at_upper *= 0.5;
      } else {
        upper = y;
        at_upper = at;
        at_lower *= 0.5;
      }
    }
    return 0.5 * (lower + upper);
  }

  /// Encloses the only zero of det in a piece by its signs on both sides of a guess.
  std::optional<CertifiedResult> narrowed(const Piece& piece, const BallForm& det) {
    const double guess = guess_zero(det);
    const double time = piece.begin + piece.length * guess;
    const double width = std::max(0.4 * options_.toi_tolerance, 0x1p-51) * time;
    const double lower = std::max(piece.begin, time - width);
    const double upper = std::min(piece.end(), time + width);
    const int before = sign_of(det.front());
    const bool begins = lower == piece.begin || determinant_sign<kind>(points_, lower) == before;
    const bool ends = upper == piece.end() || determinant_sign<kind>(points_, upper) == -before;
    if (!begins || !ends || !(upper - lower <= options_.toi_tolerance * upper)) return undecided();
    if (lower >= options_.t_max) return free_of_contact(Stage::bisection);
    return contact(lower, upper, corners_at(piece.polygon, guess));
  }

  // ---- A distance ----

  /// Encloses the first contact at the distance in a piece whose end is one: halves without contact
  /// are left behind, and a middle that is a contact is the new end.
  std::optional<CertifiedResult> narrowed_by_distance(Piece& piece) {
    Piece& first = pieces_[count_ + 1];
    for (int step = 0; step < most_halvings; ++step) {
      if (piece.length <= std::max(options_.toi_tolerance, 0x1p-51) * piece.end()) {
        if (piece.begin >= options_.t_max) return free_of_contact(Stage::bisection);
        return contact(piece.begin, piece.end(), piece.polygon.w[piece.polygon.degree]);
      }
      halve(piece.polygon, first.polygon, second_);
      piece.length *= 0.5;
      const std::size_t last = second_.degree;
      if (is_contact_at(first.polygon, last)) {
        piece.polygon.assign(first.polygon);
        continue;
      }
      if (!separates(first.polygon, separator_at<kind, norm>(first.polygon.w[last])) &&
          !separates(first.polygon, separator_at<kind, norm>(first.polygon.w[0]))) {
        return undecided();
      }
      piece.polygon.assign(second_);
      piece.begin += piece.length;
    }
    return undecided();
  }

  const ControlPoints& points_;
  const CertifiedOptions& options_;
  bool has_distance_;
  /// The pieces that are left, the first one last: at most one of each length.
  std::array<Piece, most_levels + 3> pieces_;
  std::size_t count_ = 0;
  ControlPolygon second_;
};

}  // namespace
}  // namespace touchstone::fast::curved
