/// \file
/// A plugin whose first coordinate selects its action, from right answers to the worst failures.
/// Queries on curves have it act in the same way, but what it repeats of a query is its shape.
/// With BATCH it takes many queries at once, and says by the tolerance of a no how many.

#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/verify/solvers/plugins/misbehaviour.hpp"
#include "touchstone/plugin.h"

namespace {

using touchstone::tests::Misbehaviour;
using enum Misbehaviour;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The sanitizer must not stop this before it happens.
[[gnu::no_sanitize("undefined")]] void write_to_null() {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;  // NOLINT(clang-analyzer-core.NullDereference): meant
}

[[noreturn]] void hang() {
  for (volatile bool go_on = true;;) static_cast<void>(go_on);
}

[[noreturn]] void sleep_for_ever() {
  for (;;) ::pause();
}

[[noreturn]] void write_without_end() {
  std::ofstream file("large");
  for (const std::string text(4096, 'x');;) file << text;
}

/// Makes a few processes.
void fork_often() {
  for (int i = 0; i < 8; ++i) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    if (child < 0) throw std::runtime_error("fork is refused");
  }
}

/// True in the copy; in the other after its end.
bool copy() {
  const pid_t child = ::fork();
  if (child == 0) return true;
  ::waitpid(child, nullptr, 0);
  return false;
}

/// True if the system lets this process signal its parent, by one of several ways.
bool may_signal_parent() {
  const pid_t parent = ::getppid();
  return ::kill(parent, 0) == 0 || ::kill(-::getpgid(parent), 0) == 0 || ::kill(-1, 0) == 0 ||
         ::sigqueue(parent, 0, {}) == 0 || ::syscall(SYS_tgkill, parent, parent, 0) == 0 ||
         ::syscall(SYS_tkill, parent, 0) == 0 || ::syscall(SYS_pidfd_open, parent, 0) >= 0;
}

/// Allocates much memory without using it.
void allocate_much() {
  std::vector<std::unique_ptr<char[]>> blocks;
  for (int i = 0; i < 32; ++i) blocks.push_back(std::make_unique_for_overwrite<char[]>(1U << 26U));
}

/// The number of calls, for the action that dies at one of them.
int calls = 0;

/// Acts that end without an answer.
void fail(Misbehaviour what) {
  if (what == dies_at_call_1500 && ++calls == 1500) std::abort();
  if (what == throws) throw std::runtime_error("thrown by a plugin");
  if (what == throws_a_number) throw 7;
  if (what == exits_with_3) std::exit(3);
  if (what == exits_at_once) ::_exit(0);
  if (what == kills_itself) std::raise(SIGKILL);
  if (what == writes_without_end) write_without_end();
  if (what == closes_all) ::syscall(SYS_close_range, 0, ~0U, 0U);
  if (what == closes_all || what == sleeps) sleep_for_ever();
  if (what == aborts) std::abort();
  if (what == hangs) hang();
  if (what == writes_to_null) write_to_null();
}

/// Acts before the answer no; true if it is yes instead.
bool act(Misbehaviour what) {
  if (what == forks) fork_often();
  if (what == copies_itself) return copy();
  if (what == signals_parent) return may_signal_parent() || ::kill(::getpid(), 0) != 0;
  if (what == allocates) allocate_much();
  if (what == prints) {
    std::puts("printed by a plugin\x1b[31m");
    std::fputs("and as error\n", stderr);
  }
  return what == writes_a_file && !(std::ofstream("written_by_a_plugin") << "x");
}

/// The answers of those that only answer.
const std::map<Misbehaviour, TouchstonePluginAnswer> answers_alone{
    {yes_with_tolerance_0, {TOUCHSTONE_YES, 0.0, nan, 0.0}},
    {says_no_with_toi, {TOUCHSTONE_NO, 0.25, 0.5, 1e-9}},
    {is_undecided, {TOUCHSTONE_UNDECIDED, nan, nan, nan}},
    {verdict_too_large, {TOUCHSTONE_ERROR + 1, 0.25, 0.5, 1e-9}},
    {verdict_negative, {-1, 0.25, 0.5, 1e-9}},
    {infinite_toi_lower, {TOUCHSTONE_YES, -infinity, 0.5, 1e-9}},
    {infinite_toi_upper, {TOUCHSTONE_YES, 0.25, infinity, 1e-9}},
    {yes_without_toi, {TOUCHSTONE_YES, nan, nan, nan}},
    {negative_tolerance, {TOUCHSTONE_YES, 0.25, 0.5, -1e-9}},
    {nan_tolerance, {TOUCHSTONE_YES, 0.25, 0.5, nan}},
    {infinite_tolerance, {TOUCHSTONE_YES, 0.25, 0.5, infinity}}};

}  // namespace

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "misbehaving"; }

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  const auto what = static_cast<Misbehaviour>(static_cast<int>(coordinates[0]));
  fail(what);
  if (what == leaves_answer_alone) return;
  if (what == repeats_query) {
    *answer = {TOUCHSTONE_YES, coordinates[1], coordinates[23], static_cast<double>(kind)};
  } else if (what == repeats_norm) {
    *answer = {TOUCHSTONE_YES, static_cast<double>(options->norm), nan, nan};
  } else if (what == repeats_options) {
    *answer = {options->max_checks == 77 ? TOUCHSTONE_YES : TOUCHSTONE_NO, options->tolerance,
               options->min_separation, options->t_max};
  } else if (const auto known = answers_alone.find(what); known != answers_alone.end()) {
    *answer = known->second;
  } else {
    answer->verdict = act(what) ? TOUCHSTONE_YES : TOUCHSTONE_NO;
  }
}

void touchstone_plugin_solve_curved(std::int32_t kind, std::int32_t degree,
                                    std::int32_t is_rational, const double* control,
                                    const TouchstonePluginOptions* options,
                                    TouchstonePluginAnswer* answer) {
  touchstone_plugin_solve(kind, control, options, answer);
  if (static_cast<int>(control[0]) != static_cast<int>(repeats_query)) return;
  answer->toi_lower = kind + 10 * degree + 100 * is_rational;
  answer->toi_upper = control[(degree + 1) * 4 * (3 + is_rational) - 1];
}

#ifdef BATCH
void touchstone_plugin_solve_batch(std::int32_t kind, std::int64_t count, const double* coordinates,
                                   const TouchstonePluginOptions* options,
                                   TouchstonePluginAnswer* answers) {
  for (std::int64_t i = 0; i < count; ++i) {
    touchstone_plugin_solve(kind, coordinates + 24 * i, options, &answers[i]);
    if (answers[i].verdict == TOUCHSTONE_NO) answers[i].tolerance = static_cast<double>(count);
  }
}
#endif
