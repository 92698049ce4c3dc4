#pragma once

/// \file
/// Numbers of about 106 bits as unevaluated sums of two doubles, for any scalar with the operations
/// of double, lanes included.
///
/// **Errors.** Let u = 2^-53. All pairs are normalised: high is the double nearest to the sum,
/// hence
/// |low| ≤ u |high|. While nothing overflows or underflows, sums and products are wrong by less
/// than 8u² = 2^-103 of the truth, whatever the signs: an arithmetic of 103 digits in the sense of
/// touchstone/derivation/rounding_model.hpp. The algorithms are AccurateDWPlusDW and DWTimesDW1 of
/// [joldes2017] (bounds there: 3u²/(1−4u) and 7u²). The weaker bounds needed here have short
/// proofs.
///
/// *Products.* Scale so that 1 ≤ a.high, b.high < 2; the low parts are at most u. Left out is a.low
/// b.low, at most u². The two cross terms are each below 2u and rounded by at most u² each.
/// - If a.high b.high < 2, then a.high + b.high < 3. So the cross terms add up to at most 3u,
///   rounded by at most 2u², and with the error term, at most u, to at most 4u, rounded by at most
///   2u². The sum is 7u², for a product that is at least (1 − u)².
/// - Otherwise they add up to at most 4u, rounded by 2u², and with the error term, at most 2u, to
///   at most 6u, rounded by 4u². The sum is 9u², for a product that is at least 2 (1 − u)².
///
/// *Sums.* Let |a.high| ≥ |b.high|, scaled so that 1 ≤ a.high < 2, and exactly s + s' = a.high +
/// b.high, t + t' = a.low + b.low. Two operations round: c = s' + t, and w = t' + v', where v + v'
/// = s + c exactly.
/// - If −a.high ≤ b.high ≤ −a.high/2, then s is exact, s' = 0 and c = t: only w is rounded, by at
///   most u |t' + v'|, and not at all if v' = 0. Otherwise |s + t| is more than 2^53 last places of
///   t: s is a multiple of them, as it is of the last place of b.high, of which t has at most 1½.
///   So
///   |t'|, at most half a last place of t, is below u |v|, and |v'| ≤ u |v|. The error is at most
///   2u² |v|, for a sum that is at least (1 − 2u) |v|.
/// - Otherwise σ ≤ s < 2σ for a σ of ½, 1 or 2. Then |s'| ≤ uσ, and |t| is at most 2u (3u/2 if σ =
///   ½, as then |b.high| < 1): |s' + t| is at most 2u, 3u and 4u for σ = ½, 1 and 2, so that c is
///   rounded by at most 2u²σ. |v'| ≤ u |v| and |t'| ≤ u², so that w is rounded by at most u² |v| +
///   u³. The sum is 3u² and terms of order u³, for a sum that is at least σ (1 − 5u) and close to
///   |v|.
///
/// **Underflow.** Sums of doubles, and hence of pairs, are not affected: results below the least
/// normal number are multiples of 2^-1074, and exact. In a product P = a.high b.high, let η =
/// 2^-1075. Each cross term has an additional error of at most η, and the error term one of ε. With
/// a fused operation, or if |P| ≥ 2^-995, ε is at most η; computed by halves it is 3η above 2^-1022
/// and 4η below, as successively more of the four products of halves have bits below 2^-1074.
/// (Their sum stays exact. It is one of multiples of 2^-1074 below 2^-1021, or as exact as it is
/// without underflow.)
/// - For |P| < 2^-971 the two sums of cross terms and error term are below 2^-1021, hence exact:
///   the additional error of the product is at most 6η.
/// - Otherwise ε ≤ η. The underflow errors can carry a sum beyond the power of two that bounded its
///   rounding, which adds no more than these errors: 2η in the first sum, 3η in the second. The
///   additional error is at most 8η.
///
/// The derivation counts 2^-1071 = 16η, half the least positive number of double_double_format.

#include "touchstone/filters/strict_arithmetic.hpp"

namespace touchstone::filters {

/// high + low; high is the double nearest to the sum.
template <class Scalar>
struct DoubleDouble {
  Scalar high;
  Scalar low;
};

/// a + b exactly. \pre |a| ≥ |b|, or a is a multiple (0 is one) of the last place of b.
/// [dekker1971]
template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> sum_of_ordered(const Scalar& a, const Scalar& b) {
  const Scalar sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly. [knuth1997]
template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> exact_sum(const Scalar& a, const Scalar& b) {
  const Scalar sum = a + b;
  const Scalar b_part = sum - a;
  const Scalar a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// a − b exactly.
template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> exact_difference(const Scalar& a, const Scalar& b) {
  const Scalar difference = a - b;
  const Scalar b_part = a - difference;
  const Scalar a_part = difference + b_part;
  return {difference, (a - a_part) - (b - b_part)};
}

/// a · b − product for product = fl(a · b), exactly: without a fused operation, by halves of 26
/// bits (Veltkamp; [dekker1971]). \pre |a|, |b| ≤ 2^990. Lanes with a fused operation overload it.
template <class Scalar>
[[nodiscard]] constexpr Scalar product_error(const Scalar& a, const Scalar& b,
                                             const Scalar& product) {
  const Scalar splitter(0x1p27 + 1);
  const Scalar a_scaled = splitter * a, b_scaled = splitter * b;
  const Scalar a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
  const Scalar a_low = a - a_high, b_low = b - b_high;
  return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> operator+(const DoubleDouble<Scalar>& a,
                                                       const DoubleDouble<Scalar>& b) {
  const DoubleDouble<Scalar> high = exact_sum(a.high, b.high);
  const DoubleDouble<Scalar> low = exact_sum(a.low, b.low);
  const DoubleDouble<Scalar> carried = sum_of_ordered<Scalar>(high.high, high.low + low.high);
  return sum_of_ordered<Scalar>(carried.high, low.low + carried.low);
}

template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> operator-(const DoubleDouble<Scalar>& a,
                                                       const DoubleDouble<Scalar>& b) {
  const DoubleDouble<Scalar> high = exact_difference(a.high, b.high);
  const DoubleDouble<Scalar> low = exact_difference(a.low, b.low);
  const DoubleDouble<Scalar> carried = sum_of_ordered<Scalar>(high.high, high.low + low.high);
  return sum_of_ordered<Scalar>(carried.high, low.low + carried.low);
}

template <class Scalar>
[[nodiscard]] constexpr DoubleDouble<Scalar> operator*(const DoubleDouble<Scalar>& a,
                                                       const DoubleDouble<Scalar>& b) {
  const Scalar product = a.high * b.high;
  const Scalar error = product_error(a.high, b.high, product);
  const Scalar cross_terms = a.high * b.low + a.low * b.high;
  return sum_of_ordered<Scalar>(product, error + cross_terms);
}

}  // namespace touchstone::filters
