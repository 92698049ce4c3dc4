#include "verify/report/stability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view legend =
    "levels, a character each: . no wrong answer; 0 to 9 false positives, up to so many tenths of "
    "the misses\nand more (9 with all); N false negatives, T a time of impact excludes the true "
    "one, "
    "E errors, B a yes beyond its tolerance\n";

std::string_view name_of(const Outcome& outcome) {
  return outcome.worst ? to_string(*outcome.worst) : std::string_view();
}

/// What a level's cell looks like in one character.
char character_of(const Outcome& outcome) {
  if (!outcome.worst) return '.';
  switch (*outcome.worst) {
    case Fault::false_negative:
      return 'N';
    case Fault::late_toi:
    case Fault::early_toi_upper:
      return 'T';
    case Fault::error:
      return 'E';
    case Fault::beyond_tolerance:
      return 'B';
    default:
      return static_cast<char>('0' + std::min(9, static_cast<int>(10.0 * outcome.rate)));
  }
}

/// The cells of one hardness and kind.
using Row = std::vector<const StabilityCell*>;

std::vector<Row> rows_of(const StabilityResult& result) {
  std::vector<Row> rows;
  for (const StabilityCell& cell : result.cells) {
    const bool is_new = rows.empty() || rows.back().front()->hardness != cell.hardness ||
                        rows.back().front()->kind != cell.kind;
    if (is_new) rows.emplace_back();
    rows.back().push_back(&cell);
  }
  return rows;
}

std::vector<TextColumn> columns() {
  return joined<TextColumn>(
      {{word_column("hardness", 8),
        word_column("levels", 16),
        word_column("kind", 11),
        word_column("level by", 11),
        {"queries", 7}},
       fault_columns(),
       {{"ns/query", 10}, {"checks", 9}, {"error p50", 9}, {"error max", 9}}});
}

TextRow text_row(const Row& row, std::size_t method) {
  CertifyResult sum;
  std::string marks;
  for (const StabilityCell* cell : row) {
    sum += cell->judged;
    marks += character_of(outcome_of(cell->judged, method));
  }
  const MethodResult& all = sum.methods.at(method);
  const Judgement& judged = all.judgement;
  const Hardness& hardness = *row.front()->hardness;
  return joined<std::string>(
      {{std::string(hardness.name),
        fmt::format("2^{} … 2^{}", hardness.exponents.front(), hardness.exponents.back()),
        std::string(to_string(row.front()->kind)), marks, std::to_string(judged.queries)},
       fault_cells(judged),
       {number_text(nanoseconds_per_query(all), "{:.1f}"),
        number_text(checks_per_query(all), "{:.1f}"), error_text(judged.toi_errors.quantile(0.5)),
        error_text(judged.toi_errors.max())}});
}

std::string method_text(const StabilityResult& result, std::size_t method) {
  TextTable table(columns());
  for (const Row& row : rows_of(result)) table.add(text_row(row, method));
  return fmt::format("{}\n{}\n", promise_text(result.total.methods.at(method)), table.text());
}

nlohmann::json json_of(const StabilityCell& cell, std::size_t method) {
  const MethodResult& of_method = cell.judged.methods.at(method);
  const Judgement& judged = of_method.judgement;
  const Outcome outcome = outcome_of(cell.judged, method);
  nlohmann::json json = to_json(judged);
  json.update({{"hardness", cell.hardness->name},
               {"exponent", cell.exponent},
               {"level", std::ldexp(1.0, cell.exponent)},
               {"kind", to_string(cell.kind)},
               {"queries", judged.queries},
               {"collisions", cell.judged.collisions},
               {"beyond_tolerance", judged.count(Fault::beyond_tolerance)},
               {"false_negative_rate", rate_of(Fault::false_negative, cell.judged, method)},
               {"false_positive_rate", rate_of(Fault::false_positive, cell.judged, method)},
               {"worst", text_or_null(name_of(outcome))},
               {"worst_rate", outcome.rate},
               {"ns_per_query", number_to_json(nanoseconds_per_query(of_method))},
               {"checks_per_query", number_to_json(checks_per_query(of_method))}});
  return json;
}

StabilityMark mark_of(const StabilityCell& cell, std::size_t method) {
  const MethodResult& result = cell.judged.methods.at(method);
  const Judgement& judged = result.judgement;
  const Outcome outcome = outcome_of(cell.judged, method);
  return {.method = result.name,
          .hardness = std::string(cell.hardness->name),
          .measure = std::string(cell.hardness->measure),
          .exponent = cell.exponent,
          .kind = cell.kind,
          .queries = cell.judged.queries,
          .collisions = cell.judged.collisions,
          .false_positives = judged.count(Fault::false_positive),
          .false_negatives = judged.count(Fault::false_negative),
          .late_tois = judged.count(Fault::late_toi),
          .early_upper_tois = judged.count(Fault::early_toi_upper),
          .beyond_tolerance = judged.count(Fault::beyond_tolerance),
          .errors = judged.count(Fault::error),
          .undecided = judged.undecided,
          .worst = std::string(name_of(outcome)),
          .worst_rate = outcome.rate,
          .toi_error = spread_of(judged.toi_errors),
          .nanoseconds = nanoseconds_per_query(result).value_or(Measurement::unknown),
          .checks = checks_per_query(result).value_or(Measurement::unknown)};
}

}  // namespace

std::string promise_text(const MethodResult& method) {
  return fmt::format("{} ({}): {} its promise", printable(method.name), to_string(method.promise),
                     keeps(method.judgement, method.promise) ? "keeps" : "breaks");
}

std::string to_text(const StabilityResult& result) {
  std::string text;
  if (!is_contact(result.separation)) {
    text += fmt::format("minimum separation {}\n", to_text(result.separation));
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) text += method_text(result, i);
  text += legend;
  for (const StabilityCell& cell : result.cells) {
    for (const Mismatch& mismatch : cell.judged.mismatches) {
      text += fmt::format("disagreement: {}: {} query {}: certified solver {}, oracle {}\n",
                          cell.judged.name, to_string(cell.kind), mismatch.index, mismatch.recorded,
                          mismatch.truth);
    }
  }
  return text;
}

nlohmann::json to_json(const StabilityResult& result) {
  nlohmann::json json{{"seed", result.seed},
                      {"count", result.count},
                      {"separation", nlohmann::json()},
                      {"interrupted", result.total.interrupted},
                      {"disagreements", result.total.label_mismatches},
                      {"hardnesses", nlohmann::json::array()},
                      {"methods", nlohmann::json::array()}};
  if (!is_contact(result.separation)) json["separation"] = to_json(result.separation);
  const Hardness* latest = nullptr;
  for (const StabilityCell& cell : result.cells) {
    if (cell.hardness == latest) continue;
    latest = cell.hardness;
    json["hardnesses"].push_back({{"name", latest->name},
                                  {"measure", latest->measure},
                                  {"reason", latest->reason},
                                  {"exponents", latest->exponents}});
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) {
    const MethodResult& total = result.total.methods[i];
    nlohmann::json cells = nlohmann::json::array();
    for (const StabilityCell& cell : result.cells) cells.push_back(json_of(cell, i));
    json["methods"].push_back({{"name", total.name},
                               {"promise", to_string(total.promise)},
                               {"keeps_promise", keeps(total.judgement, total.promise)},
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

Table overview_of(const StabilityResult& result) {
  Table table{.title = "The worst at any level", .columns = {"method"}, .rows = {}};
  std::vector<CertifyResult> sums;
  for (const StabilityCell& cell : result.cells) {
    if (table.columns.back() != cell.hardness->name) {
      table.columns.emplace_back(cell.hardness->name);
      sums.emplace_back();
    }
    sums.back() += cell.judged;
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(result.total.methods[i].name);
    for (const CertifyResult& sum : sums) {
      const Outcome outcome = outcome_of(sum, i);
      row.push_back(outcome.worst
                        ? fmt::format("{} {:.2g} %", name_of(outcome), 100.0 * outcome.rate)
                        : "nothing wrong");
    }
  }
  return table;
}

}  // namespace touchstone::verify
