/// \file
/// A plugin of a solver that answers vertex-face queries alone.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "vertex_face_alone"; }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->kinds[TOUCHSTONE_EDGE_EDGE] = 0;
  promise->times = TOUCHSTONE_TIMES_NONE;
}

/// No other kind is asked.
void touchstone_plugin_solve(std::int32_t, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::Points start, end;
  std::memcpy(start, coordinates, sizeof start);
  std::memcpy(end, coordinates + 12, sizeof end);
  answer->verdict = yours::vertex_face(start, end) ? TOUCHSTONE_YES : TOUCHSTONE_NO;
}
