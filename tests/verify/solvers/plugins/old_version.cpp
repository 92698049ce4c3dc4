/// \file
/// A plugin made for version 1 of the interface, whose options end before the norm.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return 1; }

const char* touchstone_plugin_name() { return "old_version"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  answer->verdict = TOUCHSTONE_YES;
  answer->toi_lower = options->min_separation;
  answer->toi_upper = options->t_max;
}
