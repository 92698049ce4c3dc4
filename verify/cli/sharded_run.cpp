#include "verify/cli/sharded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/generate/random_stream.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/json.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t most_bytes = std::size_t{1} << 31U;

// ---- Shards -------------------------------------------------------------------------------------

/// \throws std::invalid_argument if the text is no I/N with I < N
Shard shard_of(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = io::number_from_text<std::size_t>(text.substr(0, slash));
  const auto count =
      io::number_from_text<std::size_t>(text.substr(std::min(slash + 1, text.size())));
  if (index && count && *index < *count) return {*index, *count};
  throw std::invalid_argument(
      fmt::format("--shard: '{}' is not I/N, as 0/4 or 3/4: part I of N, from 0 on", text));
}

// ---- What the parts of a run have in common -----------------------------------------------------

std::string digest_of(std::string_view text) {
  return fmt::format("{:016x}", generate::hash(text));
}
std::string digest_of_file(const fs::path& file) {
  return digest_of(io::read_file(file, most_bytes));
}

/// The identity of the program: its version, and its digest if the version does not identify the
/// sources.
std::string program() {
  std::string text(version());
  if (!text.ends_with(')') || text.ends_with("-dirty)")) {
    text += ", digest " + digest_of_file("/proc/self/exe");
  }
  return text;
}

/// The options that results depend on, in the order of the help.
std::vector<std::string> options_of(const Command& command) {
  static const std::set<std::string> others{"PATH",   "--shard", "--threads", "--show-output",
                                            "--json", "--truth", "--prove",   "--view",
                                            "--out",  "--table", "--badge"};
  std::vector<std::string> options;
  for (const auto& [option, value] : given_options(command)) {
    if (!others.contains(option)) options.push_back(fmt::format("{}={}", option, value));
  }
  return options;
}

/// The digests of the files that options name.
json uses_of(const std::vector<std::string>& options) {
  json uses = json::object();
  for (const std::string& option : options) {
    const std::string file = option.substr(option.find('=') + 1);
    if (fs::is_regular_file(file)) uses[file] = digest_of_file(file);
  }
  return uses;
}

/// The digest of the names and sizes of all inputs, and of their companions.
std::string inputs_of(const SourceArguments& sources) {
  std::string text;
  for (const fs::path& file : data::find_datasets(sources.paths)) {
    text += fmt::format("{}\n{}\n", file.string(), fs::file_size(file));
    for (const fs::path& companion : data::find_ground_truth_files(file)) {
      text += fmt::format("{}\n{}\n", companion.string(), fs::file_size(companion));
    }
  }
  return digest_of(text);
}

// ---- The sum ------------------------------------------------------------------------------------

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

/// Adds the result of the next part. Counts are summed, of greatest values the greater is kept,
/// lists are joined, and everything else must agree.
/// \throws std::invalid_argument that names the difference.
void add(json& sum, const json& next, const std::string& key) {
  if (sum.is_object() && sum.contains("histogram")) {
    judge::ToiErrors errors = judge::toi_errors_from_json(sum);
    sum = judge::to_json(errors += judge::toi_errors_from_json(next));
  } else if (key == "toi_error" && (sum.is_null() || next.is_null())) {
    if (sum.is_null()) sum = next;
  } else if (key == "separation") {
    if (sum != next) sum = nullptr;  // none is common
  } else if (sum.is_array() && next.is_array() && (sum.empty() || next.empty())) {
    if (sum.empty()) sum = next;  // a part without sources has no methods
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

std::string number_text(const json& of, const char* key) {
  return of.contains(key) ? of.at(key).dump() : "0";
}

/// The main counts: of certificates, or of queries with a line for each method.
std::string summary_text(const json& total) {
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
  for (const json& method : total.at("methods")) {
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

/// The status that follows from the solvers' responses to the queries of all parts.
Status status_of_responses(const json& total) {
  const auto responses = [](const json& counts) -> judge::Responses {
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
  for (const json& method : total.value("methods", json::array())) {
    status = worse(status, status_of(method.at("name").get<std::string>(), responses(method)));
  }
  return status;
}

// ---- Parts --------------------------------------------------------------------------------------

struct Part {
  fs::path file;
  json shard;
  json result;
};

/// \throws std::runtime_error if it is not that of a part
Part read_part(const fs::path& file) {
  Part part{.file = file, .shard = {}, .result = io::read_json(file, most_bytes)};
  try {
    part.shard = part.result.at("shard");
    part.result.erase("shard");
    static_cast<void>(part.shard.at("status").get<int>());
    if (part.shard.at("index").get<std::size_t>() < part.shard.at("count").get<std::size_t>()) {
      return part;
    }
  } catch (const json::exception&) {
    // as below
  }
  throw std::runtime_error(file.string() +
                           ": no result of a part; --shard I/N --json FILE writes them");
}

/// \throws std::runtime_error if they are of two runs
void require_one_run(const Part& first, const Part& other) {
  for (const char* what : {"program", "command", "options", "uses", "inputs", "count"}) {
    const json a = first.shard.value(what, json()), b = other.shard.value(what, json());
    if (a == b) continue;
    throw std::runtime_error(fmt::format("{}: of another run than {}: {} {}, not {}",
                                         other.file.string(), first.file.string(), what, b.dump(),
                                         a.dump()));
  }
}

/// The parts in order. \throws std::runtime_error if they are not those of one run, each once.
std::map<std::size_t, Part> read_parts(const std::vector<fs::path>& files) {
  std::map<std::size_t, Part> parts;
  for (const fs::path& file : files) {
    Part part = read_part(file);
    if (!parts.empty()) require_one_run(parts.begin()->second, part);
    const auto index = part.shard.at("index").get<std::size_t>();
    const auto [place, is_new] = parts.try_emplace(index, std::move(part));
    if (!is_new) {
      throw std::runtime_error(fmt::format("{}: has part {}, as has {}", file.string(), index,
                                           place->second.file.string()));
    }
  }
  const auto count = parts.begin()->second.shard.at("count").get<std::size_t>();
  std::size_t missing = 0;
  while (parts.contains(missing)) ++missing;
  if (missing == count) return parts;
  const std::size_t others = count - parts.size() - 1;
  throw std::runtime_error(fmt::format("part {} of {} is missing{}: nothing is added up", missing,
                                       count,
                                       others == 0 ? "" : fmt::format(", and {} others", others)));
}

json sum_of(const std::map<std::size_t, Part>& parts) {
  json sum;
  for (const auto& [index, part] : parts) {
    try {
      const json next = without_means(part.result);
      if (sum.is_null()) {
        sum = next;
      } else {
        add(sum, next, "");
      }
    } catch (const std::exception& error) {
      throw std::runtime_error(part.file.string() + ": " + io::reason_of(error));
    }
  }
  return sum;
}

}  // namespace

void set_shard(const Command& command, const std::string& shard, SourceArguments& sources) {
  if (shard.empty()) return;
  sources.shard = shard_of(shard);
  const std::vector<std::string> options = options_of(command);
  sources.shard_record = json{{"index", sources.shard.index}, {"count", sources.shard.count},
                              {"program", program()},         {"command", name_of(command)},
                              {"options", options},           {"uses", uses_of(options)},
                              {"inputs", inputs_of(sources)}}
                             .dump();
}

void write_results(Output& file, nlohmann::json results, const SourceArguments& sources,
                   const std::function<Status()>& status, bool is_complete) {
  if (!file) return;
  if (sources.is_part()) {
    results["shard"] = json::parse(sources.shard_record);
    results["shard"]["status"] = static_cast<int>(status());
  }
  file.write(io::json_document(results));
  if (is_complete || !sources.is_part()) {
    file.close();
  } else {
    file.close_incomplete();
  }
}

namespace {

/// Adds up the results of all parts.
Status merge_shards(const std::vector<fs::path>& parts, const std::string& json_file) {
  Files files;
  files.add_inputs(parts);
  Output output(files, json_file);
  const std::map<std::size_t, Part> all = read_parts(parts);
  const json total = sum_of(all);
  output.complete_with([&] { return io::json_document(total); });
  io::print(files.summary_stream(),
            fmt::format("{} {}\n{}", all.size(), all.size() == 1 ? "part" : "parts",
                        summary_text(total)));
  Status status = status_of_responses(total);
  for (const auto& [index, part] : all) {
    status = worse(status, part.shard.at("status").get<Status>());
  }
  if (total.value("queries", total.value("certificates", 0U)) == 0U) {
    report_error("no query in any part: nothing was asked");
    status = worse(status, Status::bad_input);
  }
  return files.has_failed() ? Status::bad_input : status;
}

}  // namespace

void merge_command::add(Command& app, Status& status) {
  struct Arguments {
    std::vector<fs::path> parts;
    std::string json_file;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command* command =
      add_command(app, "merge", "Add up the results of all parts of a run (--shard)");
  begin_group(*command, "Input");
  add_option(*command, "parts", arguments->parts);
  begin_group(*command, "Output");
  add_option(*command, "--json", arguments->json_file);
  set_help(*command,
           "touchstone merge run/*.json   # of certify data --shard I/N --json run/I.json",
           "The sum has no times and means. A part that is missing or there twice, and one of "
           "another run, is an error that names it: version, options, the contents of files that "
           "options name, and the names and sizes of all inputs must agree.\n" +
               std::string(answering_statuses));
  set_action(*command, [arguments, &status] {
    status = merge_shards(arguments->parts, arguments->json_file);
  });
}

}  // namespace touchstone::verify::cli
