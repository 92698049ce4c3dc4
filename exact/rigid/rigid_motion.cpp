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
/// While an interval has more than about a turn, points are only known to be within |v| of the
/// body's position.

#include "touchstone/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

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

ExactVector exactly(const Point& a, const Point& b) {
  return {Rational(a[0]) - Rational(b[0]), Rational(a[1]) - Rational(b[1]),
          Rational(a[2]) - Rational(b[2])};
}
Rational triple(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}
/// An upper bound of the length.
Rational length(const ExactVector& a) { return abs(a[0]) + abs(a[1]) + abs(a[2]); }

/// The points of a query at a time.
struct Places {
  double time;
  std::array<Point, moving_points> points;
};

class Search {
 public:
  Search(Kind kind, const RigidQuery& query, const RigidOptions& options)
      : kind_(kind), query_(query), options_(options) {
    for (std::size_t body = 0; body < 2; ++body) {
      const auto& [start, end] = query.bodies[body];
      Point turn;
      for (std::size_t k = 0; k < 3; ++k) turn[k] = end.rotation[k] - start.rotation[k];
      // The difference is rounded by at most 2^-53 of the angles.
      turn_[body] = length(turn) + 0x1p-50 * (magnitude(start.rotation) + magnitude(end.rotation));
      reach_[body] = 0.0;
      for (std::size_t i = first_of(body); i < first_of(body + 1); ++i) {
        reach_[body] = std::max(reach_[body], length(query.points[i]));
      }
      // Lengths are at most √3 times magnitudes.
      rounding_ += 2.0 * place_error *
                   (std::max(magnitude(start.position), magnitude(end.position)) + reach_[body]);
    }
  }

  [[nodiscard]] RigidDecision run() {
    std::vector<std::array<double, 2>> waiting{{0.0, 1.0}};
    while (!waiting.empty()) {
      const auto [a, b] = waiting.back();
      waiting.pop_back();
      if (++result_.intervals > options_.greatest_count) return undecided_from(a, 0.0);
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
        return undecided_from(a, error_of(h));
      }
      waiting.push_back({middle, b});
      waiting.push_back({a, middle});
    }
    result_.verdict = RigidVerdict::no;
    result_.toi_lower = result_.toi_upper = 1.0;
    return result_;
  }

 private:
  [[nodiscard]] std::size_t first_of(std::size_t body) const {
    if (body == 0) return 0;
    return body == 2 ? moving_points : (kind_ == Kind::vertex_face ? 1 : 2);
  }
  [[nodiscard]] std::size_t body_of(std::size_t point) const { return point < first_of(1) ? 0 : 1; }

  RigidDecision found(double lower) {
    result_.verdict = RigidVerdict::yes;
    result_.toi_lower = lower;
    return result_;
  }
  RigidDecision undecided_from(double lower, double error) {
    if (has_contact_) return found(lower);
    result_.toi_lower = lower;
    result_.error = error;
    return result_;
  }

  [[nodiscard]] bool has_few_turns(double h) const {
    return h * turn_[0] <= 1.0 && h * turn_[1] <= 1.0;
  }

  [[nodiscard]] Places places(double t) const {
    Places result{t, {}};
    for (std::size_t i = 0; i < moving_points; ++i) {
      result.points[i] = place_of(query_.bodies[body_of(i)], query_.points[i], t);
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

  /// The bodies' positions are farther apart than their points reach, on an axis.
  [[nodiscard]] bool is_free_by_reach(double a, double b) const {
    const auto position = [&](std::size_t body, double t, std::size_t axis) {
      const auto& [start, end] = query_.bodies[body];
      return start.position[axis] + t * (end.position[axis] - start.position[axis]);
    };
    const double reach = (reach_[0] + reach_[1] + rounding_) * upwards;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at_a = position(0, a, axis) - position(1, a, axis);
      const double at_b = position(0, b, axis) - position(1, b, axis);
      if ((at_a > reach && at_b > reach) || (at_a < -reach && at_b < -reach)) return true;
    }
    return false;
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
  [[nodiscard]] std::vector<ExactVector> corners(const Places& at) const {
    const auto& x = at.points;
    if (kind_ == Kind::vertex_face) {
      return {exactly(x[0], x[1]), exactly(x[0], x[2]), exactly(x[0], x[3])};
    }
    return {exactly(x[0], x[2]), exactly(x[1], x[2]), exactly(x[1], x[3]), exactly(x[0], x[3])};
  }

  [[nodiscard]] bool has_contact(const Places& a, const Places& b) const {
    const std::vector<ExactVector> at_a = corners(a), at_b = corners(b);
    return sign_of_determinant(at_a) * sign_of_determinant(at_b) < 0 &&
           have_one_sign(at_a, at_b, Rational(error_of(b.time - a.time)));
  }

  /// The sign of det, or 0 if the rounding of places could change it.
  [[nodiscard]] int sign_of_determinant(const std::vector<ExactVector>& w) const {
    const Rational error(rounding_ * upwards);
    const Rational x = length(w[0]), y = length(w[1]), z = length(w.back());
    return certain_sign(triple(w[0], w[1], w.back()),
                        Rational((x + error) * (y + error) * (z + error) - x * y * z));
  }

  static int certain_sign(const Rational& value, const Rational& margin) {
    if (value > margin) return 1;
    return value < -margin ? -1 : 0;
  }

  static bool have_one_sign(const std::vector<ExactVector>& a, const std::vector<ExactVector>& b,
                            const Rational& error) {
    // The normal of the polygon in the middle of the interval.
    const auto middle = [&](std::size_t i) {
      ExactVector result;
      for (std::size_t k = 0; k < 3; ++k) result[k] = a[i][k] + b[i][k];
      return result;
    };
    const ExactVector origin = middle(0), p = minus(middle(1), origin);
    const ExactVector q = minus(middle(a.size() - 1), origin);
    const ExactVector d{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                        p[0] * q[1] - p[1] * q[0]};
    std::optional<int> common;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t j = (i + 1) % a.size();
      const Rational x = std::max(length(a[i]), length(b[i]));
      const Rational y = std::max(length(a[j]), length(b[j]));
      const Rational margin = length(d) * ((x + error) * (y + error) - x * y);
      const Rational in_between = (triple(d, a[i], b[j]) + triple(d, b[i], a[j])) / 2;
      for (const Rational& o : {triple(d, a[i], a[j]), in_between, triple(d, b[i], b[j])}) {
        const int sign = certain_sign(o, margin);
        if (sign == 0 || sign != common.value_or(sign)) return false;
        common = sign;
      }
    }
    return true;
  }

  static ExactVector minus(const ExactVector& a, const ExactVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }

  Kind kind_;
  const RigidQuery& query_;
  const RigidOptions& options_;
  std::array<double, 2> turn_{};   ///< upper bounds of |Δ|
  std::array<double, 2> reach_{};  ///< upper bounds of |v|
  double rounding_ = 0.0;          ///< of places, in a corner
  bool has_contact_ = false;
  RigidDecision result_;
};

void require_valid(const RigidQuery& query, const RigidOptions& options) {
  constexpr double greatest = 0x1p100;
  const auto require = [](const Point& x) {
    // Written so that NaN fails too.
    if (!(magnitude(x) <= greatest) || std::isnan(x[0] + x[1] + x[2])) {
      throw std::domain_error("rigid query: a number is not finite or above 2^100");
    }
  };
  for (const Point& point : query.points) require(point);
  for (const RigidMotion& motion : query.bodies) {
    for (const RigidPose& pose : {motion.start, motion.end}) {
      require(pose.position);
      require(pose.rotation);
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
  return Search(kind, query, options).run();
}

}  // namespace touchstone::exact
