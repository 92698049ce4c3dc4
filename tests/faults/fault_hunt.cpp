/// \file
/// The table of planted faults in solvers: the fuzzer hunts each, with its time and number of
/// queries. Exit status 1 if a fault that should be found is not, or if a harmless one is.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

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

int run(const std::vector<std::string>& names, const HuntOptions& options) {
  std::vector<const FaultySolver*> chosen;
  chosen.reserve(faulty_solvers().size() + names.size());
  for (const std::string& name : names) chosen.push_back(&find_faulty_solver(name));
  if (names.empty()) {
    for (const FaultySolver& solver : faulty_solvers()) chosen.push_back(&solver);
  }
  fmt::print("{:<30} {:<16} {:>8} {:>10}  {:<46} {}\n", "fault", "of", "seconds", "queries",
             "found as", "what");
  std::size_t wrong = 0;
  for (const FaultySolver* const solver : chosen) {
    if (!print(*solver, hunt(*solver, options))) ++wrong;
  }
  fmt::print("{} faults, {} not as they should be\n", chosen.size(), wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace touchstone::tests

int main(int argc, char** argv) {
  touchstone::tests::HuntOptions options;
  std::vector<std::string> names;
  CLI::App app("Hunts the faults that are planted in solvers: tests/faults/faults.txt");
  app.footer("Example: fault_hunt --seconds 10 filter_10 axis_of_start");
  app.add_option("NAME", names, "faults; without a name all that this build plants");
  app.add_option("--seconds", options.seconds, "for each fault (60)")->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "of the fuzzer (1)");
  CLI11_PARSE(app, argc, argv);
  try {
    return touchstone::tests::run(names, options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fault_hunt: {}\n", error.what());
    return 2;
  }
}
