#include "verify/report/judgement_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "verify/io/json.hpp"

namespace touchstone::verify::report {
namespace {

nlohmann::json to_json(const judge::LateTimes& late) {
  return {{"count", late.count},
          {"beyond", late.beyond},
          {"greatest", io::number_to_json(late.greatest.step)},
          {"greatest_ulps", io::number_to_json(late.greatest.ulps)}};
}

}  // namespace

std::vector<io::TextColumn> fault_columns() {
  return {{"false neg", 9},    {"false pos", 9}, {"late toi", 8},
          {"early upper", 11}, {"undecided", 9}, {"errors", 7}};
}

io::TextRow fault_cells(const judge::Judgement& judgement) {
  return {std::to_string(judgement.count(judge::Fault::false_negative)),
          std::to_string(judgement.count(judge::Fault::false_positive)),
          std::to_string(judgement.count(judge::Fault::late_toi)),
          std::to_string(judgement.count(judge::Fault::early_toi_upper)),
          std::to_string(judgement.undecided()),
          std::to_string(judgement.errors())};
}

bool claims_too_much(const judge::Judgement& judgement) {
  return judgement.count(judge::Fault::beyond_tolerance) != 0;
}

io::TextColumn tolerance_column() { return {"beyond tol", 10}; }

std::string tolerance_cell(const judge::Judgement& judgement) {
  return std::to_string(judgement.count(judge::Fault::beyond_tolerance));
}

std::vector<io::TextColumn> toi_error_columns() {
  return {{"error p50", 9}, {"error p99", 9}, {"error max", 9}};
}

io::TextRow toi_error_cells(const judge::ToiErrors& errors) {
  return {io::error_text(errors.quantile(0.5)), io::error_text(errors.quantile(0.99)),
          io::error_text(errors.max())};
}

std::string reading_text(std::uint64_t skipped, std::uint64_t rounded) {
  std::string text;
  if (skipped != 0) text += fmt::format("{} queries in error skipped\n", skipped);
  if (rounded != 0) text += fmt::format("{} coordinates rounded to double\n", rounded);
  return text;
}

nlohmann::json to_json(const judge::Judgement& judgement) {
  return {{"false_negatives", judgement.count(judge::Fault::false_negative)},
          {"false_positives", judgement.count(judge::Fault::false_positive)},
          {"late_toi", judgement.count(judge::Fault::late_toi)},
          {"early_toi_upper", judgement.count(judge::Fault::early_toi_upper)},
          {"beyond_tolerance", judgement.count(judge::Fault::beyond_tolerance)},
          {"undecided", judgement.undecided()},
          {"errors", judgement.errors()},
          {"outside", judgement.outside},
          {"left_out", judgement.left_out},
          {"toi_error", judge::to_json(judgement.toi_errors)},
          {"late", to_json(judgement.late)}};
}

}  // namespace touchstone::verify::report
