#include "verify/baselines/interval_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::baselines::interval_search_test {
namespace {

const Interval unit(0.0, 1.0);

/// x² = 1/2
struct SquareIsHalf {
  using Box = ParameterBox<1>;

  [[nodiscard]] static bool may_vanish(const Box& box) {
    return may_be_zero(box[0] * box[0] - Interval(0.5));
  }
  [[nodiscard]] static bool reaches_domain(const Box& /*box*/) { return true; }
  [[nodiscard]] static bool accepts(const Box& /*box*/) { return true; }
};

TEST(IntervalSearch, FindsARootInOneDimension) {
  const auto found = search_box<1>(SquareIsHalf{}, {unit}, {1e-12}, 0);
  ASSERT_EQ(found.verdict, fast::Verdict::yes);
  EXPECT_LE(found.box[0].lower(), std::sqrt(0.5));
  EXPECT_GE(found.box[0].upper(), std::sqrt(0.5));
  EXPECT_LE(boost::numeric::width(found.box[0]), 1e-12);
}

TEST(IntervalSearch, DoesNotSplitNeighbouringDoubles) {
  const Interval narrow(1.0, std::nextafter(1.0, 2.0));
  EXPECT_EQ(dimension_to_split<1>({narrow}, {0.0}, 0), std::nullopt);
  const auto found = search_box<1>(SquareIsHalf{}, {unit}, {0.0}, 0);
  EXPECT_EQ(found.verdict, fast::Verdict::yes);
}

}  // namespace
}  // namespace touchstone::baselines::interval_search_test
