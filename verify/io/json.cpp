#include "verify/io/json.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <set>

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

nlohmann::json read_json(const std::filesystem::path& path, std::size_t most_bytes) {
  std::map<int, std::set<std::string>> keys;  // of the open object of each depth
  const auto check = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    if (depth > deepest_json) {
      throw DatasetError(path, {}, "nested more than " + std::to_string(deepest_json) + " deep");
    }
    if (event == nlohmann::json::parse_event_t::object_start) keys[depth + 1].clear();
    if (event == nlohmann::json::parse_event_t::key && !keys[depth].insert(value).second) {
      throw DatasetError(path, {}, "repeated key " + quote(value.get<std::string>()));
    }
    return true;
  };
  try {
    return nlohmann::json::parse(without_byte_order_mark(read_file(path, most_bytes), path), check);
  } catch (const nlohmann::json::parse_error& error) {
    throw DatasetError(path, {}, "no JSON: " + reason_of(error));
  } catch (const nlohmann::json::out_of_range& error) {
    throw DatasetError(path, {}, "a number beyond the range: " + reason_of(error));
  }
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

}  // namespace touchstone::verify::io
