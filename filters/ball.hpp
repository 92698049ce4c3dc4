#pragma once

/// \file
/// Numbers of 106 bits, each with a bound of its error: for expressions whose bound nobody has
/// derived, and for magnitudes that are known at run time alone.
///
/// A ball stands for any real x with |x − center| ≤ radius. The sum, difference or product of two balls
/// holds those of all numbers in them.
///
/// **Proof.** Let c be the pair computed from the centers a and b, and u = 2^-53.
/// - *Sums.* c is wrong by less than 2^-103 of the exact sum (filters/double_double.hpp), so by less
///   than 2^-102 |c.high|. Underflow takes no part: the error is a multiple of 2^-1074, so it is 0
///   where 2^-103 |c.high| is below that; elsewhere 2^-102 |c.high|, rounded to a multiple of 2^-1074,
///   is not below it either. Numbers in the balls add the two radii. The radius is computed by two
///   additions, each exact or wrong by at most u of its sum, and a factor of 1 + 2^-50, which is more
///   than both and never rounds to less than what it multiplies.
/// - *Products.* c is wrong by less than 2^-103 of the product and 2^-1071. Numbers in the balls add
///   |a| s + |b| r + r s, where r and s are the radii; the magnitudes of a and b are at most 1 + u
///   times those of their high parts. The radius is computed by operations on numbers that are not
///   negative, six in a row at most, each wrong by at most u of its result and 2^-1075; the factor of
///   1 + 2^-49 and the addition of 2^-1070 are more than all of that.
/// - A factor that is exactly 0 makes a product that is.
///
/// \pre Nothing overflows, and magnitudes are at most 2^490: so those of factors' halves are in the
/// range of filters/double_double.hpp.

#include <array>

#include "filters/double_double.hpp"

namespace touchstone::filters {

struct Ball {
  DoubleDouble<double> center{0.0, 0.0};
  double radius = 0.0;

  constexpr Ball() = default;
  /// Exactly this number.
  constexpr explicit Ball(double x) : center{x, 0.0} {}
  constexpr explicit Ball(const DoubleDouble<double>& x) : center(x) {}
  constexpr Ball(const DoubleDouble<double>& x, double error) : center(x), radius(error) {}

  [[nodiscard]] constexpr bool is_exact_zero() const { return center.high == 0.0 && radius == 0.0; }
};

/// Are all numbers of the ball positive? (The low part is at most half a last place of the high
/// one, and the rounding of twice the radius cannot make up for the half that is left.)
[[nodiscard]] constexpr bool is_positive(const Ball& a) {
  return a.center.high > 0.0 && a.center.high > 2.0 * a.radius;
}

[[nodiscard]] constexpr double magnitude(double x) { return x < 0.0 ? -x : x; }

[[nodiscard]] constexpr Ball operator-(const Ball& a) {
  return {{-a.center.high, -a.center.low}, a.radius};
}

namespace ball_arithmetic {

[[nodiscard]] constexpr Ball sum(const DoubleDouble<double>& center, double radii) {
  constexpr double rounding = 0x1p-102, enough = 1.0 + 0x1p-50;
  return {center, (radii + magnitude(center.high) * rounding) * enough};
}

}  // namespace ball_arithmetic

[[nodiscard]] constexpr Ball operator+(const Ball& a, const Ball& b) {
  return ball_arithmetic::sum(a.center + b.center, a.radius + b.radius);
}
[[nodiscard]] constexpr Ball operator-(const Ball& a, const Ball& b) {
  return ball_arithmetic::sum(a.center - b.center, a.radius + b.radius);
}

[[nodiscard]] constexpr Ball operator*(const Ball& a, const Ball& b) {
  if (a.is_exact_zero() || b.is_exact_zero()) return {};
  constexpr double rounding = 0x1p-102, underflow = 0x1p-1070, enough = 1.0 + 0x1p-49;
  const DoubleDouble<double> center = a.center * b.center;
  const double spread =
      magnitude(a.center.high) * b.radius + (magnitude(b.center.high) + b.radius) * a.radius;
  return {center, (spread + magnitude(center.high) * rounding) * enough + underflow};
}

/// |x|.
[[nodiscard]] constexpr Ball abs(const Ball& a) { return a.center.high < 0.0 ? -a : a; }

}  // namespace touchstone::filters
