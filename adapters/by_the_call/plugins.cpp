/// \file
/// The adapters that take one pair as plugins, so that `touchstone bench --plugin` times them: for
/// each query a call of C's touchstone_solve or, with TICCD, of a function of Tight-Inclusion's
/// interface. `./run results point_of_use` measures both.

#include <cstdint>

#include "touchstone/plugin.h"
#ifdef TICCD
#include <array>
#include <limits>

#include "tight_inclusion/ccd.hpp"
#else
#include "touchstone/touchstone.h"
#endif

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

#ifdef TICCD

const char* touchstone_plugin_name() { return "tight_inclusion_adapter"; }

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  std::array<ticcd::Vector3, 8> x;
  for (ticcd::Vector3& point : x) {
    point = ticcd::Vector3::Map(coordinates);
    coordinates += 3;
  }
  const auto& ask = kind == TOUCHSTONE_VERTEX_FACE ? ticcd::vertexFaceCCD : ticcd::edgeEdgeCCD;
  ticcd::Scalar toi = std::numeric_limits<ticcd::Scalar>::infinity(), tolerance = 0;
  const bool collides =
      ask(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], ticcd::Array3::Constant(-1),
          options->min_separation, toi, options->tolerance, options->t_max, -1, tolerance, true,
          ticcd::CCDRootFindingMethod::BREADTH_FIRST_SEARCH);
  answer->verdict = collides ? TOUCHSTONE_YES : TOUCHSTONE_NO;
  if (collides) answer->toi_lower = toi;
}

#else

const char* touchstone_plugin_name() { return "c_function"; }

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  TouchstoneOptions asked = touchstone_default_options();
  asked.min_separation = options->min_separation;
  asked.norm = options->norm;
  asked.t_max = options->t_max;
  asked.max_threads = 1;
  TouchstoneImpact impact;
  if (touchstone_solve(kind, 1, coordinates, &asked, &impact) != TOUCHSTONE_OK) return;
  answer->verdict = impact.verdict;
  answer->toi_lower = impact.toi_lower;
  answer->toi_upper = impact.toi_upper;
}

#endif
