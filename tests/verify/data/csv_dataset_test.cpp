#include "verify/data/csv_dataset.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/data/npy_dataset.hpp"

namespace touchstone::verify::data::csv_dataset_test {
namespace {

using base::AnyQuery;
using test::contents;
using test::error_of;
using test::expect_numbered;
using test::joined;
using test::numbered;
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

// ---- Every shape, in CSV and NumPy --------------------------------------------------------------

/// A shape and the line and the extents that files have of it.
struct ShapeCase {
  QueryShape shape;
  std::string line;
  std::vector<std::uint64_t> extents;
};

const ShapeCase cubic{{Kind::edge_edge, 3, false}, "degree,3", {4, 4, 3}};
const ShapeCase rational{{Kind::edge_edge, 2, true}, "rational,2", {3, 4, 4}};
const ShapeCase weighted{{Kind::edge_edge, 1, true}, "rational,1", {2, 4, 4}};
const ShapeCase straight{{Kind::edge_edge, 1, false}, "degree,1", {2, 4, 3}};
const ShapeCase highest{{Kind::edge_edge, 8, true}, "rational,8", {9, 4, 4}};
const std::array all{cubic, rational, weighted, straight, highest};

/// The rows of numbered queries, as quarters or as decimals, odd queries labelled as collisions.
std::string numbered_text(const QueryShape& shape, std::size_t count, bool fractions, bool labels) {
  std::string text;
  for (std::size_t index = 0; index < count; ++index) {
    const AnyQuery query = numbered(shape, index);
    for (std::size_t i = 0; i < query.numbers().size(); ++i) {
      const double x = query.numbers()[i];
      text += fractions ? std::to_string(std::lround(4 * x)) + ",4" : std::to_string(x);
      const bool ends_row = (i + 1) % shape.numbers_of_point() == 0;
      if (ends_row && labels) text += index % 2 == 1 ? ",1" : ",0";
      text += ends_row ? "\n" : ",";
    }
  }
  return text;
}

template <class Number = double>
std::string array_text(const ShapeCase& of, std::size_t count, const std::string& descr = "<f8") {
  std::vector<std::uint64_t> extents{count};
  extents.insert(extents.end(), of.extents.begin(), of.extents.end());
  std::vector<Number> numbers;
  for (std::size_t index = 0; index < count; ++index) {
    const AnyQuery query = numbered(of.shape, index);
    numbers.insert(numbers.end(), query.numbers().begin(), query.numbers().end());
  }
  return tests::array(descr, extents, numbers);
}

std::vector<std::uint64_t> indices_up_to(std::size_t count) {
  std::vector<std::uint64_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

/// The first error of a file of queries.
std::string error_in(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.file(name, text);
  return error_of(folder.path(), [&] {
    const auto source = open_dataset(path, {.kind = Kind::edge_edge});
    (void)read_all(*source);
  });
}

TEST(CurvedCsv, IsReadInEveryShapeAndFormatOfNumbers) {
  for (const ShapeCase& of : all) {
    for (const bool fractions : {false, true}) {
      for (const bool labels : {false, true}) {
        const TemporaryFolder folder;
        const std::string text = numbered_text(of.shape, 3, fractions, labels);
        const auto source = open_dataset(folder.file("a_ee.csv", of.line + "\n" + text));
        EXPECT_EQ(source->shape(), of.shape);
        const auto records = read_all(*source);
        expect_numbered(records, {0, 1, 2}, of.shape);
        EXPECT_EQ(records.at(0).collides, labels ? std::optional(false) : std::nullopt);
        EXPECT_EQ(records.at(1).collides, labels ? std::optional(true) : std::nullopt);
      }
    }
  }
}

TEST(CurvedCsv, NamesItsFaultyLines) {
  const std::string range = ": the degree of curves must be from 1 to 8, not ";
  const std::string whole = ": the degree must be a whole number: ";
  const std::string rows = numbered_text(rational.shape, 1, false, false);
  const std::string lost =
      "; the rest of the file is left out, since it is unknown from here on which 12 rows are a "
      "query: mend this line";
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"degree,9\n", "1:2" + range + "9"},
           {"\nrational,0\n", "2:2" + range + "0; repeat the control point of a point at rest"},
           {"rational,-1\n", "1:2" + whole + "\"-1\""},
           {"degree,\n", "1:2" + whole + "\"\""},
           {"degree,2\n", " no queries"},
           {"rational,2\n1,2,3\n", "2: 3 columns, expected 4, 5, 8 or 9" + lost},
           {"rational,2\n" + rows + "degree,2\n", "14: 2 columns, expected 4 as before" + lost}}) {
    EXPECT_EQ(strict_error(text), error);
  }
  for (const char* const word : {"degree\n1,2,3\n", "degrees,2\n"}) {
    EXPECT_TRUE(strict_error(word).ends_with(rest_is_left_out)) << word;
  }
}

TEST(CurvedCsv, SkipsAQueryWithAnInvalidNumberOrWeight) {
  const std::string good = numbered_text(weighted.shape, 1, false, false);
  std::string rest;
  for (int i = 0; i < 7; ++i) rest += "1,2,3,1\n";
  for (const auto& [row, fault] : {std::pair{"1,2,3,0", ":4: a weight must be positive"},
                                   std::pair{"1,2,3,-1", ":4: a weight must be positive"},
                                   std::pair{"1,2,x,1", ":3: not a number: \"x\""}}) {
    const Survivors kept = survivors("rational,1\n" + good + row + "\n" + rest + good);
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:10" + std::string(fault)});
    expect_numbered({kept.records.front()}, {0}, weighted.shape);
    EXPECT_EQ(kept.records.back().index, 2U);
  }
}

TEST(CurvedCsv, IsReadBackAsItWasWritten) {
  for (const ShapeCase& of : all) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a_ee.csv";
    CsvWriter writer(path);
    for (std::size_t i = 0; i < 3; ++i) writer.write(numbered(of.shape, i), i % 2 == 1);
    writer.close();
    const std::string line = of.shape.is_straight() ? "" : of.line + "\n";
    EXPECT_TRUE(contents(path).starts_with(line + "0,1,1,4,1,2,"));
    const auto records = read_all(*open_dataset(path));
    expect_numbered(records, {0, 1, 2}, of.shape);
    EXPECT_EQ(records[1].collides, std::optional(true));
    const std::string rows = csv_rows(numbered(of.shape, 0), std::nullopt);
    EXPECT_TRUE(rows.starts_with(line));
    expect_numbered(read_all(*open_dataset(folder.file("b_ee.csv", rows))), {0}, of.shape);
    const auto twice = read_all(*open_dataset(folder.file("c_ee.csv", rows + rows)));
    EXPECT_EQ(twice.size(), 2U);
  }
}

/// More queries than a block has.
TEST(CurvedNpy, IsReadInEveryShapeAndFromArchivesWithLabels) {
  constexpr std::size_t count = 600;
  std::vector<std::uint8_t> labels(count);
  for (std::size_t i = 0; i < count; i += 3) labels[i] = 1;
  for (const ShapeCase& of : all) {
    const TemporaryFolder folder;
    NpyDataset source(folder.file("a_ee.npy", array_text(of, 4)), {});
    EXPECT_EQ(source.shape(), of.shape);
    EXPECT_EQ(source.progress(), 0.0);
    EXPECT_EQ(source.next().value().collides, std::nullopt);
    EXPECT_EQ(source.progress(), 0.25);
    expect_numbered(read_all(source), {1, 2, 3}, of.shape);
    EXPECT_EQ(source.progress(), 1.0);
    for (const std::string& queries :
         {array_text(of, count), array_text<float>(of, count, "<f4")}) {
      for (const bool is_compressed : {false, true}) {
        const auto archived = read_all(*open_dataset(tests::archive(
            folder.path() / "b_ee.npz",
            {{"queries.npy", queries}, {"collides.npy", tests::array("|b1", {count}, labels)}},
            is_compressed)));
        expect_numbered(archived, indices_up_to(count), of.shape);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(archived[i].collides, i % 3 == 0);
      }
    }
  }
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder.path(),
                     [&] {
                       (void)open_dataset(tests::archive(
                           folder.path() / "c_ee.npz",
                           {{"queries.npy", array_text(straight, 3)},
                            {"collides.npy", tests::array("|b1", {count}, labels)}}));
                     }),
            "c_ee.npz: collides: shape (600), expected (3)");
}

TEST(CurvedNpy, IsReadBackAsItWasWritten) {
  for (const ShapeCase& of : all) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a_ee.npy";
    NpyWriter writer(path, of.shape);
    for (std::size_t i = 0; i < 600; ++i) writer.write(numbered(of.shape, i).numbers());
    std::vector<double> infinite(of.shape.numbers_of_query(), HUGE_VAL);
    EXPECT_THROW(writer.write(infinite), std::invalid_argument);
    writer.close();
    EXPECT_EQ(NpyArray(path).shape().size(), of.shape.is_straight() ? 3U : 4U);
    expect_numbered(read_all(*open_dataset(path)), indices_up_to(600), of.shape);
  }
}

TEST(CurvedNpy, SkipsAQueryWithAnInvalidNumberOrWeight) {
  const auto expect_skipped = [](std::vector<double> numbers, std::vector<std::uint64_t> extents,
                                 const std::string& fault) {
    const TemporaryFolder folder;
    const Survivors kept = read_survivors(
        folder.file("a_ee.npy", tests::array("<f8", extents, numbers)), folder.path());
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a_ee.npy: query 1, " + fault});
    EXPECT_EQ(kept.records.size(), 2U);
  };
  for (std::size_t i = 0; i < 24; ++i) {
    std::vector<double> numbers(72, 1.0);
    numbers[24 + i] = std::array{std::nan(""), HUGE_VAL, -HUGE_VAL}.at(i % 3);
    expect_skipped(numbers, {3, 8, 3},
                   "point " + std::to_string(i / 3) + ", " + "xyz"[i % 3] + ": not finite");
  }
  for (const auto& [place, value, point] :
       {std::tuple{std::size_t{3}, std::nan(""), "0"}, std::tuple{std::size_t{15}, 0.0, "3"},
        std::tuple{std::size_t{15}, HUGE_VAL, "3"}}) {
    std::vector<double> numbers(96, 1.0);
    numbers[32 + place] = value;
    expect_skipped(numbers, {3, 2, 4, 4},
                   std::string("point ") + point + ", weight: not positive and finite");
  }
}

TEST(NpyDataset, ThatBecomesShorterGivesWhatIsThereAndThenOneError) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a_vf.npy";
  for (const bool keep_going : {false, true}) {
    NpyWriter writer(path);
    for (std::size_t i = 0; i < 3000; ++i) writer.write(test::numbered_query(i));
    writer.close();
    std::vector<std::string> messages;
    NpyDataset source(path,
                      {.keep_going = keep_going, .on_skip = [&](const io::DatasetError& fault) {
                         messages.emplace_back(fault.reason());
                       }});
    std::vector<RecordedQuery> records{source.next().value()};
    std::filesystem::resize_file(path, 128 + 192 * 2000);
    const std::string error = error_of(folder.path(), [&] {
      while (auto record = source.next()) records.push_back(*record);
    });
    expect_numbered(records, indices_up_to(1536));  // whole blocks
    const std::string reason = "the array ends early: it has become shorter while it was read";
    EXPECT_EQ(error, keep_going ? "no DatasetError" : "a_vf.npy: " + reason);
    EXPECT_EQ(messages, std::vector<std::string>(keep_going ? 1 : 0, reason));
    EXPECT_EQ(source.skipped(), keep_going ? 1U : 0U);
    EXPECT_FALSE(source.next().has_value()) << "it has ended";
  }
}

TEST(CurvedNpy, OfAnotherShapeIsRefused) {
  const std::vector<double> numbers(480, 1.0);
  const std::string expected =
      ", expected (N, 8, 3), or (N, K+1, 4, 3) for curves of degree K from 1 to 8 (repeat the "
      "control point of a point at rest), or (N, K+1, 4, 4) with weights";
  const auto error = [&](const std::vector<std::uint64_t>& extents) {
    return error_in("a.npy", tests::array("<f8", extents, numbers));
  };
  EXPECT_EQ(error({4, 10, 4, 3}), "a.npy: shape (4, 10, 4, 3)" + expected);
  EXPECT_EQ(error({8, 4, 3, 5}), "a.npy: shape (8, 4, 3, 5)" + expected);
  EXPECT_EQ(error({6, 4, 4, 5}), "a.npy: shape (6, 4, 4, 5)" + expected);
  EXPECT_EQ(error({40, 1, 4, 3}), "a.npy: shape (40, 1, 4, 3)" + expected);
  EXPECT_EQ(error({40, 4, 3}), "a.npy: shape (40, 4, 3)" + expected);
}

}  // namespace
}  // namespace touchstone::verify::data::csv_dataset_test
