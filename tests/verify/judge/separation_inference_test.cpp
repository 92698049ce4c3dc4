#include "verify/judge/separation_inference.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace touchstone::verify::judge::separation_inference_test {
namespace {

constexpr Separation contact{.distance = 0.0, .norm = Norm::linf};
constexpr Separation contact_l2{.distance = -0.0, .norm = Norm::l2};
constexpr Separation one_linf{.distance = 1.0, .norm = Norm::linf};
constexpr Separation one_l2{.distance = 1.0, .norm = Norm::l2};
constexpr Separation two_linf{.distance = 2.0, .norm = Norm::linf};

TEST(Separation, AtDistanceZeroTheNormDoesNotMatter) {
  EXPECT_TRUE(same_separation(contact, contact_l2));
  EXPECT_FALSE(same_separation(one_l2, one_linf));
  EXPECT_FALSE(same_separation(one_linf, two_linf));
}

TEST(Separation, OnlyWhatFollowsIsInferred) {
  EXPECT_EQ(infer(one_l2, one_l2), Inference::all);
  EXPECT_EQ(infer(contact_l2, contact), Inference::all);
  EXPECT_EQ(infer(contact_l2, one_linf), Inference::collisions);
  EXPECT_EQ(infer(one_linf, two_linf), Inference::collisions);
  EXPECT_EQ(infer(one_l2, one_linf), Inference::collisions);
  EXPECT_EQ(infer(one_l2, two_linf), Inference::collisions);
  // Points within 1 of each other on every axis may be farther apart than 1.
  EXPECT_EQ(infer(one_linf, one_l2), Inference::nothing);
  EXPECT_EQ(infer(two_linf, one_linf), Inference::nothing);
  EXPECT_EQ(infer(one_linf, contact), Inference::nothing);
}

}  // namespace
}  // namespace touchstone::verify::judge::separation_inference_test
