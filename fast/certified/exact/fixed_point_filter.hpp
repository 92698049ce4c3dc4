#pragma once

/// \file
/// Forms on intervals in fixed point, with a bound of what is lost: most signs need no more.
///
/// With Bernstein's coefficients b_k = c_k / binomial(n,k), a form is Σ b_k binomial(n,k)
/// (1−t)^(n−k) t^k. Its coefficients on an interval [s,e] come from them by de Casteljau's steps, which
/// replace all neighbours a, b by (1−t) a + t b: the one of index k takes n − k steps with t = s and k
/// with t = e.
///
/// **Bound.** Let the c_k be in units that make the greatest one below 2^60, and t in units of 2^-60,
/// both without their fractions. Then every coefficient found is within 2 + 3n units of the true one.
/// Proof. The c_k are wrong by less than 1, their quotients by less than 1 more. A step is a mean, so
/// it adds nothing to the errors of a and b. It is itself wrong by less than 1, because its fraction
/// is dropped, and by less than 2 because t is wrong by at most 2^-60 and |a − b| < 2^61. ∎
///
/// Why beside floating_point_filter.hpp, which has degrees up to 3 and numbers of fixed size: without this one
/// `touchstone bench handcrafted --method certified --min-separation 1e-3 --norm l2` takes 2.0
/// (vertex-face) and 1.8 times (edge-edge) as long (means of two runs a program, 23 November 2026),
/// although one query in 500 gets here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/contact_conditions.hpp"

namespace touchstone::fast::exact_stage {

/// A form on an interval, in fixed point.
class FixedPointForm {
 public:
  static constexpr std::size_t largest_degree = 8;
  static constexpr int fraction_bits = 60;

  /// Σ c_k x^(n−k) y^k on the interval between two times, both in units of 2^-60, without their
  /// fractions. \pre the degree is at most largest_degree; 0 ≤ lower, upper ≤ 2^60.
  FixedPointForm(std::span<const BigInteger> c, std::int64_t lower, std::int64_t upper);

  /// What the signs of the coefficients on the interval tell, if that is sure.
  [[nodiscard]] std::optional<IntervalSigns> signs() const;
  /// The sign at the interval's lower end, if it is sure and not 0, else 0.
  [[nodiscard]] int first_sign() const { return sign(0); }
  /// Bernstein's coefficients on the interval.
  [[nodiscard]] std::span<const std::int64_t> coefficients() const { return {b_.data(), size_}; }

 private:
  [[nodiscard]] int sign(std::size_t k) const;

  std::array<std::int64_t, largest_degree + 1> b_{};
  std::size_t size_;
};

}  // namespace touchstone::fast::exact_stage
