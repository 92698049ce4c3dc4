#include "filters/derivation/published_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "filters/derivation/rounding_model.hpp"
#include "tests/filters/support.hpp"

namespace touchstone::filters::published_model_test {
namespace {

template <class Expression>
mpq_class constant(const Format& format) {
  return published_model_units(record<Expression>()) * format.unit_roundoff();
}

TEST(PublishedModel, GivesThePublishedDoubleConstantsToTheLastDigit) {
  EXPECT_EQ(constant<PaperEdgeEdge>(double_format), mpq_class(6.217248937900877e-15));
  EXPECT_EQ(constant<PaperVertexFace>(double_format), mpq_class(6.661338147750939e-15));
  EXPECT_EQ(constant<PaperEdgeEdgeSeparated>(double_format), mpq_class(7.105427357601002e-15));
  EXPECT_EQ(constant<PaperVertexFaceSeparated>(double_format), mpq_class(7.549516567451064e-15));
}

/// Seven digits of a number in [1e-6, 1e-5), rounded up as in the publication.
std::string seven_digits_up(const mpq_class& x) {
  const mpq_class scaled = x * 1'000'000 * 1'000'000;
  mpz_class up;
  mpz_cdiv_q(up.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const std::string digits = up.get_str();
  return digits.substr(0, 1) + "." + digits.substr(1) + "e-06";
}

TEST(PublishedModel, GivesThePublishedFloatConstantsToSevenDigits) {
  EXPECT_EQ(seven_digits_up(constant<PaperEdgeEdge>(float_format)), "3.337861e-06");
  EXPECT_EQ(seven_digits_up(constant<PaperVertexFace>(float_format)), "3.576279e-06");
  EXPECT_EQ(seven_digits_up(constant<PaperEdgeEdgeSeparated>(float_format)), "3.814698e-06");
  EXPECT_EQ(seven_digits_up(constant<PaperVertexFaceSeparated>(float_format)), "4.053116e-06");
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
