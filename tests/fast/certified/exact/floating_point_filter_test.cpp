#include "fast/certified/exact/floating_point_filter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/number.hpp"

namespace touchstone::fast::exact_stage::floating_point_filter_test {
namespace {

using exact::Integer;
using exact::Rational;
using tests::Random;

using Time = BasicTime<std::int64_t>;

constexpr std::array<int, 4> rounding_modes{FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

Time draw_time(Random& random) {
  const auto bits = static_cast<unsigned>(random.between(1, 61));
  const std::int64_t sum = std::int64_t{1} << bits;
  const std::int64_t y = std::abs(random.integer<std::int64_t>(bits)) % (sum + 1);
  return {sum - y, y};
}

/// The blossom of Σ c_k x^(n−k) y^k at these times, times n, by steps on integers.
Integer blossom_of(const std::vector<Integer>& c, const std::vector<Time>& times) {
  std::vector<Integer> b = c;
  if (b.size() > 2) {
    b.front() *= static_cast<long>(b.size() - 1);
    b.back() *= static_cast<long>(b.size() - 1);
  }
  for (const Time& t : times) {
    for (std::size_t i = 0; i + 1 < b.size(); ++i) {
      b[i] = b[i] * Integer(t.x) + b[i + 1] * Integer(t.y);
    }
    b.pop_back();
  }
  return b[0];
}

/// Coefficients of at most `bits` bits, which nearly vanish at the time in one case of two.
std::vector<std::int64_t> draw_form(Random& random, std::size_t degree, const Time& t) {
  std::vector<std::int64_t> c(degree + 1);
  if (random.coin()) {
    for (std::int64_t& x : c) x = random.integer<std::int64_t>(58);
    return c;
  }
  // (y₀ x − x₀ y) times a form of a lower degree, with small changes.
  const auto small = [](std::int64_t x) { return x >> 33U; };
  for (std::size_t i = 0; i < degree; ++i) {
    const auto factor = random.integer<std::int64_t>(24);
    c[i] += factor * small(t.y);
    c[i + 1] -= factor * small(t.x);
  }
  c[static_cast<std::size_t>(random.between(0, static_cast<int>(degree)))] += random.between(-1, 1);
  return c;
}

template <std::size_t count>
struct Drawn {
  explicit Drawn(Random& random) : at(draw_time(random)), other(draw_time(random)) {
    const auto c = draw_form(random, count - 1, at);
    for (std::size_t i = 0; i < count; ++i) {
      coefficients[i] = FixedInteger<2>(c[i]);
      integers.emplace_back(c[i]);
    }
  }
  Time at, other;
  std::array<FixedInteger<2>, count> coefficients;
  std::vector<Integer> integers;
};

TEST(FilteredForm, SignsAreExactInEveryRoundingMode) {
  Random random(1);
  int zeros = 0;
  for (int i = 0; i < 4000; ++i) {
    std::fesetround(rounding_modes[static_cast<std::size_t>(i) % 4]);
    const Drawn<2> line(random);
    EXPECT_EQ(FilteredForm(line.coefficients).sign_at(line.at),
              sgn(blossom_of(line.integers, {line.at})));
    const Drawn<3> quadratic(random);
    const FilteredForm of_quadratic(quadratic.coefficients);
    const int sign = sgn(blossom_of(quadratic.integers, {quadratic.at, quadratic.at}));
    EXPECT_EQ(of_quadratic.sign_at(quadratic.at), sign);
    EXPECT_EQ(of_quadratic.sign(quadratic.at, quadratic.other),
              sgn(blossom_of(quadratic.integers, {quadratic.at, quadratic.other})));
    const Drawn<4> cubic(random);
    const FilteredForm of_cubic(cubic.coefficients);
    EXPECT_EQ(of_cubic.sign_at(cubic.at),
              sgn(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.at})));
    EXPECT_EQ(of_cubic.sign(cubic.at, cubic.at, cubic.other),
              sgn(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.other})));
    if (sign == 0) ++zeros;
  }
  std::fesetround(FE_TONEAREST);
  EXPECT_GT(zeros, 20);
}

TEST(FilteredForm, RoundedValuesAreWithinTheirBound) {
  Random random(2);
  int unsure = 0, near = 0;
  for (int i = 0; i < 4000; ++i) {
    const Drawn<4> cubic(random);
    std::fesetround(rounding_modes[static_cast<std::size_t>(i) % 4]);
    const RoundedBlossom rounded = FilteredForm(cubic.coefficients).rounded_value_at(cubic.at);
    std::fesetround(FE_TONEAREST);
    const Rational truth(blossom_of(cubic.integers, {cubic.at, cubic.at, cubic.at}));
    const Rational error = abs(Rational(rounded.value) - truth);
    EXPECT_LE(error, Rational(RoundedBlossom::rounding) * Rational(rounded.magnitude));
    if (rounded.sign() == 0) ++unsure;
    if (!rounded.is_near()) continue;
    ++near;
    EXPECT_LE(error, exact::power_of_two(-43) * abs(truth));
  }
  EXPECT_GT(unsure, 100);
  EXPECT_GT(near, 1000);
}

TEST(FilteredForm, TellsNothingOfWhatOverflows) {
  // 2^1000 − 2^1000 t and its negative, with weights up to 2^61.
  FixedInteger<16> large(std::int64_t{1});
  for (int i = 0; i < 1000; ++i) large += large;
  const Time middle{std::int64_t{1} << 60U, std::int64_t{1} << 60U};
  const FilteredForm<16, 2> line(std::array<FixedInteger<16>, 2>{large, -large});
  EXPECT_EQ(line.rounded_value_at(middle).sign(), 0);
  EXPECT_EQ(line.sign_at(middle), 0);
  const FilteredForm<16, 2> positive(std::array<FixedInteger<16>, 2>{large, large});
  EXPECT_EQ(positive.rounded_value_at(middle).sign(), 0);
  EXPECT_EQ(positive.sign_at(middle), 1);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::floating_point_filter_test
