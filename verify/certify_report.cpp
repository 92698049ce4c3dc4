#include "verify/certify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format =
    "{:<{}}  {:<11}  {:>9}  {:>10}  {:>9}  {:>10}  {:>9}  {:>10}  {:>8}\n";

void append_row(std::string& text, std::size_t width, const CertifyResult& result,
                std::string_view kind) {
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), result.name, width, kind,
                 result.queries, result.collisions, result.labels, result.label_mismatches,
                 result.tois, result.toi_mismatches,
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
                 "queries", "collisions", "labels", "mismatches", "tois", "mismatches", "µs/query");
  for (const CertifyResult& result : results)
    append_row(text, width, result, to_string(result.kind));
  const CertifyResult sum = total(results);
  append_row(text, width, sum, "");
  if (sum.skipped != 0) text += fmt::format("{} queries in error skipped\n", sum.skipped);
  if (sum.rounded != 0) text += fmt::format("{} coordinates rounded to double\n", sum.rounded);

  for (const CertifyResult& result : results) {
    for (const Mismatch& mismatch : result.mismatches) {
      text += fmt::format("mismatch: {}: {} query {}: recorded {} {}, truth {}\n", result.name,
                          to_string(result.kind), mismatch.index, name_of(mismatch.of),
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
    file["kind"] = to_string(result.kind);
    if (result.error) file["error"] = *result.error;
    json["files"].push_back(std::move(file));
    for (const Mismatch& mismatch : result.mismatches) {
      json["mismatches"].push_back({{"file", result.name},
                                    {"index", mismatch.index},
                                    {"kind", to_string(result.kind)},
                                    {"of", name_of(mismatch.of)},
                                    {"recorded", mismatch.recorded},
                                    {"truth", mismatch.truth}});
    }
  }
  return json;
}

TruthWriter::TruthWriter(std::ostream& out) : out_(out) {
  out_ << "file,index,kind,collides,toi_lower,toi_upper\n";
}

void TruthWriter::write(const std::string& file, Kind kind, const Truth& truth) {
  const auto end = [](const std::optional<exact::DoubleInterval>& toi, double value) {
    return toi ? fmt::format("{}", value) : std::string();
  };
  const exact::DoubleInterval toi = truth.toi.value_or(exact::DoubleInterval{0.0, 0.0});
  out_ << fmt::format("{},{},{},{:d},{},{}\n", csv_field(file), truth.index, to_string(kind),
                      truth.collides, end(truth.toi, toi.lower), end(truth.toi, toi.upper));
}

}  // namespace touchstone::verify
