// touchstone solve: a solver's answers as a file.

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
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
#include "verify/cli/sharded_run.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/judge/terms.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/answers.hpp"

namespace touchstone::verify::cli::solve_command {
namespace {

namespace fs = std::filesystem;
using Progress = std::function<void(double)>;

struct Arguments {
  SourceArguments sources;
  std::string shard;
  SolverArguments solver;
  std::string out_file;
  std::string json_file;
};

/// The only solver on the command line.
SolverArguments the_solver(const Arguments& arguments) {
  if (arguments.solver.methods.size() + arguments.solver.plugins.size() != 1 ||
      (!arguments.solver.methods.empty() && arguments.solver.methods.front() == "none")) {
    throw std::invalid_argument("solve needs exactly one solver: --method NAME or --plugin LIB.so");
  }
  if (arguments.out_file.empty()) throw std::invalid_argument("--out has no file name");
  return arguments.solver;
}

/// Answers by verdict. A missing answer (judge::Fault) counts as an error or as undecided, and by
/// its failure.
struct AnswerCounts {
  std::uint64_t yes = 0;
  std::uint64_t no = 0;
  std::uint64_t undecided = 0;
  std::uint64_t errors = 0;
  report::FailureCounts failures{};

  void add(const fast::Answer& answer, const judge::Failure* failure) {
    using fast::Verdict;
    Verdict verdict = answer.verdict;
    if (const auto why = failure != nullptr ? std::optional(*failure) : judge::failure_of(answer)) {
      ++failures[static_cast<std::size_t>(why->kind)];
      verdict = judge::verdict_of(why->kind);
    }
    yes += verdict == Verdict::yes ? 1U : 0U;
    no += verdict == Verdict::no ? 1U : 0U;
    undecided += verdict == Verdict::undecided ? 1U : 0U;
    errors += verdict == Verdict::error ? 1U : 0U;
  }
};

/// A run: the sources in order, then the summary.
class SolveRun {
 public:
  explicit SolveRun(const Arguments& arguments)
      : arguments_(arguments),
        solvers_(files_, the_solver(arguments)),
        solver_(*solvers_.all().front()),
        out_(files_, arguments.out_file),
        json_(files_, arguments.json_file) {
    out_.write(solvers::answers_header());
  }

  Status run() {
    for_each_source(
        arguments_.sources, files_,
        {.title = "solve",
         .use = [this](data::QuerySource& source,
                       const Progress& progress) { solve_source(source, progress); },
         .fail = [this](const fs::path&, const io::DatasetError& error) { fail(error.what()); },
         .stopped = [this] { return stopped(); }});
    // Also between two sources.
    sum_.interrupted = sum_.interrupted || io::interrupted();
    if (is_without_queries()) {
      out_.discard();
    } else {
      out_.close();
    }
    const bool is_complete =
        !sum_.interrupted && (reading_errors_ == 0 || arguments_.sources.keep_going);
    write_results(
        json_, summary(), arguments_.sources, [this] { return status(); }, is_complete);
    report_unplaced_crashes(solver_.name(), asked_.unplaced_crashes);
    solvers_.report_output(arguments_.solver.show_output);
    print_summary();
    return status();
  }

 private:
  [[nodiscard]] std::uint64_t unasked() const {
    return asked_.missing + asked_.outside + asked_.left_out;
  }

  /// True if nothing could be read. Then there is nothing to write.
  [[nodiscard]] bool is_without_queries() const {
    return asked_.queries == 0 && reading_errors_ != 0;
  }

  void print_summary() const {
    if (is_without_queries()) return;
    std::FILE* const stream = files_.summary_stream();
    const auto separation = judge::common_separation(separations_);
    if (separation && !is_zero(*separation)) {
      io::print(stream, fmt::format("minimum separation {}\n", judge::to_text(*separation)));
    }
    io::print(
        stream,
        fmt::format("{}: {} queries, {} yes, {} no, {} undecided, {} errors, {:.1f} ns/query\n",
                    solver_.name(), asked_.queries, counts_.yes, counts_.no, counts_.undecided,
                    counts_.errors, asked_.nanoseconds_per_query()));
    if (unasked() != 0) {
      io::print(stream, fmt::format("not asked: {} queries outside its terms{}, or similar to "
                                    "those at which it hangs\n",
                                    unasked(), judge::to_text(solver_.terms())));
    }
    const std::string failures = report::to_text(counts_.failures);
    if (!failures.empty()) io::print(stream, fmt::format("no answer: {}\n", failures));
    io::print(stream, report::reading_text(sum_.skipped, sum_.rounded));
  }

  void solve_source(data::QuerySource& source, const Progress& progress) {
    jobs::CertifyOptions options;
    options.separation = separation_for(arguments_.sources, source);
    separations_.push_back(options.separation);
    solvers_.report_norms(options.separation);
    options.decides = false;
    options.threads = arguments_.sources.threads;
    options.stop = &io::interrupted();
    options.solvers = solvers_.all();
    options.on_progress = progress;
    options.on_answer = [&](const solvers::Solver&, std::uint64_t index, const fast::Answer& answer,
                            const judge::Failure* failure) {
      counts_.add(answer, failure);
      out_.write(solvers::answer_row(source.name(), index, source.kind(), answer, failure));
      // An exception ends the run immediately; the failure was already reported.
      if (out_.failed()) throw std::runtime_error("answers cannot be written");
    };
    const jobs::CertifyResult result = jobs::certify(source, options);
    sum_ += result;
    asked_ += result.methods.front().judgement;
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
    nlohmann::json json{{"method", solver_.name()},
                        {"queries", asked_.queries},
                        {"yes", counts_.yes},
                        {"no", counts_.no},
                        {"undecided", counts_.undecided},
                        {"errors", counts_.errors},
                        {"unasked", unasked()},
                        {"unplaced_crashes", asked_.unplaced_crashes},
                        {"ns_per_query", asked_.nanoseconds_per_query()},
                        {"skipped", sum_.skipped},
                        {"rounded", sum_.rounded},
                        {"reading_errors", reading_errors_},
                        {"interrupted", sum_.interrupted}};
    json["failures"] = report::to_json(counts_.failures);
    if (const auto separation = judge::common_separation(separations_)) {
      json["separation"] = judge::to_json(*separation);
    }
    return json;
  }

  [[nodiscard]] Status status() const {
    if (files_.has_failed() || reading_errors_ + sum_.skipped != 0) {
      return Status::bad_input;
    }
    if (io::interrupted()) return Status::interrupted;
    if (arguments_.sources.is_part()) return Status::all_well;
    if (asked_.queries + unasked() == 0) return status_of_queries(arguments_.sources, 0);
    return status_of(solver_.name(),
                     {.asked = asked_.queries,
                      .hangs = counts_.failures[static_cast<std::size_t>(judge::Fault::hang)],
                      .errors = counts_.errors,
                      .unasked = unasked()});
  }

  const Arguments& arguments_;
  Files files_;
  Solvers solvers_;
  const solvers::Solver& solver_;
  Output out_;
  Output json_;
  jobs::CertifyResult sum_;
  judge::Judgement asked_;  ///< the queries that the solver was asked
  AnswerCounts counts_;
  std::vector<Separation> separations_;  // of the sources
  std::uint64_t reading_errors_ = 0;
};

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("solve", "Write the answers of a solver to all queries as CSV");
  add_source_options(*command, arguments->sources);
  add_option(*command, "--shard", arguments->shard);
  add_solver_options(*command, arguments->solver);
  add_option(*command, "--t-max", arguments->solver.options.t_max);
  command->option_defaults()->group("Output");
  add_option(*command, "--out", arguments->out_file);
  add_option(*command, "--json", arguments->json_file);
  set_help(*command, "touchstone solve --plugin ./libsolver.so data/handcrafted --out answers.csv",
           "Exit status: 0 success, 1 the solver hangs (docs/testing.md), 2 bad input or usage, or "
           "nothing asked or answered, 130 interrupted (results so far are written).");
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, arguments->sources.built_in_set(), arguments->solver);
    set_shard(*command, arguments->shard, arguments->sources);
    status = SolveRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::solve_command
