/// \file
/// A plugin that misses everything, but only if it is called with certain options.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "wrong_with_options"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  const bool wrong = options->tolerance == 0.125 && options->max_checks == 77 &&
                     options->min_separation == 0.25 && options->norm == TOUCHSTONE_L2 &&
                     options->t_max == 1.0;
  answer->verdict = wrong ? TOUCHSTONE_NO : TOUCHSTONE_UNDECIDED;
}
