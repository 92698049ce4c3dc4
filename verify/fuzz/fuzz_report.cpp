#include "verify/fuzz/fuzz_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "verify/fuzz/diagnosis.hpp"
#include "verify/fuzz/signature.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::fuzz {
namespace {

nlohmann::json texts_of(std::span<const double> numbers) {
  nlohmann::json list = nlohmann::json::array();
  for (const double x : numbers) list.push_back(fmt::format("{:a}", x));
  return list;
}

/// Adds `coordinates` of a query on straight lines, and of one on curves what to_json says.
void add_numbers(const AnyQuery& query, nlohmann::json& json) {
  const QueryShape& shape = query.shape();
  if (shape.is_straight()) {
    json["coordinates"] = texts_of(query.numbers());
    return;
  }
  json["degree"] = shape.degree;
  json["rational"] = shape.is_rational;
  json["numbers"] = query.numbers();
  nlohmann::json control = nlohmann::json::array(), weights = nlohmann::json::array();
  const std::size_t size = shape.numbers_of_point();
  for (std::size_t i = 0; i < query.numbers().size() / size; ++i) {
    const auto point = query.numbers().subspan(size * i, size);
    if (i % moving_points == 0) {
      control.push_back(nlohmann::json::array());
      weights.push_back(nlohmann::json::array());
    }
    control.back().push_back(texts_of(point.first(3)));
    if (shape.is_rational) weights.back().push_back(fmt::format("{:a}", point[3]));
  }
  json["control"] = control;
  if (shape.is_rational) json["weights"] = weights;
}

/// Whether the simplest query is the simplest there is, where that needs to be said.
std::string_view shrinking_text(Shrinking shrinking) {
  switch (shrinking) {
    case Shrinking::cut_short:
      return "  (the time was over before it was made simpler, or as simple as it goes)\n";
    case Shrinking::not_reproduced:
      return "  (asked alone, it is not wrong)\n";
    default:
      return "";
  }
}

std::string kind_text(const std::optional<Kind>& kind) {
  return kind ? std::string(to_string(*kind)) : "any";
}

std::string group_table(const FuzzResult& result) {
  io::TextTable table({{"group", 5},
                       io::word_column("finding", 17),
                       {"count", 6},
                       io::word_column("scale", 9),
                       io::word_column("kind", 11),
                       io::word_column("shape", 9),
                       io::word_column("contact", 7),
                       {"first after queries", 8}});
  for (std::size_t i = 0; i < result.groups.size(); ++i) {
    const FindingGroup& group = result.groups[i];
    const Signature signature = signature_of(result.findings.at(group.best));
    const auto first = std::ranges::find(result.findings, i, &Finding::group);
    table.add({std::to_string(i + 1),
               (signature.is_slight ? "slightly " : "") + std::string(to_string(signature.what)),
               std::to_string(group.count), to_text(signature.ends), kind_text(signature.kind),
               to_text(signature.shape), to_text(signature.time), std::to_string(first->queries)});
  }
  return table.text();
}

std::string example_text(std::size_t number, const Finding& finding, const SolverCall& asked) {
  std::string text = fmt::format("\ngroup {}: {}\n  truth: {}\n  {}\n", number, to_line(finding),
                                 finding.simplest.truth, scale_text(finding, asked));
  text += shrinking_text(finding.shrinking);
  return text + as_short_points(finding.simplest.query);
}

std::string findings_text(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  if (result.all_findings == 0) return "\nno findings\n";
  std::string text =
      fmt::format("\n{} findings, in {} groups by what can be told of their cause\n\n{}",
                  result.all_findings, result.groups.size(), group_table(result));
  for (std::size_t i = 0; i < result.groups.size(); ++i) {
    text += example_text(i + 1, result.findings.at(result.groups[i].best), report.solver);
  }
  return text;
}

/// Why the run ended, if it ended before all was done that was asked for.
std::string end_text(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  std::string text;
  if (result.ended_by == FuzzEnd::time && report.queries != 0) {
    text += fmt::format("\nended by the time: {} of {} queries judged in {} s\n", result.queries,
                        report.queries, report.seconds);
  }
  if (result.ended_by != FuzzEnd::findings && result.unjudged != 0) {
    text +=
        fmt::format("\n{} queries more were answered, too late to be judged\n", result.unjudged);
  }
  if (result.unanswered != 0) {
    text +=
        fmt::format("\n{} queries more were asked, and not answered in time\n", result.unanswered);
  }
  return text;
}

nlohmann::json number_or_null(const std::optional<int>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json group_json(const FuzzResult& result, const FindingGroup& group) {
  const Signature signature = signature_of(result.findings.at(group.best));
  return {{"what", to_string(signature.what)},
          {"is_slight", signature.is_slight},
          {"method", signature.method},
          {"count", group.count},
          {"best", group.best},
          {"scale", to_text(signature.ends)},
          {"kind", signature.kind ? nlohmann::json(to_string(*signature.kind)) : nlohmann::json()},
          {"shape", to_text(signature.shape)},
          {"time", to_text(signature.time)}};
}

nlohmann::json answer_json(const fast::Answer& answer) {
  return {{"verdict", judge::to_string(answer.verdict)},
          {"toi_lower", io::number_to_json(answer.toi_lower)},
          {"toi_upper", io::number_to_json(answer.toi_upper)},
          {"tolerance", io::number_to_json(answer.tolerance)}};
}

nlohmann::json case_json(const FailingCase& failing) {
  nlohmann::json json{{"answer", answer_json(failing.answer)},
                      {"collides", failing.collides},
                      {"truth", failing.truth},
                      {"detail", failing.detail},
                      {"certificate", io::text_or_null(failing.certificate)}};
  add_numbers(failing.query, json);
  return json;
}

nlohmann::json solver_json(const SolverCall& solver) {
  return {{"method", solver.method},
          {"plugin", io::text_or_null(solver.plugin.string())},
          {"promise", solvers::to_string(solver.promise)},
          {"terms", judge::as_options(solver.terms)},
          {"tolerance", solver.options.tolerance},
          {"max_checks", solver.options.max_checks},
          {"min_separation", solver.options.separation.distance},
          {"norm", to_string(solver.options.separation.norm)},
          {"t_max", solver.options.t_max},
          {"query_limit", solver.query_limit_seconds},
          {"memory_limit", solver.limits.memory_bytes},
          {"allow_processes", solver.limits.may_fork}};
}

}  // namespace

std::string scale_text(const Finding& finding, const SolverCall& asked) {
  const auto& [below, above] = finding.scales;
  if (!below && !above) {
    const bool is_asked = finding.what != judge::Fault::hang && is_zero(finding.separation) &&
                          finding.shrinking == Shrinking::complete;
    if (!is_asked) return "not asked at other scales";
    return fmt::format("wrong at any scale from 2^{} to 2^{}", least_scale(asked.options.tolerance),
                       greatest_scale);
  }
  std::string text = "wrong while the greatest coordinate is";
  if (below) text += fmt::format(" above 2^{}", *below + 1);
  if (above) text += fmt::format("{} below 2^{}", below ? " and" : "", *above);
  return text;
}

std::string to_line(const Finding& finding) {
  std::string about = to_text(finding.simplest.query.shape());
  if (!is_zero(finding.separation)) {
    about += " at minimum separation " + judge::to_text(finding.separation);
  }
  return fmt::format("{} of {}, {}: {}", to_string(finding.what), io::printable(finding.method),
                     about, finding.simplest.detail);
}

std::string to_text(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  const Separation separation = report.solver.options.separation;
  std::string text = fmt::format(
      "{} ({}{}), seed {}{}{}: {} queries in {:.1f} s, {} of them images, {} collisions\n"
      "{:.0f} queries a second, {:.0f} without the method's own time; {} judged by the oracle\n",
      report.solver.method, solvers::to_string(report.solver.promise),
      judge::to_text(report.solver.terms), report.seed,
      report.degrees.empty() ? "" : fmt::format(", degree {}", fmt::join(report.degrees, " ")),
      is_zero(separation) ? "" : ", minimum separation " + judge::to_text(separation),
      result.queries, result.seconds, result.images, result.collisions, result.queries_per_second(),
      result.judged_per_second(), result.judged_by_oracle);
  text += end_text(report);
  text += findings_text(report);
  if (result.outside != 0) {
    text += fmt::format("{} queries outside its terms{}: not asked\n", result.outside,
                        judge::to_text(report.solver.terms));
  }
  if (result.left_out != 0) {
    text += fmt::format(
        "{} queries of generators at whose queries it hangs: not asked; at last a query might "
        "take {} s\n",
        result.left_out, result.query_limit_seconds);
  }
  if (result.other_findings != 0) {
    text += fmt::format("{} of kinds that were not sought\n", result.other_findings);
  }
  return text;
}

nlohmann::json to_json(const Finding& finding, const SolverCall& asked) {
  const Reproduction reproduction = reproduction_of(finding, asked);
  nlohmann::json json = case_json(finding.simplest);
  // Names of earlier versions.
  if (!finding.original.query.shape().is_straight())
    json.update(answer_json(finding.simplest.answer));
  json.update({{"what", to_string(finding.what)},
               {"kind", to_string(finding.kind())},
               {"separation", judge::to_json(finding.separation)},
               {"method", finding.method},
               {"generator", finding.generator},
               {"seconds", finding.seconds},
               {"queries", finding.queries},
               {"shrinking", to_string(finding.shrinking)},
               {"group", finding.group},
               {"wrong_until",
                {{"below", number_or_null(finding.scales.end_below)},
                 {"above", number_or_null(finding.scales.end_above)}}},
               {"original", case_json(finding.original)},
               {"solver", solver_json(reproduction.solver)},
               {"command", as_command(reproduction)}});
  return json;
}

nlohmann::json to_json(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  nlohmann::json generators = nlohmann::json::array();
  for (const GeneratorStatistics& generator : result.generators) {
    generators.push_back({{"name", generator.name},
                          {"queries", generator.queries},
                          {"collisions", generator.collisions},
                          {"coverage_keys", generator.coverage_keys},
                          {"findings", generator.findings}});
  }
  nlohmann::json findings = nlohmann::json::array(), only = nlohmann::json::array();
  for (const judge::Fault kind : report.only) only.push_back(to_string(kind));
  for (const Finding& finding : result.findings) {
    findings.push_back(to_json(finding, report.solver));
  }
  nlohmann::json groups = nlohmann::json::array();
  for (const FindingGroup& group : result.groups) groups.push_back(group_json(result, group));
  nlohmann::json json{
      {"solver", solver_json(report.solver)},
      {"method", report.solver.method},
      {"promise", solvers::to_string(report.solver.promise)},
      {"seed", report.seed},
      {"separation", judge::to_json(report.solver.options.separation)},
      {"asked",
       {{"seconds", report.seconds > 0.0 ? nlohmann::json(report.seconds) : nlohmann::json()},
        {"queries", report.queries != 0 ? nlohmann::json(report.queries) : nlohmann::json()},
        {"only", only}}},
      {"ended_by", to_string(result.ended_by)},
      {"queries", result.queries},
      {"unjudged", result.unjudged},
      {"unanswered", result.unanswered},
      {"outside", result.outside},
      {"left_out", result.left_out},
      {"images", result.images},
      {"collisions", result.collisions},
      {"judged_by_oracle", result.judged_by_oracle},
      {"seconds", result.seconds},
      {"method_seconds", result.method_seconds},
      {"shrink_seconds", result.shrink_seconds},
      {"other_seconds", result.other_seconds},
      {"queries_per_second", result.queries_per_second()},
      {"judged_per_second", result.judged_per_second()},
      {"all_findings", result.all_findings},
      {"other_findings", result.other_findings},
      {"unplaced_crashes", result.unplaced_crashes},
      {"interrupted", result.ended_by == FuzzEnd::interrupt},
      {"generators", generators},
      {"findings", findings},
      {"groups", groups}};
  if (!report.degrees.empty()) json["asked"]["degrees"] = report.degrees;
  return json;
}

}  // namespace touchstone::verify::fuzz
