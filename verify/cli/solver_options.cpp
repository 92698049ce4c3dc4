#include "verify/cli/solver_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/solvers/published.hpp"

namespace touchstone::verify::cli {
namespace {

constexpr std::string_view no_method = "none";
/// A check of a box on curves takes ten times as long, and families on curves need more of them.
constexpr std::int64_t curved_max_checks = 10'000;

/// \throws std::invalid_argument for "none" with others.
std::vector<std::string> named_methods(const SolverArguments& arguments) {
  const bool has_none = std::ranges::find(arguments.methods, no_method) != arguments.methods.end();
  if (!has_none) return arguments.methods;
  if (arguments.methods.size() > 1) {
    throw std::invalid_argument("--method none excludes other methods");
  }
  return {};
}

}  // namespace

void add_named_solver_options(Command& command, SolverArguments& arguments) {
  begin_group(command, "Solver");
  add_option(command, "--method", arguments.methods);
  add_option(command, "--plugin", arguments.plugins);
  add_option(command, "--answers-kinds", arguments.kinds);
  add_option(command, "--float-coordinates", arguments.float_coordinates);
  add_option(command, "--starts-apart", arguments.starts_apart);
  add_option(command, "--times", arguments.times);
  add_option(command, "--time-error", arguments.time_error);
  add_option(command, "--query-limit", arguments.query_limit);
  add_option(command, "--memory-limit", arguments.memory_limit);
  add_option(command, "--allow-processes", arguments.allow_processes);
  add_option(command, "--show-output", arguments.show_output);
}

void add_solver_options(Command& command, SolverArguments& arguments) {
  add_named_solver_options(command, arguments);
  add_option(command, "--tolerance", arguments.options.tolerance);
  add_option(command, "--max-checks", arguments.options.max_checks);
}

solvers::TermsChanges SolverArguments::terms() const {
  solvers::TermsChanges terms{.starts_apart = io::number_from_text<double>(starts_apart),
                              .time_error = time_error};
  for (const std::string& name : kinds) terms.kinds.push_back(kind_from_string(name));
  if (float_coordinates) terms.float_coordinates = true;
  if (!times.empty()) {
    terms.times = times == "bounds" ? fast::Times::bounds
                  : times == "none" ? fast::Times::none
                                    : fast::Times::estimates;
  }
  return terms;
}

void settle_query_limit(const Command& command, double seconds, SolverArguments& arguments) {
  constexpr double least_limit = 0.1, part = 1.0 / 60.0;
  if (is_given(command, "--query-limit") || !(seconds > 0.0)) return;
  arguments.query_limit = std::min(arguments.query_limit, std::max(least_limit, part * seconds));
}

std::vector<std::filesystem::path> SolverArguments::files() const {
  std::vector<std::filesystem::path> all = plugins;
  all.insert(all.end(), results.begin(), results.end());
  return all;
}

solvers::ChildLimits SolverArguments::limits() const {
  solvers::ChildLimits limits{.may_fork = allow_processes};
  if (memory_limit) {
    limits.memory_bytes = static_cast<std::uint64_t>(*memory_limit * bytes_of_gibibyte);
  }
  return limits;
}

std::unique_ptr<fast::Method> SolverArguments::load(const std::filesystem::path& plugin) const {
  constexpr double least_limit = 10.0;  // the disk may be slow
  return solvers::load_plugin(plugin, {.terms = terms(),
                                       .limits = limits(),
                                       .load_seconds = std::max(least_limit, query_limit),
                                       .stop = &io::interrupted()});
}

solvers::SolverProcessOptions SolverArguments::process() const {
  return {.query_limit_seconds = query_limit, .stop = &io::interrupted(), .limits = limits()};
}

void settle_solver_options(const Command& command, bool built_in_set, SolverArguments& arguments) {
  if (built_in_set) {
    if (!is_given(command, "--max-checks")) {
      arguments.options.max_checks =
          is_given(command, "--degree") ? curved_max_checks : built_in_max_checks;
    }
    return;
  }
  for (const std::string name : {"--exact", "--query-limit", "--memory-limit", "--allow-processes",
                                 "--show-output", "--tolerance", "--max-checks"}) {
    if (arguments.empty() && is_given(command, name)) {
      throw std::invalid_argument(name + " needs a solver: add --method or --plugin");
    }
  }
}

void report_output(std::string_view solver, const solvers::CapturedOutput& output, bool show) {
  if (output.text.empty()) return;
  const std::uint64_t bytes = output.text.size() + output.dropped;
  if (!show) {
    report_warning(fmt::format("{} printed {} bytes; --show-output shows them", solver, bytes));
    return;
  }
  std::string_view rest = output.text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    io::print(stderr, fmt::format("{}: {}\n", solver, io::printable(rest.substr(0, end))));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (output.dropped != 0) {
    io::print(stderr, fmt::format("{}: and {} bytes more\n", solver, output.dropped));
  }
}

void report_norms(const fast::MethodInfo& info, const Separation& separation) {
  if (is_zero(separation) || info.norms.empty() || info.measures_in(separation.norm)) return;
  const std::string_view own = to_string(info.norms.front());
  report_warning(fmt::format(
      "{} measures a separation in {} only, and is asked in {}; --norm {} asks in its own norm",
      info.name, own, to_string(separation.norm), own));
}

void report_unplaced_crashes(std::string_view solver, std::uint64_t crashes) {
  if (crashes == 0) return;
  report_error(
      fmt::format("{} ended its process {} times, not at a particular query", solver, crashes));
}

Status status_of(std::string_view solver, const judge::Responses& responses) {
  const auto silence = judge::silence_of(solver, responses);
  if (!silence) return Status::all_well;
  report_error(silence->text);
  return silence->is_unjudged ? Status::bad_input : Status::wrong_answers;
}

Status worse(Status a, Status b) {
  for (const Status status : {Status::wrong_answers, Status::bad_input}) {
    if (a == status || b == status) return status;
  }
  return std::max(a, b);
}

Solvers::Solvers(Files& files, const SolverArguments& arguments, MethodHost host) {
  files.add_inputs(arguments.files());
  const solvers::SolverProcessOptions process = arguments.process();
  const bool in_children = host == MethodHost::children_with_limit && arguments.query_limit > 0.0;
  for (const std::string& name : named_methods(arguments)) {
    const fast::Method& method = method_named(name, arguments);
    fast::MethodOptions options = arguments.options;
    if (arguments.has_usual_checks) {
      options.max_checks = std::min(options.max_checks, method.info().usual_max_checks);
    }
    add(in_children ? solvers::solver_in_children(method, options, process)
                    : solvers::solver_in_process(method, options),
        arguments.exact);
  }
  for (const std::filesystem::path& path : arguments.plugins) {
    methods_.push_back(arguments.load(path));
    add(solvers::solver_in_children(*methods_.back(), arguments.options, process), arguments.exact);
  }
  for (const std::filesystem::path& path : arguments.results) {
    results_.push_back({path, solvers::load_answers(path)});
    fast::Terms terms;
    for (const auto& group : results_.back().answers.groups()) {
      terms.add(group.kind);
    }
    add(solvers::recorded_solver(path.string(), results_.back().answers,
                                 solvers::changed(terms, arguments.terms())),
        arguments.exact);
  }
}

const fast::Method& Solvers::method_named(std::string_view name, const SolverArguments& arguments) {
  const fast::Method& method = solvers::find_any(name);
  const bool is_chosen = arguments.kernels.certified != nullptr;
  if (!is_chosen || name != fast::certified_info().name) return method;
  methods_.push_back(fast::certified_method({.kernels = arguments.kernels}));
  return *methods_.back();
}

void Solvers::add(std::unique_ptr<solvers::Solver> solver, bool exact) {
  if (exact) solver->hold_to(fast::Promise::exact);
  const std::string name = solver->name();
  const auto is_taken = [&](const auto& other) { return other->name() == solver->name(); };
  for (int number = 2; std::ranges::any_of(solvers_, is_taken); ++number) {
    solver->rename(fmt::format("{} ({})", name, number));
  }
  solvers_.push_back(std::move(solver));
}

std::vector<const solvers::Solver*> Solvers::all() const {
  std::vector<const solvers::Solver*> result;
  result.reserve(solvers_.size());
  for (const auto& solver : solvers_) result.push_back(solver.get());
  return result;
}

void Solvers::report_norms(const Separation& separation) {
  if (is_zero(separation) || std::exchange(has_reported_norms_, true)) return;
  for (const auto& solver : solvers_) cli::report_norms(solver->info(), separation);
}

void Solvers::report_output(bool show) const {
  for (const auto& solver : solvers_) {
    cli::report_output(solver->name(), solver->take_output(), show);
  }
}

std::vector<std::string> Solvers::warnings() const {
  std::vector<std::string> result;
  for (const auto& [path, answers] : results_) {
    const std::uint64_t unasked = answers.unasked();
    if (unasked == 0) continue;
    const auto groups = answers.groups();
    const auto group =
        std::ranges::find_if(groups, [](const auto& candidate) { return candidate.unasked != 0; });
    result.push_back(fmt::format("{}:{}: {} answers refer to unknown queries (first: {} of {})",
                                 path.string(), group->first_unasked_line, unasked,
                                 to_string(group->kind), group->file));
  }
  return result;
}

}  // namespace touchstone::verify::cli
