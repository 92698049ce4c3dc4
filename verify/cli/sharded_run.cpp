#include "verify/cli/sharded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/generate/families.hpp"
#include "verify/io/json.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/sha256.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/pieces.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* shard_option = "--shard";
constexpr const char* resume_option = "--resume";

// ---- Shards -------------------------------------------------------------------------------------

std::optional<std::size_t> variable(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
  return value == nullptr ? std::nullopt : io::number_from_text<std::size_t>(value);
}

Shard checked(std::size_t index, std::size_t count) {
  if (index < count) return {index, count};
  throw std::invalid_argument(
      fmt::format("--shard: there is no part {} of {}; parts are counted from 0", index, count));
}

/// The part of a task of a Slurm array. An array of some tasks alone, such as failed ones that are
/// submitted again, does not tell the number of all tasks.
Shard shard_of_array(std::size_t task) {
  const std::size_t count = variable("SLURM_ARRAY_TASK_COUNT").value_or(0);
  const bool is_whole = variable("SLURM_ARRAY_TASK_MIN") == 0U &&
                        variable("SLURM_ARRAY_TASK_MAX").value_or(0) + 1 == count;
  if (is_whole && count > 1) return checked(task, count);
  throw std::invalid_argument(
      fmt::format("--shard auto: the number of parts is unknown, because the tasks of this Slurm "
                  "array are not 0 to N-1 with N > 1; pass --shard {}/N",
                  task));
}

Shard shard_of_environment() {
  if (const auto task = variable("SLURM_ARRAY_TASK_ID")) return shard_of_array(*task);
  const auto rank = variable("OMPI_COMM_WORLD_RANK"), size = variable("OMPI_COMM_WORLD_SIZE");
  if (rank && size) return checked(*rank, *size);
  throw std::invalid_argument(
      "--shard auto: neither SLURM_ARRAY_TASK_ID nor OMPI_COMM_WORLD_RANK and _SIZE are set");
}

// ---- The plan -----------------------------------------------------------------------------------

/// The identity of the program that makes results: its version, and its digest if the version does
/// not identify the sources.
std::string program() {
  std::string text(version());
  if (!text.ends_with(')') || text.ends_with("-dirty)")) {
    text += ", SHA-256 " + io::sha256_of_file("/proc/self/exe");
  }
  return text;
}

/// The file, or the files of the folder; none if it is neither.
std::vector<fs::path> files_below(const fs::path& path) {
  if (fs::is_regular_file(path)) return {path};
  std::vector<fs::path> files;
  if (!fs::is_directory(path)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

/// The options of the command line that results depend on, in the order of the help, and the files
/// that they name.
void set_options(const CLI::App& command, const PieceRun& run, jobs::Plan& plan) {
  std::set<std::string> left_out{shard_option, resume_option, "--threads", run.input};
  left_out.insert(run.outputs.begin(), run.outputs.end());
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || left_out.contains(name)) continue;
    if (std::ranges::count(run.refused, name) != 0) {
      throw std::invalid_argument(name + " does not work with --resume");
    }
    const std::vector<std::string> values = option->results();
    for (const std::string& value : values) {
      const bool is_flag = option->get_expected_min() == 0;
      plan.options.push_back(is_flag && value == "true" ? name : fmt::format("{}={}", name, value));
      for (const fs::path& file : files_below(value)) {
        plan.uses[file.string()] = io::sha256_of_file(file);
      }
    }
  }
  for (const std::string& output : run.outputs) {
    const CLI::Option* const option = command.get_option(output);
    if (option->count() != 0) plan.outputs[output] = option->as<std::string>();
  }
  // The counts of a piece are always needed.
  plan.outputs.try_emplace(std::string(jobs::json_option), "");
}

/// Runs a piece in a process of its own. Returns its exit status.
int do_piece(const jobs::PieceFolder& folder, std::size_t number, const std::string& threads) {
  const jobs::Plan& plan = folder.plan();
  const jobs::Piece& piece = plan.pieces[number];
  return folder.finish(number, [&](const std::map<std::string, fs::path>& outputs) {
    std::vector<std::string> arguments{"touchstone", plan.command};
    arguments.insert(arguments.end(), plan.options.begin(), plan.options.end());
    if (!threads.empty()) arguments.push_back("--threads=" + threads);
    for (const auto& [option, file] : outputs) arguments.push_back(option + "=" + file.string());
    arguments.insert(arguments.end(), piece.arguments.begin(), piece.arguments.end());
    return jobs::run_own_program(std::move(arguments));
  });
}

/// The same, with a report of an error.
int try_piece(const jobs::PieceFolder& folder, std::size_t number, const std::string& threads) {
  std::string reason;
  int status = static_cast<int>(Status::bad_input);
  try {
    status = do_piece(folder, number, threads);
    reason = fmt::format("ended with status {}", status);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (status > static_cast<int>(Status::wrong_answers) && !io::interrupted()) {
    report_error(fmt::format("piece {}, {}: {}; it is not done", number,
                             folder.plan().pieces[number].name, reason));
  }
  return status;
}

// ---- The merged result --------------------------------------------------------------------------

std::string number_text(const nlohmann::json& json, const char* key) {
  return json.contains(key) ? json.at(key).dump() : "0";
}

/// The main counts: of certificates, or of queries with a line for each method.
std::string summary_text(const nlohmann::json& total) {
  if (total.contains("pieces")) return {};
  if (total.contains("certificates")) {
    return fmt::format("{} certificates: {} no collision, {} collision, {} time of impact\n",
                       number_text(total, "certificates"), number_text(total, "no_collision"),
                       number_text(total, "collision"), number_text(total, "time_of_impact"));
  }
  std::string text = fmt::format("{} queries", number_text(total, "queries"));
  if (total.contains("collisions")) {
    text += fmt::format(", {} collisions", number_text(total, "collisions"));
  }
  if (total.contains("labels")) {
    text += total.at("labels") == 0
                ? ", no recorded labels"
                : fmt::format(", {} wrong labels of {}", number_text(total, "label_mismatches"),
                              number_text(total, "labels"));
  } else {
    text += "; no truth: nothing was judged";
  }
  text += '\n';
  if (!total.contains("methods")) return text;
  for (const nlohmann::json& method : total.at("methods")) {
    text += fmt::format(
        "{}: {} judged, {} false negatives, {} false positives, {} late toi, {} early upper, {} "
        "undecided, {} errors\n",
        method.at("name").get<std::string>(), number_text(method, "queries"),
        number_text(method, "false_negatives"), number_text(method, "false_positives"),
        number_text(method, "late_toi"), number_text(method, "early_toi_upper"),
        number_text(method, "undecided"), number_text(method, "errors"));
  }
  return text;
}

void write_merged_text(const jobs::PieceFolder& folder, const std::string& option,
                       const std::string& name, Files& files) {
  CertificatesFile output(files, name, "");
  folder.merged_text(option, [&](std::string_view text) { output.write(text); });
  output.close(std::string_view());
}

/// The status that follows from the solvers' responses to the queries of all pieces.
Status status_of_responses(const nlohmann::json& total) {
  const auto responses = [](const nlohmann::json& counts) -> Responses {
    return {.asked = counts.at("queries"),
            .hangs = counts.at("failures").at(judge::to_string(judge::Fault::hang)),
            .errors = counts.at("errors"),
            .unasked = counts.value("unasked", std::uint64_t{0}) +
                       counts.value("outside", std::uint64_t{0}) +
                       counts.value("left_out", std::uint64_t{0})};
  };
  Status status = Status::all_well;
  if (total.contains("method")) {
    return status_of(total.at("method").get<std::string>(), responses(total));
  }
  for (const nlohmann::json& method : total.value("methods", nlohmann::json::array())) {
    status = worse(status, status_of(method.at("name").get<std::string>(), responses(method)));
  }
  return status;
}

/// Writes the merged files, and prints a summary. \pre the folder has no faults
Status write_merged(const jobs::PieceFolder& folder, const std::string& json_file) {
  Files files;
  const nlohmann::json total = folder.merged_json();
  for (const auto& [option, name] : folder.plan().outputs) {
    if (option == jobs::json_option) {
      Output(files, json_file.empty() ? name : json_file).complete(io::json_document(total));
    } else {
      write_merged_text(folder, option, name, files);
    }
  }
  io::print(files.summary_stream(),
            fmt::format("{} pieces\n{}", folder.plan().pieces.size(), summary_text(total)));
  const Status status = worse(static_cast<Status>(folder.status()), status_of_responses(total));
  return files.has_failed() ? Status::bad_input : status;
}

/// The pieces of the command line's queries: the sources that for_each_source passes on.
std::vector<jobs::Piece> pieces_of(const SourceArguments& sources) {
  std::vector<jobs::Piece> pieces;
  if (sources.built_in_set()) {
    const std::vector<BuiltInSource> families = built_in_sources(sources);
    for (std::size_t i = 0; i < families.size(); ++i) {
      pieces.push_back(
          {.name = fmt::format("{} {}", families[i].family.name, to_string(families[i].kind)),
           .files = {},
           .arguments = {"--piece", fmt::format("--only-source={}", i)}});
    }
    return pieces;
  }
  std::set<fs::path> seen;
  for (const fs::path& path : sources.paths) {
    for (const fs::path& file : data::find_datasets({&path, 1})) {
      if (!seen.insert(fs::weakly_canonical(file)).second) continue;
      jobs::Piece piece{
          .name = file.string(), .files = {file}, .arguments = {"--piece", "--", file.string()}};
      for (const fs::path& companion : data::find_ground_truth_files(file)) {
        piece.files.push_back(companion);
      }
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

}  // namespace

void add_piece_options(CLI::App& command, PieceArguments& arguments) {
  add_option(command, shard_option, arguments.shard);
  add_option(command, resume_option, arguments.folder);
}

Shard shard_of(const PieceArguments& arguments) {
  if (arguments.shard.empty()) return {};
  if (arguments.shard == "auto") return shard_of_environment();
  const std::string_view text = arguments.shard;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = io::number_from_text<std::size_t>(text.substr(0, slash));
  const auto count =
      io::number_from_text<std::size_t>(text.substr(std::min(slash + 1, text.size())));
  if (!index || !count) {
    throw std::invalid_argument("--shard: '" + arguments.shard + "' is not I/N, as 0/4 or 3/4");
  }
  return checked(*index, *count);
}

Status run_pieces(const CLI::App& command, const PieceArguments& arguments, const PieceRun& run) {
  jobs::Plan plan{.program = program(),
                  .command = command.get_name(),
                  .options = {},
                  .uses = {},
                  .outputs = {},
                  .pieces = run.pieces};
  set_options(command, run, plan);
  const Shard shard = shard_of(arguments);
  const jobs::PieceFolder folder(arguments.folder, std::move(plan));
  const CLI::Option* const threads = command.get_option_no_throw("--threads");
  const std::string thread_count =
      threads != nullptr && threads->count() != 0 ? threads->as<std::string>() : "";
  io::ProgressBar bar(command.get_name());
  int worst = 0;
  const std::size_t count = run.pieces.size();
  for (std::size_t i = 0; i < count && !io::interrupted(); ++i) {
    bar.update(static_cast<double>(i) / static_cast<double>(count));
    if (!shard.contains(i) || folder.fault(i).empty()) continue;
    worst = std::max(worst, try_piece(folder, i, thread_count));
  }
  bar.clear();
  if (io::interrupted()) return Status::interrupted;
  const std::size_t faults = folder.faults().size();
  if (faults == 0) return write_merged(folder, "");
  const std::size_t left = faults - folder.foreign_files().size();
  io::print(stdout,
            fmt::format("{} of {} pieces are done, not yet {}: when all are, touchstone merge {}\n",
                        count - left, count, left, io::printable(arguments.folder.string())));
  return std::min(static_cast<Status>(worst), Status::bad_input);
}

Status run_in_pieces(const CLI::App& command, const PieceArguments& arguments,
                     SourceArguments& sources, PieceRun in_pieces,
                     const std::function<Status()>& run) {
  if (!arguments.folder.empty()) {
    in_pieces.pieces = pieces_of(sources);
    return run_pieces(command, arguments, in_pieces);
  }
  sources.shard = shard_of(arguments);
  if (sources.shard.count == 1 || sources.built_in_set()) return run();
  // The files of all paths are counted together: some commands open one path after the other.
  const std::vector<jobs::Piece> pieces = pieces_of(sources);
  sources.paths.clear();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (sources.shard.contains(i)) sources.paths.push_back(pieces[i].files.front());
  }
  if (sources.paths.empty()) {
    report_warning(
        fmt::format("--shard: {} files, none for part {}", pieces.size(), sources.shard.index));
    return Status::all_well;
  }
  sources.shard = {};
  return run();
}

Status merge_pieces(const fs::path& path, const std::string& json_file) {
  const jobs::PieceFolder folder(path);
  if (folder.plan().program != program()) {
    report_error(fmt::format("{}: made by version {}, this is version {}", path.string(),
                             folder.plan().program, program()));
    return Status::bad_input;
  }
  const std::vector<std::string> faults = folder.faults();
  for (const std::string& fault : faults) report_error(fault);
  if (!faults.empty()) {
    report_error(fmt::format("{} of {} pieces: nothing is merged", faults.size(),
                             folder.plan().pieces.size()));
    return Status::bad_input;
  }
  return write_merged(folder, json_file);
}

}  // namespace touchstone::verify::cli
