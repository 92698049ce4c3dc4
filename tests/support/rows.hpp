#pragma once

/// \file
/// Rows of tables in text files, and texts with alternatives.

#include <string>
#include <string_view>
#include <vector>

namespace touchstone::tests {

/// The parts of a text between the separators.
[[nodiscard]] inline std::vector<std::string> split(std::string_view text,
                                                    std::string_view separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; (at = text.find(separator)) != std::string_view::npos;) {
    parts.emplace_back(text.substr(0, at));
    text.remove_prefix(at + separator.size());
  }
  parts.emplace_back(text);
  return parts;
}

[[nodiscard]] inline std::string joined(const std::vector<std::string>& parts,
                                        std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) text.append(&part == parts.data() ? "" : separator) += part;
  return text;
}

[[nodiscard]] inline std::string replaced(std::string text, std::string_view what,
                                          std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// The rows for each choice in {a|b}; {} is the first choice again.
[[nodiscard]] inline std::vector<std::string> expanded(const std::string& row) {
  const std::size_t begin = row.find('{'), end = row.find('}');
  if (begin == std::string::npos) return {row};
  std::vector<std::string> rows;
  for (const std::string& choice : split(row.substr(begin + 1, end - begin - 1), "|")) {
    const std::string chosen = row.substr(0, begin) + choice + row.substr(end + 1);
    for (std::string& one : expanded(replaced(chosen, "{}", choice))) rows.push_back(one);
  }
  return rows;
}

/// The points of a query `vertex_face p, p, p, p > p, p, p, p` or `edge_edge …`, at both ends, or
/// at rest without `>`; `over p > p` is a vertex over the resting triangle 0 0 0, 4 0 0, 0 4 0.
struct QueryRow {
  std::string kind;
  std::vector<std::string> points;

  explicit QueryRow(const std::string& row) : kind(row.substr(0, row.find(' '))) {
    std::vector<std::string> ends = split(row.substr(kind.size() + 1), " > ");
    if (ends.size() == 1) ends.push_back(ends[0]);
    for (const std::string& end : ends) {
      for (std::string& point :
           split(end + (kind == "over" ? ", 0 0 0, 4 0 0, 0 4 0" : ""), ", ")) {
        points.push_back(std::move(point));
      }
    }
    if (kind == "over") kind = "vertex_face";
  }
};

}  // namespace touchstone::tests
