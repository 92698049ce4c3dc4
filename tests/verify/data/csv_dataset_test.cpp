#include "verify/data/csv_dataset.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
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
using test::numbered_query;
using test::random_query;
using test::read_all;
using test::read_survivors;
using test::resident_growth;
using test::Survivors;
using test::TemporaryFolder;

using Limits = std::numeric_limits<double>;

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

/// The replacement of line 12, the fourth of query 1 of three, and its error.
struct Fault {
  std::string line;
  std::string error;
};

class CsvFault : public ::testing::TestWithParam<Fault> {};

TEST_P(CsvFault, IsLocatedAndCostsItsQueryOnly) {
  std::vector<std::string> lines = numbered_lines(3, true);
  lines[11] = GetParam().line;
  EXPECT_EQ(strict_error(joined(lines)), GetParam().error);
  const Survivors kept = survivors(joined(lines));
  expect_numbered(kept.records, {0, 2});
  EXPECT_EQ(kept.skipped, 1U);
  EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + GetParam().error});
  EXPECT_FALSE(kept.records[0].collides.value());
  EXPECT_FALSE(kept.records[1].collides.value());
}

INSTANTIATE_TEST_SUITE_P(
    Table, CsvFault,
    ::testing::Values(
        Fault{"1,0,2,1,3,1,1", "12:2: zero denominator"},
        Fault{"1,1,2,1,3,0,1", "12:6: zero denominator"},
        Fault{"1,1,x,1,3,1,1", "12:3: not a number: \"x\""},
        Fault{"1,1,2,1,,1,1", "12:5: not a number: \"\""},
        Fault{"1,1,2,1,0.1,1,1", "12:5: not exactly a double (--round takes the nearest)"},
        Fault{"1,1,2,1,1" + std::string(400, '0') + ",1,1", "12:5: beyond the range of double"},
        Fault{"1,1,2,1,3,1,2", "12:7: label must be 0 or 1: \"2\""},
        Fault{"1,1,2,1,3,1,", "12:7: label must be 0 or 1: \"\""},
        Fault{"1,1,2,1,3,1,true", "12:7: label must be 0 or 1: \"true\""}));

const std::string rest_is_left_out =
    "; the rest of the file is left out, since it is unknown from here on which eight rows are a "
    "query: mend this line";

/// A line after which rows cannot be counted, instead of line 12 or in addition to it. From there
/// on no query is read: neither the query of that line nor one made of later rows.
class CsvLineThatIsNoRow : public ::testing::TestWithParam<Fault> {};

TEST_P(CsvLineThatIsNoRow, EndsTheFile) {
  const std::string error = GetParam().error + rest_is_left_out;
  for (const bool in_addition : {false, true}) {
    std::vector<std::string> lines = numbered_lines(5, true);
    const auto line = lines.begin() + 11;
    in_addition ? static_cast<void>(lines.insert(line, GetParam().line))
                : static_cast<void>(*line = GetParam().line);
    EXPECT_EQ(strict_error(joined(lines)), error);
    const Survivors kept = survivors(joined(lines));
    expect_numbered(kept.records, {0});
    EXPECT_EQ(kept.skipped, 1U);
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + error});
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, CsvLineThatIsNoRow,
    ::testing::Values(Fault{"1,1,2,1,3,1,0",
                            "12:7: label differs from that of the query's first row"},
                      Fault{"1,1,2,1,3,1", "12: 6 columns, expected 7 as before"},
                      Fault{"1,1,2,1,3,1,1,1", "12: 8 columns, expected 7 as before"},
                      Fault{"1", "12: 1 columns, expected 7 as before"},
                      Fault{"", "12: blank line inside a query"},
                      Fault{" \t", "12: blank line inside a query"},
                      Fault{"xn,xd,yn,yd,zn,zd,label", "12: no number in the line"},
                      Fault{",,,,,,", "12: no number in the line"},
                      Fault{"1,1,2,1,3,1,\"1", "12:7: malformed quoted field"},
                      Fault{"1,1,2,\"1\"1,3,1,1", "12:4: malformed quoted field"},
                      Fault{"1,1,2,1,3,1,1" + std::string(io::LineReader::longest_line, ' '),
                            "12: line longer than 1 MiB"}));

TEST(CsvDataset, AMissingRowIsFoundAtTheFirstLabelThatDiffers) {
  std::vector<std::string> lines = numbered_lines(6, true);
  lines.erase(lines.begin() + 19);
  const Survivors kept = survivors(joined(lines));
  expect_numbered(kept.records, {0, 1});
  EXPECT_EQ(kept.messages,
            std::vector<std::string>{
                "a.csv:24:7: label differs from that of the query's first row" + rest_is_left_out});
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

TEST(CsvDataset, BlankLinesAndHeadersMayStandBetweenQueries) {
  for (const bool labelled : {false, true}) {
    const std::string header = labelled ? "xn,xd,yn,yd,zn,zd,label" : "\"x n\",xd,y_n,yd,#zn,zd";
    std::vector<std::string> lines{"", header, " \t"};
    for (std::size_t query = 0; query < 4; ++query) {
      if (query == 2) lines.insert(lines.end(), {header, "", header});
      for (const std::string& row : test::numbered_rows(query, labelled)) lines.push_back(row);
      lines.insert(lines.end(), query, "");
    }
    for (const std::string line_end : {"\n", "\r\n"}) {
      const Survivors kept = survivors(joined(lines, line_end));
      expect_numbered(kept.records, {0, 1, 2, 3});
      EXPECT_EQ(kept.messages, std::vector<std::string>{});
      EXPECT_EQ(strict_error(joined(lines, line_end)), "no DatasetError");
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

TEST(CsvDataset, CoordinatesMayBeDecimalsInOneColumnOrTwo) {
  const std::string numbers = "-0.75,1,0.5,2,3e2,1\n";
  const std::string plain = "-0.75, 0.25 ,300\n";
  std::string six, seven, three, four;
  for (int row = 0; row < 8; ++row) {
    six += numbers;
    seven += numbers.substr(0, numbers.size() - 1) + ",1\n";
    three += plain;
    four += plain.substr(0, plain.size() - 1) + ",1\n";
  }
  for (const std::string& text :
       {six, seven, three, four, "x,y,z\n" + three, "x,y,z,collides\n" + four}) {
    const Survivors kept = survivors(text);
    ASSERT_EQ(kept.records.size(), 1U) << text;
    for (std::size_t point = 0; point < 8; ++point) {
      EXPECT_EQ(kept.records[0].query.straight().at(point / 4, point % 4, 0), -0.75);
      EXPECT_EQ(kept.records[0].query.straight().at(point / 4, point % 4, 1), 0.25);
      EXPECT_EQ(kept.records[0].query.straight().at(point / 4, point % 4, 2), 300.0);
    }
    EXPECT_EQ(kept.records[0].collides.has_value(), text.ends_with(",1\n") && text != six);
  }
}

TEST(CsvDataset, ReadsSpacesLineEndsSignsAndBlankLinesAtTheEnd) {
  const std::vector<std::string> plain = numbered_lines(2, true);
  std::vector<std::string> decorated;
  for (std::string line : plain) {
    for (std::size_t at = 0; (at = line.find(',', at)) != std::string::npos; at += 4) {
      line.replace(at, 1, " ,\t ");
    }
    decorated.push_back("  +" + line + " ");
  }
  std::string without_last_newline = joined(plain);
  without_last_newline.pop_back();
  for (const std::string& text :
       {joined(decorated), joined(plain, "\r\n"), joined(decorated, "\r\n"), without_last_newline,
        joined(plain) + "\n \n\r\n\t"}) {
    const TemporaryFolder folder;
    CsvDataset source(folder.file("a.csv", text), vertex_face());
    expect_numbered(read_all(source), {0, 1});
  }
}

TEST(CsvDataset, ATruncatedLastQueryIsOneError) {
  for (std::size_t rows = 1; rows < 8; ++rows) {
    std::vector<std::string> lines = numbered_lines(3, true);
    lines.resize(16 + rows);
    const std::string error = std::to_string(16 + rows) +
                              ": truncated query: " + std::to_string(rows) +
                              " of 8 rows; if a row is missing further up, queries behind it were "
                              "put together of two";
    EXPECT_EQ(strict_error(joined(lines) + "\n\n"), error);
    const Survivors kept = survivors(joined(lines));
    expect_numbered(kept.records, {0, 1});
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + error});
    EXPECT_EQ(kept.skipped, 1U);
  }
}

TEST(CsvDataset, FaultsInManyQueriesLeaveAllOthers) {
  std::vector<std::string> lines = numbered_lines(50, true);
  std::vector<std::uint64_t> good;
  for (std::size_t query = 0; query < 50; ++query) {
    if (query % 3 == 0) {
      for (std::size_t row = query % 8; row < 8; ++row) lines[8 * query + row].replace(0, 1, "?");
    } else {
      good.push_back(query);
    }
  }
  const Survivors kept = survivors(joined(lines));
  expect_numbered(kept.records, good);
  EXPECT_EQ(kept.skipped, 17U);
  EXPECT_EQ(kept.messages.size(), 17U);
  EXPECT_EQ(kept.messages.at(1), "a.csv:28:1: not a number: \"?09\"") << "the first of five";
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

TEST(CsvDataset, MemoryDoesNotGrowWithTheFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.csv";
  std::size_t queries = 0;
  {
    CsvWriter writer(path);
    Query query{};
    for (double& x : query.coordinates) x = 0x1.fffffffffffffp-11;
    for (; queries < 50000; ++queries) writer.write(query, queries % 2 == 1);
    writer.close();
  }
  ASSERT_GT(std::filesystem::file_size(path), 40'000'000U);
  const std::size_t streamed = resident_growth([&] {
    CsvDataset source(path, vertex_face());
    std::size_t count = 0;
    while (source.next()) ++count;
    EXPECT_EQ(count, queries);
  });
  EXPECT_LT(streamed, 4'000'000U);
  const std::size_t whole = resident_growth([&] {
    const std::string text = contents(path);
    EXPECT_EQ(text.size(), std::filesystem::file_size(path));
  });
  EXPECT_GT(whole, 30'000'000U) << "the measure must see a reader that keeps the file";
}

TEST(CsvWriter, WritesThe2021FormatToTheByte) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.path() / "a.csv");
  Query query{};
  query.at(0, 0, 0) = 0.5;
  query.at(1, 3, 2) = -3.0;
  writer.write(query, true);
  writer.close();
  std::string expected = "1,2,0,1,0,1,1\n";
  for (int row = 1; row < 7; ++row) expected += "0,1,0,1,0,1,1\n";
  EXPECT_EQ(contents(folder.path() / "a.csv"), expected + "0,1,0,1,-3,1,1\n");
}

TEST(CsvWriter, WhatIsReadBackIsWhatWasWritten) {
  const TemporaryFolder folder;
  std::mt19937_64 random(7);
  std::vector<Query> queries(300);
  for (Query& query : queries) query = random_query(random);
  queries[5].coordinates[0] = 4.9e-324;
  queries[5].coordinates[1] = 1.797e308;
  queries[5].coordinates[2] = -Limits::max();
  queries[5].coordinates[3] = Limits::min();
  CsvWriter writer(folder.path() / "a.csv");
  for (std::size_t i = 0; i < queries.size(); ++i) writer.write(queries[i], i % 3 == 0);
  writer.close();
  CsvDataset source(folder.path() / "a.csv", vertex_face());
  const auto records = read_all(source);
  ASSERT_EQ(records.size(), queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(records[i].query.straight(), queries[i]);
    EXPECT_EQ(records[i].index, i);
    EXPECT_EQ(records[i].collides, std::optional(i % 3 == 0));
  }
}

TEST(CsvWriter, RefusesWhatIsNotFiniteAndStaysUsable) {
  const TemporaryFolder folder;
  CsvWriter writer(folder.path() / "a.csv");
  for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    Query query = numbered_query(0);
    query.at(1, 3, 2) = bad;
    EXPECT_THROW(writer.write(query, true), std::invalid_argument);
  }
  writer.write(numbered_query(0), false);
  writer.close();
  CsvDataset source(folder.path() / "a.csv", vertex_face());
  expect_numbered(read_all(source), {0});
}

}  // namespace
}  // namespace touchstone::verify::data::csv_dataset_test
