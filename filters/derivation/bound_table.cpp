#include "touchstone/derivation/bound_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string_view>
#include <thread>

#include "touchstone/derivation/catalogue.hpp"
#include "touchstone/derivation/gappa.hpp"
#include "touchstone/derivation/published_model.hpp"

namespace touchstone::filters {
namespace {

/// A task: one cell of the table that is expensive to compute.
struct Task {
  std::size_t row;
  const CatalogueEntry* entry;
  Model model;
};

bool runs_in(const CatalogueEntry& entry, const Format& format) {
  return std::ranges::find(entry.formats, format.digits, &Format::digits) != entry.formats.end();
}

DeriveRow start_row(const CatalogueEntry& entry, const Format& format,
                    const DeriveOptions& options) {
  DeriveRow row{.expression = entry.graph.name,
                .format = format,
                .published_constant = {},
                .published = {},
                .rigorous = {},
                .gappa = {},
                .observed = {}};
  if (entry.published) {
    const bool is_double = format.digits == double_format.digits;
    row.published_constant = is_double ? entry.published->in_double : entry.published->in_float;
    if (options.models.contains(Model::published)) {
      row.published = published_model_units(find_expression(entry.published->order).graph);
    }
  }
  if (options.models.contains(Model::rigorous)) {
    row.rigorous = derive_bound(entry.graph, format).rounding() / format.unit_roundoff();
  }
  return row;
}

/// Runs the tasks in several threads.
class Work {
 public:
  Work(const DeriveOptions& options, DeriveResult& result, const std::vector<Task>& tasks)
      : options_(options), result_(result), tasks_(tasks) {}

  void run() {
    const unsigned wanted =
        options_.threads > 0 ? options_.threads : std::max(1U, std::thread::hardware_concurrency());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < std::min<std::size_t>(wanted, tasks_.size()); ++i) {
        threads.emplace_back([this] { take_tasks(); });
      }
    }
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void take_tasks() {
    for (std::size_t task = next_++; task < tasks_.size(); task = next_++) {
      try {
        finish(tasks_[task]);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        next_ = tasks_.size();
      }
    }
  }

  void finish(const Task& task) {
    DeriveRow& row = result_.rows[task.row];
    bool missing = false;
    if (task.model == Model::gappa) {
      try {
        row.gappa = gappa_bound(task.entry->graph, row.format, GappaGoal::rounding);
        if (row.gappa) *row.gappa /= row.format.unit_roundoff();
      } catch (const GappaMissing&) {
        missing = true;
      }
    } else {
      row.observed =
          search_worst_case(task.entry->graph, task.entry->evaluators, row.format, options_.search);
    }
    const std::lock_guard lock(mutex_);
    result_.gappa_missing |= missing;
  }

  const DeriveOptions& options_;
  DeriveResult& result_;
  const std::vector<Task>& tasks_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

std::string in_units(const std::optional<mpq_class>& bound) {
  return bound ? fmt::format("{:.6g} u", bound->get_d()) : "";
}

/// The width of a text is its number of characters, because all texts are ASCII.
std::string line(std::size_t name_width, std::string_view expression, std::string_view precision,
                 std::string_view constant, std::string_view published, std::string_view ours,
                 std::string_view gappa, std::string_view observed, std::string_view tightness) {
  return fmt::format("{:<{}}  {:<13}  {:>21}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}\n", expression,
                     name_width, precision, constant, published, ours, gappa, observed, tightness);
}

}  // namespace

std::optional<double> DeriveRow::tightness() const {
  if (!rigorous || !observed || observed->units <= 0) return std::nullopt;
  return rigorous->get_d() / observed->units;
}

DeriveResult derive(const DeriveOptions& options) {
  DeriveResult result;
  std::vector<Task> tasks;
  for (const CatalogueEntry& entry : catalogue()) {
    for (const Format& format : options.formats) {
      if (!runs_in(entry, format)) continue;
      for (const Model model : {Model::gappa, Model::observed}) {
        if (options.models.contains(model)) tasks.push_back({result.rows.size(), &entry, model});
      }
      result.rows.push_back(start_row(entry, format, options));
    }
  }
  Work(options, result, tasks).run();
  return result;
}

std::string to_table(const DeriveResult& result) {
  std::size_t width = std::string_view("expression").size();
  for (const DeriveRow& row : result.rows) width = std::max(width, row.expression.size());
  std::string text = line(width, "expression", "precision", "published constant", "its model",
                          "our bound", "gappa's", "observed", "tightness");
  for (const DeriveRow& row : result.rows) {
    const std::optional<double> tightness = row.tightness();
    text += line(width, row.expression, row.format.name, row.published_constant,
                 in_units(row.published), in_units(row.rigorous), in_units(row.gappa),
                 row.observed ? fmt::format("{:.4g} u", row.observed->units) : "",
                 tightness ? fmt::format("{:.2f}", *tightness) : "");
  }
  return text;
}

}  // namespace touchstone::filters
