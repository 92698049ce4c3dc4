/// \file
/// A plugin that says yes to everything. At the call that TOUCHSTONE_TEST_CALL names, of each
/// process, it interrupts its parent process: an interrupt during the work, whatever the machine's
/// load.

#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>

#include "touchstone/plugin.h"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "interrupts_its_parent"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer* answer) {
  static long calls = 0;
  const char* const call = std::getenv("TOUCHSTONE_TEST_CALL");
  if (++calls == (call == nullptr ? 1 : std::atol(call))) kill(getppid(), SIGINT);
  answer->verdict = TOUCHSTONE_UNDECIDED;
}
