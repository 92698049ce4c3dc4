#include "verify/report/certify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "touchstone/any_kind.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/judge.hpp"
#include "verify/judge/terms.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::string_view kind_text(const jobs::CertifyResult& result) {
  return result.shape ? to_string(result.shape->kind) : "";
}

/// "vertex-face", or "vertex-face of degree 2", or "rational vertex-face of degree 2".
std::string shape_text(const jobs::CertifyResult& result) {
  std::string text(kind_text(result));
  if (!result.shape || result.shape->is_straight()) return text;
  if (result.shape->is_rational) text.insert(0, "rational ");
  return text + fmt::format(" of degree {}", result.shape->degree);
}

io::TextRow row_of(const jobs::CertifyResult& result) {
  return {io::printable(result.name),
          shape_text(result),
          std::to_string(result.queries),
          std::to_string(result.collisions),
          std::to_string(result.labels),
          std::to_string(result.label_mismatches),
          std::to_string(result.tois),
          std::to_string(result.toi_mismatches),
          io::number_text(result.microseconds_per_query(), "{:.2f}")};
}

std::string_view name_of(judge::Mismatch::Of of) {
  return of == judge::Mismatch::Of::label ? "label" : "toi";
}

std::string mismatch_text(const jobs::CertifyResult& result, const judge::Mismatch& mismatch) {
  return fmt::format("mismatch: {}: {} query {}: recorded {} {}, truth {}\n",
                     io::printable(result.name), kind_text(result), mismatch.index,
                     name_of(mismatch.of), mismatch.recorded, mismatch.truth);
}

bool has_separation(const std::vector<jobs::CertifyResult>& results) {
  return !std::ranges::all_of(
      results, [](const jobs::CertifyResult& result) { return is_zero(result.separation); });
}

/// The separation of all sources, if it is one.
std::optional<Separation> separation_of(const std::vector<jobs::CertifyResult>& results) {
  std::vector<Separation> all;
  all.reserve(results.size());
  for (const jobs::CertifyResult& result : results) all.push_back(result.separation);
  return judge::common_separation(all);
}

std::string_view name_of(judge::Inference inference) {
  if (inference == judge::Inference::all) return "all";
  return inference == judge::Inference::collisions ? "collisions" : "nothing";
}

/// The separation of the numbers below.
std::string separations_text(const std::vector<jobs::CertifyResult>& results) {
  if (!has_separation(results)) return {};
  std::string text;
  if (const auto separation = separation_of(results)) {
    text += fmt::format("minimum separation {}\n", judge::to_text(*separation));
  } else {
    for (const jobs::CertifyResult& result : results) {
      text += fmt::format("minimum separation {}: {}\n", judge::to_text(result.separation),
                          io::printable(result.name));
    }
  }
  const auto compares_collisions = [](const jobs::CertifyResult& result) {
    return result.compared == judge::Inference::collisions;
  };
  if (std::ranges::any_of(results, compares_collisions)) {
    text +=
        "recorded answers are about less separation: only their collisions are compared, which "
        "must collide, no later\n";
  }
  return text;
}

nlohmann::json counts(const jobs::CertifyResult& result) {
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

/// The column of tolerances in the table of methods: shown if there is a separation, or a method
/// claims too much.
enum class Tolerances : std::uint8_t { hidden, shown };

io::TextRow method_row(const std::string& name, std::string_view kind,
                       const jobs::MethodResult& method, Tolerances tolerances) {
  const judge::Judgement& judged = method.judgement;
  std::optional<double> time;
  if (method.timed) time = judged.nanoseconds_per_query();
  io::TextRow row =
      io::joined<std::string>({{name, std::string(kind), std::to_string(judged.queries)},
                               fault_cells(judged),
                               {io::number_text(time, "{:.1f}")},
                               toi_error_cells(judged.toi_errors)});
  if (tolerances == Tolerances::shown) {
    row.push_back(tolerance_cell(judged));
  }
  return row;
}

/// "12 late, 5 by more than 1e-12, …; at most by 0.3 of the step, 7 ulp"; empty if none is.
std::string late_text(const judge::LateTimes& late) {
  if (late.count == 0) return {};
  std::string text = fmt::format("{} late", late.count);
  for (std::size_t i = 0; i < late.beyond.size(); ++i) {
    text += fmt::format(", {} by more than {:.0e}", late.beyond.at(i),
                        judge::LateTimes::thresholds.at(i));
  }
  return fmt::format("{}; at most by {} of the step, {:.0f} ulp", text,
                     io::error_text(late.greatest.step), late.greatest.ulps);
}

/// The queries that were not asked because of the terms, and for lack of time; empty if all were.
std::string unasked_text(const judge::Judgement& judgement, const fast::Terms& terms) {
  std::string text;
  if (judgement.outside != 0) {
    text += fmt::format("{} queries outside its terms{}", judgement.outside, judge::to_text(terms));
  }
  if (judgement.left_out != 0) {
    text += fmt::format("{}{} queries skipped, for lack of time or after hangs at similar ones",
                        text.empty() ? "" : "; ", judgement.left_out);
  }
  return text;
}

/// "miss", "false alarm", "wrong time", or as judge::to_text.
std::string_view common_name(judge::Fault fault) {
  if (fault == judge::Fault::false_negative) return "miss";
  if (fault == judge::Fault::false_positive) return "false alarm";
  if (fault == judge::Fault::late_toi || fault == judge::Fault::early_toi_upper) {
    return "wrong time";
  }
  return judge::to_text(fault);
}

/// "SOURCE: vertex-face query 4: answer no, truth collision at 0.5".
std::string answer_text(const jobs::CertifyResult& result, const judge::WrongAnswer& wrong) {
  std::string text = fmt::format("{}: {} query {}: answer {}, truth {}", io::printable(result.name),
                                 kind_text(result), wrong.index, wrong.answer, wrong.truth);
  if (wrong.lateness) {
    text += fmt::format(", late by {:.1e}, {:.0f} ulp", wrong.lateness->step, wrong.lateness->ulps);
  }
  return text;
}

/// The number of answers of a group and fault that are printed.
constexpr std::size_t most_printed = 20;

/// The positions of answers in the order of harm, later times first, else as they are.
std::vector<std::size_t> by_harm(const std::vector<judge::WrongAnswer>& wrong,
                                 fast::Promise promise) {
  const auto key = [&](std::size_t i) {
    const judge::WrongAnswer& answer = wrong[i];
    return std::pair(
        judge::harm_of(answer.fault, judge::is_slight(answer.fault, answer.lateness), promise),
        answer.lateness ? -answer.lateness->step : 0.0);
  };
  std::vector<std::size_t> order(wrong.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, key);
  return order;
}

/// The answers that broke the promise, the worst first, a line each; the first of a fault, then the
/// number of further ones.
std::string wrong_answers_text(const jobs::CertifyResult& result,
                               const jobs::MethodResult& method) {
  const judge::Judgement& judgement = method.judgement;
  const std::string name = io::printable(method.name);
  std::string text;
  // By text: all errors together.
  std::map<std::string_view, std::uint64_t> printed;
  for (const std::size_t i : by_harm(judgement.wrong_answers, method.promise)) {
    const judge::WrongAnswer& wrong = judgement.wrong_answers[i];
    std::uint64_t& count = printed[judge::to_text(wrong.fault)];
    if (!judge::breaks(wrong.fault, method.promise) || count == most_printed) continue;
    ++count;
    text +=
        fmt::format("{}: {}: {}\n", judge::to_text(wrong.fault), name, answer_text(result, wrong));
  }
  for (const judge::Fault fault : judge::all_faults) {
    const auto count = printed.extract(judge::to_text(fault));
    const std::uint64_t all = judgement.total(fault);
    if (count.empty() || count.mapped() != most_printed || all == most_printed) continue;
    text += fmt::format("{}: {}: {}: and {} more\n", judge::to_text(fault), name,
                        io::printable(result.name), all - most_printed);
  }
  return text;
}

using FailureCounts = std::array<std::uint64_t, judge::fault_count>;

/// "1 crash, 2 undecided": the number of each kind; empty if there are none.
std::string to_text(const FailureCounts& failures) {
  std::string text;
  for (const judge::Fault kind : judge::all_failures) {
    const std::uint64_t count = failures[static_cast<std::size_t>(kind)];
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, judge::to_string(kind));
  }
  return text;
}

/// Number of missing answers, by kind, unless the solver itself was undecided.
std::string failures_text(const jobs::MethodResult& method) {
  const judge::Judgement& judged = method.judgement;
  const auto is_other = [&](judge::Fault kind) {
    return kind != judge::Fault::undecided && judged.count(kind) != 0;
  };
  if (std::ranges::none_of(judge::all_failures, is_other)) return {};
  return fmt::format("no answer: {}: {}\n", method.name, to_text(judged.faults));
}

/// Missing answers, late times, and queries that were not asked, a line each.
std::string notes_text(const jobs::MethodResult& method) {
  std::string text = failures_text(method);
  if (const std::string late = late_text(method.judgement.late); !late.empty()) {
    text += fmt::format("times of impact: {}: {}\n", method.name, late);
  }
  return text;
}

/// The queries outside of the promise, as the last line.
std::string outside_text(const jobs::MethodResult& method) {
  const std::string unasked = unasked_text(method.judgement, method.terms);
  return unasked.empty() ? "" : fmt::format("not asked: {}: {}\n", method.name, unasked);
}

std::string methods_text(std::size_t width, const std::vector<jobs::CertifyResult>& results,
                         const jobs::CertifyResult& sum) {
  const bool shows_tolerances =
      has_separation(results) ||
      std::ranges::any_of(sum.methods, claims_too_much, &jobs::MethodResult::judgement);
  const Tolerances tolerances = shows_tolerances ? Tolerances::shown : Tolerances::hidden;
  for (const jobs::MethodResult& method : sum.methods) {
    width = std::max(width, io::printable(method.name).size());
  }
  std::vector<io::TextColumn> columns = io::joined<io::TextColumn>(
      {{io::word_column("method", width + 2), io::word_column("kind", 11), {"queries", 9}},
       fault_columns(),
       {{"ns/query", 10}},
       toi_error_columns()});
  if (shows_tolerances) columns.push_back(tolerance_column());
  io::TextTable table(columns);
  std::string wrong_answers;
  for (std::size_t i = 0; i < sum.methods.size(); ++i) {
    table.add(method_row(io::printable(sum.methods[i].name), "", sum.methods[i], tolerances));
    for (const jobs::CertifyResult& result : results) {
      if (i >= result.methods.size()) continue;
      const jobs::MethodResult& method = result.methods[i];
      if (judge::keeps(method.judgement, method.promise)) continue;
      table.add(
          method_row("  " + io::printable(result.name), kind_text(result), method, tolerances));
      wrong_answers += wrong_answers_text(result, method);
    }
  }
  std::string text = '\n' + table.text();
  for (const jobs::MethodResult& method : sum.methods) text += notes_text(method);
  text += wrong_answers;
  for (const jobs::MethodResult& method : sum.methods) text += outside_text(method);
  return text;
}

// ---- The summary --------------------------------------------------------------------------------

std::string time_text(std::optional<double> nanoseconds) {
  if (nanoseconds && *nanoseconds >= 1e6) return fmt::format("{:.1f} ms", *nanoseconds * 1e-6);
  if (nanoseconds && *nanoseconds >= 1e3) return fmt::format("{:.1f} µs", *nanoseconds * 1e-3);
  return io::number_text(nanoseconds, "{:.0f} ns");
}

std::string promise_cell(const jobs::MethodResult& method) {
  std::string promise(solvers::to_string(method.promise));
  if (method.promise == fast::Promise::none) return promise;
  if (method.judgement.queries == 0) return promise + ": not judged";
  return promise + (judge::keeps(method.judgement, method.promise) ? ": kept" : ": broken");
}

std::string solvers_text(const jobs::CertifyResult& sum) {
  io::TextTable table({io::word_column("solver"),
                       io::word_column("promise"),
                       {"queries", 7},
                       {"misses", 6},
                       {"false alarms", 12},
                       {"wrong times", 11},
                       {"no answer", 9},
                       {"time", 8}});
  std::string notes;
  for (const jobs::MethodResult& method : sum.methods) {
    const judge::Judgement& judged = method.judgement;
    table.add({io::printable(method.name), promise_cell(method), std::to_string(judged.queries),
               std::to_string(judged.count(judge::Fault::false_negative)),
               std::to_string(judged.count(judge::Fault::false_positive)),
               std::to_string(judged.count(judge::Fault::late_toi) +
                              judged.count(judge::Fault::early_toi_upper)),
               std::to_string(judged.undecided() + judged.errors()),
               time_text(method.nanoseconds_per_query())});
    notes += failures_text(method) + outside_text(method);
  }
  return '\n' + table.text() + notes;
}

std::uint64_t broken_answers(const jobs::MethodResult& method) {
  std::uint64_t count = method.judgement.unplaced_crashes;
  for (const judge::Fault fault : judge::all_faults) {
    if (judge::breaks(fault, method.promise)) count += method.judgement.count(fault);
  }
  return count;
}

/// The worst answers of a solver that broke its promise, of those alike one of each source first.
std::vector<std::string> worst_answers(const std::vector<jobs::CertifyResult>& results,
                                       std::size_t solver, std::size_t most) {
  // By the harm, and the number of those alike in the source.
  std::multimap<std::pair<int, std::size_t>, std::string> all;
  for (const jobs::CertifyResult& result : results) {
    if (solver >= result.methods.size()) continue;
    const jobs::MethodResult& method = result.methods[solver];
    std::map<int, std::size_t> alike;
    for (const judge::WrongAnswer& wrong : method.judgement.wrong_answers) {
      if (!judge::breaks(wrong.fault, method.promise)) continue;
      const bool is_slight = judge::is_slight(wrong.fault, wrong.lateness);
      const int harm = judge::harm_of(wrong.fault, is_slight, method.promise);
      all.emplace(std::pair(harm, alike[harm]++),
                  fmt::format("  {}: {}: {}\n", common_name(wrong.fault),
                              io::printable(method.name), answer_text(result, wrong)));
    }
  }
  std::vector<std::string> lines;
  for (auto& [order, line] : all) {
    if (lines.size() < most) lines.push_back(std::move(line));
  }
  return lines;
}

/// The number of wrong answers, recorded ones and those of solvers, and some of them, of each kind
/// of answers about as many.
std::string wrong_text(const std::vector<jobs::CertifyResult>& results,
                       const jobs::CertifyResult& sum, std::size_t most) {
  std::uint64_t count = sum.label_mismatches + sum.toi_mismatches;
  std::size_t groups = count != 0 ? 1 : 0;
  for (const jobs::MethodResult& method : sum.methods) {
    const std::uint64_t broken = broken_answers(method);
    count += broken;
    groups += broken != 0 ? 1 : 0;
  }
  const std::size_t share = std::max<std::size_t>(1, most / std::max<std::size_t>(1, groups));
  std::vector<std::string> lines;
  for (const jobs::CertifyResult& result : results) {
    for (const judge::Mismatch& mismatch : result.mismatches) {
      if (lines.size() < share) lines.push_back("  " + mismatch_text(result, mismatch));
    }
  }
  for (std::size_t i = 0; i < sum.methods.size(); ++i) {
    lines = io::joined<std::string>({lines, worst_answers(results, i, share)});
  }
  if (lines.size() > most) lines.resize(most);
  const std::string_view colon = lines.size() < count ? ", such as" : "";
  return fmt::format("found: {} wrong{}\n{}", count, colon, fmt::join(lines, ""));
}

nlohmann::json json_of(const judge::WrongAnswer& wrong) {
  return {{"index", wrong.index},
          {"fault", judge::to_text(wrong.fault)},
          {"answer", wrong.answer},
          {"truth", wrong.truth}};
}

nlohmann::json json_of(const FailureCounts& failures) {
  nlohmann::json json = nlohmann::json::object();
  for (const judge::Fault kind : judge::all_failures) {
    json[judge::to_string(kind)] = failures[static_cast<std::size_t>(kind)];
  }
  return json;
}

nlohmann::json counts(const jobs::MethodResult& method) {
  const judge::Judgement& judged = method.judgement;
  nlohmann::json json = to_json(judged);
  json.update({{"name", method.name},
               {"promise", solvers::to_string(method.promise)},
               {"terms", judge::as_options(method.terms)},
               {"queries", judged.queries},
               {"failures", json_of(judged.faults)},
               {"unplaced_crashes", judged.unplaced_crashes},
               {"missing", judged.missing},
               {"ns_per_query", io::number_to_json(method.nanoseconds_per_query())}});
  return json;
}

nlohmann::json methods_of(const jobs::CertifyResult& result) {
  nlohmann::json json = nlohmann::json::array();
  for (const jobs::MethodResult& method : result.methods) json.push_back(counts(method));
  return json;
}

void append_wrong_answers(nlohmann::json& methods, const jobs::CertifyResult& result) {
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    for (const judge::WrongAnswer& wrong : result.methods[i].judgement.wrong_answers) {
      nlohmann::json json = json_of(wrong);
      json.update({{"file", result.name}, {"kind", kind_text(result)}});
      methods[i]["wrong_answers"].push_back(std::move(json));
    }
  }
}

// ---- Answers without a truth --------------------------------------------------------------------

std::uint64_t noes_of(const judge::Judgement& asked) {
  return asked.queries - asked.collisions - asked.undecided() - asked.errors_at_queries();
}

std::uint64_t unasked_of(const judge::Judgement& asked) {
  return asked.missing + asked.outside + asked.left_out;
}

}  // namespace

std::string to_text(const std::vector<jobs::CertifyResult>& results) {
  std::size_t width = 5, shape_width = 11;
  for (const jobs::CertifyResult& result : results) {
    width = std::max(width, io::printable(result.name).size());
    shape_width = std::max(shape_width, shape_text(result).size());
  }

  io::TextTable table({io::word_column("file", width),
                       io::word_column("kind", shape_width),
                       {"queries", 9},
                       {"collisions", 10},
                       {"labels", 9},
                       {"wrong labels", 11},
                       {"tois", 9},
                       {"wrong tois", 10},
                       {"µs/query", 8}});
  for (const jobs::CertifyResult& result : results) table.add(row_of(result));
  const jobs::CertifyResult sum = jobs::total(results);
  table.add(row_of(sum));
  std::string text = separations_text(results) + table.text();
  text += reading_text(sum.skipped, sum.rounded);
  for (const jobs::CertifyResult& result : results) {
    for (const judge::Mismatch& mismatch : result.mismatches) {
      text += mismatch_text(result, mismatch);
    }
  }
  if (!sum.methods.empty()) text += methods_text(width, results, sum);
  return text;
}

std::string to_summary(const std::vector<jobs::CertifyResult>& results, std::size_t most_lines) {
  const jobs::CertifyResult sum = jobs::total(results);
  std::string text =
      fmt::format("asked: {} queries, of which {} collide", sum.queries, sum.collisions);
  if (has_separation(results)) {
    const auto separation = separation_of(results);
    text +=
        " within " + (separation ? judge::to_text(*separation) : "the distances of their files");
  }
  text += fmt::format("\ntruth: exact, {} a query", time_text(1e3 * sum.microseconds_per_query()));
  if (sum.labels + sum.tois != 0) {
    text += fmt::format("; recorded: {} of {} verdicts wrong", sum.label_mismatches, sum.labels);
    if (sum.tois != 0) {
      text += fmt::format(", {} of {} times wrong", sum.toi_mismatches, sum.tois);
    }
  }
  text += '\n' + reading_text(sum.skipped, sum.rounded);
  if (!sum.methods.empty()) text += solvers_text(sum);
  text += '\n';
  if (jobs::has_wrong_answers(sum)) {
    const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
    return text + wrong_text(results, sum, lines < most_lines ? most_lines - lines : 0);
  }
  if (sum.queries == 0) return text + "found: nothing, as nothing was asked\n";
  if (sum.labels + sum.tois == 0 && sum.methods.empty()) {
    return text + "found: nothing to compare, without recorded answers and solvers\n";
  }
  if (std::ranges::all_of(sum.methods, [](const auto& m) { return m.judgement.queries == 0; }) &&
      sum.labels + sum.tois == 0) {
    return text + "found: nothing, as no solver answered\n";
  }
  const bool has_false_alarms = std::ranges::any_of(sum.methods, [](const auto& method) {
    return method.judgement.count(judge::Fault::false_positive) != 0;
  });
  text += "found: nothing wrong";
  if (sum.interrupted) text += " so far";
  return text + (has_false_alarms ? "; false alarms are allowed\n" : "\n");
}

nlohmann::json to_json(const std::vector<jobs::CertifyResult>& results) {
  const jobs::CertifyResult sum = jobs::total(results);
  nlohmann::json json = counts(sum);
  if (const auto separation = separation_of(results))
    json["separation"] = judge::to_json(*separation);
  json["methods"] = methods_of(sum);
  if (sum.proofs.certificates() != 0) json["proofs"] = jobs::to_json(sum.proofs);
  for (nlohmann::json& method : json["methods"]) method["wrong_answers"] = nlohmann::json::array();
  json["mismatches"] = nlohmann::json::array();
  json["files"] = nlohmann::json::array();
  for (const jobs::CertifyResult& result : results) {
    nlohmann::json file = counts(result);
    file["file"] = result.name;
    file["kind"] = kind_text(result);
    if (result.shape && !result.shape->is_straight()) {
      file["degree"] = result.shape->degree;
      file["rational"] = result.shape->is_rational;
    }
    file["separation"] = judge::to_json(result.separation);
    file["compared"] = name_of(result.compared);
    file["methods"] = methods_of(result);
    if (result.error) file["error"] = *result.error;
    json["files"].push_back(std::move(file));
    append_wrong_answers(json["methods"], result);
    for (const judge::Mismatch& mismatch : result.mismatches) {
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

std::string answers_to_text(const jobs::MethodResult& method) {
  const judge::Judgement& asked = method.judgement;
  std::string text =
      fmt::format("{}: {} queries, {} yes, {} no, {} undecided, {} errors, {:.1f} ns/query\n",
                  method.name, asked.queries, asked.collisions, noes_of(asked), asked.undecided(),
                  asked.errors_at_queries(), asked.nanoseconds_per_query());
  if (const std::uint64_t unasked = unasked_of(asked); unasked != 0) {
    text += fmt::format(
        "not asked: {} queries outside its terms{}, or similar to those at which it hangs\n",
        unasked, judge::to_text(method.terms));
  }
  const std::string failures = to_text(asked.faults);
  return failures.empty() ? text : text + fmt::format("no answer: {}\n", failures);
}

nlohmann::json answers_to_json(const jobs::MethodResult& method) {
  const judge::Judgement& asked = method.judgement;
  return {{"method", method.name},
          {"queries", asked.queries},
          {"yes", asked.collisions},
          {"no", noes_of(asked)},
          {"undecided", asked.undecided()},
          {"errors", asked.errors_at_queries()},
          {"unasked", unasked_of(asked)},
          {"failures", json_of(asked.faults)},
          {"unplaced_crashes", asked.unplaced_crashes},
          {"ns_per_query", asked.nanoseconds_per_query()}};
}

std::string truth_header() {
  return io::csv_row({"file", "index", "kind", "collides", "toi_lower", "toi_upper"});
}

std::string truth_row(const std::string& file, AnyKind kind, const judge::GroundTruth& truth) {
  const auto [lower, upper] = truth.toi.value_or(exact::DoubleInterval{unknown, unknown});
  return io::csv_row({file, std::to_string(truth.index), std::string(to_string(kind)),
                      truth.collides ? "1" : "0", io::csv_number(lower), io::csv_number(upper)});
}

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 28U;

void add_wrong_answers(KnownAnswers& to, const jobs::CertifyResult& result,
                       const jobs::MethodResult& method) {
  for (const judge::Fault fault : judge::all_faults) {
    if (judge::breaks(fault, method.promise) &&
        method.judgement.count(fault) > judge::Judgement::most_kept) {
      throw std::runtime_error(fmt::format(
          "--baseline: at most {} answers of one fault in one file; {} has {} in {}",
          judge::Judgement::most_kept, method.name, method.judgement.count(fault), result.name));
    }
  }
  for (const judge::WrongAnswer& wrong : method.judgement.wrong_answers) {
    if (!judge::breaks(wrong.fault, method.promise)) continue;
    KnownAnswer known = known_query(method.name, result.name, result.shape.value().kind,
                                    wrong.index, result.separation);
    known.fault = wrong.fault;
    to.insert(std::move(known));
  }
}

/// The first answers, a line each.
std::string list_text(std::string_view title, const KnownAnswers& answers) {
  constexpr std::size_t most = 3;
  std::string text;
  std::size_t count = 0;
  for (const KnownAnswer& one : answers) {
    if (count++ == most) break;
    text += fmt::format("  {}: {} of {}: {}: {} query {}\n", title, common_name(one.fault),
                        io::printable(one.solver), io::printable(one.file), one.kind, one.index);
  }
  if (answers.size() > most) text += fmt::format("  and {} more\n", answers.size() - most);
  return text;
}

}  // namespace

KnownAnswer known_query(const std::string& solver, const std::string& file, AnyKind kind,
                        std::uint64_t index, const Separation& separation) {
  return {.solver = solver,
          .file = file,
          .kind = std::string(to_string(kind)),
          .index = index,
          .distance = separation.distance,
          .norm = std::string(to_string(is_zero(separation) ? Norm::l2 : separation.norm)),
          .fault = judge::all_faults.front()};
}

void add_of_query(const KnownAnswers& known, const KnownAnswer& query, KnownAnswers& to) {
  for (auto at = known.lower_bound(query); at != known.end(); ++at) {
    KnownAnswer same = query;
    same.fault = at->fault;
    if (*at != same) return;
    to.insert(*at);
  }
}

KnownAnswers read_baseline(const std::filesystem::path& path) {
  KnownAnswers known;
  try {
    const nlohmann::json json = io::read_json(path, most_bytes);
    for (const nlohmann::json& row : json.at("known")) {
      const auto fault = judge::fault_from_name(row.at(4).get<std::string>());
      if (!fault) throw std::invalid_argument("an unknown fault: " + row.at(4).dump());
      const bool is_about_contact = row.size() < 7;
      known.insert({row.at(0), row.at(1), row.at(2), row.at(3),
                    is_about_contact ? 0.0 : row.at(5).get<double>(),
                    is_about_contact ? "l2" : row.at(6).get<std::string>(), *fault});
    }
  } catch (const io::DatasetError&) {
    throw;
  } catch (const std::exception& error) {
    throw io::DatasetError(path, {}, "no baseline: " + io::reason_of(error));
  }
  return known;
}

std::string baseline_document(const KnownAnswers& known) {
  std::string rows;
  for (const KnownAnswer& one : known) {
    const nlohmann::json row{
        one.solver,   one.file, one.kind, one.index, judge::to_string(one.fault),
        one.distance, one.norm};
    rows += rows.empty() ? "\n" : ",\n";
    rows += row.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  }
  return fmt::format("{{\"known\": [{}\n]}}\n", rows);
}

namespace {

/// The answers that broke a promise.
/// \throws std::runtime_error if a solver has more of one fault in one file than are kept
KnownAnswers wrong_answers_of(const std::vector<jobs::CertifyResult>& results) {
  KnownAnswers all;
  for (const jobs::CertifyResult& result : results) {
    for (const jobs::MethodResult& method : result.methods) add_wrong_answers(all, result, method);
  }
  return all;
}

}  // namespace

BaselineChange change_of(const KnownAnswers& baseline, const KnownAnswers& asked,
                         const std::vector<jobs::CertifyResult>& results) {
  BaselineChange change{.fresh = {}, .mended = {}, .now = wrong_answers_of(results)};
  std::ranges::set_difference(change.now, baseline,
                              std::inserter(change.fresh, change.fresh.end()));
  for (const KnownAnswer& known : baseline) {
    if (change.now.contains(known)) continue;
    (asked.contains(known) ? change.mended : change.now).insert(known);
  }
  return change;
}

std::string to_text(const BaselineChange& change) {
  return fmt::format("baseline: {} known wrong answers, {} new, {} mended\n",
                     change.now.size() - change.fresh.size() + change.mended.size(),
                     change.fresh.size(), change.mended.size()) +
         list_text("new", change.fresh) + list_text("mended", change.mended);
}

std::string badge(const jobs::MethodResult& method) {
  const judge::Judgement& judged = method.judgement;
  const std::string score =
      fmt::format("{} misses, {} false alarms", judged.count(judge::Fault::false_negative),
                  judged.count(judge::Fault::false_positive));
  constexpr int left = 82, padding = 8;
  const int right = 13 * static_cast<int>(score.size()) / 2 + 2 * padding;
  const std::string_view color = judge::keeps(judged, method.promise) ? "#2a7d2e" : "#b3261e";
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="20" role="img" font-family="sans-serif" font-size="12" fill="#fff">
<title>{1} in {2} queries, judged by Touchstone</title>
<rect width="{0}" height="20" rx="3" fill="#444"/>
<path d="M{3} 0h{4}a3 3 0 0 1 3 3v14a3 3 0 0 1 -3 3h-{4}z" fill="{5}"/>
<text x="{6}" y="14" textLength="{7}">Touchstone</text>
<text x="{8}" y="14" textLength="{9}">{1}</text>
</svg>
)",
      left + right, score, judged.queries, left, right - 3, color, padding, left - 2 * padding,
      left + padding, right - 2 * padding);
}

}  // namespace touchstone::verify::report
