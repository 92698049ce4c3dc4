/// \file
/// The table of planted faults in solvers: the fuzzer hunts each, with its time and number of
/// queries, for a minute at most. Exit status 1 if a fault that should be found is not, or if a
/// harmless one is.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include "tests/faults/hunt.hpp"

namespace touchstone::tests {
namespace {

std::string outcome(const FaultySolver& solver, const Hunt& hunt) {
  if (hunt.finding) {
    return fmt::format("{} by {}{}", verify::judge::to_string(hunt.finding->what),
                       hunt.finding->generator,
                       solver.fault.harmless.empty() ? "" : " (SHOULD BE HARMLESS)");
  }
  if (!solver.fault.rare.empty()) return "not found (rare)";
  return solver.fault.harmless.empty() ? "NOT FOUND" : "harmless";
}

/// Prints the hunt. True if its result is as it should be.
bool print(const FaultySolver& solver, const Hunt& hunt) {
  fmt::print("{:<30} {:<16} {:>8.2f} {:>10}  {:<46} {}\n", solver.fault.name, solver.of,
             hunt.seconds, hunt.queries, outcome(solver, hunt), solver.fault.what);
  const std::string_view why =
      solver.fault.harmless.empty() ? solver.fault.rare : solver.fault.harmless;
  if (!hunt.finding && !why.empty()) fmt::print("    {}\n", why);
  (void)std::fflush(stdout);
  if (hunt.finding) return solver.fault.harmless.empty();
  return !why.empty();
}

int run() {
  fmt::print("{:<30} {:<16} {:>8} {:>10}  {:<46} {}\n", "fault", "of", "seconds", "queries",
             "found as", "what");
  std::size_t wrong = 0;
  for (const FaultySolver& solver : faulty_solvers()) {
    if (!print(solver, hunt(solver, {}))) ++wrong;
  }
  fmt::print("{} faults, {} not as they should be\n", faulty_solvers().size(), wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace touchstone::tests

int main() {
  try {
    return touchstone::tests::run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "fault_hunt: {}\n", error.what());
    return 2;
  }
}
