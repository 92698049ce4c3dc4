// touchstone merge: the results of the parts of a run as one.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/sharded_run.hpp"

namespace touchstone::verify::cli::merge_command {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> parts;
  std::string json_file;
};

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command =
      add_command(app, "merge", "Add up the results of all parts of a run (--shard)");
  begin_group(*command, "Input");
  add_option(*command, "parts", arguments->parts);
  begin_group(*command, "Output");
  add_option(*command, "--json", arguments->json_file);
  set_help(*command,
           "touchstone merge run/*.json   # of certify data --shard I/N --json run/I.json",
           "The sum has no times and means. A part that is missing or there twice, and one of "
           "another run, is an error that names it: version, options, the contents of files that "
           "options name, and the names and sizes of all inputs must agree.\n" +
               std::string(answering_statuses));
  set_action(*command, [arguments, &status] {
    status = merge_shards(arguments->parts, arguments->json_file);
  });
}

}  // namespace touchstone::verify::cli::merge_command
