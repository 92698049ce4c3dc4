#pragma once

/// \file
/// JSON as all commands write it, and what JSON has no numbers or texts for.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// A number as JSON, which has finite ones only: null for nothing and for NaN, and the words "Infinity"
/// and "-Infinity".
[[nodiscard]] nlohmann::json number_to_json(std::optional<double> number);

/// The reverse of number_to_json, with NaN for null.
/// \throws nlohmann::json::exception if it is none of these.
[[nodiscard]] double number_from_json(const nlohmann::json& json);

/// The text; null if it is empty.
[[nodiscard]] nlohmann::json text_or_null(std::string_view text);

/// JSON as it is written to a file: in ASCII, so that no name in it acts on a terminal. What is no UTF-8
/// becomes U+FFFD.
[[nodiscard]] std::string json_document(const nlohmann::json& json);

}  // namespace touchstone::verify::io
