/// \file
/// A plugin whose name is null.

#include <cstdint>

#include "verify/plugin.h"

std::int32_t touchstone_plugin_version() { return touchstone_interface_version; }

const char* touchstone_plugin_name() { return "two\nlines"; }

void touchstone_plugin_solve(std::int32_t, const double*, const touchstone_options*,
                             touchstone_answer*) {}
