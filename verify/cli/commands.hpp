#pragma once

/// \file
/// The subcommands of `touchstone`. Each adds itself to the command line; its callback runs
/// the command and sets the exit status.

namespace CLI {  // NOLINT(readability-identifier-naming): the parser's
class App;
}

namespace touchstone::verify::cli {

/// A command of the command line, or all of it: the parser's, through verify/cli/option_table.hpp.
using Command = CLI::App;

/// Outcome of a run, used as the exit status.
enum class Status : int {
  all_well = 0,
  /// A wrong recorded answer, a broken promise of a solver, or a collision in a step, an
  /// intersection.
  wrong_answers = 1,
  bad_input = 2,      ///< invalid input or usage
  interrupted = 130,  ///< by a signal; the results so far are reported
};

// The command `touchstone certify`, and so on with the other commands.
// clang-format off
namespace certify_command { void add(Command& app, Status& status); }
namespace solve_command { void add(Command& app, Status& status); }
namespace prove_command { void add(Command& app, Status& status); }
namespace generate_command { void add(Command& app, Status& status); }
namespace bench_command { void add(Command& app, Status& status); }
namespace fuzz_command { void add(Command& app, Status& status); }
namespace intersections_command { void add(Command& app, Status& status); }
namespace step_command { void add(Command& app, Status& status); }
namespace view_command { void add(Command& app, Status& status); }
namespace merge_command { void add(Command& app, Status& status); }
// clang-format on

/// Adds all subcommands.
inline void add_commands(Command& app, Status& status) {
  for (const auto add :
       {certify_command::add, solve_command::add, prove_command::add, generate_command::add,
        step_command::add, intersections_command::add, bench_command::add, fuzz_command::add,
        merge_command::add, view_command::add}) {
    add(app, status);
  }
}

}  // namespace touchstone::verify::cli
