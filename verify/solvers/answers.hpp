#pragma once

/// \file
/// The file of a solver's answers, from us or from anywhere: CSV, a row a query,
///
///     file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure
///
/// file: its path, printable (printable.hpp). verdict: yes, no, undecided or error. The next three
/// fields are empty where a solver gives no value. failure: the reason for a missing answer
/// (fault.hpp: "crash: SIGSEGV", "hang", …), else empty; the column is optional. File, index and
/// kind together identify a query: the families of the built-in set have queries of both kinds
/// under one name.

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/certified.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::solvers {

/// The decision of the certified solver as an answer.
[[nodiscard]] fast::Answer answer_of(const fast::CertifiedResult& result);

/// The first line of the file, with its line end.
[[nodiscard]] std::string answers_header();

/// A row of the file, with its line end. Numbers have as many digits as give the same double again.
/// \param failure the reason for a missing answer; null: as the answer shows (failure_of); then an
/// answer that is not finite becomes an error, and an undecided one has an empty field
[[nodiscard]] std::string answer_row(std::string_view file, std::uint64_t index, AnyKind kind,
                                     const fast::Answer& answer,
                                     const judge::Failure* failure = nullptr);

/// An answer of such a file.
struct RecordedAnswer {
  fast::Answer answer = {};
  /// Its kind, if one was recorded.
  std::optional<judge::Fault> failure = std::nullopt;
};

/// Answers read from such a file. Forty bytes an answer.
class RecordedAnswers {
 public:
  /// The records of the file under one name and kind.
  struct Group {
    std::string file;
    AnyKind kind;
    std::uint64_t answers;
    /// The number of these that answer_to() never returned: answers to queries that do not exist.
    std::uint64_t unasked;
    /// Line of the first of them in the order of indices; 0 if there are none.
    std::uint64_t first_unasked_line;
  };

  /// The answer to a query, if there is one, which then counts as asked for. May be called from
  /// several threads at once.
  [[nodiscard]] std::optional<RecordedAnswer> answer_to(std::string_view file, AnyKind kind,
                                                        std::uint64_t index) const;

  /// All groups, ordered by name and kind. Not to be called while another thread is in answer_to().
  [[nodiscard]] std::vector<Group> groups() const;

  /// Answers never asked for. Not to be called while another thread is in answer_to().
  [[nodiscard]] std::uint64_t unasked() const;

 private:
  friend class AnswersReader;

  struct Row {
    std::uint64_t index;
    double toi_lower, toi_upper, tolerance;
    std::uint32_t line;
    fast::Verdict verdict;
    std::optional<judge::Fault> failure;
    mutable bool asked;
  };
  static_assert(sizeof(Row) == 40);

  /// A deque grows without a second copy of its rows.
  using Rows = std::deque<Row>;
  using Key = std::pair<std::string, AnyKind>;
  struct KeyLess {
    using is_transparent = void;  // NOLINT(readability-identifier-naming): the library's name
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return std::pair<std::string_view, AnyKind>(a) < std::pair<std::string_view, AnyKind>(b);
    }
  };

  /// Ascending indices in each.
  std::map<Key, Rows, KeyLess> rows_;
};

/// Reads a file of answers. The header must have these columns in this order, the last one or not;
/// rows may come in any order, lines may end in LF or CRLF, and names (or any other field) may
/// stand in quotes. Times of impact are finite decimal numbers or
/// empty; their range is not checked here, but by the judge. A failure must agree with the verdict
/// (verdict_of). Times with any other verdict than yes may be any number and are dropped: solvers
/// write 1, infinity or the last step there. Tolerances are numbers from 0 on, or empty; one of
/// "inf" claims nothing.
/// \throws DatasetError that names line, column (number of the field) and reason, for everything
/// else, and for two rows that answer the same query.
[[nodiscard]] RecordedAnswers load_answers(const std::filesystem::path& path);

}  // namespace touchstone::verify::solvers
