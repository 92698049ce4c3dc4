#pragma once

/// \file
/// Random numbers for tests: the same on every machine, for a seed that stands in the test.
///
/// The generator is splitmix64 [steele2014]: a counter that advances by an odd
/// constant, each value scrambled by xor-shifts and multiplications. The distributions of the
/// standard library are not used because their results differ between implementations.

#include <bit>
#include <cmath>
#include <cstdint>

namespace touchstone::tests {

/// A deterministic source of random numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// 64 random bits.
  [[nodiscard]] std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }

  /// One of least, …, greatest. \pre least ≤ greatest, and their difference is below 2^31.
  [[nodiscard]] int between(int least, int greatest) {
    const auto count = static_cast<std::uint64_t>(std::int64_t{greatest} - least + 1);
    const std::uint64_t offset = ((bits() >> 32U) * count) >> 32U;
    return static_cast<int>(least + static_cast<std::int64_t>(offset));
  }

  [[nodiscard]] bool coin() { return (bits() >> 63U) != 0; }

  /// A number n with |n| < 2^`bit_count`, uniform in its magnitude, of either sign. `Integer` is
  /// any integer type that holds it: std::int64_t for up to 63 bits, mpz_class for any number.
  template <class Integer>
  [[nodiscard]] Integer integer(unsigned bit_count) {
    static constexpr unsigned chunk = 15;
    Integer magnitude = 0;
    for (unsigned done = 0; done < bit_count; done += chunk) {
      const unsigned width = bit_count - done < chunk ? bit_count - done : chunk;
      magnitude =
          magnitude * Integer(1 << width) + Integer(static_cast<int>(bits() >> (64 - width)));
    }
    return coin() ? magnitude : Integer(-magnitude);
  }

  /// A multiple of 2^-53 times the width, in [lower, upper).
  [[nodiscard]] double uniform(double lower = 0.0, double upper = 1.0) {
    return lower + (upper - lower) * std::ldexp(static_cast<double>(bits() >> 11U), -53);
  }

  /// A finite double of random bit pattern: every exponent alike, subnormals and both zeros too.
  [[nodiscard]] double finite_double() {
    for (;;) {
      const auto x = std::bit_cast<double>(bits());
      if (std::isfinite(x)) return x;
    }
  }

  /// n · 2^k with |n| < 2^`bit_count` and least_exponent ≤ k ≤ greatest_exponent: sums and products
  /// of such numbers are often exact, and often equal. \pre bit_count ≤ 53.
  [[nodiscard]] double few_bit_double(unsigned bit_count, int least_exponent,
                                      int greatest_exponent) {
    const auto significand = static_cast<double>(integer<std::int64_t>(bit_count));
    return std::ldexp(significand, between(least_exponent, greatest_exponent));
  }

 private:
  std::uint64_t state_;
};

}  // namespace touchstone::tests
