#include "verify/cli/commands.hpp"

namespace touchstone::verify::cli {

void add_commands(CLI::App& app, Status& status) {
  for (const auto add :
       {certify_command::add, solve_command::add, prove_command::add, generate_command::add,
        candidates_command::add, step_command::add, intersections_command::add, bench_command::add,
        fuzz_command::add, convert_command::add, merge_command::add, stability_command::add,
        report_command::add, view_command::add, derive_command::add}) {
    add(app, status);
  }
}

}  // namespace touchstone::verify::cli
