#include "verify/baselines/interval_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace touchstone::baselines::interval_search_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Interval unit(0.0, 1.0);

/// A problem given by functions.
template <std::size_t Dimensions>
struct Posed {
  using Box = ParameterBox<Dimensions>;
  std::function<bool(const Box&)> vanish = [](const Box&) { return true; };
  std::function<bool(const Box&)> reach = [](const Box&) { return true; };
  std::function<bool(const Box&)> accept = [](const Box&) { return true; };

  [[nodiscard]] bool may_vanish(const Box& box) const { return vanish(box); }
  [[nodiscard]] bool reaches_domain(const Box& box) const { return reach(box); }
  [[nodiscard]] bool accepts(const Box& box) const { return accept(box); }
};

/// x² = c
Posed<1> square_is(double c) {
  return {.vanish = [c](const auto& box) { return may_be_zero(box[0] * box[0] - Interval(c)); }};
}

TEST(IntervalSearch, FindsARootInOneDimension) {
  const auto found = search_box<1>(square_is(0.5), {unit}, {1e-12}, 0);
  ASSERT_EQ(found.verdict, fast::Verdict::yes);
  EXPECT_LE(found.box[0].lower(), std::sqrt(0.5));
  EXPECT_GE(found.box[0].upper(), std::sqrt(0.5));
  EXPECT_LE(boost::numeric::width(found.box[0]), 1e-12);
}

TEST(IntervalSearch, ProvesThatThereIsNoRoot) {
  // (x − 0.3)² + 1e-6 is nowhere 0; the product of narrow intervals shows it.
  const Posed<1> problem{.vanish = [](const auto& box) {
    const Interval x = box[0] - Interval(0.3);
    return may_be_zero(x * x + Interval(1e-6));
  }};
  const auto found = search_box<1>(problem, {unit}, {1e-9}, 0);
  EXPECT_EQ(found.verdict, fast::Verdict::no);
  EXPECT_GT(found.checks, 10);
}

TEST(IntervalSearch, TakesTheEarliestOfSeveralInOneDimension) {
  // Zeros at 0.25 and 0.75.
  Posed<1> problem{.vanish = [](const auto& box) {
    return may_be_zero((box[0] - Interval(0.25)) * (box[0] - Interval(0.75)));
  }};
  const auto first = search_box<1>(problem, {unit}, {1e-6}, 0);
  ASSERT_EQ(first.verdict, fast::Verdict::yes);
  EXPECT_NEAR(first.box[0].lower(), 0.25, 2e-6);
  problem.accept = [](const auto& box) { return box[0].lower() > 0.5; };
  const auto second = search_box<1>(problem, {unit}, {1e-6}, 0);
  ASSERT_EQ(second.verdict, fast::Verdict::yes) << "what is not accepted is dropped";
  EXPECT_NEAR(second.box[0].lower(), 0.75, 2e-6);
}

TEST(IntervalSearch, SplitsInTurnWhatIsNotSmall) {
  const ParameterBox<3> box{unit, unit, unit};
  EXPECT_EQ(dimension_to_split<3>(box, {0.5, 0.5, 0.5}, 2), 0U);
  EXPECT_EQ(dimension_to_split<3>(box, {0.5, 0.5, 0.5}, 0), 1U);
  EXPECT_EQ(dimension_to_split<3>(box, {0.5, 1.0, 0.5}, 0), 2U);
  EXPECT_EQ(dimension_to_split<3>(box, {0.5, infinity, infinity}, 0), 0U);
  EXPECT_EQ(dimension_to_split<3>(box, {1.0, 1.0, infinity}, 0), std::nullopt);
}

TEST(IntervalSearch, DoesNotSplitNeighbouringDoubles) {
  const Interval narrow(1.0, std::nextafter(1.0, 2.0));
  EXPECT_EQ(dimension_to_split<1>({narrow}, {0.0}, 0), std::nullopt);
  const auto found = search_box<1>(square_is(0.5), {unit}, {0.0}, 0);
  EXPECT_EQ(found.verdict, fast::Verdict::yes);
}

TEST(IntervalSearch, AnInfiniteToleranceMakesTheWholeAxisSmall) {
  const auto found = search_box<1>(Posed<1>{}, {unit}, {infinity}, 0);
  EXPECT_EQ(found.verdict, fast::Verdict::yes);
  EXPECT_EQ(found.checks, 1);
  EXPECT_EQ(found.box[0].lower(), 0.0);
  EXPECT_EQ(found.box[0].upper(), 1.0);
}

TEST(IntervalSearch, AsksForTheDomainOfAllButTheFirstDimension) {
  Posed<2> problem;
  problem.reach = [](const auto&) { return false; };
  EXPECT_EQ(search_box<2>(problem, {unit, unit}, {0.5, infinity}, 0).verdict, fast::Verdict::yes);
  EXPECT_EQ(search_box<2>(problem, {unit, unit}, {infinity, 0.5}, 0).verdict, fast::Verdict::no);
}

TEST(IntervalSearch, SaysWhenItsChecksAreSpent) {
  Posed<1> problem;
  problem.accept = [](const auto&) { return false; };
  const auto found = search_box<1>(problem, {unit}, {1e-9}, 100);
  EXPECT_EQ(found.verdict, fast::Verdict::undecided);
  EXPECT_EQ(found.checks, 100);
  // Three intervals are checked: one, and its two halves.
  EXPECT_EQ(search_box<1>(problem, {unit}, {0.5}, 3).verdict, fast::Verdict::no);
  EXPECT_EQ(search_box<1>(problem, {unit}, {0.5}, 2).verdict, fast::Verdict::undecided);
}

}  // namespace
}  // namespace touchstone::baselines::interval_search_test
