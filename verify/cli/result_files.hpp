#pragma once

/// \file
/// The page to look at the results of a command (--view), as `touchstone view` writes it.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/cli/files.hpp"
#include "verify/view/step_facts.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::cli {

/// A page of the first queries that a command found, if a file is named. A failure is reported
/// once, as by Output.
class ViewFile {
 public:
  /// The maximum number of queries on a page.
  static constexpr std::size_t most_queries = 100;

  /// \throws as Output.
  ViewFile(Files& files, const std::string& name) : name_(name), output_(files, name) {}

  /// True if a file was named.
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }

  /// True if the page is full.
  [[nodiscard]] bool is_full() const { return queries_.size() >= most_queries; }

  /// Adds a query unless the page is full. If the page has the query already, its notes and answers
  /// are extended.
  void add(view::ViewedQuery query);

  /// Adds a step, and the first of its pairs.
  void add(const view::ViewedStep& step);

  /// Adds a mesh at rest, from view::resting_facts().
  void add(nlohmann::json resting_mesh);

  /// Writes the page, with answers of the certified solver under these options. Whatever fails is
  /// reported.
  void write(const fast::MethodOptions& options = {});

  /// Lines about the contents of the page; empty if no file was named or it could not be written.
  /// \param allowed false positives, which break no promise and are not on the page
  [[nodiscard]] std::string summary(std::uint64_t allowed = 0) const;

 private:
  [[nodiscard]] std::string page(const fast::MethodOptions& options) const;

  std::string name_;
  Output output_;
  std::vector<view::ViewedQuery> queries_;
  nlohmann::json step_;
  bool is_cut_ = false;
};

}  // namespace touchstone::verify::cli
