#include "verify/report/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

double passes(const jobs::SolverResult& solver, const jobs::BenchResult& group) {
  return solver.times.median() / group.memory_pass.median();
}

// ---- Text ---------------------------------------------------------------------------------------

std::vector<io::TextColumn> columns_of_group() {
  return io::joined<io::TextColumn>({{io::word_column("method", 6),
                                      {"ns/query", 10},
                                      {"passes", 8},
                                      {"p50", 9},
                                      {"p99", 9},
                                      {"max", 11},
                                      {"timed", 8},
                                      {"judged", 8}},
                                     fault_columns(),
                                     toi_error_columns()});
}

io::TextRow row_of(const jobs::SolverResult& solver, const jobs::BenchResult& group) {
  const judge::Judgement& judged = solver.judgement;
  const auto single = [&](double jobs::SingleTimes::*time) {
    return solver.singles ? io::number_text((*solver.singles).*time, "{:.0f}") : "-";
  };
  return io::joined<std::string>(
      {{io::printable(solver.name), io::number_text(solver.times.median(), "{:.1f}"),
        io::number_text(passes(solver, group), "{:.2f}"), single(&jobs::SingleTimes::p50),
        single(&jobs::SingleTimes::p99), single(&jobs::SingleTimes::max),
        std::to_string(solver.queries), std::to_string(judged.queries)},
       fault_cells(judged),
       toi_error_cells(judged.toi_errors)});
}

/// "  ended by: axis 78.12 %, …"; empty for those without stages.
std::string stages_text(const jobs::SolverResult& solver) {
  if (solver.queries == 0) return {};
  std::string text;
  for (const solvers::StageCount& count : solver.stages) {
    const double share =
        100.0 * static_cast<double>(count.queries) / static_cast<double>(solver.queries);
    text += fmt::format("{} {} {:.4g} %", text.empty() ? "  ended by:" : ",", count.stage, share);
  }
  return text;
}

/// ", minimum separation 1e-08 (l2)"; nothing at distance 0.
std::string separation_text(const Separation& separation) {
  if (is_zero(separation)) return "";
  return ", minimum separation " + judge::to_text(separation);
}

void append_group(std::string& text, const jobs::BenchResult& group) {
  const bool judged_all = group.judged == group.queries;
  text += fmt::format("{}, {}{}: {} queries, {} collisions{}; memory pass {} ns/query{}\n",
                      io::printable(group.name), to_string(group.kind),
                      separation_text(group.separation), group.queries, group.collisions,
                      judged_all ? "" : fmt::format(" among {} judged", group.judged),
                      io::number_text(group.memory_pass.median(), "{:.2f}"),
                      group.interrupted ? " (interrupted)" : "");
  const bool shows_tolerances =
      std::ranges::any_of(group.solvers, claims_too_much, &jobs::SolverResult::judgement);
  std::vector<io::TextColumn> columns = columns_of_group();
  if (shows_tolerances) columns.push_back(tolerance_column());
  io::TextTable table(columns);
  for (const jobs::SolverResult& solver : group.solvers) {
    io::TextRow row = row_of(solver, group);
    if (shows_tolerances) row.push_back(tolerance_cell(solver.judgement));
    table.add(row);
    const std::string stages = stages_text(solver);
    if (!stages.empty()) table.add_line(stages);
  }
  text += table.text();
  for (const jobs::SolverResult& solver : group.solvers) {
    if (!jobs::broke_promise(solver)) continue;
    text += wrong_answers_text({.method = solver.name,
                                .promise = solver.promise,
                                .judgement = solver.judgement,
                                .group = group.name,
                                .kind = to_string(group.kind)},
                               [&](std::size_t i) { return solver.wrong_places[i]; });
  }
  text += '\n';
}

/// One clock's times of a step.
io::TextRow step_row(const jobs::StepTimes& times, std::string_view clock,
                     double jobs::WorkTime::*time) {
  const auto milliseconds = [time](auto... parts) {
    return io::number_text(1e3 * (... + (parts.*time)), "{:.1f} ms");
  };
  return {std::to_string(times.threads),
          std::string(clock),
          milliseconds(times.trees),
          milliseconds(times.candidates),
          milliseconds(times.collisions),
          milliseconds(times.earliest),
          milliseconds(times.trees, times.collisions),
          milliseconds(times.trees, times.earliest),
          milliseconds(times.next, times.earliest)};
}

/// The same of line searches.
io::TextRow line_search_row(const jobs::StepTimes& times, std::string_view clock,
                            double jobs::WorkTime::*time) {
  const auto milliseconds = [time](const jobs::WorkTime& of) {
    return io::number_text(1e3 * (of.*time), "{:.1f} ms");
  };
  return {std::to_string(times.threads), std::string(clock), milliseconds(times.free_step_size),
          milliseconds(times.limit_of_scene), milliseconds(times.limit_of_pairs)};
}

void append_step(std::string& text, const jobs::StepResult& step) {
  text += fmt::format(
      "{}{}: {} vertices, {} edges, {} faces; vertex-face {} candidates, {} collisions; edge-edge "
      "{} candidates, {} collisions; memory pass {} ms{}\n",
      io::printable(step.name), separation_text(step.separation), step.vertices, step.edges,
      step.faces, step.vertex_face.candidates, step.vertex_face.collisions,
      step.edge_edge.candidates, step.edge_edge.collisions,
      io::number_text(1e3 * step.memory_pass.processor, "{:.3f}"),
      step.interrupted ? " (interrupted)" : "");
  text +=
      fmt::format("memory of a step: {} above the mesh; {} pages touched, {} in the next step\n",
                  io::number_text(0x1p-20 * static_cast<double>(step.memory.peak), "{:.1f} MiB"),
                  step.memory.faults_of_first, step.memory.faults_of_next);
  if (step.earliest) {
    text += fmt::format("earliest impact between {} and {}{}\n", step.earliest->toi_lower,
                        step.earliest->toi_upper,
                        step.earliest_agrees ? "" : ": NOT that of the collisions");
  }
  io::TextTable table({{"threads", 7},
                       io::word_column("time", 9),
                       {"trees", 10},
                       {"candidates", 10},
                       {"collisions", 10},
                       {"earliest", 10},
                       {"step, all", 13},
                       {"step, earliest", 15},
                       {"next, earliest", 15}});
  for (const jobs::StepTimes& times : step.times) {
    table.add(step_row(times, "wall", &jobs::WorkTime::wall));
    table.add(step_row(times, "processor", &jobs::WorkTime::processor));
  }
  text += table.text();
  io::TextTable line_searches({{"threads", 7},
                               io::word_column("time", 9),
                               {"free step size", 15},
                               {"limit of scene", 15},
                               {"limit of pairs", 15}});
  for (const jobs::StepTimes& times : step.times) {
    line_searches.add(line_search_row(times, "wall", &jobs::WorkTime::wall));
    line_searches.add(line_search_row(times, "processor", &jobs::WorkTime::processor));
  }
  text += line_searches.text() + '\n';
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
        "Whole steps: medians of as many repetitions; wall: time from beginning to end; processor: "
        "time of all\n"
        "threads, as in the other tables. trees: making them; candidates: finding all without "
        "storing them;\n"
        "collisions, earliest: with another search. The memory pass reads vertices, edges and "
        "faces.\n"
        "Line searches: the greatest free step size, and the limits that leave a fifth of the "
        "scene's and of each\n"
        "pair's distance.\n";
  }
  const auto is_sampled = [](const jobs::BenchResult& group) {
    return std::ranges::any_of(group.solvers, [&](const jobs::SolverResult& solver) {
      return solver.queries < group.queries;
    });
  };
  if (std::ranges::any_of(report.groups, is_sampled)) {
    text += fmt::format(
        "timed: of larger groups an evenly spread sample that takes about {} s a repetition.\n",
        report.options.seconds);
  }
  const auto is_judged_in_part = [](const jobs::BenchResult& group) {
    return group.judged < group.queries;
  };
  if (std::ranges::any_of(report.groups, is_judged_in_part)) {
    text += fmt::format(
        "judged: of larger groups an evenly spread sample of {}, and all that any method calls a "
        "collision; a false\n"
        "negative outside of the sample is found only if another method reports the collision.\n",
        report.options.judge);
  }
  return text;
}

// ---- JSON ---------------------------------------------------------------------------------------

nlohmann::json json_of(const jobs::TimesPerQuery& times) {
  return {{"ns_per_query", io::number_to_json(times.median())},
          {"min_ns_per_query", io::number_to_json(times.min())},
          {"repetitions", times.repetitions}};
}

nlohmann::json json_of(const std::optional<jobs::SingleTimes>& singles) {
  if (!singles) return {};
  return {{"queries", singles->queries},
          {"mean_ns", singles->mean},
          {"p50_ns", singles->p50},
          {"p99_ns", singles->p99},
          {"max_ns", singles->max}};
}

nlohmann::json json_of(const std::vector<solvers::StageCount>& stages) {
  nlohmann::json json;
  for (const solvers::StageCount& count : stages) json[std::string(count.stage)] = count.queries;
  return json;
}

nlohmann::json wrong_answers_of(const jobs::SolverResult& solver) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < solver.judgement.wrong_answers.size(); ++i) {
    nlohmann::json& json = list.emplace_back(to_json(solver.judgement.wrong_answers[i]));
    json.update(
        {{"source", solver.wrong_places[i].source}, {"index", solver.wrong_places[i].index}});
  }
  return list;
}

nlohmann::json json_of(const jobs::SolverResult& solver, const jobs::BenchResult& group) {
  const judge::Judgement& judged = solver.judgement;
  nlohmann::json json = to_json(judged);
  json.update({{"name", solver.name},
               {"promise", solvers::to_string(solver.promise)},
               {"queries", solver.queries},
               {"time", json_of(solver.times)},
               {"passes", io::number_to_json(passes(solver, group))},
               {"single", json_of(solver.singles)},
               {"stages", json_of(solver.stages)},
               {"judged", judged.queries},
               {"broke_promise", jobs::broke_promise(solver)},
               {"wrong_answers", wrong_answers_of(solver)}});
  return json;
}

nlohmann::json json_of(const jobs::BenchResult& group) {
  nlohmann::json methods = nlohmann::json::array();
  for (const jobs::SolverResult& solver : group.solvers) {
    methods.push_back(json_of(solver, group));
  }
  nlohmann::json json{{"name", group.name},
                      {"kind", to_string(group.kind)},
                      {"queries", group.queries},
                      {"judged", group.judged},
                      {"collisions", group.collisions},
                      {"interrupted", group.interrupted},
                      {"memory_pass", json_of(group.memory_pass)},
                      {"methods", std::move(methods)},
                      {"separation", judge::to_json(group.separation)}};
  return json;
}

nlohmann::json json_of(const jobs::StepCounts& counts) {
  return {{"candidates", counts.candidates}, {"collisions", counts.collisions}};
}

nlohmann::json json_of(const jobs::StepMemory& memory) {
  return {{"peak_bytes", memory.peak},
          {"page_faults", memory.faults_of_first},
          {"page_faults_of_next", memory.faults_of_next}};
}

nlohmann::json json_of(const std::optional<jobs::StepResult>& step) {
  if (!step) return {};
  nlohmann::json times = nlohmann::json::array();
  for (const jobs::StepTimes& time : step->times) {
    nlohmann::json& json = times.emplace_back(nlohmann::json{{"threads", time.threads}});
    const auto add = [&json](const std::string& part, const jobs::WorkTime& of) {
      json[part + "_s"] = of.wall;
      json[part + "_processor_s"] = of.processor;
    };
    add("trees", time.trees);
    add("candidates", time.candidates);
    add("collisions", time.collisions);
    add("earliest", time.earliest);
    add("next", time.next);
    add("free_step_size", time.free_step_size);
    add("limit_of_scene", time.limit_of_scene);
    add("limit_of_pairs", time.limit_of_pairs);
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
                      {"memory", json_of(step->memory)},
                      {"interrupted", step->interrupted},
                      {"memory_pass_s", step->memory_pass.processor},
                      {"times", std::move(times)},
                      {"separation", judge::to_json(step->separation)}};
  return json;
}

}  // namespace

bool has_wrong_answers(const BenchReport& report) {
  return jobs::any_broke_promise(report.groups) || (report.step && !report.step->earliest_agrees);
}

std::string to_text(const BenchReport& report) {
  std::string text;
  for (const jobs::BenchResult& group : report.groups) append_group(text, group);
  if (report.step) append_step(text, *report.step);
  return report.groups.empty() && !report.step ? text : text + legend(report);
}

nlohmann::json to_json(const BenchReport& report) {
  nlohmann::json groups = nlohmann::json::array();
  for (const jobs::BenchResult& group : report.groups) groups.push_back(json_of(group));
  return {{"repetitions", report.options.repetitions},
          {"seconds", report.options.seconds},
          {"judge", report.options.judge},
          {"groups", std::move(groups)},
          {"step", json_of(report.step)}};
}

}  // namespace touchstone::verify::report
