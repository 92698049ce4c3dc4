#include "verify/jobs/pieces.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/sha256.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::jobs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* plan_format = "touchstone plan 1";
constexpr const char* record_format = "touchstone piece 1";
constexpr const char* plan_name = "plan.json";
constexpr std::size_t most_bytes = std::size_t{1} << 31U;

void write_file(const fs::path& path, std::string_view text) {
  io::OutputFile file(path);
  file.write(text);
  file.close();
}

/// A file as plans and records have it: `file` (the given name), `bytes`, `sha256`.
/// \throws DatasetError if it cannot be read.
json described(const fs::path& file, const std::string& name) {
  return {{"file", name}, {"bytes", fs::file_size(file)}, {"sha256", io::sha256_of_file(file)}};
}

/// A folder that is removed with this object unless it is to be kept.
class NewFolder {
 public:
  explicit NewFolder(fs::path path) : path_(std::move(path)) { fs::create_directory(path_); }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  NewFolder(NewFolder&&) = delete;
  NewFolder& operator=(NewFolder&&) = delete;
  ~NewFolder() {
    std::error_code ignored;
    if (!is_kept_) fs::remove_all(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }
  void keep() { is_kept_ = true; }

 private:
  fs::path path_;
  bool is_kept_ = false;
};

// ---- The plan -----------------------------------------------------------------------------------

json to_json(const Plan& plan) {
  json pieces = json::array();
  for (const Piece& piece : plan.pieces) {
    json files = json::array();
    for (const fs::path& file : piece.files) files.push_back(file.string());
    pieces.push_back({{"name", piece.name}, {"files", files}, {"arguments", piece.arguments}});
  }
  return {{"format", plan_format},   {"program", plan.program}, {"command", plan.command},
          {"options", plan.options}, {"uses", plan.uses},       {"outputs", plan.outputs},
          {"pieces", pieces}};
}

Plan plan_from_json(const json& source) {
  if (source.at("format") != plan_format) throw std::invalid_argument("unknown format");
  Plan plan{.program = source.at("program"),
            .command = source.at("command"),
            .options = source.at("options"),
            .uses = source.at("uses"),
            .outputs = source.at("outputs"),
            .pieces = {}};
  for (const json& piece : source.at("pieces")) {
    const std::vector<std::string> files = piece.at("files");
    plan.pieces.push_back({.name = piece.at("name"),
                           .files = {files.begin(), files.end()},
                           .arguments = piece.at("arguments")});
  }
  return plan;
}

/// The plan of a folder; none if it has no plan. \throws std::runtime_error if it cannot be read.
std::optional<Plan> read_plan(const fs::path& folder) {
  const fs::path file = folder / plan_name;
  if (!fs::exists(file)) return std::nullopt;
  try {
    return plan_from_json(io::read_json(file, most_bytes));
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": not the plan of a run: " + io::reason_of(error));
  }
}

/// The difference between two plans, in the words of the user.
std::string difference(const Plan& given, const Plan& there) {
  const auto join = [](const auto& texts) { return fmt::format("{}", fmt::join(texts, " ")); };
  if (given.program != there.program)
    return "of version " + there.program + ", not " + given.program;
  if (given.command != there.command) return "of " + there.command + ", not " + given.command;
  if (given.options != there.options) {
    return fmt::format("with the options '{}', not '{}'", join(there.options), join(given.options));
  }
  if (given.uses != there.uses) return "with other contents of a file that an option names";
  if (given.outputs != there.outputs) return "with other output files";
  return "of other inputs";
}

// ---- Merging ------------------------------------------------------------------------------------

/// Numbers that cannot be added, as times and means.
bool is_left_out(std::string_view key) {
  return key.find("_per_") != std::string_view::npos || key.ends_with("seconds") ||
         key == "file_bytes";
}
bool is_greatest(std::string_view key) { return key == "max" || key.starts_with("greatest"); }
bool is_list(std::string_view key) {
  static constexpr std::array<std::string_view, 4> lists{"files", "mismatches", "wrong_answers",
                                                         "beyond_limits"};
  return std::ranges::find(lists, key) != lists.end();
}

json without_means(const json& source) {
  if (source.is_array()) {
    json result = json::array();
    for (const json& item : source) result.push_back(without_means(item));
    return result;
  }
  if (!source.is_object()) return source;
  json result = json::object();
  for (const auto& [key, value] : source.items()) {
    if (!is_left_out(key)) result[key] = without_means(value);
  }
  return result;
}

/// Adds the result of the next piece. Counts are summed, of greatest values the greater is kept,
/// lists are joined, and everything else must agree.
/// \throws std::invalid_argument that names the difference.
void add(json& sum, const json& next, const std::string& key) {
  if (sum.is_object() && sum.contains("histogram")) {
    judge::ToiErrors errors = judge::toi_errors_from_json(sum);
    sum = judge::to_json(errors += judge::toi_errors_from_json(next));
  } else if (key == "toi_error" && (sum.is_null() || next.is_null())) {
    if (sum.is_null()) sum = next;
  } else if (sum.is_object() && next.is_object()) {
    for (const auto& [name, value] : next.items()) {
      if (sum.contains(name)) {
        add(sum[name], value, name);
      } else {
        sum[name] = value;
      }
    }
  } else if (sum.is_array() && next.is_array() && is_list(key)) {
    sum.insert(sum.end(), next.begin(), next.end());
  } else if (sum.is_array() && next.is_array() && sum.size() == next.size()) {
    for (std::size_t i = 0; i < sum.size(); ++i) add(sum[i], next[i], key);
  } else if (is_greatest(key)) {
    if (io::number_from_json(sum) < io::number_from_json(next)) sum = next;
  } else if (sum.is_number_integer() && next.is_number_integer()) {
    sum = sum.get<std::int64_t>() + next.get<std::int64_t>();
  } else if (sum != next) {
    throw std::invalid_argument(key + " is " + next.dump() + ", elsewhere " + sum.dump());
  }
}

/// The commands whose results are counts of queries; those of the others stay apart.
bool is_additive(const std::string& command) {
  return command == "certify" || command == "solve" || command == "prove";
}

/// The word that begins the closing line of a text; none for CSV.
std::string_view closing_word(std::string_view header) {
  if (header.starts_with("touchstone-certificates")) return "certificates ";
  if (header.starts_with("touchstone-steps")) return "steps ";
  return {};
}

}  // namespace

PieceFolder::PieceFolder(fs::path folder, Plan plan)
    : folder_(std::move(folder)), plan_(std::move(plan)) {
  const std::string text = io::json_document(to_json(plan_));
  if (const auto there = read_plan(folder_)) {
    if (io::json_document(to_json(*there)) != text) {
      throw std::runtime_error(fmt::format("{}: has the pieces of a run {}; choose another folder",
                                           folder_.string(), difference(plan_, *there)));
    }
  } else {
    fs::create_directories(folder_);
    write_file(folder_ / plan_name, text);
  }
  digest_ = io::sha256(text);
}

PieceFolder::PieceFolder(fs::path folder) : folder_(std::move(folder)) {
  auto plan = read_plan(folder_);
  if (!plan) throw std::runtime_error(folder_.string() + ": no pieces (there is no plan.json)");
  plan_ = std::move(*plan);
  digest_ = io::sha256(io::json_document(to_json(plan_)));
}

fs::path PieceFolder::record_file(std::size_t piece) const {
  return folder_ / fmt::format("{:06}.piece", piece);
}

json PieceFolder::record(std::size_t piece) const {
  return io::read_json(record_file(piece), most_bytes);
}

fs::path PieceFolder::output(std::size_t piece, std::string_view option) const {
  return folder_ / record(piece).at("outputs").at(option).at("file").get<std::string>();
}

json PieceFolder::described_inputs(std::size_t piece) const {
  json inputs = json::array();
  for (const fs::path& file : plan_.pieces[piece].files) {
    inputs.push_back(described(file, file.string()));
  }
  return inputs;
}

json PieceFolder::checked_inputs(std::size_t piece) const {
  for (const auto& [file, digest] : plan_.uses) {
    if (io::sha256_of_file(file) != digest) {
      throw std::runtime_error(file + ": has changed since the run began");
    }
  }
  return described_inputs(piece);
}

int PieceFolder::finish(std::size_t piece, const Work& work) const {
  json record{{"format", record_format},
              {"program", plan_.program},
              {"plan", digest_},
              {"piece", piece},
              {"name", plan_.pieces[piece].name},
              {"inputs", checked_inputs(piece)}};
  NewFolder own(folder_ / fmt::format("{:06}-{}", piece, io::unused_name()));
  std::map<std::string, fs::path> files;
  for (const auto& [option, name] : plan_.outputs) {
    files[option] = own.path() / option.substr(option.find_first_not_of('-'));
  }
  const int status = work(files);
  if (status != 0 && status != 1) return status;
  if (checked_inputs(piece) != record["inputs"]) {
    throw std::runtime_error("an input has changed while it was read");
  }
  record["status"] = status;
  for (const auto& [option, file] : files) {
    record["outputs"][option] = described(file, file.lexically_relative(folder_).string());
  }
  record["sha256"] = io::sha256(record.dump());
  write_file(record_file(piece), io::json_document(record));
  own.keep();
  return status;
}

std::string PieceFolder::fault_of(const std::string& text, std::size_t piece) const {
  try {
    json record = json::parse(text);
    const std::string digest = record.at("sha256");
    record.erase("sha256");
    if (io::sha256(record.dump()) != digest) return "its record is damaged";
    if (record.at("program") != plan_.program) {
      return fmt::format("made by version {}, not {}", record.at("program").dump(), plan_.program);
    }
    if (record.at("plan") != digest_) return "of another run";
    if (record.at("piece") != piece) {
      return fmt::format("piece {} is also there under this number", record.at("piece").dump());
    }
    if (record.at("inputs") != described_inputs(piece)) return "its input has changed since";
    for (const auto& [option, name] : plan_.outputs) {
      const json& output = record.at("outputs").at(option);
      const std::string file = output.at("file");
      if (output != described(folder_ / file, file)) return "its results have changed since";
    }
    return {};
  } catch (const json::exception&) {
    return "its record is damaged";
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string PieceFolder::fault(std::size_t piece) const {
  const fs::path file = record_file(piece);
  return fs::exists(file) ? fault_of(io::read_file(file, most_bytes), piece) : "missing";
}

std::vector<std::string> PieceFolder::faults() const {
  std::vector<std::string> result;
  for (std::size_t piece = 0; piece < plan_.pieces.size(); ++piece) {
    const std::string reason = fault(piece);
    if (reason.empty()) continue;
    result.push_back(fmt::format("{}: piece {}, {}: {}", record_file(piece).string(), piece,
                                 plan_.pieces[piece].name, reason));
  }
  for (std::string& foreign : foreign_files()) result.push_back(std::move(foreign));
  return result;
}

std::vector<std::string> PieceFolder::foreign_files() const {
  std::set<fs::path> expected;
  for (std::size_t piece = 0; piece < plan_.pieces.size(); ++piece) {
    expected.insert(record_file(piece));
  }
  std::vector<std::string> result;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (entry.path().extension() != ".piece" || expected.contains(entry.path())) continue;
    result.push_back(entry.path().string() + ": no piece of this run has that name");
  }
  return result;
}

int PieceFolder::status() const {
  int result = 0;
  for (std::size_t piece = 0; piece < plan_.pieces.size(); ++piece) {
    result = std::max(result, record(piece).at("status").get<int>());
  }
  return result;
}

json PieceFolder::merged_json() const {
  json sum = is_additive(plan_.command) ? json() : json{{"pieces", json::array()}};
  for (std::size_t piece = 0; piece < plan_.pieces.size(); ++piece) {
    const json next = io::read_json(output(piece, json_option), most_bytes);
    if (!is_additive(plan_.command)) {
      sum["pieces"].push_back({{"name", plan_.pieces[piece].name}, {"result", next}});
    } else if (sum.is_null()) {
      sum = without_means(next);
    } else {
      try {
        add(sum, without_means(next), "");
      } catch (const std::exception& error) {
        throw std::runtime_error(
            fmt::format("piece {}, {}: {}", piece, plan_.pieces[piece].name, error.what()));
      }
    }
  }
  return sum;
}

void PieceFolder::merged_text(std::string_view option,
                              const std::function<void(std::string_view)>& take) const {
  std::uint64_t closed = 0;
  std::string_view closing;
  for (std::size_t piece = 0; piece < plan_.pieces.size(); ++piece) {
    const std::string text = io::read_file(output(piece, option), most_bytes);
    std::string_view body = text;
    const std::size_t header_end = body.find('\n') + 1;
    closing = closing_word(body.substr(0, header_end));
    if (piece > 0) body.remove_prefix(header_end);
    if (!closing.empty()) {
      const std::size_t last = body.rfind('\n', body.size() - 2) + 1;
      std::uint64_t count = 0;
      const std::string_view line = body.substr(std::min(last, body.size()));
      if (line.starts_with(closing)) {
        std::from_chars(line.data() + closing.size(), line.data() + line.size(), count);
      }
      closed += count;
      body.remove_suffix(line.size());
    }
    take(body);
  }
  if (!closing.empty()) take(fmt::format("{}{}\n", closing, closed));
}

namespace {

/// Replaces this child by the program, which the system kills when the parent's thread ends.
[[noreturn]] void become(char** arguments, pid_t parent) {
  constexpr int cannot_run = 127;  // as of a shell
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent may have ended before.
  if (::getppid() != parent) ::_exit(cannot_run);
  ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
  ::execv("/proc/self/exe", arguments);
  ::_exit(cannot_run);
}

}  // namespace

int run_own_program(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid(), process = ::fork();
  if (process == 0) become(pointers.data(), parent);
  if (process < 0) throw std::system_error(errno, std::generic_category(), "cannot run a piece");
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    if (io::interrupted()) ::kill(process, SIGINT);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace touchstone::verify::jobs
