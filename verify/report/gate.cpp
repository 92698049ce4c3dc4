#include "verify/report/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "touchstone/query.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/judge.hpp"
#include "verify/report/judgement_report.hpp"

namespace touchstone::verify::report {
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
    to.insert({method.name, result.name, std::string(to_string(result.shape.value().kind)),
               wrong.index, wrong.fault});
  }
}

/// True if the run has asked the solver about the query.
bool is_asked(const KnownAnswer& known, const std::vector<jobs::CertifyResult>& results) {
  return std::ranges::any_of(results, [&](const jobs::CertifyResult& result) {
    return result.name == known.file && result.shape &&
           to_string(result.shape->kind) == known.kind && known.index < result.queries &&
           std::ranges::find(result.methods, known.solver, &jobs::MethodResult::name) !=
               result.methods.end();
  });
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

KnownAnswers wrong_answers_of(const std::vector<jobs::CertifyResult>& results) {
  KnownAnswers all;
  for (const jobs::CertifyResult& result : results) {
    for (const jobs::MethodResult& method : result.methods) add_wrong_answers(all, result, method);
  }
  return all;
}

KnownAnswers read_baseline(const std::filesystem::path& path) {
  KnownAnswers known;
  try {
    const nlohmann::json json = io::read_json(path, most_bytes);
    for (const nlohmann::json& row : json.at("known")) {
      const auto fault = judge::fault_from_name(row.at(4).get<std::string>());
      if (!fault) throw std::invalid_argument("an unknown fault: " + row.at(4).dump());
      known.insert({row.at(0), row.at(1), row.at(2), row.at(3), *fault});
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
    const nlohmann::json row{one.solver, one.file, one.kind, one.index,
                             judge::to_string(one.fault)};
    rows += rows.empty() ? "\n" : ",\n";
    rows += row.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  }
  return fmt::format("{{\"known\": [{}\n]}}\n", rows);
}

BaselineChange change_of(const KnownAnswers& baseline,
                         const std::vector<jobs::CertifyResult>& results) {
  BaselineChange change{.fresh = {}, .mended = {}, .now = wrong_answers_of(results)};
  std::ranges::set_difference(change.now, baseline,
                              std::inserter(change.fresh, change.fresh.end()));
  for (const KnownAnswer& known : baseline) {
    if (change.now.contains(known)) continue;
    (is_asked(known, results) ? change.mended : change.now).insert(known);
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
