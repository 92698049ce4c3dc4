#include "touchstone/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "touchstone/filters/error_bounds.hpp"

namespace touchstone::fast::filter_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least = std::numeric_limits<double>::denorm_min();

double on_first_axis(Kind kind, double x_max, double d, ErrorModel model = ErrorModel::derived) {
  return error_filter(kind, {x_max, 0.0, 0.0}, d, model)[0];
}

TEST(ErrorFilter, TakesTheSeparationForACoordinate) {
  EXPECT_EQ(on_first_axis(Kind::edge_edge, 3.0, 2.0), filters::edge_edge_separated_double(3.0));
  EXPECT_EQ(on_first_axis(Kind::edge_edge, 3.0, 5.0), filters::edge_edge_separated_double(5.0));
  EXPECT_EQ(on_first_axis(Kind::vertex_face, 3.0, 5.0), filters::vertex_face_separated_double(5.0));
  EXPECT_EQ(on_first_axis(Kind::vertex_face, 3.0, least),
            filters::vertex_face_separated_double(3.0));
}

TEST(ErrorFilter, GivesThePublishedConstantsUpToSizeOne) {
  for (const double x_max : {0.0, 1e-300, 0.5, 1.0}) {
    EXPECT_EQ(on_first_axis(Kind::edge_edge, x_max, 0.0, ErrorModel::published),
              6.217248937900877e-15);
    EXPECT_EQ(on_first_axis(Kind::vertex_face, x_max, 0.0, ErrorModel::published),
              6.661338147750939e-15);
    EXPECT_EQ(on_first_axis(Kind::edge_edge, x_max, 1e-8, ErrorModel::published),
              7.105427357601002e-15);
    EXPECT_EQ(on_first_axis(Kind::vertex_face, x_max, 1e-8, ErrorModel::published),
              7.549516567451064e-15);
  }
  EXPECT_EQ(on_first_axis(Kind::edge_edge, 10.0, 0.0, ErrorModel::published),
            6.217248937900877e-12);
}

TEST(ErrorFilter, IsBelowThePublishedAtEveryScale) {
  for (const Kind kind : {Kind::edge_edge, Kind::vertex_face}) {
    for (const double d : {0.0, 1e-30}) {
      for (int exponent = -1074; exponent <= 300; ++exponent) {
        for (const double factor : {1.0, 1.25, 1.5, 1.999}) {
          const double x_max = std::ldexp(factor, exponent);
          EXPECT_LT(on_first_axis(kind, x_max, d),
                    on_first_axis(kind, x_max, d, ErrorModel::published))
              << x_max;
        }
      }
    }
  }
}

TEST(ErrorFilter, ReleasedHasTheLeastOfOneAndXMaxForTheGreatest) {
  for (const double d : {0.0, 1e-8}) {
    const double published = on_first_axis(Kind::vertex_face, 1.0, d, ErrorModel::published);
    for (const double x_max : {1.0, 3.0, 1e6}) {
      EXPECT_EQ(on_first_axis(Kind::vertex_face, x_max, d, ErrorModel::released), published);
    }
    EXPECT_EQ(on_first_axis(Kind::vertex_face, 0.5, d, ErrorModel::released), published / 8.0);
    EXPECT_EQ(on_first_axis(Kind::vertex_face, 0.0, d, ErrorModel::released), 0.0);
  }
  EXPECT_EQ(on_first_axis(Kind::edge_edge, 0x1p-20, 0.0, ErrorModel::released),
            6.217248937900877e-15 * 0x1p-60);
}

/// The released bound is not one: it is below half a unit in the last place, an error that F's
/// values have at least, for small or large coordinates.
TEST(ErrorFilter, ReleasedIsBelowHalfAUnitInTheLastPlaceAtMostScales) {
  for (const double x_max : {1e-3, 1e-2, 1e3}) {
    EXPECT_LT(on_first_axis(Kind::vertex_face, x_max, 0.0, ErrorModel::released), 0x1p-53 * x_max);
  }
}

TEST(ErrorFilter, OfSinglePrecisionIsTheDerivedBoundInFloat) {
  const auto on_axis = [](Kind kind, double x_max, double d) {
    return on_first_axis(kind, x_max, d, ErrorModel::single_precision);
  };
  EXPECT_EQ(on_axis(Kind::edge_edge, 3.0, 0.0), filters::edge_edge_float(3.0F));
  EXPECT_EQ(on_axis(Kind::vertex_face, 0.0, 0.0), filters::vertex_face_float(0.0F));
  EXPECT_EQ(on_axis(Kind::edge_edge, 3.0, 5.0), filters::edge_edge_separated_float(5.0F));
  EXPECT_EQ(on_axis(Kind::vertex_face, 3.0, 1.0), filters::vertex_face_separated_float(3.0F));
  EXPECT_LT(on_axis(Kind::vertex_face, 0x1p120, 0.0), infinity);
  EXPECT_EQ(on_axis(Kind::vertex_face, 0x1p126, 0.0), infinity);
}

TEST(ErrorFilter, IsPositiveWithNothingButUnderflow) {
  EXPECT_GT(on_first_axis(Kind::edge_edge, 0.0, 0.0), 0.0);
  EXPECT_GT(on_first_axis(Kind::vertex_face, least, 0.0), least);
}

TEST(ErrorFilter, IsInfiniteWhereOverflowCouldOccur) {
  for (const ErrorModel model :
       {ErrorModel::derived, ErrorModel::published, ErrorModel::released}) {
    EXPECT_EQ(on_first_axis(Kind::edge_edge, std::numeric_limits<double>::max(), 0.0, model),
              infinity);
    EXPECT_EQ(on_first_axis(Kind::vertex_face, 1.0, 0x1p1022, model), infinity);
  }
  EXPECT_LT(on_first_axis(Kind::edge_edge, 0x1p1020, 0.0), infinity);
}

}  // namespace
}  // namespace touchstone::fast::filter_test
