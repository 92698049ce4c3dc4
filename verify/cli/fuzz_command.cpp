// touchstone fuzz: a search for wrong answers of one solver.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/fuzz/fuzz_report.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/solvers/published.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/query_files.hpp"

namespace touchstone::verify::cli::fuzz_command {
namespace {

namespace fs = std::filesystem;

/// The maximum time, in seconds, for simplifying a finding.
constexpr double shrink_seconds = 5.0;
/// Instead of a degree: curves with weights, of degrees 1 and 2.
constexpr std::string_view rational = "rational";

struct Arguments {
  SolverArguments solver;
  SeparationArguments separation;
  double seconds = 0.0;
  std::uint64_t queries = 0;
  std::uint64_t seed = default_seed;
  std::uint64_t most_findings = 20;
  std::string kind;
  std::vector<std::string> degree;
  std::vector<std::string> only;
  std::vector<fs::path> corpus;
  std::string out_file;
  std::string json_file;
  std::string view_file;

  /// Seconds of the run; 0: no limit.
  [[nodiscard]] double run_seconds() const {
    return seconds == 0.0 && queries == 0 ? usual_fuzz_seconds : seconds;
  }

  /// The degrees in the words of the command line.
  [[nodiscard]] std::vector<std::string> degrees() const {
    return degree.empty() ? std::vector<std::string>{"1"} : degree;
  }

  /// The shapes of a degree.
  [[nodiscard]] std::vector<AnyShape> shapes(const std::string& of_degree) const {
    std::vector<AnyShape> result;
    for (const AnyKind one : kinds_of(kind)) {
      if (of_degree != rational) {
        result.push_back({.kind = one, .degree = std::stoul(of_degree)});
        continue;
      }
      result.push_back({.kind = one, .degree = 1, .is_rational = true});
      result.push_back({.kind = one, .degree = 2, .is_rational = true});
    }
    return result;
  }

  [[nodiscard]] std::vector<judge::Fault> sought() const {
    std::vector<judge::Fault> result;
    for (const std::string& name : only) result.push_back(judge::fault_from_name(name).value());
    return result;
  }
};

/// The fraction of a run that is done.
double part_of_run(const Arguments& arguments, double seconds, std::uint64_t queries) {
  const double limit = arguments.run_seconds();
  const double of_time = limit > 0.0 ? seconds / limit : 0.0;
  if (arguments.queries == 0) return of_time;
  return std::max(of_time, static_cast<double>(queries) / static_cast<double>(arguments.queries));
}

// ---- The corpus ---------------------------------------------------------------------------------

/// The kind of a file: from its path, or else from --kind.
AnyKind kind_of(const fs::path& file, const Arguments& arguments) {
  try {
    return data::kind_from_path(file);
  } catch (const io::DatasetError&) {
    if (arguments.kind.empty()) throw;
    return kind_from_string(arguments.kind);
  }
}

std::vector<base::AnyQuery> read_corpus(const Arguments& arguments, Files& files) {
  std::vector<base::AnyQuery> corpus;
  if (arguments.corpus.empty()) return corpus;
  for (const fs::path& file : data::find_datasets(arguments.corpus)) {
    files.add_dataset(file);
    const AnyKind kind = kind_of(file, arguments);
    const auto source = data::open_dataset(file, {.kind = kind});
    for (auto query = source->next(); query && !io::interrupted(); query = source->next()) {
      corpus.push_back(std::move(query->query));
    }
  }
  return corpus;
}

// ---- The dataset that is written ----------------------------------------------------------------

/// FILE itself for straight lines if its path determines the kind, else with the kind in its name;
/// for curves with shape and kind.
fs::path dataset_path(const fs::path& file, const AnyShape& shape) {
  const std::string_view kind = to_string(shape.kind);
  try {
    if (data::kind_from_path(file) != shape.kind) {
      throw std::runtime_error(
          fmt::format("{}: its name excludes {} queries; add --kind", file.string(), kind));
    }
    if (shape.is_straight()) return file;
  } catch (const io::DatasetError&) {
    // The name does not contain the kind.
  }
  std::string name = file.stem().string();
  if (!shape.is_straight()) {
    name += fmt::format("-{}-{}", shape.is_rational ? rational : "degree", shape.degree);
  }
  fs::path result = file;
  return result.replace_filename(fmt::format("{}-{}.csv", name, kind));
}

/// The findings' queries, with their truth, as datasets, one for each shape. The files appear when
/// they are complete, and only if there are queries.
class FoundQueries {
 public:
  FoundQueries(Files& files, const Arguments& arguments, const Separation& separation)
      : all_files_(files),
        name_(arguments.out_file),
        folder_(name_.has_parent_path() ? name_.parent_path() : "."),
        separation_(separation) {
    if (arguments.out_file.empty()) return;
    if (fs::path(arguments.out_file).extension() != ".csv") {
      throw std::runtime_error(arguments.out_file + ": the name must end in .csv");
    }
    require_same_separation(folder_, separation_);
    for (const std::string& degree : arguments.degrees()) {
      for (const AnyShape& shape : arguments.shapes(degree)) (void)file_of(shape);
    }
  }

  void write(const base::AnyQuery& query, bool collides) {
    if (name_.empty()) return;
    File& file = file_of(query.shape());
    file.writer.write(query, collides);
    ++file.queries;
  }

  /// The files written.
  [[nodiscard]] std::vector<fs::path> close() {
    std::vector<fs::path> written;
    for (const File& file : files_) {
      if (file.queries != 0) written.push_back(file.path);
    }
    // The separation is written first: without it the labels would be about contact.
    if (!written.empty() && !is_zero(separation_)) {
      data::write_separation(folder_, separation_);
    }
    for (File& file : files_) {
      if (file.queries != 0) file.writer.close();
    }
    return written;
  }

 private:
  struct File {
    explicit File(const fs::path& name) : path(name), writer(name) {}
    fs::path path;
    data::CsvWriter writer;
    std::uint64_t queries = 0;
  };

  /// The file of the shape, which is opened when it is first asked for: simplified queries may be
  /// of any lower degree.
  [[nodiscard]] File& file_of(const AnyShape& shape) {
    const fs::path path = dataset_path(name_, shape);
    const auto found = std::ranges::find(files_, path, &File::path);
    if (found != files_.end()) return *found;
    all_files_.add_output(path);
    return files_.emplace_back(path);
  }

  Files& all_files_;
  fs::path name_;
  fs::path folder_;
  Separation separation_;
  std::deque<File> files_;
};

// ---- The run ------------------------------------------------------------------------------------

/// A run: the search with its findings as they occur, then the reports.
class FuzzRun {
 public:
  explicit FuzzRun(const Arguments& arguments)
      : arguments_(arguments),
        json_(files_, arguments.json_file),
        view_(files_, arguments.view_file),
        found_(files_, arguments, arguments.separation.given()),
        bar_("fuzz") {
    files_.add_inputs(arguments.solver.files());
    load_method();
    options_.seconds = arguments.run_seconds();
    options_.most_queries = arguments.queries;
    options_.seed = arguments.seed;
    options_.separation = arguments.separation.given();
    report_norms(method_->info(), options_.separation);
    options_.method = arguments.solver.options;
    if (arguments.solver.exact) options_.promise = fast::Promise::exact;
    options_.query_limit_seconds = arguments.solver.query_limit;
    options_.limits = arguments.solver.limits();
    options_.most_groups = arguments.most_findings;
    options_.shrink_seconds = shrink_seconds;
    options_.only = arguments.sought();
    options_.corpus = read_corpus(arguments, files_);
    options_.shapes = chosen_shapes();
    leave_out_others();
    options_.stop = &io::interrupted();
    options_.on_progress = [this](double seconds, std::uint64_t queries) {
      bar_.update(part_of_run(arguments_, seconds, queries));
    };
    options_.on_finding = [this](const fuzz::Finding& finding) { add(finding); };
    asked_ = {.method = std::string(method_->name()),
              .plugin = plugin_ ? fs::absolute(arguments.solver.plugins.front()) : fs::path(),
              .promise = options_.promise.value_or(method_->promise()),
              .terms = method_->info().terms,
              .options = fuzz::method_options(options_),
              .query_limit_seconds = options_.query_limit_seconds,
              .limits = options_.limits};
  }

  Status run() {
    const fuzz::FuzzReport report{.solver = asked_,
                                  .seed = options_.seed,
                                  .seconds = options_.seconds,
                                  .queries = options_.most_queries,
                                  .only = options_.only,
                                  .degrees = arguments_.degrees(),
                                  .result = fuzz::fuzz(*method_, options_)};
    const nlohmann::json json = fuzz::to_json(report);
    bar_.clear();
    report_unplaced_crashes(asked_.method, report.result.unplaced_crashes);
    report_output(asked_.method, report.result.output, arguments_.solver.show_output);
    std::vector<fs::path> written;
    attempt([&] { written = found_.close(); });
    if (json_) json_.complete(io::json_document(json));
    attempt([&] { write_view(json); });
    io::print(out(), fuzz::to_text(report));
    for (const fs::path& file : written)
      io::print(out(), fmt::format("written: {}\n", io::printable(file.string())));
    io::print(out(), view_.summary());
    return status(report.result);
  }

 private:
  /// Writes findings. If it fails, the other outputs go on.
  void attempt(const std::function<void()>& write) {
    try {
      write();
    } catch (const std::exception& error) {
      bar_.clear();
      report_error(error.what());
      files_.note_failure();
    }
  }

  void write_view(const nlohmann::json& report) {
    if (!view_) return;
    std::size_t number = 0;
    for (const nlohmann::json& finding : report.at("findings")) {
      view_.add(view::query_from_json(finding, fmt::format("finding {}", number++)));
    }
    view_.write(arguments_.solver.options);
  }

  void load_method() {
    const SolverArguments& solver = arguments_.solver;
    if (solver.methods.size() + solver.plugins.size() != 1) {
      throw std::invalid_argument(
          "fuzz needs exactly one solver: name it with --method or --plugin");
    }
    if (!solver.methods.empty()) {
      method_ = &solvers::find_any(solver.methods.front());
      return;
    }
    plugin_ = solver.load(solver.plugins.front());
    method_ = plugin_.get();
  }

  /// The shapes that the command line names and the solver answers.
  /// \throws std::invalid_argument if it answers none of a degree.
  [[nodiscard]] std::vector<AnyShape> chosen_shapes() const {
    std::vector<AnyShape> result;
    for (const std::string& degree : arguments_.degrees()) {
      const std::size_t before = result.size();
      std::ranges::copy_if(
          arguments_.shapes(degree), std::back_inserter(result),
          [&](const AnyShape& shape) { return method_->info().terms.answers(shape); });
      if (result.size() == before) refuse(degree);
    }
    return result;
  }

  /// Reports the queries of the corpus that the search cannot use.
  void leave_out_others() {
    const std::size_t count = std::erase_if(options_.corpus, [&](const base::AnyQuery& query) {
      return std::ranges::find(options_.shapes, query.kind(), &AnyShape::kind) ==
             options_.shapes.end();
    });
    if (count != 0) {
      report_warning(fmt::format("--corpus: left out: {} queries of other kinds", count));
    }
  }

  [[noreturn]] void refuse(const std::string& degree) const {
    const fast::Terms& terms = method_->info().terms;
    const auto answers = [&terms](AnyKind one) { return terms.answers(one); };
    if (std::ranges::none_of(kinds_of(arguments_.kind), answers)) {
      std::vector<std::string_view> answered;
      for (const AnyKind one : all_kinds) {
        if (answers(one)) answered.push_back(to_string(one));
      }
      throw std::invalid_argument(
          fmt::format("{} answers no {} queries; it takes --kind {}", method_->name(),
                      arguments_.kind.empty() ? "vertex-face or edge-edge" : arguments_.kind,
                      fmt::join(answered, " or ")));
    }
    const std::string what = degree == "1"        ? "straight lines; add --degree for curves"
                             : degree == rational ? "rational curves"
                                                  : "curves of degree " + degree;
    throw std::invalid_argument(fmt::format("{} answers no {}queries on {}", method_->name(),
                                            arguments_.kind.empty() ? "" : arguments_.kind + " ",
                                            what));
  }

  [[nodiscard]] std::FILE* out() const { return files_.summary_stream(); }

  void add(const fuzz::Finding& finding) {
    if (finding.group == groups_) {
      ++groups_;
      bar_.clear();
      io::print(stderr,
                fmt::format("after {:.1f} s: {}\n", finding.seconds, fuzz::to_line(finding)));
    }
    const fuzz::FailingCase& simplest = finding.simplest;
    const fuzz::FailingCase& original = finding.original;
    attempt([&] {
      found_.write(simplest.query, simplest.collides);
      if (simplest.query != original.query) found_.write(original.query, original.collides);
    });
  }

  [[nodiscard]] Status status(const fuzz::FuzzResult& result) const {
    const bool seeks_ends =
        fuzz::seeks(options_, judge::Fault::crash) || fuzz::seeks(options_, judge::Fault::exit);
    if (files_.has_failed()) return Status::bad_input;
    if (result.all_findings != 0 || (seeks_ends && result.unplaced_crashes != 0)) {
      return Status::wrong_answers;
    }
    if (result.ended_by == fuzz::FuzzEnd::interrupt) return Status::interrupted;
    if (result.queries != 0) return Status::all_well;
    report_error(
        fmt::format("nothing was judged: {} answered no query in {} s; increase --seconds, or set "
                    "a smaller --query-limit to find the slow query",
                    asked_.method, options_.seconds));
    return Status::bad_input;
  }

  const Arguments& arguments_;
  Files files_;
  Output json_;
  ViewFile view_;
  FoundQueries found_;
  io::ProgressBar bar_;
  std::unique_ptr<fast::Method> plugin_;
  const fast::Method* method_ = nullptr;
  fuzz::FuzzOptions options_;
  fuzz::SolverCall asked_;
  std::size_t groups_ = 0;  ///< of findings, so far
};

// ---- The command line ---------------------------------------------------------------------------

void add_search_options(Command& command, Arguments& arguments) {
  begin_group(command, "Search");
  add_option(command, "--seconds", arguments.seconds);
  add_option(command, "--queries", arguments.queries);
  add_option(command, "--seed", arguments.seed);
  add_option(command, "--degree", arguments.degree);
  add_option(command, "--most-findings", arguments.most_findings);
  add_option(command, "--only", arguments.only);
  add_option(command, "--kind", arguments.kind);
  add_option(command, "--corpus", arguments.corpus);
  add_separation_options(command, arguments.separation);
}

void add_output_options(Command& command, Arguments& arguments) {
  begin_group(command, "Output");
  add_option(command, "--out", arguments.out_file);
  add_option(command, "--json", arguments.json_file);
  add_option(command, "--view", arguments.view_file);
}

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command = add_command(app, "fuzz", "Search for queries that a solver answers wrongly");
  add_solver_options(*command, arguments->solver);
  add_option(*command, "--exact", arguments->solver.exact);
  add_search_options(*command, *arguments);
  add_output_options(*command, *arguments);
  set_help(
      *command,
      "touchstone fuzz --plugin ./libsolver.so --only false_negative --seconds 600\n"
      "touchstone fuzz --plugin ./libsolver.so --exact --json findings.json --corpus data\n"
      "touchstone fuzz --plugin ./libsolver.so --degree 2 --degree 3",
      "The solver runs in a child process. Findings are simplified, grouped by fault, kind and "
      "shape, and printed with one example per group. The same --seed and --queries give the same "
      "findings. The search and the judgement: docs/testing.md.\n"
      "Exit status: 0 nothing found (130: interrupted), 1 findings, 2 bad input or usage, nothing "
      "judged.");
  set_action(*command, [arguments, command, &status] {
    for (const AnyKind kind : kinds_of(arguments->kind)) require_kind(*command, kind);
    settle_solver_options(*command, true, arguments->solver);
    settle_query_limit(*command, arguments->run_seconds(), arguments->solver);
    status = FuzzRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::fuzz_command
