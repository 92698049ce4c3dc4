// The command line: one subcommand a job.

#include <cstdio>
#include <exception>
#include <stdexcept>

#include "fast/arithmetic_check.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"

namespace {

using touchstone::verify::cli::Status;

int run(int argc, char** argv) {
  CLI::App app{"Touchstone: whether and when two moving primitives touch, exactly."};
  app.footer(
      "Exit status: 0 all is well, 1 wrong answers found, 2 bad input or usage, 130 interrupted.\n"
      "Example: touchstone certify path/to/queries");
  app.set_version_flag("--version", TOUCHSTONE_VERSION);
  app.require_subcommand(1);
  Status status = Status::all_well;
  touchstone::verify::cli::add_certify_command(app, status);
  touchstone::verify::cli::add_solve_command(app, status);
  touchstone::verify::cli::add_prove_command(app, status);
  touchstone::verify::cli::add_generate_command(app, status);
  touchstone::verify::cli::add_candidates_command(app, status);
  touchstone::verify::cli::add_bench_command(app, status);
  touchstone::verify::cli::add_fuzz_command(app, status);
  touchstone::verify::cli::add_stability_command(app, status);
  touchstone::verify::cli::add_report_command(app, status);
  touchstone::verify::cli::add_derive_command(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return static_cast<int>(code == 0 ? Status::all_well : Status::bad_input);
  }
  return static_cast<int>(status);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    touchstone::fast::require_strict_arithmetic();
    const int status = run(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw std::runtime_error("standard output: cannot be written");
    }
    return status;
  } catch (const std::exception& error) {
    touchstone::verify::cli::report_error(error.what());
    return static_cast<int>(Status::bad_input);
  }
}
