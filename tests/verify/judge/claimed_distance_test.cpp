#include "verify/judge/claimed_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fast/method.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::verify::judge::claimed_distance_test {
namespace {

using exact::Rational;
using fast::Answer;
using fast::Verdict;

constexpr Query falling{{1, 1, 2, 0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                         1, 1, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0}};

/// The distance that a yes of Tight-Inclusion claims.
double claimed_with_filter(double tolerance, const Query& query, double distance) {
  return claimed_distance(fast::error_filter, ContactKind::vertex_face, query,
                          {.verdict = Verdict::yes, .tolerance = tolerance},
                          {.distance = distance, .norm = Norm::linf})
      .distance;
}

Separation stated(double tolerance, const Separation& separation) {
  return claimed_distance(nullptr, ContactKind::vertex_face, falling,
                          {.verdict = Verdict::yes, .tolerance = tolerance}, separation);
}

TEST(StatedDistance, IsToleranceAndSeparationRoundedUpInTheNormAskedFor) {
  EXPECT_EQ(stated(0.0, {}), Separation{});
  EXPECT_EQ(stated(0.25, {}).distance, 0.25);
  EXPECT_EQ(stated(0.0, {.distance = 1e-3, .norm = Norm::l2}),
            (Separation{.distance = 1e-3, .norm = Norm::l2}));
  const Separation sum = stated(0.1, {.distance = 1e-3, .norm = Norm::l2});
  EXPECT_EQ(sum.norm, Norm::l2);
  EXPECT_GE(Rational(sum.distance), Rational(0.1) + Rational(1e-3));
  EXPECT_LT(sum.distance, 0.1 + 1e-3 + 1e-15);
}

TEST(ClaimedDistance, IsTheSumRoundedUpAndHardlyMore) {
  const double tolerance = 0.1, distance = 1e-3;
  const double filter = fast::error_filter(ContactKind::vertex_face, {4, 4, 2}, distance)[0];
  ASSERT_GT(filter, 0.0);
  const Rational sum = Rational(tolerance) + Rational(distance) + 2 * Rational(filter);
  const Rational claimed(claimed_with_filter(tolerance, falling, distance));
  EXPECT_GT(claimed, sum);
  EXPECT_LT(claimed, sum + Rational(0x1p-52));
}

TEST(ClaimedDistance, WithoutAToleranceOrBeyondTheScaleNothingIsClaimed) {
  EXPECT_TRUE(std::isinf(claimed_with_filter(Answer::none, falling, 0.0)));
  EXPECT_TRUE(std::isinf(claimed_with_filter(1.0, falling, 0x1p1017)));
  Query huge = falling;
  huge.at(0, 2, 1) = -0x1p1017;
  EXPECT_TRUE(std::isinf(claimed_with_filter(1.0, huge, 0.0)));
  EXPECT_FALSE(std::isinf(claimed_with_filter(1.0, falling, 0.0)));
}

/// The oracle confirms the claim.
TEST(ClaimedDistance, TightInclusionKeepsItOnWhatItCannotTellFromContact) {
  std::size_t claims = 0;
  for (const double distance : {0.0, 1e-8, 1e-30}) {
    const Separation separation{.distance = distance, .norm = Norm::linf};
    for (const generate::Family& family : generate::families(separation)) {
      for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
        if (!generate::supports(family, kind)) continue;
        for (std::uint64_t index = 0; index < 4; ++index) {
          const Query query = generate::make_query(family, kind, 7, index, separation).query;
          const auto result = fast::tight_inclusion(
              kind, query,
              {.max_checks = 1000, .separation = {.distance = distance, .norm = Norm::linf}});
          if (result.verdict != Verdict::yes) continue;
          const Separation claimed = claimed_distance(
              fast::error_filter, kind, query,
              {.verdict = Verdict::yes, .tolerance = result.tolerance}, separation);
          if (!is_valid(claimed)) continue;
          ++claims;
          ASSERT_TRUE(exact::decide(kind, query, claimed).collides()) << family.name;
        }
      }
    }
  }
  EXPECT_GT(claims, 300U);
}

/// The vertex comes down from 2 to 1 over the triangle.
TEST(ClaimedDistance, NearnessIsSeenWhereTheBoundsLeaveRoom) {
  const auto is_seen = [](double t, double distance) {
    return is_seen_within(ContactKind::vertex_face, falling, t, distance);
  };
  EXPECT_TRUE(is_seen(1.0, 1.0 + 1e-12));
  EXPECT_FALSE(is_seen(1.0, 1.0)) << "right, but within the bounds";
  EXPECT_FALSE(is_seen(1.0, 1.0 - 1e-12));
  EXPECT_TRUE(is_seen(0.75, 1.25 + 1e-12));
  EXPECT_FALSE(is_seen(0.75, 1.25 - 1e-12));
  EXPECT_FALSE(is_seen(Answer::none, 10.0));
  EXPECT_FALSE(is_seen(1.5, 10.0));
}

TEST(ClaimedDistance, WhatIsSeenIsTrue) {
  std::size_t seen = 0, near = 0;
  for (const generate::Family& family : generate::families({})) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      if (!generate::supports(family, kind)) continue;
      for (std::uint64_t index = 0; index < 6; ++index) {
        const Query query = generate::make_query(family, kind, 11, index, {}).query;
        const double size = std::abs(query.at(0, 0, 0)) + std::abs(query.at(1, 3, 1));
        for (const double distance : {1e-12 * size, 1e-3 * size, 0.3 * size}) {
          if (!is_valid({.distance = distance})) continue;
          const bool is_seen = is_seen_within(kind, query, 0.375, distance);
          const bool is_near =
              exact::decide(kind, query, {.distance = distance, .norm = Norm::linf}).collides();
          EXPECT_TRUE(is_near || !is_seen) << family.name << " " << index;
          seen += is_seen ? 1U : 0U;
          near += is_near ? 1U : 0U;
        }
      }
    }
  }
  EXPECT_GT(4 * seen, near);
}

}  // namespace
}  // namespace touchstone::verify::judge::claimed_distance_test
