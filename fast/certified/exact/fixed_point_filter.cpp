#include "fast/certified/exact/fixed_point_filter.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {
namespace {

constexpr std::int64_t one = std::int64_t{1} << FixedPointForm::fraction_bits;

/// (1−t) a + t b, without its fraction.
std::int64_t mean(std::int64_t a, std::int64_t b, std::int64_t t) {
  const SignedWideLimb sum = SignedWideLimb{a} * (one - t) + SignedWideLimb{b} * t;
  return static_cast<std::int64_t>(sum >> FixedPointForm::fraction_bits);
}

/// The coefficients from 0 to t.
void cut_after(std::span<std::int64_t> b, std::int64_t t) {
  for (std::size_t first = 1; first < b.size(); ++first) {
    for (std::size_t k = b.size() - 1; k >= first; --k) b[k] = mean(b[k - 1], b[k], t);
  }
}

/// The coefficients from t to 1.
void cut_before(std::span<std::int64_t> b, std::int64_t t) {
  for (std::size_t end = b.size(); end-- > 1;) {
    for (std::size_t k = 0; k < end; ++k) b[k] = mean(b[k], b[k + 1], t);
  }
}

/// Calls visit(k, binomial of n over k).
template <class Visit>
void visit_binomials(std::size_t size, const Visit& visit) {
  std::uint64_t binomial = 1;
  for (std::size_t k = 0; k < size; ++k) {
    visit(k, binomial);
    binomial = static_cast<std::uint64_t>(WideLimb{binomial} * (size - 1 - k) / (k + 1));
  }
}

}  // namespace

FixedPointForm::FixedPointForm(std::span<const BigInteger> c, std::int64_t lower,
                               std::int64_t upper)
    : size_(c.size()) {
  long top = std::numeric_limits<long>::min();  // all b_k are below 2^top
  visit_binomials(size_, [&](std::size_t k, std::uint64_t binomial) {
    if (c[k].sign() != 0) {
      top = std::max(top, c[k].bit_length() - static_cast<long>(std::bit_width(binomial)) + 1);
    }
  });
  visit_binomials(size_, [&](std::size_t k, std::uint64_t binomial) {
    if (c[k].sign() == 0) {
      b_[k] = 0;
      return;
    }
    const SignedWideLimb x = c[k].truncated(fraction_bits - top);
    b_[k] = static_cast<std::int64_t>(binomial == 1 ? x : x / static_cast<std::int64_t>(binomial));
  });
  const std::span<std::int64_t> b(b_.data(), size_);
  if (upper != one) cut_after(b, upper);
  if (lower == upper) {
    std::ranges::fill(b, b.back());
  } else if (lower != 0) {
    cut_before(b, static_cast<std::int64_t>((SignedWideLimb{lower} << fraction_bits) / upper));
  }
}

int FixedPointForm::sign(std::size_t k) const {
  const auto error = static_cast<std::int64_t>(2 + 6 * (size_ - 1));
  if (b_[k] > error) return 1;
  return b_[k] < -error ? -1 : 0;
}

// A coefficient of uncertain sign is harmless only alone between two of opposite signs, which then
// change once in any case. Several, or one between equal signs or at an end, leave the number of
// changes open.
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
