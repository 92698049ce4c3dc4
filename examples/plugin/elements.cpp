/// \file
/// A plugin of a solver that answers when elements invert: tetrahedra, and triangles in the plane.

#include <cstdint>
#include <cstring>

#include "touchstone/plugin.h"
#include "your_solver.hpp"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "elements"; }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->kinds[TOUCHSTONE_VERTEX_FACE] = promise->kinds[TOUCHSTONE_EDGE_EDGE] = 0;
  if (promise->size < sizeof *promise) return;  // a judge that asks about contact alone
  promise->elements[0] = promise->elements[1] = 1;
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  yours::Points start, end;
  std::memcpy(start, coordinates, sizeof start);
  std::memcpy(end, coordinates + 12, sizeof end);
  const bool inverts = kind == TOUCHSTONE_TETRAHEDRON
                           ? yours::tetrahedron(start, end, answer->toi_lower)
                           : yours::plane_triangle(start, end, answer->toi_lower);
  answer->verdict = inverts ? TOUCHSTONE_YES : TOUCHSTONE_NO;
}
