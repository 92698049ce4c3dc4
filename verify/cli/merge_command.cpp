// touchstone merge: the results of pieces as one.

#include <memory>
#include <string>

#include "verify/cli/commands.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/sharded_run.hpp"

namespace touchstone::verify::cli::merge_command {
namespace {

struct Arguments {
  std::string folder;
  std::string json_file;
};

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("merge", "Join the results of a run in pieces (--resume) into one");
  command->option_defaults()->group("Input");
  add_option(*command, "FOLDER", arguments->folder);
  command->option_defaults()->group("Output");
  add_option(*command, "--json", arguments->json_file);
  set_help(
      *command,
      "touchstone merge run   # of touchstone certify data --shard 0/2 --resume run --json "
      "all.json",
      "Writes the files that the command line of the run named. The result has no times and "
      "does not depend on the order of the pieces. A missing or damaged piece, one of another run "
      "or version, and one with a changed input is an error that names it. Run it where the "
      "pieces ran: their inputs are checked again.\n"
      "Exit status: 0 success, 1 wrong answers or collisions in a piece, or a solver that "
      "hangs at more than 1 % of all queries, 2 pieces are missing or invalid, or a "
      "solver answers nothing, 130 interrupted (nothing is written).");
  command->callback(
      [arguments, &status] { status = merge_pieces(arguments->folder, arguments->json_file); });
}

}  // namespace touchstone::verify::cli::merge_command
