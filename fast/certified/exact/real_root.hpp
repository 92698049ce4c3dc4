#pragma once

/// \file
/// Instants in [0,1] that are roots of polynomials, and exact signs of other polynomials at
/// them.
///
/// Polynomials here are inner ones (polynomial.hpp): roots at t=0 and t=1 are treated separately.
/// On an interval from (x0,y0) to (x1,y1) a polynomial becomes the form f(X x0 + Y x1, X y0 + Y
/// y1), whose sign changes bound the number of roots inside (Descartes), counted with multiplicity,
/// and equal it if they are at most one. For a squarefree polynomial, intervals that are small
/// enough have at most one sign change (Vincent), so bisection finds all roots in ascending order.
/// If roots are very close, the interval is divided at a guess of the extremum between them.
/// If fixed point is uncertain, or after three divisions, multiple factors are removed. Intervals
/// that then remain are cut at the roots of the derivative, found in the same way: between
/// neighbours f is monotone, and has a root iff its signs at them differ.
///
/// An instant α is a dyadic number or the only root, a simple one, of f in an open dyadic interval.
/// The sign of q(α): if q's form on the interval has no sign change, the sign of its coefficients.
/// Otherwise it is 0 iff gcd(f,q) has a root in the interval, that is iff its form there has an odd
/// number of sign changes; if it is not 0, halving the interval leads to the first case. Two
/// instants are equal iff the divisor of their polynomials has a root in both intervals.
///
/// Fixed-point arithmetic decides most signs (fixed_point_filter.hpp). Those that it leaves
/// uncertain are mostly 0, so the divisor comes next, which mostly is 1 modulo a prime, and
/// integers last.
///
/// Narrowing guesses the root and computes two exact signs around it; a wrong guess only costs a
/// bisection instead. The first guesses are in floating point, from the form in fixed point, and
/// shorten the interval by the factor 2^-40. Then f is nearly linear on it, and the error of the
/// secant through its values at both ends is about the square of the length: each step shortens the
/// interval by 2^-k, with k twice that of the step before [abbott2006]. So two roots that are
/// 2^-50000 apart take some ten steps.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/polynomial.hpp"

namespace touchstone::fast::exact_stage {

/// numerator / 2^exponent, in [0,1].
struct Dyadic {
  BigInteger numerator;
  long exponent = 0;
};

/// A number strictly between the ends that halves the interval, or halves the logarithm of the
/// ratio of its ends (or of their distances from 1) if these are far apart. So a root close to 0 or
/// 1 needs no more steps than the logarithm of its exponent. \pre lower < upper.
[[nodiscard]] Dyadic split(const Dyadic& lower, const Dyadic& upper);

/// The sign of a − b.
[[nodiscard]] int compare(const Dyadic& a, const Dyadic& b);

/// A time in [0,1].
class Instant {
 public:
  /// A dyadic number.
  explicit Instant(Dyadic value);
  /// The only root of f in the open interval. \pre f has exactly one root there, and it is simple.
  Instant(Polynomial f, Dyadic lower, Dyadic upper);

  /// The sign of a form at this time. Narrows as far as necessary.
  [[nodiscard]] int sign_of(std::span<const BigInteger> q);

  /// The sign of a − b. Narrows both as far as necessary.
  friend int compare(Instant& a, Instant& b);

  /// The ends of an interval that contains this time, strictly inside unless they are equal.
  [[nodiscard]] const Dyadic& lower() const { return lower_; }
  [[nodiscard]] const Dyadic& upper() const { return upper_; }

  /// Shortens the interval, usually by at least 2^-40, and by more each time.
  void narrow();

  /// True if this time is later than the double with these bits (enclosing_doubles.hpp).
  [[nodiscard]] bool is_above(std::uint64_t bits);

  /// An approximation of this time, for guesses. Narrows to about the accuracy of a double, unless
  /// that takes many steps.
  [[nodiscard]] double guess();

  /// numerator/denominator at this time, to about the accuracy of a double (absolute, below 1).
  /// \pre the denominator is not 0 there, and the quotient is in [0,1].
  [[nodiscard]] double quotient_of(std::span<const BigInteger> numerator,
                                   std::span<const BigInteger> denominator);

 private:
  [[nodiscard]] bool narrow_by_guess();
  [[nodiscard]] bool narrow_by_secant();
  /// True if this time is later than `t`, which lies inside the interval. Narrows the interval
  /// accordingly.
  [[nodiscard]] bool cut(const Dyadic& t);
  /// The sign of this time minus `t`.
  [[nodiscard]] int compare_with(const Dyadic& t);
  /// True if q is 0 at this time. \pre it is not a dyadic number
  [[nodiscard]] bool is_root_of(std::span<const BigInteger> q) const;
  /// True if both polynomials have a common root in the intersection of the intervals.
  [[nodiscard]] bool shares_root(const Instant& other) const;
  [[nodiscard]] bool is_dyadic() const { return f_.empty(); }

  Polynomial f_;  // empty: the time is lower_
  Dyadic lower_, upper_;
  int sign_below_ = 0;  // of f_, between lower_ and the root
  /// The next step shortens the interval by the factor 2^-gain_: nearly twice the bits of the last
  /// step if that succeeded, else half. Steps of more than guess_gain bits are secants.
  static constexpr long guess_gain = 40, least_gain = guess_gain / 2;
  long gain_ = least_gain;
};

/// Calls `visit` once for every root of f in the open interval (0,1), ascending, until it returns
/// true. Returns true if it did. \pre f is not zero.
bool visit_roots(Polynomial f, const std::function<bool(Instant&)>& visit);

/// 1 if the form is proved to be nowhere negative between the times, −1 if it is proved to be
/// nowhere positive, else 0.
[[nodiscard]] int weak_sign_between(std::span<const BigInteger> form, const Dyadic& from,
                                    const Dyadic& to);

/// True if the form is proved to be positive from `from` to `to`.
[[nodiscard]] bool is_positive_between(std::span<const BigInteger> form, const Dyadic& from,
                                       const Dyadic& to);

/// The form's smallest root later than `from` and not later than `end`, if it has one.
/// \pre the form is positive at `from`; from.upper() ≤ end ≤ 1.
[[nodiscard]] std::optional<Instant> first_root_after(Instant& from, const Dyadic& end,
                                                      std::span<const BigInteger> form);

/// The double in [0,1] with these bits (enclosing_doubles.hpp).
[[nodiscard]] Dyadic dyadic_of(std::uint64_t bits);

}  // namespace touchstone::fast::exact_stage
