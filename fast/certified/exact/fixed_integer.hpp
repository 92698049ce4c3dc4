#pragma once

/// \file
/// Integers of a fixed number of bits, for decisions with numbers of bounded size.
///
/// Two's complement in limbs of 64 bits, the least significant first. A product is as long as its
/// factors together, so it cannot overflow. Sums can overflow, and the caller must ensure that they
/// do not (contact_conditions.hpp bounds each polynomial's coefficients).

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast::exact_stage {

// Only a typedef permits the extension without a warning.
// NOLINTNEXTLINE(modernize-use-using)
__extension__ typedef unsigned __int128 WideLimb;
// NOLINTNEXTLINE(modernize-use-using)
__extension__ typedef __int128 SignedWideLimb;

/// An integer of `size` limbs, uninitialised by default.
template <std::size_t size>
class FixedInteger {
 public:
  static constexpr std::size_t limbs = size;

  constexpr FixedInteger() = default;
  constexpr explicit FixedInteger(std::int64_t value) {
    limb_.fill(value < 0 ? ~std::uint64_t{0} : 0);
    limb_[0] = static_cast<std::uint64_t>(value);
  }
  constexpr explicit FixedInteger(SignedWideLimb value) {
    static_assert(size >= 2);
    limb_.fill(value < 0 ? ~std::uint64_t{0} : 0);
    limb_[0] = static_cast<std::uint64_t>(value);
    limb_[1] = static_cast<std::uint64_t>(value >> 64U);
  }

  /// −1, 0 or 1.
  [[nodiscard]] int sign() const {
    std::uint64_t any = 0;
    for (const std::uint64_t x : limb_) any |= x;
    if (any == 0) return 0;
    return is_negative() ? -1 : 1;
  }

  FixedInteger& operator+=(const FixedInteger& other) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const WideLimb sum = WideLimb{limb_[i]} + other.limb_[i] + carry;
      limb_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64U);
    }
    return *this;
  }
  FixedInteger& operator-=(const FixedInteger& other) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const WideLimb difference = WideLimb{limb_[i]} - other.limb_[i] - borrow;
      limb_[i] = static_cast<std::uint64_t>(difference);
      borrow = static_cast<std::uint64_t>(difference >> 64U) & 1U;
    }
    return *this;
  }
  friend FixedInteger operator+(FixedInteger a, const FixedInteger& b) { return a += b; }
  friend FixedInteger operator-(FixedInteger a, const FixedInteger& b) { return a -= b; }
  friend FixedInteger operator-(const FixedInteger& a) { return FixedInteger() -= a; }
  friend bool operator==(const FixedInteger&, const FixedInteger&) = default;

  template <std::size_t other_size>
  friend FixedInteger<size + other_size> operator*(const FixedInteger& a,
                                                   const FixedInteger<other_size>& b) {
    return a.times(b);
  }

  /// a x + b y, with weights of one limb or two. \pre 0 ≤ x, y; and x + y is below half of what its
  /// unsigned type holds.
  friend FixedInteger<size + 1> blend(const FixedInteger& a, std::int64_t x, const FixedInteger& b,
                                      std::int64_t y) {
    return a.times_unsigned(static_cast<std::uint64_t>(x)) +=
           b.times_unsigned(static_cast<std::uint64_t>(y));
  }

  friend FixedInteger<size + 2> blend(const FixedInteger& a, SignedWideLimb x,
                                      const FixedInteger& b, SignedWideLimb y) {
    return a * FixedInteger<2>(x) + b * FixedInteger<2>(y);
  }

  /// An approximation with a relative error below 2^-50, in any rounding mode. \pre below 2^1023.
  [[nodiscard]] double rounded() const {
    FixedInteger magnitude;
    std::uint64_t carry = sign_mask() & 1U;
    for (std::size_t i = 0; i < size; ++i) {
      const WideLimb sum = WideLimb{limb_[i] ^ sign_mask()} + carry;
      magnitude.limb_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64U);
    }
    std::size_t top = size - 1;
    while (top > 0 && magnitude.limb_[top] == 0) --top;
    auto value = static_cast<double>(magnitude.limb_[top]);
    if (top > 0) value = value * 0x1p64 + static_cast<double>(magnitude.limb_[top - 1]);
    // Lower limbs are less than 2^-64 of it.
    for (std::size_t i = 1; i < top; ++i) value *= 0x1p64;
    return std::copysign(value, static_cast<double>(static_cast<std::int64_t>(limb_[size - 1])));
  }

 private:
  template <std::size_t>
  friend class FixedInteger;

  [[nodiscard]] bool is_negative() const { return (limb_[size - 1] >> 63U) != 0; }
  /// All bits set for a negative number, else none. It replaces a branch: signs are unpredictable.
  [[nodiscard]] std::uint64_t sign_mask() const {
    return std::uint64_t{0} - (limb_[size - 1] >> 63U);
  }

  [[nodiscard]] FixedInteger<size + 1> times_unsigned(std::uint64_t factor) const {
    FixedInteger<size + 1> product;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const WideLimb sum = WideLimb{limb_[i]} * factor + carry;
      product.limb_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64U);
    }
    product.limb_[size] = carry - (sign_mask() & factor);
    return product;
  }

  /// A limb times the factor and a carry of 64 bits fit into two limbs with a sign.
  [[nodiscard]] FixedInteger<size + 1> times_signed(std::int64_t factor) const {
    FixedInteger<size + 1> product;
    SignedWideLimb carry = 0;
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const SignedWideLimb sum = SignedWideLimb{factor} * limb_[i] + carry;
      product.limb_[i] = static_cast<std::uint64_t>(sum);
      carry = sum >> 64U;
    }
    const auto top = static_cast<std::int64_t>(limb_[size - 1]);
    const SignedWideLimb sum = SignedWideLimb{factor} * top + carry;
    product.limb_[size - 1] = static_cast<std::uint64_t>(sum);
    product.limb_[size] = static_cast<std::uint64_t>(sum >> 64U);
    return product;
  }

  template <std::size_t other_size>
  [[nodiscard]] FixedInteger<size + other_size> times(const FixedInteger<other_size>& b) const {
    if constexpr (other_size == 1) return times_signed(static_cast<std::int64_t>(b.limb_[0]));
    if constexpr (size == 1) return b.times_signed(static_cast<std::int64_t>(limb_[0]));
    if constexpr (size == 2 && other_size == 2) return times_of_two(b);
    FixedInteger<size + other_size> product{};
    for (std::size_t i = 0; i < size; ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < other_size; ++j) {
        const WideLimb sum = WideLimb{limb_[i]} * b.limb_[j] + product.limb_[i + j] + carry;
        product.limb_[i + j] = static_cast<std::uint64_t>(sum);
        carry = static_cast<std::uint64_t>(sum >> 64U);
      }
      product.limb_[i + other_size] = carry;
    }
    // A negative factor was read with 2^(64 limbs) added.
    product.subtract_above(size, b, sign_mask());
    product.subtract_above(other_size, *this, b.sign_mask());
    return product;
  }

  /// The product of two limbs each: the upper limb is signed, and a product with it fits into two.
  [[nodiscard]] FixedInteger<4> times_of_two(const FixedInteger<2>& b) const {
    const auto upper = static_cast<std::int64_t>(limb_[1]);
    const auto b_upper = static_cast<std::int64_t>(b.limb_[1]);
    const WideLimb low = WideLimb{limb_[0]} * b.limb_[0];
    const SignedWideLimb first =
        SignedWideLimb{upper} * b.limb_[0] + static_cast<std::uint64_t>(low >> 64U);
    const SignedWideLimb second =
        SignedWideLimb{b_upper} * limb_[0] + static_cast<std::uint64_t>(first);
    const SignedWideLimb high = SignedWideLimb{upper} * b_upper + (first >> 64U) + (second >> 64U);
    FixedInteger<4> product;
    product.limb_ = {static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(second),
                     static_cast<std::uint64_t>(high), static_cast<std::uint64_t>(high >> 64U)};
    return product;
  }

  /// Subtracts 2^(64 places) times a correspondingly shorter number, masked by the mask.
  template <std::size_t other_size>
  void subtract_above(std::size_t places, const FixedInteger<other_size>& other,
                      std::uint64_t mask) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < other_size; ++i) {
      std::uint64_t& limb = limb_[places + i];
      const WideLimb difference = WideLimb{limb} - (other.limb_[i] & mask) - borrow;
      limb = static_cast<std::uint64_t>(difference);
      borrow = static_cast<std::uint64_t>(difference >> 64U) & 1U;
    }
  }

  std::array<std::uint64_t, size> limb_;
};

}  // namespace touchstone::fast::exact_stage
