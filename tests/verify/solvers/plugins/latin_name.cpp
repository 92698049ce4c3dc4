/// \file
/// A plugin whose name is the environment variable TOUCHSTONE_PLUGIN_NAME, or otherwise not UTF-8.

#include <cstdint>
#include <cstdlib>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() {
  const char* const name = std::getenv("TOUCHSTONE_PLUGIN_NAME");  // NOLINT(concurrency-mt-unsafe)
  return name == nullptr ? "caf\xe9" : name;
}

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer*) {}
