#include "verify/report/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "verify/io/printable.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view row_format =
    "{:<{}}  {:>10}  {:>8}  {:>9}  {:>9}  {:>11}  {:>8}  {:>8}  {:>9}  {:>9}  {:>8}  {:>11}  "
    "{:>9}  {:>6}  {:>9}  {:>9}  {:>9}\n";

constexpr std::string_view step_row_format =
    "{:>7}  {:<9}  {:>11}  {:>10}  {:>10}  {:>13}  {:>15}\n";

/// Of a group, solver and fault so many answers are printed.
constexpr std::size_t most_printed = 20;

/// A number, or a dash where it is unknown.
std::string number_text(double number, std::string_view format) {
  return std::isnan(number) ? "-" : fmt::format(fmt::runtime(format), number);
}

double passes(const SolverResult& solver, const BenchResult& group) {
  return solver.times.median() / group.memory_pass.median();
}

// ---- Text ---------------------------------------------------------------------------------------

void append_header(std::string& text, std::size_t width) {
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), "method", width, "ns/query",
                 "passes", "p50", "p99", "max", "timed", "judged", "false neg", "false pos",
                 "late toi", "early upper", "undecided", "errors", "error p50", "error p99",
                 "error max");
}

void append_row(std::string& text, std::size_t width, const SolverResult& solver,
                const BenchResult& group) {
  const Judgement& judged = solver.judgement;
  const auto single = [&](double SingleTimes::*time) {
    return solver.singles ? fmt::format("{:.0f}", (*solver.singles).*time) : "-";
  };
  fmt::format_to(std::back_inserter(text), fmt::runtime(row_format), printable(solver.name), width,
                 number_text(solver.times.median(), "{:.1f}"),
                 number_text(passes(solver, group), "{:.2f}"), single(&SingleTimes::p50),
                 single(&SingleTimes::p99), single(&SingleTimes::max), solver.queries,
                 judged.queries, judged.count(Fault::false_negative),
                 judged.count(Fault::false_positive), judged.count(Fault::late_toi),
                 judged.count(Fault::early_toi_upper), judged.undecided, judged.count(Fault::error),
                 number_text(judged.toi_errors.quantile(0.5), "{:.2e}"),
                 number_text(judged.toi_errors.quantile(0.99), "{:.2e}"),
                 number_text(judged.toi_errors.max(), "{:.2e}"));
}

/// "  ended by: axis 78.12 %, …"
void append_stages(std::string& text, const SolverResult& solver) {
  if (solver.stages.empty() || solver.queries == 0) return;
  std::string_view separator = "  ended by: ";
  for (const StageCount& count : solver.stages) {
    const double share =
        100.0 * static_cast<double>(count.queries) / static_cast<double>(solver.queries);
    text += fmt::format("{}{} {:.4g} %", separator, count.stage, share);
    separator = ", ";
  }
  text += '\n';
}

void append_wrong_answers(std::string& text, const SolverResult& solver, const BenchResult& group) {
  if (!broke_promise(solver)) return;
  std::array<std::uint64_t, fault_count> printed{};
  for (std::size_t i = 0; i < solver.judgement.wrong_answers.size(); ++i) {
    const WrongAnswer& wrong = solver.judgement.wrong_answers[i];
    auto& count = printed[static_cast<std::size_t>(wrong.fault)];
    if (!breaks(wrong.fault, solver.promise) || count == most_printed) continue;
    ++count;
    const QueryPlace& place = solver.wrong_places[i];
    text += fmt::format("{}: {}: {}: {} query {}: answer {}, truth {}\n", to_string(wrong.fault),
                        printable(solver.name), printable(place.source), to_string(group.kind),
                        place.index, wrong.answer, wrong.truth);
  }
  for (std::size_t i = 0; i < fault_count; ++i) {
    const std::uint64_t all = solver.judgement.faults[i];
    if (printed[i] != most_printed || all == most_printed) continue;
    text += fmt::format("{}: {}: {}: and {} more\n", to_string(static_cast<Fault>(i)),
                        printable(solver.name), printable(group.name), all - most_printed);
  }
}

/// ", minimum separation 1e-08 (l2)"; nothing at distance 0.
std::string separation_text(const Separation& separation) {
  if (is_contact(separation)) return "";
  return ", minimum separation " + to_text(separation);
}

void append_group(std::string& text, const BenchResult& group) {
  const bool judged_all = group.judged == group.queries;
  text += fmt::format(
      "{}, {}{}: {} queries, {} collisions{}; memory pass {} ns/query{}\n", printable(group.name),
      to_string(group.kind), separation_text(group.separation), group.queries, group.collisions,
      judged_all ? "" : fmt::format(" among {} judged", group.judged),
      number_text(group.memory_pass.median(), "{:.2f}"), group.interrupted ? " (interrupted)" : "");
  std::size_t width = 6;
  for (const SolverResult& solver : group.solvers) {
    width = std::max(width, printable(solver.name).size());
  }
  append_header(text, width);
  for (const SolverResult& solver : group.solvers) {
    append_row(text, width, solver, group);
    append_stages(text, solver);
  }
  for (const SolverResult& solver : group.solvers) {
    append_wrong_answers(text, solver, group);
  }
  text += '\n';
}

/// One clock's times of a step.
void append_step_row(std::string& text, const StepTimes& times, std::string_view clock,
                     double StepTime::*time) {
  const auto milliseconds = [time](auto... parts) {
    return fmt::format("{:.1f} ms", 1e3 * (... + (parts.*time)));
  };
  fmt::format_to(std::back_inserter(text), fmt::runtime(step_row_format), times.threads, clock,
                 milliseconds(times.broad_phase), milliseconds(times.collisions),
                 milliseconds(times.earliest), milliseconds(times.broad_phase, times.collisions),
                 milliseconds(times.broad_phase, times.earliest));
}

void append_step(std::string& text, const StepResult& step) {
  text += fmt::format(
      "{}{}: {} vertices, {} edges, {} faces; vertex-face {} candidates, {} collisions; edge-edge "
      "{} "
      "candidates, {} collisions{}\n",
      printable(step.name), separation_text(step.separation), step.vertices, step.edges, step.faces,
      step.vertex_face.candidates, step.vertex_face.collisions, step.edge_edge.candidates,
      step.edge_edge.collisions, step.interrupted ? " (interrupted)" : "");
  if (step.earliest) {
    text += fmt::format("earliest impact between {} and {}{}\n", step.earliest->toi_lower,
                        step.earliest->toi_upper,
                        step.earliest_agrees ? "" : ": NOT that of the collisions");
  }
  fmt::format_to(std::back_inserter(text), fmt::runtime(step_row_format), "threads", "time",
                 "broad phase", "collisions", "earliest", "step, all", "step, earliest");
  for (const StepTimes& times : step.times) {
    append_step_row(text, times, "wall", &StepTime::wall);
    append_step_row(text, times, "processor", &StepTime::processor);
  }
  text += '\n';
}

std::string legend(const BenchReport& report) {
  std::string text = fmt::format(
      "ns/query: median of {} repetitions, processor time of one thread; passes: as a multiple of "
      "the memory pass,\n"
      "which only reads the queries. p50, p99, max: ns of single queries, one call each, the "
      "shortest of up to three,\n"
      "without the clock's own time. error: from toi_lower up to the exact time of impact.\n",
      report.options.repetitions);
  if (report.step) {
    text +=
        "The table of whole steps has medians of as many repetitions: wall is the time from "
        "beginning "
        "to end, processor\n"
        "that of all threads together, which the other tables have.\n";
  }
  const auto is_sampled = [](const BenchResult& group) {
    return std::ranges::any_of(
        group.solvers, [&](const SolverResult& solver) { return solver.queries < group.queries; });
  };
  if (std::ranges::any_of(report.groups, is_sampled)) {
    text += fmt::format(
        "timed: where not all, an evenly spread sample that takes about {} s a repetition.\n",
        report.options.seconds);
  }
  const auto is_judged_in_part = [](const BenchResult& group) {
    return group.judged < group.queries;
  };
  if (std::ranges::any_of(report.groups, is_judged_in_part)) {
    text += fmt::format(
        "judged: where not all, an evenly spread sample of {}, and what any method calls a "
        "collision: a false negative\n"
        "outside of the sample is known only where another method says so.\n",
        report.options.judge);
  }
  return text;
}

// ---- JSON ---------------------------------------------------------------------------------------

nlohmann::json number_or_null(double number) {
  return std::isnan(number) ? nlohmann::json() : nlohmann::json(number);
}

nlohmann::json json_of(const Times& times) {
  return {{"ns_per_query", number_or_null(times.median())},
          {"min_ns_per_query", number_or_null(times.min())},
          {"repetitions", times.repetitions}};
}

nlohmann::json json_of(const std::optional<SingleTimes>& singles) {
  if (!singles) return {};
  return {{"queries", singles->queries},
          {"p50_ns", singles->p50},
          {"p99_ns", singles->p99},
          {"max_ns", singles->max}};
}

nlohmann::json json_of(const std::vector<StageCount>& stages) {
  nlohmann::json json;
  for (const StageCount& count : stages) json[std::string(count.stage)] = count.queries;
  return json;
}

nlohmann::json json_of(const ToiErrors& errors) {
  if (errors.count() == 0) return {};
  return {{"count", errors.count()},
          {"p50", errors.quantile(0.5)},
          {"p99", errors.quantile(0.99)},
          {"max", errors.max()}};
}

nlohmann::json wrong_answers_of(const SolverResult& solver) {
  nlohmann::json json = nlohmann::json::array();
  for (std::size_t i = 0; i < solver.judgement.wrong_answers.size(); ++i) {
    const WrongAnswer& wrong = solver.judgement.wrong_answers[i];
    json.push_back({{"source", solver.wrong_places[i].source},
                    {"index", solver.wrong_places[i].index},
                    {"fault", to_string(wrong.fault)},
                    {"answer", wrong.answer},
                    {"truth", wrong.truth}});
  }
  return json;
}

nlohmann::json json_of(const SolverResult& solver, const BenchResult& group) {
  const Judgement& judged = solver.judgement;
  return {{"name", solver.name},
          {"promise", to_string(solver.promise)},
          {"queries", solver.queries},
          {"time", json_of(solver.times)},
          {"passes", number_or_null(passes(solver, group))},
          {"single", json_of(solver.singles)},
          {"stages", json_of(solver.stages)},
          {"judged", judged.queries},
          {"false_negatives", judged.count(Fault::false_negative)},
          {"false_positives", judged.count(Fault::false_positive)},
          {"late_toi", judged.count(Fault::late_toi)},
          {"early_toi_upper", judged.count(Fault::early_toi_upper)},
          {"undecided", judged.undecided},
          {"errors", judged.count(Fault::error)},
          {"toi_error", json_of(judged.toi_errors)},
          {"broke_promise", broke_promise(solver)},
          {"wrong_answers", wrong_answers_of(solver)}};
}

nlohmann::json json_of(const BenchResult& group) {
  nlohmann::json methods = nlohmann::json::array();
  for (const SolverResult& solver : group.solvers) {
    methods.push_back(json_of(solver, group));
  }
  nlohmann::json json{{"name", group.name},
                      {"kind", to_string(group.kind)},
                      {"queries", group.queries},
                      {"judged", group.judged},
                      {"collisions", group.collisions},
                      {"interrupted", group.interrupted},
                      {"memory_pass", json_of(group.memory_pass)},
                      {"methods", std::move(methods)}};
  if (!is_contact(group.separation)) json["separation"] = to_json(group.separation);
  return json;
}

nlohmann::json json_of(const StepCounts& counts) {
  return {{"candidates", counts.candidates}, {"collisions", counts.collisions}};
}

nlohmann::json json_of(const std::optional<StepResult>& step) {
  if (!step) return {};
  nlohmann::json times = nlohmann::json::array();
  for (const StepTimes& time : step->times) {
    times.push_back({{"threads", time.threads},
                     {"broad_phase_s", time.broad_phase.wall},
                     {"collisions_s", time.collisions.wall},
                     {"earliest_s", time.earliest.wall},
                     {"broad_phase_processor_s", time.broad_phase.processor},
                     {"collisions_processor_s", time.collisions.processor},
                     {"earliest_processor_s", time.earliest.processor}});
  }
  nlohmann::json earliest;
  if (step->earliest) {
    earliest = {{"toi_lower", step->earliest->toi_lower}, {"toi_upper", step->earliest->toi_upper}};
  }
  nlohmann::json json{{"name", step->name},
                      {"vertices", step->vertices},
                      {"edges", step->edges},
                      {"faces", step->faces},
                      {"vertex_face", json_of(step->vertex_face)},
                      {"edge_edge", json_of(step->edge_edge)},
                      {"earliest", std::move(earliest)},
                      {"earliest_agrees", step->earliest_agrees},
                      {"interrupted", step->interrupted},
                      {"times", std::move(times)}};
  if (!is_contact(step->separation)) json["separation"] = to_json(step->separation);
  return json;
}

}  // namespace

bool has_wrong_answers(const BenchReport& report) {
  return any_broke_promise(report.groups) || (report.step && !report.step->earliest_agrees);
}

std::string to_text(const BenchReport& report) {
  std::string text;
  for (const BenchResult& group : report.groups) append_group(text, group);
  if (report.step) append_step(text, *report.step);
  return report.groups.empty() && !report.step ? text : text + legend(report);
}

nlohmann::json to_json(const BenchReport& report) {
  nlohmann::json groups = nlohmann::json::array();
  for (const BenchResult& group : report.groups) groups.push_back(json_of(group));
  return {{"repetitions", report.options.repetitions},
          {"seconds", report.options.seconds},
          {"judge", report.options.judge},
          {"groups", std::move(groups)},
          {"step", json_of(report.step)}};
}

}  // namespace touchstone::verify
