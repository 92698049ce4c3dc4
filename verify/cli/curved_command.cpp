// touchstone curved: queries on Bézier curves.

#include <memory>

#include "verify/cli/commands.hpp"
#include "verify/cli/curved_run.hpp"
#include "verify/cli/help.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"

namespace touchstone::verify::cli::curved_command {

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<CurvedArguments>();
  CLI::App* command = app.add_subcommand(
      "curved", "Decide queries on Bézier curves exactly, and judge the certified solver");
  command->option_defaults()->group("Input");
  command
      ->add_option(
          "FILES", arguments->paths,
          "Files .npy of shape (N, K+1, 4, 3 or 4), or .csv; default: families of known truth")
      ->type_name("");
  command->add_option("--count", arguments->count, "Queries of each family and kind")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(1, 1'000'000));
  add_seed_option(*command, arguments->seed, "Seed of the families");
  command->add_flag("--others", arguments->judges_others,
                    "Judge also tight_inclusion, subdivision, sampling and advancement");
  add_kind_option(*command, arguments->kind, "vertex-face or edge-edge, if the path does not tell");
  add_separation_options(*command, arguments->separation);
  command->add_option("--threads", arguments->threads, "Cores to use (0: all)")
      ->type_name("N")
      ->capture_default_str();
  command->option_defaults()->group("Solver");
  add_plugin_option(*command, arguments->judged);
  add_solver_limits(*command, arguments->judged);
  add_exact_flag(*command, arguments->judged);
  command->option_defaults()->group("Output");
  command
      ->add_option("--proof", arguments->proof_file,
                   "Write certificates for touchstone-check; compressed if it ends in .zst")
      ->type_name("FILE");
  add_json_option(*command, arguments->json_file);
  set_help(
      *command,
      "touchstone curved --others --plugin mine.so\n"
      "touchstone curved curves.csv --kind edge-edge --proof curves.cert",
      "A row of an array has the control points of a query from t=0 to t=1, each of the four "
      "points, with weights last if the curves are rational. A file of CSV begins with "
      "degree,K or rational,K.\n"
      "Exit status: 0 success, 1 an answer of ours is wrong, or a plugin breaks its promise "
      "or hangs at more than 1 % of its queries, 2 bad input or usage, or a plugin that answers "
      "nothing, 130 interrupted.");
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, false, arguments->judged);
    status = run_curves(*arguments);
  });
}

}  // namespace touchstone::verify::cli::curved_command
