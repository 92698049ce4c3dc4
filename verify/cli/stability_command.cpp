// touchstone stability: solvers on queries of growing difficulty.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/generate/hardness.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/report/report_page.hpp"
#include "verify/report/stability.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::cli::stability_command {
namespace {

struct Arguments {
  SolverArguments judged;
  SeparationArguments separation;
  std::vector<std::string> hardnesses;
  std::uint64_t seed = default_seed;
  std::uint64_t count = report::StabilityOptions{}.count;
  unsigned threads = 0;
  double seconds = 0.0;
  std::string json_file;
  std::string picture_file;
};

/// The named kinds of difficulty, in their usual order; by default those on straight lines or, for
/// solvers that answer none of these, on curves.
std::vector<const generate::Hardness*> chosen(const std::vector<std::string>& names,
                                              const Solvers& solvers) {
  for (const std::string& name : names) static_cast<void>(generate::hardness_from_name(name));
  const bool is_straight = std::ranges::any_of(
      solvers.all(), [](const solvers::Solver* solver) { return solver->terms().straight; });
  const auto usual = is_straight ? generate::hardnesses() : generate::curve_hardnesses();
  std::vector<const generate::Hardness*> result;
  for (const generate::Hardness& hardness : names.empty() ? usual : generate::all_hardnesses()) {
    const bool is_named = std::ranges::find(names, hardness.name) != names.end();
    if (names.empty() || is_named) result.push_back(&hardness);
  }
  return result;
}

/// All methods except the baselines, if the user names no solver.
SolverArguments judged_by(const Arguments& arguments) {
  SolverArguments judged = arguments.judged;
  if (!judged.empty()) return judged;
  for (const auto& method : solvers::methods()) {
    if (!method->info().is_baseline) judged.methods.emplace_back(method->name());
  }
  return judged;
}

report::StabilityResult measure(const Arguments& arguments, const Solvers& solvers) {
  io::ProgressBar bar("stability");
  report::StabilityOptions options{.hardnesses = chosen(arguments.hardnesses, solvers),
                                   .seed = arguments.seed,
                                   .count = arguments.count,
                                   .seconds = arguments.seconds};
  options.certify.separation = arguments.separation.given();
  options.certify.threads = arguments.threads;
  options.certify.solvers = solvers.all();
  options.certify.on_progress = [&bar](double fraction) { bar.update(fraction); };
  options.certify.stop = &io::interrupted();
  return report::measure_stability(options);
}

Status run(const Arguments& arguments) {
  Files files;
  Solvers solvers(files, judged_by(arguments));
  solvers.report_norms(arguments.separation.given());
  Output json(files, arguments.json_file), picture(files, arguments.picture_file);
  const report::StabilityResult result = measure(arguments, solvers);
  for (const jobs::MethodResult& method : result.total.methods) {
    report_unplaced_crashes(method.name, method.judgement.unplaced_crashes);
  }
  solvers.report_output(arguments.judged.show_output);
  // Files first, so that they are complete even if standard output is closed.
  if (json) json.complete(io::json_document(report::to_json(result)));
  picture.complete_with([&] { return report::stability_page(result, command_line()); });
  io::print(files.summary_stream(), report::to_text(result));
  if (files.has_failed()) return Status::bad_input;
  if (jobs::has_wrong_answers(result.total)) return Status::wrong_answers;
  if (io::interrupted()) return Status::interrupted;
  Status status = Status::all_well;
  for (const jobs::MethodResult& method : result.total.methods) {
    status = worse(status, status_of(method.name, Responses::of(method.judgement)));
  }
  return status;
}

void add_options(CLI::App& command, Arguments& arguments) {
  add_solver_options(command, arguments.judged);
  add_option(command, "--exact", arguments.judged.exact);
  add_option(command, "--seconds", arguments.seconds);
  command.option_defaults()->group("Queries");
  add_option(command, "--hardness", arguments.hardnesses);
  add_option(command, "--seed", arguments.seed);
  add_option(command, "--count", arguments.count);
  add_option(command, "--threads", arguments.threads);
  add_separation_options(command, arguments.separation);
  command.option_defaults()->group("Output");
  add_option(command, "--json", arguments.json_file);
  add_option(command, "--picture", arguments.picture_file);
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("stability", "Judge solvers on queries of growing difficulty");
  add_options(*command, *arguments);
  std::string list;
  for (const generate::Hardness& hardness : generate::all_hardnesses()) {
    list += fmt::format("{}{} ({}, {} to {})", list.empty() ? "" : "; ", hardness.name,
                        hardness.measure, generate::level_text(hardness, hardness.levels.front()),
                        generate::level_text(hardness, hardness.levels.back()));
  }
  set_help(
      *command, "touchstone stability --method tight_inclusion --picture stability.html",
      "Queries with one kind of difficulty, at several levels: " + list +
          ". Half of them collide. Those on curves are asked if they are named, or if no "
          "solver takes straight lines. By default all built-in solvers except the baselines are "
          "judged.\n" +
          std::string(answering_statuses));
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, true, arguments->judged);
    settle_query_limit(*command, arguments->seconds, arguments->judged);
    status = run(*arguments);
  });
}

}  // namespace touchstone::verify::cli::stability_command
