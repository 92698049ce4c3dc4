// touchstone generate: the built-in set as a dataset.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/dataset/csv_dataset.hpp"
#include "verify/dataset/npy.hpp"
#include "verify/dataset/toi_writer.hpp"
#include "verify/families/families.hpp"
#include "verify/terminal.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string folder;
  std::vector<std::string> names;
  std::uint64_t seed = default_seed;
  std::uint64_t count = 1000;
  bool npy = false;
  bool list = false;
  std::string json_file;
};

struct Written {
  fs::path file;
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;
};

std::vector<Family> chosen(const std::vector<std::string>& names) {
  if (names.empty()) return {families().begin(), families().end()};
  std::vector<Family> result;
  result.reserve(names.size());
  for (const std::string& name : names) result.push_back(family_from_name(name));
  return result;
}

void list_families(const std::vector<Family>& chosen_families) {
  for (const Family& family : chosen_families)
    fmt::print("{}\n    {}\n", family.name, family.reason);
}

/// FOLDER/KIND/FAMILY.csv with its times of impact in FOLDER/KIND/toi/FAMILY_toi.csv.
Written write_csv(QuerySource& source, const fs::path& folder) {
  Written written{.file = folder / (source.name() + ".csv")};
  fs::create_directories(folder / "toi");
  CsvWriter queries(written.file);
  ToiWriter tois(folder / "toi" / (source.name() + "_toi.csv"));
  for (auto query = source.next(); query && !interrupted(); query = source.next()) {
    queries.write(query->query, query->collides.value());
    if (query->toi) tois.write(query->index, *query->toi);
    ++written.queries;
    written.collisions += query->collides.value() ? 1U : 0U;
  }
  queries.close();
  tois.close();
  return written;
}

/// FOLDER/KIND/FAMILY.npy, without the truth.
Written write_npy(QuerySource& source, const fs::path& folder) {
  Written written{.file = folder / (source.name() + ".npy")};
  const fs::path companion = folder / "toi" / (source.name() + "_toi.csv");
  if (fs::exists(companion)) {
    throw std::runtime_error(companion.string() +
                             ": would be taken for the array's; choose another folder");
  }
  fs::create_directories(folder);
  NpyWriter queries(written.file);
  for (auto query = source.next(); query && !interrupted(); query = source.next()) {
    queries.write(query->query);
    ++written.queries;
    written.collisions += query->collides.value() ? 1U : 0U;
  }
  queries.close();
  return written;
}

std::vector<Written> write_families(const Arguments& arguments) {
  std::vector<Written> result;
  const std::vector<Family> chosen_families = chosen(arguments.names);
  ProgressBar progress("generate");
  for (std::size_t i = 0; i < chosen_families.size(); ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      if (interrupted() || !supports(chosen_families[i], kind)) continue;
      const auto source = open_family(chosen_families[i], kind, arguments.seed, arguments.count);
      const fs::path folder = fs::path(arguments.folder) / to_string(kind);
      result.push_back(arguments.npy ? write_npy(*source, folder) : write_csv(*source, folder));
    }
    progress.update(static_cast<double>(i + 1) / static_cast<double>(chosen_families.size()));
  }
  return result;
}

Status generate(const Arguments& arguments) {
  if (arguments.list) {
    list_families(chosen(arguments.names));
    return Status::all_well;
  }
  if (arguments.folder.empty()) throw CLI::RequiredError("--out");
  OptionalOutput json_output(arguments.json_file);
  nlohmann::json json = nlohmann::json::array();
  std::uint64_t queries = 0, collisions = 0;
  const std::vector<Written> files = write_families(arguments);
  for (const Written& written : files) {
    queries += written.queries;
    collisions += written.collisions;
    json.push_back({{"file", written.file.string()},
                    {"queries", written.queries},
                    {"collisions", written.collisions}});
  }
  if (json_output) json_output.write(json.dump(2) + "\n");
  json_output.close();
  fmt::print("{} queries, {} of them collisions, in {} files below {}\n", queries, collisions,
             files.size(), arguments.folder);
  return interrupted() ? Status::interrupted : Status::all_well;
}

}  // namespace

void add_generate_command(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "generate", "Write the built-in set: degenerate queries with truth known by construction");
  command->add_option("--out", arguments->folder, "Folder to write to")->type_name("FOLDER");
  command->add_option("--family", arguments->names, "Only these families (see --list)")
      ->type_name("NAME");
  command->add_option("--seed", arguments->seed, "Seed")
      ->capture_default_str()
      ->check(whole_number(0, UINT64_MAX));
  command->add_option("--count", arguments->count, "Queries a family and kind")
      ->capture_default_str()
      ->check(whole_number(1, UINT64_MAX));
  command->add_flag("--npy", arguments->npy,
                    "Write float64 arrays of shape (N, 8, 3), without the truth, instead of CSV");
  command->add_flag("--list", arguments->list, "Name the families and why their truth is known");
  command->add_option("--json", arguments->json_file, "Write the list of files as JSON")
      ->type_name("FILE");
  command->footer(
      "Exit status: 0 all is written, 2 bad usage or an error in writing, 130 interrupted.\n"
      "Example: touchstone generate --out hard --count 100 --family hourglass");
  command->callback([arguments, &status] { status = generate(*arguments); });
}

}  // namespace touchstone::verify::cli
