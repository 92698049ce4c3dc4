#pragma once

/// \file
/// The subcommands of `touchstone`. Each adds itself to the command line; its callback runs
/// the command and sets the exit status.

#include <CLI/CLI.hpp>

namespace touchstone::verify::cli {

/// Outcome of a run, used as the exit status.
enum class Status : int {
  all_well = 0,
  /// A wrong recorded answer, a broken promise of a solver, or a collision in a step.
  wrong_answers = 1,
  bad_input = 2,      ///< invalid input or usage
  interrupted = 130,  ///< by a signal; the results so far are reported
};

/// `touchstone certify`
void add_certify_command(CLI::App& app, Status& status);

/// `touchstone solve`
void add_solve_command(CLI::App& app, Status& status);

/// `touchstone prove`
void add_prove_command(CLI::App& app, Status& status);

/// `touchstone generate`
void add_generate_command(CLI::App& app, Status& status);

/// `touchstone bench`
void add_bench_command(CLI::App& app, Status& status);

/// `touchstone fuzz`
void add_fuzz_command(CLI::App& app, Status& status);

/// `touchstone stability`
void add_stability_command(CLI::App& app, Status& status);

/// `touchstone report`
void add_report_command(CLI::App& app, Status& status);

/// `touchstone candidates`
void add_candidates_command(CLI::App& app, Status& status);

/// `touchstone step`
void add_step_command(CLI::App& app, Status& status);

/// `touchstone view`
void add_view_command(CLI::App& app, Status& status);

/// `touchstone derive`
void add_derive_command(CLI::App& app, Status& status);

}  // namespace touchstone::verify::cli
