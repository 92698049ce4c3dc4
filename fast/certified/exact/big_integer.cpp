#include "fast/certified/exact/big_integer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {
namespace {

constexpr long limb_bits = 64;

constexpr std::uint64_t low(WideLimb x) { return static_cast<std::uint64_t>(x); }
constexpr std::uint64_t high(WideLimb x) { return static_cast<std::uint64_t>(x >> limb_bits); }

/// 1/x modulo 2^64, by Newton's iteration: x is correct in 3 bits, each step doubles their number.
/// \pre x is odd.
constexpr std::uint64_t inverse(std::uint64_t x) {
  std::uint64_t result = x;
  for (int right = 3; right < limb_bits; right *= 2) result *= 2 - x * result;
  return result;
}

/// Adds x y to the limbs. Returns true if there is a carry beyond them.
bool add_row(std::uint64_t* limb, std::size_t size, std::uint64_t x,
             std::span<const std::uint64_t> y) {
  std::uint64_t carry = 0;
  for (std::size_t j = 0; j < y.size(); ++j) {
    const WideLimb sum = WideLimb{x} * y[j] + limb[j] + carry;
    limb[j] = low(sum);
    carry = high(sum);
  }
  for (std::size_t j = y.size(); carry != 0 && j < size; ++j) {
    limb[j] += carry;
    carry = limb[j] < carry ? 1 : 0;
  }
  return carry != 0;
}

/// Subtracts x y from the limbs, modulo their range. Returns true if it was greater.
bool subtract_row(std::uint64_t* limb, std::size_t size, std::uint64_t x,
                  std::span<const std::uint64_t> y) {
  std::uint64_t borrow = 0;
  for (std::size_t j = 0; j < y.size(); ++j) {
    const WideLimb product = WideLimb{x} * y[j] + borrow;
    borrow = high(product) + (limb[j] < low(product) ? 1 : 0);
    limb[j] -= low(product);
  }
  for (std::size_t j = y.size(); borrow != 0 && j < size; ++j) {
    const std::uint64_t before = limb[j];
    limb[j] -= borrow;
    borrow = before < borrow ? 1 : 0;
  }
  return borrow != 0;
}

}  // namespace

double quotient(const Approximation& a, const Approximation& b) {
  if (b.significand == 0.0) return 0.0;
  const long exponent = std::clamp(a.exponent - b.exponent, -3000L, 3000L);
  const double value = std::ldexp(a.significand / b.significand, static_cast<int>(exponent));
  constexpr double largest = std::numeric_limits<double>::max();
  return std::clamp(value, -largest, largest);
}

BigInteger::BigInteger(std::int64_t value) : size_(value == 0 ? 0 : 1), negative_(value < 0) {
  const auto bits = static_cast<std::uint64_t>(value);
  few_[0] = negative_ ? 0 - bits : bits;
}

void BigInteger::resize(std::size_t size) {
  if (size > inline_limbs && size > many_.size()) {
    if (many_.empty()) many_.assign(few_.begin(), few_.end());
    many_.resize(size);
  }
  std::uint64_t* const limb = limbs();
  for (std::size_t i = size_; i < size; ++i) limb[i] = 0;
  size_ = size;
}

void BigInteger::trim() {
  const std::uint64_t* const limb = limbs();
  while (size_ > 0 && limb[size_ - 1] == 0) --size_;
  if (size_ == 0) negative_ = false;
}

long BigInteger::bit_length() const {
  if (size_ == 0) return 0;
  return static_cast<long>(size_) * limb_bits - std::countl_zero(limbs()[size_ - 1]);
}

long BigInteger::trailing_zeros() const {
  const std::uint64_t* const limb = limbs();
  std::size_t i = 0;
  while (limb[i] == 0) ++i;
  return static_cast<long>(i) * limb_bits + std::countr_zero(limb[i]);
}

Approximation BigInteger::approximation() const {
  if (size_ == 0) return {};
  const std::uint64_t* const limb = limbs();
  const int unused = std::countl_zero(limb[size_ - 1]);
  std::uint64_t top = limb[size_ - 1] << unused;
  if (size_ > 1 && unused > 0) top |= limb[size_ - 2] >> (limb_bits - unused);
  const double significand = std::ldexp(static_cast<double>(top), -64);
  return {negative_ ? -significand : significand, bit_length()};
}

SignedWideLimb BigInteger::truncated(long shift) const {
  if (size_ == 0 || bit_length() + shift <= 0) return 0;
  const std::uint64_t* const limb = limbs();
  // Three limbs, from the first that counts.
  const auto first = static_cast<std::size_t>(shift < 0 ? -shift / limb_bits : 0);
  const long beyond = shift < 0 ? -shift % limb_bits : 0;
  const auto at = [&](std::size_t i) { return first + i < size_ ? limb[first + i] : 0; };
  WideLimb magnitude = (WideLimb{at(1)} << limb_bits) | at(0);
  if (shift > 0) magnitude <<= shift;
  if (beyond > 0) {
    magnitude = (magnitude >> beyond) | (WideLimb{at(2)} << (2 * limb_bits - beyond));
  }
  const auto value = static_cast<SignedWideLimb>(magnitude);
  return negative_ ? -value : value;
}

std::uint64_t BigInteger::residue(std::uint64_t modulus) const {
  const std::uint64_t* const limb = limbs();
  WideLimb rest = 0;
  for (std::size_t i = size_; i-- > 0;) rest = ((rest << limb_bits) | limb[i]) % modulus;
  const std::uint64_t magnitude = low(rest);
  return negative_ && magnitude != 0 ? modulus - magnitude : magnitude;
}

// Divides from the lowest limb up: the lowest limb of the remainder, divided by the divisor's
// modulo 2^64, is the next limb of the quotient.
BigInteger BigInteger::divided_exactly(const BigInteger& divisor) const {
  if (size_ == 0) return {};
  const long zeros = divisor.trailing_zeros();
  BigInteger left = *this >> zeros;
  const BigInteger odd = divisor >> zeros;
  const std::uint64_t* const factor = odd.limbs();
  const std::uint64_t inverse_factor = inverse(factor[0]);
  BigInteger result;
  result.resize(left.size_ - odd.size_ + 1);
  std::uint64_t *const rest = left.limbs(), *const limb = result.limbs();
  for (std::size_t i = 0; i < result.size_; ++i) {
    limb[i] = rest[i] * inverse_factor;
    std::uint64_t carry = 0;
    for (std::size_t j = 0; i + j < left.size_ && (j < odd.size_ || carry != 0); ++j) {
      const WideLimb product = WideLimb{limb[i]} * (j < odd.size_ ? factor[j] : 0) + carry;
      carry = high(product) + (rest[i + j] < low(product) ? 1 : 0);
      rest[i + j] -= low(product);
    }
  }
  result.negative_ = negative_ != divisor.negative_;
  result.trim();
  return result;
}

int BigInteger::compare_magnitude(const BigInteger& other) const {
  if (size_ != other.size_) return size_ < other.size_ ? -1 : 1;
  const std::uint64_t *const a = limbs(), *const b = other.limbs();
  for (std::size_t i = size_; i-- > 0;) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

void BigInteger::add_magnitude(const BigInteger& other) {
  const std::size_t count = other.size_;
  resize(std::max(size_, count) + 1);
  std::uint64_t* const a = limbs();
  const std::uint64_t* const b = other.limbs();
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < count || carry != 0; ++i) {
    const WideLimb sum = WideLimb{a[i]} + (i < count ? b[i] : 0) + carry;
    a[i] = low(sum);
    carry = high(sum);
  }
  trim();
}

void BigInteger::set_difference(const BigInteger& larger, const BigInteger& smaller) {
  const std::size_t count = smaller.size_;
  resize(larger.size_);
  std::uint64_t* const result = limbs();
  const std::uint64_t *const a = larger.limbs(), *const b = smaller.limbs();
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    const WideLimb difference = WideLimb{a[i]} - (i < count ? b[i] : 0) - borrow;
    result[i] = low(difference);
    borrow = high(difference) != 0 ? 1 : 0;
  }
  trim();
}

BigInteger& BigInteger::add(const BigInteger& other, bool negative) {
  if (other.size_ == 0) return *this;
  if (size_ == 0) negative_ = negative;
  if (negative_ == negative) {
    add_magnitude(other);
    return *this;
  }
  if (compare_magnitude(other) >= 0) {
    set_difference(*this, other);
    return *this;
  }
  negative_ = negative;
  BigInteger larger = other;
  larger.negative_ = negative;
  larger.set_difference(larger, *this);
  return *this = larger;
}

// A product of the other sign is subtracted modulo 2^(64 size). If it is greater, the difference is
// 2^(64 size) minus the magnitude.
BigInteger& BigInteger::add_product(const BigInteger& a, const BigInteger& b, bool negative) {
  if (a.size_ == 0 || b.size_ == 0) return *this;
  if (size_ == 0) negative_ = negative;
  resize(size_ == 0 ? a.size_ + b.size_ : std::max(size_, a.size_ + b.size_) + 1);
  const bool is_sum = negative_ == negative;
  std::uint64_t* const result = limbs();
  const std::uint64_t *const x = a.limbs(), *const y = b.limbs();
  bool is_below_zero = false;
  for (std::size_t i = 0; i < a.size_; ++i) {
    // Sums of coordinates of very different size have many limbs that are 0.
    if (x[i] == 0) continue;
    is_below_zero |= is_sum ? add_row(result + i, size_ - i, x[i], {y, b.size_})
                            : subtract_row(result + i, size_ - i, x[i], {y, b.size_});
  }
  if (is_below_zero) {
    std::uint64_t carry = 1;
    for (std::size_t i = 0; i < size_; ++i) {
      const WideLimb sum = WideLimb{~result[i]} + carry;
      result[i] = low(sum);
      carry = high(sum);
    }
    negative_ = negative;
  }
  trim();
  return *this;
}

BigInteger& BigInteger::operator<<=(long bits) {
  if (size_ == 0 || bits == 0) return *this;
  const auto whole = static_cast<std::size_t>(bits / limb_bits);
  const long part = bits % limb_bits;
  const std::size_t old_size = size_;
  resize(size_ + whole + 1);
  std::uint64_t* const limb = limbs();
  for (std::size_t i = size_; i-- > 0;) {
    const std::uint64_t upper = i >= whole && i - whole < old_size ? limb[i - whole] : 0;
    const std::uint64_t lower = i > whole && i - whole - 1 < old_size ? limb[i - whole - 1] : 0;
    limb[i] = part == 0 ? upper : (upper << part) | (lower >> (limb_bits - part));
  }
  trim();
  return *this;
}

BigInteger& BigInteger::operator>>=(long bits) {
  if (size_ == 0 || bits == 0) return *this;
  const auto whole = std::min(static_cast<std::size_t>(bits / limb_bits), size_);
  const long part = bits % limb_bits;
  std::uint64_t* const limb = limbs();
  for (std::size_t i = 0; i + whole < size_; ++i) {
    const std::uint64_t lower = limb[i + whole];
    const std::uint64_t upper = i + whole + 1 < size_ ? limb[i + whole + 1] : 0;
    limb[i] = part == 0 ? lower : (lower >> part) | (upper << (limb_bits - part));
  }
  size_ -= whole;
  trim();
  return *this;
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
  BigInteger product;
  product.add_product(a, b);
  return product;
}

// Newton's iteration for the inverse x of d: x + x (1 − x d), which doubles the number of correct
// bits. Here d is b / 2^length, with a magnitude in [1/2, 1), and x is in units of 2^-known.
BigInteger approximate_quotient(const BigInteger& a, const BigInteger& b, long bits) {
  if (b.sign() == 0) return 0;
  const auto leading = [](const BigInteger& x, long count) {
    const long beyond = x.bit_length() - count;
    return beyond > 0 ? x >> beyond : x << -beyond;
  };
  constexpr long double_bits = 50, lost_bits = 6;
  const long needed = bits + 2 * lost_bits;
  long known = double_bits;
  BigInteger inverse(static_cast<std::int64_t>(0x1p50 / b.approximation().significand));
  while (known < needed) {
    const long next = std::min(2 * known - lost_bits, needed);
    inverse <<= next - known;
    const BigInteger error = (BigInteger(1) << 2 * next) - inverse * leading(b, next);
    inverse += (inverse * error) >> 2 * next;
    known = next;
  }
  const BigInteger product = leading(a, known) * inverse;
  const long beyond = 2 * known - bits + b.bit_length() - a.bit_length();
  return beyond > 0 ? product >> beyond : product << -beyond;
}

}  // namespace touchstone::fast::exact_stage
