#pragma once

/// \file
/// A query as a person reads it, as a dataset holds it, and as a test that shows what is wrong.

#include <filesystem>
#include <optional>
#include <string>

#include "exact/query.hpp"

namespace touchstone::verify {

/// A line a point, at t=0 and then at t=1: its name in the kind, and its coordinates in decimal and in
/// hexadecimal. Both give the very doubles.
[[nodiscard]] std::string as_points(Kind kind, const Query& query);

/// The eight rows that a dataset has for it (csv_dataset.hpp), with the label where there is one.
/// \throws std::invalid_argument if a coordinate is not finite.
[[nodiscard]] std::string as_csv(const Query& query, std::optional<bool> collides = std::nullopt);

/// What a method answered wrongly.
struct Reproduction {
  Kind kind = Kind::vertex_face;
  Query query{};
  Separation separation;
  /// The truth: does it collide at this separation?
  bool collides = false;
  /// The name of one of methods(), or what a plugin calls itself.
  std::string method;
  /// What is wrong, in some words: "false negative".
  std::string what;
  /// The plugin's library; empty for one of methods().
  std::filesystem::path plugin = {};
  /// Is the plugin held to exactness?
  bool exact_plugin = false;
};

/// The text of a C++ file: a function that asks a method and judges its answer, and a GoogleTest that
/// calls it. It includes headers of this library and links touchstone::verify; it fails where the
/// method's answer breaks what the method promises, and passes where it does not.
/// \pre all coordinates are finite.
[[nodiscard]] std::string as_cpp_test(const Reproduction& found);

}  // namespace touchstone::verify
