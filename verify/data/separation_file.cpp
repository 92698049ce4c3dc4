#include "verify/data/separation_file.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {
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
  return path ? read_separation(*path) : Separation{.distance = 0.0, .norm = Norm::linf};
}

void write_separation(const fs::path& folder, const Separation& separation) {
  io::OutputFile file(folder / file_name);
  file.write(fmt::format("{{\"min_separation\": \"{:a}\", \"norm\": \"{}\"}}\n",
                         separation.distance, to_string(separation.norm)));
  file.close();
}

}  // namespace touchstone::verify::data
