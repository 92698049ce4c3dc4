#include "verify/baselines/method_support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cfenv>
#include <limits>
#include <stdexcept>

#include "touchstone/query.hpp"

namespace touchstone::baselines::method_support_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

double opaque(double x) {
  const volatile double hidden = x;
  return hidden;
}

fast::Answer solve(fast::Answer (*function)(Kind, const Query&, const fast::MethodOptions&),
                   const Query& query, const fast::MethodOptions& options = {}) {
  const auto method = baseline_method({.name = "some"}, function);
  fast::Answer answer;
  method->solve(Queries(Kind::vertex_face, {&query, 1}), {&answer, 1}, options);
  return answer;
}

fast::Answer always_no(Kind, const Query&, const fast::MethodOptions&) {
  return {.verdict = fast::Verdict::no};
}

fast::Answer always_throws(Kind, const Query&, const fast::MethodOptions&) {
  throw std::runtime_error("given up");
}

fast::Answer number_thrown(Kind, const Query&, const fast::MethodOptions&) { throw 1; }

fast::Answer yes_if_rounding_to_nearest(Kind, const Query&, const fast::MethodOptions&) {
  const bool nearest = opaque(1.0) + opaque(0x1p-53) == 1.0 &&
                       opaque(1.0) + opaque(0x1.8p-53) > 1.0 && std::fegetround() == FE_TONEAREST;
  return {.verdict = nearest ? fast::Verdict::yes : fast::Verdict::no};
}

TEST(BaselineMethod, WhatIsThrownIsACollision) {
  EXPECT_EQ(solve(always_throws, Query{}).verdict, fast::Verdict::yes);
  EXPECT_EQ(solve(number_thrown, Query{}).verdict, fast::Verdict::yes);
}

TEST(BaselineMethod, RefusesWhatIsNotFinite) {
  for (const double bad : {nan, infinity, -infinity}) {
    for (const std::size_t place : {0U, 11U, 23U}) {
      Query query{};
      query.coordinates[place] = bad;
      EXPECT_EQ(solve(always_no, query).verdict, fast::Verdict::error);
    }
  }
}

TEST(BaselineMethod, RefusesOptionsThatMeanNothing) {
  const auto bad = std::to_array<fast::MethodOptions>({{.tolerance = 0.0},
                                                       {.tolerance = nan},
                                                       {.tolerance = infinity},
                                                       {.separation = {.distance = -1.0}},
                                                       {.separation = {.distance = nan}},
                                                       {.separation = {.distance = infinity}},
                                                       {.t_max = -0.5},
                                                       {.t_max = 1.5},
                                                       {.t_max = nan}});
  for (const fast::MethodOptions& options : bad) {
    EXPECT_FALSE(are_valid(options));
    EXPECT_EQ(solve(always_no, Query{}, options).verdict, fast::Verdict::error);
  }
  EXPECT_TRUE(are_valid({}));
  EXPECT_TRUE(are_valid({.separation = {.distance = 1e-100}, .t_max = 0.0}));
}

TEST(BaselineMethod, RoundsToNearestWhateverTheCallerDoes) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    std::fesetround(mode);
    const fast::Verdict verdict = solve(yes_if_rounding_to_nearest, Query{}).verdict;
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(verdict, fast::Verdict::yes) << mode;
    EXPECT_EQ(after, mode);
  }
}

}  // namespace
}  // namespace touchstone::baselines::method_support_test
