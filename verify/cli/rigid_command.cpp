// touchstone rigid: queries of rotating rigid bodies.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "touchstone/rigid_motion.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/help.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/data/rigid_query_file.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::cli::rigid_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> paths;
  bool keep_going = false;
  std::string json_file;
};

constexpr std::array<const char*, 3> names{"no", "yes", "undecided"};
const char* name_of(exact::RigidVerdict verdict) {
  return names.at(static_cast<std::size_t>(verdict));
}

/// Why a query is undecided.
constexpr std::array<const char*, 4> limits{"", "the least interval of time",
                                            "the number of intervals", "interrupted"};

/// The files, and those of folders in the order of their names.
std::vector<fs::path> query_files(const std::vector<fs::path>& paths) {
  std::vector<fs::path> result;
  for (const fs::path& path : paths) {
    if (!fs::is_directory(path)) {
      result.push_back(path);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.path().extension() == ".json") found.push_back(entry.path());
    }
    if (found.empty()) throw io::DatasetError(path, {}, "no .json files in the folder");
    std::ranges::sort(found);
    result.insert(result.end(), found.begin(), found.end());
  }
  return result;
}

Status run(const Arguments& arguments) {
  Files files;
  Output json(files, arguments.json_file);
  const std::vector<fs::path> paths = query_files(arguments.paths);
  files.add_inputs(paths);
  std::array<std::size_t, names.size()> counts{};
  std::string lines;
  nlohmann::json decisions = nlohmann::json::array();
  std::size_t errors = 0;
  io::ProgressBar bar("rigid");
  const auto fail = [&](const io::DatasetError& error) {
    bar.clear();
    report_error(error.what());
    ++errors;
  };
  for (std::size_t i = 0; i < paths.size() && !io::interrupted(); ++i) {
    if (errors != 0 && !arguments.keep_going) break;
    bar.update(static_cast<double>(i) / static_cast<double>(paths.size()));
    data::KindOfRigidQuery query;
    exact::RigidDecision decision;
    try {
      query = data::read_rigid_query(paths[i]);
      decision = exact::decide(query.kind, query.query, {.stop = &io::interrupted()});
    } catch (const io::DatasetError& error) {
      fail(error);
      continue;
    } catch (const std::domain_error& error) {
      fail(io::DatasetError(paths[i], {}, error.what()));
      continue;
    }
    if (decision.limit == exact::RigidLimit::stop) break;
    ++counts.at(static_cast<std::size_t>(decision.verdict));
    const std::string name = io::printable(paths[i].string());
    const char* const limit = limits.at(static_cast<std::size_t>(decision.limit));
    if (decision.verdict == exact::RigidVerdict::yes) {
      lines += fmt::format("{}: yes, at a time in [{:.17g}, {:.17g}]\n", name, decision.toi_lower,
                           decision.toi_upper);
    } else if (decision.verdict == exact::RigidVerdict::undecided) {
      lines += fmt::format("{}: undecided within {:.3g}, free before the time {:.17g} ({})\n", name,
                           decision.error, decision.toi_lower, limit);
    }
    decisions.push_back({{"file", paths[i].string()},
                         {"kind", to_string(query.kind)},
                         {"verdict", name_of(decision.verdict)},
                         {"toi_lower", decision.toi_lower},
                         {"toi_upper", decision.toi_upper},
                         {"error", decision.error},
                         {"limit", io::text_or_null(limit)}});
  }
  bar.clear();
  if (json) json.write(io::json_document({{"queries", decisions}}));
  json.close();
  io::print(files.summary_stream(),
            fmt::format("{}{} queries: {} no, {} yes, {} undecided{}\n", lines, decisions.size(),
                        counts[0], counts[1], counts[2],
                        errors == 0 ? "" : fmt::format(", {} invalid", errors)));
  if (io::interrupted()) return Status::interrupted;
  if (files.has_failed() || errors != 0) return Status::bad_input;
  return counts[0] < decisions.size() ? Status::wrong_answers : Status::all_well;
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "rigid", "Decide queries of two rotating rigid bodies, with proved bounds");
  command->option_defaults()->group("Input");
  add_option(*command, "QUERIES", arguments->paths);
  add_option(*command, "--keep-going", arguments->keep_going);
  command->option_defaults()->group("Output");
  add_option(*command, "--json", arguments->json_file);
  set_help(*command,
           "touchstone rigid query.json\n"
           "touchstone rigid queries/ --json verdicts.json",
           "Positions and rotation vectors go linearly from pose_t0 to pose_t1. Every answer is "
           "proved: no, yes with an enclosure of the time of impact, or undecided, with a distance "
           "within which the bodies come. Exact if no rotation moves a point.\n"
           "Exit status: 0 no query collides, 1 some collide or are undecided, 2 bad input.");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace touchstone::verify::cli::rigid_command
