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
#include "verify/methods/plugin.hpp"
#include "verify/methods/registry.hpp"

namespace touchstone::verify::cli {
namespace {

constexpr std::string_view no_method = "none";
constexpr double longest_limit = 1e6;

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
                  "Seconds a query may take; beyond, it is undecided (0: no limit)")
      ->capture_default_str()
      ->check(real_number(0.0, longest_limit));
  command
      .add_option("--tolerance", arguments.options.tolerance,
                  "What tolerance-driven methods aim at, in units of the coordinates")
      ->capture_default_str()
      ->check(real_number(DBL_TRUE_MIN, DBL_MAX));
  command
      .add_option("--max-checks", arguments.options.max_checks,
                  "Steps that iterative methods may take a query (0: no limit)")
      ->capture_default_str()
      ->check(whole_number(0, INT64_MAX));
}

Respondents::Respondents(const RespondentArguments& arguments) {
  const IsolationOptions isolation{.query_limit_seconds = arguments.query_limit};
  for (const fast::Method* method : named_methods(arguments.methods)) {
    add(arguments.query_limit > 0.0 ? respond_isolated(*method, arguments.options, isolation)
                                    : respond_in_process(*method, arguments.options),
        arguments.exact);
  }
  for (const std::filesystem::path& path : arguments.plugins) {
    plugins_.push_back(load_plugin(path));
    add(respond_isolated(*plugins_.back(), arguments.options, isolation), arguments.exact);
  }
  for (const std::filesystem::path& path : arguments.results) {
    results_.push_back({path, load_answers(path)});
    add(respond_recorded(path.string(), results_.back().answers), arguments.exact);
  }
}

void Respondents::add(std::unique_ptr<Respondent> respondent, bool exact) {
  if (exact) respondent->hold_to(fast::Promise::exact);
  respondents_.push_back(std::move(respondent));
}

std::vector<const Respondent*> Respondents::all() const {
  std::vector<const Respondent*> result;
  result.reserve(respondents_.size());
  for (const auto& respondent : respondents_) result.push_back(respondent.get());
  return result;
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
