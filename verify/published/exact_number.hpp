#pragma once

/// \file
/// Exact numbers for baselines that decide signs exactly ([brochu2012] and [tang2014] do it in
/// floating-point expansions).
///
/// Expansions overflow and underflow with their terms. Here all doubles of a query are scaled by
/// one power of two to integers, which changes no sign because every form is homogeneous in them,
/// and products and sums of integers are exact over the whole range of doubles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"

namespace touchstone::verify::published {

/// An integer of any size.
class ExactNumber {
 public:
  using Integer = fast::exact_stage::BigInteger;

  ExactNumber() = default;
  ExactNumber(int value) : value_(value) {}  // NOLINT(google-explicit-constructor): a number
  explicit ExactNumber(Integer value) : value_(std::move(value)) {}

  /// −1, 0 or 1.
  [[nodiscard]] int sign() const { return value_.sign(); }
  /// An approximation of this number times 2^exponent; its magnitude is at most the greatest
  /// double, and 0 below the least one.
  [[nodiscard]] double estimate(long exponent) const {
    const auto about = value_.approximation();
    const long shift = std::clamp(about.exponent + exponent, -3000L, 3000L);
    constexpr double greatest = std::numeric_limits<double>::max();
    return std::clamp(std::ldexp(about.significand, static_cast<int>(shift)), -greatest, greatest);
  }

  friend ExactNumber operator-(const ExactNumber& a) { return ExactNumber(-a.value_); }
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
    return ExactNumber(a.value_ + b.value_);
  }
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) {
    return ExactNumber(a.value_ - b.value_);
  }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
    return ExactNumber(a.value_ * b.value_);
  }
  /// \pre the number is even.
  friend ExactNumber half(const ExactNumber& a) { return ExactNumber(a.value_ >> 1); }
  friend bool operator==(const ExactNumber& a, const ExactNumber& b) {
    return a.value_ == b.value_;
  }
  /// True if both are positive, both negative or both 0.
  friend bool same_sign(const ExactNumber& a, const ExactNumber& b) { return a.sign() == b.sign(); }
  /// An approximation of a/b. \pre b is not 0.
  friend double quotient(const ExactNumber& a, const ExactNumber& b) {
    return fast::exact_stage::quotient(a.value_.approximation(), b.value_.approximation());
  }
  friend bool is_zero(const ExactNumber& a) { return a.sign() == 0; }

 private:
  Integer value_;
};

/// The exponent of a power of two that divides all these finite doubles; 0 if all are 0.
[[nodiscard]] inline int common_exponent(std::span<const double> values) {
  int least = std::numeric_limits<int>::max();
  for (const double x : values) {
    if (x != 0.0) least = std::min(least, fast::exact_stage::binary_fraction(x).exponent);
  }
  return least == std::numeric_limits<int>::max() ? 0 : least;
}

/// x / 2^exponent. \pre x is a multiple of 2^exponent.
[[nodiscard]] inline ExactNumber scaled_to_integer(double x, int exponent) {
  const auto fraction = fast::exact_stage::binary_fraction(x);
  if (fraction.numerator == 0) return {};
  const fast::exact_stage::BigInteger numerator(fraction.numerator);
  const long shift = long{fraction.exponent} - exponent;
  return ExactNumber(shift >= 0 ? numerator << shift : numerator >> -shift);
}

/// The doubles divided by one power of two, and doubled `doublings` times.
/// \pre all are finite.
template <std::size_t count>
[[nodiscard]] std::array<ExactNumber, count> scaled_to_integers(
    const std::array<double, count>& values, int doublings = 0) {
  const int exponent = common_exponent(values) - doublings;
  std::array<ExactNumber, count> result;
  for (std::size_t i = 0; i < count; ++i) result[i] = scaled_to_integer(values[i], exponent);
  return result;
}

}  // namespace touchstone::verify::published
