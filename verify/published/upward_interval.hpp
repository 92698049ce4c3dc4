#pragma once

/// \file
/// Intervals whose lower end is stored negated, so that one rounding mode, upward, serves both ends
/// ([brochu2012], [tang2014]); also those of IRF and UIRF.
///
/// **Theorem.** Under upward rounding the result of an operation holds every result of it on
/// numbers of the operands, also where ends overflow or underflow: −lower and upper are each
/// bounded from above, and rounding up keeps bounds from above. Neither end's stored number is ever
/// −∞, so sums are never NaN; a product is where an end 0 meets an infinite one, and there the
/// bound is 0 since the numbers themselves are finite.
///
/// The rounding mode is the caller's duty: RoundingMode.

#include <algorithm>
#include <cfenv>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::verify::published {

/// The numbers from −minus_lower to upper.
struct UpwardInterval {
  double minus_lower = 0.0;
  double upper = 0.0;

  UpwardInterval() = default;
  UpwardInterval(double x) : minus_lower(-x), upper(x) {}  // NOLINT(google-explicit-constructor)
  UpwardInterval(double negated_lower, double upper_end)
      : minus_lower(negated_lower), upper(upper_end) {}

  /// 1 or −1 where all its numbers have that sign, else 0.
  [[nodiscard]] int sign() const {
    if (minus_lower < 0.0) return 1;
    return upper < 0.0 ? -1 : 0;
  }
  /// About the middle; NaN where both ends are infinite.
  [[nodiscard]] double estimate() const { return 0.5 * (upper - minus_lower); }

  friend UpwardInterval operator-(const UpwardInterval& a) { return {a.upper, a.minus_lower}; }
  friend UpwardInterval operator+(const UpwardInterval& a, const UpwardInterval& b) {
    return {a.minus_lower + b.minus_lower, a.upper + b.upper};
  }
  friend UpwardInterval operator-(const UpwardInterval& a, const UpwardInterval& b) {
    return a + -b;
  }
  friend UpwardInterval operator*(const UpwardInterval& a, const UpwardInterval& b) {
    if (a.minus_lower <= 0.0) return positive_times(a, b);
    if (a.upper <= 0.0) return -positive_times(-a, b);
    return {std::max(bound(a.minus_lower, b.upper), bound(a.upper, b.minus_lower)),
            std::max(bound(a.upper, b.upper), bound(a.minus_lower, b.minus_lower))};
  }
  friend UpwardInterval half(const UpwardInterval& a) {
    return {0.5 * a.minus_lower, 0.5 * a.upper};
  }
  /// True if a number of one may have the sign of a number of the other; always true if one holds
  /// 0.
  friend bool same_sign(const UpwardInterval& a, const UpwardInterval& b) {
    return a.sign() * b.sign() >= 0;
  }
  /// True if it is the number 0 alone.
  friend bool is_zero(const UpwardInterval& a) { return a.minus_lower == 0.0 && a.upper == 0.0; }

 private:
  /// x·y, rounded up, where an infinite factor stands for an unknown finite one.
  static double bound(double x, double y) {
    const double product = x * y;
    return product == product ? product : 0.0;
  }
  /// a·b for a ≥ 0.
  static UpwardInterval positive_times(const UpwardInterval& a, const UpwardInterval& b) {
    const double least = -a.minus_lower;
    return {bound(b.minus_lower >= 0.0 ? a.upper : least, b.minus_lower),
            bound(b.upper >= 0.0 ? a.upper : least, b.upper)};
  }
};

/// While it lives, this thread rounds in another mode; then the mode before it is back, also where
/// an exception ended its life. (BSC's published code forgets that, bsc.cpp.)
///
/// The compiler knows of no mode, and may move arithmetic across the guard within a function. So
/// the arithmetic belongs in a function that is called, and not inlined, while the guard lives, and
/// in a file compiled with -frounding-math.
class RoundingMode {
 public:
  /// \param mode FE_UPWARD or FE_TONEAREST
  explicit RoundingMode(int mode) : callers_(current()) { set(mode); }
  ~RoundingMode() { set(callers_); }
  RoundingMode(const RoundingMode&) = delete;
  RoundingMode& operator=(const RoundingMode&) = delete;
  RoundingMode(RoundingMode&&) = delete;
  RoundingMode& operator=(RoundingMode&&) = delete;

 private:
#ifdef __SSE2__
  // std::fesetround sets the old floating-point unit too, which costs more than a query.
  static int current() { return static_cast<int>(_MM_GET_ROUNDING_MODE() >> 3U); }
  static void set(int mode) { _MM_SET_ROUNDING_MODE(static_cast<unsigned>(mode) << 3U); }
#else
  static int current() { return std::fegetround(); }
  static void set(int mode) { std::fesetround(mode); }
#endif

  int callers_;
};

/// The middle of an interval, rounded to nearest in any mode.
[[nodiscard, gnu::noinline]] inline double middle_of(const UpwardInterval& x) {
  const RoundingMode nearest(FE_TONEAREST);
  // Read and written where the mode is set.
  const volatile double lower = -x.minus_lower, upper = x.upper;
  const volatile double middle = (lower + upper) / 2.0;
  return middle;
}

}  // namespace touchstone::verify::published
