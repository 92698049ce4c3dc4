#include "verify/data/ground_truth_files.hpp"

#include <fmt/core.h>

#include <fmt/format.h>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "verify/io/coordinate_text.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {
namespace {

constexpr int end_of_file = -1;

bool is_word_character(int c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' ||
         c == '-' || c == '.';
}

/// Splits a line of two columns; false if it has another number.
bool split_fields(std::string_view line, std::array<std::string, 2>& fields) {
  const io::CsvSplit split = io::split_csv(line, fields);
  return split.count == fields.size() && split.fault == io::CsvSplit::Fault::none;
}

std::optional<std::filesystem::path> find_companion(const std::filesystem::path& dataset,
                                                    const std::string& folder,
                                                    const std::string& ending) {
  const std::filesystem::path directory = dataset.parent_path();
  const std::string name = dataset_stem(dataset) + ending;
  for (const auto& candidate :
       {directory / ".." / folder / name, directory / folder / name, directory / name}) {
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::status(candidate, error))) return candidate;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> find_labels(const std::filesystem::path& dataset) {
  return find_companion(dataset, "mma_bool", "_mma_bool.json");
}

std::optional<std::filesystem::path> find_tois(const std::filesystem::path& dataset) {
  return find_companion(dataset, "toi", "_toi.csv");
}

}  // namespace

LabelReader::LabelReader(std::filesystem::path path) : file_(std::move(path)) {
  end_ = file_.read_all(buffer_);
  const std::string_view begin(buffer_.data(), end_);
  begin_ = begin.size() - io::without_byte_order_mark(begin, file_.path()).size();
  if (skip_whitespace() != '[') fail("expected a JSON array of booleans");
  take();
}

bool LabelReader::at(std::uint64_t index) {
  if (broken_) throw io::DatasetError(*broken_);
  while (elements_ <= index) {
    const std::optional<Element> element = next_element();
    if (!element) {
      throw io::DatasetError(
          path(), position_,
          fmt::format("no label for query {}: the array has only {}", index, elements_));
    }
    if (elements_ <= index) continue;
    if (element->text == "true" || element->text == "1") return true;
    if (element->text == "false" || element->text == "0") return false;
    throw io::DatasetError(path(), element->position, "not a boolean: " + io::quote(element->text));
  }
  throw std::logic_error("labels are read in ascending order");
}

std::optional<io::DatasetError> LabelReader::beyond(std::uint64_t count) {
  if (broken_ || closed_) return std::nullopt;
  try {
    while (const std::optional<Element> element = next_element()) {
      if (elements_ > count) {
        return io::DatasetError(path(), element->position,
                                fmt::format("more labels than the {} queries", count));
      }
    }
    take();
    if (skip_whitespace() != end_of_file) fail("expected nothing after the array");
  } catch (const io::DatasetError& fault) {
    return fault;
  }
  return std::nullopt;
}

/// The next element; empty at the closing bracket, at which the position stays.
std::optional<LabelReader::Element> LabelReader::next_element() {
  if (closed_) return std::nullopt;
  int c = skip_whitespace();
  if (c == ']') {
    closed_ = true;
    return std::nullopt;
  }
  if (elements_ > 0) {
    if (c != ',') fail("expected ',' or ']'");
    take();
    c = skip_whitespace();
  }
  if (!is_word_character(c)) fail("expected true or false");
  Element element = read_word();
  ++elements_;
  return element;
}

LabelReader::Element LabelReader::read_word() {
  static constexpr std::size_t longest_word = 64;
  Element element{.text = {}, .position = position_};
  for (int c = peek(); is_word_character(c); c = peek()) {
    if (element.text.size() == longest_word) fail("expected true or false");
    element.text += static_cast<char>(c);
    take();
  }
  return element;
}

/// The next byte, which stays, or end_of_file.
int LabelReader::peek() {
  if (begin_ == end_) {
    begin_ = 0;
    end_ = file_.read(buffer_);
    if (end_ == 0) return end_of_file;
  }
  return static_cast<unsigned char>(buffer_.at(begin_));
}

void LabelReader::take() {
  if (peek() == '\n') {
    position_ = {.line = position_.line + 1, .column = 1};
  } else {
    ++position_.column;
  }
  ++begin_;
}

int LabelReader::skip_whitespace() {
  int c = peek();
  for (; c == ' ' || c == '\t' || c == '\r' || c == '\n'; c = peek()) take();
  return c;
}

void LabelReader::fail(const std::string& reason) {
  broken_.emplace(path(), position_, reason);
  throw io::DatasetError(*broken_);
}

ToiReader::ToiReader(std::filesystem::path path) : lines_(std::move(path)) {
  const std::optional<io::Line> header = lines_.next();
  if (!header) throw io::DatasetError(lines_.path(), {}, "expected the header query,toi");
  std::array<std::string, 2> fields;
  if (!split_fields(header->text, fields) || io::trimmed(fields[0]) != "query" ||
      io::trimmed(fields[1]) != "toi") {
    throw io::DatasetError(lines_.path(), {.line = 1}, "expected the header query,toi");
  }
}

std::optional<exact::Rational> ToiReader::at(std::uint64_t index) {
  if (broken_) throw io::DatasetError(*broken_);
  seek(index);
  if (!entry_ || entry_->query != index) return std::nullopt;
  try {
    return exact::rational_from_decimal(entry_->decimal);
  } catch (const std::invalid_argument&) {
    throw io::DatasetError(lines_.path(), {.line = entry_->line, .column = 2},
                           io::fault_of_decimal(entry_->decimal));
  }
}

std::optional<io::DatasetError> ToiReader::beyond(std::uint64_t count) {
  if (broken_) return std::nullopt;
  try {
    seek(count);
  } catch (const io::DatasetError& fault) {
    return fault;
  }
  if (!entry_) return std::nullopt;
  return io::DatasetError(
      lines_.path(), {.line = entry_->line, .column = 1},
      fmt::format("toi of query {}, but there are {} queries", entry_->query, count));
}

void ToiReader::seek(std::uint64_t index) {
  try {
    while (!ended_ && (!entry_ || entry_->query < index)) {
      entry_ = next_entry();
      ended_ = !entry_;
    }
  } catch (const io::DatasetError& fault) {
    broken_ = fault;
    throw;
  }
}

std::optional<ToiReader::Entry> ToiReader::next_entry() {
  const std::optional<io::Line> line = lines_.next();
  if (!line) return std::nullopt;
  std::array<std::string, 2> fields;
  if (!split_fields(line->text, fields)) {
    fail({.line = line->number}, "expected two columns, query and toi");
  }
  const std::string_view query_text = io::trimmed(fields[0]);
  const std::optional<std::uint64_t> query = io::number_from_text<std::uint64_t>(query_text);
  const io::FilePosition position{.line = line->number, .column = 1};
  if (!query) fail(position, "not a query number: " + io::quote(query_text));
  if (entry_ && *query <= entry_->query) fail(position, "query numbers do not ascend");
  return Entry{
      .query = *query, .decimal = std::string(io::trimmed(fields[1])), .line = line->number};
}

void ToiReader::fail(io::FilePosition position, const std::string& reason) const {
  throw io::DatasetError(lines_.path(), position, reason);
}

std::string dataset_stem(const std::filesystem::path& dataset) {
  const std::filesystem::path stem = dataset.stem();
  return (dataset.extension() == ".zst" ? stem.stem() : stem).string();
}

std::vector<std::filesystem::path> find_ground_truth_files(const std::filesystem::path& dataset) {
  std::vector<std::filesystem::path> paths;
  for (const auto& path : {find_labels(dataset), find_tois(dataset)}) {
    if (path) paths.push_back(*path);
  }
  if (const auto path = find_separation_file(dataset)) paths.push_back(*path);
  return paths;
}

GroundTruthFiles::GroundTruthFiles(const std::filesystem::path& dataset) {
  if (auto path = find_labels(dataset)) labels_.emplace(*path);
  if (auto path = find_tois(dataset)) tois_.emplace(*path);
}

RecordedTruth GroundTruthFiles::at(std::uint64_t index) {
  RecordedTruth truth;
  if (labels_) truth.collides = labels_->at(index);
  if (tois_) truth.toi = tois_->at(index);
  return truth;
}

std::vector<io::DatasetError> GroundTruthFiles::beyond(std::uint64_t count) {
  std::vector<io::DatasetError> faults;
  if (labels_) {
    if (auto fault = labels_->beyond(count)) faults.push_back(*fault);
  }
  if (tois_) {
    if (auto fault = tois_->beyond(count)) faults.push_back(*fault);
  }
  return faults;
}

std::filesystem::path GroundTruthFiles::label_path() const {
  return labels_ ? labels_->path() : std::filesystem::path();
}

// ---- Writing ------------------------------------------------------------------------------------

namespace {

exact::Integer power_of_ten(long exponent) {
  exact::Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(exponent));
  return power;
}

/// x · 10^exponent.
exact::Rational scaled(const exact::Rational& x, long exponent) {
  return exponent >= 0 ? exact::Rational(x * power_of_ten(exponent))
                       : exact::Rational(x / power_of_ten(-exponent));
}

/// A positive number as `digits` · 10^exponent.
struct Decimal {
  exact::Integer digits;
  long exponent;
};

/// n / 2^k = n · 5^k / 10^k.
Decimal exact_decimal(const exact::Rational& x) {
  const auto k = mpz_scan1(x.get_den_mpz_t(), 0);
  exact::Integer factor;
  mpz_ui_pow_ui(factor.get_mpz_t(), 5, k);
  return {.digits = x.get_num() * factor, .exponent = -static_cast<long>(k)};
}

Decimal rounded_decimal(const exact::Rational& x, long digits) {
  const auto decimal_digits = [](const exact::Integer& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 10));
  };
  // sizeinbase may be one too large, so the quotient's length is known but for one digit each way.
  long exponent = decimal_digits(x.get_num()) - decimal_digits(x.get_den()) + 1 - digits;
  while (scaled(x, -exponent) < power_of_ten(digits - 1)) --exponent;
  while (scaled(x, -exponent) >= power_of_ten(digits)) ++exponent;
  const exact::Rational shifted = scaled(x, -exponent) + exact::Rational(1, 2);
  return {.digits = shifted.get_num() / shifted.get_den(), .exponent = exponent};
}

/// value ≠ 0 has the sign of `value` and the magnitude of `decimal`.
std::string text(const exact::Rational& value, const Decimal& decimal) {
  const std::string digits = decimal.digits.get_str();
  std::string mantissa = digits.substr(0, digits.find_last_not_of('0') + 1);
  if (mantissa.size() > 1) mantissa.insert(1, ".");
  const long exponent = decimal.exponent + static_cast<long>(digits.size()) - 1;
  return (value < 0 ? "-" : "") + mantissa + "E" + std::to_string(exponent);
}

}  // namespace

std::string to_decimal(const exact::Rational& value, unsigned significant_digits) {
  if (value == 0) return "0";
  return text(value, rounded_decimal(abs(value), significant_digits));
}

std::string to_decimal(const exact::Rational& value) {
  if (value == 0) return "0";
  const bool dyadic = mpz_popcount(value.get_den_mpz_t()) == 1;
  if (!dyadic) return to_decimal(value, rounded_digits);
  return text(value, exact_decimal(abs(value)));
}

ToiWriter::ToiWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write("query,toi\n");
}

void ToiWriter::write(std::uint64_t query, const exact::Rational& toi) {
  if (last_query_ && query <= *last_query_) {
    throw std::invalid_argument("query numbers must ascend");
  }
  file_.write(fmt::format("{},{}\n", query, to_decimal(toi)));
  last_query_ = query;
}

namespace {

namespace fs = std::filesystem;

constexpr std::string_view file_name = "separation.json";
constexpr std::size_t most_bytes = std::size_t{1} << 16U;
constexpr const char* distance_key = "min_separation";
constexpr const char* norm_key = "norm";

/// True if there is a digit other than 0 before the exponent.
bool has_value(std::string_view text) {
  const bool is_hexadecimal = text.find_first_of("xX") != std::string_view::npos;
  const std::size_t end = text.find_first_of(is_hexadecimal ? "pP" : "eE");
  return text.substr(0, end).find_first_of("123456789abcdefABCDEF") != std::string_view::npos;
}

/// Parses the file; of its keys at the top none may be unknown.
nlohmann::json parse(const fs::path& path) {
  const auto check_key = [&](int depth, nlohmann::json::parse_event_t event,
                             const nlohmann::json& value) {
    if (event != nlohmann::json::parse_event_t::key || depth != 1) return true;
    const auto key = value.get<std::string>();
    if (key != distance_key && key != norm_key) {
      throw io::DatasetError(path, {},
                             fmt::format("unknown key {}, expected {} and {}", io::quote(key),
                                         distance_key, norm_key));
    }
    return true;
  };
  return io::read_json(path, most_bytes, check_key);
}

}  // namespace

std::optional<double> distance_from_text(const std::string& text) {
  if (text.empty() || std::isspace(static_cast<unsigned char>(text.front())) != 0) {
    return std::nullopt;
  }
  char* end = nullptr;
  const double distance = std::strtod(text.c_str(), &end);
  const bool is_read = end == text.c_str() + text.size();
  if (!is_read || !is_valid({.distance = distance})) return std::nullopt;
  if (distance == 0.0 && has_value(text)) return std::nullopt;
  // −0 is the distance 0.
  return distance == 0.0 ? 0.0 : distance;
}

std::optional<fs::path> find_separation_file(const fs::path& dataset) {
  const fs::path folder = dataset.parent_path();
  for (const fs::path& path : {folder / file_name, folder / ".." / file_name}) {
    // Opening the file reports any other error.
    std::error_code error;
    if (fs::status(path, error).type() != fs::file_type::not_found) return path;
  }
  return std::nullopt;
}

Separation read_separation(const fs::path& path) {
  try {
    const nlohmann::json json = parse(path);
    const auto distance = distance_from_text(json.at(distance_key).get<std::string>());
    if (!distance) throw io::DatasetError(path, {}, "min_separation must be a finite number ≥ 0");
    return {.distance = *distance, .norm = norm_from_string(json.at(norm_key).get<std::string>())};
  } catch (const nlohmann::json::exception& error) {
    throw io::DatasetError(path, {}, "not a separation: " + io::reason_of(error));
  } catch (const std::invalid_argument& error) {
    throw io::DatasetError(path, {}, error.what());
  }
}

Separation recorded_separation(const fs::path& dataset) {
  const auto path = find_separation_file(dataset);
  return path ? read_separation(*path) : Separation{};
}

void write_separation(const fs::path& folder, const Separation& separation) {
  io::OutputFile file(folder / file_name);
  file.write(fmt::format("{{\"min_separation\": \"{:a}\", \"norm\": \"{}\"}}\n",
                         separation.distance, to_string(separation.norm)));
  file.close();
}

}  // namespace touchstone::verify::data
