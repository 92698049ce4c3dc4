#include "exact/contact/corner_motion.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchstone::exact {
namespace {

/// A finite double as significand · 2^exponent with an odd significand (0 · 2^0 for zero).
struct Decomposed {
  std::int64_t significand = 0;
  int exponent = 0;
};

/// Computed from the bits, because a caller's floating-point environment may flush subnormals to
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

/// GMP's integers are made of long, which has 32 bits on some processors, or of a double, which
/// takes longer.
Integer significand_of(const Decomposed& x) {
  if constexpr (sizeof(long) >= sizeof(x.significand)) return static_cast<long>(x.significand);
  return Integer(static_cast<double>(x.significand));
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
Motion in_units(Kind kind, const Query& query, const std::array<int, 3>& units) {
  Motion motion{.kind = kind, .points = {}, .corners = {}, .corner_count = 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        motion.points[point][axis].c[end] =
            in_units(decompose(query.at(end, point, axis)), units[axis]);
      }
    }
  }
  for (const Corner& corner : corners(kind)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion.corners[motion.corner_count][axis] =
          motion.points[corner.plus][axis] - motion.points[corner.minus][axis];
    }
    ++motion.corner_count;
  }
  return motion;
}

}  // namespace

Polynomial to_polynomial(std::span<const Integer> form) {
  // With s = 1−t, one factor s at a time: Σ c_k s^(n−k) t^k by Horner's rule in s.
  std::vector<Integer> a(form.size());
  a[0] = form[0];
  for (std::size_t k = 1; k < form.size(); ++k) {
    for (std::size_t i = k; i > 0; --i) a[i] -= a[i - 1];
    a[k] += form[k];
  }
  return Polynomial(std::move(a));
}

int sign_at(std::span<const Integer> form, AlgebraicNumber& t) {
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

Motion scale_to_integers(Kind kind, const Query& query) {
  return in_units(kind, query,
                  {axis_exponent(query, 0), axis_exponent(query, 1), axis_exponent(query, 2)});
}

Motion scale_uniformly(Kind kind, const Query& query, const Separation& separation) {
  // A comparison accepts a negative subnormal if the environment treats it as zero.
  const bool is_infinite_or_nan = !is_valid(separation);
  const Decomposed distance =
      is_infinite_or_nan ? Decomposed{-1, 0} : decompose(separation.distance);
  if (distance.significand < 0) {
    throw std::invalid_argument("a separation's distance must be finite and not negative");
  }
  int unit = last_exponent(distance);
  for (std::size_t axis = 0; axis < 3; ++axis) unit = std::min(unit, axis_exponent(query, axis));
  Motion motion = in_units(kind, query, {unit, unit, unit});
  motion.distance = in_units(distance, unit);
  motion.norm = separation.norm;
  return motion;
}

Form<2> cross_component(const Motion& motion, std::size_t i, std::size_t j, std::size_t axis) {
  const Motion::Point &a = motion.corners[i], &b = motion.corners[j];
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  Form<2> result = a[y] * b[z];
  subtract_product(result, a[z], b[y]);
  return result;
}

Form<2> dot(const Motion& motion, std::size_t i, std::size_t j) {
  const Motion::Point &a = motion.corners[i], &b = motion.corners[j];
  Form<2> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) add_product(sum, a[axis], b[axis]);
  return sum;
}

Form<2> normal_component(const Motion& motion, std::size_t axis) {
  const std::size_t last = motion.corner_count - 1;
  const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
  const auto edge = [&](std::size_t corner, std::size_t k) {
    return motion.corners[corner][k] - motion.corners[0][k];
  };
  Form<2> result = edge(1, y) * edge(last, z);
  subtract_product(result, edge(1, z), edge(last, y));
  return result;
}

Form<3> determinant(const Motion& motion) {
  const std::size_t last = motion.corner_count - 1;
  Form<3> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_product(sum, cross_component(motion, 0, 1, axis), motion.corners[last][axis]);
  }
  return sum;
}

}  // namespace touchstone::exact
