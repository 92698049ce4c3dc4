#pragma once

/// \file
/// Instants in [0,1] that are roots of polynomials, and exact signs of other polynomials there.
///
/// Polynomials here are inner ones (polynomial.hpp): roots at t=0 and t=1 are asked for by themselves.
/// On an interval from (x0,y0) to (x1,y1) it becomes the form f(X x0 + Y x1, X y0 + Y y1), whose sign
/// changes bound the number of roots inside (Descartes), and equal it if they are none or one,
/// multiples counted. Of a squarefree polynomial, intervals that are small enough have none or one
/// (Vincent), so bisection finds all roots in ascending order. Where roots are hardly apart, a guess
/// of the extremum between them is where to look closer. What three divisions do not separate is cut at
/// the roots of the derivative, which are found the same way: between neighbouring ones f is monotone, and
/// has a root iff its signs beside them differ.
///
/// An instant α is a dyadic number or the only root, a simple one, of f in an open dyadic interval.
/// The sign of q(α): if q's form on the interval has no sign change, the sign of its coefficients.
/// Otherwise it is 0 iff gcd(f,q) has a root in the interval, that is iff its form there has an odd
/// number of sign changes; if it is not 0, halving the interval brings the first case about. Two
/// instants are equal iff the divisor of their polynomials has a root in both intervals.
///
/// Most signs are seen in fixed point already: fixed_point_filter.hpp.
///
/// Narrowing guesses the root and asks for two exact signs around it; a wrong guess costs a bisection
/// instead and nothing else. The first guesses are in floating point and make the interval 2^-40 times as
/// long. Then it is so short that f is nearly linear there, and the secant through its values at both
/// ends errs by about the square of the length: each step makes the interval 2^-k times as long, with k
/// twice that of the step before [abbott2006]. So two roots that are 2^-50000 apart take some ten steps.

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

/// A number strictly between them that halves the interval, or halves the logarithm of the ratio of
/// its ends (or of their distances from 1) where these are far apart: so a root near 0 or 1 takes no
/// more steps than the logarithm of its exponent. \pre lower < upper.
[[nodiscard]] Dyadic split(const Dyadic& lower, const Dyadic& upper);

/// The sign of a − b.
[[nodiscard]] int compare(const Dyadic& a, const Dyadic& b);

/// A time in [0,1].
class Instant {
 public:
  /// A dyadic number.
  explicit Instant(Dyadic value);
  /// The only root of f in the open interval. \pre f has just one there, and it is simple.
  Instant(Polynomial f, Dyadic lower, Dyadic upper);

  /// The sign of a form at this time. Narrows as far as that takes.
  [[nodiscard]] int sign_of(std::span<const BigInteger> q);

  /// The sign of a − b. Narrows both as far as that takes.
  friend int compare(Instant& a, Instant& b);

  /// This time is not before lower() and not after upper(); strictly between if they differ.
  [[nodiscard]] const Dyadic& lower() const { return lower_; }
  [[nodiscard]] const Dyadic& upper() const { return upper_; }

  /// Makes the interval much shorter, as a rule by 2^-40 at least, and by more each time.
  void narrow();

  /// Is this time later than the double of these bits (enclosing_doubles.hpp)?
  [[nodiscard]] bool is_above(std::uint64_t bits);

  /// Near this time; a guess.
  [[nodiscard]] double guess() const;

  /// numerator/denominator at this time, to about the accuracy of a double (absolute, below 1).
  /// \pre the denominator is not 0 there, and the quotient is in [0,1].
  [[nodiscard]] double quotient_of(const Form<BigInteger, 2>& numerator,
                                   const Form<BigInteger, 2>& denominator);

 private:
  [[nodiscard]] bool narrow_by_guess();
  [[nodiscard]] bool narrow_by_secant();
  /// Is this time later than `t`, which lies inside the interval? Notes what it finds.
  [[nodiscard]] bool cut(const Dyadic& t);
  /// The sign of this time minus `t`.
  [[nodiscard]] int compare_with(const Dyadic& t);
  /// Do both polynomials have a root where the intervals overlap?
  [[nodiscard]] bool shares_root(const Instant& other) const;
  [[nodiscard]] bool is_dyadic() const { return f_.empty(); }

  Polynomial f_;  // empty: the time is lower_
  Dyadic lower_, upper_;
  int sign_below_ = 0;  // of f_, between lower_ and the root
  /// The next step is to make the interval 2^gain_ times as short: twice the bits of the last one, if
  /// that did, else half. Steps of more than guess_gain bits are secants.
  static constexpr long guess_gain = 40, least_gain = guess_gain / 2;
  long gain_ = least_gain;
};

/// Calls `visit` for every root of f in the open interval (0,1), ascending and once each, until it
/// returns true. Returns whether it did. \pre f is not zero.
bool visit_roots(Polynomial f, const std::function<bool(Instant&)>& visit);

/// 1 if the form is seen not to be negative anywhere between the times, −1 if it is seen not to be
/// positive, else 0.
[[nodiscard]] int weak_sign_between(std::span<const BigInteger> form, const Dyadic& from,
                                    const Dyadic& to);

/// Is the form positive from `from` to `to`? False if that is not seen.
[[nodiscard]] bool is_positive_between(std::span<const BigInteger> form, const Dyadic& from,
                                       const Dyadic& to);

/// The form's smallest root later than `from` and not later than `end`, if it has one.
/// \pre the form is positive at `from`; from.upper() ≤ end ≤ 1.
[[nodiscard]] std::optional<Instant> first_root_after(Instant& from, const Dyadic& end,
                                                      std::span<const BigInteger> form);

/// The double in [0,1] of these bits (enclosing_doubles.hpp).
[[nodiscard]] Dyadic dyadic_of(std::uint64_t bits);

}  // namespace touchstone::fast::exact_stage
