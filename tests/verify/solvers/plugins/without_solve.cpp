/// \file
/// A plugin without the function that solves.

#include <cstdint>

#include "verify/plugin.h"

std::int32_t touchstone_plugin_version() { return touchstone_interface_version; }

const char* touchstone_plugin_name() { return "without_solve"; }
