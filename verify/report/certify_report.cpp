#include "verify/report/certify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "verify/io/csv.hpp"
#include "verify/io/printable.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format =
    "{:<{}}  {:<11}  {:>9}  {:>10}  {:>9}  {:>11}  {:>9}  {:>10}  {:>8}\n";

constexpr std::string_view method_row_format =
    "{:<{}}  {:<11}  {:>9}  {:>9}  {:>9}  {:>8}  {:>11}  {:>9}  {:>7}  {:>10}  {:>9}  {:>9}  "
    "{:>9}\n";

/// Of a source and fault so many answers are printed.
constexpr std::size_t most_printed = 20;

std::string_view kind_text(const CertifyResult& result) {
  return result.kind ? to_string(*result.kind) : "";
}

void append_row(std::string& text, std::size_t width, const CertifyResult& result) {
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), printable(result.name), width,
                 kind_text(result), result.queries, result.collisions, result.labels,
                 result.label_mismatches, result.tois, result.toi_mismatches,
                 fmt::format("{:.2f}", result.microseconds_per_query()));
}

std::string_view name_of(Mismatch::Of of) { return of == Mismatch::Of::label ? "label" : "toi"; }

bool has_separation(const std::vector<CertifyResult>& results) {
  return !std::ranges::all_of(
      results, [](const CertifyResult& result) { return is_contact(result.separation); });
}

/// The separation of all sources, if it is one, and more than contact.
std::optional<Separation> separation_of(const std::vector<CertifyResult>& results) {
  std::vector<Separation> all;
  all.reserve(results.size());
  for (const CertifyResult& result : results) all.push_back(result.separation);
  return common_separation(all);
}

std::string_view name_of(Inference inference) {
  if (inference == Inference::all) return "all";
  return inference == Inference::collisions ? "collisions" : "nothing";
}

/// What the numbers below are about.
void append_separations(std::string& text, const std::vector<CertifyResult>& results) {
  if (!has_separation(results)) return;
  if (const auto separation = separation_of(results)) {
    text += fmt::format("minimum separation {}\n", to_text(*separation));
  } else {
    for (const CertifyResult& result : results) {
      text += fmt::format("minimum separation {}: {}\n", to_text(result.separation),
                          printable(result.name));
    }
  }
  const auto compares_collisions = [](const CertifyResult& result) {
    return result.compared == Inference::collisions;
  };
  if (std::ranges::any_of(results, compares_collisions)) {
    text +=
        "recorded answers are about less separation: only their collisions are compared, which "
        "must "
        "collide, no later\n";
  }
}

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

std::string error_text(double error) {
  return std::isnan(error) ? "-" : fmt::format("{:.2e}", error);
}

/// Does the table of methods have a column of tolerances? It has if there is a separation, or somebody
/// claims too much.
enum class Tolerances : std::uint8_t { hidden, shown };

void append_method_row(std::string& text, std::size_t width, const std::string& name,
                       std::string_view kind, const MethodResult& method, Tolerances tolerances) {
  const Judgement& judged = method.judgement;
  fmt::format_to(std::back_inserter(text), fmt::runtime(method_row_format), name, width, kind,
                 judged.queries, judged.count(Fault::false_negative),
                 judged.count(Fault::false_positive), judged.count(Fault::late_toi),
                 judged.count(Fault::early_toi_upper), judged.undecided, judged.count(Fault::error),
                 method.timed ? fmt::format("{:.1f}", judged.nanoseconds_per_query()) : "-",
                 error_text(judged.toi_errors.quantile(0.5)),
                 error_text(judged.toi_errors.quantile(0.99)), error_text(judged.toi_errors.max()));
  if (tolerances == Tolerances::hidden) return;
  text.pop_back();
  text += fmt::format("  {:>10}\n", judged.count(Fault::beyond_tolerance));
}

void append_wrong_answers(std::string& text, const CertifyResult& result,
                          const MethodResult& method) {
  std::array<std::uint64_t, fault_count> printed{};
  for (const WrongAnswer& wrong : method.judgement.wrong_answers) {
    auto& count = printed[static_cast<std::size_t>(wrong.fault)];
    if (!breaks(wrong.fault, method.promise) || count == most_printed) continue;
    ++count;
    text += fmt::format("{}: {}: {}: {} query {}: answer {}, truth {}\n", to_string(wrong.fault),
                        printable(method.name), printable(result.name), kind_text(result),
                        wrong.index, wrong.answer, wrong.truth);
  }
  for (std::size_t i = 0; i < fault_count; ++i) {
    if (printed[i] != most_printed || method.judgement.faults[i] == most_printed) continue;
    const auto fault = static_cast<Fault>(i);
    text += fmt::format("{}: {}: {}: and {} more\n", to_string(fault), printable(method.name),
                        printable(result.name), method.judgement.faults[i] - most_printed);
  }
}

/// How often it gave no answer, by kind, if that is for other reasons than its own indecision.
void append_failures(std::string& text, const MethodResult& method) {
  std::string kinds;
  bool is_only_undecided = true;
  for (const FailureKind kind : all_failure_kinds) {
    const std::uint64_t count = method.judgement.count(kind);
    if (count == 0) continue;
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count, to_string(kind));
    is_only_undecided = is_only_undecided && kind == FailureKind::undecided;
  }
  if (!is_only_undecided) text += fmt::format("no answer: {}: {}\n", method.name, kinds);
}

bool claims_too_much(const MethodResult& method) {
  return method.judgement.count(Fault::beyond_tolerance) != 0;
}

void append_methods(std::string& text, std::size_t width, const std::vector<CertifyResult>& results,
                    const CertifyResult& sum) {
  for (const MethodResult& method : sum.methods) {
    width = std::max(width, printable(method.name).size());
  }
  const bool shows_tolerances =
      has_separation(results) || std::ranges::any_of(sum.methods, claims_too_much);
  const Tolerances tolerances = shows_tolerances ? Tolerances::shown : Tolerances::hidden;
  width += 2;
  text += '\n';
  fmt::format_to(std::back_inserter(text), fmt::runtime(method_row_format), "method", width, "kind",
                 "queries", "false neg", "false pos", "late toi", "early upper", "undecided",
                 "errors", "ns/query", "error p50", "error p99", "error max");
  if (tolerances == Tolerances::shown) {
    text.pop_back();
    text += fmt::format("  {:>10}\n", "beyond tol");
  }
  std::string wrong_answers;
  for (std::size_t i = 0; i < sum.methods.size(); ++i) {
    append_method_row(text, width, printable(sum.methods[i].name), "", sum.methods[i], tolerances);
    for (const CertifyResult& result : results) {
      if (i >= result.methods.size()) continue;
      const MethodResult& method = result.methods[i];
      if (keeps(method.judgement, method.promise)) continue;
      append_method_row(text, width, "  " + printable(result.name), kind_text(result), method,
                        tolerances);
      append_wrong_answers(wrong_answers, result, method);
    }
  }
  for (const MethodResult& method : sum.methods) append_failures(text, method);
  text += wrong_answers;
}

nlohmann::json number_or_null(bool known, double number) {
  return known ? nlohmann::json(number) : nlohmann::json();
}

nlohmann::json to_json(const ToiErrors& errors) {
  if (errors.count() == 0) return {};
  return {{"count", errors.count()},
          {"p50", errors.quantile(0.5)},
          {"p90", errors.quantile(0.9)},
          {"p99", errors.quantile(0.99)},
          {"max", errors.max()}};
}

nlohmann::json failures_of(const Judgement& judged) {
  nlohmann::json json = nlohmann::json::object();
  for (const FailureKind kind : all_failure_kinds) json[to_string(kind)] = judged.count(kind);
  return json;
}

nlohmann::json counts(const MethodResult& method) {
  const Judgement& judged = method.judgement;
  const bool has_time = method.timed && judged.queries != 0;
  return {{"name", method.name},
          {"promise", to_string(method.promise)},
          {"queries", judged.queries},
          {"false_negatives", judged.count(Fault::false_negative)},
          {"false_positives", judged.count(Fault::false_positive)},
          {"late_toi", judged.count(Fault::late_toi)},
          {"early_toi_upper", judged.count(Fault::early_toi_upper)},
          {"undecided", judged.undecided},
          {"errors", judged.count(Fault::error)},
          {"failures", failures_of(judged)},
          {"unplaced_crashes", judged.unplaced_crashes},
          {"beyond_tolerance", judged.count(Fault::beyond_tolerance)},
          {"missing", judged.missing},
          {"ns_per_query", number_or_null(has_time, judged.nanoseconds_per_query())},
          {"toi_error", to_json(judged.toi_errors)}};
}

nlohmann::json methods_of(const CertifyResult& result) {
  nlohmann::json json = nlohmann::json::array();
  for (const MethodResult& method : result.methods) json.push_back(counts(method));
  return json;
}

void append_wrong_answers(nlohmann::json& methods, const CertifyResult& result) {
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    for (const WrongAnswer& wrong : result.methods[i].judgement.wrong_answers) {
      methods[i]["wrong_answers"].push_back({{"file", result.name},
                                             {"index", wrong.index},
                                             {"kind", kind_text(result)},
                                             {"fault", to_string(wrong.fault)},
                                             {"answer", wrong.answer},
                                             {"truth", wrong.truth}});
    }
  }
}

}  // namespace

std::string to_text(const std::vector<CertifyResult>& results) {
  std::size_t width = 5;
  for (const CertifyResult& result : results)
    width = std::max(width, printable(result.name).size());

  std::string text;
  append_separations(text, results);
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
      text += fmt::format("mismatch: {}: {} query {}: recorded {} {}, truth {}\n",
                          printable(result.name), kind_text(result), mismatch.index,
                          name_of(mismatch.of), mismatch.recorded, mismatch.truth);
    }
  }
  if (!sum.methods.empty()) append_methods(text, width, results, sum);
  return text;
}

nlohmann::json to_json(const std::vector<CertifyResult>& results) {
  const CertifyResult sum = total(results);
  nlohmann::json json = counts(sum);
  if (const auto separation = separation_of(results)) json["separation"] = to_json(*separation);
  json["methods"] = methods_of(sum);
  if (sum.proofs.certificates() != 0) json["proofs"] = to_json(sum.proofs);
  for (nlohmann::json& method : json["methods"]) method["wrong_answers"] = nlohmann::json::array();
  json["mismatches"] = nlohmann::json::array();
  json["files"] = nlohmann::json::array();
  for (const CertifyResult& result : results) {
    nlohmann::json file = counts(result);
    file["file"] = result.name;
    file["kind"] = kind_text(result);
    if (!is_contact(result.separation)) {
      file["separation"] = to_json(result.separation);
      file["compared"] = name_of(result.compared);
    }
    file["methods"] = methods_of(result);
    if (result.error) file["error"] = *result.error;
    json["files"].push_back(std::move(file));
    append_wrong_answers(json["methods"], result);
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
