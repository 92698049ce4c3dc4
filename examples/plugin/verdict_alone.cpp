/// \file
/// A plugin of a solver that answers yes or no, and gives no time.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "verdict_alone"; }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->times = TOUCHSTONE_TIMES_NONE;
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::Points start, end;
  std::memcpy(start, coordinates, sizeof start);
  std::memcpy(end, coordinates + 12, sizeof end);
  const bool collides = kind == TOUCHSTONE_VERTEX_FACE ? yours::vertex_face(start, end)
                                                       : yours::edge_edge(start, end);
  answer->verdict = collides ? TOUCHSTONE_YES : TOUCHSTONE_NO;
}
