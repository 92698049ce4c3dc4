#pragma once

/// \file
/// Random numbers for tests: the same on every machine, from a seed in the test.
///
/// The generator is that of the product (splitmix64). The distributions of the standard library are
/// not used because their results differ between implementations.

#include <bit>
#include <cmath>
#include <cstdint>

#include "verify/generate/random_stream.hpp"

namespace touchstone::tests {

/// The product's generator, with the draws of tests.
class Random : public verify::generate::Random {
 public:
  using verify::generate::Random::Random;

  /// One of least, …, greatest. \pre least ≤ greatest, and their difference is below 2^31.
  [[nodiscard]] int between(int least, int greatest) {
    const auto count = static_cast<std::uint64_t>(std::int64_t{greatest} - least + 1);
    const std::uint64_t offset = ((bits() >> 32U) * count) >> 32U;
    return static_cast<int>(least + static_cast<std::int64_t>(offset));
  }

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

  /// A finite double with a random bit pattern: all exponents are equally likely, including
  /// subnormals and both zeros.
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
};

}  // namespace touchstone::tests
