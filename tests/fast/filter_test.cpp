#include "touchstone/tight_inclusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "touchstone/filters/error_bounds.hpp"

namespace touchstone::fast::filter_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least = std::numeric_limits<double>::denorm_min();

double on_first_axis(Kind kind, double x_max, double d, ErrorModel model = ErrorModel::derived) {
  return error_filter(kind, {x_max, 0.0, 0.0}, d, model)[0];
}

TEST(ErrorFilter, IsTheDerivedBoundAndTakesTheSeparationForACoordinate) {
  EXPECT_EQ(on_first_axis(Kind::edge_edge, 3.0, 2.0), filters::edge_edge_separated_double(3.0));
  EXPECT_EQ(on_first_axis(Kind::vertex_face, 3.0, 5.0), filters::vertex_face_separated_double(5.0));
  EXPECT_EQ(on_first_axis(Kind::vertex_face, 3.0, least),
            filters::vertex_face_separated_double(3.0));
  const auto in_float = [](Kind kind, double x_max, double d) {
    return on_first_axis(kind, x_max, d, ErrorModel::single_precision);
  };
  EXPECT_EQ(in_float(Kind::edge_edge, 3.0, 0.0), filters::edge_edge_float(3.0F));
  EXPECT_EQ(in_float(Kind::vertex_face, 0.0, 0.0), filters::vertex_face_float(0.0F));
  EXPECT_EQ(in_float(Kind::edge_edge, 3.0, 5.0), filters::edge_edge_separated_float(5.0F));
  EXPECT_EQ(in_float(Kind::vertex_face, 3.0, 1.0), filters::vertex_face_separated_float(3.0F));
}

TEST(ErrorFilter, GivesThePublishedConstantsUpToSizeOneAndReleasedScalesBelow) {
  struct Row {
    Kind kind;
    double d, constant;
  };
  for (const auto& [kind, d, constant] : {Row{Kind::edge_edge, 0.0, 6.217248937900877e-15},
                                          Row{Kind::vertex_face, 0.0, 6.661338147750939e-15},
                                          Row{Kind::edge_edge, 1e-8, 7.105427357601002e-15},
                                          Row{Kind::vertex_face, 1e-8, 7.549516567451064e-15}}) {
    for (const double x_max : {0.0, 1e-300, 0.5, 1.0}) {
      EXPECT_EQ(on_first_axis(kind, x_max, d, ErrorModel::published), constant);
    }
    // The release has the least of one and x_max for the greatest.
    for (const double x_max : {0.0, 0x1p-20, 0.5, 1.0, 3.0, 1e6}) {
      const double least_of_both = std::min(1.0, x_max);
      EXPECT_EQ(on_first_axis(kind, x_max, d, ErrorModel::released),
                constant * (least_of_both * least_of_both * least_of_both));
    }
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

/// The released bound is not one: it is below half a unit in the last place, an error that F's
/// values have at least, for small or large coordinates.
TEST(ErrorFilter, ReleasedIsBelowHalfAUnitInTheLastPlaceAtMostScales) {
  for (const double x_max : {1e-3, 1e-2, 1e3}) {
    EXPECT_LT(on_first_axis(Kind::vertex_face, x_max, 0.0, ErrorModel::released), 0x1p-53 * x_max);
  }
}

TEST(ErrorFilter, IsInfiniteWhereOverflowCouldOccurAndNeverZero) {
  for (const ErrorModel model :
       {ErrorModel::derived, ErrorModel::published, ErrorModel::released}) {
    EXPECT_EQ(on_first_axis(Kind::edge_edge, std::numeric_limits<double>::max(), 0.0, model),
              infinity);
    EXPECT_EQ(on_first_axis(Kind::vertex_face, 1.0, 0x1p1022, model), infinity);
  }
  EXPECT_LT(on_first_axis(Kind::edge_edge, 0x1p1020, 0.0), infinity);
  for (const auto& [x_max, is_infinite] : {std::pair(0x1p120, false), {0x1p126, true}}) {
    const double filter =
        on_first_axis(Kind::vertex_face, x_max, 0.0, ErrorModel::single_precision);
    EXPECT_EQ(filter == infinity, is_infinite) << x_max;
  }
  // Nothing but underflow.
  EXPECT_GT(on_first_axis(Kind::edge_edge, 0.0, 0.0), 0.0);
  EXPECT_GT(on_first_axis(Kind::vertex_face, least, 0.0), least);
}

}  // namespace
}  // namespace touchstone::fast::filter_test
