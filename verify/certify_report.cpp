#include "verify/certify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format =
    "{:<{}}  {:<11}  {:>9}  {:>10}  {:>9}  {:>11}  {:>9}  {:>10}  {:>8}\n";

std::string_view kind_text(const CertifyResult& result) {
  return result.kind ? to_string(*result.kind) : "";
}

void append_row(std::string& text, std::size_t width, const CertifyResult& result) {
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), result.name, width,
                 kind_text(result), result.queries, result.collisions, result.labels,
                 result.label_mismatches, result.tois, result.toi_mismatches,
                 fmt::format("{:.2f}", result.microseconds_per_query()));
}

std::string_view name_of(Mismatch::Of of) { return of == Mismatch::Of::label ? "label" : "toi"; }

nlohmann::json counts(const CertifyResult& result) {
  return {{"queries", result.queries},
          {"collisions", result.collisions},
          {"labels", result.labels},
          {"label_mismatches", result.label_mismatches},
          {"tois", result.tois},
          {"toi_mismatches", result.toi_mismatches},
          {"us_per_query", result.microseconds_per_query()},
          {"skipped", result.skipped},
          {"rounded", result.rounded},
          {"errors", result.errors},
          {"interrupted", result.interrupted}};
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string to_text(const std::vector<CertifyResult>& results) {
  std::size_t width = 5;
  for (const CertifyResult& result : results) width = std::max(width, result.name.size());

  std::string text;
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), "file", width, "kind",
                 "queries", "collisions", "labels", "mislabelled", "tois", "wrong tois",
                 "µs/query");
  for (const CertifyResult& result : results) append_row(text, width, result);
  const CertifyResult sum = total(results);
  append_row(text, width, sum);
  if (sum.skipped != 0) text += fmt::format("{} queries in error skipped\n", sum.skipped);
  if (sum.rounded != 0) text += fmt::format("{} coordinates rounded to double\n", sum.rounded);

  for (const CertifyResult& result : results) {
    for (const Mismatch& mismatch : result.mismatches) {
      text += fmt::format("mismatch: {}: {} query {}: recorded {} {}, truth {}\n", result.name,
                          kind_text(result), mismatch.index, name_of(mismatch.of),
                          mismatch.recorded, mismatch.truth);
    }
  }
  return text;
}

nlohmann::json to_json(const std::vector<CertifyResult>& results) {
  nlohmann::json json = counts(total(results));
  json["mismatches"] = nlohmann::json::array();
  json["files"] = nlohmann::json::array();
  for (const CertifyResult& result : results) {
    nlohmann::json file = counts(result);
    file["file"] = result.name;
    file["kind"] = kind_text(result);
    if (result.error) file["error"] = *result.error;
    json["files"].push_back(std::move(file));
    for (const Mismatch& mismatch : result.mismatches) {
      json["mismatches"].push_back({{"file", result.name},
                                    {"index", mismatch.index},
                                    {"kind", kind_text(result)},
                                    {"of", name_of(mismatch.of)},
                                    {"recorded", mismatch.recorded},
                                    {"truth", mismatch.truth}});
    }
  }
  return json;
}

std::string truth_header() { return "file,index,kind,collides,toi_lower,toi_upper\n"; }

std::string truth_row(const std::string& file, Kind kind, const Truth& truth) {
  const std::string toi =
      truth.toi ? fmt::format("{},{}", truth.toi->lower, truth.toi->upper) : std::string(",");
  return fmt::format("{},{},{},{:d},{}\n", csv_field(file), truth.index, to_string(kind),
                     truth.collides, toi);
}

}  // namespace touchstone::verify
