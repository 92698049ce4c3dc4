#include "touchstone/plugin.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>

namespace touchstone::verify::plugin_test {
namespace {

// Existing libraries were compiled with these numbers. A change of one is a new version of the
// interface.

TEST(PluginInterface, KindsAndVerdictsHaveTheirNumbers) {
  EXPECT_EQ(TOUCHSTONE_VERTEX_FACE, 0);
  EXPECT_EQ(TOUCHSTONE_EDGE_EDGE, 1);
  EXPECT_EQ(TOUCHSTONE_NO, 0);
  EXPECT_EQ(TOUCHSTONE_YES, 1);
  EXPECT_EQ(TOUCHSTONE_UNDECIDED, 2);
  EXPECT_EQ(TOUCHSTONE_ERROR, 3);
  EXPECT_EQ(TOUCHSTONE_LINF, 0);
  EXPECT_EQ(TOUCHSTONE_L2, 1);
  EXPECT_EQ(TOUCHSTONE_PROMISES_NOTHING, 0);
  EXPECT_EQ(TOUCHSTONE_PROMISES_CONSERVATIVE, 1);
  EXPECT_EQ(TOUCHSTONE_PROMISES_EXACT, 2);
  EXPECT_EQ(TOUCHSTONE_TIMES_BOUNDS, 0);
  EXPECT_EQ(TOUCHSTONE_TIMES_ESTIMATES, 1);
  EXPECT_EQ(TOUCHSTONE_TIMES_NONE, 2);
  EXPECT_EQ(TOUCHSTONE_PLUGIN_VERSION, 2);
}

TEST(PluginInterface, StructsHaveTheirLayout) {
  EXPECT_EQ(sizeof(TouchstonePluginOptions), 40U);
  EXPECT_EQ(offsetof(TouchstonePluginOptions, tolerance), 0U);
  EXPECT_EQ(offsetof(TouchstonePluginOptions, max_checks), 8U);
  EXPECT_EQ(offsetof(TouchstonePluginOptions, min_separation), 16U);
  EXPECT_EQ(offsetof(TouchstonePluginOptions, t_max), 24U);
  EXPECT_EQ(offsetof(TouchstonePluginOptions, norm), 32U);

  EXPECT_EQ(sizeof(TouchstonePluginAnswer), 32U);
  EXPECT_EQ(offsetof(TouchstonePluginAnswer, verdict), 0U);
  EXPECT_EQ(offsetof(TouchstonePluginAnswer, toi_lower), 8U);
  EXPECT_EQ(offsetof(TouchstonePluginAnswer, toi_upper), 16U);
  EXPECT_EQ(offsetof(TouchstonePluginAnswer, tolerance), 24U);

  EXPECT_EQ(sizeof(TouchstonePluginPromise), 48U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, size), 0U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, promise), 4U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, kinds), 8U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, is_float), 16U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, times), 20U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, starts_apart), 24U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, time_error), 32U);
  EXPECT_EQ(offsetof(TouchstonePluginPromise, elements), 40U);
}

TEST(PluginInterface, FunctionsHaveTheirTypes) {
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_version), int32_t()>));
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_name), const char*()>));
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_solve),
                              void(int32_t, const double*, const TouchstonePluginOptions*,
                                   TouchstonePluginAnswer*)>));
  EXPECT_TRUE((std::is_same_v<decltype(touchstone_plugin_solve_curved),
                              void(int32_t, int32_t, int32_t, const double*,
                                   const TouchstonePluginOptions*, TouchstonePluginAnswer*)>));
}

}  // namespace
}  // namespace touchstone::verify::plugin_test
