/// \file
/// A plugin of a solver in single precision, which needs primitives that are apart at t=0.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "single_precision"; }

/// Queries arrive rounded to float, so no conversion below rounds.
void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->is_float = 1;
  promise->starts_apart = 0.0;
  promise->times = TOUCHSTONE_TIMES_ESTIMATES;
  promise->time_error = 1e-6;
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::FloatPoints start, end;
  for (int i = 0; i < 12; ++i) {
    start[i / 3][i % 3] = static_cast<float>(coordinates[i]);
    end[i / 3][i % 3] = static_cast<float>(coordinates[12 + i]);
  }
  float toi = 0.0F;
  const bool collides = kind == TOUCHSTONE_VERTEX_FACE ? yours::vertex_face(start, end, toi)
                                                       : yours::edge_edge(start, end, toi);
  answer->verdict = collides ? TOUCHSTONE_YES : TOUCHSTONE_NO;
  if (collides) answer->toi_lower = static_cast<double>(toi);
}
