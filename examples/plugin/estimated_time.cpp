/// \file
/// A plugin of a solver whose time of impact is the nearest number that it finds, not a bound.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "estimated_time"; }

/// An error of the time up to 1e-9 of the step is no fault.
void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->times = TOUCHSTONE_TIMES_ESTIMATES;
  promise->time_error = 1e-9;
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::Points start, end;
  std::memcpy(start, coordinates, sizeof start);
  std::memcpy(end, coordinates + 12, sizeof end);
  double toi = 0.0;
  const bool collides = kind == TOUCHSTONE_VERTEX_FACE ? yours::vertex_face(start, end, toi)
                                                       : yours::edge_edge(start, end, toi);
  answer->verdict = collides ? TOUCHSTONE_YES : TOUCHSTONE_NO;
  if (collides) answer->toi_lower = toi;
}
