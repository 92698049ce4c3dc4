/// \file
/// Exact numbers against rationals, over the whole range of doubles.

#include "verify/baselines/exact_number.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"

namespace touchstone::baselines::exact_number_test {
namespace {

using exact::Rational;

TEST(ExactNumber, HasTheSignsOfRationalsOverTheWholeRangeOfDoubles) {
  tests::Random random(3);
  for (int i = 0; i < tests::trials(2000); ++i) {
    std::array<double, 6> values{};
    for (double& x : values) {
      x = i % 2 == 0 ? random.finite_double() : random.few_bit_double(4, -2, 2);
    }
    const auto n = scaled_to_integers(values);
    std::array<Rational, 6> r;
    for (std::size_t k = 0; k < 6; ++k) r[k] = Rational(values[k]);
    EXPECT_EQ((n[0] * n[1] - n[2] * n[3]).sign(), sgn(Rational(r[0] * r[1] - r[2] * r[3])));
    EXPECT_EQ((n[4] + n[5] - n[0]).sign(), sgn(Rational(r[4] + r[5] - r[0])));
    EXPECT_EQ((-n[0]).sign(), -sgn(r[0]));
    EXPECT_EQ(same_sign(n[0], n[1]), sgn(r[0]) == sgn(r[1]));
    EXPECT_EQ(n[0] * n[1] == n[2] * n[3], Rational(r[0] * r[1]) == Rational(r[2] * r[3]));
  }
}

}  // namespace
}  // namespace touchstone::baselines::exact_number_test
