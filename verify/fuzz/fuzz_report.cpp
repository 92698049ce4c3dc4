#include "verify/fuzz/fuzz_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "verify/methods/answers.hpp"
#include "verify/methods/registry.hpp"
#include "verify/separation.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format = "{:<17}  {:>10}  {:>10}  {:>10}  {:>8}\n";

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json coordinates_of(const Query& query) {
  nlohmann::json list = nlohmann::json::array();
  for (const double x : query.coordinates) list.push_back(fmt::format("{:a}", x));
  return list;
}

std::string generator_table(const FuzzResult& result) {
  std::string text = fmt::format(fmt::runtime(row_format), "generator", "queries", "collisions",
                                 "signatures", "findings");
  for (const GeneratorStatistics& generator : result.generators) {
    text += fmt::format(fmt::runtime(row_format), generator.name, generator.queries,
                        generator.collisions, generator.signatures, generator.findings);
  }
  return text;
}

}  // namespace

std::string to_text(const Finding& finding) {
  std::string about(to_string(finding.kind));
  if (!is_contact(finding.separation)) {
    about += " at minimum separation " + to_text(finding.separation);
  }
  return fmt::format("{} of {}, {} ({}, after {:.2f} s and {} queries)\n  {}\n  truth: {}\n",
                     to_string(finding.what), finding.method, about, finding.generator,
                     finding.seconds, finding.queries, finding.detail, finding.truth);
}

std::string to_text(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  std::string text = fmt::format(
      "{} ({}), seed {}{}: {} queries in {:.1f} s, {} of them images, {} collisions\n"
      "{:.0f} queries a second, {:.0f} without the method's own time; {} judged by the oracle\n\n",
      report.method, to_string(report.promise), report.seed,
      is_contact(report.separation) ? "" : ", minimum separation " + to_text(report.separation),
      result.queries, result.seconds, result.images, result.collisions, result.queries_per_second(),
      result.judged_per_second(), result.judged_by_oracle);
  text += generator_table(result);
  text += result.all_findings == 0 ? "\nno findings\n"
                                   : fmt::format("\n{} findings, {} with all that are like them\n",
                                                 result.findings.size(), result.all_findings);
  return text;
}

nlohmann::json to_json(const Finding& finding) {
  return {{"what", to_string(finding.what)},
          {"kind", to_string(finding.kind)},
          {"separation", to_json(finding.separation)},
          {"method", finding.method},
          {"collides", finding.collides},
          {"truth", finding.truth},
          {"detail", finding.detail},
          {"answer",
           {{"verdict", to_string(finding.answer.verdict)},
            {"toi_lower", number_or_null(finding.answer.toi_lower)},
            {"toi_upper", number_or_null(finding.answer.toi_upper)},
            {"tolerance", number_or_null(finding.answer.tolerance)}}},
          {"generator", finding.generator},
          {"seconds", finding.seconds},
          {"queries", finding.queries},
          {"coordinates", coordinates_of(finding.query)},
          {"certificate", finding.certificate}};
}

nlohmann::json to_json(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  nlohmann::json generators = nlohmann::json::array();
  for (const GeneratorStatistics& generator : result.generators) {
    generators.push_back({{"name", generator.name},
                          {"queries", generator.queries},
                          {"collisions", generator.collisions},
                          {"signatures", generator.signatures},
                          {"findings", generator.findings}});
  }
  nlohmann::json findings = nlohmann::json::array();
  for (const Finding& finding : result.findings) findings.push_back(to_json(finding));
  return {{"method", report.method},
          {"promise", to_string(report.promise)},
          {"seed", report.seed},
          {"separation", to_json(report.separation)},
          {"queries", result.queries},
          {"images", result.images},
          {"collisions", result.collisions},
          {"judged_by_oracle", result.judged_by_oracle},
          {"seconds", result.seconds},
          {"method_seconds", result.method_seconds},
          {"other_seconds", result.other_seconds},
          {"queries_per_second", result.queries_per_second()},
          {"judged_per_second", result.judged_per_second()},
          {"all_findings", result.all_findings},
          {"unplaced_crashes", result.unplaced_crashes},
          {"interrupted", result.interrupted},
          {"generators", generators},
          {"findings", findings}};
}

}  // namespace touchstone::verify
