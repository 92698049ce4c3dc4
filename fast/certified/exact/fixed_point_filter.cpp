#include "fast/certified/exact/fixed_point_filter.hpp"

#include <algorithm>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {
namespace {

constexpr std::int64_t one = std::int64_t{1} << FixedPointForm::fraction_bits;

using Coefficients = std::array<std::int64_t, FixedPointForm::largest_degree + 1>;

/// One de Casteljau step on the first `size` coefficients, which reduces their number by one.
void step(Coefficients& b, std::size_t size, std::int64_t t) {
  for (std::size_t k = 0; k + 1 < size; ++k) {
    const SignedWideLimb sum = SignedWideLimb{b[k]} * (one - t) + SignedWideLimb{b[k + 1]} * t;
    b[k] = static_cast<std::int64_t>(sum >> FixedPointForm::fraction_bits);
  }
}

}  // namespace

FixedPointForm::FixedPointForm(std::span<const BigInteger> c, std::int64_t lower,
                               std::int64_t upper)
    : size_(c.size()) {
  long top = 0;
  for (const BigInteger& x : c) top = std::max(top, x.bit_length());
  Coefficients from_lower{};
  std::int64_t binomial = 1;
  for (std::size_t k = 0; k < size_; ++k) {
    from_lower[k] = c[k].truncated(fraction_bits - top) / binomial;
    binomial =
        binomial * static_cast<std::int64_t>(size_ - 1 - k) / static_cast<std::int64_t>(k + 1);
  }
  for (std::size_t k = size_; k-- > 0;) {
    Coefficients b = from_lower;
    for (std::size_t left = k + 1; left > 1; --left) step(b, left, upper);
    b_[k] = b[0];
    step(from_lower, k + 1, lower);
  }
}

int FixedPointForm::sign(std::size_t k) const {
  const auto error = static_cast<std::int64_t>(2 + 3 * (size_ - 1));
  if (b_[k] > error) return 1;
  return b_[k] < -error ? -1 : 0;
}

// Coefficients of uncertain sign are harmless only singly between two of opposite signs: with one
// of them there is one change in any case. Several of them, or one between equal signs or at an
// end, leave the number of changes open.
std::optional<IntervalSigns> FixedPointForm::signs() const {
  IntervalSigns result;
  int doubts = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const int here = sign(k);
    if (here == 0) {
      ++doubts;
      continue;
    }
    if (doubts > 1 || (doubts == 1 && here != -result.last)) return std::nullopt;
    if (result.first == 0) result.first = here;
    if (here == -result.last) ++result.changes;
    result.last = here;
    doubts = 0;
  }
  if (doubts > 0) return std::nullopt;
  return result;
}

}  // namespace touchstone::fast::exact_stage
