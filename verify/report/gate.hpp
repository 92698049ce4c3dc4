#pragma once

/// \file
/// A gate for changes of a solver: a baseline of its known wrong answers, so that only new ones
/// fail, and a badge with its score.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "verify/jobs/certify.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::report {

/// A wrong answer, by its query.
struct KnownAnswer {
  std::string solver;
  std::string file;  ///< or family
  std::string kind;  ///< "vertex-face" or "edge-edge"
  std::uint64_t index = 0;
  judge::Fault fault = judge::Fault::false_negative;

  friend auto operator<=>(const KnownAnswer&, const KnownAnswer&) = default;
};
using KnownAnswers = std::set<KnownAnswer>;

/// The answers that broke a promise.
/// \throws std::runtime_error if a solver has more of one fault in one file than are kept
/// (judge::Judgement::most_kept).
[[nodiscard]] KnownAnswers wrong_answers_of(const std::vector<jobs::CertifyResult>& results);

/// The known answers of a file as `baseline_document` writes it. \throws io::DatasetError
[[nodiscard]] KnownAnswers read_baseline(const std::filesystem::path& path);

/// JSON with an answer a line.
[[nodiscard]] std::string baseline_document(const KnownAnswers& known);

/// The difference between a baseline and a run.
struct BaselineChange {
  KnownAnswers fresh;   ///< wrong, and not in the baseline
  KnownAnswers mended;  ///< in the baseline, asked in this run, and no longer wrong
  KnownAnswers now;     ///< the baseline without `mended`, with `fresh`
};
[[nodiscard]] BaselineChange change_of(const KnownAnswers& baseline,
                                       const std::vector<jobs::CertifyResult>& results);

/// The change in some lines, the first answers of each sort by name.
[[nodiscard]] std::string to_text(const BaselineChange& change);

/// An SVG image with the numbers of misses and false alarms of a solver, green if it has kept its
/// promise, else red.
[[nodiscard]] std::string badge(const jobs::MethodResult& method);

}  // namespace touchstone::verify::report
