/// \file
/// A plugin of a solver that takes start and end of each point beside each other.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "interleaved"; }

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::Trajectories points;
  for (int point = 0; point < 4; ++point) {
    for (int end = 0; end < 2; ++end) {
      std::memcpy(points[point][end], coordinates + 12 * end + 3 * point,
                  sizeof points[point][end]);
    }
  }
  double toi = 0.0;
  const bool collides = kind == TOUCHSTONE_VERTEX_FACE ? yours::vertex_face(points, toi)
                                                       : yours::edge_edge(points, toi);
  answer->verdict = collides ? TOUCHSTONE_YES : TOUCHSTONE_NO;
  if (collides) answer->toi_lower = toi;
}
