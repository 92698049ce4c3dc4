#pragma once

/// \file
/// Faults of a method's answers in words, in tables and as JSON: the same for every command
/// that judges.

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "verify/data/query_source.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::report {

// ---- Text ---------------------------------------------------------------------------------------

/// The columns of false negatives, false positives, late and early times of impact, undecided
/// answers and errors.
[[nodiscard]] std::vector<io::TextColumn> fault_columns();
/// Their cells.
[[nodiscard]] io::TextRow fault_cells(const judge::Judgement& judgement);

/// True if a yes is beyond its tolerance.
[[nodiscard]] bool claims_too_much(const judge::Judgement& judgement);
/// The column of these answers, for tables that have it only if there are some.
[[nodiscard]] io::TextColumn tolerance_column();
/// Its cell.
[[nodiscard]] std::string tolerance_cell(const judge::Judgement& judgement);

/// The columns of the errors of times of impact: median, 99th percentile, maximum.
[[nodiscard]] std::vector<io::TextColumn> toi_error_columns();
/// Their cells.
[[nodiscard]] io::TextRow toi_error_cells(const judge::ToiErrors& errors);

/// A judgement, and the names under which it is printed.
struct NamedJudgement {
  std::string_view method;
  fast::Promise promise = fast::Promise::none;
  const judge::Judgement& judgement;
  std::string_view group;  ///< of the queries
  std::string_view kind;   ///< of the queries
};

/// "12 late, 5 by more than 1e-12, …; at most by 0.3 of the step, 7 ulp"; empty if none is.
[[nodiscard]] std::string late_text(const judge::LateTimes& late);

/// The queries that were not asked because of the terms, and for lack of time; empty if all were.
[[nodiscard]] std::string unasked_text(const judge::Judgement& judgement, const fast::Terms& terms);

/// The fault of an answer in common words: "miss", "false alarm", "wrong time", or as
/// judge::to_text.
[[nodiscard]] std::string_view common_name(judge::Fault fault);

/// "SOURCE: vertex-face query 4: answer no, truth collision at 0.5".
[[nodiscard]] std::string answer_text(const data::QueryPlace& place, std::string_view kind,
                                      const judge::WrongAnswer& wrong);

/// The answers that broke the promise, the worst first, a line each: the fault ("false negative"),
/// the method and answer_text; the first twenty of a fault, then the number of further ones.
/// \param place_of the source of the query of a wrong answer, by the answer's position in
/// Judgement::wrong_answers.
[[nodiscard]] std::string wrong_answers_text(
    const NamedJudgement& named, const std::function<data::QueryPlace(std::size_t)>& place_of);

using FailureCounts = std::array<std::uint64_t, judge::fault_count>;

/// "1 crash, 2 undecided": the number of each kind; empty if there are none.
[[nodiscard]] std::string to_text(const FailureCounts& failures);

/// Exceptions from reading, a line each: queries in error, and rounded coordinates. Empty if all
/// was.
[[nodiscard]] std::string reading_text(std::uint64_t skipped, std::uint64_t rounded);

// ---- JSON ---------------------------------------------------------------------------------------

/// `false_negatives`, `false_positives` (undecided answers among them), `late_toi`,
/// `early_toi_upper`, `beyond_tolerance`, `undecided`, `errors`, `outside` and `left_out` (queries
/// that were not asked: Judgement), `late` (see below), and `toi_error`: null where no
/// time of impact was given, else `count`, `p50`, `p90`, `p99`, `max` and `histogram`
/// (judge::ToiErrors) of the distance from toi_lower to the exact time of impact, quantiles to
/// 1.6%.
[[nodiscard]] nlohmann::json to_json(const judge::Judgement& judgement);

/// The times later than the exact ones: their `count`, `beyond` (the numbers of those later by more
/// than 1e-12, 1e-9, 1e-6 and 1e-3 of the step), `greatest` in units of the step, and
/// `greatest_ulps`.
[[nodiscard]] nlohmann::json to_json(const judge::LateTimes& late);

/// `index`, `fault` (its text, verify/judge/fault.hpp), `answer` and `truth`.
[[nodiscard]] nlohmann::json to_json(const judge::WrongAnswer& wrong);

/// The number of queries without an answer by the name of the failure.
[[nodiscard]] nlohmann::json to_json(const FailureCounts& failures);

}  // namespace touchstone::verify::report
