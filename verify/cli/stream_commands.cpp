// touchstone certify, solve and prove: one run of queries through the truth and the solvers into
// files, of which each command has others. `certify` judges; `solve` decides nothing and writes the
// answers of a solver; `prove` asks no solver and writes certificates.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/sharded_run.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/certify_report.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/asked_solvers.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;
using Progress = std::function<void(double)>;

enum class Preset : std::uint8_t { certify, solve, prove };

struct Arguments {
  Preset preset = Preset::certify;
  SourceArguments sources;
  std::string shard;
  SolverArguments solvers;
  double seconds = 0.0;
  std::string json_file;
  std::string truth_file;
  std::string answers_file;
  std::string proof_file;
  std::string claim = "time_of_impact";
  std::string width;
  std::string view_file;
  std::string baseline_file;
  std::string badge_file;
  bool writes_baseline = false;
  bool table = false;
};

/// The solvers to ask. `certify` without a name judges ours, and only on the built-in set.
/// \throws std::invalid_argument if the preset needs others, or a file
SolverArguments asked_by(const Arguments& arguments) {
  SolverArguments asked = arguments.solvers;
  switch (arguments.preset) {
    case Preset::certify:
      if (asked.empty() && arguments.sources.built_in_set()) {
        asked.methods = solvers::default_methods(kinds_of(arguments.sources.kind));
      }
      break;
    case Preset::solve:
      if (asked.methods.size() + asked.plugins.size() != 1 ||
          std::ranges::count(asked.methods, "none") != 0) {
        throw std::invalid_argument(
            "solve needs exactly one solver: --method NAME or --plugin LIB.so");
      }
      if (arguments.answers_file.empty()) throw std::invalid_argument("--out has no file name");
      break;
    case Preset::prove:
      if (arguments.proof_file.empty()) throw std::invalid_argument("--prove has no file name");
  }
  return asked;
}

exact::ProveOptions proof_options(const Arguments& arguments) {
  exact::ProveOptions options;
  if (arguments.claim == "collision") options.collision_claim = exact::Claim::collision;
  if (arguments.width.empty()) return options;
  try {
    options.width = exact::rational_from_decimal(arguments.width);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("--width: " + io::fault_of_decimal(arguments.width));
  }
  if (sgn(*options.width) <= 0) throw std::invalid_argument("--width must be positive");
  return options;
}

/// A run: the sources in order, then the reports.
class StreamRun {
 public:
  explicit StreamRun(const Arguments& arguments)
      : arguments_(arguments),
        proof_options_(proof_options(arguments)),
        solvers_(files_, asked_by(arguments)),
        json_(files_, arguments.json_file),
        truth_(files_, arguments.truth_file, report::truth_header()),
        answers_(files_, arguments.answers_file, solvers::answers_header()),
        proof_(files_, arguments.proof_file, exact::certificates_header()),
        view_(files_, arguments.view_file),
        new_baseline_(files_, arguments.writes_baseline ? arguments.baseline_file : ""),
        badge_(files_, arguments.badge_file) {
    if (badge_ && solvers_.all().size() != 1) {
      throw std::runtime_error(
          fmt::format("--badge: it shows one solver (--method, --plugin), and this run judges {}",
                      solvers_.all().size()));
    }
    read_baseline();
    for (const solvers::Solver* solver : solvers_.all()) {
      sum_.methods.push_back(jobs::result_of(*solver));
    }
    if (arguments.seconds > 0.0) {
      budget_ = jobs::Budget(arguments.seconds, solvers_.all(), arguments.sources.threads);
    }
  }

  Status run() {
    for_each_source(
        arguments_.sources, files_,
        {.title = std::string(name()),
         .use = [this](data::QuerySource& source,
                       const Progress& progress) { use(source, progress); },
         .fail = [this](const fs::path& path, const io::DatasetError& error) { fail(path, error); },
         .stopped = [this] { return stopped(); },
         .begin =
             [this](std::size_t left) {
               deadline_ = budget_.begin_source(left);
               unjudged_ = left - 1;
             }});
    // Also between two sources.
    sum_.interrupted = sum_.interrupted || io::interrupted();
    report_answers();
    solvers_.report_output(arguments_.solvers.show_output);
    for (const std::string& reason : sum_.proofs.beyond_limits) report_error(reason);
    // Files first, so that they are complete even if standard output is closed.
    close_files();
    if (!is_without_queries()) print_summary();
    const Status own = status();
    if (!judges() && own != Status::all_well) return own;
    return worse(status_of_responses(), own);
  }

 private:
  // ---- The preset

  [[nodiscard]] std::string_view name() const {
    static constexpr std::array<std::string_view, 3> names{"certify", "solve", "prove"};
    return names.at(static_cast<std::size_t>(arguments_.preset));
  }
  [[nodiscard]] bool judges() const { return arguments_.preset == Preset::certify; }

  /// True if the only file that the run is for cannot be written.
  [[nodiscard]] bool has_lost_results() const {
    return !judges() && (answers_.failed() || proof_.failed());
  }
  /// Ends the source then; the failure is reported already.
  void require_results() const {
    if (has_lost_results()) throw std::runtime_error("the results cannot be written");
  }

  [[nodiscard]] bool has_baseline() const { return !arguments_.baseline_file.empty(); }

  // ---- Sources

  void use(data::QuerySource& source, const Progress& progress) {
    jobs::CertifyOptions options;
    options.separation = separation_for(arguments_.sources, source);
    separations_.push_back(options.separation);
    solvers_.report_norms(options.separation);
    // The truth of the families is exact.
    if (arguments_.sources.built_in_set()) options.toi_tolerance = 0;
    options.decides = arguments_.preset != Preset::solve;
    options.proof = proof_options_;
    options.threads = arguments_.sources.threads;
    options.stop = &io::interrupted();
    options.deadline = deadline_;
    options.solvers = solvers_.all();
    options.on_progress = progress;
    set_sinks(source, options);
    jobs::CertifyResult result = jobs::certify(source, options);
    if (has_lost_results()) {
      result.errors = 0;
    } else if (result.error) {
      report_error(*result.error);
    }
    add(std::move(result));
  }

  /// The options must live no longer than the source.
  void set_sinks(const data::QuerySource& source, jobs::CertifyOptions& options) {
    if (truth_) {
      options.on_truth = [&](const judge::GroundTruth& truth) {
        truth_.write(report::truth_row(source.name(), source.kind(), truth));
      };
    }
    if (proof_) {
      options.on_certificates = [this](std::string_view text) {
        proof_.write(text);
        require_results();
      };
    }
    if (view_) {
      options.on_wrong = [this](judge::WrongQuery wrong) {
        view_.add(view::viewed_query(std::move(wrong)));
      };
    }
    if (!answers_ && !has_baseline()) return;
    options.on_answer = [this, &source, separation = options.separation](
                            const solvers::Solver& solver, std::uint64_t index,
                            const fast::Answer& answer, const judge::Failure* failure) {
      if (has_baseline()) {
        report::add_of_query(
            baseline_,
            report::known_query(solver.name(), source.name(), source.kind(), index, separation),
            asked_);
      }
      if (!answers_) return;
      answers_.write(solvers::answer_row(source.name(), index, source.kind(), answer, failure));
      require_results();
    };
  }

  /// The result for a path or file that could not be opened: no queries.
  void fail(const fs::path& path, const io::DatasetError& error) {
    report_error(error.what());
    jobs::CertifyResult result;
    result.name = path.string();
    result.separation = arguments_.sources.separation.given();
    result.fail(error.what());
    for (const solvers::Solver* solver : solvers_.all()) {
      result.methods.push_back(jobs::result_of(*solver));
    }
    add(std::move(result));
  }

  void add(jobs::CertifyResult result) {
    sum_ += result;
    if (judges()) results_.push_back(std::move(result));
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || budget_.is_over() || has_lost_results() ||
           (sum_.errors != 0 && !arguments_.sources.keep_going);
  }

  // ---- Files

  void read_baseline() {
    const fs::path path = arguments_.baseline_file;
    if (!has_baseline() || (arguments_.writes_baseline && !fs::exists(path))) return;
    if (!arguments_.writes_baseline) files_.add_input(path);
    baseline_ = report::read_baseline(path);
  }

  /// True if nothing could be read. Then there is nothing to write.
  [[nodiscard]] bool is_without_queries() const { return sum_.queries == 0 && sum_.errors != 0; }

  void close_files() {
    if (is_without_queries()) {
      truth_.discard();
      answers_.discard();
      proof_.discard();
    }
    truth_.close();
    answers_.close();
    // Without its closing line the checker takes it for cut.
    if (io::interrupted()) {
      proof_.close_incomplete();
    } else {
      proof_.complete(exact::certificates_closing_line(sum_.proofs.certificates()));
    }
    write_results(
        json_, to_json(), arguments_.sources, [this] { return status(); },
        !sum_.interrupted && (sum_.errors == 0 || arguments_.sources.keep_going));
    write_gate();
    view_.write(arguments_.solvers.options);
  }

  /// Compares with the baseline, and writes it and the badge. A baseline remains as it was unless
  /// all queries were asked.
  void write_gate() {
    const bool is_complete = !sum_.interrupted && sum_.errors == 0;
    if (new_baseline_ && !is_complete) {
      report_warning("the baseline remains as it was: not all queries were asked");
    }
    try {
      if (has_baseline()) change_ = report::change_of(baseline_, asked_, results_);
      if (is_complete) new_baseline_.write(report::baseline_document(change_.now));
    } catch (const std::runtime_error& error) {
      report_error(error.what());
      files_.note_failure();
    }
    if (is_complete && !files_.has_failed()) {
      new_baseline_.close();
    } else {
      new_baseline_.discard();
    }
    if (badge_) badge_.complete(report::badge(sum_.methods.at(0)));
  }

  [[nodiscard]] nlohmann::json to_json() const {
    nlohmann::json document;
    if (judges()) {
      document = report::to_json(results_);
    } else {
      document =
          proof_ ? jobs::to_json(sum_.proofs) : report::answers_to_json(sum_.methods.front());
      if (proof_) {
        document["file_bytes"] = proof_.bytes();
        document["oracle_us_per_query"] = sum_.microseconds_per_query();
      }
      document["skipped"] = sum_.skipped;
      document["rounded"] = sum_.rounded;
      document["reading_errors"] = sum_.errors;
      if (const auto separation = judge::common_separation(separations_)) {
        document["separation"] = judge::to_json(*separation);
      }
    }
    document["interrupted"] = sum_.interrupted;
    return document;
  }

  // ---- The summary

  void print_summary() const {
    std::FILE* const stream = files_.summary_stream();
    if (judges()) {
      print_judgement(stream);
      return;
    }
    const auto separation = judge::common_separation(separations_);
    if (separation && !is_zero(*separation)) {
      io::print(stream, fmt::format("minimum separation {}\n", judge::to_text(*separation)));
    }
    if (answers_) io::print(stream, report::answers_to_text(sum_.methods.front()));
    if (proof_) {
      io::print(stream,
                fmt::format("{}oracle {:.2f} µs/query, file {} bytes\n", jobs::to_text(sum_.proofs),
                            sum_.microseconds_per_query(), proof_.bytes()));
    }
    io::print(stream, report::reading_text(sum_.skipped, sum_.rounded));
  }

  void print_judgement(std::FILE* stream) const {
    // No more than 25 lines, with those below.
    const std::size_t lines = has_baseline() ? 12 : 22;
    io::print(stream,
              arguments_.table ? report::to_text(results_) : report::to_summary(results_, lines));
    if (has_baseline()) io::print(stream, report::to_text(change_));
    if (!arguments_.table) io::print(stream, next_steps());
    if (proof_) io::print(stream, fmt::format("\n{}", jobs::to_text(sum_.proofs)));
    if (arguments_.seconds > 0.0) print_unjudged(stream);
    io::print(stream, view_.summary(allowed_false_positives()));
  }

  /// Advice below the summary.
  [[nodiscard]] std::string next_steps() const {
    std::string text = "next:  --table prints every file and column";
    if (!json_) text += ", --json FILE keeps them";
    text += '\n';
    if (!view_ && std::ranges::any_of(results_, can_be_drawn)) {
      text += "       --view FILE.html shows these queries in a browser\n";
    }
    if (!change_.mended.empty() && !new_baseline_) {
      text += "       --write-baseline removes what is mended from the baseline\n";
    }
    return text + (arguments_.solvers.empty()
                       ? "       --plugin ./libsolver.so judges your solver (docs/testing.md)\n"
                       : "       touchstone fuzz searches for further wrong answers\n");
  }

  /// True if there is a wrong answer that the page draws.
  static bool can_be_drawn(const jobs::CertifyResult& result) {
    return result.shape && !result.shape->kind.is_cell() && jobs::has_wrong_answers(result);
  }

  /// The sources whose queries were not all judged in the time of the run; by name in the table.
  void print_unjudged(std::FILE* stream) const {
    std::size_t cut = 0;
    for (const jobs::CertifyResult& result : results_) {
      if (!result.interrupted) continue;
      ++cut;
      if (!arguments_.table) continue;
      io::print(stream, fmt::format("not judged in time: {}: all after the first {} queries\n",
                                    io::printable(result.name), result.queries));
    }
    if (cut != 0 && !arguments_.table) {
      io::print(stream, fmt::format("not judged in time: a part of {} sources\n", cut));
    }
    if (budget_.is_over() && unjudged_ != 0) {
      io::print(stream, fmt::format("not judged in time: {} further sources\n", unjudged_));
    }
  }

  [[nodiscard]] std::uint64_t allowed_false_positives() const {
    std::uint64_t sum = 0;
    for (const jobs::MethodResult& method : sum_.methods) {
      if (judge::breaks(judge::Fault::false_positive, method.promise)) continue;
      sum += method.judgement.count(judge::Fault::false_positive);
    }
    return sum;
  }

  /// Reports queries without a recorded answer, and answers without a query.
  void report_answers() const {
    for (std::size_t i = 0; i < sum_.methods.size(); ++i) {
      const jobs::MethodResult& method = sum_.methods[i];
      report_unplaced_crashes(method.name, method.judgement.unplaced_crashes);
      if (method.judgement.missing == 0) continue;
      const auto first = std::ranges::find_if(results_, [i](const jobs::CertifyResult& result) {
        return result.methods[i].judgement.first_missing.has_value();
      });
      report_error(fmt::format("{}: no answer to {} queries, first to {} query {} of {}",
                               method.name, method.judgement.missing,
                               to_string(first->shape.value().kind),
                               first->methods[i].judgement.first_missing.value(), first->name));
    }
    // A run that ended early did not solve all queries.
    if (sum_.interrupted || sum_.errors != 0 || budget_.is_over()) return;
    for (const std::string& warning : solvers_.warnings()) report_warning(warning);
  }

  // ---- The status

  /// The status that follows from the solvers' responses; for a part the sum of all determines it.
  [[nodiscard]] Status status_of_responses() const {
    Status status = Status::all_well;
    if (io::interrupted() || arguments_.sources.is_part()) return status;
    for (const jobs::MethodResult& method : sum_.methods) {
      if (method.judgement.missing != 0) continue;
      status = worse(status, status_of(method.name, judge::Responses::of(method.judgement)));
    }
    return status;
  }

  /// True if an answer is wrong, and not in the baseline.
  [[nodiscard]] bool has_new_wrong_answers() const {
    if (!has_baseline()) return jobs::has_wrong_answers(sum_);
    const auto has_crashed = [](const jobs::MethodResult& method) {
      return method.judgement.unplaced_crashes != 0;
    };
    return sum_.label_mismatches + sum_.toi_mismatches != 0 ||
           (!change_.fresh.empty() && !new_baseline_) ||
           std::ranges::any_of(sum_.methods, has_crashed);
  }

  [[nodiscard]] Status status() const {
    const auto is_incomplete = [](const jobs::MethodResult& method) {
      return method.judgement.missing != 0;
    };
    if (files_.has_failed()) return Status::bad_input;
    if (judges() && has_new_wrong_answers()) return Status::wrong_answers;
    if (sum_.errors + sum_.skipped != 0 || !sum_.proofs.beyond_limits.empty() ||
        std::ranges::any_of(sum_.methods, is_incomplete)) {
      return Status::bad_input;
    }
    if (io::interrupted()) return Status::interrupted;
    return status_of_queries(arguments_.sources, sum_.queries);
  }

  const Arguments& arguments_;
  exact::ProveOptions proof_options_;
  Files files_;
  Solvers solvers_;
  Output json_;
  Output truth_;
  Output answers_;
  Output proof_;
  ViewFile view_;
  Output new_baseline_;
  Output badge_;
  report::KnownAnswers baseline_;
  report::KnownAnswers asked_;  ///< those of the baseline whose queries were asked
  report::BaselineChange change_;
  jobs::Budget budget_;
  base::Deadline deadline_;
  std::size_t unjudged_ = 0;                  ///< sources after the latest one
  std::vector<Separation> separations_;       ///< of the sources that were opened
  std::vector<jobs::CertifyResult> results_;  ///< of a run that judges
  jobs::CertifyResult sum_;
};

/// Runs the command after its line is parsed.
void set_run(Command& command, const std::shared_ptr<Arguments>& arguments, Status& status) {
  set_action(command, [arguments, &command, &status] {
    settle_solver_options(command, arguments->sources.built_in_set(), arguments->solvers);
    settle_query_limit(command, arguments->seconds, arguments->solvers);
    set_shard(command, arguments->shard, arguments->sources);
    status = StreamRun(*arguments).run();
  });
}

}  // namespace

void certify_command::add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command = add_command(
      app, "certify", "Decide queries exactly; compare answers and solvers with the truth");
  add_source_options(*command, arguments->sources);
  add_option(*command, "--shard", arguments->shard);
  add_solver_options(*command, arguments->solvers);
  add_option(*command, "--results", arguments->solvers.results);
  add_option(*command, "--exact", arguments->solvers.exact);
  add_option(*command, "--seconds", arguments->seconds);
  begin_group(*command, "Output");
  add_option(*command, "--json", arguments->json_file);
  add_option(*command, "--truth", arguments->truth_file);
  add_option(*command, "--prove", arguments->proof_file);
  add_option(*command, "--view", arguments->view_file);
  add_option(*command, "--table", arguments->table);
  add_option(*command, "--baseline", arguments->baseline_file);
  add_option(*command, "--write-baseline", arguments->writes_baseline);
  add_option(*command, "--badge", arguments->badge_file);
  set_help(*command,
           "touchstone certify data/handcrafted --json result.json\n"
           "touchstone certify --min-separation 1e-8 --norm linf --method tight_inclusion\n"
           "touchstone certify --degree 2 --degree rational --plugin ./libsolver.so",
           "By default our solvers are judged, and only on the built-in set; --method none "
           "disables this. Definitions of wrong answers: docs/testing.md.\n" +
               std::string(answering_statuses));
  set_run(*command, arguments, status);
}

void solve_command::add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->preset = Preset::solve;
  Command* command =
      add_command(app, "solve", "Write the answers of a solver to all queries as CSV");
  add_source_options(*command, arguments->sources);
  add_option(*command, "--shard", arguments->shard);
  add_solver_options(*command, arguments->solvers);
  add_option(*command, "--t-max", arguments->solvers.options.t_max);
  begin_group(*command, "Output");
  add_option(*command, "--out", arguments->answers_file);
  add_option(*command, "--json", arguments->json_file);
  set_help(*command, "touchstone solve --plugin ./libsolver.so data/handcrafted --out answers.csv",
           "Exit status: 0 success, 1 the solver hangs (docs/testing.md), 2 bad input or usage, or "
           "nothing asked or answered, 130 interrupted (results so far are written).");
  set_run(*command, arguments, status);
}

void prove_command::add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->preset = Preset::prove;
  Command* command =
      add_command(app, "prove", "Write a proof of each verdict, for touchstone-check");
  add_source_options(*command, arguments->sources);
  add_option(*command, "--shard", arguments->shard);
  begin_group(*command, "Output");
  add_option(*command, "--prove", arguments->proof_file);
  add_option(*command, "--claim", arguments->claim);
  add_option(*command, "--width", arguments->width);
  add_option(*command, "--json", arguments->json_file);
  set_help(*command,
           "touchstone prove data/handcrafted --prove handcrafted.cert.zst\n"
           "zstdcat handcrafted.cert.zst | touchstone-check -",
           "A query whose proof exceeds the limits of the format is bad input.\n" +
               std::string(writing_statuses));
  set_run(*command, arguments, status);
}

}  // namespace touchstone::verify::cli
