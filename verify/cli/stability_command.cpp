// touchstone stability: how solvers bear hardness.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/report/page.hpp"
#include "verify/report/stability_report.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/stability/hardness.hpp"
#include "verify/stability/stability.hpp"

namespace touchstone::verify::cli {
namespace {

struct Arguments {
  SolverArguments judged;
  SeparationArguments separation;
  std::vector<std::string> hardnesses;
  std::uint64_t seed = default_seed;
  std::uint64_t count = stability::StabilityOptions{}.count;
  unsigned threads = 0;
  std::string json_file;
  std::string picture_file;
};

/// Those that are named, in their own order; all if none is.
std::vector<const stability::Hardness*> chosen(const std::vector<std::string>& names) {
  std::vector<const stability::Hardness*> result;
  for (const std::string& name : names) static_cast<void>(stability::hardness_from_name(name));
  for (const stability::Hardness& hardness : stability::hardnesses()) {
    const auto is_it = [&](const std::string& name) { return name == hardness.name; };
    if (names.empty() || std::ranges::any_of(names, is_it)) result.push_back(&hardness);
  }
  return result;
}

/// Where the user names no solver, all methods but the baselines.
SolverArguments judged_by(const Arguments& arguments) {
  SolverArguments judged = arguments.judged;
  if (!judged.empty()) return judged;
  for (const auto& method : solvers::methods()) {
    if (!method->info().is_baseline) judged.methods.emplace_back(method->name());
  }
  return judged;
}

/// \throws std::runtime_error if a file is named twice.
void check_names(const Arguments& arguments, const ReportedOutput& json,
                 const ReportedOutput& picture) {
  if (json.is(arguments.picture_file)) {
    throw std::runtime_error(arguments.picture_file + ": named for two outputs");
  }
  for (const std::filesystem::path& file : arguments.judged.files()) {
    if (json.is(file) || picture.is(file)) {
      throw std::runtime_error(file.string() + ": named for input and output");
    }
  }
}

stability::StabilityResult measure(const Arguments& arguments, const Solvers& solvers) {
  io::ProgressBar bar("stability");
  return stability::measure_stability(
      chosen(arguments.hardnesses),
      {.separation = arguments.separation.given(),
       .seed = arguments.seed,
       .count = arguments.count,
       .threads = arguments.threads,
       .solvers = solvers.all(),
       .on_progress = [&bar](double fraction) { bar.update(fraction); },
       .stop = &io::interrupted()});
}

Status run(const Arguments& arguments) {
  const Solvers solvers(judged_by(arguments));
  ReportedOutput json(arguments.json_file);
  ReportedOutput picture(arguments.picture_file);
  check_names(arguments, json, picture);
  const stability::StabilityResult result = measure(arguments, solvers);
  for (const jobs::MethodResult& method : result.total.methods) {
    report_unplaced_crashes(method.name, method.judgement.unplaced_crashes);
  }
  solvers.report_output(arguments.judged.show_output);
  // Files first: a closed standard output must not cost them.
  if (json) json.write(io::json_document(report::to_json(result)));
  json.close();
  if (picture) picture.write(report::stability_page(result, command_line()));
  picture.close();
  const bool is_standard_output = json.is_standard_output() || picture.is_standard_output();
  io::print(is_standard_output ? stderr : stdout, report::to_text(result));
  if (stability::has_wrong_answers(result)) return Status::wrong_answers;
  if (json.failed() || picture.failed()) return Status::bad_input;
  return io::interrupted() ? Status::interrupted : Status::all_well;
}

void add_options(CLI::App& command, Arguments& arguments) {
  add_solver_options(command, arguments.judged);
  command.add_flag("--exact", arguments.judged.exact,
                   "Hold every solver to exactness: false positives are wrong answers too");
  std::string names;
  for (const stability::Hardness& hardness : stability::hardnesses()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", hardness.name);
  }
  command.add_option("--hardness", arguments.hardnesses, "Only these of " + names)
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_option("--seed", arguments.seed, "Seed of the queries")
      ->capture_default_str()
      ->check(whole_number(0, UINT64_MAX));
  command.add_option("--count", arguments.count, "Queries a hardness, level and kind")
      ->capture_default_str()
      ->check(whole_number(1, UINT64_MAX));
  command.add_option("--threads", arguments.threads, "Cores to use (0: all)")
      ->capture_default_str();
  add_separation_options(command, arguments.separation);
  command.add_option("--json", arguments.json_file, "Write the result as JSON")->type_name("FILE");
  command
      .add_option("--picture", arguments.picture_file,
                  "Draw the result as a heat map: a page (HTML) that any browser shows")
      ->type_name("FILE.html");
}

}  // namespace

void add_stability_command(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "stability", "Map what solvers get wrong, and how long they take, as queries get harder");
  add_options(*command, *arguments);
  std::string list;
  for (const stability::Hardness& hardness : stability::hardnesses()) {
    list += fmt::format("  {:<9} {}: 2^{} to 2^{}\n", hardness.name, hardness.measure,
                        hardness.exponents.front(), hardness.exponents.back());
  }
  command->footer(
      "Queries that are hard in one way, at eleven levels each, and mild in all others:\n" + list +
      "Half of them collide. The truth is that of the certified solver, checked by the oracle on "
      "all.\n"
      "Without --method or --plugin all our methods are judged but the baselines.\n"
      "Exit status: 0 all solvers keep their promise, 1 some do not, 2 bad usage, 130 interrupted\n"
      "(what is done by then is reported and written).\n"
      "Example: touchstone stability --method tight_inclusion --picture stability.html");
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, true, arguments->judged);
    status = run(*arguments);
  });
}

}  // namespace touchstone::verify::cli
