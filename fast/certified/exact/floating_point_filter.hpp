#pragma once

/// \file
/// Exact signs of forms at times, mostly from floating point.
///
/// Times are t = y/(x+y), and a form of degree n is known by its Bernstein coefficients b_i, times
/// a factor. With weights x, y of n times, de Casteljau's steps, b_i ← b_i x + b_{i+1} y for one
/// time after the other, yield its *blossom* at these times, up to a positive factor: for n times t
/// its value there, and for k times e and n−k times s its Bernstein coefficient k on [s,e].
///
/// **Bound.** Let the steps run in doubles, from rounded b_i, x and y, and also with |b_i| for b_i,
/// which yields m. For n ≤ 3 the error of the computed value is less than 2^-47 m, in any rounding
/// mode. Proof. With v = 2^-52, every operation and conversion has a relative error δ, |δ| ≤ v,
/// without subnormals and overflow, and b_i one of at most 5v (FixedInteger::rounded). The value is
/// a sum of terms, each with at most one rounded weight, product and sum for each step: it has at
/// most 5 + 3n ≤ 14 factors 1+δ, so its error is less than 15v of its magnitude. m is the sum of
/// these magnitudes, and computed at least 1 − 15v of it; 15v / (1 − 15v) < 2^-48. All numbers are
/// integers, so none but 0 is below 1; an overflow makes m infinite, and then the sign is unknown.
/// ∎
///
/// **Reason.** With integers alone `touchstone bench handcrafted --method certified` takes 1.2
/// (vertex-face) and 1.6 times (edge-edge) as long (medians of three runs of each program, 23
/// November 2026).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {

/// t = y/(x+y). \pre x, y ≥ 0, and x + y is positive and at most a quarter of the type's maximum:
/// then a mean of two coefficients, weighted with x and y, needs only the weight's limbs in
/// addition.
template <class Weight>
struct BasicTime {
  Weight x, y;
  double rounded_x, rounded_y;

  constexpr BasicTime(Weight of_start, Weight of_end)
      : x(of_start),
        y(of_end),
        rounded_x(static_cast<double>(x)),
        rounded_y(static_cast<double>(y)) {}

  [[nodiscard]] Weight sum() const { return x + y; }
  [[nodiscard]] double guess() const { return rounded_y / (rounded_x + rounded_y); }
};

/// A de Casteljau step: the form with one of its arguments set to a time.
template <std::size_t limbs, std::size_t count, class Weight>
auto blended(const std::array<FixedInteger<limbs>, count>& b, const BasicTime<Weight>& t) {
  std::array<decltype(blend(b[0], t.x, b[0], t.y)), count - 1> result;
  for (std::size_t i = 0; i + 1 < count; ++i) result[i] = blend(b[i], t.x, b[i + 1], t.y);
  return result;
}

/// The exact blossom.
template <std::size_t limbs>
FixedInteger<limbs> blossom(const std::array<FixedInteger<limbs>, 1>& b) {
  return b[0];
}
template <std::size_t limbs, std::size_t count, class Weight, class... Rest>
auto blossom(const std::array<FixedInteger<limbs>, count>& b, const BasicTime<Weight>& t,
             const Rest&... rest) {
  return blossom(blended(b, t), rest...);
}

/// A blossom in floating point.
struct RoundedBlossom {
  static constexpr double rounding = 0x1p-47;

  double value;
  double magnitude;  ///< m

  /// The sign if it is certain, else 0.
  [[nodiscard]] int sign() const {
    if (!(std::abs(value) > rounding * magnitude)) return 0;
    return value > 0.0 ? 1 : -1;
  }
  /// True if the value is accurate enough for uses without proof.
  [[nodiscard]] bool is_near() const { return std::abs(value) > 0x1p-3 * magnitude; }
};

/// A form of degree up to 3, given by its coefficients.
template <std::size_t limbs, std::size_t count>
class FilteredForm {
  static_assert(2 <= count && count <= 4);

 public:
  static constexpr std::size_t degree = count - 1;

  FilteredForm() = default;
  /// The form Σ c_k x^(n−k) y^k, whose Bernstein coefficients are c_k / binomial(n,k); here
  /// multiplied by n.
  explicit FilteredForm(const std::array<FixedInteger<limbs>, count>& c) : form_(c) {
    for (std::size_t i = 0; i < count; ++i) rounded_[i] = c[i].rounded();
    rounded_.front() *= end_factor;
    rounded_.back() *= end_factor;
  }

  /// The c_k.
  [[nodiscard]] const std::array<FixedInteger<limbs>, count>& form() const { return form_; }
  [[nodiscard]] bool is_zero() const {
    return std::ranges::all_of(form_, [](const auto& c) { return c.sign() == 0; });
  }
  /// The b_i.
  [[nodiscard]] const std::array<double, count>& rounded() const { return rounded_; }
  [[nodiscard]] int coefficient_sign(std::size_t i) const { return form_[i].sign(); }

  /// The sign of the blossom; the number of times is the degree.
  template <class... Times>
  [[nodiscard]] int sign(const Times&... times) const {
    static_assert(sizeof...(times) == count - 1);
    const int sure = rounded_blossom(times...).sign();
    return sure != 0 ? sure : blossom(exact(), times...).sign();
  }

  template <class Time>
  [[nodiscard]] int sign_at(const Time& t) const {
    return at_all(t, [this](const auto&... times) { return this->sign(times...); });
  }
  /// The value multiplied by a power of the sum of the weights, whose exponent is the degree.
  template <class Time>
  [[nodiscard]] RoundedBlossom rounded_value_at(const Time& t) const {
    return at_all(t, [this](const auto&... times) { return this->rounded_blossom(times...); });
  }
  template <class Time>
  [[nodiscard]] auto value_at(const Time& t) const {
    return at_all(t, [this](const auto&... times) { return blossom(this->exact(), times...); });
  }

 private:
  static constexpr int end_factor = degree == 1 ? 1 : degree;

  /// The b_i.
  [[nodiscard]] std::array<FixedInteger<limbs>, count> exact() const {
    std::array<FixedInteger<limbs>, count> b = form_;
    for (int i = 1; i < end_factor; ++i) {
      b.front() += form_.front();
      b.back() += form_.back();
    }
    return b;
  }

  /// function(t, …, t) with as many arguments as the degree.
  template <class Time, class Function>
  static auto at_all(const Time& t, const Function& function) {
    if constexpr (count == 2) {
      return function(t);
    } else if constexpr (count == 3) {
      return function(t, t);
    } else {
      return function(t, t, t);
    }
  }

  template <class... Times>
  [[nodiscard]] RoundedBlossom rounded_blossom(const Times&... times) const {
    std::array<double, count> b = rounded_, m;
    for (std::size_t i = 0; i < count; ++i) m[i] = std::abs(b[i]);
    std::size_t left = count;
    const auto step = [&](double x, double y) {
      --left;
      for (std::size_t i = 0; i < left; ++i) {
        b[i] = b[i] * x + b[i + 1] * y;
        m[i] = m[i] * x + m[i + 1] * y;
      }
    };
    (step(times.rounded_x, times.rounded_y), ...);
    return {b[0], m[0]};
  }

  std::array<FixedInteger<limbs>, count> form_;
  std::array<double, count> rounded_;
};

}  // namespace touchstone::fast::exact_stage
