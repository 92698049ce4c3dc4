#pragma once

/// \file
/// Numbers of 106 bits, each with a bound of its error: for expressions without a derived
/// bound, and for magnitudes that are known only at run time.
///
/// A ball represents any real x with |x − center| ≤ radius. The sum, difference or product of two
/// balls contains the sums, differences or products of all numbers in them.
///
/// **Proof.** Let c be the pair computed from the centers a and b, and u = 2^-53.
/// - *Sums.* c is wrong by less than 2^-103 of the exact sum
/// (touchstone/filters/double_double.hpp), so by
///   less than 2^-102 |c.high|. Underflow has no effect: the error is a multiple of 2^-1074, so it
///   is 0 where 2^-103 |c.high| is below that; elsewhere 2^-102 |c.high|, rounded to a multiple of
///   2^-1074, is not below it either. The variation within the balls adds the two radii. The radius
///   is computed by two additions, each exact or wrong by at most u of its sum, and a factor of 1 +
///   2^-50, which exceeds both errors; a product with it never rounds below the other factor.
/// - *Products.* c is wrong by less than 2^-103 of the product and 2^-1071. The variation within
///   the balls adds |a| s + |b| r + r s, where r and s are the radii; the magnitudes of a and b are
///   at most 1 + u times those of their high parts. The radius is computed by operations on numbers
///   that are not negative, six in a row at most, each wrong by at most u of its result and
///   2^-1075; the factor of 1 + 2^-49 and the addition of 2^-1070 exceed these errors together.
/// - A product with a factor that is exactly 0 is exactly 0. (In plain C++; on lanes it has a
///   radius.)
///
/// \pre Nothing overflows, and magnitudes are at most 2^490, so that the halves of factors are in
/// the range of touchstone/filters/double_double.hpp.

#include <type_traits>

#include "touchstone/filters/double_double.hpp"

namespace touchstone::filters {

/// A ball over double, or over lanes with the operations of double.
template <class Scalar>
struct BallOf {
  DoubleDouble<Scalar> center{Scalar(0.0), Scalar(0.0)};
  Scalar radius{0.0};

  constexpr BallOf() = default;
  /// A number without error.
  constexpr explicit BallOf(double x) : center{Scalar(x), Scalar(0.0)} {}
  constexpr explicit BallOf(const DoubleDouble<Scalar>& x) : center(x) {}
  constexpr BallOf(const DoubleDouble<Scalar>& x, const Scalar& error) : center(x), radius(error) {}
};

using Ball = BallOf<double>;

[[nodiscard]] constexpr bool is_exact_zero(const Ball& a) {
  return a.center.high == 0.0 && a.radius == 0.0;
}

/// True if all numbers of the ball are positive. (The low part is at most half a last place of the
/// high one, and the rounding of twice the radius is less than the other half.)
[[nodiscard]] constexpr bool is_positive(const Ball& a) {
  return a.center.high > 0.0 && a.center.high > 2.0 * a.radius;
}
/// The same in each lane.
template <class Scalar>
[[nodiscard]] constexpr auto is_positive(const BallOf<Scalar>& a) {
  return (a.center.high > Scalar(0.0)) & (a.center.high > Scalar(2.0) * a.radius);
}

/// |x|.
template <class Scalar>
[[nodiscard]] constexpr Scalar magnitude(const Scalar& x) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return x < 0.0 ? -x : x;
  } else {
    return abs(x);
  }
}
template <class Scalar>
[[nodiscard]] constexpr BallOf<Scalar> operator-(const BallOf<Scalar>& a) {
  const Scalar zero(0.0);
  return {{zero - a.center.high, zero - a.center.low}, a.radius};
}
[[nodiscard]] constexpr Ball abs(const Ball& a) { return a.center.high < 0.0 ? -a : a; }

/// The sum or difference with this center, of balls whose radii add up to that.
template <class Scalar>
[[nodiscard]] constexpr BallOf<Scalar> ball_of_sum(const DoubleDouble<Scalar>& center,
                                                   const Scalar& radii) {
  constexpr double rounding = 0x1p-102, enough = 1.0 + 0x1p-50;
  return {center, (radii + magnitude(center.high) * Scalar(rounding)) * Scalar(enough)};
}

template <class Scalar>
[[nodiscard]] constexpr BallOf<Scalar> operator+(const BallOf<Scalar>& a, const BallOf<Scalar>& b) {
  return ball_of_sum<Scalar>(a.center + b.center, a.radius + b.radius);
}
template <class Scalar>
[[nodiscard]] constexpr BallOf<Scalar> operator-(const BallOf<Scalar>& a, const BallOf<Scalar>& b) {
  return ball_of_sum<Scalar>(a.center - b.center, a.radius + b.radius);
}

template <class Scalar>
[[nodiscard]] constexpr BallOf<Scalar> operator*(const BallOf<Scalar>& a, const BallOf<Scalar>& b) {
  if constexpr (std::is_same_v<Scalar, double>) {
    if (is_exact_zero(a) || is_exact_zero(b)) return {};
  }
  constexpr double rounding = 0x1p-102, underflow = 0x1p-1070, enough = 1.0 + 0x1p-49;
  const DoubleDouble<Scalar> center = a.center * b.center;
  const Scalar spread =
      magnitude(a.center.high) * b.radius + (magnitude(b.center.high) + b.radius) * a.radius;
  return {center, (spread + magnitude(center.high) * Scalar(rounding)) * Scalar(enough) +
                      Scalar(underflow)};
}

}  // namespace touchstone::filters
