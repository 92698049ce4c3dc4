// touchstone candidates: the candidate pairs of a step of a simulation, as a dataset.

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "fast/candidates.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/mesh.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/npy.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/io/text_table.hpp"
#include "verify/mesh/moving_mesh.hpp"

namespace touchstone::verify::cli::candidates_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string before;
  std::string after;
  std::string prefix;
  fast::BroadPhaseOptions broad_phase{.max_candidates = 0};
  std::string json_file;
};

/// The output files of a run in addition to the summary.
struct Arrays {
  explicit Arrays(const std::string& prefix)
      : vertex_face(prefix + "_vf.npy"),
        edge_edge(prefix + "_ee.npy"),
        vertex_face_pairs(prefix + "_vf_pairs.npy"),
        edge_edge_pairs(prefix + "_ee_pairs.npy"),
        edges(prefix + "_edges.npy") {}

  [[nodiscard]] std::vector<fs::path> all() const {
    return {vertex_face, edge_edge, vertex_face_pairs, edge_edge_pairs, edges};
  }

  fs::path vertex_face, edge_edge, vertex_face_pairs, edge_edge_pairs, edges;
};

/// Candidates of a kind, with the time of the search.
struct Found {
  Kind kind;
  std::vector<fast::IndexPair> pairs;
  double seconds;
};

/// The number of candidates of a kind that fit into the available memory; no limit if that is
/// unknown.
std::uint64_t candidates_in_free_memory() {
  static constexpr std::uint64_t bytes_each = 24;
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "MemAvailable:" && file >> kibibytes) return kibibytes * 1024 / bytes_each;
  }
  return std::numeric_limits<std::uint64_t>::max();
}

/// \throws std::runtime_error with the number of candidates and advice, if they are too many.
std::vector<fast::IndexPair> find_pairs(const mesh::MovingMesh& mesh, Kind kind,
                                        const fast::BroadPhaseOptions& options) {
  try {
    return kind == Kind::vertex_face
               ? fast::vertex_face_candidates(mesh.vertices, mesh.faces, options)
               : fast::edge_edge_candidates(mesh.vertices, mesh.edges, options);
  } catch (const fast::TooManyCandidates& error) {
    throw std::runtime_error(fmt::format(
        "{}: {} {} candidates, more than the {} that fit into memory: take frames that are nearer "
        "in "
        "time, a smaller --min-separation or a part of the mesh, or allow more by --max-candidates",
        mesh.name, error.count(), to_string(kind), options.max_candidates));
  }
}

Found find(const mesh::MovingMesh& mesh, Kind kind, fast::BroadPhaseOptions options) {
  const auto start = std::chrono::steady_clock::now();
  options.stop = &io::interrupted();
  if (options.max_candidates == 0) options.max_candidates = candidates_in_free_memory();
  std::vector<fast::IndexPair> pairs = find_pairs(mesh, kind, options);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  return {.kind = kind, .pairs = std::move(pairs), .seconds = time.count()};
}

/// Writes the candidates as a stream of queries, which would take much more memory than the pairs.
/// \throws io::Interrupted; then there is no file.
void write_queries(const fs::path& path, const mesh::MovingMesh& mesh, const Found& found) {
  static constexpr std::size_t pairs_of_update = 1U << 14U;
  const fast::Candidates candidates = mesh::candidates_of(mesh, found.kind, found.pairs);
  io::ProgressBar progress("write " + path.filename().string());
  data::NpyWriter writer(path);
  for (std::size_t i = 0; i < found.pairs.size(); ++i) {
    io::throw_if_interrupted();
    writer.write(fast::query_of(mesh.vertices, candidates, found.pairs[i]));
    if (i % pairs_of_update == 0) {
      progress.update(static_cast<double>(i) / static_cast<double>(found.pairs.size()));
    }
  }
  writer.close();
}

nlohmann::json summary(const mesh::MovingMesh& mesh, const std::vector<Found>& all) {
  nlohmann::json result{{"vertices", mesh.vertices.size()},
                        {"edges", mesh.edges.size()},
                        {"faces", mesh.faces.size()},
                        {"candidates", nlohmann::json::object()},
                        {"interrupted", io::interrupted().load()}};
  for (const Found& found : all) {
    result["candidates"][std::string(to_string(found.kind))] = {{"count", found.pairs.size()},
                                                                {"seconds", found.seconds}};
  }
  return result;
}

std::string table_of(const mesh::MovingMesh& mesh, const std::vector<Found>& all) {
  io::TextTable sizes({io::word_column("mesh", 12), {"count", 10}});
  sizes.add({"vertices", std::to_string(mesh.vertices.size())});
  sizes.add({"edges", std::to_string(mesh.edges.size())});
  sizes.add({"faces", std::to_string(mesh.faces.size())});
  io::TextTable candidates({io::word_column("candidates", 12), {"count", 10}, {"seconds", 8}});
  for (const Found& found : all) {
    candidates.add({std::string(to_string(found.kind)), std::to_string(found.pairs.size()),
                    io::number_text(found.seconds, "{:.3f}")});
  }
  return sizes.text() + '\n' + candidates.text();
}

Status candidates(const Arguments& arguments) {
  if (arguments.prefix.empty()) throw std::invalid_argument("--out has no file name");
  Files files;
  for (const std::string& input : {arguments.before, arguments.after}) files.add_input(input);
  Output json(files, arguments.json_file);
  const Arrays arrays(arguments.prefix);
  for (const fs::path& array : arrays.all()) files.add_output(array);
  const mesh::MovingMesh mesh = mesh::read_step(arguments.before, arguments.after);
  report_note(arguments.before, mesh.note);
  std::vector<Found> all;
  until_interrupted([&] {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      all.push_back(find(mesh, kind, arguments.broad_phase));
    }
    const fs::path folder = arrays.edges.parent_path();
    if (!folder.empty()) fs::create_directories(folder);
    data::write_index_pairs(arrays.edges, mesh.edges);
    data::write_index_pairs(arrays.vertex_face_pairs, all[0].pairs);
    data::write_index_pairs(arrays.edge_edge_pairs, all[1].pairs);
    write_queries(arrays.vertex_face, mesh, all[0]);
    write_queries(arrays.edge_edge, mesh, all[1]);
  });
  if (json) json.complete(io::json_document(summary(mesh, all)));
  io::print(files.summary_stream(), table_of(mesh, all));
  if (files.has_failed()) return Status::bad_input;
  return io::interrupted() ? Status::interrupted : Status::all_well;
}

void add_options(CLI::App& command, Arguments& arguments) {
  command.option_defaults()->group("Input");
  add_option(command, "before", arguments.before);
  add_option(command, "after", arguments.after);
  add_option(command, "--min-separation", [&arguments](const std::string& text) {
    arguments.broad_phase.separation.distance = data::distance_from_text(text).value();
  });
  add_option(command, "--threads", arguments.broad_phase.max_threads);
  command.option_defaults()->group("Output");
  add_option(command, "--out", arguments.prefix);
  add_option(command, "--max-candidates", arguments.broad_phase.max_candidates);
  add_option(command, "--json", arguments.json_file);
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "candidates", "Write the pairs of a moving mesh whose swept boxes overlap");
  add_options(*command, *arguments);
  set_help(*command,
           "touchstone candidates frames/92.ply frames/93.ply --out cloth\n"
           "touchstone certify cloth_vf.npy cloth_ee.npy",
           "Pairs that share a vertex are left out. Edges are numbered by their larger vertex, "
           "then by the smaller.\n" +
               std::string(writing_statuses));
  command->callback([arguments, &status] { status = candidates(*arguments); });
}

}  // namespace touchstone::verify::cli::candidates_command
