/// \file
/// A plugin that states a promise of which nothing is usual, or with NONSENSE one out of range. It
/// answers nothing.

#include <cstdint>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "states_terms"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer*) {}

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->promise = TOUCHSTONE_PROMISES_EXACT;
  promise->kinds[TOUCHSTONE_EDGE_EDGE] = 0;
  promise->is_float = 1;
  promise->times = TOUCHSTONE_TIMES_ESTIMATES;
  promise->starts_apart = 0.5;
  promise->time_error = 0.25;
#ifdef NONSENSE
  promise->kinds[TOUCHSTONE_VERTEX_FACE] = 0;
#endif
}
