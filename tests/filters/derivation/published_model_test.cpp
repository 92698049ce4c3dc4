#include "touchstone/derivation/published_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/filters/support.hpp"
#include "touchstone/derivation/rounding_model.hpp"

namespace touchstone::filters::published_model_test {
namespace {

/// Seven digits of a number in [1e-6, 1e-5), rounded up as in the publication.
std::string seven_digits_up(const mpq_class& x) {
  const mpq_class scaled = x * 1'000'000 * 1'000'000;
  mpz_class up;
  mpz_cdiv_q(up.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const std::string digits = up.get_str();
  return digits.substr(0, 1) + "." + digits.substr(1) + "e-06";
}

template <class Expression>
void expect_constants(double in_double, const char* in_float) {
  const mpq_class units = published_model_units(record<Expression>());
  EXPECT_EQ(mpq_class(units * double_format.unit_roundoff()), mpq_class(in_double));
  EXPECT_EQ(seven_digits_up(units * float_format.unit_roundoff()), in_float);
}

TEST(PublishedModel, GivesThePublishedConstants) {
  expect_constants<PaperEdgeEdge>(6.217248937900877e-15, "3.337861e-06");
  expect_constants<PaperVertexFace>(6.661338147750939e-15, "3.576279e-06");
  expect_constants<PaperEdgeEdgeSeparated>(7.105427357601002e-15, "3.814698e-06");
  expect_constants<PaperVertexFaceSeparated>(7.549516567451064e-15, "4.053116e-06");
}

TEST(PublishedModel, DependsOnTheOrderOfOperations) {
  EXPECT_EQ(published_model_units(record<PaperEdgeEdge>()), 56);
  EXPECT_EQ(published_model_units(record<ReleasedEdgeEdge>()), 84);
}

TEST(PublishedModel, FollowsABlendByHand) {
  // Two products below 1, each with an error of u; a sum below 2 with half an ulp of 2u.
  EXPECT_EQ(published_model_units(record<Blend>()), 4);
}

}  // namespace
}  // namespace touchstone::filters::published_model_test
