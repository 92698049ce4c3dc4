/// \file
/// A plugin that hangs at every query.

#include <cstdint>
#include <ctime>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "never_answers"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer*) {
  constexpr std::timespec hour{.tv_sec = 3600, .tv_nsec = 0};
  for (;;) nanosleep(&hour, nullptr);
}
