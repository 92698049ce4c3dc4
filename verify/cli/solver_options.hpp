#pragma once

/// \file
/// The solvers of a command line: built-in methods, plugins, recorded answers.

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/judge/responses.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/plugin_method.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::cli {

inline constexpr double bytes_of_gibibyte = 0x1p30;

/// The usual value of --max-checks on the built-in set.
inline constexpr std::int64_t built_in_max_checks = 100'000;

/// The named solvers and their options.
struct SolverArguments {
  std::vector<std::string> methods;
  std::vector<std::filesystem::path> plugins;
  std::vector<std::filesystem::path> results;
  /// Wall-clock seconds for a query; 0: no limit.
  double query_limit = fuzz::FuzzOptions{}.query_limit_seconds;
  bool exact = false;
  // The terms of plugins and of recorded answers, where they differ from the stated ones.
  std::vector<std::string> kinds = {};
  bool float_coordinates = false;
  std::string starts_apart = {};
  std::string times = {};
  std::optional<double> time_error = {};
  /// Memory limit of a solver's process in GiB, if not the usual one; 0: no limit.
  std::optional<double> memory_limit = {};
  bool allow_processes = false;
  bool show_output = false;
  fast::MethodOptions options;
  /// True if methods take no more checks than is usual in comparisons.
  bool has_usual_checks = false;
  /// The kernels of the certified solver, and of steps.
  fast::Kernels kernels = {};

  /// The input files.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  /// The changes of terms that these options ask for.
  [[nodiscard]] solvers::TermsChanges terms() const;

  /// The limits of a solver's process.
  [[nodiscard]] solvers::ChildLimits limits() const;

  /// The plugin at a path, loaded in a child process. \throws DatasetError as load_plugin does.
  [[nodiscard]] std::unique_ptr<fast::Method> load(const std::filesystem::path& plugin) const;

  /// The options of a solver's process, which ends at an interrupt.
  [[nodiscard]] solvers::SolverProcessOptions process() const;

  [[nodiscard]] bool empty() const { return methods.empty() && plugins.empty() && results.empty(); }
};

/// Adds --method, --plugin, the terms of the promises of plugins, --query-limit, --memory-limit,
/// --allow-processes and --show-output; the arguments must live until the command line is parsed.
void add_named_solver_options(Command& command, SolverArguments& arguments);

/// Adds these, --tolerance and --max-checks.
void add_solver_options(Command& command, SolverArguments& arguments);

/// Without --query-limit, a query may take no more than a sixtieth of the run if that is less than
/// the usual limit. \param seconds of the run; 0: no limit
void settle_query_limit(const Command& command, double seconds, SolverArguments& arguments);

/// Adjusts the arguments of a parsed command line: on the built-in set, which has the most
/// difficult queries, methods take fewer steps unless --max-checks is given.
/// \throws std::invalid_argument if an option of solvers is given without a solver.
void settle_solver_options(const Command& command, bool built_in_set, SolverArguments& arguments);

/// Prints a solver's output on standard error if requested, each line after its name, printable
/// (verify/io/printable.hpp); otherwise a hint. Nothing without output.
void report_output(std::string_view solver, const solvers::CapturedOutput& output, bool show);

/// Warns of a method that measures a separation in another norm only, and names that.
void report_norms(const fast::MethodInfo& info, const Separation& separation);

/// Reports on standard error the number of times that a solver ended its process, if positive.
void report_unplaced_crashes(std::string_view solver, std::uint64_t crashes);

/// The status of a run by its solver's responses: bad_input if it answered nothing,
/// wrong_answers if it hung too often (verify/judge/responses.hpp); the reason goes to standard
/// error.
[[nodiscard]] Status status_of(std::string_view solver, const judge::Responses& responses);

/// The more urgent of two: wrong_answers before bad_input before the others.
[[nodiscard]] Status worse(Status a, Status b);

/// The process in which methods run.
enum class MethodHost : std::uint8_t {
  children_with_limit,  ///< in child processes if there is a time limit for queries
  this_process
};

/// The solvers of a run, with the objects that they depend on.
class Solvers {
 public:
  /// The solvers of the arguments, in the order methods, plugins, results. Plugins run in child
  /// processes, until interrupted. The method "none" means no method. If several have the same
  /// name, the second is called "NAME (2)", and so on.
  /// \throws std::invalid_argument for an unknown method, or "none" with others; DatasetError if a
  /// plugin or a file of answers cannot be loaded; the exceptions of Files, which records the input
  /// files.
  Solvers(Files& files, const SolverArguments& arguments,
          MethodHost host = MethodHost::children_with_limit);

  [[nodiscard]] std::vector<const solvers::Solver*> all() const;

  /// Reports their output since the last call. Must not be called while one of them is solving.
  void report_output(bool show) const;

  /// Reports, once, the methods that measure no separation in this norm.
  void report_norms(const Separation& separation);

  /// Warnings for files with answers to queries that do not occur.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Results {
    std::filesystem::path path;
    solvers::RecordedAnswers answers;
  };

  void add(std::unique_ptr<solvers::Solver> solver, bool exact);
  [[nodiscard]] const fast::Method& method_named(std::string_view name,
                                                 const SolverArguments& arguments);

  /// The methods that are not in the registry.
  std::vector<std::unique_ptr<fast::Method>> methods_;
  std::deque<Results> results_;  // the addresses of elements are stable
  std::vector<std::unique_ptr<solvers::Solver>> solvers_;
  bool has_reported_norms_ = false;
};

}  // namespace touchstone::verify::cli
