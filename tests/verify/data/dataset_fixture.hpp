#pragma once

/// \file
/// Common parts of the tests of dataset readers and writers.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/data/dataset.hpp"

namespace touchstone::verify::data::test {

using tests::TemporaryFolder;

[[nodiscard]] inline std::string contents(const std::filesystem::path& path) {
  return tests::read_file(path);
}

[[nodiscard]] inline std::vector<RecordedQuery> read_all(QuerySource& source) {
  std::vector<RecordedQuery> records;
  while (auto record = source.next()) records.push_back(*record);
  return records;
}

/// The text of the DatasetError that the action throws, without `folder` (if given) at its front.
template <class Action>
[[nodiscard]] std::string error_of(const std::filesystem::path& folder, const Action& action) {
  try {
    action();
  } catch (const io::DatasetError& error) {
    const std::string text = error.what();
    const std::string prefix = folder.empty() ? "" : folder.string() + "/";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
  }
  return "no DatasetError";
}

/// A stream read with keep_going.
struct Survivors {
  std::vector<RecordedQuery> records;
  std::uint64_t skipped;
  /// The text of each error, without the folder.
  std::vector<std::string> messages;
};

[[nodiscard]] inline Survivors read_survivors(const std::filesystem::path& path,
                                              const std::filesystem::path& folder,
                                              DatasetOptions options = {}) {
  Survivors survivors;
  options.keep_going = true;
  options.on_skip = [&](const io::DatasetError& fault) {
    survivors.messages.push_back(error_of(folder, [&] { throw fault; }));
  };
  const auto source = open_dataset(path, options);
  survivors.records = read_all(*source);
  survivors.skipped = source->skipped();
  return survivors;
}

/// A query whose numbers all differ from place to place, are quarters, and no weight is 0.
[[nodiscard]] inline base::AnyQuery numbered(const AnyShape& shape, std::size_t index) {
  std::vector<double> numbers(shape.numbers_of_query());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<double>(100 * index + i) / 4.0;
  }
  return {shape, numbers};
}
[[nodiscard]] inline Query numbered_query(std::size_t index) {
  return numbered({}, index).straight();
}

/// The eight lines of numbered_query(index) without line ends; labelled so that odd ones collide.
[[nodiscard]] inline std::vector<std::string> numbered_rows(std::size_t index, bool labelled) {
  std::vector<std::string> rows;
  for (std::size_t row = 0; row < query_points; ++row) {
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      text += (axis == 0 ? "" : ",") + std::to_string(100 * index + 3 * row + axis) + ",4";
    }
    rows.push_back(text + (labelled ? "," + std::to_string(index % 2) : ""));
  }
  return rows;
}

[[nodiscard]] inline std::vector<std::string> numbered_lines(std::size_t queries, bool labelled) {
  std::vector<std::string> lines;
  for (std::size_t index = 0; index < queries; ++index) {
    for (const std::string& row : numbered_rows(index, labelled)) lines.push_back(row);
  }
  return lines;
}

[[nodiscard]] inline std::string joined(const std::vector<std::string>& lines,
                                        std::string_view line_end = "\n") {
  std::string text;
  for (const std::string& line : lines) {
    text += line;
    text += line_end;
  }
  return text;
}

/// Expects exactly the numbered queries of these indices, each with its index, of any kind.
inline void expect_numbered(const std::vector<RecordedQuery>& records,
                            const std::vector<std::uint64_t>& indices, AnyShape shape = {}) {
  ASSERT_EQ(records.size(), indices.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i].index, indices[i]);
    shape.kind = records[i].query.kind();
    EXPECT_EQ(records[i].query, numbered(shape, indices[i]));
  }
}

}  // namespace touchstone::verify::data::test
