#include "verify/cli/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "touchstone/certified.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/view/asked_solvers.hpp"
#include "verify/view/query_facts.hpp"
#include "verify/view/view_page.hpp"

namespace touchstone::verify::cli {
namespace {

bool is_same(const view::ViewedQuery& a, const view::ViewedQuery& b) {
  return a.query == b.query && judge::same_separation(a.separation, b.separation);
}

template <class Thing>
void append(std::vector<Thing>& all, std::vector<Thing>&& further) {
  std::ranges::move(further, std::back_inserter(all));
}

}  // namespace

void ViewFile::add(view::ViewedQuery query) {
  if (!output_) return;
  const auto known = std::ranges::find_if(
      queries_, [&](const view::ViewedQuery& other) { return is_same(other, query); });
  if (known != queries_.end()) {
    append(known->notes, std::move(query.notes));
    append(known->answers, std::move(query.answers));
  } else if (is_full()) {
    is_cut_ = true;
  } else {
    queries_.push_back(std::move(query));
  }
}

void ViewFile::add(const view::ViewedStep& step) {
  if (!output_) return;
  step_ = view::step_facts(step);
  for (view::ViewedQuery& query : view::first_queries(step, most_queries)) add(std::move(query));
}

void ViewFile::add(nlohmann::json resting_mesh) { step_ = std::move(resting_mesh); }

void ViewFile::write(const fast::MethodOptions& options) {
  output_.complete_with([&] { return page(options); });
}

std::string ViewFile::page(const fast::MethodOptions& options) const {
  const auto judge =
      solvers::solver_in_process(solvers::find_method(fast::certified_info().name), options);
  const solvers::Solver* const certified = judge.get();
  std::vector<nlohmann::json> facts;
  for (const view::ViewedQuery& query : queries_) {
    const bool has_answered = std::ranges::find(query.answers, certified->name(),
                                                &judge::GivenAnswer::solver) != query.answers.end();
    facts.push_back(
        view::query_facts(query, view::ask({&certified, has_answered ? 0U : 1U}, query).answers));
  }
  return view::view_page(facts, command_line(), step_);
}

std::string ViewFile::summary(std::uint64_t allowed) const {
  if (!output_ || output_.failed()) return {};
  const std::string name = io::printable(name_);
  if (!step_.is_null()) {
    const auto total = step_.at("total").get<std::size_t>();
    const bool is_at_rest = !step_.contains("after");
    const std::string one = is_at_rest ? "intersection" : "collision";
    return fmt::format("{}: {}, {}\n", name, step_.at("label").get<std::string>(),
                       total == 0   ? (is_at_rest ? "without an " : "without a ") + one
                       : total == 1 ? "1 " + one
                                    : fmt::format("{} {}s", total, one));
  }
  if (queries_.empty() && allowed != 0) {
    return fmt::format(
        "{}: no wrong answer to look at (false positives, which break no promise: {}; --exact "
        "shows them)\n",
        name, allowed);
  }
  if (queries_.empty()) return fmt::format("{}: nothing was found to look at\n", name);
  return fmt::format("{}: {}{} to look at\n", name, is_cut_ ? "the first " : "",
                     queries_.size() == 1 ? "1 query" : fmt::format("{} queries", queries_.size()));
}

}  // namespace touchstone::verify::cli
