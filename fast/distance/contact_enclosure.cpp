#include "fast/distance/contact_enclosure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "touchstone/filters/ball.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast {
namespace {

using exact_stage::Parameters;
using filters::Ball;
using Balls = filters::Vector3<Ball>;
using Doubles = std::array<double, 3>;

constexpr double unbounded = std::numeric_limits<double>::infinity();

// ---- Bounds in doubles --------------------------------------------------------------------------

/// Bounds are computed from numbers that are not negative, in fewer than a hundred operations:
/// these factors cover their rounding.
constexpr double above = 1.0 + 0x1p-44, below = 1.0 - 0x1p-44;
/// A bound of what underflow takes from a bound of an error. In the units of the computation the
/// greatest coordinate is from 2^-64 to 2^65, or about 2^400, so lengths are below 2^403. An
/// operation loses at most 2^-1074, which is multiplied by no more than two of these lengths, or by
/// `greatest_inverse_sine` twice and one of them.
constexpr double least_error = 0x1p-264;
constexpr double greatest_inverse_sine = 0x1p100;

/// |a|, to a few places; neither overflows nor underflows.
double length(const Doubles& a) {
  const double greatest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  if (greatest == 0.0) return 0.0;
  const double x = a[0] / greatest, y = a[1] / greatest, z = a[2] / greatest;
  return greatest * std::sqrt(x * x + y * y + z * z);
}

double most(const Ball& x) { return above * (std::abs(x.center.high) + x.radius); }
double least(const Ball& x) {
  const double high = x.center.high;
  return high - (1.0 - below) * std::abs(high) - above * x.radius;
}
/// The greatest distance of a number of the ball from the double at its center.
double error_of(const Ball& x) { return above * (x.radius + std::abs(x.center.low)); }

Doubles center(const Balls& a) { return {a[0].center.high, a[1].center.high, a[2].center.high}; }
double most(const Balls& a) { return above * length({most(a[0]), most(a[1]), most(a[2])}); }
double error_of(const Balls& a) {
  return above * length({error_of(a[0]), error_of(a[1]), error_of(a[2])});
}
double least(const Balls& a) {
  return std::max(0.0, below * length(center(a)) - above * error_of(a));
}

bool is_exact_zero(const Balls& a) {
  return std::ranges::all_of(a, [](const Ball& x) { return filters::is_exact_zero(x); });
}
/// True if both are the same number, without error.
bool is_exactly(const Ball& a, const Ball& b) {
  return a.radius == 0.0 && b.radius == 0.0 && a.center.high == b.center.high &&
         a.center.low == b.center.low;
}
bool is_exactly(const Balls& a, const Balls& b) {
  return is_exactly(a[0], b[0]) && is_exactly(a[1], b[1]) && is_exactly(a[2], b[2]);
}

Balls plus(const Balls& a, const Balls& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Balls minus(const Balls& a, const Balls& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Balls times(const Ball& s, const Balls& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// x · 2^exponent, with an error of its own only where a part is subnormal.
Ball scaled(const Ball& x, int exponent) {
  if (filters::is_exact_zero(x)) return {};
  const auto by = [exponent](double part) { return std::ldexp(part, exponent); };
  return {{by(x.center.high), by(x.center.low)}, by(x.radius) + (exponent < 0 ? 0x1p-1070 : 0.0)};
}

/// A vector in units of a power of two in which its greatest component is near 1, unless that is
/// between 2^-100 and 2^100 in any case: products of two or three do not underflow.
struct Normalised {
  Balls vector;
  int exponent = 0;  ///< vector · 2^exponent is the original; even
};

/// The even exponent for numbers of this magnitude.
int exponent_for(double greatest) {
  if (greatest == 0.0) return 0;
  const int exponent = std::ilogb(greatest);
  return std::abs(exponent) <= 100 ? 0 : exponent - (exponent & 1);
}

Balls scaled(const Balls& a, int exponent) {
  if (exponent == 0) return a;
  return {scaled(a[0], exponent), scaled(a[1], exponent), scaled(a[2], exponent)};
}

double greatest_component(const Balls& a) { return std::max({most(a[0]), most(a[1]), most(a[2])}); }

Normalised normalised(const Balls& a) {
  const int exponent = exponent_for(greatest_component(a));
  return {scaled(a, -exponent), exponent};
}

// ---- Directions ---------------------------------------------------------------------------------

/// A unit vector with a bound of its distance from the exact one.
struct Direction {
  Eigen::Vector3d vector = Eigen::Vector3d::UnitX();
  double error = unbounded;  ///< unbounded if nothing is known of the direction
};

/// The direction of the center, for any vector of the ball or one at most that far from it: those
/// of a and b differ by at most 2 |a − b| / |a|. \pre the vector is normalised
Direction direction_of(const Balls& a, double farther = 0.0) {
  constexpr double greatest_error = 0.5, rounding = 0x1p-49;
  const Doubles middle = center(a);
  const double size = length(middle);
  if (!(size > 0.0)) return {};
  const double error = above * 2.0 * (error_of(a) + farther) / (below * size) + rounding;
  Direction result{.error = error <= greatest_error ? error : unbounded};
  const double greatest = std::max({std::abs(middle[0]), std::abs(middle[1]), std::abs(middle[2])});
  const Eigen::Vector3d x = Eigen::Vector3d(middle[0], middle[1], middle[2]) / greatest;
  result.vector = x / (size / greatest);
  return result;
}

Direction opposite(Direction direction) {
  direction.vector = -direction.vector;
  return direction;
}

// ---- The pair at the time -----------------------------------------------------------------------

/// A point or a vector at the time, and its rate of change.
struct Moving {
  Balls now, rate;
  Balls start = {}, end = {};  ///< at t=0 and at t=1

  [[nodiscard]] bool is_always_zero() const { return is_exact_zero(start) && is_exact_zero(end); }
};

/// True if two vectors are equal or opposite at all times.
bool are_parallel(const Moving& p, const Moving& q) {
  const auto opposite = [](const Balls& a) -> Balls { return {-a[0], -a[1], -a[2]}; };
  return (is_exactly(p.start, q.start) && is_exactly(p.end, q.end)) ||
         (is_exactly(p.start, opposite(q.start)) && is_exactly(p.end, opposite(q.end)));
}

/// The time as a ball.
Ball ball_of(const TimeEnclosure& time) {
  if (time.lower == time.upper) return Ball(time.lower);
  const double middle = time.lower + 0.5 * (time.upper - time.lower);
  const double radius = std::max(time.upper - middle, middle - time.lower);
  return {{middle, 0.0}, above * radius + std::numeric_limits<double>::denorm_min()};
}

/// The exponent of the power of two by which coordinates are multiplied, against overflow and
/// underflow: 0 unless a coordinate, or the time, is of unusual size.
int scaling_of(const Query& query, const TimeEnclosure& time) {
  constexpr int usual = 64, unusual_size = 400;
  constexpr double least_usual_time = 0x1p-200;
  double greatest = 0.0;
  for (const double x : query.coordinates) greatest = std::max(greatest, std::abs(x));
  if (greatest == 0.0) return 0;
  const int exponent = std::ilogb(greatest);
  const bool is_usual_time = time.upper == 0.0 || time.lower >= least_usual_time;
  return std::abs(exponent) <= usual && is_usual_time ? 0 : unusual_size - exponent;
}

class MovingPair {
 public:
  MovingPair(ContactKind kind, const Query& query, const TimeEnclosure& time)
      : query_(query),
        exponent_(scaling_of(query, time)),
        time_(time),
        ball_of_time_(ball_of(time)) {
    const auto points = affine_vectors(kind);
    r = vector(points[0]);
    p = vector(points[1]);
    q = vector(points[2]);
    a = place(points[0][0]);
    b = place(points[0][1]);
  }

  Moving r, p, q;  ///< F = r − u p − v q
  Balls a, b;      ///< r = a − b

  /// A place in the units of the query, and a bound of the error of all its coordinates together.
  [[nodiscard]] Eigen::Vector3d in_query_units(const Balls& x) const {
    const auto by = [this](double part) { return std::ldexp(part, -exponent_); };
    const Doubles middle = center(x);
    return {by(middle[0]), by(middle[1]), by(middle[2])};
  }
  [[nodiscard]] double in_query_units(double error) const {
    constexpr double subnormal = 2.0 * std::numeric_limits<double>::denorm_min();
    if (exponent_ == 0) return above * (error + least_error);
    return above * std::ldexp(error + least_error, -exponent_) + subnormal;
  }

 private:
  [[nodiscard]] double coordinate(std::size_t end, std::size_t point, std::size_t axis) const {
    const double x = query_.at(end, point, axis);
    return exponent_ == 0 ? x : std::ldexp(x, exponent_);
  }
  /// A bound of the error of coordinates, which may become subnormal, and of their differences.
  [[nodiscard]] double rounding() const { return exponent_ < 0 ? 0x1p-1070 : 0.0; }

  [[nodiscard]] Moving moving(const Balls& start, const Balls& end) const {
    Moving result{.now = start, .rate = minus(end, start), .start = start, .end = end};
    if (time_.lower == 1.0) {
      result.now = end;
    } else if (time_.upper > 0.0) {
      result.now = plus(start, times(ball_of_time_, result.rate));
    }
    return result;
  }

  [[nodiscard]] Moving vector(const std::array<std::size_t, 2>& points) const {
    const auto at_end = [&](std::size_t end) {
      Balls result;
      for (std::size_t k = 0; k < 3; ++k) {
        if (query_.at(end, points[0], k) == query_.at(end, points[1], k)) continue;
        const double to = coordinate(end, points[0], k), from = coordinate(end, points[1], k);
        result[k] = {filters::exact_difference(to, from), rounding()};
      }
      return result;
    };
    return moving(at_end(0), at_end(1));
  }

  [[nodiscard]] Balls place(std::size_t point) const {
    const auto at_end = [&](std::size_t end) {
      Balls result;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = coordinate(end, point, k);
        if (query_.at(end, point, k) != 0.0) result[k] = {{x, 0.0}, rounding()};
      }
      return result;
    };
    return moving(at_end(0), at_end(1)).now;
  }

  const Query& query_;
  int exponent_;
  TimeEnclosure time_;
  Ball ball_of_time_;
};

/// r − u p − v q.
Balls difference_at(const Parameters& x, const Balls& r, const Balls& p, const Balls& q) {
  return minus(minus(r, times(Ball(x.u), p)), times(Ball(x.v), q));
}

// ---- The nearest points -------------------------------------------------------------------------

/// Bounds of the errors at given parameters.
struct Errors {
  double difference = unbounded;  ///< of F
  double first = unbounded;       ///< of a point on the first edge, along it
  double second = unbounded;      ///< on the second edge

  void take(const Errors& other) {
    difference = std::min(difference, other.difference);
    first = std::min(first, other.first);
    second = std::min(second, other.second);
  }
};

/// The parameters with those on the boundary but for rounding moved onto it, where the bounds are
/// best.
Parameters on_boundary(ContactKind kind, Parameters x) {
  constexpr double near = 0x1p-45;
  for (double* const one : {&x.u, &x.v}) {
    if (*one < near) *one = 0.0;
    if (*one > 1.0 - near) *one = 1.0;
  }
  if (kind == ContactKind::vertex_face && 1.0 - x.u - x.v < near) {
    x.v = 1.0 - x.u;
    x.u = 1.0 - x.v;  // now both sum up to 1 exactly
  }
  return x;
}

/// The polygon at the time, and F at the given parameters.
class ContactPolygon {
 public:
  ContactPolygon(ContactKind kind, const MovingPair& pair, const Parameters& at)
      : kind_(kind),
        pair_(pair),
        at_(at),
        p_(normalised(pair.p.now)),
        q_(normalised(pair.q.now)),
        f_(normalised(difference_at(at, pair.r.now, pair.p.now, pair.q.now))),
        product_(filters::cross(p_.vector, q_.vector)),
        p_length_(most(pair.p.now)),
        q_length_(most(pair.q.now)) {
    const double area = least(product_);
    const double product = above * most(p_.vector) * most(q_.vector);
    if (area * greatest_inverse_sine > product) inverse_sine_ = product / area;
  }

  /// F, and p × q, normalised.
  [[nodiscard]] const Normalised& difference() const { return f_; }
  [[nodiscard]] const Balls& product() const { return product_; }
  [[nodiscard]] bool is_parallel() const {
    return is_exact_zero(product_) || are_parallel(pair_.p, pair_.q);
  }

  /// If the primitives have a common point at the time.
  [[nodiscard]] Errors touching() const {
    const double distance = unnormalised(most(f_.vector));
    Errors result = at_sine(distance);
    if (is_parallel()) result.take({distance, distance, distance});
    result.take(lengths(distance));
    return result;
  }

  /// If not.
  [[nodiscard]] Errors apart() const {
    const Ball along_p = filters::dot(f_.vector, pair_.p.now);
    const Ball along_q = filters::dot(f_.vector, pair_.q.now);
    Errors result{.difference = unnormalised(most(f_.vector))};
    if (inverse_sine_ < unbounded) {
      const double slopes = slope(along_p, pair_.p.now) + slope(along_q, pair_.q.now);
      result.take(at_sine(unnormalised(above * inverse_sine_ * slopes)));
    }
    if (is_parallel()) {
      const double bound = unnormalised(p_length_ >= q_length_ ? slope(along_p, pair_.p.now)
                                                               : slope(along_q, pair_.q.now));
      result.take({bound, bound, bound});
    }
    take_features(along_p, along_q, result);
    result.take(lengths(result.difference));
    return result;
  }

  /// True if with these errors the nearest points are certainly inside the face, or inside both
  /// edges.
  [[nodiscard]] bool is_inside(const Errors& errors) const {
    if (!(inverse_sine_ < unbounded && least(pair_.p.now) > 0.0 && least(pair_.q.now) > 0.0)) {
      return false;
    }
    const double along = above * (errors.difference + least_error) * inverse_sine_;
    const double du = above * along / least(pair_.p.now);
    const double dv = above * along / least(pair_.q.now);
    const auto [u, v] = at_;
    if (!(u > du && v > dv)) return false;
    constexpr double rounding = 0x1p-50;
    return kind_ == ContactKind::vertex_face
               ? 1.0 - u - v > above * (du + dv) + rounding
               : 1.0 - u > above * du + rounding && 1.0 - v > above * dv + rounding;
  }

 private:
  [[nodiscard]] double unnormalised(double x) const { return std::ldexp(x, f_.exponent); }

  /// The bounds of edges that are not parallel.
  [[nodiscard]] Errors at_sine(double difference) const {
    if (inverse_sine_ == unbounded) return {.difference = difference};
    const double along = above * difference * inverse_sine_;
    return {difference, along, along};
  }
  /// No point is farther off than its edge is long.
  [[nodiscard]] Errors lengths(double difference) const {
    return {difference, std::min(p_length_, above * (q_length_ + difference)),
            std::min(q_length_, above * (p_length_ + difference))};
  }
  /// |F·e| / |e| from F·e; 0 for e = 0.
  static double slope(const Ball& product, const Balls& e) {
    if (is_exact_zero(e)) return 0.0;
    const double size = least(e);
    return size > 0.0 ? above * most(product) / size : unbounded;
  }

  /// True if corners whose parameters differ by this coincide at all times.
  [[nodiscard]] bool coincide(int du, int dv) const {
    return (du == 0 || pair_.p.is_always_zero()) && (dv == 0 || pair_.q.is_always_zero());
  }
  [[nodiscard]] bool coincide(const Corner& a, const Corner& b) const {
    return coincide(a.u - b.u, a.v - b.v);
  }

  /// m_k, of the normalised F: (u − u_k) F·p + (v − v_k) F·q.
  [[nodiscard]] Ball rise(const Corner& corner, const Ball& along_p, const Ball& along_q) const {
    const auto difference = [](double x, int corner_x) {
      return Ball(filters::exact_difference(x, static_cast<double>(corner_x)));
    };
    return difference(at_.u, corner.u) * along_p + difference(at_.v, corner.v) * along_q;
  }

  [[nodiscard]] bool is_corner(const Corner& corner) const {
    return at_.u == corner.u && at_.v == corner.v;
  }
  /// True if F is exactly on that side.
  [[nodiscard]] bool is_on_side(const Corner& from, const Corner& to) const {
    if (from.u == to.u) return at_.u == from.u;
    if (from.v == to.v) return at_.v == from.v;
    return filters::exact_difference(1.0, at_.u).high == at_.v &&
           filters::exact_difference(1.0, at_.u).low == 0.0;
  }

  void take_features(const Ball& along_p, const Ball& along_q, Errors& errors) const {
    const std::span<const Corner> all = corners(kind_);
    std::array<Ball, 4> rises;
    for (std::size_t k = 0; k < all.size(); ++k) rises[k] = rise(all[k], along_p, along_q);
    double deepest = 0.0;
    for (const Ball& one : std::span(rises).first(all.size())) {
      deepest = std::max(deepest, -least(one));
    }
    errors.difference =
        std::min(errors.difference, above * std::ldexp(std::sqrt(deepest), f_.exponent / 2));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t j = i + 1 < all.size() ? i + 1 : 0;
      if (is_corner(all[i]) && least_rise(rises, i, i) > 0.0) errors.take({0.0, 0.0, 0.0});
      if (is_on_side(all[i], all[j])) take_side(rises, i, j, along_p, along_q, errors);
    }
  }

  /// The least m_k of all corners but these and those that coincide with one of them.
  [[nodiscard]] double least_rise(const std::array<Ball, 4>& rises, std::size_t i,
                                  std::size_t j) const {
    const std::span<const Corner> all = corners(kind_);
    double result = unbounded;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (coincide(all[k], all[i]) || coincide(all[k], all[j])) continue;
      result = std::min(result, least(rises[k]));
    }
    return result;
  }

  void take_side(const std::array<Ball, 4>& rises, std::size_t i, std::size_t j,
                 const Ball& along_p, const Ball& along_q, Errors& errors) const {
    const Corner &from = corners(kind_)[i], &to = corners(kind_)[j];
    const bool has_p = from.u != to.u, has_q = from.v != to.v;
    const Balls& p = pair_.p.now;
    const Balls& q = pair_.q.now;
    const double slope_of_side = has_p && has_q ? slope(along_p - along_q, minus(p, q))
                                 : has_p        ? slope(along_p, p)
                                                : slope(along_q, q);
    const double rise = least_rise(rises, i, j), reach = above * (p_length_ + q_length_);
    if (!(rise > 0.0 && above * 2.0 * slope_of_side * reach <= rise)) return;
    const double bound = unnormalised(slope_of_side);
    // The weight of the corners that are not on the side.
    const double others = rise == unbounded ? 0.0 : above * 2.0 * (slope_of_side / rise) * bound;
    const double across = above * others * (has_p ? q_length_ : p_length_);
    const double along = above * (bound + across);
    errors.take(has_p ? Errors{bound, along, across} : Errors{bound, across, along});
  }

  ContactKind kind_;
  const MovingPair& pair_;
  Parameters at_;
  Normalised p_, q_, f_;
  Balls product_;
  double p_length_, q_length_;
  double inverse_sine_ = unbounded;
};

// ---- The normal ---------------------------------------------------------------------------------

struct Normal {
  Direction direction;
  bool has_side = false;
};

int sign_of(const Ball& x) { return is_positive(x) ? 1 : is_positive(-x) ? -1 : 0; }

/// A vector and its rate, without its ends, in units in which neither is great or small.
Moving normalised(const Moving& x) {
  const int exponent =
      -exponent_for(std::max(greatest_component(x.now), greatest_component(x.rate)));
  return {.now = scaled(x.now, exponent), .rate = scaled(x.rate, exponent)};
}

/// The rate of det = (p × q)·r, up to a positive factor.
Ball rate_of_determinant(const MovingPair& pair) {
  const Moving r = normalised(pair.r), p = normalised(pair.p), q = normalised(pair.q);
  const Balls turning = plus(filters::cross(p.rate, q.now), filters::cross(p.now, q.rate));
  return filters::dot(turning, r.now) + filters::dot(filters::cross(p.now, q.now), r.rate);
}

/// The direction of the product, towards the side with this sign of det; if it is unknown, that of
/// the product itself.
Normal normal_of_product(const ContactPolygon& polygon, int side) {
  const Direction direction = direction_of(polygon.product());
  return {side < 0 ? opposite(direction) : direction, side != 0};
}

/// Of primitives that touch: a segment or point and a point, or two of which one has no length.
/// −F' without its component along the segment e, that is −(e × F') × e.
Normal normal_of_segment(const MovingPair& pair, const Parameters& at, double error) {
  Balls rate = difference_at(at, pair.r.rate, pair.p.rate, pair.q.rate);
  const bool is_point = pair.p.is_always_zero() && pair.q.is_always_zero();
  if (is_point) return {opposite(direction_of(normalised(rate).vector)), true};
  const Moving& e = pair.p.is_always_zero() ? pair.q : pair.p;
  const double size = least(e.now);
  // F' changes by e' with the parameter, which is known to error / |e|.
  const double slack =
      size > 0.0 ? above * ((error + least_error) / size) * most(e.rate) : unbounded;
  if (slack == unbounded) return {};
  for (Ball& x : rate) x.radius = above * (x.radius + slack);
  const Balls along = normalised(e.now).vector;
  const Balls upright = filters::cross(filters::cross(along, normalised(rate).vector), along);
  return {opposite(direction_of(normalised(upright).vector)), true};
}

/// A unit vector for pairs without a normal: −F' without its component along the longer edge, or
/// any vector perpendicular to that.
Eigen::Vector3d perpendicular(const MovingPair& pair, const Parameters& at) {
  const auto unit = [](const Balls& a) { return direction_of(normalised(a).vector).vector; };
  const auto product = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];  // in one order on every processor
  };
  const bool is_p = most(pair.p.now) >= most(pair.q.now);
  const Eigen::Vector3d along = unit(is_p ? pair.p.now : pair.q.now);
  const auto upright = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return x - product(x, along) * along;
  };
  const Balls rate = difference_at(at, pair.r.rate, pair.p.rate, pair.q.rate);
  if (length(center(rate)) > 0.0) {
    constexpr double noise = 0x1p-40;
    const Eigen::Vector3d against = upright(-unit(rate));
    const double size = std::sqrt(product(against, against));
    if (size > noise) return against / size;
  }
  Eigen::Index axis = 0;
  along.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d any = upright(Eigen::Vector3d::Unit(axis));
  return any / std::sqrt(product(any, any));
}

Normal normal_of_touching(const MovingPair& pair, const ContactPolygon& polygon,
                          const Parameters& at, const Errors& errors) {
  const bool is_segment = pair.p.is_always_zero() || pair.q.is_always_zero();
  Normal result = is_segment ? normal_of_segment(pair, at, errors.difference)
                             : normal_of_product(polygon, -sign_of(rate_of_determinant(pair)));
  if (result.direction.error == unbounded) result = {{.vector = perpendicular(pair, at)}, false};
  return result;
}

Normal normal_of_apart(const MovingPair& pair, const ContactPolygon& polygon, const Parameters& at,
                       const Errors& errors) {
  const Normalised& f = polygon.difference();
  Normal result{direction_of(f.vector, std::ldexp(errors.difference + least_error, -f.exponent)),
                true};
  if (polygon.is_inside(errors)) {
    const int side = sign_of(filters::dot(polygon.product(), normalised(pair.r.now).vector));
    Normal of_product = normal_of_product(polygon, side);
    if (side != 0 && of_product.direction.error < result.direction.error) return of_product;
    if (result.direction.error == unbounded) result = of_product;
  }
  if (result.direction.error == unbounded) {
    result.has_side = false;
    if (!(length(center(f.vector)) > 0.0)) result.direction.vector = perpendicular(pair, at);
  }
  return result;
}

}  // namespace

ContactEnclosure enclose_contact(ContactKind kind, const Query& query, const TimeEnclosure& time,
                                 const Parameters& approximate, bool is_touching) {
  const Parameters at = on_boundary(kind, exact_stage::inside_domain(kind, approximate));
  const MovingPair pair(kind, query, time);
  const ContactPolygon polygon(kind, pair, at);
  const Errors errors = is_touching ? polygon.touching() : polygon.apart();
  const Normal normal = is_touching ? normal_of_touching(pair, polygon, at, errors)
                                    : normal_of_apart(pair, polygon, at, errors);
  const bool is_face = kind == ContactKind::vertex_face;
  const Balls along_p = times(Ball(at.u), pair.p.now), along_q = times(Ball(at.v), pair.q.now);
  const Balls first = is_face ? pair.a : minus(pair.a, along_p);
  const Balls second = plus(pair.b, is_face ? plus(along_p, along_q) : along_q);
  const double first_error = error_of(first) + (is_face ? 0.0 : errors.first);
  const double second_error = error_of(second) + (is_face ? errors.difference : errors.second);
  return {.at = at,
          .first = pair.in_query_units(first),
          .second = pair.in_query_units(second),
          .normal = normal.direction.vector.array() + 0.0,  // 0 in place of −0
          .point_error = pair.in_query_units(above * std::max(first_error, second_error)),
          .normal_error = normal.direction.error,
          .has_side = normal.has_side};
}

}  // namespace touchstone::fast
