// The command line: one subcommand for each job.

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <new>

#include "fast/platform/arithmetic_check.hpp"
#include "touchstone/broad_phase.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/terminal.hpp"

namespace {

using touchstone::verify::cli::Status;

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

/// An interrupt before there was anything to keep.
int report_interrupt() {
  touchstone::verify::cli::report_error("interrupted");
  return static_cast<int>(Status::interrupted);
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
    const Status status = touchstone::verify::cli::run_command_line(argc, argv);
    touchstone::verify::io::finish_printing();
    return static_cast<int>(status);
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
