#include "verify/report/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

using Rows = std::span<const jobs::BenchRow>;

/// The settings that differ among the rows of a table.
struct Varying {
  explicit Varying(Rows rows) {
    std::set<double> all_tolerances;
    std::set<std::int64_t> all_limits;
    for (const jobs::BenchRow& row : rows) {
      all_tolerances.insert(row.options.tolerance);
      all_limits.insert(row.options.max_checks);
    }
    tolerance = all_tolerances.size() > 1;
    max_checks = all_limits.size() > 1;
  }

  bool tolerance = false;
  bool max_checks = false;
};

/// "level 3, d 1e-08 (l2)": the level and the separation, if there are, and what differs.
std::string setting_of(const jobs::BenchRow& row, const Varying& varying) {
  std::vector<std::string> parts;
  if (row.level) parts.push_back(fmt::format("level {}", *row.level));
  if (!is_zero(row.options.separation)) {
    parts.push_back("d " + judge::to_text(row.options.separation));
  }
  if (varying.tolerance) parts.push_back(fmt::format("tolerance {}", row.options.tolerance));
  if (varying.max_checks) parts.push_back(fmt::format("checks {}", row.options.max_checks));
  return fmt::format("{}", fmt::join(parts, ", "));
}

io::TextRow cells_of(const jobs::BenchRow& row) {
  const judge::Judgement& judged = row.judgement;
  const double ns = row.nanoseconds;
  return io::joined<std::string>(
      {{io::number_text(ns, "{:.1f}"), io::number_text(ns / row.certified_nanoseconds, "{:.3g}"),
        io::number_text(ns / row.pass_nanoseconds, "{:.3g}"), std::to_string(row.timed),
        std::to_string(judged.queries), std::to_string(judged.collisions)},
       fault_cells(judged),
       toi_error_cells(judged.toi_errors)});
}

std::vector<io::TextColumn> columns() {
  return io::joined<io::TextColumn>({{{"ns/query", 10},
                                      {"/ certified", 11},
                                      {"passes", 8},
                                      {"timed", 8},
                                      {"judged", 8},
                                      {"collide", 8}},
                                     fault_columns(),
                                     toi_error_columns()});
}

nlohmann::json json_of(const std::optional<jobs::SingleTimes>& singles) {
  if (!singles) return {};
  return {{"mean_ns", singles->mean}, {"p50_ns", singles->p50}, {"p99_ns", singles->p99}};
}

nlohmann::json json_of(const jobs::StepCounts& counts) {
  return {{"candidates", counts.candidates}, {"collisions", counts.collisions}};
}

}  // namespace

std::string to_text(Rows rows) {
  const jobs::BenchRow& first = rows.front();
  std::string text = fmt::format("{}, {}: {} queries\n", io::printable(first.source),
                                 to_string(first.kind), first.queries);
  const Varying varying(rows);
  const bool has_settings =
      std::ranges::any_of(rows, [&](const auto& row) { return !setting_of(row, varying).empty(); });
  const bool shows_tolerances =
      std::ranges::any_of(rows, claims_too_much, &jobs::BenchRow::judgement);
  std::vector<io::TextColumn> all{io::word_column("method", 6)};
  if (has_settings) all.push_back(io::word_column("setting", 7));
  all = io::joined<io::TextColumn>({all, columns()});
  if (shows_tolerances) all.push_back(tolerance_column());
  io::TextTable table(all);
  for (const jobs::BenchRow& row : rows) {
    io::TextRow cells{io::printable(row.method)};
    if (has_settings) cells.push_back(setting_of(row, varying));
    cells = io::joined<std::string>({cells, cells_of(row)});
    if (shows_tolerances) cells.push_back(tolerance_cell(row.judgement));
    table.add(cells);
  }
  text += table.text();
  for (const jobs::BenchRow& row : rows) {
    if (row.interrupted) text += "interrupted\n";
    if (!jobs::broke_promise(row)) continue;
    text += fmt::format("{} ({}) breaks its promise: touchstone certify names the queries\n",
                        io::printable(row.method), solvers::to_string(row.promise));
  }
  return text + '\n';
}

std::string to_text(const jobs::StepResult& step) {
  std::string text = fmt::format(
      "{}{}: {} vertices, {} edges, {} faces; vertex-face {} candidates, {} collisions; edge-edge "
      "{} candidates, {} collisions; memory pass {} ms{}\n",
      io::printable(step.name),
      is_zero(step.separation) ? "" : ", minimum separation " + judge::to_text(step.separation),
      step.vertices, step.edges, step.faces, step.vertex_face.candidates,
      step.vertex_face.collisions, step.edge_edge.candidates, step.edge_edge.collisions,
      io::number_text(1e3 * step.memory_pass.processor, "{:.3f}"),
      step.interrupted ? " (interrupted)" : "");
  if (step.earliest) {
    text += fmt::format("earliest impact between {} and {}{}\n", step.earliest->toi_lower,
                        step.earliest->toi_upper,
                        step.earliest_agrees ? "" : ": NOT that of the collisions");
  }
  std::vector<io::TextColumn> columns{{"threads", 7}, io::word_column("time", 9)};
  for (const std::string_view part : jobs::step_parts) columns.push_back({std::string(part), 10});
  io::TextTable table(columns);
  for (const jobs::StepTimes& times : step.times) {
    for (const bool is_wall : {true, false}) {
      io::TextRow row{std::to_string(times.threads), is_wall ? "wall" : "processor"};
      for (const jobs::WorkTime& time : times.parts) {
        row.push_back(io::number_text(1e3 * (is_wall ? time.wall : time.processor), "{:.1f} ms"));
      }
      table.add(row);
    }
  }
  return text + table.text() + '\n';
}

std::string bench_legend(const jobs::BenchOptions& options, bool has_step) {
  std::string text = fmt::format(
      "ns/query: median of {} repetitions, processor time of one thread, of an evenly spread "
      "sample "
      "that takes about {} s;\n"
      "/ certified: as a multiple of the certified solver's time on the same queries, in turns; "
      "passes: of a pass that only\n"
      "reads the queries. judged: an evenly spread part of {} of those timed, and all that the "
      "method or certified calls a\n"
      "collision. error: from toi_lower up to the exact time of impact.\n",
      options.repetitions, options.seconds, options.judge);
  if (has_step) {
    text +=
        "Whole steps: wall: time from beginning to end; processor: time of all threads. trees: "
        "making them; candidates:\n"
        "finding all without storing them; then searches of their own. The memory pass reads "
        "vertices, edges and faces;\n"
        "the limits of line searches leave a fifth of the scene's and of each pair's distance.\n";
  }
  return text;
}

nlohmann::json to_json(const jobs::BenchRow& row) {
  nlohmann::json json = to_json(row.judgement);
  if (!json["toi_error"].is_null()) json["toi_error"].erase("histogram");
  json.update({{"source", row.source},
               {"kind", to_string(row.kind)},
               {"level", row.level ? nlohmann::json(*row.level) : nlohmann::json()},
               {"method", row.method},
               {"promise", solvers::to_string(row.promise)},
               {"tolerance", row.options.tolerance},
               {"max_checks", row.options.max_checks},
               {"queries", row.queries},
               {"timed", row.timed},
               {"judged", row.judgement.queries},
               {"collisions", row.judgement.collisions},
               {"at_limit", row.at_limit},
               {"keeps_promise", !jobs::broke_promise(row)},
               {"ns_per_query", io::number_to_json(row.nanoseconds)},
               {"certified_ns_per_query", io::number_to_json(row.certified_nanoseconds)},
               {"pass_ns_per_query", io::number_to_json(row.pass_nanoseconds)},
               {"single", json_of(row.singles)},
               {"interrupted", row.interrupted}});
  json.update(judge::to_json(row.options.separation));
  return json;
}

nlohmann::json to_json(const jobs::StepResult& step) {
  nlohmann::json times = nlohmann::json::array();
  for (const jobs::StepTimes& time : step.times) {
    nlohmann::json& json = times.emplace_back(nlohmann::json{{"threads", time.threads}});
    for (std::size_t i = 0; i < jobs::step_parts.size(); ++i) {
      const std::string part(jobs::step_parts.at(i));
      json[part + "_s"] = time.parts.at(i).wall;
      json[part + "_processor_s"] = time.parts.at(i).processor;
    }
  }
  nlohmann::json earliest;
  if (step.earliest) {
    earliest = {{"toi_lower", step.earliest->toi_lower}, {"toi_upper", step.earliest->toi_upper}};
  }
  nlohmann::json json{{"step", step.name},
                      {"vertices", step.vertices},
                      {"edges", step.edges},
                      {"faces", step.faces},
                      {"vertex_face", json_of(step.vertex_face)},
                      {"edge_edge", json_of(step.edge_edge)},
                      {"earliest", std::move(earliest)},
                      {"earliest_agrees", step.earliest_agrees},
                      {"interrupted", step.interrupted},
                      {"memory_pass_s", step.memory_pass.processor},
                      {"times", std::move(times)}};
  json.update(judge::to_json(step.separation));
  return json;
}

}  // namespace touchstone::verify::report
