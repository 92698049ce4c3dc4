#pragma once

/// \file
/// The page that a command writes to look at what it found (--view), as `touchstone view` writes pages.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/cli/files.hpp"
#include "verify/view/query_facts.hpp"
#include "verify/view/step_facts.hpp"

namespace touchstone::verify::cli {

/// A page of the first queries that a command found, if a file is named. A failure is reported, once, as that
/// of Output.
class ViewFile {
 public:
  /// A page holds at most so many queries.
  static constexpr std::size_t most_queries = 100;

  /// \throws as Output does.
  ViewFile(Files& files, const std::string& name) : name_(name), output_(files, name) {}

  /// Was a file named?
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }

  /// Has it as many queries as a page holds?
  [[nodiscard]] bool is_full() const { return queries_.size() >= most_queries; }

  /// Takes a query unless it is full. A query that it has already gets the further notes and answers.
  void add(view::ViewedQuery query);

  /// Takes a step, and the first of its pairs.
  void add(const view::ViewedStep& step);

  /// Writes the page: on it the certified solver answers too, under these options.
  void write(const fast::MethodOptions& options = {});

  /// What the page shows, a line: nothing if no file was named or it could not be written.
  /// \param allowed false positives, which break no promise and are not on the page
  [[nodiscard]] std::string summary(std::uint64_t allowed = 0) const;

 private:
  std::string name_;
  Output output_;
  std::vector<view::ViewedQuery> queries_;
  nlohmann::json step_;
  bool is_cut_ = false;
};

/// Adds --view.
void add_view_option(CLI::App& command, std::string& file, const std::string& description);

}  // namespace touchstone::verify::cli
