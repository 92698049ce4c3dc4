// touchstone bench: speed and error of every solver in one run.

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fast/broad_phase/search.hpp"
#include "fast/candidates.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "touchstone/certified.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/workload.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/bench.hpp"
#include "verify/jobs/step_bench.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/mesh/moving_mesh.hpp"
#include "verify/report/bench_report.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::cli::bench_command {
namespace {

namespace fs = std::filesystem;
using Progress = std::function<void(double)>;

constexpr std::string_view best_kernel = "best";

struct Arguments {
  SourceArguments sources;
  SolverArguments solvers;
  /// The two frames of a step; empty without --step.
  std::vector<fs::path> step;
  std::string kernel = std::string(best_kernel);
  jobs::BenchOptions bench;
  std::string json_file;

  [[nodiscard]] bool built_in_workload() const { return step.empty() && sources.built_in_set(); }
};

/// \throws std::invalid_argument if this processor cannot run it.
const fast::CertifiedKernel* kernel_of(const std::string& name) {
  if (name == best_kernel) return nullptr;
  for (const fast::CertifiedKernel* const kernel : fast::certified_kernels()) {
    if (fast::to_string(kernel->instructions) == name) return kernel;
  }
  throw std::invalid_argument("this processor cannot run kernel " + name);
}

/// A run: the groups in order, then the reports.
class BenchRun {
 public:
  explicit BenchRun(const Arguments& arguments)
      : arguments_(arguments),
        separation_(arguments.sources.separation.given()),
        solvers_(files_, arguments.solvers, MethodHost::this_process),
        json_(files_, arguments.json_file) {
    files_.add_inputs(arguments.step);
    certified_.separation = separation_;
    report_.options = arguments.bench;
    report_.options.threads = arguments.sources.threads;
    report_.options.stop = &io::interrupted();
  }

  Status run() {
    until_stopped(
        files_, [this] { return !report_.groups.empty(); }, [this] { bench_all(); });
    if (json_) json_.complete(io::json_document(report::to_json(report_)));
    if (!report_.groups.empty() || errors_.empty()) {
      io::print(files_.summary_stream(), report::to_text(report_));
    }
    return status();
  }

 private:
  void bench_all() {
    if (!arguments_.step.empty()) {
      bench_given_step();
    } else if (arguments_.built_in_workload()) {
      bench_built_in();
    } else {
      SourceArguments sources = arguments_.sources;
      for (const fs::path& path : arguments_.sources.paths) {
        sources.paths = {path};
        bench_sources(sources, path.string(), {Kind::vertex_face, Kind::edge_edge});
      }
    }
  }

  void bench_group(const data::QueryGroup& group, std::vector<const solvers::Solver*> solvers,
                   const Separation& separation) {
    if (group.queries().empty() || stopped()) return;
    leave_out_others(group, solvers);
    solvers_.report_norms(separation);
    if (solvers.empty()) return fail(group.name() + ": no solver takes these queries");
    io::ProgressBar bar(fmt::format("bench {} {}", group.name(), to_string(group.kind())));
    jobs::BenchOptions options = report_.options;
    options.separation = separation;
    options.on_progress = [&bar](double fraction) { bar.update(fraction); };
    report_.groups.push_back(jobs::bench(group, solvers, options));
    bar.clear();
    solvers_.report_output(arguments_.solvers.show_output);
  }

  /// Leaves out the solvers that do not take the curves of the group, and reports them.
  static void leave_out_others(const data::QueryGroup& group,
                               std::vector<const solvers::Solver*>& solvers) {
    std::erase_if(solvers, [&](const solvers::Solver* solver) {
      if (jobs::takes_curves(solver->terms(), group.shape())) return false;
      report_warning(fmt::format("{}: {} is left out: it takes no {}", group.name(), solver->name(),
                                 group.shape().is_straight() ? "straight lines" : "such curves"));
      return true;
    });
  }

  /// The candidates of a mesh, from index pairs too.
  void bench_candidates(const mesh::MovingMesh& mesh, Kind kind) {
    const auto pairs = mesh::find_candidates(mesh, kind, 0, separation_, &io::interrupted());
    const fast::Candidates candidates = mesh::candidates_of(mesh, kind, pairs);
    const auto with_queries = solvers::certified_queries(certified_);
    const auto with_pairs = solvers::certified_pairs(mesh.vertices, candidates, certified_);
    std::vector<const solvers::Solver*> solvers = solvers_.all();
    solvers.insert(solvers.end(), {with_queries.get(), with_pairs.get()});
    bench_group(data::QueryGroup(mesh.name, kind, mesh::queries_of(mesh, candidates)), solvers,
                separation_);
  }

  void bench_built_in() {
    const mesh::MovingMesh patches = generate::moving_patches({.seed = arguments_.sources.seed});
    for (const Kind kind : chosen_kinds()) bench_candidates(patches, kind);
    bench_sources(arguments_.sources, "built-in set", chosen_kinds());
  }

  void bench_given_step() {
    const mesh::MovingMesh mesh = mesh::read_step(arguments_.step.at(0), arguments_.step.at(1));
    report_note(arguments_.step.front(), mesh.note);
    for (const Kind kind : chosen_kinds()) bench_candidates(mesh, kind);
    if (stopped()) return;
    io::ProgressBar bar("bench " + mesh.name);
    report_.step =
        jobs::bench_step(mesh, {.repetitions = report_.options.repetitions,
                                .threads = arguments_.sources.threads,
                                .separation = separation_,
                                .on_progress = [&bar](double fraction) { bar.update(fraction); },
                                .stop = &io::interrupted()});
  }

  /// The options with the kernel of the chosen instruction set.
  [[nodiscard]] const fast::SearchKernel* search_kernel() const {
    const fast::CertifiedKernel* const kernel = arguments_.solvers.kernel;
    if (kernel == nullptr) return nullptr;
    return fast::find_kernel(fast::search_kernels(), kernel->instructions);
  }

  /// Measures the queries below a path, or of the built-in set, one kind at a time, because both
  /// may not fit into memory.
  void bench_sources(const SourceArguments& sources, const std::string& name,
                     const std::vector<Kind>& kinds) {
    for (const Kind kind : kinds) {
      std::vector<data::QueryGroup> groups;
      std::optional<Separation> separation;
      for_each_source(
          sources, files_,
          {.title = "reading " + name,
           .use =
               [&](data::QuerySource& source, const Progress& progress) {
                 if (is_element(source.kind())) return fail(not_measured(source));
                 if (source.kind() != kind) return;
                 require_one_separation(source, separation);
                 group_of(groups, name, source.shape()).read(source, progress, [this] {
                   return stopped();
                 });
                 skipped_ += source.skipped();
               },
           .fail = [this](const fs::path&, const io::DatasetError& error) { fail(error.what()); },
           .stopped = [this] { return stopped(); }});
      const Separation asked = separation.value_or(separation_);
      for (const data::QueryGroup& group : groups) bench_group(group, solvers_.all(), asked);
    }
  }

  /// \throws DatasetError if the separation of the source differs from that of the earlier ones.
  void require_one_separation(const data::QuerySource& source,
                              std::optional<Separation>& so_far) const {
    const Separation separation = separation_for(arguments_.sources, source);
    if (so_far && !judge::same_separation(*so_far, separation)) {
      throw io::DatasetError(source.name(), {},
                             "is for a minimum separation of " + judge::to_text(separation) +
                                 ", the files before it for " + judge::to_text(*so_far));
    }
    so_far = separation;
  }

  [[nodiscard]] std::vector<Kind> chosen_kinds() const {
    if (arguments_.sources.kind.empty()) return {Kind::vertex_face, Kind::edge_edge};
    return {kind_from_string(arguments_.sources.kind)};
  }

  static std::string not_measured(const data::QuerySource& source) {
    return source.name() + ": " + contact_alone("bench", source.kind()) + ": name other files";
  }

  /// Files are opened once for each kind, so an error may occur twice.
  void fail(const std::string& message) {
    if (errors_.insert(message).second) report_error(message);
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || (!errors_.empty() && !arguments_.sources.keep_going);
  }

  [[nodiscard]] Status status() const {
    if (files_.has_failed()) return Status::bad_input;
    if (report::has_wrong_answers(report_)) return Status::wrong_answers;
    if (!errors_.empty() || skipped_ != 0) return Status::bad_input;
    if (io::interrupted()) return Status::interrupted;
    return status_of_queries(arguments_.sources, report_.groups.size() + (report_.step ? 1U : 0U));
  }

  const Arguments& arguments_;
  Separation separation_;  // of queries that are not read from files
  Files files_;
  Solvers solvers_;
  Output json_;
  fast::CertifiedOptions certified_;
  /// For the timed solvers of this thread.
  fast::UseKernels kernels_{{.certified = arguments_.solvers.kernel, .search = search_kernel()}};
  report::BenchReport report_;
  std::set<std::string> errors_;
  std::uint64_t skipped_ = 0;
};

void add_bench_options(CLI::App& command, Arguments& arguments) {
  command.option_defaults()->group("Measurement");
  add_option(command, "--step", arguments.step)->excludes(command.get_option("PATH"));
  add_option(command, "--kernel", arguments.kernel);
  add_option(command, "--repetitions", arguments.bench.repetitions);
  add_option(command, "--seconds", arguments.bench.seconds);
  add_option(command, "--judge", arguments.bench.judge);
  command.option_defaults()->group("Output");
  add_option(command, "--json", arguments.json_file);
}

/// The default methods, if the user names no solver.
void settle(const CLI::App& command, Arguments& arguments) {
  if (arguments.solvers.empty()) arguments.solvers.methods = solvers::default_methods();
  arguments.solvers.kernel = kernel_of(arguments.kernel);
  settle_solver_options(command, arguments.built_in_workload(), arguments.solvers);
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("bench", "Measure speed and error of solvers, also on whole steps");
  add_source_options(*command, arguments->sources);
  add_solver_options(*command, arguments->solvers);
  add_bench_options(*command, *arguments);
  set_help(*command,
           "touchstone bench data/handcrafted --method tight_inclusion --json result.json\n"
           "touchstone bench --step 92.ply 93.ply --method certified",
           "Without PATH: two patches of mesh that move through each other, and the built-in set. "
           "Built-in solvers run in this process, in one thread; plugins run in child processes. "
           "With --step the queries are the candidates of the broad phase, and the whole step is "
           "timed, with one thread and with --threads.\n" +
               std::string(judging_statuses));
  command->callback([arguments, command, &status] {
    settle(*command, *arguments);
    status = BenchRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::bench_command
