#include "tight_inclusion/interval_root_finder.hpp"

#include <gtest/gtest.h>

#include <tight_inclusion/interval_root_finder.hpp>

#include "touchstone/tight_inclusion.hpp"

namespace touchstone::adapters::interval_root_finder_test {
namespace {

using ticcd::Vector3;

TEST(TightInclusionFilter, IsThatOfTheGreatestCoordinates) {
  for (const bool is_vertex_face : {false, true}) {
    for (const bool is_separated : {false, true}) {
      const ticcd::Array3 filter = ticcd::get_numerical_error(
          {Vector3(-8, 1, 0), Vector3(3, -2, 1e9)}, is_vertex_face, is_separated);
      const auto expected = fast::error_filter(is_vertex_face ? Kind::vertex_face : Kind::edge_edge,
                                               {8, 2, 1e9}, is_separated ? 1e-300 : 0.0);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(filter[axis], expected[static_cast<std::size_t>(axis)]);
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::adapters::interval_root_finder_test
