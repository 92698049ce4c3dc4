/// \file
/// A plugin whose name is one line of text, but not in UTF-8.

#include <cstdint>

#include "verify/plugin.h"

std::int32_t touchstone_plugin_version() { return touchstone_interface_version; }

const char* touchstone_plugin_name() { return "caf\xe9"; }

void touchstone_plugin_solve(std::int32_t, const double*, const touchstone_options*,
                             touchstone_answer*) {}
