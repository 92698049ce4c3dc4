#include "verify/plugin.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>

namespace touchstone::verify::plugin_test {
namespace {

// Existing libraries were compiled with these numbers. A change of one is a new version of the
// interface.

TEST(PluginInterface, KindsAndVerdictsHaveTheirNumbers) {
  EXPECT_EQ(touchstone_vertex_face, 0);
  EXPECT_EQ(touchstone_edge_edge, 1);
  EXPECT_EQ(touchstone_no, 0);
  EXPECT_EQ(touchstone_yes, 1);
  EXPECT_EQ(touchstone_undecided, 2);
  EXPECT_EQ(touchstone_error, 3);
  EXPECT_EQ(touchstone_linf, 0);
  EXPECT_EQ(touchstone_l2, 1);
  EXPECT_EQ(touchstone_interface_version, 2);
}

TEST(PluginInterface, StructsHaveTheirLayout) {
  EXPECT_EQ(sizeof(touchstone_options), 40U);
  EXPECT_EQ(offsetof(touchstone_options, tolerance), 0U);
  EXPECT_EQ(offsetof(touchstone_options, max_checks), 8U);
  EXPECT_EQ(offsetof(touchstone_options, min_separation), 16U);
  EXPECT_EQ(offsetof(touchstone_options, t_max), 24U);
  EXPECT_EQ(offsetof(touchstone_options, norm), 32U);

  EXPECT_EQ(sizeof(touchstone_answer), 32U);
  EXPECT_EQ(offsetof(touchstone_answer, verdict), 0U);
  EXPECT_EQ(offsetof(touchstone_answer, toi_lower), 8U);
  EXPECT_EQ(offsetof(touchstone_answer, toi_upper), 16U);
  EXPECT_EQ(offsetof(touchstone_answer, tolerance), 24U);
}

TEST(PluginInterface, FunctionsHaveTheirTypes) {
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_version), int32_t()>));
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_name), const char*()>));
  EXPECT_TRUE((
      std::is_same_v<decltype(touchstone_plugin_solve),
                     void(int32_t, const double*, const touchstone_options*, touchstone_answer*)>));
}

}  // namespace
}  // namespace touchstone::verify::plugin_test
