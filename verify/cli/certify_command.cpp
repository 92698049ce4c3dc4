// touchstone certify: the main job.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/cli/certificates_file.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/report/certify_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;
using Progress = std::function<void(double)>;

struct Arguments {
  SourceArguments sources;
  SolverArguments judged;
  std::string json_file;
  std::string truth_file;
  std::string proof_file;
};

/// Which solvers to judge: where the user names none, the default methods, on the built-in set only.
SolverArguments judged_by(const Arguments& arguments) {
  SolverArguments judged = arguments.judged;
  if (judged.empty() && arguments.sources.built_in_set()) {
    judged.methods = solvers::default_methods();
  }
  return judged;
}

/// One run: its sources one after the other, then its reports.
class CertifyRun {
 public:
  explicit CertifyRun(const Arguments& arguments)
      : arguments_(arguments),
        solvers_(judged_by(arguments)),
        json_(arguments.json_file),
        truth_(arguments.truth_file),
        proof_(arguments.proof_file) {
    require_one_name(arguments.json_file, json_.is(arguments.truth_file));
    require_one_name(arguments.proof_file,
                     proof_.is(arguments.json_file) || proof_.is(arguments.truth_file));
    for (const fs::path& file : arguments.judged.files()) {
      if (is_output(file)) throw std::runtime_error(file.string() + ": named for input and output");
    }
    if (truth_) truth_.write(report::truth_header());
  }

  Status run() {
    for_each_source(arguments_.sources,
                    {.title = "certify",
                     .use = [this](data::QuerySource& source,
                                   const Progress& progress) { certify_source(source, progress); },
                     .fail = [this](const fs::path& path,
                                    const data::DatasetError& error) { fail(path, error); },
                     .stopped = [this] { return stopped(); },
                     .is_output = [this](const fs::path& path) { return is_output(path); }});
    report_answers();
    solvers_.report_output(arguments_.judged.show_output);
    // Files first: a closed standard output must not cost them.
    truth_.close();
    proof_.close(sum_.proofs.certificates());
    if (json_) json_.write(io::json_document(report::to_json(results_)));
    json_.close();
    print_summary();
    return status();
  }

 private:
  static void require_one_name(const std::string& file, bool is_another) {
    if (is_another) throw std::runtime_error(file + ": named for two outputs");
  }

  [[nodiscard]] bool is_output(const fs::path& path) const {
    return json_.is(path) || truth_.is(path) || proof_.is(path);
  }

  void print_summary() const {
    const bool is_standard_output =
        json_.is_standard_output() || truth_.is_standard_output() || proof_.is_standard_output();
    std::FILE* const stream = is_standard_output ? stderr : stdout;
    io::print(stream, report::to_text(results_));
    if (proof_) io::print(stream, fmt::format("\n{}", jobs::to_text(sum_.proofs)));
    report_beyond_limits(sum_.proofs);
  }

  void certify_source(data::QuerySource& source, const Progress& progress) {
    jobs::CertifyOptions options;
    options.separation = separation_for(arguments_.sources, source);
    // The truth of the families is exact.
    if (arguments_.sources.built_in_set()) options.toi_tolerance = 0;
    options.threads = arguments_.sources.threads;
    options.stop = &io::interrupted();
    options.solvers = solvers_.all();
    options.on_progress = progress;
    if (truth_) {
      options.on_truth = [&](const judge::Truth& truth) {
        truth_.write(report::truth_row(source.name(), source.kind(), truth));
      };
    }
    if (proof_) {
      options.on_certificates = [this](std::string_view text) { proof_.write(text); };
    }
    add(jobs::certify(source, options));
    if (results_.back().error) report_error(*results_.back().error);
  }

  /// A path or file that could not be opened: a result without queries.
  void fail(const fs::path& path, const data::DatasetError& error) {
    report_error(error.what());
    jobs::CertifyResult result;
    result.name = path.string();
    result.separation = arguments_.sources.separation.given();
    result.fail(error.what());
    for (const solvers::Solver* solver : solvers_.all()) {
      result.methods.push_back(
          {solver->name(), solver->promise(), solver->is_timed(), judge::Judgement{}});
    }
    add(std::move(result));
  }

  void add(jobs::CertifyResult result) {
    sum_ += result;
    results_.push_back(std::move(result));
  }

  /// Says which queries have no recorded answer, and which answers have no query.
  void report_answers() const {
    for (std::size_t i = 0; i < sum_.methods.size(); ++i) {
      const jobs::MethodResult& method = sum_.methods[i];
      report_unplaced_crashes(method.name, method.judgement.unplaced_crashes);
      if (method.judgement.missing == 0) continue;
      const auto first = std::ranges::find_if(results_, [i](const jobs::CertifyResult& result) {
        return i < result.methods.size() && result.methods[i].judgement.first_missing;
      });
      report_error(fmt::format("{}: no answer to {} queries, first to {} query {} of {}",
                               method.name, method.judgement.missing,
                               to_string(first->kind.value()),
                               first->methods[i].judgement.first_missing.value(), first->name));
    }
    // What ended early did not ask for all.
    if (sum_.interrupted || sum_.errors != 0) return;
    for (const std::string& warning : solvers_.warnings()) report_warning(warning);
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || (sum_.errors != 0 && !arguments_.sources.keep_going);
  }

  [[nodiscard]] Status status() const {
    const auto is_wrong = [](const jobs::MethodResult& method) {
      return !judge::keeps(method.judgement, method.promise);
    };
    const auto is_incomplete = [](const jobs::MethodResult& method) {
      return method.judgement.missing != 0;
    };
    if (sum_.label_mismatches + sum_.toi_mismatches != 0 ||
        std::ranges::any_of(sum_.methods, is_wrong)) {
      return Status::wrong_answers;
    }
    if (json_.failed() || truth_.failed() || proof_.failed() || sum_.errors + sum_.skipped != 0 ||
        !sum_.proofs.beyond_limits.empty() || std::ranges::any_of(sum_.methods, is_incomplete)) {
      return Status::bad_input;
    }
    return io::interrupted() ? Status::interrupted : Status::all_well;
  }

  const Arguments& arguments_;
  Solvers solvers_;
  ReportedOutput json_;
  ReportedOutput truth_;
  CertificatesFile proof_;
  std::vector<jobs::CertifyResult> results_;
  jobs::CertifyResult sum_;
};

void add_judged_options(CLI::App& command, SolverArguments& judged) {
  add_solver_options(command, judged);
  command
      .add_option("--results", judged.results,
                  "Judge the answers of this file: file,index,kind,verdict,toi_lower,toi_upper,"
                  "tolerance and maybe failure (as touchstone solve writes it)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_flag("--exact", judged.exact,
                   "Hold every solver to exactness: false positives are wrong answers too");
}

}  // namespace

void add_certify_command(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "certify",
      "Decide every query exactly and hold recorded labels and times of impact, and the "
      "answers of solvers, against the truth");
  add_source_options(*command, arguments->sources);
  add_judged_options(*command, arguments->judged);
  command->add_option("--json", arguments->json_file, "Write the result as JSON")
      ->type_name("FILE");
  command
      ->add_option("--truth", arguments->truth_file,
                   "Write the truth as CSV: file,index,kind,collides,toi_lower,toi_upper")
      ->type_name("FILE");
  command
      ->add_option("--prove", arguments->proof_file,
                   "Write a proof of every verdict, as touchstone prove does")
      ->type_name("FILE");
  command->footer(
      "Solvers: --method, --plugin and --results may each be given several times. Without any of\n"
      "them, those of ours that promise something are judged on the built-in set (--method none:\n"
      "no solver), and no solver on other queries.\n"
      "Exit status: 0 all recorded answers are true and all solvers keep their promise, 1 some "
      "are\n"
      "not or do not (every solver must be free of false negatives, of times of impact that "
      "exclude\n"
      "the true one and of errors, an exact one of false positives too), 2 bad input, a query\n"
      "without a recorded answer, or bad usage, 130 interrupted (what is done by then is reported\n"
      "and written).\n"
      "With --min-separation the truth is about that distance; of what is recorded about contact "
      "only\n"
      "what follows is compared: a collision must collide, no later.\n"
      "A yes is held to the tolerance it comes with: the primitives must come within it and the\n"
      "distance (of Tight-Inclusion twice its filter, too).\n"
      "Example: touchstone certify data/handcrafted --json result.json --truth truth.csv\n"
      "Example: touchstone certify --min-separation 1e-8 --norm l2 --method tight_inclusion");
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, arguments->sources.built_in_set(), arguments->judged);
    status = CertifyRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli
