#include "fast/certified/exact/real_root.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/fixed_point_filter.hpp"

namespace touchstone::fast::exact_stage {
namespace {

/// t = y/(x+y).
struct Time {
  BigInteger x, y;
};

Time time_of(const Dyadic& t) { return {(BigInteger(1) << t.exponent) - t.numerator, t.numerator}; }

bool equal(const Dyadic& a, const Dyadic& b) {
  return (a.numerator << b.exponent) == (b.numerator << a.exponent);
}

Dyadic reduced(const Dyadic& t) {
  if (t.numerator.sign() == 0) return {};
  const long zeros = std::min(t.numerator.trailing_zeros(), t.exponent);
  return {t.numerator >> zeros, t.exponent - zeros};
}

Dyadic from_one(const Dyadic& t) {
  return {(BigInteger(1) << t.exponent) - t.numerator, t.exponent};
}

/// lower + (upper − lower) · part, truncated below 2^-64 times the length and times the unit of
/// `part`, which is in (0,1). So the length of numbers is proportional to the precision of their
/// intervals.
Dyadic between(const Dyadic& lower, const Dyadic& upper, const Dyadic& part) {
  constexpr long kept_bits = 64;
  const long exponent = std::max(lower.exponent, upper.exponent);
  const BigInteger low = lower.numerator << (exponent - lower.exponent);
  const BigInteger high = upper.numerator << (exponent - upper.exponent);
  const BigInteger length = high - low;
  const long dropped = std::max(length.bit_length() - kept_bits, 0L);
  return reduced({((low << part.exponent) + length * part.numerator) >> dropped,
                  exponent + part.exponent - dropped});
}

/// Σ c_k x^(n−k) y^k for numbers or, with x and y linear forms, on an interval.
BigInteger evaluate(std::span<const BigInteger> c, const Time& t) {
  BigInteger value = c[0], power = 1;
  for (std::size_t k = 1; k < c.size(); ++k) {
    power = power * t.y;
    value = value * t.x + c[k] * power;
  }
  return value;
}

/// (a + b z) p(z).
Polynomial times_linear(const Polynomial& p, const BigInteger& a, const BigInteger& b) {
  Polynomial product(p.size() + 1);
  for (std::size_t k = 0; k < p.size(); ++k) {
    product[k].add_product(a, p[k]);
    product[k + 1].add_product(b, p[k]);
  }
  return product;
}

/// The form on the interval between two times.
Polynomial restricted(std::span<const BigInteger> c, const Time& lower, const Time& upper) {
  Polynomial value{c[0]}, power{1};
  for (std::size_t k = 1; k < c.size(); ++k) {
    power = times_linear(power, lower.y, upper.y);
    value = times_linear(value, lower.x, upper.x);
    for (std::size_t i = 0; i < value.size(); ++i) value[i].add_product(c[k], power[i]);
  }
  return value;
}

/// The same in parameters that are linear in t: x + y is equal at both ends.
Polynomial restricted(std::span<const BigInteger> c, const Dyadic& lower, const Dyadic& upper) {
  if (lower.numerator.sign() == 0 && equal(upper, {1, 0})) return {c.begin(), c.end()};
  const long exponent = std::max(lower.exponent, upper.exponent);
  const auto time = [&](const Dyadic& t) {
    return time_of({t.numerator << (exponent - t.exponent), exponent});
  };
  return restricted(c, time(lower), time(upper));
}

IntervalSigns signs_of(const Polynomial& c) {
  std::vector<int> signs;
  for (const BigInteger& x : c) signs.push_back(x.sign());
  return interval_signs(signs);
}

// ---- Signs, in fixed point or else in integers --------------------------------------------------

/// A time in the units of FixedPointForm.
std::int64_t in_fixed_point(const Dyadic& t) {
  return static_cast<std::int64_t>(
      t.numerator.truncated(FixedPointForm::fraction_bits - t.exponent));
}

std::optional<FixedPointForm> fixed_point_form(std::span<const BigInteger> c, const Dyadic& lower,
                                               const Dyadic& upper) {
  if (c.size() > FixedPointForm::largest_degree + 1) return std::nullopt;
  return FixedPointForm(c, in_fixed_point(lower), in_fixed_point(upper));
}

/// The signs in fixed point, if they are certain.
std::optional<IntervalSigns> rounded_signs_between(std::span<const BigInteger> c,
                                                   const Dyadic& lower, const Dyadic& upper) {
  const auto form = fixed_point_form(c, lower, upper);
  return form ? form->signs() : std::nullopt;
}

IntervalSigns signs_between(std::span<const BigInteger> c, const Dyadic& lower,
                            const Dyadic& upper) {
  if (const auto signs = rounded_signs_between(c, lower, upper)) return *signs;
  return signs_of(restricted(c, lower, upper));
}

/// The sign at a time.
int sign_at(std::span<const BigInteger> c, const Dyadic& t) {
  if (const auto form = fixed_point_form(c, t, t)) {
    if (form->first_sign() != 0) return form->first_sign();
  }
  return evaluate(c, time_of(t)).sign();
}

// ---- Guesses ------------------------------------------------------------------------------------

/// An approximation of a form on an interval. Its coefficients may differ by more than the range of
/// doubles: next to two very close roots the first ones nearly vanish.
using Guess = std::vector<Approximation>;

/// significand · 2^exponent; 0 far below the range of doubles.
double scaled(double significand, long exponent) {
  // Faster than std::ldexp if the power of two is a double.
  if (exponent >= -1022 && exponent <= 1023) {
    return significand * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
  }
  if (exponent < -1100) return 0.0;
  return std::ldexp(significand, static_cast<int>(std::min(exponent, 3000L)));
}

/// The same with the exponent 0 where a number is not much smaller than the greatest one.
Guess in_one_unit(Guess c) {
  constexpr long much = 500;
  long top = std::numeric_limits<long>::min();
  for (const Approximation& x : c) top = x.significand != 0.0 ? std::max(top, x.exponent) : top;
  for (Approximation& x : c) {
    if (x.significand == 0.0) continue;
    x.exponent -= top;
    if (x.exponent >= -much) x = {scaled(x.significand, x.exponent), 0};
  }
  return c;
}

/// A guess from fixed point, if that is accurate.
std::optional<Guess> rounded_guess(const Polynomial& f, const Dyadic& lower, const Dyadic& upper) {
  constexpr std::int64_t accurate = std::int64_t{1} << 54;
  const auto form = fixed_point_form(f, lower, upper);
  if (!form) return std::nullopt;
  const auto b = form->coefficients();
  if (std::ranges::none_of(b, [](std::int64_t x) { return x > accurate || x < -accurate; })) {
    return std::nullopt;
  }
  Guess result;
  double binomial = 0x1p-60;
  for (std::size_t k = 0; k < b.size(); ++k) {
    result.push_back({static_cast<double>(b[k]) * binomial, 0});
    binomial *= static_cast<double>(b.size() - 1 - k) / static_cast<double>(k + 1);
  }
  return result;
}

Guess local_guess(const Polynomial& f, const Dyadic& lower, const Dyadic& upper) {
  if (auto guess = rounded_guess(f, lower, upper)) return *std::move(guess);
  Guess result;
  for (const BigInteger& x : restricted(f, lower, upper)) result.push_back(x.approximation());
  return in_one_unit(std::move(result));
}

/// a/a_divisor − b/b_divisor.
Approximation difference(const Approximation& a, double a_divisor, const Approximation& b,
                         double b_divisor) {
  const long top = std::max(a.exponent, b.exponent);
  return {scaled(a.significand, a.exponent - top) / a_divisor -
              scaled(b.significand, b.exponent - top) / b_divisor,
          top};
}

/// A number in [0,1]: the double with these bits, divided by 2^exponent.
struct Position {
  std::uint64_t bits = bits_of_zero;
  long exponent = 0;
};

Dyadic dyadic_of(const Position& position) {
  Dyadic result = exact_stage::dyadic_of(position.bits);
  result.exponent += position.exponent;
  return result;
}

/// The form at y in (0,1), x = 1 − y, times a power of two that brings it close to 1.
double value_at(const Guess& c, const Position& at) {
  int y_exponent = 0;
  const double y = std::bit_cast<double>(at.bits), significand = std::frexp(y, &y_exponent);
  const double x = 1.0 - scaled(y, -at.exponent);
  const auto exponent_of = [&](std::size_t k) {
    return c[k].exponent + static_cast<long>(k) * (y_exponent - at.exponent);
  };
  long top = std::numeric_limits<long>::min();
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (c[k].significand != 0.0) top = std::max(top, exponent_of(k));
  }
  double value = 0.0, power = 1.0;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const bool counts = c[k].significand != 0.0;
    value = value * x + (counts ? scaled(c[k].significand * power, exponent_of(k) - top) : 0.0);
    power *= significand;
  }
  return value;
}

/// The place of the sign change, or 1 if there is none, if it is not close to 0 and the
/// coefficients have one unit: by the secant, which counts the value at an end less when that end
/// remains, or by halving.
std::optional<double> guess_ordinary_root(const Guess& c, int sign_below) {
  constexpr double enough = 0x1p-50;
  const auto degree = static_cast<long>(c.size() - 1);
  if (!std::ranges::all_of(c, [](const Approximation& x) { return x.exponent == 0; })) return {};
  const auto value = [&](double y) {
    const double x = 1.0 - y;
    double sum = 0.0, power = sign_below;
    for (const Approximation& a : c) {
      sum = sum * x + a.significand * power;
      power *= y;
    }
    return sum;
  };
  double low = scaled(1.0, -500 / degree), high = 1.0;  // the powers of y are above 2^-500
  double at_low = value(low), at_high = value(high), last = high;
  if (at_high >= 0.0) return high;
  if (!(at_low > 0.0)) return {};
  int kept = 0;  // how often the same end remained: positive for the upper one
  for (int left = 60; left > 0 && high - low > enough * high; --left) {
    const bool halves = left % 4 == 0;
    double y = halves ? 0.5 * (low + high) : low + (high - low) * (at_low / (at_low - at_high));
    if (!(y > low && y < high)) y = 0.5 * (low + high);
    const double here = value(y);
    if (here == 0.0 || std::abs(y - last) <= enough * y) return y;
    last = y;
    if (here > 0.0) {
      low = y;
      at_low = here;
      kept = std::max(kept, 0) + 1;
      if (kept > 1) at_high *= 0.5;
    } else {
      high = y;
      at_high = here;
      kept = std::min(kept, 0) - 1;
      if (kept < -1) at_low *= 0.5;
    }
  }
  return high;
}

/// The place in (0,1) of the form's sign change. Close to 0 by bisection over the doubles: first
/// over those with common exponents, and while it is below them, over those 2^-1000 times as large.
Position guess_root(const Guess& c, int sign_below) {
  if (const auto y = guess_ordinary_root(c, sign_below))
    return {std::bit_cast<std::uint64_t>(*y), 0};
  constexpr auto least = std::bit_cast<std::uint64_t>(0x1p-1000);
  constexpr long most = 1000000;
  Position at;
  for (;; at.exponent += 1000) {
    const auto is_below_root = [&](std::uint64_t bits) {
      return value_at(c, {bits, at.exponent}) * sign_below > 0.0;
    };
    if (at.exponent < most && !is_below_root(least)) continue;
    at.bits = enclose(0.5, 1, is_below_root).upper;
    return at;
  }
}

/// The place in (0,1) at which a form that has this sign at 0 is next to 0, if it has one extremum.
/// With Bernstein's coefficients b_k = c_k / binomial(n,k), its derivative has n (b_(k+1) − b_k).
Position guess_extremum(const Guess& c, int sign) {
  const auto degree = static_cast<double>(c.size() - 1);
  Guess derivative;
  double here = 1.0, next = degree, lower = 1.0;  // binomials of n over k, k + 1; of n − 1 over k
  for (std::size_t k = 0; k + 1 < c.size(); ++k) {
    derivative.push_back(difference(c[k + 1], next, c[k], here));
    derivative.back().significand *= lower;
    const auto i = static_cast<double>(k);
    here = next;
    next *= (degree - i - 1.0) / (i + 2.0);
    lower *= (degree - 1.0 - i) / (i + 1.0);
  }
  return guess_root(derivative, -sign);
}

// ---- Isolation of roots -------------------------------------------------------------------------

/// The derivative by t of a form in x and y: the derivative by y minus the one by x.
Polynomial derivative(const Polynomial& f) {
  const auto degree = static_cast<std::int64_t>(f.size() - 1);
  Polynomial result;
  for (std::int64_t k = 0; k < degree; ++k) {
    const auto i = static_cast<std::size_t>(k);
    result.push_back(BigInteger(k + 1) * f[i + 1] - BigInteger(degree - k) * f[i]);
  }
  return result;
}

/// An interval that may contain roots.
struct Interval {
  Dyadic lower, upper;
  bool guess = true;      ///< true if a guess may choose the place of a split
  bool isolates = false;  ///< true if there is exactly one root inside
};

/// The times in an interval that are this number of spacings of doubles before and after a guess;
/// empty if they are beyond its ends.
struct Around {
  Dyadic before, after;
};
std::optional<Around> around(const Position& guess, std::uint64_t slack, const Dyadic& from,
                             const Dyadic& to) {
  const std::uint64_t rounded = guess.bits & ~(slack - 1);
  if (rounded <= slack || rounded + 2 * slack >= bits_of_one) return std::nullopt;
  return Around{between(from, to, dyadic_of({rounded - slack, guess.exponent})),
                between(from, to, dyadic_of({rounded + 2 * slack, guess.exponent}))};
}

/// The numbers between which a guess finds a cluster of the form's roots, if any.
std::optional<Around> cluster(const Polynomial& f, const Interval& in, int first_sign) {
  constexpr std::uint64_t slack = std::uint64_t{1} << 12U;
  return around(guess_extremum(local_guess(f, in.lower, in.upper), first_sign), slack, in.lower,
                in.upper);
}

/// The intervals that remain to be searched for roots of f, the first one last.
class RootSearch {
 public:
  RootSearch(Polynomial f, Dyadic lower, Dyadic upper)
      : f_(std::move(f)), open_{{std::move(lower), std::move(upper)}} {}

  /// The next root, ascending.
  [[nodiscard]] std::optional<Instant> next() {
    while (!open_.empty()) {
      const Interval interval = std::move(open_.back());
      open_.pop_back();
      if (equal(interval.lower, interval.upper)) return Instant(interval.lower);
      if (interval.isolates) return Instant(f_, interval.lower, interval.upper);
      const IntervalSigns local = signs_in(interval);
      if (local.changes == 1) return Instant(f_, interval.lower, interval.upper);
      if (local.changes > 1) divide(interval, local);
    }
    return std::nullopt;
  }

 private:
  /// The signs in an interval. If fixed point is uncertain, a root may be multiple, which a divisor
  /// shows before integers are needed.
  [[nodiscard]] IntervalSigns signs_in(const Interval& interval) {
    if (const auto local = rounded_signs_between(f_, interval.lower, interval.upper)) return *local;
    make_squarefree();
    return signs_between(f_, interval.lower, interval.upper);
  }

  void make_squarefree() {
    if (!is_squarefree_) f_ = squarefree(f_);
    is_squarefree_ = true;
  }

  /// Searches the parts of an interval. Roots that are not separated after some divisions may be a
  /// single one, or so close that only the extremum between them separates them.
  void divide(const Interval& interval, const IntervalSigns& local) {
    constexpr int patience = 3;
    if (++divisions_ > patience) {
      if (is_squarefree_) return divide_at_extrema(interval, local);
      make_squarefree();
      open_.push_back(interval);
      return;
    }
    const auto close = interval.guess ? cluster(f_, interval, local.first) : std::nullopt;
    if (!close) {
      const Dyadic middle = split(interval.lower, interval.upper);
      open_.push_back({middle, interval.upper});
      push_point(middle);
      open_.push_back({interval.lower, middle});
      return;
    }
    open_.push_back({close->after, interval.upper, false});
    push_point(close->after);
    open_.push_back({close->before, close->after});
    push_point(close->before);
    open_.push_back({interval.lower, close->before, false});
  }

  /// Splits at the extrema if f is squarefree: there is at most one root between neighbours.
  void divide_at_extrema(const Interval& interval, const IntervalSigns& local) {
    std::vector<Interval> parts;
    Dyadic start = interval.lower;
    int sign = local.first;
    const auto add_until = [&](const Dyadic& end, int sign_there) {
      if (sign_there != sign) parts.push_back({start, end, false, true});
      sign = sign_there;
    };
    RootSearch extrema(inner_polynomial(derivative(f_)), interval.lower, interval.upper);
    while (auto extremum = extrema.next()) {
      const int here = extremum->sign_of(f_);
      while (sign_at(f_, extremum->lower()) == 0 || sign_at(f_, extremum->upper()) == 0) {
        extremum->narrow();
      }
      add_until(extremum->lower(), here);
      start = extremum->upper();
    }
    add_until(interval.upper, local.last);
    open_.insert(open_.end(), parts.rbegin(), parts.rend());
  }

  void push_point(const Dyadic& t) {
    if (sign_at(f_, t) == 0) open_.push_back({t, t});
  }

  Polynomial f_;
  std::vector<Interval> open_;
  int divisions_ = 0;
  bool is_squarefree_ = false;
};

}  // namespace

Dyadic dyadic_of(std::uint64_t bits) {
  const auto [numerator, exponent] = odd_fraction(std::bit_cast<double>(bits));
  return {numerator, -exponent};
}

int compare(const Dyadic& a, const Dyadic& b) {
  return ((a.numerator << b.exponent) - (b.numerator << a.exponent)).sign();
}

Dyadic split(const Dyadic& lower, const Dyadic& upper) {
  if (compare(lower, {1, 1}) >= 0 && lower.numerator.sign() != 0) {
    return from_one(split(from_one(upper), from_one(lower)));
  }
  if (compare(upper, {1, 1}) > 0) return {1, 1};
  // 2^top ≥ upper > 2^(top−1)
  const bool power_of_two = upper.numerator.trailing_zeros() + 1 == upper.numerator.bit_length();
  const long top = upper.numerator.bit_length() - upper.exponent - (power_of_two ? 1 : 0);
  if (lower.numerator.sign() == 0) return {1, -2 * top};
  const long bottom = lower.numerator.bit_length() - lower.exponent;  // 2^bottom > lower
  if (bottom < top) {
    const long exponent = bottom + (top - 1 - bottom) / 2;
    return {1, -exponent};
  }
  return between(lower, upper, {1, 1});
}

Instant::Instant(Dyadic value) : lower_(std::move(value)), upper_(lower_) {}

Instant::Instant(Polynomial f, Dyadic lower, Dyadic upper)
    : f_(std::move(f)),
      lower_(std::move(lower)),
      upper_(std::move(upper)),
      sign_below_(signs_between(f_, lower_, upper_).first) {}

bool Instant::cut(const Dyadic& t) {
  const int sign = sign_at(f_, t);
  if (sign == sign_below_) {
    lower_ = t;
    return true;
  }
  upper_ = t;
  if (sign == 0) {
    lower_ = t;
    f_.clear();
  }
  return false;
}

bool Instant::narrow_by_guess() {
  constexpr std::uint64_t slack = std::uint64_t{1} << 8U;
  auto rounded = rounded_guess(f_, lower_, upper_);
  if (!rounded) {
    // Most such intervals are so short that f is nearly linear, which takes two values.
    if (narrow_by_secant()) return true;
    if (is_dyadic()) return false;
  }
  Guess local = rounded ? *std::move(rounded) : local_guess(f_, lower_, upper_);
  // Relative to the closer end, because doubles are dense only near 0.
  const bool from_upper =
      value_at(local, {std::bit_cast<std::uint64_t>(0.5), 0}) * sign_below_ > 0.0;
  if (from_upper) std::ranges::reverse(local);
  const Position root = guess_root(local, from_upper ? -sign_below_ : sign_below_);
  auto near =
      from_upper ? around(root, slack, upper_, lower_) : around(root, slack, lower_, upper_);
  if (!near) return false;
  if (from_upper) std::swap(near->before, near->after);
  return cut(near->before) && !cut(near->after);
}

bool Instant::narrow_by_secant() {
  // The values in a common unit.
  const auto degree = static_cast<long>(f_.size() - 1);
  const BigInteger at_lower = evaluate(f_, time_of(lower_)) << degree * upper_.exponent;
  const BigInteger at_upper = evaluate(f_, time_of(upper_)) << degree * lower_.exponent;
  const BigInteger root = approximate_quotient(at_lower, at_lower - at_upper, gain_);
  const BigInteger first = root - 1, last = root + 2;
  if (first.sign() <= 0 || last.bit_length() > gain_) return false;
  const Dyadic before = between(lower_, upper_, {first, gain_});
  const Dyadic after = between(lower_, upper_, {last, gain_});
  return cut(before) && !cut(after);
}

void Instant::narrow() {
  if (is_dyadic()) return;
  if (gain_ > guess_gain ? narrow_by_secant() : narrow_by_guess()) {
    constexpr long lost_bits = 4;  // of the last step, and of the next one to the curvature
    gain_ = 2 * gain_ - lost_bits;
    return;
  }
  gain_ = std::max(gain_ / 2, least_gain);
  if (!is_dyadic()) static_cast<void>(cut(split(lower_, upper_)));
}

// Fixed point comes first. If it is uncertain, q may be 0, which only a divisor shows; if there is
// none, integers decide.
int Instant::sign_of(std::span<const BigInteger> q) {
  if (is_zero(q)) return 0;
  constexpr int patience = 1;  // narrowing is cheaper than a divisor
  bool is_no_root = false;
  gain_ = least_gain;
  for (int round = 0;; ++round) {
    if (is_dyadic()) return sign_at(q, lower_);
    auto local = rounded_signs_between(q, lower_, upper_);
    if (!is_no_root && (!local || (round == patience && local->changes > 0))) {
      if (is_root_of(q)) return 0;
      is_no_root = true;
    }
    if (!local) local = signs_of(restricted(q, lower_, upper_));
    if (local->changes == 0) return local->first;
    narrow();
  }
}

bool Instant::is_root_of(std::span<const BigInteger> q) const {
  const Polynomial inner = inner_polynomial(q);
  if (inner == f_) return true;
  const Polynomial common = common_divisor(f_, inner);
  return common.size() > 1 && signs_between(common, lower_, upper_).changes % 2 == 1;
}

int Instant::compare_with(const Dyadic& t) {
  if (is_dyadic()) return touchstone::fast::exact_stage::compare(lower_, t);
  if (touchstone::fast::exact_stage::compare(t, lower_) <= 0) return 1;
  if (touchstone::fast::exact_stage::compare(t, upper_) >= 0) return -1;
  if (cut(t)) return 1;
  return is_dyadic() ? 0 : -1;
}

bool Instant::shares_root(const Instant& other) const {
  const Polynomial common = common_divisor(f_, other.f_);
  const auto before = [](const Dyadic& a, const Dyadic& b) {
    return touchstone::fast::exact_stage::compare(a, b) < 0;
  };
  const Dyadic& from = std::max(lower_, other.lower_, before);
  const Dyadic& to = std::min(upper_, other.upper_, before);
  return signs_between(common, from, to).changes % 2 == 1;
}

int compare(Instant& a, Instant& b) {
  constexpr int patience = 1;
  a.gain_ = b.gain_ = Instant::least_gain;
  for (int round = 0;; ++round) {
    if (b.is_dyadic()) return a.compare_with(b.lower_);
    if (a.is_dyadic()) return -b.compare_with(a.lower_);
    if (compare(a.upper_, b.lower_) <= 0) return -1;
    if (compare(b.upper_, a.lower_) <= 0) return 1;
    if (round == patience && a.shares_root(b)) return 0;
    // The two are refined alternately, so that many steps of one do not delay the other.
    const long gain = std::min(a.gain_, b.gain_);
    if (a.gain_ == gain) a.narrow();
    if (b.gain_ == gain) b.narrow();
  }
}

bool Instant::is_above(std::uint64_t bits) {
  const Dyadic t = dyadic_of(bits);
  if (compare(t, lower_) <= 0) return !is_dyadic() || !equal(t, lower_);
  if (compare(t, upper_) >= 0) return false;
  return cut(t);
}

double Instant::guess() {
  constexpr int enough = 3;
  constexpr long accurate_bits = 53;
  gain_ = least_gain;
  for (int round = 0; round < enough && !is_dyadic(); ++round) {
    const long exponent = std::max(lower_.exponent, upper_.exponent);
    const BigInteger upper = upper_.numerator << (exponent - upper_.exponent);
    const BigInteger length = upper - (lower_.numerator << (exponent - lower_.exponent));
    if (upper.bit_length() - length.bit_length() > accurate_bits) break;
    narrow();
  }
  const BigInteger sum =
      (lower_.numerator << upper_.exponent) + (upper_.numerator << lower_.exponent);
  Approximation middle = sum.approximation();
  middle.exponent -= lower_.exponent + upper_.exponent + 1;
  return quotient(middle, {0.5, 1});
}

double Instant::quotient_of(std::span<const BigInteger> numerator,
                            std::span<const BigInteger> denominator) {
  constexpr double accuracy = 0x1p-48;  // above the quotients' own errors
  const auto at = [&](const Dyadic& t) {
    const Time time = time_of(t);
    return quotient(evaluate(numerator, time).approximation(),
                    evaluate(denominator, time).approximation());
  };
  gain_ = least_gain;
  for (;;) {
    const double first = at(lower_);
    if (is_dyadic()) return first;
    const double last = at(upper_);
    const bool regular = signs_of(restricted(denominator, lower_, upper_)).changes == 0 &&
                         evaluate(denominator, time_of(lower_)).sign() != 0 &&
                         evaluate(denominator, time_of(upper_)).sign() != 0;
    if (regular && std::abs(first - last) <= accuracy) return first;
    narrow();
  }
}

bool visit_roots(Polynomial f, const std::function<bool(Instant&)>& visit) {
  if (f.size() <= 1) return false;
  RootSearch search(std::move(f), {0, 0}, {1, 0});
  while (auto root = search.next()) {
    if (visit(*root)) return true;
  }
  return false;
}

int weak_sign_between(std::span<const BigInteger> form, const Dyadic& from, const Dyadic& to) {
  const IntervalSigns local = signs_between(form, from, to);
  return local.changes == 0 ? local.first : 0;
}

bool is_positive_between(std::span<const BigInteger> form, const Dyadic& from, const Dyadic& to) {
  if (equal(from, to)) return sign_at(form, from) > 0;
  if (const auto rounded = fixed_point_form(form, from, to)) {
    if (const auto signs = rounded->signs(); signs && signs->changes == 0) return signs->first > 0;
  }
  const Polynomial local = restricted(form, from, to);
  return signs_of(local).changes == 0 && local.front().sign() > 0 && local.back().sign() > 0;
}

std::optional<Instant> first_root_after(Instant& from, const Dyadic& end,
                                        std::span<const BigInteger> form) {
  // One sign on the whole interval of `from`: the first root is not inside.
  static_cast<void>(from.sign_of(form));
  const Dyadic& start = from.upper();
  if (sign_at(form, start) == 0) return Instant(start);
  if (equal(start, end)) return std::nullopt;
  Polynomial f = inner_polynomial(form);
  if (auto root = RootSearch(std::move(f), start, end).next()) return root;
  if (sign_at(form, end) == 0) return Instant(end);
  return std::nullopt;
}

}  // namespace touchstone::fast::exact_stage
