#include "verify/fuzz/fuzz_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "verify/data/csv_dataset.hpp"
#include "verify/fuzz/recheck.hpp"
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

/// Adds the numbers of a query in the form that to_json describes.
void add_numbers(const base::AnyQuery& query, nlohmann::json& json) {
  const AnyShape& shape = query.shape();
  json["degree"] = shape.degree;
  json["rational"] = shape.is_rational;
  json["numbers"] = query.numbers();
  if (shape.is_straight()) {
    json["coordinates"] = texts_of(query.numbers());
    return;
  }
  const std::size_t size = shape.numbers_of_point();
  for (std::size_t i = 0; i < query.numbers().size() / size; ++i) {
    const auto point = query.numbers().subspan(size * i, size);
    json["control"][i / moving_points].push_back(texts_of(point.first(3)));
    if (shape.is_rational) json["weights"][i / moving_points].push_back(texts_of(point)[3]);
  }
}

// ---- Asking again -------------------------------------------------------------------------------

/// The solver that is wrong: the one asked, or the judge.
SolverCall wrong_solver(const Finding& finding, const SolverCall& asked) {
  SolverCall result = asked;
  if (finding.method == asked.method) return result;
  result.method = finding.method;
  result.plugin.clear();
  result.terms = {};
  result.promise = fast::Promise::exact;
  return result;
}

/// The options of the command line with which the solver was asked.
std::string options_as_words(const SolverCall& solver) {
  const fast::MethodOptions& options = solver.options;
  const bool is_plugin = !solver.plugin.empty();
  std::string words = is_plugin ? "--plugin " + io::shell_word(solver.plugin.string())
                                : "--method " + solver.method;
  words += fmt::format(" --tolerance {} --max-checks {} --min-separation {} --norm {}",
                       options.tolerance, std::max<std::int64_t>(options.max_checks, 0),
                       options.separation.distance, to_string(options.separation.norm));
  words += fmt::format(" --query-limit {}", solver.query_limit_seconds);
  if (solver.limits.memory_bytes != solvers::ChildLimits{}.memory_bytes) {
    const auto bytes = static_cast<double>(solver.limits.memory_bytes);
    words += fmt::format(" --memory-limit {}", bytes / 0x1p30);
  }
  if (solver.limits.may_fork) words += " --allow-processes";
  if (is_plugin) words += judge::as_options(solver.terms);
  return solver.promise == fast::Promise::exact ? words + " --exact" : words;
}

/// Commands for a POSIX shell that write the simplest query as a dataset and ask the solver again,
/// with the same options; `touchstone certify` then judges it.
std::string command(const Finding& finding, const SolverCall& solver) {
  const FailingCase& failing = finding.simplest;
  const Separation& separation = solver.options.separation;
  const std::string file = fmt::format("finding-{}.csv", to_string(failing.query.kind()));
  // Without more, a label is about contact itself.
  std::optional<bool> label;
  if (is_zero(separation)) label = failing.collides;
  return fmt::format("cat > {0} <<'END'\n{1}END\ntouchstone certify {0} {2}\n", file,
                     data::csv_rows(failing.query, label), options_as_words(solver));
}

// ---- As text ------------------------------------------------------------------------------------

/// A remark where the simplest query may not be the simplest there is.
std::string_view shrinking_text(Shrinking shrinking) {
  switch (shrinking) {
    case Shrinking::cut_short:
      return "  (the time ended before its query was fully simplified)\n";
    case Shrinking::not_reproduced:
      return "  (asked alone, the solver is right)\n";
    default:
      return "";
  }
}

std::string group_table(const FuzzResult& result) {
  io::TextTable table({{"group", 5},
                       io::word_column("finding", 17),
                       {"count", 6},
                       io::word_column("kind", 11),
                       io::word_column("shape", 9),
                       {"first after queries", 8}});
  for (std::size_t i = 0; i < result.groups.size(); ++i) {
    const FindingGroup& group = result.groups[i];
    const Signature signature = signature_of(result.findings.at(group.best));
    const auto first = std::ranges::find(result.findings, i, &Finding::group);
    table.add({std::to_string(i + 1),
               (signature.is_slight ? "slightly " : "") + std::string(to_string(signature.what)),
               std::to_string(group.count), std::string(to_string(signature.kind)),
               std::string(to_string(signature.shape)), std::to_string(first->queries)});
  }
  return table.text();
}

std::string example_text(std::size_t number, const Finding& finding) {
  std::string text = fmt::format("\ngroup {}: {}\n  truth: {}\n", number, to_line(finding),
                                 finding.simplest.truth);
  text += shrinking_text(finding.shrinking);
  return text + as_points(finding.simplest.query);
}

std::string findings_text(const FuzzResult& result) {
  if (result.all_findings == 0) return "\nno findings\n";
  std::string text = fmt::format("\n{} findings, in {} groups\n\n{}", result.all_findings,
                                 result.groups.size(), group_table(result));
  for (std::size_t i = 0; i < result.groups.size(); ++i) {
    text += example_text(i + 1, result.findings.at(result.groups[i].best));
  }
  return text;
}

/// The reason for an early end of the run.
std::string end_text(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  std::string text;
  if (result.ended_by == FuzzEnd::time && report.queries != 0) {
    text += fmt::format("\nended by the time limit: {} of {} queries judged in {} s\n",
                        result.queries, report.queries, report.seconds);
  }
  if (result.ended_by != FuzzEnd::findings && result.unjudged != 0) {
    text +=
        fmt::format("\n{} further queries were answered too late to be judged\n", result.unjudged);
  }
  if (result.unanswered != 0) {
    text += fmt::format("\n{} further queries were not answered in time\n", result.unanswered);
  }
  return text;
}

// ---- As JSON ------------------------------------------------------------------------------------

nlohmann::json group_json(const FuzzResult& result, const FindingGroup& group) {
  const Signature signature = signature_of(result.findings.at(group.best));
  return {{"what", to_string(signature.what)},
          {"is_slight", signature.is_slight},
          {"method", signature.method},
          {"count", group.count},
          {"best", group.best},
          {"kind", to_string(signature.kind)},
          {"shape", to_string(signature.shape)}};
}

nlohmann::json answer_json(const fast::Answer& answer) {
  return {{"verdict", judge::to_string(answer.verdict)},
          {"toi_lower", io::number_to_json(answer.toi_lower)},
          {"toi_upper", io::number_to_json(answer.toi_upper)},
          {"tolerance", io::number_to_json(answer.tolerance)}};
}

nlohmann::json case_json(const FailingCase& failing) {
  nlohmann::json toi;
  if (failing.toi) toi = {{"lower", failing.toi->lower}, {"upper", failing.toi->upper}};
  nlohmann::json json{{"answer", answer_json(failing.answer)},
                      {"collides", failing.collides},
                      {"toi", toi},
                      {"truth", failing.truth},
                      {"detail", failing.detail},
                      {"certificate", io::text_or_null(failing.certificate)}};
  add_numbers(failing.query, json);
  return json;
}

nlohmann::json solver_json(const SolverCall& solver) {
  const bool are_estimates = solver.terms.times == fast::Times::estimates;
  return {
      {"method", solver.method},
      {"plugin", io::text_or_null(solver.plugin.string())},
      {"promise", solvers::to_string(solver.promise)},
      {"terms", judge::as_options(solver.terms)},
      {"time_error", are_estimates ? nlohmann::json(solver.terms.time_error) : nlohmann::json()},
      {"tolerance", solver.options.tolerance},
      {"max_checks", solver.options.max_checks},
      {"min_separation", solver.options.separation.distance},
      {"norm", to_string(solver.options.separation.norm)},
      {"t_max", solver.options.t_max},
      {"query_limit", solver.query_limit_seconds},
      {"memory_limit", solver.limits.memory_bytes},
      {"allow_processes", solver.limits.may_fork}};
}

nlohmann::json finding_json(const Finding& finding, const SolverCall& asked) {
  const SolverCall solver = wrong_solver(finding, asked);
  nlohmann::json json = case_json(finding.simplest);
  json.update({{"what", to_string(finding.what)},
               {"kind", to_string(finding.kind())},
               {"separation", judge::to_json(finding.separation)},
               {"method", finding.method},
               {"generator", finding.generator},
               {"seconds", finding.seconds},
               {"queries", finding.queries},
               {"shrinking", to_string(finding.shrinking)},
               {"group", finding.group},
               {"original", case_json(finding.original)},
               {"solver", solver_json(solver)},
               {"command", command(finding, solver)}});
  return json;
}

}  // namespace

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
  const bool are_lines = report.degrees == std::vector<std::string>{"1"};
  std::string text = fmt::format(
      "{} ({}{}), seed {}{}{}: {} queries in {:.1f} s, {} of them images, {} collisions\n"
      "{:.0f} queries a second, {:.0f} without the method's own time; {} judged by the oracle\n",
      report.solver.method, solvers::to_string(report.solver.promise),
      judge::to_text(report.solver.terms), report.seed,
      are_lines ? "" : fmt::format(", degree {}", fmt::join(report.degrees, " ")),
      is_zero(separation) ? "" : ", minimum separation " + judge::to_text(separation),
      result.queries, result.seconds, result.images, result.collisions, result.queries_per_second(),
      result.judged_per_second(), result.judged_by_oracle);
  text += end_text(report);
  text += findings_text(result);
  if (result.outside != 0) {
    text += fmt::format("{} queries outside its terms{}: not asked\n", result.outside,
                        judge::to_text(report.solver.terms));
  }
  if (result.left_out != 0) {
    text += fmt::format(
        "{} queries not asked, of generators whose queries hang; the limit of a query ended at "
        "{} s\n",
        result.left_out, result.query_limit_seconds);
  }
  if (result.other_findings != 0) {
    text += fmt::format("{} findings of other kinds\n", result.other_findings);
  }
  return text;
}

nlohmann::json to_json(const FuzzReport& report) {
  const FuzzResult& result = report.result;
  nlohmann::json generators = nlohmann::json::array();
  for (const GeneratorStatistics& generator : result.generators) {
    generators.push_back({{"name", generator.name},
                          {"queries", generator.queries},
                          {"collisions", generator.collisions},
                          {"findings", generator.findings}});
  }
  nlohmann::json findings = nlohmann::json::array(), only = nlohmann::json::array();
  for (const judge::Fault kind : report.only) only.push_back(to_string(kind));
  for (const Finding& finding : result.findings) {
    findings.push_back(finding_json(finding, report.solver));
  }
  nlohmann::json groups = nlohmann::json::array();
  for (const FindingGroup& group : result.groups) groups.push_back(group_json(result, group));
  return {{"solver", solver_json(report.solver)},
          {"method", report.solver.method},
          {"promise", solvers::to_string(report.solver.promise)},
          {"seed", report.seed},
          {"separation", judge::to_json(report.solver.options.separation)},
          {"asked",
           {{"seconds", report.seconds > 0.0 ? nlohmann::json(report.seconds) : nlohmann::json()},
            {"queries", report.queries != 0 ? nlohmann::json(report.queries) : nlohmann::json()},
            {"only", only},
            {"degrees", report.degrees}}},
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
}

}  // namespace touchstone::verify::fuzz
