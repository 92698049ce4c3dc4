#include "verify/io/json.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"

namespace touchstone::verify::io {
namespace {

constexpr const char* infinity_name = "Infinity";
constexpr const char* negative_infinity_name = "-Infinity";

}  // namespace

nlohmann::json number_to_json(std::optional<double> number) {
  if (!number || std::isnan(*number)) return {};
  if (std::isinf(*number)) return *number > 0.0 ? infinity_name : negative_infinity_name;
  return *number;
}

double number_from_json(const nlohmann::json& json) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (json == infinity_name) return infinity;
  if (json == negative_infinity_name) return -infinity;
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

namespace {

/// \param place of the text in the file
nlohmann::json parsed(std::string_view text, const std::filesystem::path& path,
                      FilePosition place) {
  std::map<int, std::set<std::string>> keys;  // of the open object of each depth
  const auto check = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    if (depth > deepest_json) {
      throw DatasetError(path, place, "nested more than " + std::to_string(deepest_json) + " deep");
    }
    if (event == nlohmann::json::parse_event_t::object_start) keys[depth + 1].clear();
    if (event == nlohmann::json::parse_event_t::key && !keys[depth].insert(value).second) {
      throw DatasetError(path, place, "repeated key " + quote(value.get<std::string>()));
    }
    return true;
  };
  try {
    return nlohmann::json::parse(text, check);
  } catch (const nlohmann::json::parse_error& error) {
    throw DatasetError(path, place, "no JSON: " + reason_of(error));
  } catch (const nlohmann::json::out_of_range& error) {
    throw DatasetError(path, place, "a number beyond the range: " + reason_of(error));
  }
}

}  // namespace

nlohmann::json read_json(const std::filesystem::path& path, std::size_t most_bytes) {
  const std::string text = read_file(path, most_bytes);
  return parsed(without_byte_order_mark(text, path), path, {});
}

std::vector<nlohmann::json> read_json_lines(const std::filesystem::path& path,
                                            std::size_t most_bytes) {
  std::vector<nlohmann::json> all;
  std::istringstream lines(read_file(path, most_bytes));
  std::size_t number = 1;
  for (std::string line; std::getline(lines, line); ++number) {
    if (!line.empty()) all.push_back(parsed(line, path, {.line = number}));
  }
  return all;
}

nlohmann::json text_or_null(std::string_view text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

std::string reason_of(const std::exception& error) {
  const std::string_view text = error.what();
  if (!text.starts_with("[json.exception")) return std::string(text);
  return std::string(text.substr(text.find("] ") + 2));
}

std::string json_document(const nlohmann::json& json) {
  static constexpr auto replace = nlohmann::json::error_handler_t::replace;
  static constexpr bool only_ascii = true;
  return json.dump(2, ' ', only_ascii, replace) + "\n";
}

std::string json_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace touchstone::verify::io
