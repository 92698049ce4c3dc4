#include "verify/fuzz/plainness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::verify::fuzz::plainness_test {
namespace {

using tests::Random;

Query with_coordinates(const std::vector<std::pair<std::size_t, double>>& values) {
  Query query{};
  for (const auto& [place, value] : values) query.coordinates.at(place) = value;
  return query;
}

Plainness of_itself(const Query& query, Kind kind = Kind::vertex_face) {
  return plainness(kind, query, query);
}

Plainness alone(double x, Kind kind = Kind::vertex_face) {
  return of_itself(with_coordinates({{5, x}}), kind);
}

Query scaled(const Query& query, int exponent) {
  Query result = query;
  for (double& x : result.coordinates) x = std::ldexp(x, exponent);
  return result;
}

TEST(Plainness, CountsTheLengthOfWrittenNumbers) {
  constexpr std::uint64_t rest = 8 + 2 + 1;  // a magnitude other than 0, in motion
  const auto length = [](double x) { return alone(x).length; };
  EXPECT_EQ(of_itself(Query{}).length, 0U);
  EXPECT_EQ(length(1.0), rest + 3);
  EXPECT_EQ(length(-1.0), rest + 4);
  EXPECT_EQ(length(12.0), rest + 6);
  EXPECT_EQ(length(200.0), rest + 3 + 2);
  EXPECT_EQ(length(0.1), rest + 3 + 2);
  EXPECT_EQ(length(0.02), rest + 3 + 1 + 2);
  EXPECT_EQ(length(1.25), rest + 9 + 2);
  EXPECT_EQ(length(-0.0), 1U);
}

TEST(Plainness, CountsAMagnitudeOnceAndMotion) {
  const auto length = [](const Query& query) { return of_itself(query).length; };
  const std::uint64_t one = length(with_coordinates({{0, 5.0}}));
  EXPECT_EQ(length(with_coordinates({{0, 5.0}, {12, 5.0}})), one + 2 - 1);   // at rest
  EXPECT_EQ(length(with_coordinates({{0, 5.0}, {12, -5.0}})), one + 2 + 1);  // a sign
  EXPECT_EQ(length(with_coordinates({{0, 5.0}, {4, 5.0}})), one + 2 + 1);    // moves too
  EXPECT_GT(length(with_coordinates({{0, 5.0}, {12, 4.0}})), one + 8);
}

TEST(Plainness, PutsEverydayNumbersFirst) {
  EXPECT_EQ(alone(0x1p-10).beyond, 0U);
  EXPECT_EQ(alone(1023.9).beyond, 0U);
  EXPECT_EQ(alone(0x1p10).beyond, 1U);
  EXPECT_EQ(alone(0x1p-1074).beyond, 1064U);
  const Query both = with_coordinates({{5, 0x1p12}, {6, -0x1p12}, {7, 0x1p-11}});
  EXPECT_EQ(of_itself(both).beyond, 3U + 1U);
  EXPECT_LT(alone(123.456789), alone(1e4));
}

TEST(Plainness, PrefersElementsWithSizeToShortNumbers) {
  Query flat = tests::over_triangle(1, 1, 1, -1).query;
  const Query whole = flat;
  for (const std::size_t end : {0U, 1U}) flat.point(end, 3) = flat.point(end, 1);
  EXPECT_LT(of_itself(flat).length, of_itself(whole).length);
  EXPECT_LT(of_itself(whole), of_itself(flat));
}

TEST(Plainness, MeasuresTheDriftFromTheOriginalsSize) {
  const Query query = tests::over_triangle(1, 1, 1, -1).query;  // up to 4
  const auto drift = [&](int exponent, const Query& original) {
    return plainness(Kind::vertex_face, scaled(query, exponent), original).drift;
  };
  EXPECT_EQ(drift(0, query), 0U);
  EXPECT_EQ(drift(3, query), 0U);
  EXPECT_EQ(drift(-3, query), 0U);
  EXPECT_EQ(drift(5, query), 2U);
  EXPECT_EQ(drift(-7, query), 4U);
  // For a query far from everyday size, any such size is allowed.
  EXPECT_EQ(drift(7, scaled(query, 300)), 0U);
  EXPECT_EQ(drift(-12, scaled(query, 300)), 0U);
  EXPECT_EQ(drift(9, scaled(query, 300)), 2U);
}

TEST(Plainness, PrefersTheLessOfEquallyLongNumbers) {
  EXPECT_EQ(alone(5.0).length, alone(7.0).length);
  EXPECT_LT(alone(5.0), alone(7.0));
}

TEST(Plainness, KnowsWhichPointsMayBeExchanged) {
  const auto disorder = [](Kind kind, std::size_t place) {
    return of_itself(with_coordinates({{place, 1.0}}), kind).disorder;
  };
  EXPECT_LT(disorder(Kind::vertex_face, 6), disorder(Kind::vertex_face, 3));
  EXPECT_LT(disorder(Kind::vertex_face, 9), disorder(Kind::vertex_face, 6));
  EXPECT_EQ(disorder(Kind::vertex_face, 0), disorder(Kind::vertex_face, 9));
  EXPECT_LT(disorder(Kind::edge_edge, 3), disorder(Kind::edge_edge, 0));
  EXPECT_LT(disorder(Kind::edge_edge, 9), disorder(Kind::edge_edge, 6));
  EXPECT_EQ(disorder(Kind::edge_edge, 3), disorder(Kind::edge_edge, 9));
}

TEST(Plainness, IsWorseSomewhereByAnyOfFourNumbers) {
  const Plainness a{.beyond = 1, .degenerate = 1, .drift = 1, .length = 1};
  EXPECT_FALSE(a.is_worse_somewhere(a));
  for (std::uint64_t Plainness::*number :
       {&Plainness::beyond, &Plainness::degenerate, &Plainness::drift, &Plainness::length}) {
    Plainness worse{};
    worse.*number = 2;
    EXPECT_TRUE(worse.is_worse_somewhere(a));
    EXPECT_FALSE(a.is_worse_somewhere({.beyond = 2, .degenerate = 2, .drift = 2, .length = 2}));
  }
  EXPECT_FALSE((Plainness{.size = 9, .disorder = 9}).is_worse_somewhere(a));
}

TEST(Degeneracy, IsZeroForElementsWithSize) {
  EXPECT_EQ(degeneracy(Kind::vertex_face, tests::over_triangle(1, 1, 1, -1).query), 0U);
  EXPECT_EQ(degeneracy(Kind::edge_edge, tests::over_edge(1, 1, -1, -0.5).query), 0U);
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Query query = tests::full_significand_query(random);
    for (const int exponent : {-1000, 0, 1000}) {
      EXPECT_EQ(degeneracy(Kind::vertex_face, scaled(query, exponent)),
                degeneracy(Kind::vertex_face, query));
    }
  }
}

TEST(Degeneracy, CountsCollapsedElementsByEnd) {
  Query face = tests::over_triangle(1, 1, 1, -1).query;
  face.point(0, 2) = face.point(0, 3);
  EXPECT_EQ(collapsed_elements(Kind::vertex_face, face), 1U);
  face.point(0, 2) = Eigen::Vector3d(2.0, 2.0, 0x1p-12) + face.point(0, 1);
  face.point(0, 3) = Eigen::Vector3d(1.0, 1.0, 0.0) + face.point(0, 1);
  EXPECT_EQ(collapsed_elements(Kind::vertex_face, face), 1U);
  face.point(1, 2) = face.point(1, 3) = Eigen::Vector3d(face.point(1, 1));
  EXPECT_EQ(collapsed_elements(Kind::vertex_face, face), 1U + 2U);
  Query edges = tests::over_edge(1, 1, -1, -0.5).query;
  edges.point(0, 0) = edges.point(0, 1);
  edges.point(1, 2) = edges.point(1, 3);
  EXPECT_EQ(collapsed_elements(Kind::edge_edge, edges), 2U);
  EXPECT_EQ(degeneracy(Kind::edge_edge, Query{}), 5U);
  EXPECT_EQ(degeneracy(Kind::vertex_face, Query{}), 5U);
}

TEST(Degeneracy, CountsPointsThatStayInOnePlane) {
  Query query = tests::over_triangle(1, 1, 0, 0).query;
  EXPECT_EQ(degeneracy(Kind::vertex_face, query), 1U);
  query.at(1, 0, 2) = 0.5;
  EXPECT_EQ(degeneracy(Kind::vertex_face, query), 0U);
}

TEST(Plainness, TakesAnyFiniteCoordinates) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    Query query;
    for (double& x : query.coordinates) x = random.finite_double();
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      EXPECT_LE(degeneracy(kind, query), 5U);
      EXPECT_GT(of_itself(query, kind).length, 24U * (8U + 3U + 2U) / 2U);
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::fuzz::plainness_test
