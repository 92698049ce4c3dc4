#pragma once

/// \file
/// The solvers that a command line names: methods of ours, plugins, recorded answers.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/respondent.hpp"

namespace touchstone::verify::cli {

/// What the user said of solvers.
struct RespondentArguments {
  std::vector<std::string> methods;
  std::vector<std::filesystem::path> plugins;
  std::vector<std::filesystem::path> results;
  /// Wall-clock seconds a query; 0: no limit.
  double query_limit = FuzzOptions{}.query_limit_seconds;
  bool exact = false;
  /// Bytes of memory that a solver's process may take; 0: no limit.
  std::uint64_t memory_limit = ChildLimits{}.memory_bytes;
  bool allow_processes = false;
  bool show_output = false;
  fast::MethodOptions options;

  /// Files that are read.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  /// What the process of a solver may take.
  [[nodiscard]] ChildLimits limits() const;

  /// The plugin at a path, loaded in a child process. \throws DatasetError as load_plugin does.
  [[nodiscard]] std::unique_ptr<fast::Method> load(const std::filesystem::path& plugin) const;

  /// How the process of a solver is to be used: until interrupted.
  [[nodiscard]] SolverProcessOptions process() const;

  [[nodiscard]] bool empty() const { return methods.empty() && plugins.empty() && results.empty(); }
};

/// Adds --method, --plugin, --query-limit, --memory-limit, --allow-processes, --show-output,
/// --tolerance and --max-checks; the arguments must live
/// until the command line is parsed.
void add_solver_options(CLI::App& command, RespondentArguments& arguments);

/// To be called on the arguments of a parsed command line: on the built-in set, which is made of the
/// hardest queries, methods take fewer steps unless --max-checks says how many.
/// \throws std::invalid_argument if an option of solvers is given and no solver is asked.
void settle_solver_options(const CLI::App& command, bool built_in_set,
                           RespondentArguments& arguments);

/// Prints on standard error what a solver printed if that is asked for, line by line behind its name,
/// printable (verify/io/printable.hpp); else how to see it. Nothing if it printed nothing.
void report_output(std::string_view solver, const CapturedOutput& output, bool show);

/// Says on standard error that a solver ended its process so often, unless that is never.
void report_unplaced_crashes(std::string_view solver, std::uint64_t crashes);

/// The respondents of a run, and all that they need to live.
class Respondents {
 public:
  /// Those that the arguments name, in the order methods, plugins, results. Plugins, and with a
  /// limit also methods, answer in child processes, until interrupted. The method "none" stands for
  /// no method. Of several with one name, the second is called "NAME (2)", and so on.
  /// \throws std::invalid_argument for an unknown method, or "none" beside others; DatasetError if a
  /// plugin or a file of answers cannot be loaded.
  explicit Respondents(const RespondentArguments& arguments);

  [[nodiscard]] std::vector<const Respondent*> all() const;

  /// What they printed. Not to be called while one of them is asked.
  void report_output(bool show) const;

  /// Files of answers with answers to queries that were never asked: a warning text each.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Results {
    std::filesystem::path path;
    RecordedAnswers answers;
  };

  void add(std::unique_ptr<Respondent> respondent, bool exact);

  std::vector<std::unique_ptr<fast::Method>> plugins_;
  std::deque<Results> results_;  // its elements stay where they are
  std::vector<std::unique_ptr<Respondent>> respondents_;
};

}  // namespace touchstone::verify::cli
