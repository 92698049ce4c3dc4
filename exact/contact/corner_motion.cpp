#include "exact/contact/corner_motion.hpp"

#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include "exact/algebra/positivity.hpp"

namespace touchstone::exact {
namespace {

/// A finite double as significand · 2^exponent with an odd significand (0 · 2^0 for zero).
struct Decomposed {
  std::int64_t significand = 0;
  int exponent = 0;
};

/// Decomposes by the bits, because a caller's floating-point environment may flush subnormals to
/// zero.
Decomposed decompose(double x) {
  static constexpr int fraction_bits = 52, exponent_bias = 1075, special_exponent = 0x7FF;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int field = static_cast<int>((bits >> fraction_bits) & special_exponent);
  if (field == special_exponent) throw std::domain_error("a query's coordinates must be finite");
  std::uint64_t significand = bits & ((std::uint64_t{1} << fraction_bits) - 1);
  if (field != 0) significand |= std::uint64_t{1} << fraction_bits;
  if (significand == 0) return {};
  const int zeros = std::countr_zero(significand);
  const auto magnitude = static_cast<std::int64_t>(significand >> zeros);
  return {(bits >> 63U) != 0 ? -magnitude : magnitude, std::max(field, 1) - exponent_bias + zeros};
}

constexpr int no_exponent = std::numeric_limits<int>::max();

/// The exponent of the last bit; no_exponent for zero.
int last_exponent(const Decomposed& x) { return x.significand == 0 ? no_exponent : x.exponent; }

/// Converts by long or, where that has 32 bits, by a double, which is slower.
Integer significand_of(const Decomposed& x) {
  if constexpr (sizeof(long) >= sizeof(x.significand)) {
    return static_cast<long>(x.significand);
  } else {
    Integer value;
    value = static_cast<double>(x.significand);
    return value;
  }
}

/// x as a multiple of 2^unit. \pre unit ≤ its last exponent
Integer in_units(const Decomposed& x, int unit) {
  Integer value = significand_of(x);
  if (x.significand != 0) value <<= static_cast<unsigned long>(x.exponent - unit);
  return value;
}

/// The exponent of an axis' last bit.
int axis_exponent(const Query& query, std::size_t axis) {
  int least = no_exponent;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      least = std::min(least, last_exponent(decompose(query.at(end, point, axis))));
    }
  }
  return least;
}

/// The motion in units 2^units of each axis.
Motion in_units(ContactKind kind, const Query& query, const std::array<int, 3>& units) {
  Motion motion{.kind = kind, .points = {}, .corners = {}, .corner_count = 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        motion.points[point][axis].c[end] =
            in_units(decompose(query.at(end, point, axis)), units[axis]);
      }
    }
  }
  set_corners(motion);
  return motion;
}

/// The distance of a separation. \throws std::invalid_argument if it is not valid.
Decomposed distance_of(const Separation& separation) {
  // A comparison accepts a negative subnormal if the environment treats it as zero.
  const bool is_infinite_or_nan = !is_valid(separation);
  const Decomposed distance =
      is_infinite_or_nan ? Decomposed{-1, 0} : decompose(separation.distance);
  if (distance.significand < 0) {
    throw std::invalid_argument("a separation's distance must be finite and not negative");
  }
  return distance;
}

// ---- Curves -------------------------------------------------------------------------------------

/// A resting point has one weight, which does not matter.
bool is_rational(const Trajectory& curve) { return curve.weights.size() > 1; }

/// The weights as a form with integer coefficients; 1 for a polynomial curve.
CurvedForm weight_form(const Trajectory& curve) {
  if (!is_rational(curve)) return {{Integer(1)}};
  int unit = no_exponent;
  for (const double weight : curve.weights) unit = std::min(unit, last_exponent(decompose(weight)));
  CurvedForm form{binomials(curve.degree())};
  for (std::size_t j = 0; j < form.c.size(); ++j) {
    form.c[j] *= in_units(decompose(curve.weights[j]), unit);
  }
  return form;
}

/// Weight times position along an axis, in units 2^unit.
CurvedForm numerator(const Trajectory& curve, const CurvedForm& weights, std::size_t axis,
                     int unit) {
  CurvedForm form = is_rational(curve) ? weights : CurvedForm{binomials(curve.degree())};
  for (std::size_t j = 0; j < form.c.size(); ++j) {
    form.c[j] *= in_units(decompose(curve.control[j][axis]), unit);
  }
  return form;
}

void require_valid(const Trajectory& curve) {
  if (curve.control.empty() || curve.degree() > greatest_degree) {
    throw std::invalid_argument("a trajectory must have 1 to 9 control points");
  }
  if (curve.weights.empty()) return;
  if (curve.weights.size() != curve.control.size()) {
    throw std::invalid_argument("a trajectory must have as many weights as control points");
  }
  for (const double weight : curve.weights) {
    if (decompose(weight).significand <= 0) {
      throw std::domain_error("the weights of a trajectory must be positive");
    }
  }
}

/// The same polynomial as a form of this degree: multiplied by powers of (1−t) + t.
CurvedForm raised_to(CurvedForm form, std::size_t degree) {
  const CurvedForm step{{Integer(1), Integer(1)}};
  while (form.c.size() <= degree) form = form * step;
  return form;
}

/// The denominators of the points, those of equal weights once.
std::vector<CurvedForm> distinct_weights(const std::vector<CurvedForm>& weights) {
  std::vector<CurvedForm> distinct;
  for (const CurvedForm& form : weights) {
    const auto is_this = [&](const CurvedForm& other) { return other.c == form.c; };
    if (form.c.size() > 1 && std::ranges::none_of(distinct, is_this)) distinct.push_back(form);
  }
  return distinct;
}

}  // namespace

Polynomial to_polynomial(std::span<const Integer> form) {
  if (form.empty()) return {};
  // Compute Σ c_k s^(n−k) t^k, s = 1−t, by Horner's rule in s.
  std::vector<Integer> a(form.size());
  a[0] = form[0];
  for (std::size_t k = 1; k < form.size(); ++k) {
    for (std::size_t i = k; i > 0; --i) a[i] -= a[i - 1];
    a[k] += form[k];
  }
  return Polynomial(std::move(a));
}

int sign_at(std::span<const Integer> form, AlgebraicNumber& t) {
  if (form.empty()) return 0;
  if (t.rational() == Rational(0)) return sgn(form.front());
  if (t.rational() == Rational(1)) return sgn(form.back());
  bool positive = false, negative = false;
  for (const Integer& x : form) {
    positive = positive || sgn(x) > 0;
    negative = negative || sgn(x) < 0;
  }
  if (positive && negative) return t.sign_of(to_polynomial(form));
  return (positive ? 1 : 0) - (negative ? 1 : 0);
}

Motion scale(ContactKind kind, const Query& query, const Separation& separation) {
  if (!is_zero(separation)) return scale_uniformly(kind, query, separation);
  return in_units(kind, query,
                  {axis_exponent(query, 0), axis_exponent(query, 1), axis_exponent(query, 2)});
}

Motion scale_uniformly(ContactKind kind, const Query& query, const Separation& separation) {
  const Decomposed distance = distance_of(separation);
  int unit = last_exponent(distance);
  for (std::size_t axis = 0; axis < 3; ++axis) unit = std::min(unit, axis_exponent(query, axis));
  Motion motion = in_units(kind, query, {unit, unit, unit});
  motion.distance = in_units(distance, unit);
  motion.norm = separation.norm;
  return motion;
}

namespace {

/// \param is_uniform One unit for all axes.
MotionOf<Curved> scaled(ContactKind kind, const CurvedQuery& query, const Separation& separation,
                        bool is_uniform) {
  const Decomposed distance = distance_of(separation);
  std::array<int, 3> units{no_exponent, no_exponent, no_exponent};
  std::vector<CurvedForm> weights;
  for (const Trajectory& curve : query) {
    require_valid(curve);
    weights.push_back(weight_form(curve));
    for (const auto& point : curve.control) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        units[axis] = std::min(units[axis], last_exponent(decompose(point[axis])));
      }
    }
  }
  MotionOf<Curved> motion{.kind = kind, .points = {}, .corners = {}, .corner_count = 0};
  if (is_uniform) {
    units.fill(std::min(std::ranges::min(units), last_exponent(distance)));
    motion.distance = in_units(distance, units[0]);
  }
  motion.norm = separation.norm;
  const std::vector<CurvedForm> distinct = distinct_weights(weights);
  std::size_t degree = 1;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CurvedForm form = numerator(query[point], weights[point], axis, units[axis]);
      for (const CurvedForm& other : distinct) {
        if (other.c != weights[point].c) form = form * other;
      }
      degree = std::max(degree, form.c.size() - 1);
      motion.points[point][axis] = std::move(form);
    }
  }
  CurvedForm& denominator = motion.denominator.value;
  for (const CurvedForm& other : distinct) {
    denominator = denominator * other;
    const Polynomial factor = primitive_part(to_polynomial(other.c));
    if (factor.degree() > 0) motion.denominator.of_points.push_back(factor);
  }
  denominator = raised_to(std::move(denominator), degree);
  for (auto& point : motion.points) {
    for (CurvedForm& form : point) form = raised_to(std::move(form), degree);
  }
  set_corners(motion);
  return motion;
}

}  // namespace

MotionOf<Curved> scale(ContactKind kind, const CurvedQuery& query, const Separation& separation) {
  return scaled(kind, query, separation, !is_zero(separation));
}

MotionOf<Curved> scale_uniformly(ContactKind kind, const CurvedQuery& query,
                                 const Separation& separation) {
  return scaled(kind, query, separation, true);
}

}  // namespace touchstone::exact
