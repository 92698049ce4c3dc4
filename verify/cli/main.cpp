// The command line: one subcommand for each job.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fast/platform/arithmetic_check.hpp"
#include "touchstone/broad_phase.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"

namespace {

using touchstone::verify::cli::set_help;
using touchstone::verify::cli::Status;
using touchstone::verify::cli::use_help_format;
using touchstone::verify::cli::version;
using touchstone::verify::io::print;

/// Replaces standard streams that were closed when the program began, so that no later file becomes
/// a standard stream and receives printed text. Writing to the replacement fails, as it would have
/// without it.
void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    // The system assigns the lowest free descriptor, which is this one.
    [[maybe_unused]] const int opened =
        ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// Reports an unknown subcommand, with the probably intended one.
bool report_unknown(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (std::ranges::find(names, word) != names.end()) return false;
  const std::string nearest = touchstone::verify::cli::nearest_name(word, names);
  touchstone::verify::cli::report_error(
      "no command " + word + "; " +
      (nearest.empty() ? "touchstone --help lists them" : "did you mean " + nearest + "?"));
  return true;
}

/// The reason of an error of usage, also of an option that takes one value and is given twice.
std::string reason_of(const CLI::Error& error) {
  const std::string reason = error.what();
  const std::size_t end = reason.find(": At Most 1 required but received ");
  return end == std::string::npos ? reason : reason.substr(0, end) + " is given more than once";
}

/// An interrupt before there was anything to keep.
int report_interrupt() {
  touchstone::verify::cli::report_error("interrupted");
  return static_cast<int>(Status::interrupted);
}

int run(int argc, char** argv) {
  CLI::App app{
      "Exact ground truth, verified solvers and test tools for continuous collision detection",
      "touchstone"};
  use_help_format(app);
  set_help(
      app, "touchstone certify path/to/queries",
      "touchstone COMMAND --help describes a command.\n"
      "Exit status: 0 success, 1 wrong answers, collisions or intersections, 2 bad input or usage, "
      "130 interrupted.");
  app.set_version_flag("--version", std::string(version()), "Print the version");
  // The message quotes the command line.
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return touchstone::verify::io::printable(reason_of(error)) +
           "\nRun with --help for more information.\n";
  });
  app.require_subcommand(0, 1);
  Status status = Status::all_well;
  touchstone::verify::cli::add_commands(app, status);
  if (argc > 1 && argv[1][0] != '-' && report_unknown(app, argv[1])) {
    return static_cast<int>(Status::bad_input);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are exceptions too.
    std::ostringstream help, reason;
    const int code = app.exit(error, help, reason);
    print(stdout, help.str());
    print(stderr, reason.str());
    return static_cast<int>(code == 0 ? Status::all_well : Status::bad_input);
  }
  if (app.get_subcommands().empty()) {
    print(stderr, app.help());
    return static_cast<int>(Status::bad_input);
  }
  return static_cast<int>(status);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    open_standard_streams();
    // A write to a pipe without a reader, or beyond the limit of a file's size, then fails.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    touchstone::fast::require_strict_arithmetic();
    // From here on a signal ends every command with its results so far.
    static_cast<void>(touchstone::verify::io::interrupted());
    const int status = run(argc, argv);
    touchstone::verify::io::finish_printing();
    return status;
  } catch (const touchstone::verify::io::Interrupted&) {
    return report_interrupt();
  } catch (const touchstone::fast::Stopped&) {
    return report_interrupt();
  } catch (const std::filesystem::filesystem_error& error) {
    touchstone::verify::cli::report_error(error.path1().string() + ": " + error.code().message());
    return static_cast<int>(Status::bad_input);
  } catch (const std::bad_alloc&) {
    touchstone::verify::cli::report_error("not enough memory; a smaller part of the input may fit");
    return static_cast<int>(Status::bad_input);
  } catch (const std::exception& error) {
    touchstone::verify::cli::report_error(error.what());
    return static_cast<int>(Status::bad_input);
  }
}
