// touchstone certify: the main job.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/certify.hpp"
#include "verify/certify_report.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/dataset/dataset.hpp"
#include "verify/families/families.hpp"
#include "verify/terminal.hpp"

namespace touchstone::verify::cli {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> paths;
  std::string kind;
  bool round = false;
  bool keep_going = false;
  std::string json_file;
  std::string truth_file;
  unsigned threads = 0;
  std::uint64_t seed = default_seed;
  std::uint64_t count = 1000;
};

/// One run: its sources one after the other, then its reports.
class CertifyRun {
 public:
  explicit CertifyRun(const Arguments& arguments)
      : arguments_(arguments), json_(arguments.json_file), truth_(arguments.truth_file) {
    if (json_.is(arguments.truth_file)) {
      throw std::runtime_error(arguments.json_file + ": named for two outputs");
    }
    if (truth_) truth_.write(truth_header());
  }

  Status run() {
    static constexpr auto replace_bad_utf8 = nlohmann::json::error_handler_t::replace;
    if (arguments_.paths.empty()) {
      certify_built_in_set();
    } else {
      certify_files(find_files());
    }
    // Files first: a closed standard output must not cost them.
    complete(truth_);
    write(json_, to_json(results_).dump(2, ' ', false, replace_bad_utf8) + "\n");
    complete(json_);
    fmt::print("{}", to_text(results_));
    return status();
  }

 private:
  void certify_built_in_set() {
    CertifyOptions options;
    options.toi_tolerance = 0;  // the truth of the families is exact
    for (const Family& family : families()) {
      for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
        if (stopped() || !supports(family, kind)) continue;
        certify_source(*open_family(family, kind, arguments_.seed, arguments_.count), options);
      }
    }
  }

  /// The dataset files of all paths, each once.
  std::vector<std::filesystem::path> find_files() {
    std::vector<std::filesystem::path> files;
    std::set<std::filesystem::path> seen;
    for (const std::filesystem::path& path : arguments_.paths) {
      try {
        for (const std::filesystem::path& file : find_datasets({&path, 1})) {
          if (json_.is(file) || truth_.is(file)) {
            throw std::runtime_error(file.string() + ": named for input and output");
          }
          if (seen.insert(std::filesystem::weakly_canonical(file)).second) files.push_back(file);
        }
      } catch (const DatasetError& error) {
        fail(path, error);
        if (stopped()) return {};
      }
    }
    return files;
  }

  void certify_files(const std::vector<std::filesystem::path>& files) {
    DatasetOptions options;
    if (!arguments_.kind.empty()) options.kind = kind_from_string(arguments_.kind);
    options.round = arguments_.round;
    options.keep_going = arguments_.keep_going;
    options.on_skip = [](const DatasetError& error) { report_error(error.what()); };
    for (const std::filesystem::path& file : files) {
      if (stopped()) return;
      try {
        certify_source(*open_dataset(file, options), {});
      } catch (const DatasetError& error) {
        fail(file, error);
      }
    }
  }

  void certify_source(QuerySource& source, CertifyOptions options) {
    ProgressBar progress(source.name());
    options.threads = arguments_.threads;
    options.stop = &interrupted();
    options.on_progress = [&](double fraction) { progress.update(fraction); };
    if (truth_) {
      options.on_truth = [&](const Truth& truth) {
        write(truth_, truth_row(source.name(), source.kind(), truth));
      };
    }
    results_.push_back(certify(source, options));
    if (results_.back().error) report_error(*results_.back().error);
  }

  /// A path or file that could not be opened: a result without queries.
  void fail(const std::filesystem::path& path, const DatasetError& error) {
    report_error(error.what());
    CertifyResult result;
    result.name = path.string();
    result.fail(error.what());
    results_.push_back(std::move(result));
  }

  /// Runs a step of an output. If it fails, the work goes on without that output.
  template <class Step>
  void attempt(const OptionalOutput& output, Step step) {
    if (!output || failed_outputs_.contains(&output)) return;
    try {
      step();
    } catch (const std::exception& error) {
      report_error(error.what());
      failed_outputs_.insert(&output);
    }
  }

  void write(OptionalOutput& output, const std::string& text) {
    attempt(output, [&] { output.write(text); });
  }

  void complete(OptionalOutput& output) {
    attempt(output, [&] { output.close(); });
  }

  [[nodiscard]] bool stopped() const {
    return interrupted() || (total(results_).errors != 0 && !arguments_.keep_going);
  }

  [[nodiscard]] Status status() const {
    const CertifyResult sum = total(results_);
    if (sum.label_mismatches + sum.toi_mismatches != 0) return Status::wrong_answers;
    if (!failed_outputs_.empty() || sum.errors + sum.skipped != 0) return Status::bad_input;
    return interrupted() ? Status::interrupted : Status::all_well;
  }

  const Arguments& arguments_;
  OptionalOutput json_;
  OptionalOutput truth_;
  std::vector<CertifyResult> results_;
  std::set<const OptionalOutput*> failed_outputs_;
};

}  // namespace

void add_certify_command(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "certify",
      "Decide every query exactly and hold recorded labels and times of impact against the truth");
  command->add_option("PATH", arguments->paths,
                      "Dataset files (.csv, .npy) or folders; without any, the built-in set");
  command
      ->add_option("--kind", arguments->kind,
                   "Kind of all queries, where the paths do not say it: vertex-face or edge-edge")
      ->check(CLI::IsMember({"vertex-face", "edge-edge"}));
  command->add_flag(
      "--round", arguments->round,
      "Accept coordinates that are no doubles, rounded to the nearest, and count them");
  command->add_flag(
      "--keep-going", arguments->keep_going,
      "Skip queries and files in error, name and count them (no longer all well: exit status 2)");
  command->add_option("--json", arguments->json_file, "Write the result as JSON")
      ->type_name("FILE");
  command
      ->add_option("--truth", arguments->truth_file,
                   "Write the truth as CSV: file,index,kind,collides,toi_lower,toi_upper")
      ->type_name("FILE");
  command->add_option("--threads", arguments->threads, "Cores to use (0: all)")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Seed of the built-in set")
      ->capture_default_str()
      ->check(whole_number(0, UINT64_MAX));
  command->add_option("--count", arguments->count, "Queries a family and kind of the built-in set")
      ->capture_default_str()
      ->check(whole_number(1, UINT64_MAX));
  command->footer(
      "Exit status: 0 all recorded answers are true, 1 some are not, 2 bad input or usage,\n"
      "130 interrupted (what is done by then is reported and written).\n"
      "Example: touchstone certify data/handcrafted --json result.json --truth truth.csv");
  command->callback([arguments, &status] { status = CertifyRun(*arguments).run(); });
}

}  // namespace touchstone::verify::cli
