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

#include "fast/certified/kernel.hpp"
#include "fast/method.hpp"
#include "verify/cli/files.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::cli {

/// The solvers that the user named, and their options.
struct SolverArguments {
  std::vector<std::string> methods;
  std::vector<std::filesystem::path> plugins;
  std::vector<std::filesystem::path> results;
  /// Wall-clock seconds a query; 0: no limit.
  double query_limit = fuzz::FuzzOptions{}.query_limit_seconds;
  bool exact = false;
  /// Bytes of memory that a solver's process may take; 0: no limit.
  std::uint64_t memory_limit = solvers::ChildLimits{}.memory_bytes;
  bool allow_processes = false;
  bool show_output = false;
  fast::MethodOptions options;
  /// Of the certified solver; null: the best one for this processor.
  const fast::CertifiedKernel* kernel = nullptr;

  /// Files that are read.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  /// Limits of a solver's process.
  [[nodiscard]] solvers::ChildLimits limits() const;

  /// The plugin at a path, loaded in a child process. \throws DatasetError as load_plugin does.
  [[nodiscard]] std::unique_ptr<fast::Method> load(const std::filesystem::path& plugin) const;

  /// Options of a solver's process: it ends at an interrupt.
  [[nodiscard]] solvers::SolverProcessOptions process() const;

  [[nodiscard]] bool empty() const { return methods.empty() && plugins.empty() && results.empty(); }
};

/// Adds --method, --plugin, --query-limit, --memory-limit, --allow-processes, --show-output,
/// --tolerance and --max-checks; the arguments must live
/// until the command line is parsed.
void add_solver_options(CLI::App& command, SolverArguments& arguments);

/// Adds --plugin alone.
void add_plugin_option(CLI::App& command, SolverArguments& arguments);

/// Adds --results.
void add_recorded_option(CLI::App& command, SolverArguments& arguments);

/// Adds --exact.
void add_exact_flag(CLI::App& command, SolverArguments& arguments);

/// To be called on the arguments of a parsed command line: on the built-in set, which is made of the
/// hardest queries, methods take fewer steps unless --max-checks says how many.
/// \throws std::invalid_argument if an option of solvers is given and no solver is asked.
void settle_solver_options(const CLI::App& command, bool built_in_set, SolverArguments& arguments);

/// Prints on standard error what a solver printed if that is asked for, line by line behind its name,
/// printable (verify/io/printable.hpp); else how to see it. Nothing if it printed nothing.
void report_output(std::string_view solver, const solvers::CapturedOutput& output, bool show);

/// Says on standard error that a solver ended its process so often, unless that is never.
void report_unplaced_crashes(std::string_view solver, std::uint64_t crashes);

/// Where methods answer.
enum class MethodHost : std::uint8_t {
  children_with_limit,  ///< in child processes if there is a limit of time for a query
  this_process
};

/// The solvers of a run, and all that they need to live.
class Solvers {
 public:
  /// Those that the arguments name, in the order methods, plugins, results. Plugins answer in child
  /// processes, until interrupted. The method "none" stands for no method. Of several with one name,
  /// the second is called "NAME (2)", and so on.
  /// \throws std::invalid_argument for an unknown method, or "none" beside others; DatasetError if a
  /// plugin or a file of answers cannot be loaded; as Files does, which gets those that are read.
  Solvers(Files& files, const SolverArguments& arguments,
          MethodHost host = MethodHost::children_with_limit);

  [[nodiscard]] std::vector<const solvers::Solver*> all() const;

  /// Their output since the last call. Not to be called while one of them is solving.
  void report_output(bool show) const;

  /// Files of answers with answers to queries that were never asked: a warning text each.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Results {
    std::filesystem::path path;
    solvers::RecordedAnswers answers;
  };

  void add(std::unique_ptr<solvers::Solver> solver, bool exact);
  [[nodiscard]] const fast::Method& method_named(std::string_view name,
                                                 const SolverArguments& arguments);

  /// Methods that are not in the registry.
  std::vector<std::unique_ptr<fast::Method>> methods_;
  std::deque<Results> results_;  // its elements stay where they are
  std::vector<std::unique_ptr<solvers::Solver>> solvers_;
};

}  // namespace touchstone::verify::cli
