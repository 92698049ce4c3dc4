#include "verify/view/query_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/scene_certificate.hpp"
#include "verify/data/dataset.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/json.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::view {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t coordinate_count = 3 * query_points;
/// The greatest size of a file that is read as a whole, in bytes.
constexpr std::size_t file_limit = std::size_t{256} << 20U;
/// The greatest size of a certificate that is shown, in bytes.
constexpr std::size_t certificate_limit = std::size_t{16} << 20U;

/// The selection of a file's queries by the options. Queries are offered one after the other.
class Selection {
 public:
  explicit Selection(QueryFileOptions options) : options_(std::move(options)) {}

  /// True if the query at the position is selected.
  [[nodiscard]] bool wants(std::uint64_t index) const {
    return !is_complete() &&
           (options_.indices.empty() || std::ranges::count(options_.indices, index) != 0);
  }
  /// True if nothing more can be selected.
  [[nodiscard]] bool is_complete() const { return queries_.size() >= wanted(); }
  /// \throws std::invalid_argument if it is about a cell.
  void add(ViewedQuery query) {
    if (query.query.kind().is_cell()) {
      throw std::invalid_argument(fmt::format(
          "view takes vertex-face and edge-edge alone, not a {}: name others by --index",
          to_string(query.query.kind())));
    }
    queries_.push_back(std::move(query));
  }

  /// \throws DatasetError if there is none, or one that was named is not there
  [[nodiscard]] std::vector<ViewedQuery> take(const fs::path& path, std::uint64_t offered) {
    for (const std::uint64_t index : options_.indices) {
      if (index < offered || is_complete()) continue;
      throw io::DatasetError(path, {},
                             fmt::format("there is no query {}; it has {}", index, offered));
    }
    if (queries_.empty()) throw io::DatasetError(path, {}, "there is no query in it");
    return std::move(queries_);
  }

 private:
  [[nodiscard]] std::size_t wanted() const {
    return options_.indices.empty() ? options_.most
                                    : std::min(options_.most, options_.indices.size());
  }

  QueryFileOptions options_;
  std::vector<ViewedQuery> queries_;
};

// ---- Datasets -----------------------------------------------------------------------------------

std::vector<ViewedQuery> read_dataset(const fs::path& path, const QueryFileOptions& options) {
  const auto source = data::open_dataset(path, {.kind = options.kind, .round = options.round});
  Selection selection(options);
  std::uint64_t offered = 0;
  while (!selection.is_complete()) {
    auto recorded = source->next();
    if (!recorded) break;
    offered = recorded->index + 1;
    if (!selection.wants(recorded->index)) continue;
    ViewedQuery query{.label = jobs::certificate_label(source->name(), recorded->index),
                      .query = std::move(recorded->query),
                      .separation = source->recorded_separation()};
    if (recorded->collides) {
      query.notes.emplace_back(*recorded->collides ? "The dataset says that they collide."
                                                   : "The dataset says that they do not collide.");
    }
    selection.add(std::move(query));
  }
  return selection.take(path, offered);
}

// ---- JSON ---------------------------------------------------------------------------------------

double number_of(const nlohmann::json& json) {
  if (json.is_string()) return parse_number(json.get<std::string>());
  const double value = json.get<double>();
  if (!std::isfinite(value)) throw std::invalid_argument("a coordinate is not finite");
  return value;
}

base::AnyQuery straight_from(const nlohmann::json& coordinates, AnyKind kind) {
  if (!coordinates.is_array() || coordinates.size() != coordinate_count) {
    throw std::invalid_argument("coordinates must be a list of 24 numbers");
  }
  Query query{};
  for (std::size_t i = 0; i < coordinate_count; ++i) {
    query.coordinates.at(i) = number_of(coordinates[i]);
  }
  return {kind, query};
}

/// The curves of `control` and `weights` in a page's form (query_facts).
base::AnyQuery curves_from(const nlohmann::json& json, AnyKind kind) {
  const nlohmann::json& control = json.at("control");
  if (!control.is_array() || control.size() < 2 || control.size() > greatest_degree + 1) {
    throw std::invalid_argument("control must be a list for each of 2 to 9 control points");
  }
  const AnyShape shape{kind, control.size() - 1, json.contains("weights")};
  std::vector<double> numbers;
  for (std::size_t j = 0; j < control.size(); ++j) {
    for (std::size_t i = 0; i < moving_points; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        numbers.push_back(number_of(control[j].at(i).at(axis)));
      }
      if (!shape.is_rational) continue;
      numbers.push_back(number_of(json.at("weights").at(j).at(i)));
      if (!(numbers.back() > 0.0)) throw std::invalid_argument("a weight is not positive");
    }
  }
  return {shape, numbers};
}

Separation separation_of(const nlohmann::json& json) {
  const auto separation = json.find("separation");
  if (separation == json.end() || separation->is_null()) return {};
  const Separation result{.distance = number_of(separation->at("min_separation")),
                          .norm = norm_from_string(separation->at("norm").get<std::string>())};
  if (!is_valid(result)) throw std::invalid_argument("the separation must not be negative");
  return result;
}

fast::Verdict verdict_from(std::string_view text) {
  if (text == "no") return fast::Verdict::no;
  if (text == "yes") return fast::Verdict::yes;
  return text == "undecided" ? fast::Verdict::undecided : fast::Verdict::error;
}

/// The failure of a finding, if it is about one.
std::optional<judge::Failure> failure_of(const nlohmann::json& finding) {
  const auto kind = judge::fault_from_name(finding.at("what").get<std::string>());
  if (!kind || !judge::is_failure(*kind)) return std::nullopt;
  return judge::Failure{.kind = *kind};
}

/// Adds the further members of a finding of the fuzzer.
void add_finding(const nlohmann::json& json, ViewedQuery& query) {
  const auto method = json.at("method").get<std::string>();
  query.label += fmt::format(", {} of {}", json.at("what").get<std::string>(), method);
  query.notes.push_back(fmt::format("{}: {}", method, json.at("detail").get<std::string>()));
  const nlohmann::json& answer = json.at("answer");
  query.answers.push_back(
      {.solver = method,
       .answer = {.verdict = verdict_from(answer.at("verdict").get<std::string>()),
                  .toi_lower = io::number_from_json(answer.at("toi_lower")),
                  .toi_upper = io::number_from_json(answer.at("toi_upper")),
                  .tolerance = io::number_from_json(answer.at("tolerance"))},
       .failure = failure_of(json)});
}

std::vector<ViewedQuery> read_json(const fs::path& path, const QueryFileOptions& options) {
  std::uint64_t index = 0;
  try {
    nlohmann::json json = io::read_json(path, file_limit);
    if (json.is_object()) {
      json = json.contains("findings") ? nlohmann::json(json.at("findings"))
                                       : nlohmann::json::array({json});
    }
    Selection selection(options);
    for (; index < json.size() && !selection.is_complete(); ++index) {
      if (!selection.wants(index)) continue;
      selection.add(query_from_json(json.at(index), jobs::certificate_label(path.string(), index),
                                    options.kind));
    }
    return selection.take(path, json.size());
  } catch (const std::logic_error& error) {
    throw io::DatasetError(path, {}, fmt::format("query {}: {}", index, error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw io::DatasetError(path, {}, fmt::format("query {}: {}", index, io::reason_of(error)));
  }
}

// ---- Certificates -------------------------------------------------------------------------------

ViewedQuery query_from(std::string stream, std::string label) {
  ViewedQuery query = certified_query(std::move(stream));
  if (!query.label.empty()) label += ", " + query.label;
  query.label = std::move(label);
  return query;
}

/// \throws DatasetError if it is not the first line of certificates of queries
void check_header(const fs::path& path, std::string_view first_line) {
  if (!first_line.empty() && exact::step_certificates_header().starts_with(first_line)) {
    throw io::DatasetError(path, {.line = 1},
                           "these are certificates of steps, which have no query; "
                           "view --step draws the step between two frames");
  }
  if (first_line.empty() || !exact::certificates_header().starts_with(first_line)) {
    throw io::DatasetError(path, {.line = 1}, "not a stream of certificates");
  }
}

/// Each certificate is made a stream of its own: the lines from `query` to `end`, between header
/// and closing line.
std::vector<ViewedQuery> read_certificates(const fs::path& path, const QueryFileOptions& options) {
  io::LineReader lines(path);
  Selection selection(options);
  std::uint64_t index = 0;
  std::string text;
  for (auto line = lines.next(); line && !selection.is_complete(); line = lines.next()) {
    if (line->text.starts_with("query ")) text = exact::certificates_header();
    if (text.empty()) {
      if (line->number == 1) check_header(path, line->text);
      continue;
    }
    text.append(line->text).append("\n");
    if (text.size() > certificate_limit) {
      throw io::DatasetError(path, {.line = line->number},
                             "a certificate of more than 16 MiB; is its line 'end' missing?");
    }
    if (line->text != "end") continue;
    if (selection.wants(index)) {
      text += exact::certificates_closing_line(1);
      try {
        selection.add(query_from(text, jobs::certificate_label(path.string(), index)));
      } catch (const std::invalid_argument& error) {
        throw io::DatasetError(path, {.line = line->number}, error.what());
      }
    }
    ++index;
    text.clear();
  }
  return selection.take(path, index);
}

double parse_hexadecimal(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size())
    throw std::invalid_argument("\"" + text + "\" is no number");
  return value;
}

}  // namespace

ViewedQuery query_from_json(const nlohmann::json& json, std::string label,
                            std::optional<AnyKind> kind) {
  ViewedQuery query{.label = std::move(label)};
  if (const auto named = json.find("kind"); named != json.end()) {
    kind = kind_from_string(named->get<std::string>());
  }
  if (!kind) throw std::invalid_argument("nothing says the kind; add --kind");
  if (json.contains("control")) {
    query.query = curves_from(json, *kind);
  } else {
    query.query = straight_from(json.at("coordinates"), *kind);
  }
  query.separation = separation_of(json);
  if (json.contains("label")) query.label = json.at("label").get<std::string>();
  if (json.contains("note")) query.notes.push_back(json.at("note").get<std::string>());
  if (json.contains("what") && json.contains("answer")) add_finding(json, query);
  return query;
}

double parse_number(std::string_view text) {
  double value = std::numeric_limits<double>::infinity();
  if (text.find_first_of("xX") != std::string_view::npos) {
    value = parse_hexadecimal(std::string(text));
  } else {
    const std::size_t slash = text.find('/');
    value = io::parse_coordinate(text.substr(0, slash),
                                 slash == std::string_view::npos ? "1" : text.substr(slash + 1))
                .value;
  }
  if (!std::isfinite(value)) throw std::invalid_argument("a coordinate is not finite");
  return value;
}

Query parse_points(std::string_view text) {
  static constexpr std::string_view separators = " \t\r\n,;{}()[]";
  Query query{};
  std::size_t count = 0;
  for (std::size_t at = text.find_first_not_of(separators); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    if (count < coordinate_count) {
      query.coordinates.at(count) = parse_number(text.substr(at, end - at));
    }
    ++count;
    at = text.find_first_not_of(separators, end);
  }
  if (count != coordinate_count) {
    throw std::invalid_argument(fmt::format("{} numbers, not the 24 of a query", count));
  }
  return query;
}

std::vector<ViewedQuery> read_queries(const fs::path& path, const QueryFileOptions& options) {
  const std::string extension = path.extension().string();
  if (extension == ".json") return read_json(path, options);
  const bool is_compressed = extension == ".zst" && path.stem().extension() == ".cert";
  if (extension == ".cert" || is_compressed) return read_certificates(path, options);
  return read_dataset(path, options);
}

}  // namespace touchstone::verify::view
