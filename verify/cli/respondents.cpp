#include "verify/cli/respondents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "exact/query.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/solvers/plugin.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::cli {
namespace {

constexpr std::string_view no_method = "none";
constexpr double longest_limit = 1e6;
constexpr std::int64_t built_in_max_checks = 100'000;
constexpr double bytes_of_gibibyte = 0x1p30;
constexpr double most_gibibytes = 1e6;

std::string method_names() {
  std::string names;
  for (const auto& method : methods()) {
    if (!names.empty()) names += ", ";
    names += method->name();
  }
  return names;
}

std::vector<const fast::Method*> named_methods(const std::vector<std::string>& names) {
  if (names.size() == 1 && names.front() == no_method) return {};
  std::vector<const fast::Method*> result;
  for (const std::string& name : names) {
    if (name == no_method) throw std::invalid_argument("--method none excludes other methods");
    result.push_back(&find_method(name));
  }
  return result;
}

}  // namespace

void add_solver_options(CLI::App& command, RespondentArguments& arguments) {
  command.add_option("--method", arguments.methods, "A solver of ours: " + method_names())
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      .add_option("--plugin", arguments.plugins,
                  "Anyone's solver: a shared library with the interface of verify/plugin.h")
      ->type_name("LIB.so")
      ->allow_extra_args(false);
  command
      .add_option("--query-limit", arguments.query_limit,
                  "Seconds that a query may take of a solver in a child process; beyond, it is "
                  "undecided (0: no limit)")
      ->capture_default_str()
      ->check(real_number(0.0, longest_limit));
  command
      .add_option_function<double>(
          "--memory-limit",
          [&arguments](double gibibytes) {
            arguments.memory_limit = static_cast<std::uint64_t>(gibibytes * bytes_of_gibibyte);
          },
          fmt::format("GiB of memory that a solver's process may take (default {:g}, 0: no limit)",
                      static_cast<double>(arguments.memory_limit) / bytes_of_gibibyte))
      ->type_name("GIB")
      ->check(real_number(0.0, most_gibibytes));
  command.add_flag("--allow-processes", arguments.allow_processes,
                   "Let a solver's process make processes of its own; without it, fork() fails");
  command.add_flag("--show-output", arguments.show_output,
                   "Print on standard error what plugins print");
  command
      .add_option("--tolerance", arguments.options.tolerance,
                  "What tolerance-driven methods aim at, in units of the coordinates")
      ->capture_default_str()
      ->check(real_number(DBL_TRUE_MIN, DBL_MAX));
  command
      .add_option("--max-checks", arguments.options.max_checks,
                  fmt::format("Steps that iterative methods may take a query (0: no limit; "
                              "built-in set: {})",
                              built_in_max_checks))
      ->capture_default_str()
      ->check(whole_number(0, INT64_MAX));
}

std::vector<std::filesystem::path> RespondentArguments::files() const {
  std::vector<std::filesystem::path> all = plugins;
  all.insert(all.end(), results.begin(), results.end());
  return all;
}

ChildLimits RespondentArguments::limits() const {
  return {.memory_bytes = memory_limit, .may_fork = allow_processes};
}

std::unique_ptr<fast::Method> RespondentArguments::load(const std::filesystem::path& plugin) const {
  return load_plugin(plugin, {.limits = limits(), .stop = &interrupted()});
}

SolverProcessOptions RespondentArguments::process() const {
  return {.query_limit_seconds = query_limit, .stop = &interrupted(), .limits = limits()};
}

void settle_solver_options(const CLI::App& command, bool built_in_set,
                           RespondentArguments& arguments) {
  const auto is_given = [&](const std::string& name) {
    const CLI::Option* option = command.get_option_no_throw(name);
    return option != nullptr && option->count() != 0;
  };
  if (built_in_set) {
    if (!is_given("--max-checks")) arguments.options.max_checks = built_in_max_checks;
    return;
  }
  for (const std::string name : {"--exact", "--query-limit", "--memory-limit", "--allow-processes",
                                 "--show-output", "--tolerance", "--max-checks"}) {
    if (arguments.empty() && is_given(name)) {
      throw std::invalid_argument(name + " is for solvers, and none is named");
    }
  }
}

void report_output(std::string_view solver, const CapturedOutput& output, bool show) {
  if (output.text.empty()) return;
  const std::uint64_t bytes = output.text.size() + output.dropped;
  if (!show) {
    report_warning(fmt::format("{} printed {} bytes; --show-output shows them", solver, bytes));
    return;
  }
  std::string_view rest = output.text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    print(stderr, fmt::format("{}: {}\n", solver, printable(rest.substr(0, end))));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (output.dropped != 0) {
    print(stderr, fmt::format("{}: and {} bytes more\n", solver, output.dropped));
  }
}

void report_unplaced_crashes(std::string_view solver, std::uint64_t crashes) {
  if (crashes == 0) return;
  report_error(
      fmt::format("{} ended its process {} times, at no particular query", solver, crashes));
}

Respondents::Respondents(const RespondentArguments& arguments) {
  const SolverProcessOptions process = arguments.process();
  for (const fast::Method* method : named_methods(arguments.methods)) {
    add(arguments.query_limit > 0.0 ? respond_isolated(*method, arguments.options, process)
                                    : respond_in_process(*method, arguments.options),
        arguments.exact);
    respondents_.back()->set_reach(reach_of(method->name()));
  }
  for (const std::filesystem::path& path : arguments.plugins) {
    plugins_.push_back(arguments.load(path));
    add(respond_isolated(*plugins_.back(), arguments.options, process), arguments.exact);
  }
  for (const std::filesystem::path& path : arguments.results) {
    results_.push_back({path, load_answers(path)});
    add(respond_recorded(path.string(), results_.back().answers), arguments.exact);
  }
}

void Respondents::add(std::unique_ptr<Respondent> respondent, bool exact) {
  if (exact) respondent->hold_to(fast::Promise::exact);
  const std::string name = respondent->name();
  const auto is_taken = [&](const auto& other) { return other->name() == respondent->name(); };
  for (int number = 2; std::ranges::any_of(respondents_, is_taken); ++number) {
    respondent->call(fmt::format("{} ({})", name, number));
  }
  respondents_.push_back(std::move(respondent));
}

std::vector<const Respondent*> Respondents::all() const {
  std::vector<const Respondent*> result;
  result.reserve(respondents_.size());
  for (const auto& respondent : respondents_) result.push_back(respondent.get());
  return result;
}

void Respondents::report_output(bool show) const {
  for (const auto& respondent : respondents_) {
    cli::report_output(respondent->name(), respondent->output(), show);
  }
}

std::vector<std::string> Respondents::warnings() const {
  std::vector<std::string> result;
  for (const auto& [path, answers] : results_) {
    const std::uint64_t unasked = answers.unasked();
    if (unasked == 0) continue;
    const auto groups = answers.groups();
    const auto group =
        std::ranges::find_if(groups, [](const auto& candidate) { return candidate.unasked != 0; });
    result.push_back(fmt::format(
        "{}:{}: {} answers are to queries that were not there, first to {} of {}", path.string(),
        group->first_unasked_line, unasked, to_string(group->kind), group->file));
  }
  return result;
}

}  // namespace touchstone::verify::cli
