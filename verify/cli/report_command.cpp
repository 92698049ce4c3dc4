// touchstone report: measurements of all methods on one page.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/cli/sources.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/workload.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/mesh/moving_mesh.hpp"
#include "verify/report/experiments.hpp"
#include "verify/report/measurement.hpp"
#include "verify/report/report_page.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/asked_solvers.hpp"

namespace touchstone::verify::cli::report_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  SourceArguments sources;
  report::ExperimentOptions experiments;
  std::vector<std::string> experiment_names;
  SolverArguments solvers;
  bool field = false;
  std::string from_file;
  std::string page_file;
  std::string json_file;
  std::string view_file;
};

/// The wrong answers of each method, at most as many as fit on a page, for the first of several
/// settings.
class WrongAnswers {
 public:
  void add(judge::WrongQuery wrong) {
    std::vector<judge::WrongQuery>& of_method = by_method_[wrong.answers.front().solver];
    const auto is_known = [&](const judge::WrongQuery& other) {
      return other.query == wrong.query &&
             judge::same_separation(other.separation, wrong.separation);
    };
    if (of_method.size() == ViewFile::most_queries || std::ranges::any_of(of_method, is_known)) {
      return;
    }
    of_method.push_back(std::move(wrong));
  }

  /// Adds the first query of each method to the page, then the second, and so on, so that the
  /// places are shared.
  void add_to(ViewFile& page) const {
    for (std::size_t i = 0; i < ViewFile::most_queries; ++i) {
      for (const auto& [method, wrong] : by_method_) {
        if (i < wrong.size()) page.add(view::viewed_query(wrong[i]));
      }
    }
  }

 private:
  std::map<std::string, std::vector<judge::WrongQuery>> by_method_;
};

/// The last component of a path that is a name.
std::string short_name(const fs::path& path) {
  const fs::path normal = fs::absolute(path).lexically_normal();
  return normal.has_filename() ? normal.filename().string()
                               : normal.parent_path().filename().string();
}

class ReportRun {
 public:
  explicit ReportRun(const Arguments& arguments)
      : arguments_(arguments),
        page_(files_, arguments.page_file),
        json_(files_, arguments.json_file),
        view_(files_, arguments.view_file) {
    if (!page_ && !json_ && !view_) {
      throw std::invalid_argument("no output: name --out, --json or --view");
    }
    files_.add_inputs(arguments.solvers.files());
    files_.add_input(arguments.from_file);
  }

  Status run() {
    report::Measurements measurements;
    if (arguments_.from_file.empty()) {
      const std::vector<data::QueryGroup> groups =
          arguments_.sources.built_in_set() ? built_in() : given();
      if (!errors_.empty() && !arguments_.sources.keep_going) return Status::bad_input;
      if (groups.empty()) return status_of_queries(arguments_.sources, 0);
      measurements = measured(groups);
    } else {
      measurements = read(arguments_.from_file);
    }
    write(measurements);
    report_broken_promises(measurements);
    if (files_.has_failed()) return Status::bad_input;
    if (report::has_wrong_answers(measurements)) return Status::wrong_answers;
    if (!errors_.empty() || skipped_ != 0) return Status::bad_input;
    return io::interrupted() ? Status::interrupted : Status::all_well;
  }

 private:
  static report::Measurements read(const std::string& file) {
    static constexpr std::size_t most_bytes = std::size_t{1} << 30U;
    const nlohmann::json json = io::read_json(file, most_bytes);
    try {
      return report::measurements_from_json(json);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file + ": " + error.what());
    }
  }

  [[nodiscard]] report::Measurements measured(const std::vector<data::QueryGroup>& groups) {
    io::ProgressBar bar("report");
    report::ExperimentOptions options = arguments_.experiments;
    // A chart of one's own solver.
    if (!arguments_.solvers.plugins.empty() && options.methods.empty() && !arguments_.field) {
      options.methods = {"certified", "tight_inclusion"};
      if (options.experiments.empty()) options.experiments = {report::Experiment::field};
    }
    const std::vector<std::unique_ptr<fast::Method>> plugins = loaded_plugins();
    std::ranges::transform(plugins, std::back_inserter(options.plugins),
                           [](const auto& plugin) { return plugin.get(); });
    options.process = arguments_.solvers.process();
    options.seed = arguments_.sources.seed;
    options.threads = arguments_.sources.threads;
    options.on_progress = [&bar](double fraction) { bar.update(fraction); };
    if (view_) {
      options.on_wrong = [this](judge::WrongQuery wrong) { wrong_.add(std::move(wrong)); };
    }
    options.stop = &io::interrupted();
    report::Measurements measurements = report::run_experiments(groups, options);
    measurements.command = command_line();
    measurements.version = version();
    return measurements;
  }

  // ---- Solvers of the user's own ----

  [[nodiscard]] std::vector<std::unique_ptr<fast::Method>> loaded_plugins() const {
    std::vector<std::unique_ptr<fast::Method>> plugins;
    for (const fs::path& path : arguments_.solvers.plugins) {
      plugins.push_back(arguments_.solvers.load(path));
    }
    return plugins;
  }

  // ---- Queries ----------------------------------------------------------------------------------

  [[nodiscard]] std::vector<Kind> kinds() const {
    if (arguments_.sources.kind.empty()) return {Kind::vertex_face, Kind::edge_edge};
    return {kind_from_string(arguments_.sources.kind)};
  }

  /// The two moving patches, and the built-in set with about the requested number of queries.
  [[nodiscard]] std::vector<data::QueryGroup> built_in() {
    SourceArguments sources = arguments_.sources;
    sources.count =
        std::max<std::uint64_t>(1, arguments_.experiments.count / generate::families().size());
    const mesh::MovingMesh patches = generate::moving_patches({.seed = sources.seed});
    std::vector<data::QueryGroup> groups;
    for (const Kind kind : kinds()) {
      const auto pairs = mesh::find_candidates(patches, kind);
      groups.emplace_back(patches.name, kind,
                          mesh::queries_of(patches, mesh::candidates_of(patches, kind, pairs)));
    }
    read(sources, "built-in set", groups);
    io::throw_if_interrupted();
    return groups;
  }

  [[nodiscard]] std::vector<data::QueryGroup> given() {
    std::vector<data::QueryGroup> groups;
    std::set<std::string> names;
    SourceArguments sources = arguments_.sources;
    for (const fs::path& path : arguments_.sources.paths) {
      sources.paths = {path};
      const std::string name = short_name(path);
      read(sources, names.insert(name).second ? name : path.string(), groups);
    }
    return groups;
  }

  void read(const SourceArguments& sources, const std::string& name,
            std::vector<data::QueryGroup>& groups) {
    std::vector<data::QueryGroup> of_sources;
    for_each_source(
        sources, files_,
        {.title = "reading " + name,
         .use =
             [&](data::QuerySource& source, const std::function<void(double)>& progress) {
               if (is_element(source.kind())) {
                 return fail(source.name() + ": " + contact_alone("report", source.kind()) +
                             ": name other files");
               }
               if (std::ranges::count(kinds(), source.kind()) == 0) return;
               group_of(of_sources, name, source.shape()).read(source, progress, [this] {
                 return stopped();
               });
               skipped_ += source.skipped();
             },
         .fail = [this](const fs::path&, const io::DatasetError& error) { fail(error.what()); },
         .stopped = [this] { return stopped(); }});
    std::ranges::stable_sort(of_sources, {}, &data::QueryGroup::kind);
    for (data::QueryGroup& group : of_sources) {
      if (!group.queries().empty()) groups.push_back(std::move(group));
    }
  }

  void fail(const std::string& message) {
    if (errors_.insert(message).second) report_error(message);
  }

  [[nodiscard]] bool stopped() const {
    return io::interrupted() || (!errors_.empty() && !arguments_.sources.keep_going);
  }

  // ---- Output -----------------------------------------------------------------------------------

  void write(const report::Measurements& measurements) {
    // The measurements first, because all other outputs can be derived from them.
    if (json_) json_.complete(io::json_document(report::to_json(measurements)));
    page_.complete_with([&] { return report::report_page(measurements); });
    wrong_.add_to(view_);
    view_.write();
    std::FILE* const out = files_.summary_stream();
    if (page_ && !page_.failed()) {
      io::print(out,
                fmt::format("{}\n", io::printable(fs::absolute(arguments_.page_file).string())));
    }
    io::print(out, view_.summary(allowed_false_positives(measurements)));
  }

  static std::uint64_t allowed_false_positives(const report::Measurements& measurements) {
    std::uint64_t sum = 0;
    for (const report::Measurement& m : measurements.all) {
      if (!judge::breaks(judge::Fault::false_positive, m.promise)) sum += m.false_positives;
    }
    return sum;
  }

  static void report_broken_promises(const report::Measurements& measurements) {
    for (const report::Measurement& m : measurements.all) {
      if (m.keeps_promise) continue;
      report_error(fmt::format(
          "{} ({}) breaks its promise on {} {}, {}: false negatives {}, late toi {} (at most by "
          "{:.3g} of the step), early toi_upper {}, errors {}, false positives {}",
          m.method, solvers::to_string(m.promise), m.group, to_string(m.kind),
          report::to_string(m.experiment), m.false_negatives, m.late_tois, m.late.greatest.step,
          m.early_upper_tois, m.errors, m.false_positives));
    }
  }

  const Arguments& arguments_;
  Files files_;
  Output page_;
  Output json_;
  ViewFile view_;
  WrongAnswers wrong_;
  std::set<std::string> errors_;
  std::uint64_t skipped_ = 0;
};

void add_measuring_options(CLI::App& command, Arguments& arguments) {
  add_path_options(command, arguments.sources);
  add_option(command, "--degree", arguments.sources.degrees);
  command.option_defaults()->group("Measurement");
  add_option(command, "--method", arguments.experiments.methods);
  add_plugin_option(command, arguments.solvers);
  add_option(command, "--field", arguments.field);
  add_option(command, "--count", arguments.experiments.count);
  add_option(command, "--method-seconds", arguments.experiments.seconds);
  add_option(command, "--seconds", [&arguments](double s) { arguments.experiments.budget = s; });
  add_option(command, "--repetitions", arguments.experiments.repetitions);
  add_option(command, "--experiment", arguments.experiment_names);
  add_option(command, "--stability", arguments.experiments.stability_count);
}

void add_output_options(CLI::App& command, Arguments& arguments) {
  command.option_defaults()->group("Output");
  CLI::Option* const from = add_option(command, "--from", arguments.from_file);
  from->excludes(command.get_option("PATH"))->excludes(command.get_option("--method"));
  add_option(command, "--out", arguments.page_file);
  add_option(command, "--json", arguments.json_file);
  add_option(command, "--view", arguments.view_file)->excludes(from);
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("report", "Measure all solvers, and write a page of speed against error");
  add_measuring_options(*command, *arguments);
  add_output_options(*command, *arguments);
  set_help(
      *command,
      "touchstone report data/handcrafted --out report.html --json report.json\n"
      "touchstone report data/handcrafted --plugin mine.so --out new.html",
      "Without PATH: two patches of mesh that move through each other, and the built-in set. The "
      "page needs no network; its path is printed. Times are those of one thread.\n" +
          std::string(judging_statuses));
  command->callback([arguments, command, &status] {
    report::ExperimentOptions& options = arguments->experiments;
    for (const std::string& name : arguments->experiment_names) {
      options.experiments.push_back(report::experiment_from_string(name));
    }
    const bool is_plugin_alone = !arguments->solvers.plugins.empty() && !arguments->field;
    if (is_plugin_alone && command->count("--seconds") == 0) options.budget = usual_plugin_seconds;
    settle_query_limit(*command, options.budget, arguments->solvers);
    status = ReportRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::report_command
