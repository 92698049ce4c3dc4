#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast/certified/exact/big_integer.hpp"
#include "tests/support/properties.hpp"

// The integers of the certified solver by their laws; big_integer_test.cpp compares them with GMP's.

namespace touchstone::fast::exact_stage::big_integer_properties_test {
namespace {

using tests::expect_property;
using Digits = std::vector<std::int64_t>;

/// The digits to the base 2^61, up to 15 of them: beyond what fits into the object.
BigInteger integer(const Digits& digits) {
  BigInteger result;
  for (std::size_t i = 0; i < digits.size() && i < 15; ++i) {
    result = (result << 61) + BigInteger(digits[i]);
  }
  return result;
}

TEST(BigIntegerProperties, FormARing) {
  expect_property(1, 1000, [](const Digits& x, const Digits& y, const Digits& z) {
    const BigInteger a = integer(x), b = integer(y), c = integer(z);
    RC_ASSERT(a + b == b + a);
    RC_ASSERT((a + b) + c == a + (b + c));
    RC_ASSERT((a - b) + b == a);
    RC_ASSERT((a + (-a)).sign() == 0);
    RC_ASSERT(a * b == b * a);
    RC_ASSERT((a * b) * c == a * (b * c));
    RC_ASSERT(a * (b + c) == a * b + a * c);
    RC_ASSERT(a * BigInteger(1) == a);
  });
}

TEST(BigIntegerProperties, SignsAreMultiplicative) {
  expect_property(2, 1000, [](const Digits& x, const Digits& y) {
    const BigInteger a = integer(x), b = integer(y);
    RC_ASSERT((a * b).sign() == a.sign() * b.sign());
    RC_ASSERT((-a).sign() == -a.sign());
    RC_ASSERT((a - b).sign() == -(b - a).sign());
    RC_ASSERT((a == b) == ((a - b).sign() == 0));
  });
}

TEST(BigIntegerProperties, ShiftsAreProductsWithPowersOfTwo) {
  expect_property(3, 1000, [](const Digits& x, std::uint8_t bits, std::uint8_t more) {
    const BigInteger a = integer(x), power = BigInteger(1) << bits;
    RC_ASSERT((a << bits) == a * power);
    RC_ASSERT(((a << bits) << more) == (a << (bits + more)));
    RC_ASSERT(((a << bits) >> bits) == a);
    if (a.sign() != 0) {
      RC_ASSERT((a << bits).bit_length() == a.bit_length() + bits);
      RC_ASSERT((a << bits).trailing_zeros() == a.trailing_zeros() + bits);
    }
  });
}

TEST(BigIntegerProperties, ProductsDivideAndLeaveTheProductsResidue) {
  expect_property(4, 1000, [](const Digits& x, const Digits& y, std::uint32_t modulus) {
    const BigInteger a = integer(x), b = integer(y);
    RC_PRE(b.sign() != 0 && modulus != 0);
    RC_ASSERT((a * b).divided_exactly(b) == a);
    const std::uint64_t product = a.residue(modulus) * b.residue(modulus) % modulus;
    RC_ASSERT((a * b).residue(modulus) == product);
    RC_ASSERT((a + b).residue(modulus) == (a.residue(modulus) + b.residue(modulus)) % modulus);
  });
}

/// A quotient of approximations, each within 2^-52, is near the exact quotient.
TEST(BigIntegerProperties, ApproximationsDivide) {
  expect_property(5, 1000, [](const Digits& x, std::int32_t factor) {
    const BigInteger a = integer(x);
    RC_PRE(a.sign() != 0);
    const BigInteger multiple = a * BigInteger(factor);
    const double found = quotient(multiple.approximation(), a.approximation());
    RC_ASSERT(std::abs(found - factor) <= std::abs(static_cast<double>(factor)) * 0x1p-49);
  });
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::big_integer_properties_test
