// touchstone generate: the built-in set as a dataset.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/npy.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/workload.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/mesh/ply.hpp"

namespace touchstone::verify::cli::generate_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string folder;
  std::vector<std::string> names;
  std::vector<std::string> degrees;
  std::string kind;
  std::uint64_t seed = default_seed;
  std::uint64_t count = 1000;
  SeparationArguments separation;
  bool npy = false;
  bool list = false;
  /// Two patches of mesh instead of queries: cells along a side; 0: none.
  int patch_cells = 0;
  std::string json_file;
};

struct Written {
  fs::path file;
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;
  bool is_known = true;  // whether the truth is known by construction
};

/// The named families, else those of the named degrees, else those on straight lines, or to list
/// them all.
std::vector<generate::Family> chosen(const Arguments& arguments) {
  const Separation separation = arguments.separation.given();
  if (!arguments.degrees.empty()) return generate::families(separation, arguments.degrees);
  if (arguments.names.empty()) {
    std::vector<std::string> degrees{"1"};
    if (arguments.list) degrees = {"1", "2", "3", "rational"};
    return generate::families(separation, degrees);
  }
  std::vector<generate::Family> result;
  result.reserve(arguments.names.size());
  for (const std::string& name : arguments.names) {
    result.push_back(generate::family_from_name(name));
  }
  return result;
}

void list_families(const std::vector<generate::Family>& chosen_families) {
  for (const generate::Family& family : chosen_families) {
    const std::string curves = family.is_rational   ? " (rational)"
                               : family.degree != 1 ? fmt::format(" (degree {})", family.degree)
                                                    : "";
    io::print(stdout, fmt::format("{}{}\n    {}\n", family.name, curves, family.reason));
  }
}

/// The query without the truth for another separation.
void keep_claims_about(const Separation& separation, const data::QuerySource& source,
                       std::optional<data::RecordedQuery>& query) {
  if (!query || judge::same_separation(source.recorded_separation(), separation)) return;
  query->collides.reset();
  query->toi.reset();
}

/// Writes and counts every query of a source, with its truth for the separation.
template <class Use>
Written for_each_query(data::QuerySource& source, const Separation& separation,
                       const fs::path& file, const Use& use) {
  Written written{.file = file};
  for (auto query = source.next(); query && !io::interrupted(); query = source.next()) {
    keep_claims_about(separation, source, query);
    use(*query);
    ++written.queries;
    written.collisions += query->collides.value_or(false) ? 1U : 0U;
    written.is_known = query->collides.has_value();
  }
  return written;
}

/// FOLDER/KIND/FAMILY.csv with its times of impact in FOLDER/KIND/toi/FAMILY_toi.csv.
Written write_csv(data::QuerySource& source, const Separation& separation, const fs::path& folder,
                  Files& files) {
  const fs::path file = folder / (source.name() + ".csv");
  const fs::path toi_file = folder / "toi" / (source.name() + "_toi.csv");
  for (const fs::path& output : {file, toi_file}) files.add_output(output);
  fs::create_directories(folder / "toi");
  data::CsvWriter queries(file);
  data::ToiWriter tois(toi_file);
  Written written = for_each_query(source, separation, file, [&](const data::RecordedQuery& query) {
    queries.write(query.query, query.collides);
    if (query.toi) tois.write(query.index, *query.toi);
  });
  tois.close();
  queries.close();
  return written;
}

/// FOLDER/KIND/FAMILY.npy, without the truth.
Written write_npy(data::QuerySource& source, const Separation& separation, const fs::path& folder,
                  Files& files) {
  const fs::path file = folder / (source.name() + ".npy");
  files.add_output(file);
  const fs::path companion = folder / "toi" / (source.name() + "_toi.csv");
  if (fs::exists(companion)) {
    throw std::runtime_error(companion.string() +
                             ": would become the array's companion; choose another folder");
  }
  fs::create_directories(folder);
  data::NpyWriter queries(file, source.shape());
  Written written = for_each_query(source, separation, file, [&](const data::RecordedQuery& query) {
    queries.write(query.query.numbers());
  });
  queries.close();
  return written;
}

std::vector<Written> write_families(const Arguments& arguments, Files& files) {
  std::vector<Written> result;
  const Separation separation = arguments.separation.given();
  require_same_separation(arguments.folder, separation);
  const std::vector<generate::Family> chosen_families = chosen(arguments);
  if (!is_zero(separation)) {
    fs::create_directories(arguments.folder);
    data::write_separation(arguments.folder, separation);
  }
  io::ProgressBar progress("generate");
  for (std::size_t i = 0; i < chosen_families.size(); ++i) {
    for (const AnyKind kind : kinds_of(arguments.kind)) {
      if (io::interrupted() || !generate::supports(chosen_families[i], kind)) continue;
      const auto source = generate::open_family(chosen_families[i], kind, arguments.seed,
                                                arguments.count, separation);
      const fs::path folder = fs::path(arguments.folder) / to_string(kind);
      result.push_back(arguments.npy ? write_npy(*source, separation, folder, files)
                                     : write_csv(*source, separation, folder, files));
    }
    progress.update(static_cast<double>(i + 1) / static_cast<double>(chosen_families.size()));
  }
  if (result.empty() && !io::interrupted()) refuse_kind(arguments.kind);
  return result;
}

/// FOLDER/0.ply and FOLDER/1.ply: two patches of mesh before and after a step.
Status generate_patches(const Arguments& arguments) {
  const mesh::MovingMesh patches =
      generate::moving_patches({.seed = arguments.seed, .cells = arguments.patch_cells});
  fs::create_directories(arguments.folder);
  for (const bool is_end : {false, true}) {
    mesh::Vertices vertices(static_cast<Eigen::Index>(patches.vertices.size()), 3);
    for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
      const fast::MovingVertex& vertex = patches.vertices[static_cast<std::size_t>(i)];
      vertices.row(i) = Eigen::RowVector3d((is_end ? vertex.end : vertex.start).data());
    }
    mesh::write_ply(fs::path(arguments.folder) / (is_end ? "1.ply" : "0.ply"), vertices,
                    patches.faces);
  }
  io::print(
      stdout,
      fmt::format("{} vertices, {} faces, before and after a step: 0.ply and 1.ply in {}\n",
                  patches.vertices.size(), patches.faces.size(), io::printable(arguments.folder)));
  return Status::all_well;
}

Status generate(const Arguments& arguments) {
  if (arguments.list) {
    list_families(chosen(arguments));
    return Status::all_well;
  }
  if (arguments.folder.empty()) throw std::invalid_argument("--out is required");
  if (arguments.patch_cells > 0) return generate_patches(arguments);
  Files record;
  Output json_output(record, arguments.json_file);
  nlohmann::json json = nlohmann::json::array();
  std::uint64_t queries = 0, collisions = 0;
  const Separation separation = arguments.separation.given();
  const std::vector<Written> files = write_families(arguments, record);
  for (const Written& written : files) {
    queries += written.queries;
    collisions += written.collisions;
    json.push_back({{"file", written.file.string()}, {"queries", written.queries}});
    json.back()["collisions"] =
        written.is_known ? nlohmann::json(written.collisions) : nlohmann::json();
    json.back()["separation"] = judge::to_json(separation);
  }
  if (json_output) json_output.complete(io::json_document(json));
  io::print(record.summary_stream(),
            fmt::format(
                "{} queries, {} of them collisions{}, in {} files below {}\n", queries, collisions,
                is_zero(separation)
                    ? ""
                    : " at minimum separation " + judge::to_text(separation) + " by construction",
                files.size(), io::printable(arguments.folder)));
  if (record.has_failed()) return Status::bad_input;
  return io::interrupted() ? Status::interrupted : Status::all_well;
}

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command =
      add_command(app, "generate", "Write the built-in set: degenerate queries of known truth");
  begin_group(*command, "Input");
  add_option(*command, "--family", arguments->names);
  add_option(*command, "--degree", arguments->degrees);
  add_option(*command, "--kind", arguments->kind);
  add_option(*command, "--seed", arguments->seed);
  add_option(*command, "--count", arguments->count);
  add_separation_options(*command, arguments->separation);
  add_option(*command, "--patches", arguments->patch_cells);
  begin_group(*command, "Output");
  add_option(*command, "--list", arguments->list);
  add_option(*command, "--out", arguments->folder);
  add_option(*command, "--npy", arguments->npy);
  add_option(*command, "--json", arguments->json_file);
  set_help(
      *command,
      "touchstone generate --out hard --count 100 --family hourglass\n"
      "touchstone generate --out near --min-separation 1e-8\n"
      "touchstone generate --out curves --degree 2 --degree rational\n"
      "touchstone generate --out cells --kind tetrahedron\n"
      "touchstone generate --out patches --patches 500",
      "With --min-separation there are additional families, with contact at exactly that distance; "
      "the others are written without truth. FOLDER/separation.json records the separation.\n" +
          std::string(writing_statuses));
  set_action(*command, [arguments, command, &status] {
    for (const AnyKind kind : kinds_of(arguments->kind)) require_kind(*command, kind);
    status = generate(*arguments);
  });
}

}  // namespace touchstone::verify::cli::generate_command
