/// \file
/// Plugins that do one thing, which BEHAVIOUR names.

#include <cstdint>
#include <cstdlib>

#include "touchstone/plugin.h"

namespace {

enum Behaviour {
  always_no,
  always_yes,          // with tolerance 0
  wrong_with_options,  // misses everything, but only if it is called with certain options
  old_version,         // whose options end before the norm
  wrong_version,       // that does not exist
  latin_name,          // the environment's TOUCHSTONE_PLUGIN_NAME, or otherwise not UTF-8
  without_name,        // but two lines
  without_solve,       // and with WITHOUT_SOLVE
  states_terms,        // a promise of which nothing is usual, and answers nothing
  states_nonsense      // a promise out of range
};

constexpr Behaviour behaviour = BEHAVIOUR;

#define TEXT(name) #name
#define TEXT_OF(name) TEXT(name)

}  // namespace

std::int32_t touchstone_plugin_version() {
  if (behaviour == old_version) return 1;
  return TOUCHSTONE_PLUGIN_VERSION + (behaviour == wrong_version ? 41 : 0);
}

const char* touchstone_plugin_name() {
  if (behaviour == without_name) return "two\nlines";
  if (behaviour != latin_name) return TEXT_OF(BEHAVIOUR);
  const char* const name = std::getenv("TOUCHSTONE_PLUGIN_NAME");  // NOLINT(concurrency-mt-unsafe)
  return name == nullptr ? "caf\xe9" : name;
}

#ifndef WITHOUT_SOLVE
void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  if (behaviour == always_no) answer->verdict = TOUCHSTONE_NO;
  if (behaviour == always_yes) *answer = {TOUCHSTONE_YES, 0.0, answer->toi_upper, 0.0};
  if (behaviour == old_version) {
    answer->verdict = TOUCHSTONE_YES;
    answer->toi_lower = options->min_separation;
    answer->toi_upper = options->t_max;
  }
  if (behaviour == wrong_with_options) {
    const bool wrong = options->tolerance == 0.125 && options->max_checks == 77 &&
                       options->min_separation == 0.25 && options->norm == TOUCHSTONE_L2 &&
                       options->t_max == 1.0;
    answer->verdict = wrong ? TOUCHSTONE_NO : TOUCHSTONE_UNDECIDED;
  }
}
#endif

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  if (behaviour != states_terms && behaviour != states_nonsense) return;
  promise->promise = TOUCHSTONE_PROMISES_EXACT;
  promise->kinds[TOUCHSTONE_VERTEX_FACE] = behaviour == states_nonsense ? 0 : 1;
  promise->kinds[TOUCHSTONE_EDGE_EDGE] = 0;
  promise->elements[1] = behaviour == states_nonsense ? 0 : 1;
  promise->is_float = 1;
  promise->times = TOUCHSTONE_TIMES_ESTIMATES;
  promise->starts_apart = 0.5;
  promise->time_error = 0.25;
}
