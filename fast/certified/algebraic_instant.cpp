#include "fast/certified/algebraic_instant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "fast/certified/double_search.hpp"

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

/// Sign of a − b.
int compare(const Dyadic& a, const Dyadic& b) {
  return ((a.numerator << b.exponent) - (b.numerator << a.exponent)).sign();
}

Dyadic reduced(const Dyadic& t) {
  if (t.numerator.sign() == 0) return {};
  const long zeros = std::min(t.numerator.trailing_zeros(), t.exponent);
  return {t.numerator >> zeros, t.exponent - zeros};
}

Dyadic dyadic_of(std::uint64_t bits) {
  const DyadicDouble value = dyadic(bits);
  return {value.numerator, value.exponent};
}

Dyadic from_one(const Dyadic& t) {
  return {(BigInteger(1) << t.exponent) - t.numerator, t.exponent};
}

/// lower + (upper − lower) · part
Dyadic between(const Dyadic& lower, const Dyadic& upper, const Dyadic& part) {
  const long exponent = std::max(lower.exponent, upper.exponent);
  const BigInteger low = lower.numerator << (exponent - lower.exponent);
  const BigInteger high = upper.numerator << (exponent - upper.exponent);
  return reduced(
      {(low << part.exponent) + (high - low) * part.numerator, exponent + part.exponent});
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
    product[k] += a * p[k];
    product[k + 1] += b * p[k];
  }
  return product;
}

/// The form on the interval between two times.
Polynomial restricted(std::span<const BigInteger> c, const Time& lower, const Time& upper) {
  Polynomial value{c[0]}, power{1};
  for (std::size_t k = 1; k < c.size(); ++k) {
    power = times_linear(power, lower.y, upper.y);
    value = times_linear(value, lower.x, upper.x);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] += c[k] * power[i];
  }
  return value;
}

/// In parameters that are linear in t: x + y is the same at both ends.
Polynomial restricted(std::span<const BigInteger> c, const Dyadic& lower, const Dyadic& upper) {
  const long exponent = std::max(lower.exponent, upper.exponent);
  const auto time = [&](const Dyadic& t) {
    return time_of({t.numerator << (exponent - t.exponent), exponent});
  };
  return restricted(c, time(lower), time(upper));
}

int sign_changes(const Polynomial& c) {
  int changes = 0, last = 0;
  for (const BigInteger& x : c) {
    const int sign = x.sign();
    if (sign == 0) continue;
    if (sign == -last) ++changes;
    last = sign;
  }
  return changes;
}

/// The sign of the first coefficient that is not 0: near the interval's lower end. 0 for zero.
int first_sign(const Polynomial& c) {
  for (const BigInteger& x : c) {
    if (x.sign() != 0) return x.sign();
  }
  return 0;
}

/// Takes out the power of two that divides all coefficients.
void remove_twos(Polynomial& c) {
  long zeros = -1;
  for (const BigInteger& x : c) {
    if (x.sign() == 0) continue;
    zeros = zeros < 0 ? x.trailing_zeros() : std::min(zeros, x.trailing_zeros());
  }
  if (zeros <= 0) return;
  for (BigInteger& x : c) x >>= zeros;
}

void drop_top_zeros(Polynomial& c) {
  while (!c.empty() && c.back().sign() == 0) c.pop_back();
}

/// A multiple of a mod b.
Polynomial pseudo_remainder(Polynomial a, const Polynomial& b) {
  while (a.size() >= b.size()) {
    const BigInteger top = a.back();
    const std::size_t shift = a.size() - b.size();
    for (BigInteger& x : a) x = x * b.back();
    for (std::size_t k = 0; k < b.size(); ++k) a[k + shift] -= top * b[k];
    drop_top_zeros(a);
  }
  remove_twos(a);
  return a;
}

/// A multiple of a/b. \pre b divides a.
Polynomial pseudo_quotient(Polynomial a, const Polynomial& b) {
  Polynomial quotient(a.size() - b.size() + 1);
  while (a.size() >= b.size()) {
    const BigInteger top = a.back();
    const std::size_t shift = a.size() - b.size();
    for (BigInteger& x : quotient) x = x * b.back();
    quotient[shift] = top;
    for (BigInteger& x : a) x = x * b.back();
    for (std::size_t k = 0; k < b.size(); ++k) a[k + shift] -= top * b[k];
    drop_top_zeros(a);
  }
  remove_twos(quotient);
  return quotient;
}

/// The coefficients as doubles of one scale.
std::vector<double> approximate(const Polynomial& c) {
  std::vector<Approximation> terms;
  long top = 0;
  for (const BigInteger& x : c) {
    terms.push_back(x.approximation());
    if (x.sign() != 0)
      top = terms.size() == 1 ? terms.back().exponent : std::max(top, terms.back().exponent);
  }
  std::vector<double> result;
  for (const Approximation& term : terms) {
    const long exponent = std::max(term.exponent - top, -3000L);
    result.push_back(std::ldexp(term.significand, static_cast<int>(exponent)));
  }
  return result;
}

/// Where in (0,1) the form changes its sign, by bisection over the doubles.
std::uint64_t guess_root(const Polynomial& local, int sign_below) {
  const std::vector<double> c = approximate(local);
  const auto is_below_root = [&](std::uint64_t bits) {
    const double y = std::bit_cast<double>(bits), x = 1.0 - y;
    double value = c[0], power = 1.0;
    for (std::size_t k = 1; k < c.size(); ++k) {
      power *= y;
      value = value * x + c[k] * power;
    }
    return value * sign_below > 0.0;
  };
  return enclose(0.5, 1, is_below_root).upper;
}

}  // namespace

Polynomial inner_polynomial(Polynomial coefficients) {
  drop_top_zeros(coefficients);
  const auto first =
      std::ranges::find_if(coefficients, [](const auto& c) { return c.sign() != 0; });
  coefficients.erase(coefficients.begin(), first);
  remove_twos(coefficients);
  return coefficients;
}

Polynomial common_divisor(Polynomial a, Polynomial b) {
  if (a.size() < b.size()) std::swap(a, b);
  while (!b.empty()) {
    Polynomial remainder = pseudo_remainder(std::move(a), b);
    a = std::move(b);
    b = std::move(remainder);
  }
  return a;
}

Polynomial squarefree(const Polynomial& f) {
  if (f.size() <= 2) return f;
  Polynomial derivative;
  for (std::size_t k = 1; k < f.size(); ++k) {
    derivative.push_back(BigInteger(static_cast<std::int64_t>(k)) * f[k]);
  }
  const Polynomial repeated = common_divisor(f, derivative);
  return repeated.size() == 1 ? f : pseudo_quotient(f, repeated);
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
      sign_below_(first_sign(restricted(f_, lower_, upper_))) {}

bool Instant::cut(const Dyadic& t) {
  const int sign = evaluate(f_, time_of(t)).sign();
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

bool Instant::narrow_by_guess(const Polynomial& local) {
  constexpr std::uint64_t slack = std::uint64_t{1} << 8U;  // in spacings of doubles
  const std::uint64_t root = guess_root(local, sign_below_) & ~(slack - 1);
  if (root <= slack || root + 2 * slack >= bits_of_one) return false;
  const Dyadic lower = between(lower_, upper_, dyadic_of(root - slack));
  const Dyadic upper = between(lower_, upper_, dyadic_of(root + 2 * slack));
  return cut(lower) && !cut(upper);
}

void Instant::narrow() {
  if (is_dyadic()) return;
  if (narrow_by_guess(restricted(f_, lower_, upper_)) || is_dyadic()) return;
  static_cast<void>(cut(split(lower_, upper_)));
}

int Instant::sign_of(const Form<BigInteger, 2>& q) {
  if (is_zero(q)) return 0;
  bool may_be_zero = true;
  for (;;) {
    if (is_dyadic()) return evaluate(q, time_of(lower_)).sign();
    const Polynomial local = restricted(q, lower_, upper_);
    if (sign_changes(local) == 0) return first_sign(local);
    if (may_be_zero) {
      const Polynomial common = common_divisor(f_, inner_polynomial(q));
      if (sign_changes(restricted(common, lower_, upper_)) % 2 == 1) return 0;
      may_be_zero = false;
    }
    narrow();
  }
}

bool Instant::is_above(std::uint64_t bits) {
  const Dyadic t = dyadic_of(bits);
  if (compare(t, lower_) <= 0) return !is_dyadic() || !equal(t, lower_);
  if (compare(t, upper_) >= 0) return false;
  return cut(t);
}

double Instant::guess() const {
  const BigInteger sum =
      (lower_.numerator << upper_.exponent) + (upper_.numerator << lower_.exponent);
  Approximation middle = sum.approximation();
  middle.exponent -= lower_.exponent + upper_.exponent + 1;
  return quotient(middle, {0.5, 1});
}

double Instant::quotient_of(const Form<BigInteger, 2>& numerator,
                            const Form<BigInteger, 2>& denominator) {
  constexpr double accuracy = 0x1p-48;  // above the quotients' own errors
  const auto at = [&](const Dyadic& t) {
    const Time time = time_of(t);
    return quotient(evaluate(numerator, time).approximation(),
                    evaluate(denominator, time).approximation());
  };
  for (;;) {
    const double first = at(lower_);
    if (is_dyadic()) return first;
    const double last = at(upper_);
    const bool regular = sign_changes(restricted(denominator, lower_, upper_)) == 0 &&
                         evaluate(denominator, time_of(lower_)).sign() != 0 &&
                         evaluate(denominator, time_of(upper_)).sign() != 0;
    if (regular && std::abs(first - last) <= accuracy) return first;
    narrow();
  }
}

bool visit_roots(const Polynomial& f, const std::function<bool(Instant&)>& visit) {
  struct Interval {
    Dyadic lower, upper;
  };
  if (f.size() <= 1) return false;
  std::vector<Interval> open{{{0, 0}, {1, 0}}};
  while (!open.empty()) {
    const Interval interval = std::move(open.back());
    open.pop_back();
    if (equal(interval.lower, interval.upper)) {
      Instant point(interval.lower);
      if (visit(point)) return true;
      continue;
    }
    const int changes = sign_changes(restricted(f, interval.lower, interval.upper));
    if (changes == 0) continue;
    if (changes == 1) {
      Instant root(f, interval.lower, interval.upper);
      if (visit(root)) return true;
      continue;
    }
    const Dyadic middle = split(interval.lower, interval.upper);
    open.push_back({middle, interval.upper});
    if (evaluate(f, time_of(middle)).sign() == 0) open.push_back({middle, middle});
    open.push_back({interval.lower, middle});
  }
  return false;
}

}  // namespace touchstone::fast::exact_stage
