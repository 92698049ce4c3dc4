// touchstone certify: the main job.

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
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

void report_error(const std::string& message) {
  fmt::print(stderr, "touchstone: error: {}\n", message);
}

/// One run: its sources one after the other, then its reports.
class CertifyRun {
 public:
  explicit CertifyRun(const Arguments& arguments)
      : arguments_(arguments), json_(arguments.json_file), truth_(arguments.truth_file) {
    if (truth_) truth_writer_.emplace(truth_.stream());
  }

  Status run() {
    if (arguments_.paths.empty()) {
      certify_built_in_set();
    } else {
      certify_files();
    }
    fmt::print("{}", to_text(results_));
    if (json_) json_.stream() << to_json(results_).dump(2) << '\n';
    json_.close();
    truth_.close();
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

  void certify_files() {
    DatasetOptions options;
    if (!arguments_.kind.empty()) options.kind = kind_from_string(arguments_.kind);
    options.round = arguments_.round;
    options.keep_going = arguments_.keep_going;
    options.on_skip = [](const DatasetError& error) { report_error(error.what()); };
    for (const std::filesystem::path& file : find_datasets(arguments_.paths)) {
      if (stopped()) return;
      certify_file(file, options);
    }
  }

  void certify_file(const std::filesystem::path& file, const DatasetOptions& options) {
    try {
      certify_source(*open_dataset(file, options), {});
    } catch (const DatasetError& error) {
      fail(error.what());
    }
  }

  void certify_source(QuerySource& source, CertifyOptions options) {
    ProgressBar progress(source.name());
    options.threads = arguments_.threads;
    options.stop = &interrupted();
    options.on_progress = [&](double fraction) { progress.update(fraction); };
    if (truth_) {
      options.on_truth = [&](const Truth& truth) {
        truth_writer_->write(source.name(), source.kind(), truth);
      };
    }
    results_.push_back(certify(source, options));
    if (results_.back().error) fail(*results_.back().error);
  }

  void fail(const std::string& message) {
    report_error(message);
    failed_ = true;
  }

  [[nodiscard]] bool stopped() const {
    return interrupted() || (failed_ && !arguments_.keep_going);
  }

  [[nodiscard]] Status status() const {
    const CertifyResult sum = total(results_);
    if (sum.label_mismatches + sum.toi_mismatches != 0) return Status::wrong_answers;
    if (failed_ || sum.skipped != 0) return Status::bad_input;
    return interrupted() ? Status::interrupted : Status::all_well;
  }

  const Arguments& arguments_;
  OptionalOutput json_;
  OptionalOutput truth_;
  std::optional<TruthWriter> truth_writer_;
  std::vector<CertifyResult> results_;
  bool failed_ = false;
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
      "Skip queries and files in error, name and count them (the exit status is still 2)");
  command->add_option("--json", arguments->json_file, "Write the result as JSON")
      ->type_name("FILE");
  command
      ->add_option("--truth", arguments->truth_file,
                   "Write the truth as CSV: file,index,kind,collides,toi_lower,toi_upper")
      ->type_name("FILE");
  command->add_option("--threads", arguments->threads, "Cores to use (0: all)")
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Seed of the built-in set")->capture_default_str();
  command->add_option("--count", arguments->count, "Queries a family and kind of the built-in set")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->footer(
      "Exit status: 0 all recorded answers are true, 1 some are not, 2 bad input or usage.\n"
      "Example: touchstone certify data/handcrafted --json result.json --truth truth.csv");
  command->callback([arguments, &status] { status = CertifyRun(*arguments).run(); });
}

}  // namespace touchstone::verify::cli
