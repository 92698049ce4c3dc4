#pragma once

/// \file
/// A judgement for people (a summary, or a table), for machines (JSON), and as a dataset of its own
/// (the truth).

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "verify/jobs/certify.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::report {

/// With a separation, a line that names it (one for each source where they differ), and a line on
/// the comparison if the recorded answers are about another one. Then a line for each source and
/// one for the total, then each mismatch with source, index and both answers. If solvers were
/// judged, a line for each with its total follows; below it a line for each source where it broke
/// its promise, the number of its failures of each kind (if there are any but undecided answers of
/// its own), and the answers that broke its promise: the first twenty of a fault and source, and
/// the number of further ones.
[[nodiscard]] std::string to_text(const std::vector<jobs::CertifyResult>& results);

/// The same in few lines and common words: the queries that were asked, the recorded answers that
/// are wrong, a line for each solver with its misses (false negatives), false alarms (false
/// positives and undecided answers), wrong times, missing answers and time, and the worst wrong
/// answers, of each solver some.
/// \param most_lines with less than a dozen solvers there are no more than these
[[nodiscard]] std::string to_summary(const std::vector<jobs::CertifyResult>& results,
                                     std::size_t most_lines);

/// The total's fields `queries`, `collisions`, `labels`, `label_mismatches`, `tois`,
/// `toi_mismatches`, `us_per_query`, `skipped`, `rounded`, `errors` (that ended the reading of a
/// file), `interrupted`; `mismatches`, a list of objects with `file`, `index`, `kind`, `of`
/// ("label" or "toi"), `recorded` and `truth`; `files`, a list with the total's fields a source,
/// its name as `file`, its `kind`, `degree` and `rational` if it is on curves, and `error` if one
/// ended the reading.
///
/// The total (if it is that of all sources) and each file have their separation as `separation`, an
/// object of `min_separation` and `norm`, and each file has `compared`: "all",
/// "collisions" (recorded about another separation, so only these are compared) or "nothing".
///
/// `methods`, in the total and in each file, is a list of `name`, `promise` (by which it was
/// judged: "none", "conservative", "exact"), its `terms` (as options of the command line),
/// `queries`, the fields of a judgement (judgement_report.hpp), `missing`, `failures` (an object of
/// the number of queries without an answer by the name of the failure), `unplaced_crashes` (errors
/// at no particular query), `beyond_tolerance` and `ns_per_query` (null where no time was taken).
/// In the total each has `wrong_answers`, a list of `file`, `index`, `kind`, `fault`, `answer` and
/// `truth`, of each source and fault the first Judgement::most_kept.
[[nodiscard]] nlohmann::json to_json(const std::vector<jobs::CertifyResult>& results);

/// The answers of a solver without a truth: their number by verdict, those that are missing, by the
/// reason, and their time. A missing answer counts as undecided or as an error
/// (judge::verdict_of).
[[nodiscard]] std::string answers_to_text(const jobs::MethodResult& method);

/// The same: `method`, `queries`, `yes`, `no`, `undecided`, `errors`, `unasked`, `failures`,
/// `unplaced_crashes`, `ns_per_query`.
[[nodiscard]] nlohmann::json answers_to_json(const jobs::MethodResult& method);

/// The header of the truth as CSV: `file,index,kind,collides,toi_lower,toi_upper`.
[[nodiscard]] std::string truth_header();

/// A row of it: collides as 0 or 1, the ends of the enclosure (neighbouring doubles or equal) with
/// as many digits as give the same double again, empty without collision. The file's name is quoted
/// where CSV demands it.
[[nodiscard]] std::string truth_row(const std::string& file, AnyKind kind,
                                    const judge::GroundTruth& truth);

// A gate for changes of a solver: a baseline of its known wrong answers, so that only new ones
// fail, and a badge with its score.

/// A wrong answer, by its query.
struct KnownAnswer {
  std::string solver;
  std::string file;  ///< or family
  std::string kind;  ///< "vertex-face" and so on
  std::uint64_t index = 0;
  double distance = 0.0;  ///< the minimum separation that was asked, in
  std::string norm;       ///< "linf" or "l2"; of contact l2, as both are the same
  judge::Fault fault = judge::Fault::false_negative;

  friend auto operator<=>(const KnownAnswer&, const KnownAnswer&) = default;
};
/// Those about one query are neighbours.
using KnownAnswers = std::set<KnownAnswer>;

/// The key of the answers of a solver to a query; its fault is the first of all.
[[nodiscard]] KnownAnswer known_query(const std::string& solver, const std::string& file,
                                      AnyKind kind, std::uint64_t index,
                                      const Separation& separation);

/// Adds the known answers about that query to others.
void add_of_query(const KnownAnswers& known, const KnownAnswer& query, KnownAnswers& to);

/// The known answers of a file as `baseline_document` writes it; those without a separation are
/// about contact. \throws io::DatasetError
[[nodiscard]] KnownAnswers read_baseline(const std::filesystem::path& path);

/// JSON with an answer a line.
[[nodiscard]] std::string baseline_document(const KnownAnswers& known);

/// The difference between a baseline and a run.
struct BaselineChange {
  KnownAnswers fresh;   ///< wrong, and not in the baseline
  KnownAnswers mended;  ///< in the baseline, asked in this run, and no longer wrong
  KnownAnswers now;     ///< the baseline without `mended`, with `fresh`
};
/// \param asked those of the baseline whose queries this run has asked
/// \throws std::runtime_error if a solver has more answers of one fault in one file than are kept
/// (judge::Judgement::most_kept).
[[nodiscard]] BaselineChange change_of(const KnownAnswers& baseline, const KnownAnswers& asked,
                                       const std::vector<jobs::CertifyResult>& results);

/// The change in some lines, the first answers of each sort by name.
[[nodiscard]] std::string to_text(const BaselineChange& change);

/// An SVG image with the numbers of misses and false alarms of a solver, green if it has kept its
/// promise, else red.
[[nodiscard]] std::string badge(const jobs::MethodResult& method);

}  // namespace touchstone::verify::report
