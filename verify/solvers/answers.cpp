#include "verify/solvers/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::solvers {
namespace {

constexpr std::string_view header = "file,index,kind,verdict,toi_lower,toi_upper,tolerance,failure";
constexpr std::string_view header_without_failure = header.substr(0, header.rfind(','));

/// Numbers of the fields, counted from 1 as errors name them; 0 for the whole line.
enum class Column : std::uint64_t {
  whole_line,
  file,
  index,
  kind,
  verdict,
  toi_lower,
  toi_upper,
  tolerance,
  failure
};
constexpr std::size_t most_columns = 8;

using Fields = std::array<std::string, most_columns>;

}  // namespace

fast::Answer answer_of(const fast::CertifiedResult& result) {
  return {.verdict = result.verdict,
          .toi_lower = result.toi_lower,
          .toi_upper = result.toi_upper,
          .tolerance = fast::Answer::none};
}

std::string answers_header() { return std::string(header) + "\n"; }

std::string answer_row(std::string_view file, std::uint64_t index, AnyKind kind,
                       const fast::Answer& answer, const judge::Failure* failure) {
  const std::optional<judge::Failure> why =
      failure != nullptr ? std::optional(*failure) : judge::failure_of(answer);
  fast::Answer said = answer;
  if (why && why->kind == judge::Fault::not_finite)
    said = {.verdict = judge::verdict_of(why->kind)};
  const bool says_all = !why || why->kind == judge::Fault::undecided;
  return io::csv_row({std::string(file), std::to_string(index), std::string(to_string(kind)),
                      std::string(judge::to_string(said.verdict)), io::csv_number(said.toi_lower),
                      io::csv_number(said.toi_upper), io::csv_number(said.tolerance),
                      says_all ? std::string() : to_text(*why)});
}

/// Reads the file front to back, then puts the rows in order.
class AnswersReader {
 public:
  explicit AnswersReader(const std::filesystem::path& path) : lines_(path) {}

  RecordedAnswers read() {
    if (!next_record() || !is_header())
      fail(Column::whole_line,
           fmt::format("first line must be {}[,failure]", header_without_failure));
    columns_ = split_.count;
    while (next_record()) add_row();
    for (auto& [key, rows] : answers_.rows_) {
      if (!std::ranges::is_sorted(rows, {}, &Row::index)) std::ranges::sort(rows, before);
      check_unique(key, rows);
    }
    return std::move(answers_);
  }

 private:
  using Row = RecordedAnswers::Row;

  static bool before(const Row& a, const Row& b) {
    return std::pair(a.index, a.line) < std::pair(b.index, b.line);
  }

  [[noreturn]] void fail(Column column, const std::string& reason) const {
    const auto number = static_cast<std::uint64_t>(column);
    throw io::DatasetError(lines_.path(), {.line = line_number_, .column = number}, reason);
  }

  /// Splits the next record into fields_; false at the end of the file.
  bool next_record() {
    std::optional<io::Line> line = lines_.next();
    if (!line) return false;
    line_number_ = line->number;
    if (io::trimmed(line->text).empty())
      fail(Column::whole_line, "blank line before the end of the file");
    split_ = io::split_csv(line->text, fields_);
    if (split_.fault == io::CsvSplit::Fault::open_quote) {
      fail(Column{split_.count}, "quoted field does not end");
    }
    if (split_.fault == io::CsvSplit::Fault::text_after_quote) {
      fail(Column{split_.count}, "text after a quoted field");
    }
    return true;
  }

  [[nodiscard]] bool is_header() const {
    const std::size_t count = std::min(split_.count, most_columns);
    const std::string line = fmt::format("{}", fmt::join(std::span(fields_).first(count), ","));
    return split_.count == count && (line == header || line == header_without_failure);
  }

  [[nodiscard]] const std::string& raw(Column column) const {
    return fields_.at(static_cast<std::size_t>(column) - 1);
  }
  [[nodiscard]] std::string_view field(Column column) const { return io::trimmed(raw(column)); }

  void add_row() {
    if (split_.count != columns_) {
      fail(Column::whole_line, fmt::format("{} columns, expected {}", split_.count, columns_));
    }
    static constexpr std::uint64_t last_line = std::numeric_limits<std::uint32_t>::max();
    const fast::Verdict verdict = read_verdict();
    rows_of(read_kind())
        .push_back({.index = read_index(),
                    .toi_lower = read_time(Column::toi_lower, verdict),
                    .toi_upper = read_time(Column::toi_upper, verdict),
                    .tolerance = read_tolerance(),
                    .line = static_cast<std::uint32_t>(std::min(line_number_, last_line)),
                    .verdict = verdict,
                    .failure = read_failure(verdict),
                    .asked = false});
  }

  /// The group of the row at hand: nearly always that of the row before.
  RecordedAnswers::Rows& rows_of(AnyKind kind) {
    if (group_ == nullptr || group_->first.second != kind || group_field_ != raw(Column::file)) {
      group_field_ = raw(Column::file);
      if (group_field_.empty()) fail(Column::file, "no file name");
      group_ = &*answers_.rows_.try_emplace({io::text_of_field(group_field_), kind}).first;
    }
    return group_->second;
  }

  [[nodiscard]] std::uint64_t read_index() const {
    const std::string_view text = field(Column::index);
    const auto value = io::number_from_text<std::uint64_t>(text);
    if (!value) fail(Column::index, "index must be a whole number from 0 on: " + io::quote(text));
    return *value;
  }

  [[nodiscard]] AnyKind read_kind() const {
    try {
      return kind_from_string(field(Column::kind));
    } catch (const std::invalid_argument& error) {
      fail(Column::kind, std::string(error.what()) + ": " + io::quote(field(Column::kind)));
    }
  }

  [[nodiscard]] fast::Verdict read_verdict() const {
    for (const auto verdict :
         {fast::Verdict::no, fast::Verdict::yes, fast::Verdict::undecided, fast::Verdict::error}) {
      if (field(Column::verdict) == judge::to_string(verdict)) return verdict;
    }
    fail(Column::verdict,
         "verdict must be yes, no, undecided or error: " + io::quote(field(Column::verdict)));
  }

  /// The number in a field, if it is one: infinities and NaN are.
  [[nodiscard]] std::optional<double> read_number(Column column) const {
    return io::number_from_text<double>(field(column));
  }

  /// NaN where the field is empty, or the verdict is not yes.
  [[nodiscard]] double read_time(Column column, fast::Verdict verdict) const {
    if (field(column).empty()) return fast::Answer::none;
    const std::optional<double> value = read_number(column);
    const bool counts = verdict == fast::Verdict::yes;
    if (!value || (counts && !std::isfinite(*value))) {
      fail(column, "must be a finite double or empty: " + io::quote(field(column)));
    }
    return counts ? *value : fast::Answer::none;
  }

  /// NaN where the field is empty.
  [[nodiscard]] double read_tolerance() const {
    if (field(Column::tolerance).empty()) return fast::Answer::none;
    const std::optional<double> value = read_number(Column::tolerance);
    if (!value || std::isnan(*value)) {
      fail(Column::tolerance, "must be a double or empty: " + io::quote(field(Column::tolerance)));
    }
    if (*value < 0.0) fail(Column::tolerance, "tolerance must not be negative");
    return *value;
  }

  /// Nothing where the field is empty or not there.
  [[nodiscard]] std::optional<judge::Fault> read_failure(fast::Verdict verdict) const {
    if (columns_ < most_columns || field(Column::failure).empty()) return std::nullopt;
    const std::optional<judge::Failure> failure = judge::failure_from_text(field(Column::failure));
    if (!failure) {
      fail(Column::failure,
           "must be a kind of failure or empty: " + io::quote(field(Column::failure)));
    }
    if (judge::verdict_of(failure->kind) != verdict) {
      fail(Column::failure, fmt::format("the failure {} contradicts the verdict {}",
                                        to_string(failure->kind), judge::to_string(verdict)));
    }
    return failure->kind;
  }

  void check_unique(const RecordedAnswers::Key& key, const RecordedAnswers::Rows& rows) {
    const auto first = std::ranges::adjacent_find(rows, {}, &Row::index);
    if (first == rows.end()) return;
    line_number_ = std::next(first)->line;
    fail(Column::index,
         fmt::format("{} query {} of {} is answered in line {} already", to_string(key.second),
                     first->index, io::quote(key.first), first->line));
  }

  io::LineReader lines_;
  std::uint64_t line_number_ = 0;
  Fields fields_;
  io::CsvSplit split_;
  std::size_t columns_ = most_columns;
  RecordedAnswers answers_;
  std::pair<const RecordedAnswers::Key, RecordedAnswers::Rows>* group_ = nullptr;
  std::string group_field_;  // that named the group
};

std::optional<RecordedAnswer> RecordedAnswers::answer_to(std::string_view file, AnyKind kind,
                                                         std::uint64_t index) const {
  // The file has names as csv_field() writes them.
  const std::string name = io::is_printable(file) ? std::string() : io::printable(file);
  const auto group = rows_.find(std::pair(name.empty() ? file : std::string_view(name), kind));
  if (group == rows_.end()) return std::nullopt;
  const auto row = std::ranges::lower_bound(group->second, index, {}, &Row::index);
  if (row == group->second.end() || row->index != index) return std::nullopt;
  std::atomic_ref(row->asked).store(true, std::memory_order_relaxed);
  return RecordedAnswer{.answer = {.verdict = row->verdict,
                                   .toi_lower = row->toi_lower,
                                   .toi_upper = row->toi_upper,
                                   .tolerance = row->tolerance},
                        .failure = row->failure};
}

std::vector<RecordedAnswers::Group> RecordedAnswers::groups() const {
  std::vector<Group> result;
  for (const auto& [key, rows] : rows_) {
    const auto unasked = [](const Row& row) { return !row.asked; };
    const auto first = std::ranges::find_if(rows, unasked);
    result.push_back(
        {.file = key.first,
         .kind = key.second,
         .answers = rows.size(),
         .unasked = static_cast<std::uint64_t>(std::count_if(first, rows.end(), unasked)),
         .first_unasked_line = first == rows.end() ? 0 : first->line});
  }
  return result;
}

std::uint64_t RecordedAnswers::unasked() const {
  std::uint64_t sum = 0;
  for (const Group& group : groups()) sum += group.unasked;
  return sum;
}

RecordedAnswers load_answers(const std::filesystem::path& path) {
  return AnswersReader(path).read();
}

}  // namespace touchstone::verify::solvers
