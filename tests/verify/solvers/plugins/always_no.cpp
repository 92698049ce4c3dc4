/// \file
/// A plugin that says no to everything.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "always_no"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer* answer) {
  answer->verdict = TOUCHSTONE_NO;
}
