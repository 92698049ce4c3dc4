/// \file
/// A plugin that is undecided about everything. At the call that TOUCHSTONE_TEST_CALL names, of
/// each process, it ends its parent as SIGTERM does: an interrupt during the work, whatever the
/// machine's load.

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>

#include "touchstone/plugin.h"

namespace {

/// What asks it refuses to let it send signals. That of a pipe in which something arrives comes
/// from the system.
void interrupt_parent() {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return;
  ::fcntl(ends[0], F_SETOWN, ::getppid());
  ::fcntl(ends[0], F_SETSIG, SIGTERM);
  ::fcntl(ends[0], F_SETFL, O_ASYNC);
  if (::write(ends[1], "x", 1) != 1) std::abort();
}

}  // namespace

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "interrupts_its_parent"; }

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer* answer) {
  static long calls = 0;
  const char* const call = std::getenv("TOUCHSTONE_TEST_CALL");
  if (++calls == (call == nullptr ? 1 : std::atol(call))) interrupt_parent();
  answer->verdict = TOUCHSTONE_UNDECIDED;
}
