/// \file
/// The published method METHOD as a plugin. An exception counts as a collision, as in the
/// benchmark's harness ([wang2021]: CCD-Wrapper): that rule decides most answers of some methods
/// (bsc.cpp).

#include <algorithm>
#include <cstdint>
#include <new>

#include "fast/platform/floating_point_state.hpp"
#include "verify/published/published.hpp"

#define TEXT_OF(name) #name
#define NAME_OF(method) TEXT_OF(method)

namespace touchstone::verify::published {

Answer METHOD(ContactKind kind, const Query& query, const TouchstonePluginOptions& options);

}  // namespace touchstone::verify::published

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return NAME_OF(METHOD); }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->promise = PROMISE;
#ifdef IN_FLOAT
  promise->is_float = 1;
#endif
}

void touchstone_plugin_solve_batch(std::int32_t kind, std::int64_t count, const double* coordinates,
                                   const TouchstonePluginOptions* options,
                                   TouchstonePluginAnswer* answers) {
  using namespace touchstone;
  const fast::StrictFloatingPoint state;
  for (TouchstonePluginAnswer* answer = answers; answer != answers + count; ++answer) {
    Query query;
    std::copy_n(coordinates, query.coordinates.size(), query.coordinates.begin());
    coordinates += query.coordinates.size();
    try {
      const auto found = verify::published::METHOD(
          kind == TOUCHSTONE_VERTEX_FACE ? ContactKind::vertex_face : ContactKind::edge_edge, query,
          *options);
      answer->verdict = found.verdict;
      answer->toi_lower = found.toi;
      answer->tolerance = found.tolerance;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {
      answer->verdict = TOUCHSTONE_YES;
    }
  }
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  touchstone_plugin_solve_batch(kind, 1, coordinates, options, answer);
}
