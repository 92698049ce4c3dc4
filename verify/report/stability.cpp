#include "verify/report/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "verify/base/deadline.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/judge/terms.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

constexpr std::string_view map_legend =
    "worst by level, a character each: . every answer is right; - nothing was asked; 0 to 9 false "
    "positives, up to so many tenths of the misses\nand more (9 with all); N false negatives, T a "
    "time of impact excludes the true one (t: late by at most 1e-9), E errors, B a yes beyond its "
    "tolerance\nfailures by level, whatever is worse: E errors, H hangs, # both, . none\n";

std::vector<StabilityCell> cells_of(const StabilityOptions& options) {
  std::vector<StabilityCell> cells;
  for (const generate::Hardness* hardness : options.hardnesses) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      for (const int level : hardness->levels) {
        cells.push_back({{.hardness = hardness,
                          .level = level,
                          .kind = kind,
                          .separation = options.certify.separation},
                         {}});
      }
    }
  }
  return cells;
}

jobs::CertifyResult judge_cell(const generate::HardSort& sort, const StabilityOptions& options,
                               jobs::CertifyOptions certify_options) {
  const auto source = generate::open_hard_queries(sort, options.seed, options.count);
  certify_options.separation = source->recorded_separation();
  jobs::CertifyResult judged = jobs::certify(*source, certify_options);
  if (judged.error) throw std::runtime_error(source->name() + ": " + *judged.error);
  return judged;
}

/// The worst that a method did, and the rate of that fault.
struct Outcome {
  std::optional<judge::WorstFault> worst;  ///< nothing if nothing is wrong
  double rate = 0.0;
};

Outcome outcome_of(const jobs::CertifyResult& judged, std::size_t method) {
  const jobs::MethodResult& result = judged.methods.at(method);
  const auto worst = judge::worst_of(result.judgement, result.promise);
  return {worst, worst ? rate_of(worst->fault, judged, method) : 0.0};
}

std::string_view name_of(const Outcome& outcome) {
  if (!outcome.worst) return {};
  return outcome.worst->is_slight ? "slightly late toi" : judge::to_text(outcome.worst->fault);
}

/// "8.3 %", "100 %": two digits, or whole numbers from 100.
std::string percent(double share) {
  const double percents = 100.0 * share;
  return percents < 99.5 ? fmt::format("{:.2g} %", percents) : fmt::format("{:.0f} %", percents);
}

/// A level's cell in one character.
char character_of(const jobs::CertifyResult& judged, std::size_t method) {
  if (judged.methods.at(method).judgement.queries == 0) return '-';
  const auto [worst, rate] = outcome_of(judged, method);
  if (!worst) return '.';
  if (worst->fault != judge::Fault::false_positive) {
    return judge::letter_of(worst->fault, worst->is_slight);
  }
  return static_cast<char>('0' + std::min(9, static_cast<int>(10.0 * rate)));
}

/// Errors and hangs of a level in one character.
char failures_of(const jobs::CertifyResult& judged, std::size_t method) {
  const judge::Judgement& judgement = judged.methods.at(method).judgement;
  const bool has_hangs = judgement.count(judge::Fault::hang) != 0;
  if (judgement.errors() != 0) return has_hangs ? '#' : judge::letter_of(judge::Fault::crash);
  return has_hangs ? judge::letter_of(judge::Fault::hang) : '.';
}

/// The cells of one hardness and kind.
using CellRow = std::vector<const StabilityCell*>;

std::vector<CellRow> rows_of(const StabilityResult& result) {
  std::vector<CellRow> rows;
  for (const StabilityCell& cell : result.cells) {
    const bool is_new = rows.empty() || rows.back().front()->sort.hardness != cell.sort.hardness ||
                        rows.back().front()->sort.kind != cell.sort.kind;
    if (is_new) rows.emplace_back();
    rows.back().push_back(&cell);
  }
  return rows;
}

std::vector<io::TextColumn> columns() {
  return io::joined<io::TextColumn>(
      {{io::word_column("hardness", 8),
        io::word_column("levels", 16),
        io::word_column("kind", 11),
        io::word_column("worst by level", 11),
        io::word_column("failures", 11),
        {"queries", 7}},
       fault_columns(),
       {{"ns/query", 10}, {"checks", 9}, {"error p50", 9}, {"error max", 9}}});
}

io::TextRow text_row(const CellRow& row, std::size_t method) {
  jobs::CertifyResult sum;
  std::string marks, failures;
  for (const StabilityCell* cell : row) {
    sum += cell->judged;
    marks += character_of(cell->judged, method);
    failures += failures_of(cell->judged, method);
  }
  const jobs::MethodResult& all = sum.methods.at(method);
  const judge::Judgement& judged = all.judgement;
  const generate::Hardness& hardness = *row.front()->sort.hardness;
  return io::joined<std::string>(
      {{std::string(hardness.name),
        fmt::format("{} … {}", generate::level_text(hardness, hardness.levels.front()),
                    generate::level_text(hardness, hardness.levels.back())),
        std::string(to_string(row.front()->sort.kind)), marks, failures,
        std::to_string(judged.queries)},
       fault_cells(judged),
       {io::number_text(all.nanoseconds_per_query(), "{:.1f}"),
        io::number_text(all.checks_per_query(), "{:.1f}"),
        io::error_text(judged.toi_errors.quantile(0.5)), io::error_text(judged.toi_errors.max())}});
}

std::string method_text(const StabilityResult& result, std::size_t method) {
  io::TextTable table(columns());
  for (const CellRow& row : rows_of(result)) table.add(text_row(row, method));
  const jobs::MethodResult& total = result.total.methods.at(method);
  std::string notes;
  if (const std::string late = late_text(total.judgement.late); !late.empty()) {
    notes += "times of impact: " + late + '\n';
  }
  if (const std::string unasked = unasked_text(total.judgement, total.terms); !unasked.empty()) {
    notes += "not asked: " + unasked + '\n';
  }
  return fmt::format("{}\n{}{}\n", promise_text(total), table.text(), notes);
}

nlohmann::json json_of(const StabilityCell& cell, std::size_t method) {
  const jobs::MethodResult& of_method = cell.judged.methods.at(method);
  const judge::Judgement& judged = of_method.judgement;
  const Outcome outcome = outcome_of(cell.judged, method);
  nlohmann::json json = report::to_json(judged);
  json.update({{"hardness", cell.sort.hardness->name},
               {"level", generate::level_value(*cell.sort.hardness, cell.sort.level)},
               {"kind", to_string(cell.sort.kind)},
               {"queries", judged.queries},
               {"collisions", cell.judged.collisions},
               {"false_negative_rate", rate_of(judge::Fault::false_negative, cell.judged, method)},
               {"false_positive_rate", rate_of(judge::Fault::false_positive, cell.judged, method)},
               {"worst", io::text_or_null(name_of(outcome))},
               {"worst_rate", outcome.rate},
               {"ns_per_query", io::number_to_json(of_method.nanoseconds_per_query())},
               {"checks_per_query", io::number_to_json(of_method.checks_per_query())}});
  return json;
}

StabilityMark mark_of(const StabilityCell& cell, std::size_t method) {
  const jobs::MethodResult& result = cell.judged.methods.at(method);
  const judge::Judgement& judged = result.judgement;
  const auto [worst, rate] = outcome_of(cell.judged, method);
  StabilityMark mark{counts_of(judged)};
  mark.collisions = cell.judged.collisions;
  mark.nanoseconds = result.nanoseconds_per_query().value_or(StabilityMark::unknown);
  mark.method = result.name;
  mark.hardness = cell.sort.hardness->name;
  mark.measure = cell.sort.hardness->measure;
  mark.exponent = cell.sort.level;
  mark.is_power = cell.sort.hardness->unit == generate::LevelUnit::power_of_two;
  mark.kind = cell.sort.kind;
  mark.queries = cell.judged.queries;
  mark.hangs = judged.count(judge::Fault::hang);
  if (worst) mark.worst = worst->fault;
  mark.is_slight = worst && worst->is_slight;
  mark.worst_rate = rate;
  mark.checks = result.checks_per_query().value_or(StabilityMark::unknown);
  return mark;
}

}  // namespace

StabilityResult measure_stability(const StabilityOptions& options) {
  StabilityResult result{.separation = options.certify.separation,
                         .seed = options.seed,
                         .count = options.count,
                         .total = {},
                         .cells = cells_of(options)};
  result.total.name = "total";
  jobs::CertifyOptions certify_options = options.certify;
  jobs::Budget budget;
  if (options.seconds > 0.0) {
    budget = jobs::Budget(options.seconds, certify_options.solvers, certify_options.threads);
  }
  const auto stopped = [&] { return base::is_stopped(certify_options.stop) || budget.is_over(); };
  std::size_t done = 0;
  certify_options.on_progress = [&](double fraction) {
    if (!options.certify.on_progress) return;
    options.certify.on_progress((static_cast<double>(done) + fraction) /
                                static_cast<double>(result.cells.size()));
  };
  for (; done < result.cells.size() && !stopped(); ++done) {
    StabilityCell& cell = result.cells[done];
    certify_options.deadline = budget.begin_source(result.cells.size() - done);
    cell.judged = judge_cell(cell.sort, options, certify_options);
    result.total += cell.judged;
    certify_options.on_progress(1.0);
  }
  result.total.interrupted = result.total.interrupted || done < result.cells.size();
  result.unjudged_cells = result.cells.size() - done;
  result.cells.resize(done);
  return result;
}

double rate_of(judge::Fault fault, const jobs::CertifyResult& judged, std::size_t method) {
  const judge::Judgement& judgement = judged.methods.at(method).judgement;
  const std::uint64_t misses = judgement.queries - judgement.collisions;
  const bool about_misses =
      fault == judge::Fault::false_positive || fault == judge::Fault::beyond_tolerance;
  const std::uint64_t among = judge::is_error(fault) ? judgement.queries
                              : about_misses         ? misses
                                                     : judgement.collisions;
  const std::uint64_t count = judgement.total(fault);
  return among == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(among);
}

std::string promise_text(const jobs::MethodResult& method) {
  const bool keeps = judge::keeps(method.judgement, method.promise);
  const std::string name = io::printable(method.name);
  if (method.promise == fast::Promise::none) {
    return fmt::format("{}: promises nothing; {} worse than false positives", name,
                       keeps ? "nothing" : "answers");
  }
  return fmt::format("{} ({}{}): {} its promise", name, solvers::to_string(method.promise),
                     judge::to_text(method.terms), keeps ? "keeps" : "breaks");
}

std::string to_text(const StabilityResult& result) {
  std::string text;
  if (!is_zero(result.separation)) {
    text += fmt::format("minimum separation {}\n", judge::to_text(result.separation));
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) text += method_text(result, i);
  text += map_legend;
  if (result.unjudged_cells != 0) {
    text += fmt::format("{} cells were not judged\n", result.unjudged_cells);
  }
  for (const StabilityCell& cell : result.cells) {
    for (const judge::Mismatch& mismatch : cell.judged.mismatches) {
      text += fmt::format("disagreement: {}: {} query {}: certified solver {}, oracle {}\n",
                          cell.judged.name, to_string(cell.sort.kind), mismatch.index,
                          mismatch.recorded, mismatch.truth);
    }
  }
  return text;
}

nlohmann::json to_json(const StabilityResult& result) {
  nlohmann::json json{{"seed", result.seed},
                      {"count", result.count},
                      {"separation", judge::to_json(result.separation)},
                      {"interrupted", result.total.interrupted},
                      {"unjudged_cells", result.unjudged_cells},
                      {"disagreements", result.total.label_mismatches},
                      {"hardnesses", nlohmann::json::array()},
                      {"methods", nlohmann::json::array()}};
  const generate::Hardness* latest = nullptr;
  for (const StabilityCell& cell : result.cells) {
    if (cell.sort.hardness == latest) continue;
    latest = cell.sort.hardness;
    nlohmann::json levels = nlohmann::json::array();
    for (const int level : latest->levels) levels.push_back(generate::level_value(*latest, level));
    json["hardnesses"].push_back({{"name", latest->name},
                                  {"measure", latest->measure},
                                  {"reason", latest->reason},
                                  {"levels", std::move(levels)}});
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) {
    const jobs::MethodResult& total = result.total.methods[i];
    nlohmann::json cells = nlohmann::json::array();
    for (const StabilityCell& cell : result.cells) cells.push_back(json_of(cell, i));
    json["methods"].push_back({{"name", total.name},
                               {"promise", solvers::to_string(total.promise)},
                               {"keeps_promise", judge::keeps(total.judgement, total.promise)},
                               {"cells", std::move(cells)}});
  }
  return json;
}

std::vector<StabilityMark> marks_of(const StabilityResult& result) {
  std::vector<StabilityMark> marks;
  for (const StabilityCell& cell : result.cells) {
    for (std::size_t i = 0; i < cell.judged.methods.size(); ++i) marks.push_back(mark_of(cell, i));
  }
  return marks;
}

nlohmann::json overview_of(const StabilityResult& result) {
  std::vector<std::string> columns{"method"};
  std::vector<jobs::CertifyResult> sums;
  for (const StabilityCell& cell : result.cells) {
    if (columns.back() != cell.sort.hardness->name) {
      columns.emplace_back(cell.sort.hardness->name);
      sums.emplace_back();
    }
    sums.back() += cell.judged;
  }
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) {
    std::vector<std::string> row{io::printable(result.total.methods[i].name)};
    for (const jobs::CertifyResult& sum : sums) {
      const Outcome outcome = outcome_of(sum, i);
      row.push_back(outcome.worst ? fmt::format("{} {}", name_of(outcome), percent(outcome.rate))
                                  : "nothing wrong");
    }
    rows.push_back(row);
  }
  return {{"title", "The worst at any level"}, {"columns", columns}, {"rows", std::move(rows)}};
}

}  // namespace touchstone::verify::report
