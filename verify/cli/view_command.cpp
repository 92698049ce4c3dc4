// touchstone view: an HTML viewer of queries.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/dataset.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/mesh/frames.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/asked_solvers.hpp"
#include "verify/view/query_facts.hpp"
#include "verify/view/query_files.hpp"
#include "verify/view/step_facts.hpp"
#include "verify/view/view_page.hpp"

namespace touchstone::verify::cli::view_command {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_script = std::size_t{64} << 20U;

struct Arguments {
  const Command* command = nullptr;
  std::vector<fs::path> paths;
  std::vector<fs::path> step;
  GroupArguments groups;
  std::string points;
  std::string kind;
  view::QueryFileOptions files;
  SeparationArguments separation;
  SolverArguments solvers;
  std::string live_file;
  std::string out_file;
};

/// The methods with a promise, if the user names no solver.
SolverArguments asked_by(const Arguments& arguments) {
  SolverArguments asked = arguments.solvers;
  if (asked.empty()) asked.methods = solvers::default_methods();
  return asked;
}

/// The step between the two frames of the command line, if any.
std::optional<view::ViewedStep> read_step(const Arguments& arguments, Files& files) {
  if (arguments.step.empty()) {
    if (!arguments.groups.is_empty()) {
      throw std::invalid_argument("--groups, --apart, --radii and --separations need --step");
    }
    return std::nullopt;
  }
  const auto frames = open_frames(files, arguments.step);
  if (frames->count() != 2) throw std::invalid_argument("--step needs two frames");
  fast::CollisionGroups groups =
      collision_groups(files, arguments.groups, frames->mesh(), arguments.separation.given().norm)
          .rules;
  mesh::Vertices before = frames->next(), after = frames->next();
  return view::find_collisions(fmt::format("{} to {}", frames->name(0), frames->name(1)),
                               frames->mesh(), std::move(before), std::move(after),
                               {.solve = {.separation = arguments.separation.given()},
                                .groups = std::move(groups),
                                .stop = &io::interrupted()});
}

std::vector<view::ViewedQuery> read(const Arguments& arguments, Files& files) {
  view::QueryFileOptions options = arguments.files;
  if (!arguments.kind.empty()) options.kind = kind_from_string(arguments.kind);
  std::vector<view::ViewedQuery> queries;
  if (!arguments.points.empty()) {
    if (!options.kind) throw std::invalid_argument("--points needs --kind");
    queries.push_back(
        {.label = "points on the command line",
         .query = base::AnyQuery(*options.kind, view::parse_points(arguments.points))});
  }
  const std::vector<fs::path> paths = data::find_datasets(arguments.paths);
  require_kinds(*arguments.command, paths, options.kind);
  for (const fs::path& path : paths) {
    files.add_dataset(path);
    if (queries.size() == arguments.files.most) break;
    options.most = arguments.files.most - queries.size();
    for (view::ViewedQuery& query : view::read_queries(path, options)) {
      queries.push_back(std::move(query));
    }
  }
  for (view::ViewedQuery& query : queries) {
    query.separation = arguments.separation.settle(query.separation);
  }
  return queries;
}

/// The contents of the page: the first pairs of a step, and the queries of the other inputs.
std::vector<view::ViewedQuery> all_queries(const Arguments& arguments,
                                           const std::optional<view::ViewedStep>& step,
                                           Files& files) {
  std::vector<view::ViewedQuery> queries;
  if (step) queries = view::first_queries(*step, arguments.files.most);
  for (view::ViewedQuery& query : read(arguments, files)) queries.push_back(std::move(query));
  if (queries.empty() && !step) {
    throw std::invalid_argument("no query: name a file, --points or --step");
  }
  return queries;
}

Status run(const Arguments& arguments) {
  if (arguments.out_file.empty()) throw std::invalid_argument("--out has no file name");
  Files files;
  Output out(files, arguments.out_file);
  const std::string live =
      arguments.live_file.empty() ? "" : io::read_file(arguments.live_file, longest_script);
  const Solvers solvers(files, asked_by(arguments));
  const std::optional<view::ViewedStep> step = read_step(arguments, files);
  std::vector<view::ViewedQuery> queries = all_queries(arguments, step, files);
  io::ProgressBar bar("view");
  std::vector<nlohmann::json> facts;
  for (view::ViewedQuery& query : queries) {
    if (io::interrupted()) break;
    view::Replies replies = view::ask(solvers.all(), query);
    std::ranges::move(replies.notes, std::back_inserter(query.notes));
    facts.push_back(view::query_facts(query, replies.answers));
    bar.update(static_cast<double>(facts.size()) / static_cast<double>(queries.size()));
  }
  bar.clear();
  solvers.report_output(arguments.solvers.show_output);
  if (facts.empty() && io::interrupted()) return Status::interrupted;
  out.complete(view::view_page(facts, command_line(),
                               step ? view::step_facts(*step) : nlohmann::json(), live));
  if (files.has_failed()) return Status::bad_input;
  if (files.summary_stream() == stdout) {
    io::print(stdout, fmt::format("{}\n", io::printable(arguments.out_file)));
  }
  return io::interrupted() ? Status::interrupted : Status::all_well;
}

void add_options(Command& command, Arguments& arguments) {
  arguments.command = &command;
  begin_group(command, "Input");
  add_option(command, "PATH", arguments.paths);
  add_option(command, "--step", arguments.step);
  add_group_options(command, arguments.groups);
  add_thickness_options(command, arguments.groups);
  add_option(command, "--index", arguments.files.indices);
  add_option(command, "--most", arguments.files.most);
  add_option(command, "--points", arguments.points);
  add_option(command, "--kind", arguments.kind);
  add_option(command, "--round", arguments.files.round);
  add_separation_options(command, arguments.separation);
  add_solver_options(command, arguments.solvers);
  add_option(command, "--exact", arguments.solvers.exact);
  begin_group(command, "Output");
  add_option(command, "--live", arguments.live_file);
  add_option(command, "--out", arguments.out_file);
}

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command = add_command(app, "view", "Write an HTML viewer of queries");
  add_options(*command, *arguments);
  set_help(
      *command,
      "touchstone view path/to/vertex-face.csv --index 17 --out query.html\n"
      "touchstone view --step frames/92.ply frames/93.ply --out step.html\n"
      "touchstone view found.json --method tight_inclusion --plugin ./libsolver.so --out "
      "found.html",
      "The page needs only a browser with WebGL. It shows motion and corners, the exact time of "
      "impact, a certificate, and the answers of the solvers; without --method and --plugin, of "
      "those that promise something.\n"
      "Exit status: 0 the page is written, 2 bad input or usage, 130 interrupted.");
  set_action(*command, [arguments, command, &status] {
    settle_solver_options(*command, true, arguments->solvers);
    status = run(*arguments);
  });
}

}  // namespace touchstone::verify::cli::view_command
