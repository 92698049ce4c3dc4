#include "verify/report/stability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format =
    "{:<8}  {:<16}  {:<11}  {:<11}  {:>7}  {:>9}  {:>9}  {:>8}  {:>11}  {:>9}  {:>6}  {:>10}  "
    "{:>9}  {:>9}  {:>9}\n";

constexpr std::string_view legend =
    "levels, a character each: . no wrong answer; 0 to 9 false positives, up to so many tenths of "
    "the misses\nand more (9 with all); N false negatives, T a time of impact excludes the true "
    "one, "
    "E errors, B a yes beyond its tolerance\n";

/// What a level's cell looks like in one character.
char mark_of(const Outcome& outcome) {
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

std::string error_text(double error) {
  return std::isnan(error) ? "-" : fmt::format("{:.2e}", error);
}

std::string number_text(const std::optional<double>& number) {
  return number ? fmt::format("{:.1f}", *number) : "-";
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

void append_row(std::string& text, const Row& row, std::size_t method) {
  CertifyResult sum;
  std::string marks;
  for (const StabilityCell* cell : row) {
    sum += cell->judged;
    marks += mark_of(outcome_of(cell->judged, method));
  }
  const MethodResult& all = sum.methods.at(method);
  const Judgement& judged = all.judgement;
  const Hardness& hardness = *row.front()->hardness;
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), hardness.name,
                 fmt::format("2^{} … 2^{}", hardness.exponents.front(), hardness.exponents.back()),
                 to_string(row.front()->kind), marks, judged.queries,
                 judged.count(Fault::false_negative), judged.count(Fault::false_positive),
                 judged.count(Fault::late_toi), judged.count(Fault::early_toi_upper),
                 judged.undecided, judged.count(Fault::error),
                 number_text(nanoseconds_per_query(all)), number_text(checks_per_query(all)),
                 error_text(judged.toi_errors.quantile(0.5)), error_text(judged.toi_errors.max()));
}

void append_method(std::string& text, const StabilityResult& result, std::size_t method) {
  const MethodResult& total = result.total.methods.at(method);
  text += fmt::format("{} ({}): {} its promise\n", total.name, to_string(total.promise),
                      keeps(total.judgement, total.promise) ? "keeps" : "breaks");
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), "hardness", "levels", "kind",
                 "level by", "queries", "false neg", "false pos", "late toi", "early upper",
                 "undecided", "errors", "ns/query", "checks", "error p50", "error max");
  for (const Row& row : rows_of(result)) append_row(text, row, method);
  text += '\n';
}

nlohmann::json or_null(const std::optional<double>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json to_json(const ToiErrors& errors) {
  if (errors.count() == 0) return {};
  return {{"count", errors.count()}, {"p50", errors.quantile(0.5)}, {"max", errors.max()}};
}

nlohmann::json to_json(const StabilityCell& cell, std::size_t method) {
  const MethodResult& of_method = cell.judged.methods.at(method);
  const Judgement& judged = of_method.judgement;
  const Outcome outcome = outcome_of(cell.judged, method);
  return {{"hardness", cell.hardness->name},
          {"exponent", cell.exponent},
          {"level", std::ldexp(1.0, cell.exponent)},
          {"kind", to_string(cell.kind)},
          {"queries", judged.queries},
          {"collisions", cell.judged.collisions},
          {"false_negatives", judged.count(Fault::false_negative)},
          {"false_positives", judged.count(Fault::false_positive)},
          {"late_toi", judged.count(Fault::late_toi)},
          {"early_toi_upper", judged.count(Fault::early_toi_upper)},
          {"beyond_tolerance", judged.count(Fault::beyond_tolerance)},
          {"errors", judged.count(Fault::error)},
          {"undecided", judged.undecided},
          {"false_negative_rate", rate_of(Fault::false_negative, cell.judged, method)},
          {"false_positive_rate", rate_of(Fault::false_positive, cell.judged, method)},
          {"worst", outcome.worst ? nlohmann::json(to_string(*outcome.worst)) : nlohmann::json()},
          {"worst_rate", outcome.rate},
          {"toi_error", to_json(judged.toi_errors)},
          {"ns_per_query", or_null(nanoseconds_per_query(of_method))},
          {"checks_per_query", or_null(checks_per_query(of_method))}};
}

}  // namespace

std::string to_text(const StabilityResult& result) {
  std::string text;
  if (!is_contact(result.separation)) {
    text += fmt::format("minimum separation {}\n", to_text(result.separation));
  }
  for (std::size_t i = 0; i < result.total.methods.size(); ++i) append_method(text, result, i);
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
    for (const StabilityCell& cell : result.cells) cells.push_back(to_json(cell, i));
    json["methods"].push_back({{"name", total.name},
                               {"promise", to_string(total.promise)},
                               {"keeps_promise", keeps(total.judgement, total.promise)},
                               {"cells", std::move(cells)}});
  }
  return json;
}

}  // namespace touchstone::verify
