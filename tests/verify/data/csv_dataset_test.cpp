#include "verify/data/csv_dataset.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::csv_dataset_test {
namespace {

using test::contents;
using test::error_of;
using test::expect_numbered;
using test::joined;
using test::numbered_lines;
using test::read_all;
using test::read_survivors;
using test::Survivors;
using test::TemporaryFolder;

DatasetOptions vertex_face() { return {.kind = Kind::vertex_face}; }

/// The first error of a file of this text, without its name, read without keep_going.
std::string strict_error(const std::string& text, const DatasetOptions& options = vertex_face()) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.csv", text);
  const std::string error = error_of(folder.path(), [&] {
    CsvDataset source(path, options);
    (void)read_all(source);
  });
  return error.starts_with("a.csv:") ? error.substr(6) : error;
}

Survivors survivors(const std::string& text) {
  const TemporaryFolder folder;
  return read_survivors(folder.file("a.csv", text), folder.path(), vertex_face());
}

/// The replacement of line 12, the fourth of query 1, and its error.
struct Fault {
  std::string line;
  std::string error;
};

TEST(CsvDataset, AFaultIsLocatedAndCostsItsQueryOnly) {
  const std::vector<Fault> faults{
      {"1,0,2,1,3,1,1", "12:2: zero denominator"},
      {"1,1,2,1,3,0,1", "12:6: zero denominator"},
      {"1,1,x,1,3,1,1", "12:3: not a number: \"x\""},
      {"1,1,2,1,,1,1", "12:5: not a number: \"\""},
      {"1,1,2,1,0.1,1,1", "12:5: not exactly a double (--round takes the nearest)"},
      {"1,1,2,1,1" + std::string(400, '0') + ",1,1", "12:5: beyond the range of double"},
      {"1,1,2,1,3,1,2", "12:7: label must be 0 or 1: \"2\""},
      {"1,1,2,1,3,1,", "12:7: label must be 0 or 1: \"\""},
      {"1,1,2,1,3,1,true", "12:7: label must be 0 or 1: \"true\""}};
  for (const auto& [line, error] : faults) {
    std::vector<std::string> lines = numbered_lines(3, true);
    lines[11] = line;
    EXPECT_EQ(strict_error(joined(lines)), error);
    const Survivors kept = survivors(joined(lines));
    expect_numbered(kept.records, {0, 2});
    EXPECT_EQ(kept.skipped, 1U);
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + error});
    for (const RecordedQuery& record : kept.records) EXPECT_FALSE(record.collides.value());
  }
}

const std::string rest_is_left_out =
    "; the rest of the file is left out, since it is unknown from here on which eight rows are a "
    "query: mend this line";

/// Rows cannot be counted behind a line that is none, instead of line 12 or in addition to it: no
/// further query is read, neither that of the line nor one made of later rows.
TEST(CsvDataset, ALineThatIsNoRowEndsTheFile) {
  const std::vector<Fault> faults{
      {"1,1,2,1,3,1,0", "12:7: label differs from that of the query's first row"},
      {"1,1,2,1,3,1", "12: 6 columns, expected 7 as before"},
      {"1,1,2,1,3,1,1,1", "12: 8 columns, expected 7 as before"},
      {"1", "12: 1 columns, expected 7 as before"},
      {"", "12: blank line inside a query"},
      {" \t", "12: blank line inside a query"},
      {"xn,xd,yn,yd,zn,zd,label", "12: no number in the line"},
      {",,,,,,", "12: no number in the line"},
      {"1,1,2,1,3,1,\"1", "12:7: malformed quoted field"},
      {"1,1,2,\"1\"1,3,1,1", "12:4: malformed quoted field"}};
  for (const auto& [line, reason] : faults) {
    for (const bool in_addition : {false, true}) {
      std::vector<std::string> lines = numbered_lines(5, true);
      if (in_addition) lines.insert(lines.begin() + 11, "");
      lines[11] = line;
      const std::string error = reason + rest_is_left_out;
      EXPECT_EQ(strict_error(joined(lines)), error);
      const Survivors kept = survivors(joined(lines));
      expect_numbered(kept.records, {0});
      EXPECT_EQ(kept.skipped, 1U);
      EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + error});
    }
  }
}

TEST(CsvDataset, WhatCompanionsHoldBehindALostPlaceIsNoFurtherFault) {
  const TemporaryFolder folder;
  (void)folder.file("a_mma_bool.json", "[0,1,0,1]");
  (void)folder.file("a_toi.csv", "query,toi\n3,0.5\n");
  std::vector<std::string> lines = numbered_lines(4, false);
  lines[11] = "";
  const Survivors kept =
      read_survivors(folder.file("a.csv", joined(lines)), folder.path(), vertex_face());
  expect_numbered(kept.records, {0});
  EXPECT_EQ(kept.messages,
            std::vector<std::string>{"a.csv:12: blank line inside a query" + rest_is_left_out});
}

/// Blank lines and headers between queries, spaces, signs, line ends, and blank lines at the end.
TEST(CsvDataset, ReadsEveryFormOfTheSameQueries) {
  for (const bool labelled : {false, true}) {
    const std::string header = labelled ? "xn,xd,yn,yd,zn,zd,label" : "\"x n\",xd,y_n,yd,#zn,zd";
    const std::vector<std::string> plain = numbered_lines(4, labelled);
    std::vector<std::string> between{"", header, " \t"}, decorated;
    for (std::size_t query = 0; query < 4; ++query) {
      if (query == 2) between.insert(between.end(), {header, "", header});
      for (const std::string& row : test::numbered_rows(query, labelled)) between.push_back(row);
      between.insert(between.end(), query, "");
    }
    for (std::string line : plain) {
      for (std::size_t at = 0; (at = line.find(',', at)) != std::string::npos; at += 4) {
        line.replace(at, 1, " ,\t ");
      }
      decorated.push_back("  +" + line + " ");
    }
    std::string without_last_newline = joined(plain);
    without_last_newline.pop_back();
    for (const std::string& text :
         {joined(between), joined(between, "\r\n"), joined(decorated), joined(plain, "\r\n"),
          joined(decorated, "\r\n"), without_last_newline, joined(plain) + "\n \n\r\n\t"}) {
      const Survivors kept = survivors(text);
      expect_numbered(kept.records, {0, 1, 2, 3});
      for (const auto& record : kept.records) {
        EXPECT_EQ(record.collides, labelled ? std::optional(record.index % 2 == 1) : std::nullopt);
      }
      EXPECT_EQ(kept.messages, std::vector<std::string>{});
      EXPECT_EQ(strict_error(text), "no DatasetError");
    }
  }
}

TEST(CsvDataset, ALineThatIsNoHeaderBeginsNoFile) {
  const std::vector<std::string> rows = numbered_lines(1, false);
  const auto error = [&](const std::string& first_line) {
    return strict_error(first_line + "\n" + joined(rows));
  };
  EXPECT_EQ(error("a,b,c,d,e,f"), "no DatasetError");
  EXPECT_EQ(error("a,b,c"), "2: 6 columns, expected 3 as before" + rest_is_left_out);
  EXPECT_EQ(error("queries"), "1: 1 columns, expected 3, 4, 6 or 7" + rest_is_left_out);
  EXPECT_EQ(error("a,b,c,d,e,"), "1: no number in the line" + rest_is_left_out);
  EXPECT_EQ(error("a,b,c,d,e,-"), "1: no number in the line" + rest_is_left_out);
  EXPECT_EQ(error("a,b,c,d,e,6"), "1:1: not a number: \"a\"");
  EXPECT_EQ(error("nan,nan,nan,nan,nan,nan"), "1:1: not a finite number: \"nan\"");
  EXPECT_EQ(error("a,b,c,d,e,f\nA,B,C,D,E,F"), "2: no number in the line" + rest_is_left_out);
  EXPECT_EQ(strict_error("a,b,c,d,e,f\n\n"), " no queries");
}

TEST(CsvDataset, ATruncatedLastQueryIsOneError) {
  for (std::size_t rows = 1; rows < 8; ++rows) {
    std::vector<std::string> lines = numbered_lines(3, true);
    lines.resize(16 + rows);
    const std::string error = std::to_string(16 + rows) +
                              ": truncated query: " + std::to_string(rows) +
                              " of 8 rows; if a row is missing further up, later queries were "
                              "composed of two";
    EXPECT_EQ(strict_error(joined(lines) + "\n\n"), error);
    const Survivors kept = survivors(joined(lines));
    expect_numbered(kept.records, {0, 1});
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + error});
    EXPECT_EQ(kept.skipped, 1U);
  }
}

TEST(CsvDataset, RoundsOnlyWhereAskedAndCounts) {
  std::vector<std::string> lines = numbered_lines(3, true);
  lines[3] = "1,3,2,1,-2,3,0";
  lines[16] = "1,3,2,1,x,3,0";
  const TemporaryFolder folder;
  const auto path = folder.file("a.csv", joined(lines));
  DatasetOptions options{.kind = Kind::vertex_face, .round = true, .keep_going = true};
  const auto source = open_dataset(path, options);
  const auto records = read_all(*source);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].query.straight().at(0, 3, 0), 1.0 / 3.0);
  EXPECT_EQ(records[0].query.straight().at(0, 3, 1), 2.0);
  EXPECT_EQ(records[0].query.straight().at(0, 3, 2), -2.0 / 3.0);
  EXPECT_EQ(source->rounded(), 2U) << "the rounding in the query left out does not count";
  EXPECT_EQ(source->skipped(), 1U);
  EXPECT_EQ(strict_error(joined(lines)), "4:1: not exactly a double (--round takes the nearest)");
}

TEST(CsvDataset, ProgressRisesToOne) {
  const TemporaryFolder folder;
  CsvDataset source(folder.file("a.csv", joined(numbered_lines(5000, true))), vertex_face());
  double last = source.progress();
  EXPECT_LT(last, 0.5);
  while (source.next()) {
    EXPECT_GE(source.progress(), last);
    last = source.progress();
  }
  EXPECT_EQ(source.progress(), 1.0);
}

TEST(CsvWriter, WritesThe2021FormatToTheByte) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.path() / "a.csv");
  Query query{};
  query.at(0, 0, 0) = 0.5;
  query.at(1, 3, 2) = -3.0;
  writer.write({Kind::vertex_face, query}, true);
  writer.close();
  std::string expected = "1,2,0,1,0,1,1\n";
  for (int row = 1; row < 7; ++row) expected += "0,1,0,1,0,1,1\n";
  EXPECT_EQ(contents(folder.path() / "a.csv"), expected + "0,1,0,1,-3,1,1\n");
}

}  // namespace
}  // namespace touchstone::verify::data::csv_dataset_test
