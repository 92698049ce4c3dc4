#pragma once

/// \file
/// JSON as all commands read and write it, and what JSON has no numbers or texts for.

#include <cstddef>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io {

/// A number as JSON, which has finite ones only: null for nothing and for NaN, and the words
/// "Infinity" and "-Infinity".
[[nodiscard]] nlohmann::json number_to_json(std::optional<double> number);

/// The reverse of number_to_json, with NaN for null.
/// \throws nlohmann::json::exception if it is none of these.
[[nodiscard]] double number_from_json(const nlohmann::json& json);

/// The text; null if it is empty.
[[nodiscard]] nlohmann::json text_or_null(std::string_view text);

/// Values may be nested so deep: JSON from outside must not exhaust the stack of what walks through
/// it.
inline constexpr int deepest_json = 100;

/// The JSON in a file.
/// \throws DatasetError if the file cannot be read, has more bytes, is no JSON or nested deeper,
/// has a number beyond the range or a key twice in one object.
[[nodiscard]] nlohmann::json read_json(const std::filesystem::path& path, std::size_t most_bytes);

/// The JSON of each line of a file that is not empty. \throws DatasetError as read_json, with the
/// line
[[nodiscard]] std::vector<nlohmann::json> read_json_lines(const std::filesystem::path& path,
                                                          std::size_t most_bytes);

/// The reason that an exception of JSON gives, without the library's name and number of it: "key
/// 'format' not found". The text of any other exception is as it is.
[[nodiscard]] std::string reason_of(const std::exception& error);

/// JSON as it is written to a file: in ASCII, so that no name in it acts on a terminal. What is no
/// UTF-8 becomes U+FFFD.
[[nodiscard]] std::string json_document(const nlohmann::json& json);
/// The same in one line.
[[nodiscard]] std::string json_line(const nlohmann::json& json);

}  // namespace touchstone::verify::io
