// touchstone bench: rows of speed and error, and the page of them.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast/broad_phase/search.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "touchstone/certified.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/levels.hpp"
#include "verify/generate/workload.hpp"
#include "verify/io/json.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/bench.hpp"
#include "verify/jobs/step_bench.hpp"
#include "verify/jobs/timing.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/mesh/moving_mesh.hpp"
#include "verify/report/bench_page.hpp"
#include "verify/report/bench_report.hpp"
#include "verify/solvers/published.hpp"
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
  /// The values of settings that are measured one after the other; empty: the usual one.
  std::vector<std::string> tolerances, limits, distances;
  /// "A:B" or "A"; empty without families of growing difficulty.
  std::string levels;
  std::vector<std::string> families;
  /// The two frames of a step; empty without --step.
  std::vector<fs::path> step;
  std::string kernel = std::string(best_kernel);
  jobs::BenchOptions bench;
  std::string json_file;
  std::string page_file;
  /// Rows to show instead of measuring.
  std::vector<fs::path> from;

  [[nodiscard]] bool has_levels() const { return !levels.empty() || !families.empty(); }
  [[nodiscard]] bool built_in_workload() const { return step.empty() && sources.built_in_set(); }
};

/// \throws std::invalid_argument if this processor cannot run it.
fast::Kernels kernels_of(const std::string& name) {
  if (name == best_kernel) return {};
  for (const fast::CertifiedKernel* const kernel : fast::certified_kernels()) {
    if (fast::to_string(kernel->instructions) != name) continue;
    return {.certified = kernel,
            .search = fast::find_kernel(fast::search_kernels(), kernel->instructions)};
  }
  throw std::invalid_argument("this processor cannot run kernel " + name);
}

/// The first and the last level of a text "A:B" or "A"; all if it is empty.
std::pair<int, int> levels_of(const std::string& text) {
  if (text.empty()) return {1, generate::greatest_level};
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto first = io::number_from_text<int>(text.substr(0, colon));
  const auto last =
      colon == text.size() ? first : io::number_from_text<int>(text.substr(colon + 1));
  if (!first || !last || *first < 1 || *last < *first || *last > generate::greatest_level) {
    throw std::invalid_argument(fmt::format(
        "--level {}: a level from 1 to {}, or two as FIRST:LAST", text, generate::greatest_level));
  }
  return {*first, *last};
}

std::vector<const generate::LevelFamily*> families_of(const std::vector<std::string>& names) {
  std::vector<const generate::LevelFamily*> chosen;
  chosen.reserve(std::max(names.size(), generate::level_families().size()));
  for (const std::string& name : names) chosen.push_back(&generate::level_family(name));
  if (!names.empty()) return chosen;
  for (const generate::LevelFamily& family : generate::level_families()) chosen.push_back(&family);
  return chosen;
}

/// Solvers with the same settings.
struct Setting {
  fast::MethodOptions options;
  std::unique_ptr<Solvers> solvers;
};

/// All combinations of tolerance and limit of checks. Methods that aim at no tolerance have the
/// first alone.
std::deque<Setting> settings_of(Files& files, const Arguments& arguments) {
  std::deque<Setting> settings;
  SolverArguments solvers = arguments.solvers;
  solvers.has_usual_checks = arguments.limits.empty();
  const std::size_t tolerances = std::max<std::size_t>(1, arguments.tolerances.size());
  const std::size_t limits = std::max<std::size_t>(1, arguments.limits.size());
  for (std::size_t i = 0; i < tolerances; ++i) {
    if (!arguments.tolerances.empty()) {
      solvers.options.tolerance = io::number_from_text<double>(arguments.tolerances[i]).value();
    }
    if (i == 1) {
      std::erase_if(solvers.methods, [](const std::string& name) {
        return !solvers::find_any(name).info().is_tolerance_driven;
      });
    }
    for (std::size_t k = 0; k < limits && !solvers.empty(); ++k) {
      if (!arguments.limits.empty()) {
        solvers.options.max_checks =
            io::number_from_text<std::int64_t>(arguments.limits[k]).value();
      }
      settings.push_back(
          {solvers.options, std::make_unique<Solvers>(files, solvers, MethodHost::this_process)});
    }
  }
  return settings;
}

class BenchRun {
 public:
  explicit BenchRun(const Arguments& arguments)
      : arguments_(arguments),
        sources_(arguments.sources),
        settings_(settings_of(files_, arguments)),
        json_(files_, arguments.json_file),
        page_(files_, arguments.page_file),
        options_(arguments.bench) {
    files_.add_inputs(arguments.step);
    files_.add_inputs(arguments.from);
    if (!arguments.from.empty() && arguments.page_file.empty()) {
      throw std::invalid_argument("--from needs --page FILE.html, which it writes");
    }
    options_.threads = arguments.sources.threads;
    options_.stop = &io::interrupted();
  }

  Status run() {
    for (const fs::path& file : arguments_.from) read(file);
    if (arguments_.from.empty()) {
      until_stopped(
          files_, [this] { return !lines_.empty(); }, [this] { measure_all(); });
    }
    json_.close();
    page_.complete_with([this] { return report::bench_page(lines_); });
    if (arguments_.from.empty() && !lines_.empty()) {
      print(report::bench_legend(options_, !arguments_.step.empty()));
    }
    return status();
  }

 private:
  /// The rows of an earlier run.
  void read(const fs::path& file) {
    static constexpr std::size_t most_bytes = std::size_t{1} << 30U;
    for (nlohmann::json& row : io::read_json_lines(file, most_bytes)) {
      if (!row.is_object() || !(row.contains("ns_per_query") || row.contains("step"))) {
        throw std::runtime_error(file.string() + ": these are not the rows of touchstone bench");
      }
      lines_.push_back(std::move(row));
    }
  }

  void measure_all() {
    std::vector<std::optional<double>> distances;
    for (const std::string& text : arguments_.distances) {
      distances.push_back(data::distance_from_text(text));
    }
    if (distances.empty()) distances.emplace_back();
    for (const std::optional<double>& distance : distances) {
      sources_.separation.distance = distance;
      if (stopped()) return;
      if (!arguments_.step.empty()) {
        measure_step();
      } else if (arguments_.has_levels()) {
        measure_levels();
      } else if (sources_.built_in_set()) {
        measure_built_in();
      } else {
        for (const fs::path& path : arguments_.sources.paths) {
          sources_.paths = {path};
          measure_sources(path.string(), {ContactKind::vertex_face, ContactKind::edge_edge});
        }
      }
    }
  }

  [[nodiscard]] Separation separation() const { return sources_.separation.given(); }

  // ---- Rows -------------------------------------------------------------------------------------

  /// Measures the rows of a group, and writes each as soon as it is there.
  void add_rows(const data::QueryGroup& group, const Separation& separation,
                std::optional<int> level, std::vector<jobs::BenchRow>& rows) {
    if (group.queries().empty() || stopped()) return;
    jobs::BenchOptions options = options_;
    jobs::Bench bench(group, options);
    for (const Setting& setting : settings_) {
      setting.solvers->report_norms(separation);
      for (const solvers::Solver* const solver : setting.solvers->all()) {
        if (stopped()) return;
        if (!takes(*solver, group)) continue;
        io::ProgressBar bar(
            fmt::format("bench {} {} {}", group.name(), to_string(group.kind()), solver->name()));
        options.on_progress = [&bar](double fraction) { bar.update(fraction); };
        fast::MethodOptions asked = setting.options;
        asked.separation = separation;
        if (arguments_.limits.empty()) {
          asked.max_checks = std::min(asked.max_checks, solver->info().usual_max_checks);
        }
        rows.push_back(bench.row(*solver, asked));
        rows.back().level = level;
        keep(report::to_json(rows.back()));
        is_wrong_ = is_wrong_ || jobs::broke_promise(rows.back());
      }
      setting.solvers->report_output(arguments_.solvers.show_output);
    }
  }

  void keep(nlohmann::json line) {
    if (json_) json_.write_through(io::json_line(line));
    lines_.push_back(std::move(line));
  }

  void print(const std::string& text) const { io::print(files_.summary_stream(), text); }

  void print(const std::vector<jobs::BenchRow>& rows, const std::string& name) {
    if (!rows.empty()) {
      print(report::to_text(rows));
    } else if (!stopped()) {
      fail(name + ": no solver takes these queries");
    }
  }

  void measure(const data::QueryGroup& group, const Separation& separation) {
    if (group.queries().empty()) return;
    std::vector<jobs::BenchRow> rows;
    add_rows(group, separation, std::nullopt, rows);
    print(rows, group.name());
  }

  /// Tells the solvers that do not take the curves of the group.
  bool takes(const solvers::Solver& solver, const data::QueryGroup& group) {
    if (jobs::takes_curves(solver.terms(), group.shape())) return true;
    const std::string warning =
        fmt::format("{}: {} is left out: it takes no {}", group.name(), solver.name(),
                    group.shape().is_straight() ? "straight lines" : "such curves");
    if (warned_.insert(warning).second) report_warning(warning);
    return false;
  }

  // ---- Queries ----------------------------------------------------------------------------------

  void measure_candidates(const mesh::MovingMesh& mesh, ContactKind kind) {
    const auto queries = mesh::candidates_of(mesh, kind, separation(), &io::interrupted());
    measure(data::QueryGroup(mesh.name, kind, queries), separation());
  }

  void measure_built_in() {
    const mesh::MovingMesh patches = generate::moving_patches({.seed = sources_.seed});
    for (const AnyKind kind : kinds_of(sources_.kind)) measure_candidates(patches, kind.contact());
    measure_sources("built-in set", kinds_of(sources_.kind));
  }

  /// A table for each family and kind.
  void measure_levels() {
    const auto [first, last] = levels_of(arguments_.levels);
    for (const generate::LevelFamily* const family : families_of(arguments_.families)) {
      for (const AnyKind kind : kinds_of(sources_.kind)) {
        std::vector<jobs::BenchRow> rows;
        for (int level = first; level <= last && !stopped(); ++level) {
          add_rows(
              generate::level_group(*family, kind.contact(), level, sources_.seed, sources_.count),
              separation(), level, rows);
        }
        std::ranges::stable_sort(rows, {}, &jobs::BenchRow::method);
        print(rows, std::string(family->name));
      }
    }
  }

  void measure_step() {
    const mesh::MovingMesh mesh = mesh::read_step(arguments_.step.at(0), arguments_.step.at(1));
    report_note(arguments_.step.front(), mesh.note);
    for (const AnyKind kind : kinds_of(sources_.kind)) measure_candidates(mesh, kind.contact());
    if (stopped()) return;
    io::ProgressBar bar("bench " + mesh.name);
    const jobs::StepResult step =
        jobs::bench_step(mesh, {.repetitions = options_.repetitions,
                                .threads = options_.threads,
                                .separation = separation(),
                                .kernels = arguments_.solvers.kernels,
                                .on_progress = [&bar](double fraction) { bar.update(fraction); },
                                .stop = &io::interrupted()});
    bar.clear();
    keep(report::to_json(step));
    is_wrong_ = is_wrong_ || !step.earliest_agrees;
    print(report::to_text(step));
  }

  /// Measures the queries below a path, or of the built-in set, one kind at a time, because both
  /// may not fit into memory.
  void measure_sources(const std::string& name, const std::vector<AnyKind>& kinds) {
    for (const AnyKind kind : kinds) {
      std::vector<data::QueryGroup> groups;
      std::optional<Separation> about;
      for_each_source(
          sources_, files_,
          {.title = "reading " + name,
           .use =
               [&](data::QuerySource& source, const Progress& progress) {
                 if (source.kind() != kind) return;
                 require_one_separation(source, about);
                 group_of(groups, name, source.shape()).read(source, progress, [this] {
                   return stopped();
                 });
                 skipped_ += source.skipped();
               },
           .fail = [this](const fs::path&, const io::DatasetError& error) { fail(error.what()); },
           .stopped = [this] { return stopped(); }});
      for (const data::QueryGroup& group : groups) measure(group, about.value_or(separation()));
    }
  }

  /// \throws DatasetError if the separation of the source differs from that of the earlier ones.
  void require_one_separation(const data::QuerySource& source,
                              std::optional<Separation>& so_far) const {
    const Separation asked = separation_for(sources_, source);
    if (so_far && !judge::same_separation(*so_far, asked)) {
      throw io::DatasetError(source.name(), {},
                             "is for a minimum separation of " + judge::to_text(asked) +
                                 ", the files before it for " + judge::to_text(*so_far));
    }
    so_far = asked;
  }

  // ---- The end ----------------------------------------------------------------------------------

  /// Files are opened once for each kind, so an error may occur twice.
  void fail(const std::string& message) {
    if (errors_.insert(message).second) report_error(message);
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || (!errors_.empty() && !sources_.keep_going);
  }

  [[nodiscard]] Status status() const {
    if (files_.has_failed()) return Status::bad_input;
    if (is_wrong_) return Status::wrong_answers;
    if (!errors_.empty() || skipped_ != 0) return Status::bad_input;
    if (io::interrupted()) return Status::interrupted;
    return status_of_queries(arguments_.sources, lines_.size());
  }

  const Arguments& arguments_;
  SourceArguments sources_;  // with the present separation and path
  Files files_;
  std::deque<Setting> settings_;
  Output json_;
  Output page_;
  jobs::BenchOptions options_;
  nlohmann::json lines_ = nlohmann::json::array();
  bool is_wrong_ = false;
  std::set<std::string> errors_, warned_;
  std::uint64_t skipped_ = 0;
};

void add_query_options(Command& command, Arguments& arguments) {
  add_path_options(command, arguments.sources);
  add_option(command, "--count", arguments.sources.count);
  add_option(command, "--degree", arguments.sources.degrees);
  add_option(command, "--level", arguments.levels);
  add_option(command, "--family", arguments.families);
  add_option(command, "--step", arguments.step);
  add_option(command, "--min-separation", arguments.distances);
  add_option(command, "--norm", arguments.sources.separation.norm);
}

void add_bench_options(Command& command, Arguments& arguments) {
  begin_group(command, "Measurement");
  add_option(command, "--kernel", arguments.kernel);
  add_option(command, "--repetitions", arguments.bench.repetitions);
  add_option(command, "--seconds", arguments.bench.seconds);
  add_option(command, "--singles", arguments.bench.singles);
  add_option(command, "--judge", arguments.bench.judge);
  begin_group(command, "Output");
  add_option(command, "--json", arguments.json_file);
  add_option(command, "--page", arguments.page_file);
  add_option(command, "--from", arguments.from);
}

/// The default methods, if the user names no solver.
void settle(const Command& command, Arguments& arguments) {
  if (arguments.solvers.empty()) arguments.solvers.methods = solvers::default_methods();
  arguments.solvers.kernels = kernels_of(arguments.kernel);
  settle_solver_options(command, arguments.built_in_workload(), arguments.solvers);
}

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command = add_command(
      app, "bench", "Measure speed and error of solvers, also on whole steps; draw them");
  add_query_options(*command, *arguments);
  add_named_solver_options(*command, arguments->solvers);
  add_option(*command, "--tolerance", arguments->tolerances);
  add_option(*command, "--max-checks", arguments->limits);
  add_bench_options(*command, *arguments);
  std::string levels;
  for (const generate::LevelFamily& family : generate::level_families()) {
    levels += fmt::format("{}{} ({})", levels.empty() ? "" : "; ", family.name, family.meaning);
  }
  set_help(
      *command,
      "touchstone bench data/handcrafted --plugin mine.so --method certified --page page.html\n"
      "touchstone bench --level 1:12 --plugin mine.so --page page.html",
      "A row for each source, method and combination of settings. Without PATH: "
      "two moving patches of mesh, and the built-in set. A step's queries are the candidates of "
      "the broad phase; the whole step is timed, too. Families at level L: " +
          levels + ".\n" + std::string(judging_statuses));
  set_action(*command, [arguments, command, &status] {
    settle(*command, *arguments);
    status = BenchRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::bench_command
