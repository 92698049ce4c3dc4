#include "fast/distance/neighbouring_doubles.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace touchstone::fast::neighbouring_doubles_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// The sign of (x, or a number between it and the next double) − s.
auto sign_against(double x, bool is_between) {
  return [=](double s) -> std::optional<int> {
    if (x > s) return 1;
    if (x < s) return -1;
    return is_between ? 1 : 0;
  };
}

TEST(NeighbouringDoubles, AreFoundFromAnyGuess) {
  constexpr auto numbers =
      std::to_array({0.0, tiniest, 0x1p-1022, 1e-300, 0.1, 1.0, 7.0, greatest});
  constexpr auto guesses = std::to_array({0.0, -1.0, tiniest, 1e-300, 0.1, 1.0, 1e300, greatest,
                                          infinity, std::numeric_limits<double>::quiet_NaN()});
  for (const double x : numbers) {
    for (const double guess : guesses) {
      EXPECT_EQ(neighbouring_doubles(guess, sign_against(x, false)), (Distance{x, x}));
      EXPECT_EQ(neighbouring_doubles(guess, sign_against(x, true)),
                (Distance{x, std::nextafter(x, infinity)}));
    }
  }
}

TEST(NeighbouringDoubles, NeedFewComparisonsNearby) {
  for (const double guess : {0.1, std::nextafter(0.1, 0.0), std::nextafter(0.1, 1.0)}) {
    int comparisons = 0;
    const auto sign_of = sign_against(0.1, true);
    (void)neighbouring_doubles(guess, [&](double s) { return ++comparisons, sign_of(s); });
    EXPECT_LE(comparisons, 4);
  }
}

}  // namespace
}  // namespace touchstone::fast::neighbouring_doubles_test
