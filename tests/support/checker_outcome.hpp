#pragma once

/// \file
/// Certificates as text, and the checker's results.

#include <gtest/gtest.h>

#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>

#include "exact/checker/checker.hpp"

namespace touchstone::tests {

inline constexpr std::string_view certificate_header = "touchstone-certificates 2\n";

[[nodiscard]] inline checker::Report check_text(const std::string& text,
                                                const checker::Options& options = {}) {
  std::istringstream stream(text);
  return checker::check(stream, options);
}

/// The stream with its closing line: the text of the certificates with one for all `query` lines.
[[nodiscard]] inline std::string closed(const std::string& text) {
  std::size_t queries = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.substr(0, line.find(' ')) == "query") ++queries;
  }
  return text + "certificates " + std::to_string(queries) + "\n";
}

/// The outcome for a stream of one certificate without its closing line: its claim if it is
/// accepted, else "LINE: REASON".
[[nodiscard]] inline std::string outcome(const std::string& text) {
  const checker::Report report = check_text(closed(text));
  if (report.accepted() + report.rejected != 1) return "not one certificate";
  EXPECT_EQ(report.rejections.size(), report.rejected);
  if (report.rejected == 1) {
    return std::to_string(report.rejections[0].line) + ": " + report.rejections[0].reason;
  }
  if (report.inversions() == 1) {
    if (report.no_inversion == 1) return "no_inversion";
    return report.inversion == 1 ? "inversion" : "time_of_inversion";
  }
  if (report.no_collision == 1) return "no_collision";
  return report.collision == 1 ? "collision" : "time_of_impact";
}

/// Why a stream is refused; empty if all of it is accepted.
[[nodiscard]] inline std::string refusal(const std::string& text,
                                         const checker::Options& options = {}) {
  const checker::Report report = check_text(text, options);
  EXPECT_EQ(report.rejections.size(), report.rejected);
  return report.all_accepted() ? "" : report.rejections.at(0).reason;
}

/// Why the stream is refused of one who has the scenes.
[[nodiscard]] inline std::string refusal_about(const std::string& scenes, const std::string& text) {
  std::istringstream given(scenes);
  return refusal(text, {.scenes = &given});
}

/// A text with the first occurrence of some words replaced.
[[nodiscard]] inline std::string altered(std::string text, std::string_view what,
                                         std::string_view by) {
  const std::size_t place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  return text.replace(place, what.size(), by);
}

}  // namespace touchstone::tests
