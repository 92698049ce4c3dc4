#pragma once

/// \file
/// Integers of any size, with the operations of exact decisions: no division has a remainder.
///
/// A number is its sign and its magnitude in limbs of 64 bits, the least significant first. Up to
/// `inline_limbs` of them are in the object, so that common numbers need no allocation.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::exact_stage {

/// significand · 2^exponent, an approximation with a relative error below 2^-52. The significand is
/// 0 or has a magnitude in [1/2, 1]. For guesses, not for proofs.
struct Approximation {
  double significand = 0.0;
  long exponent = 0;
};

/// a / b; 0 if b is 0. The greatest double if the quotient exceeds it.
[[nodiscard]] double quotient(const Approximation& a, const Approximation& b);

/// An integer of any size.
class BigInteger {
 public:
  static constexpr std::size_t inline_limbs = 10;

  BigInteger() = default;
  BigInteger(std::int64_t value);  // NOLINT(google-explicit-constructor): numbers of one kind

  /// −1, 0 or 1.
  [[nodiscard]] int sign() const {
    if (size_ == 0) return 0;
    return negative_ ? -1 : 1;
  }
  /// The length of the magnitude: 0 for 0, else 1 + the index of the highest bit.
  [[nodiscard]] long bit_length() const;
  /// The index of the lowest bit that is set. \pre not 0.
  [[nodiscard]] long trailing_zeros() const;
  [[nodiscard]] Approximation approximation() const;
  /// The number · 2^shift without its fraction. \pre the magnitude of that is below 2^127.
  [[nodiscard]] SignedWideLimb truncated(long shift) const;
  /// The remainder in [0, modulus). \pre the modulus is not 0.
  [[nodiscard]] std::uint64_t residue(std::uint64_t modulus) const;
  /// The quotient by a divisor. \pre the divisor is not 0 and divides this number.
  [[nodiscard]] BigInteger divided_exactly(const BigInteger& divisor) const;

  BigInteger& operator+=(const BigInteger& other) { return add(other, other.negative_); }
  BigInteger& operator-=(const BigInteger& other) { return add(other, !other.negative_); }
  /// Adds a b, without a number for the product. \pre neither is this number.
  BigInteger& add_product(const BigInteger& a, const BigInteger& b) {
    return add_product(a, b, a.negative_ != b.negative_);
  }
  BigInteger& subtract_product(const BigInteger& a, const BigInteger& b) {
    return add_product(a, b, a.negative_ == b.negative_);
  }
  /// Multiplies by 2^bits. \pre bits ≥ 0.
  BigInteger& operator<<=(long bits);
  /// Divides by 2^bits and drops the fraction. \pre bits ≥ 0.
  BigInteger& operator>>=(long bits);

  friend BigInteger operator+(BigInteger a, const BigInteger& b) { return a += b; }
  friend BigInteger operator-(BigInteger a, const BigInteger& b) { return a -= b; }
  friend BigInteger operator-(BigInteger a) {
    a.negative_ = !a.negative_ && a.size_ != 0;
    return a;
  }
  friend BigInteger operator<<(BigInteger a, long bits) { return a <<= bits; }
  friend BigInteger operator>>(BigInteger a, long bits) { return a >>= bits; }
  friend BigInteger operator*(const BigInteger& a, const BigInteger& b);
  friend bool operator==(const BigInteger& a, const BigInteger& b) { return (a - b).sign() == 0; }

 private:
  [[nodiscard]] std::uint64_t* limbs() { return many_.empty() ? few_.data() : many_.data(); }
  [[nodiscard]] const std::uint64_t* limbs() const {
    return many_.empty() ? few_.data() : many_.data();
  }
  /// Makes the magnitude `size` limbs long; new ones are 0.
  void resize(std::size_t size);
  /// Removes leading zeros.
  void trim();
  [[nodiscard]] int compare_magnitude(const BigInteger& other) const;
  BigInteger& add(const BigInteger& other, bool negative);
  /// Adds |a b| with this sign.
  BigInteger& add_product(const BigInteger& a, const BigInteger& b, bool negative);
  void add_magnitude(const BigInteger& other);
  /// |this| ← larger − smaller, one of which is |this|.
  void set_difference(const BigInteger& larger, const BigInteger& smaller);

  std::array<std::uint64_t, inline_limbs> few_{};
  std::vector<std::uint64_t> many_;  // used once the number did not fit into few_
  std::size_t size_ = 0;             // limbs of the magnitude; the top one is not 0
  bool negative_ = false;
};

/// An approximation of 2^bits a/b, with an error below 2 if |a| ≤ |b|. 0 if b is 0. \pre bits ≥ 0.
[[nodiscard]] BigInteger approximate_quotient(const BigInteger& a, const BigInteger& b, long bits);

}  // namespace touchstone::fast::exact_stage
