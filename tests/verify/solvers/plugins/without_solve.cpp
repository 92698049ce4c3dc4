/// \file
/// A plugin without the function that solves.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "without_solve"; }
