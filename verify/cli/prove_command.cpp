// touchstone prove: certificates for a checker that does not trust the oracle.

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/sharded_run.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/judgement_report.hpp"

namespace touchstone::verify::cli::prove_command {
namespace {

namespace fs = std::filesystem;
using Progress = std::function<void(double)>;

struct Arguments {
  SourceArguments sources;
  std::string shard;
  std::string proof_file;
  std::string json_file;
  std::string claim = "time_of_impact";
  std::string width;
};

exact::ProveOptions proof_options(const Arguments& arguments) {
  exact::ProveOptions options;
  if (arguments.claim == "collision") options.collision_claim = exact::Claim::collision;
  if (!arguments.width.empty()) {
    try {
      options.width = exact::rational_from_decimal(arguments.width);
    } catch (const std::invalid_argument&) {
      throw std::invalid_argument("--width: " + io::fault_of_decimal(arguments.width));
    }
    if (sgn(*options.width) <= 0) throw std::invalid_argument("--width must be positive");
  }
  return options;
}

/// A run: the sources in order, then the summary.
class ProveRun {
 public:
  explicit ProveRun(const Arguments& arguments)
      : arguments_(arguments),
        options_(proof_options(arguments)),
        out_(files_, named_file(arguments.proof_file)),
        json_(files_, arguments.json_file) {}

  Status run() {
    for_each_source(
        arguments_.sources, files_,
        {.title = "prove",
         .use = [this](data::QuerySource& source,
                       const Progress& progress) { prove_source(source, progress); },
         .fail = [this](const fs::path&, const io::DatasetError& error) { fail(error.what()); },
         .stopped = [this] { return stopped(); }});
    // Also between two sources.
    sum_.interrupted = sum_.interrupted || io::interrupted();
    if (is_without_queries()) {
      out_.discard();
    } else {
      out_.close(sum_.proofs.certificates());
    }
    const bool is_complete =
        !sum_.interrupted && (reading_errors_ == 0 || arguments_.sources.keep_going);
    write_results(
        json_, summary(), arguments_.sources, [this] { return status(); }, is_complete);
    report_beyond_limits(sum_.proofs);
    print_summary();
    return status();
  }

 private:
  static const std::string& named_file(const std::string& name) {
    if (name.empty()) throw std::invalid_argument("--prove has no file name");
    return name;
  }

  void prove_source(data::QuerySource& source, const Progress& progress) {
    jobs::CertifyOptions options;
    options.separation = separation_for(arguments_.sources, source);
    separations_.push_back(options.separation);
    options.compares_labels = false;
    options.threads = arguments_.sources.threads;
    options.proof = options_;
    options.stop = &io::interrupted();
    options.on_progress = progress;
    options.on_certificates = [this](std::string_view certificates) {
      out_.write(certificates);
      // An exception ends the proofs immediately; the failure was already reported.
      if (out_.failed()) throw std::runtime_error("certificates cannot be written");
    };
    const jobs::CertifyResult result = jobs::certify(source, options);
    sum_ += result;
    if (result.error && !out_.failed()) fail(*result.error);
  }

  void fail(const std::string& message) {
    report_error(message);
    ++reading_errors_;
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || out_.failed() ||
           (reading_errors_ != 0 && !arguments_.sources.keep_going);
  }

  [[nodiscard]] nlohmann::json summary() const {
    nlohmann::json result = jobs::to_json(sum_.proofs);
    result.update({{"file_bytes", out_.bytes()},
                   {"oracle_us_per_query", sum_.microseconds_per_query()},
                   {"skipped", sum_.skipped},
                   {"rounded", sum_.rounded},
                   {"reading_errors", reading_errors_},
                   {"interrupted", sum_.interrupted}});
    if (const auto separation = judge::common_separation(separations_)) {
      result["separation"] = judge::to_json(*separation);
    }
    return result;
  }

  /// True if nothing could be read. Then there is nothing to write.
  [[nodiscard]] bool is_without_queries() const {
    return sum_.proofs.certificates() == 0 && reading_errors_ != 0;
  }

  void print_summary() const {
    if (is_without_queries()) return;
    std::FILE* const stream = files_.summary_stream();
    const auto separation = judge::common_separation(separations_);
    if (separation && !is_zero(*separation)) {
      io::print(stream, fmt::format("minimum separation {}\n", judge::to_text(*separation)));
    }
    io::print(stream, jobs::to_text(sum_.proofs));
    io::print(stream, fmt::format("oracle {:.2f} µs/query, file {} bytes\n",
                                  sum_.microseconds_per_query(), out_.bytes()));
    io::print(stream, report::reading_text(sum_.skipped, sum_.rounded));
  }

  [[nodiscard]] Status status() const {
    if (files_.has_failed() || reading_errors_ + sum_.skipped != 0 ||
        !sum_.proofs.beyond_limits.empty()) {
      return Status::bad_input;
    }
    if (io::interrupted()) return Status::interrupted;
    return status_of_queries(arguments_.sources, sum_.queries);
  }

  const Arguments& arguments_;
  exact::ProveOptions options_;
  Files files_;
  CertificatesFile out_;
  Output json_;
  jobs::CertifyResult sum_;
  std::vector<Separation> separations_;  // of the sources
  std::uint64_t reading_errors_ = 0;
};

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("prove", "Write a proof of each verdict, for touchstone-check");
  add_source_options(*command, arguments->sources);
  add_option(*command, "--shard", arguments->shard);
  command->option_defaults()->group("Output");
  add_option(*command, "--prove", arguments->proof_file);
  add_option(*command, "--claim", arguments->claim);
  add_option(*command, "--width", arguments->width);
  add_option(*command, "--json", arguments->json_file);
  set_help(*command,
           "touchstone prove data/handcrafted --prove handcrafted.cert.zst\n"
           "zstdcat handcrafted.cert.zst | touchstone-check -",
           "A query whose proof exceeds the limits of the format is bad input.\n" +
               std::string(writing_statuses));
  command->callback([arguments, command, &status] {
    set_shard(*command, arguments->shard, arguments->sources);
    status = ProveRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::prove_command
