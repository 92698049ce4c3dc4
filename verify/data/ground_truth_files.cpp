#include "verify/data/ground_truth_files.hpp"

#include <fmt/core.h>

#include <fmt/format.h>
#include <array>
#include <cctype>
#include <cerrno>
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

constexpr std::size_t most_label_bytes = std::size_t{1} << 30U;

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

Labels::Labels(std::filesystem::path path) : path_(std::move(path)) {
  const auto fail = [&](const std::string& reason) {
    throw io::DatasetError(path_, {},
                           reason + "; mend the file, or move it to read queries without labels");
  };
  nlohmann::json json;
  try {
    json = io::read_json(path_, most_label_bytes);
  } catch (const io::DatasetError& error) {
    fail(error.reason());
  }
  if (!json.is_array()) fail("expected a JSON array of booleans");
  for (const nlohmann::json& label : json) {
    if (!label.is_boolean() && label != 0 && label != 1) {
      fail(fmt::format("label {} is no boolean: {}", labels_.size(), io::quote(label.dump())));
    }
    labels_.push_back(label == true || label == 1);
  }
}

bool Labels::at(std::uint64_t index) const {
  if (index < labels_.size()) return labels_[index];
  throw io::DatasetError(
      path_, {}, fmt::format("no label for query {}: there are only {}", index, labels_.size()));
}

void Labels::end(std::uint64_t count) const {
  if (labels_.size() <= count) return;
  throw io::DatasetError(path_, {},
                         fmt::format("{} labels, but {} queries", labels_.size(), count));
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
  if (!seek(index) || entry_->query != index) return std::nullopt;
  try {
    return exact::rational_from_decimal(entry_->decimal);
  } catch (const std::invalid_argument&) {
    throw io::DatasetError(lines_.path(), {.line = entry_->line, .column = 2},
                           io::fault_of_decimal(entry_->decimal));
  }
}

void ToiReader::end(std::uint64_t count) {
  if (!seek(count)) return;
  throw io::DatasetError(
      lines_.path(), {.line = entry_->line, .column = 1},
      fmt::format("toi of query {}, but there are {} queries", entry_->query, count));
}

bool ToiReader::seek(std::uint64_t index) {
  while (!entry_ || entry_->query < index) {
    if (lines_.at_end()) return false;
    entry_ = read_entry();
  }
  return true;
}

ToiReader::Entry ToiReader::read_entry() {
  const io::Line line = lines_.next().value();
  const auto fail = [&](std::uint64_t column, const std::string& reason) {
    throw io::DatasetError(lines_.path(), {.line = line.number, .column = column}, reason);
  };
  std::array<std::string, 2> fields;
  if (!split_fields(line.text, fields)) fail(0, "expected two columns, query and toi");
  const std::string_view query_text = io::trimmed(fields[0]);
  const auto query = io::number_from_text<std::uint64_t>(query_text);
  if (!query) fail(1, "not a query number: " + io::quote(query_text));
  if (entry_ && *query <= entry_->query) fail(1, "query numbers do not ascend");
  return {
      .query = query.value(), .decimal = std::string(io::trimmed(fields[1])), .line = line.number};
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

void GroundTruthFiles::end(std::uint64_t count) {
  if (labels_) labels_->end(count);
  if (tois_) tois_->end(count);
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

}  // namespace

std::optional<double> distance_from_text(const std::string& text) {
  if (text.empty() || std::isspace(static_cast<unsigned char>(text.front())) != 0) {
    return std::nullopt;
  }
  char* end = nullptr;
  errno = 0;
  const double distance = std::strtod(text.c_str(), &end);
  const bool is_read = end == text.c_str() + text.size();
  if (!is_read || !is_valid({.distance = distance})) return std::nullopt;
  if (distance == 0.0 && errno == ERANGE) return std::nullopt;
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
    const nlohmann::json json = io::read_json(path, most_bytes);
    const auto distance = distance_from_text(json.at(distance_key).get<std::string>());
    if (json.size() != 2) {
      throw io::DatasetError(path, {}, "expected min_separation and norm, and nothing else");
    }
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
