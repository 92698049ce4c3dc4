#include "verify/report/judgement_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/terms.hpp"

namespace touchstone::verify::report {
namespace {

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

}  // namespace

std::vector<io::TextColumn> fault_columns() {
  return {{"false neg", 9},    {"false pos", 9}, {"late toi", 8},
          {"early upper", 11}, {"undecided", 9}, {"errors", 7}};
}

io::TextRow fault_cells(const judge::Judgement& judgement) {
  return {std::to_string(judgement.count(judge::Fault::false_negative)),
          std::to_string(judgement.count(judge::Fault::false_positive)),
          std::to_string(judgement.count(judge::Fault::late_toi)),
          std::to_string(judgement.count(judge::Fault::early_toi_upper)),
          std::to_string(judgement.undecided()),
          std::to_string(judgement.errors())};
}

bool claims_too_much(const judge::Judgement& judgement) {
  return judgement.count(judge::Fault::beyond_tolerance) != 0;
}

io::TextColumn tolerance_column() { return {"beyond tol", 10}; }

std::string tolerance_cell(const judge::Judgement& judgement) {
  return std::to_string(judgement.count(judge::Fault::beyond_tolerance));
}

std::vector<io::TextColumn> toi_error_columns() {
  return {{"error p50", 9}, {"error p99", 9}, {"error max", 9}};
}

io::TextRow toi_error_cells(const judge::ToiErrors& errors) {
  return {io::error_text(errors.quantile(0.5)), io::error_text(errors.quantile(0.99)),
          io::error_text(errors.max())};
}

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

std::string_view common_name(judge::Fault fault) {
  if (fault == judge::Fault::false_negative) return "miss";
  if (fault == judge::Fault::false_positive) return "false alarm";
  if (fault == judge::Fault::late_toi || fault == judge::Fault::early_toi_upper) {
    return "wrong time";
  }
  return judge::to_text(fault);
}

std::string answer_text(const data::QueryPlace& place, std::string_view kind,
                        const judge::WrongAnswer& wrong) {
  std::string text =
      fmt::format("{}: {} query {}: answer {}, truth {}", io::printable(place.source), kind,
                  place.index, wrong.answer, wrong.truth);
  if (wrong.lateness) {
    text += fmt::format(", late by {:.1e}, {:.0f} ulp", wrong.lateness->step, wrong.lateness->ulps);
  }
  return text;
}

std::string wrong_answers_text(const NamedJudgement& named,
                               const std::function<data::QueryPlace(std::size_t)>& place_of) {
  const judge::Judgement& judgement = named.judgement;
  const std::string method = io::printable(named.method);
  std::string text;
  // By text: all errors together.
  std::map<std::string_view, std::uint64_t> printed;
  for (const std::size_t i : by_harm(judgement.wrong_answers, named.promise)) {
    const judge::WrongAnswer& wrong = judgement.wrong_answers[i];
    std::uint64_t& count = printed[judge::to_text(wrong.fault)];
    if (!judge::breaks(wrong.fault, named.promise) || count == most_printed) continue;
    ++count;
    text += fmt::format("{}: {}: {}\n", judge::to_text(wrong.fault), method,
                        answer_text(place_of(i), named.kind, wrong));
  }
  for (const judge::Fault fault : judge::all_faults) {
    const auto count = printed.extract(judge::to_text(fault));
    const std::uint64_t all = judgement.total(fault);
    if (count.empty() || count.mapped() != most_printed || all == most_printed) continue;
    text += fmt::format("{}: {}: {}: and {} more\n", judge::to_text(fault), method,
                        io::printable(named.group), all - most_printed);
  }
  return text;
}

std::string to_text(const FailureCounts& failures) {
  std::string text;
  for (const judge::Fault kind : judge::all_failures) {
    const std::uint64_t count = failures[static_cast<std::size_t>(kind)];
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, judge::to_string(kind));
  }
  return text;
}

std::string reading_text(std::uint64_t skipped, std::uint64_t rounded) {
  std::string text;
  if (skipped != 0) text += fmt::format("{} queries in error skipped\n", skipped);
  if (rounded != 0) text += fmt::format("{} coordinates rounded to double\n", rounded);
  return text;
}

nlohmann::json to_json(const judge::Judgement& judgement) {
  return {{"false_negatives", judgement.count(judge::Fault::false_negative)},
          {"false_positives", judgement.count(judge::Fault::false_positive)},
          {"late_toi", judgement.count(judge::Fault::late_toi)},
          {"early_toi_upper", judgement.count(judge::Fault::early_toi_upper)},
          {"beyond_tolerance", judgement.count(judge::Fault::beyond_tolerance)},
          {"undecided", judgement.undecided()},
          {"errors", judgement.errors()},
          {"outside", judgement.outside},
          {"left_out", judgement.left_out},
          {"toi_error", judge::to_json(judgement.toi_errors)},
          {"late", to_json(judgement.late)}};
}

nlohmann::json to_json(const judge::LateTimes& late) {
  return {{"count", late.count},
          {"beyond", late.beyond},
          {"greatest", io::number_to_json(late.greatest.step)},
          {"greatest_ulps", io::number_to_json(late.greatest.ulps)}};
}

nlohmann::json to_json(const judge::WrongAnswer& wrong) {
  return {{"index", wrong.index},
          {"fault", judge::to_text(wrong.fault)},
          {"answer", wrong.answer},
          {"truth", wrong.truth}};
}

nlohmann::json to_json(const FailureCounts& failures) {
  nlohmann::json json = nlohmann::json::object();
  for (const judge::Fault kind : judge::all_failures) {
    json[judge::to_string(kind)] = failures[static_cast<std::size_t>(kind)];
  }
  return json;
}

}  // namespace touchstone::verify::report
