/// The interval [0,1] is examined from the left, by bisection. On an interval [a,b] of length h
/// each point moves on a curve within ε_i of the chord of its rounded places at a and b:
///
/// **Curvature.** With A(t) = [r(t)], A' = [r(1) − r(0)] =: [Δ] is constant. The derivative of
/// R = exp A is R' = ∫ e^(sA) A' e^((1−s)A) ds over s from 0 to 1, of norm at most |Δ|. Likewise
/// ‖(e^(sA))'‖ ≤ s |Δ|, so ‖R''‖ ≤ ∫ (s + (1−s)) |Δ|² ds = |Δ|². Linear interpolation errs by at
/// most h²/8 of the greatest second derivative: |x − chord| ≤ h² |Δ|² |v| / 8.
///
/// A corner is a difference of two points: it is within ε of that of the chords, the sum of the
/// greatest ε_i of both primitives.
///
/// **No contact.** If the query of the chords is free at the distance ε in L2, there is none.
///
/// **Contact.** Let the orientations d·(w_i × w_(i+1)) of the chords, for a fixed direction d, have
/// one sign on [a,b], beyond what ε can change, and det = w_0·(w_1 × w_last) different signs at a
/// and at b, beyond what the rounding of places can change. Then the orientations of the true
/// corners have one sign on [a,b], and their det, which is continuous, is 0 at a time in between:
/// this is a contact (docs/theory.md, section 6.5). The test takes a quarter more on both sides;
/// as nothing before a is in contact, the time of impact is in the interval or behind it.
///
/// **Many turns.** While an interval has more than about a turn, d·(x − p) is only known to be
/// within |d||v| of 0; but it is d·v, if d is parallel to r at both ends. With these bounds an axis
/// of coordinates or of a rotation can separate the bodies, as positions are linear in t.
///
/// **A common plane.** If the bounds of a direction n show that all points are in one plane, det is
/// always 0. Then there is a contact where the orientations of the corners have one sign, and where
/// n·(w_i × w_j) of a side changes its sign while w_i·w_j < 0: the origin is between w_i and w_j.
///
/// **Scale.** Places are in units of a power of two: the greatest magnitude of a position or a
/// point is in [1/2,1). The bound of their rounding is more than 2^-51 too great, as places err by
/// half of place_error: this covers all underflow, which changes a number by at most 2^-1074.

#include "touchstone/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "exact/contact/contact_oracle.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/rigid/rigid_place.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact {
namespace {

using Point = std::array<double, 3>;
using ExactVector = std::array<Rational, 3>;

/// The bounds below are computed in doubles, with a few dozen roundings of at most 2^-53 each.
constexpr double upwards = 1.0 + 0x1p-40;

double magnitude(const Point& x) {
  return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
}

/// An upper bound of the Euclidean length.
double length(const Point& x) { return std::hypot(x[0], x[1], x[2]) * upwards; }

ExactVector exactly(const Point& a) { return {Rational(a[0]), Rational(a[1]), Rational(a[2])}; }
ExactVector minus(const ExactVector& a, const ExactVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool is_zero(const ExactVector& a) {
  return std::ranges::all_of(a, [](const Rational& x) { return sgn(x) == 0; });
}
/// An upper bound of the length.
Rational length(const ExactVector& a) { return abs(a[0]) + abs(a[1]) + abs(a[2]); }

std::size_t body_of(Kind kind, std::size_t point) {
  return point < (kind == Kind::vertex_face ? 1U : 2U) ? 0 : 1;
}

/// True if a body's rotation keeps its direction.
bool is_axis(const RigidMotion& body, const ExactVector& direction) {
  return is_zero(cross(exactly(body.start.rotation), direction)) &&
         is_zero(cross(exactly(body.end.rotation), direction));
}

/// The bits of the greatest magnitude of positions and points, before the binary point.
int unit_of(const RigidQuery& query) {
  double most = 0.0;
  for (const Point& point : query.points) most = std::max(most, magnitude(point));
  for (const auto& [start, end] : query.bodies) {
    most = std::max({most, magnitude(start.position), magnitude(end.position)});
  }
  int unit = 0;
  static_cast<void>(std::frexp(most, &unit));
  return unit;
}

Point scaled(Point x, int exponent) {
  for (double& coordinate : x) coordinate = std::ldexp(coordinate, exponent);
  return x;
}

/// A direction d, and what d·(x − p) of each body's points is at any time.
struct Direction {
  ExactVector d;
  std::array<RationalInterval, 2> range;
};

/// The points of a query at a time.
struct Places {
  double time;
  std::array<Point, moving_points> points;
};

class Search {
 public:
  Search(Kind kind, const RigidQuery& query, const RigidOptions& options)
      : kind_(kind), query_(query), options_(options), unit_(unit_of(query)) {
    for (std::size_t body = 0; body < 2; ++body) {
      const auto& [start, end] = query.bodies[body];
      Point turn;
      for (std::size_t k = 0; k < 3; ++k) turn[k] = end.rotation[k] - start.rotation[k];
      turn_[body] = length(turn);
      for (std::size_t i = first_of(body); i < first_of(body + 1); ++i) {
        reach_[body] = std::max(reach_[body], length(scaled(query.points[i], -unit_)));
      }
      // Lengths are at most √3 times magnitudes.
      rounding_ += 2.0 * place_error *
                   (std::max(magnitude(scaled(start.position, -unit_)),
                             magnitude(scaled(end.position, -unit_))) +
                    reach_[body]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Point unit{};
      unit[axis] = 1.0;
      add_direction(unit);
    }
    for (const auto& [start, end] : query.bodies) {
      add_direction(start.rotation);
      add_direction(end.rotation);
    }
  }

  [[nodiscard]] RigidDecision run() {
    std::vector<std::array<double, 2>> waiting{{0.0, 1.0}};
    while (!waiting.empty()) {
      const auto [a, b] = waiting.back();
      waiting.pop_back();
      if (options_.stop != nullptr && *options_.stop) return undecided_from(a, RigidLimit::stop);
      if (++result_.intervals > options_.greatest_count) {
        return undecided_from(a, RigidLimit::count);
      }
      const double h = b - a, middle = a + 0.5 * h;
      const bool is_short = has_few_turns(h);
      if (!is_short) {
        if (is_free_by_reach(a, b)) continue;
      } else {
        const Places at_a = places(a), at_b = places(b);
        if (is_free(at_a, at_b)) continue;
        if (const std::optional<double> end = end_of_contact(a, b)) {
          // What is later does not matter any more.
          waiting.clear();
          has_contact_ = true;
          result_.toi_upper = std::min(result_.toi_upper, *end);
          if (result_.toi_upper - a <= options_.toi_tolerance) return found(a);
          if (b < result_.toi_upper) waiting.push_back({b, result_.toi_upper});
        }
      }
      if (h <= options_.least_interval || !(a < middle && middle < b)) {
        // The chords come as near as their error (or it is greater than the query).
        const double error = 3.0 * error_of(h);
        return undecided_from(a, RigidLimit::interval, is_short ? error : infinity);
      }
      waiting.push_back({middle, b});
      waiting.push_back({a, middle});
    }
    result_.verdict = RigidVerdict::no;
    result_.toi_lower = result_.toi_upper = 1.0;
    return result_;
  }

 private:
  using Corners = std::vector<ExactVector>;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] std::size_t first_of(std::size_t body) const {
    if (body == 0) return 0;
    return body == 2 ? moving_points : (kind_ == Kind::vertex_face ? 1 : 2);
  }

  RigidDecision found(double lower) {
    result_.verdict = RigidVerdict::yes;
    result_.toi_lower = lower;
    return result_;
  }
  /// \param error A bound of the distance (in the unit).
  RigidDecision undecided_from(double lower, RigidLimit limit, double error = infinity) {
    if (has_contact_) return found(lower);
    result_.toi_lower = lower;
    result_.error =
        std::nextafter(std::ldexp(std::min(error, distance_at(lower)), unit_), infinity);
    result_.limit = limit;
    return result_;
  }

  /// An upper bound of the distance at a time, less than twice as great unless rounding is.
  [[nodiscard]] double distance_at(double time) const {
    const Places now = places(time);
    const Query rest = query_of(now, now);
    const Point &a = now.points[0], &b = now.points[first_of(1)];
    double bound = length(Point{a[0] - b[0], a[1] - b[1], a[2] - b[2]});
    const auto is_within = [&](double distance) {
      return decide(kind_, rest, {.distance = distance, .norm = Norm::l2}).collides();
    };
    while (bound > rounding_ && is_within(0.5 * bound)) bound *= 0.5;
    return (bound + rounding_) * upwards;
  }

  [[nodiscard]] bool has_few_turns(double h) const {
    return h * turn_[0] <= 1.0 && h * turn_[1] <= 1.0;
  }

  [[nodiscard]] Places places(double t) const {
    Places result{t, {}};
    for (std::size_t i = 0; i < moving_points; ++i) {
      result.points[i] = place_of(query_.bodies[body_of(kind_, i)], query_.points[i], t, unit_);
    }
    return result;
  }

  /// ε.
  [[nodiscard]] double error_of(double h) const {
    double result = rounding_;
    for (std::size_t body = 0; body < 2; ++body) {
      const double angle = h * turn_[body];
      result += 0.125 * angle * angle * reach_[body];
    }
    return result * upwards;
  }

  // ---- No contact ----

  [[nodiscard]] bool is_free(const Places& a, const Places& b) const {
    const double error = error_of(b.time - a.time);
    if (is_apart_on_an_axis(a, b, error)) return true;
    const Query query = query_of(a, b);
    double size = 0.0;
    for (std::size_t i = 1; i < moving_points; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        size = std::max(size, std::abs(a.points[i][k] - a.points[0][k]));
      }
    }
    // The distance would be greater than anything that could separate.
    if (error > size) return false;
    return !decide(kind_, query, {.distance = error, .norm = Norm::l2}).collides();
  }

  [[nodiscard]] bool is_apart_on_an_axis(const Places& a, const Places& b, double error) const {
    const auto is_above = [&](std::size_t low, std::size_t high, std::size_t axis) {
      for (std::size_t i = first_of(high); i < first_of(high + 1); ++i) {
        for (std::size_t k = first_of(low); k < first_of(low + 1); ++k) {
          for (const Places* at : {&a, &b}) {
            if (!(at->points[i][axis] - at->points[k][axis] > error)) return false;
          }
        }
      }
      return true;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_above(0, 1, axis) || is_above(1, 0, axis)) return true;
    }
    return false;
  }

  void add_direction(const Point& direction) {
    Direction result{.d = exactly(direction), .range = {}};
    if (is_zero(result.d)) return;
    for (std::size_t body = 0; body < 2; ++body) {
      auto& [lower, upper] = result.range[body];
      upper =
          length(result.d) * Rational((reach_[body] + rounding_) * upwards) * power_of_two(unit_);
      lower = -upper;
      if (!is_axis(query_.bodies[body], result.d)) continue;
      std::swap(lower, upper);
      for (std::size_t i = first_of(body); i < first_of(body + 1); ++i) {
        const Rational value = dot(result.d, exactly(query_.points[i]));
        lower = std::min(lower, value);
        upper = std::max(upper, value);
      }
    }
    const RationalInterval start = gap(result, 0.0), end = gap(result, 1.0);
    const auto is_zero_gap = [](const RationalInterval& x) {
      return sgn(x.lower) == 0 && sgn(x.upper) == 0;
    };
    if (is_zero_gap(start) && is_zero_gap(end)) normal_ = result.d;
    directions_.push_back(std::move(result));
  }

  /// What d·w of the corners is at a time.
  [[nodiscard]] RationalInterval gap(const Direction& direction, double t) const {
    const auto position = [&](std::size_t body) {
      const auto& [start, end] = query_.bodies[body];
      const Rational from = dot(direction.d, exactly(start.position));
      const Rational to = dot(direction.d, exactly(end.position));
      return Rational(from + Rational(t) * (to - from));
    };
    const Rational between = position(0) - position(1);
    const auto& [first, second] = direction.range;
    return {between + first.lower - second.upper, between + first.upper - second.lower};
  }

  /// A direction separates the bodies whatever their angles are.
  [[nodiscard]] bool is_free_by_reach(double a, double b) const {
    return std::ranges::any_of(directions_, [&](const Direction& direction) {
      const RationalInterval at_a = gap(direction, a), at_b = gap(direction, b);
      return (sgn(at_a.lower) > 0 && sgn(at_b.lower) > 0) ||
             (sgn(at_a.upper) < 0 && sgn(at_b.upper) < 0);
    });
  }

  static Query query_of(const Places& a, const Places& b) {
    Query query;
    for (std::size_t i = 0; i < moving_points; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        query.coordinates[3 * i + k] = a.points[i][k];
        query.coordinates[12 + 3 * i + k] = b.points[i][k];
      }
    }
    return query;
  }

  // ---- Contact ----

  /// The end of an interval around [a,b] with a contact. (One at a would be in the interior of no
  /// interval of a bisection.)
  [[nodiscard]] std::optional<double> end_of_contact(double a, double b) const {
    const double margin = 0.25 * (b - a);
    const double begin = std::max(a - margin, 0.0), end = std::min(b + margin, 1.0);
    return has_contact(places(begin), places(end)) ? std::optional(end) : std::nullopt;
  }

  /// The corners in cyclic order.
  [[nodiscard]] Corners corners(const Places& at) const {
    Corners result;
    for (const Corner& corner : touchstone::corners(kind_)) {
      result.push_back(minus(exactly(at.points[corner.plus]), exactly(at.points[corner.minus])));
    }
    return result;
  }

  [[nodiscard]] bool has_contact(const Places& a, const Places& b) const {
    const Corners at_a = corners(a), at_b = corners(b);
    const Rational error(error_of(b.time - a.time));
    if (normal_) {
      return have_one_sign(at_b, at_b, rounding()) || cross_a_side(at_a, at_b, error);
    }
    return sign_of_determinant(at_a) * sign_of_determinant(at_b) < 0 &&
           have_one_sign(at_a, at_b, error);
  }

  [[nodiscard]] Rational rounding() const { return rounding_ * upwards; }

  /// The sign of det, or 0 if the rounding of places could change it.
  [[nodiscard]] int sign_of_determinant(const Corners& w) const {
    const Rational error = rounding();
    const Rational x = length(w[0]), y = length(w[1]), z = length(w.back());
    return certain_sign(dot(w[0], cross(w[1], w.back())),
                        Rational((x + error) * (y + error) * (z + error) - x * y * z));
  }

  static int certain_sign(const Rational& value, const Rational& margin) {
    if (value > margin) return 1;
    return value < -margin ? -1 : 0;
  }

  /// The sign of a product of corners i and j along the chords from a to b, which is at most
  /// `factor` times their lengths; 0 if the error could change it.
  template <class Product>
  static int sign_along(const Corners& a, const Corners& b, std::size_t i, std::size_t j,
                        const Rational& factor, const Rational& error, const Product& product) {
    const Rational x = std::max(length(a[i]), length(b[i]));
    const Rational y = std::max(length(a[j]), length(b[j]));
    const Rational margin = factor * ((x + error) * (y + error) - x * y);
    const Rational in_between = (product(a[i], b[j]) + product(b[i], a[j])) / 2;
    const int sign = certain_sign(in_between, margin);
    const bool is_same = certain_sign(product(a[i], a[j]), margin) == sign &&
                         certain_sign(product(b[i], b[j]), margin) == sign;
    return is_same ? sign : 0;
  }

  static bool have_one_sign(const Corners& a, const Corners& b, const Rational& error) {
    // The normal of the polygon in the middle of the interval.
    const auto middle = [&](std::size_t i) {
      ExactVector result;
      for (std::size_t k = 0; k < 3; ++k) result[k] = a[i][k] + b[i][k];
      return result;
    };
    const ExactVector origin = middle(0);
    const ExactVector d = cross(minus(middle(1), origin), minus(middle(a.size() - 1), origin));
    int common = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int sign = orientation(a, b, i, d, error);
      if (sign == 0 || sign == -common) return false;
      common = sign;
    }
    return true;
  }

  /// The sign of d·(w_i × w_j) of the side from corner i to the next.
  static int orientation(const Corners& a, const Corners& b, std::size_t i, const ExactVector& d,
                         const Rational& error) {
    return sign_along(a, b, i, (i + 1) % a.size(), length(d), error,
                      [&](const auto& x, const auto& y) { return dot(d, cross(x, y)); });
  }

  /// In a common plane.
  [[nodiscard]] bool cross_a_side(const Corners& a, const Corners& b, const Rational& error) const {
    const auto dot_product = [](const auto& x, const auto& y) { return dot(x, y); };
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int before = orientation(a, a, i, *normal_, rounding());
      if (before * orientation(b, b, i, *normal_, rounding()) < 0 &&
          sign_along(a, b, i, (i + 1) % a.size(), 1, error, dot_product) < 0) {
        return true;
      }
    }
    return false;
  }

  Kind kind_;
  const RigidQuery& query_;
  const RigidOptions& options_;
  int unit_;                       ///< of places
  std::array<double, 2> turn_{};   ///< upper bounds of |Δ|
  std::array<double, 2> reach_{};  ///< upper bounds of |v|, in the unit
  double rounding_ = 0.0;          ///< of places, in a corner
  std::vector<Direction> directions_;
  std::optional<ExactVector> normal_;  ///< of the plane in which all points stay
  bool has_contact_ = false;
  RigidDecision result_;
};

/// The decision if no rotation moves a point.
std::optional<RigidDecision> decide_translation(Kind kind, const RigidQuery& query) {
  Query positions{}, points{};
  for (std::size_t i = 0; i < moving_points; ++i) {
    const RigidMotion& body = query.bodies[body_of(kind, i)];
    if (!is_axis(body, exactly(query.points[i]))) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions.at(0, i, axis) = body.start.position[axis];
      positions.at(1, i, axis) = body.end.position[axis];
      points.at(0, i, axis) = points.at(1, i, axis) = query.points[i][axis];
    }
  }
  const Decision truth = decide_contact(sum_in_integers(kind, positions, points));
  if (!truth.collides()) return RigidDecision{.verdict = RigidVerdict::no, .toi_lower = 1.0};
  const auto [lower, upper] = truth.toi->enclosure();
  return RigidDecision{.verdict = RigidVerdict::yes, .toi_lower = lower, .toi_upper = upper};
}

void require_valid(const RigidQuery& query, const RigidOptions& options) {
  const auto require = [](const Point& x) {
    if (!is_finite(x)) throw std::domain_error("rigid query: a number is not finite");
  };
  for (const Point& point : query.points) require(point);
  for (const RigidMotion& motion : query.bodies) {
    for (const RigidPose& pose : {motion.start, motion.end}) {
      require(pose.position);
      require(pose.rotation);
      if (magnitude(pose.rotation) > 0x1p100) {
        throw std::domain_error("rigid query: a rotation is above 2^100 radians");
      }
    }
  }
  const auto is_part = [](double x) { return x > 0.0 && x <= 1.0; };
  if (!is_part(options.toi_tolerance) || !is_part(options.least_interval)) {
    throw std::invalid_argument("rigid query: tolerances must be in (0,1]");
  }
}

}  // namespace

RigidDecision decide(Kind kind, const RigidQuery& query, const RigidOptions& options) {
  require_valid(query, options);
  if (const auto decision = decide_translation(kind, query)) return *decision;
  return Search(kind, query, options).run();
}

}  // namespace touchstone::exact
