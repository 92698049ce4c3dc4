/// \file
/// A plugin made for a version of the interface that does not exist.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION + 41; }

const char* touchstone_plugin_name() { return "wrong_version"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer*) {}
