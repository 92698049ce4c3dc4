/// \file
/// A plugin that acts as the environment says while it is loaded and asked for its name.

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "touchstone/plugin.h"

namespace {

bool is_told(std::string_view what) {
  const char* const told = std::getenv("TOUCHSTONE_TEST_LOADING");
  return told != nullptr && what == told;
}

/// Makes processes until that is refused. At most eight: without a limit the test fails, but the
/// machine is not overloaded.
void fork_without_end() {
  for (int i = 0; i < 8; ++i) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    if (child < 0) std::exit(errno);
  }
}

[[noreturn]] void hang() {
  for (;;) ::pause();
}

const bool is_constructed = [] {
  if (is_told("constructor exits")) std::exit(0);
  if (is_told("constructor crashes")) std::raise(SIGSEGV);
  if (is_told("constructor hangs")) hang();
  if (is_told("constructor forks")) fork_without_end();
  return true;
}();

}  // namespace

std::int32_t touchstone_plugin_version() {
  if (is_told("version exits")) std::exit(0);
  if (is_told("version throws")) throw std::runtime_error("no version");
  return TOUCHSTONE_PLUGIN_VERSION;
}

const char* touchstone_plugin_name() {
  if (is_told("name exits")) std::exit(0);
  if (is_told("name crashes")) std::raise(SIGSEGV);
  if (is_told("name hangs")) hang();
  return is_constructed ? "bad_loading" : "";
}

void touchstone_plugin_promise(TouchstonePluginPromise*) {
  if (is_told("promise throws")) throw std::runtime_error("no promise");
  if (is_told("promise hangs")) hang();
}

void touchstone_plugin_solve(std::int32_t, const double*, const TouchstonePluginOptions*,
                             TouchstonePluginAnswer* answer) {
  answer->verdict = TOUCHSTONE_NO;
}
