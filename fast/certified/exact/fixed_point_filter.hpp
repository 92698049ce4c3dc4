#pragma once

/// \file
/// Forms on intervals in fixed point with an error bound, which suffices for most signs.
///
/// With Bernstein's coefficients b_k = c_k / binomial(n,k), a form is Σ b_k binomial(n,k)
/// (1−t)^(n−k) t^k. Its coefficients on an interval [s,e] are values of its polar form, with n − k
/// arguments s and k arguments e. They come by de Casteljau's steps, which replace all neighbours
/// a, b by (1−t) a + t b: first with t = e, which gives the coefficients on [0,e], and on these
/// with t = s/e.
///
/// **Bound.** Let the b_k be in units that make them less than 2^60, and t in units of 2^-60, both
/// without their fractions. Then every computed coefficient is within 2 + 6n units of the exact
/// one. Proof. The error of the b_k is less than 2: that of c_k before its division is less than 1,
/// as is that of the quotient. A step is a mean, so it does not increase the errors of a and b, and
/// its own is less than 1, from the dropped fraction; the steps are 2n deep. Without these errors
/// the result is a value of the polar form for other arguments: the computed e is less than 2^-60
/// below e; the computed quotient is less than 2^-60 below that of the computed s and e, so its
/// product with the computed e is less than 2·2^-60 below s. The polar form is linear in each
/// argument, and on [0,1] its values are means of the b_k; so each of the n arguments adds less
/// than 2·2^61·2^-60 = 4. ∎
///
/// **Reason.** floating_point_filter.hpp is limited to degree 3 and numbers of fixed size. Without
/// this filter `touchstone bench handcrafted --method certified --min-separation 1e-3 --norm l2`
/// takes 2.0 (vertex-face) and 1.8 times (edge-edge) as long (means of two runs of each program, 23
/// November 2026), although only one query in 500 reaches it.

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
  /// The binomials of greater degrees do not fit into 63 bits.
  static constexpr std::size_t largest_degree = 64;
  static constexpr int fraction_bits = 60;

  /// Σ c_k x^(n−k) y^k on the interval between two times, both in units of 2^-60, without their
  /// fractions. \pre the degree is at most largest_degree; 0 ≤ lower ≤ upper ≤ 2^60.
  FixedPointForm(std::span<const BigInteger> c, std::int64_t lower, std::int64_t upper);

  /// The sign pattern of the coefficients on the interval, if it is certain.
  [[nodiscard]] std::optional<IntervalSigns> signs() const;
  /// The sign at the interval's lower end if it is certain and not 0, else 0.
  [[nodiscard]] int first_sign() const { return sign(0); }
  /// Bernstein's coefficients on the interval.
  [[nodiscard]] std::span<const std::int64_t> coefficients() const { return {b_.data(), size_}; }

 private:
  [[nodiscard]] int sign(std::size_t k) const;

  std::array<std::int64_t, largest_degree + 1> b_;  // `size_` of them are used
  std::size_t size_;
};

}  // namespace touchstone::fast::exact_stage
