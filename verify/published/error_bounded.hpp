#pragma once

/// \file
/// A double with a bound of its error, as TCCD computes ([wang2015]).
///
/// **Theorem.** Without underflow the true value is within the bound of the double. A sum or
/// product rounds by at most 2^-53 of its magnitude; the unit below is a little more than twice
/// that, which also covers that the bounds are themselves rounded to nearest.
///
/// **Underflow breaks it**: bounds are about 2^-52 of the values, so they vanish first. A value
/// with a bound of 0 is then treated as exact, and a 0 with a bound of 0 as exactly zero. tccd.cpp
/// describes the consequences.

#include <cmath>

namespace touchstone::verify::published {

/// value ± bound.
struct ErrorBounded {
  /// ε/(1−ε) with ε = 2^-52: relative error charged to an operation.
  static constexpr double unit = 2.2204460492503136e-16;

  double value = 0.0;
  double bound = 0.0;

  ErrorBounded() = default;
  ErrorBounded(double exact) : value(exact) {}  // NOLINT(google-explicit-constructor): a number
  ErrorBounded(double about, double error) : value(about), bound(error) {}

  /// 1 or −1 if the sign is certain, else 0.
  [[nodiscard]] int sign() const {
    if (value > bound) return 1;
    return value < -bound ? -1 : 0;
  }

  friend ErrorBounded operator-(const ErrorBounded& a) { return {-a.value, a.bound}; }
  friend ErrorBounded operator+(const ErrorBounded& a, const ErrorBounded& b) {
    const double sum = a.value + b.value;
    return {sum, a.bound + b.bound + std::abs(sum) * unit};
  }
  friend ErrorBounded operator-(const ErrorBounded& a, const ErrorBounded& b) { return a + -b; }
  friend ErrorBounded operator*(const ErrorBounded& a, const ErrorBounded& b) {
    const double product = a.value * b.value;
    return {product, a.bound * b.bound + std::abs(a.value) * b.bound + std::abs(b.value) * a.bound +
                         std::abs(product) * unit};
  }
  friend ErrorBounded half(const ErrorBounded& a) { return a * 0.5; }
};

}  // namespace touchstone::verify::published
