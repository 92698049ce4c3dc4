#include "verify/view/viewed_query.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/queries.hpp"
#include "touchstone/certificate_text.hpp"

namespace touchstone::verify::view::viewed_query_test {
namespace {

/// A vertex on a parabola above a triangle, which touches it at t = 1/2; the triangle at rest.
OwnCurves touching() {
  return {.kind = Kind::vertex_face,
          .curves = {{{.control = {{1, 1, 1}, {1, 1, -1}, {1, 1, 1}}},
                      {.control = {{0, 0, 0}}},
                      {.control = {{4, 0, 0}}},
                      {.control = {{0, 4, 0}}}}}};
}

TEST(InOneShape, ConstantCurvesHaveAnyDegree) {
  const auto query = in_one_shape({.label = "", .query = touching()});
  ASSERT_TRUE(query);
  EXPECT_EQ(query->shape(), (QueryShape{.kind = Kind::vertex_face, .degree = 2}));
  const ViewedQuery shaped{.label = "", .query = *query};
  EXPECT_EQ(in_one_shape(shaped), *query);
  CurvedQuery expected = touching().curves;
  for (std::size_t i = 1; i < moving_points; ++i) {
    expected.at(i).control.assign(3, touching().curves.at(i).control.front());
  }
  EXPECT_EQ(curves_of(shaped), expected);
}

TEST(InOneShape, WeightsOfOneAreThoseOfTheOthers) {
  OwnCurves own = touching();
  own.kind = Kind::edge_edge;
  own.curves[0].weights = {1, 2, 3};
  own.curves[2].weights = {0.5};
  const auto query = in_one_shape({.label = "", .query = own});
  ASSERT_TRUE(query);
  EXPECT_EQ(query->shape(),
            (QueryShape{.kind = Kind::edge_edge, .degree = 2, .is_rational = true}));
  const CurvedQuery curves = to_curved(query->queries(), 0);
  EXPECT_EQ(curves[0].weights, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(curves[1].weights, std::vector<double>(3, 1.0));
  EXPECT_EQ(curves[2].weights, std::vector<double>(3, 0.5));
}

TEST(InOneShape, OthersHaveNone) {
  OwnCurves own = touching();
  own.curves[3].control.push_back({0, 4, 0});
  EXPECT_FALSE(in_one_shape({.label = "", .query = own}));
}

TEST(ViewedQuery, IsDecidedAndProvedAsItIsWritten) {
  const ViewedQuery own{.label = "", .query = touching()};
  const ViewedQuery shaped{.label = "", .query = in_one_shape(own).value()};
  const auto text = [](const ViewedQuery& viewed) {
    const exact::Decision decision = decide(viewed);
    EXPECT_EQ(decision.toi, exact::AlgebraicNumber(exact::Rational(1, 2)));
    return exact::certificate_stream(prove(viewed, decision), "");
  };
  EXPECT_NE(text(own).find("\ncurve 0\n"), std::string::npos);
  EXPECT_EQ(text(shaped).find("\ncurve 0\n"), std::string::npos);
  EXPECT_EQ(kind_of(own), Kind::vertex_face);
  EXPECT_EQ(straight_of(shaped), nullptr);
}

TEST(ViewedQuery, OnStraightLinesItIsAQuery) {
  const tests::PosedQuery posed = tests::over_triangle(1, 1, 1, -1);
  const ViewedQuery viewed{.label = "", .query = base::AnyQuery(posed.kind, posed.query)};
  ASSERT_NE(straight_of(viewed), nullptr);
  EXPECT_EQ(*straight_of(viewed), posed.query);
  EXPECT_EQ(decide(viewed).toi, exact::AlgebraicNumber(exact::Rational(1, 2)));
  const exact::Certificate certificate = prove(viewed, decide(viewed));
  EXPECT_EQ(std::get<Query>(certificate.query), posed.query);
}

}  // namespace
}  // namespace touchstone::verify::view::viewed_query_test
