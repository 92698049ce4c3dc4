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

DatasetOptions vertex_face() { return {.kind = ContactKind::vertex_face}; }

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

const std::string rest_is_left_out =
    "; the rest of the file is left out, since it is unknown from here on which eight rows are a "
    "query: mend this line";

/// A line instead of line 12, the fourth of query 1, and its error.
struct Fault {
  std::string line;
  std::string error;
  /// True if the line is a row: then it costs its query only. Behind a line that is none rows
  /// cannot be counted, so that no further query is read.
  bool is_row = true;
};

TEST(CsvDataset, AFaultIsLocatedAndCostsItsQueryOrTheRestOfTheFile) {
  for (const auto& [line, error, is_row] : std::vector<Fault>{
           {"1,0,2,1,3,1,1", "12:2: zero denominator"},
           {"1,1,2,1,3,0,1", "12:6: zero denominator"},
           {"1,1,x,1,3,1,1", "12:3: not a number: \"x\""},
           {"1,1,2,1,,1,1", "12:5: not a number: \"\""},
           {"1,1,2,1,0.1,1,1", "12:5: not exactly a double (--round takes the nearest)"},
           {"1,1,2,1,1" + std::string(400, '0') + ",1,1", "12:5: beyond the range of double"},
           {"1,1,2,1,3,1,2", "12:7: label must be 0 or 1: \"2\""},
           {"1,1,2,1,3,1,true", "12:7: label must be 0 or 1: \"true\""},
           {"1,1,2,1,3,1,0", "12:7: label differs from that of the query's first row", false},
           {"1,1,2,1,3,1", "12: 6 columns, expected 7 as before", false},
           {"1,1,2,1,3,1,1,1", "12: 8 columns, expected 7 as before", false},
           {"", "12: blank line inside a query", false},
           {" \t", "12: blank line inside a query", false},
           {"xn,xd,yn,yd,zn,zd,label", "12: no number in the line", false},
           {",,,,,,", "12: no number in the line", false},
           {"1,1,2,1,3,1,\"1", "12:7: malformed quoted field", false},
           {"1,1,2,\"1\"1,3,1,1", "12:4: malformed quoted field", false}}) {
    const std::string whole = error + (is_row ? "" : rest_is_left_out);
    std::vector<std::string> lines = numbered_lines(3, true);
    lines[11] = line;
    EXPECT_EQ(strict_error(joined(lines)), whole);
    const Survivors kept = survivors(joined(lines));
    expect_numbered(kept.records,
                    is_row ? std::vector<std::uint64_t>{0, 2} : std::vector<std::uint64_t>{0});
    EXPECT_EQ(kept.skipped, 1U);
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a.csv:" + whole});
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
  DatasetOptions options{.kind = ContactKind::vertex_face, .round = true, .keep_going = true};
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

// ---- Every shape, in CSV and NumPy --------------------------------------------------------------

/// A shape and the line and the extents that files have of it.
struct ShapeCase {
  AnyShape shape;
  std::string line;
  std::vector<std::uint64_t> extents;
};

const ShapeCase cubic{{ContactKind::edge_edge, 3, false}, "degree,3", {4, 4, 3}};
const ShapeCase rational{{ContactKind::edge_edge, 2, true}, "rational,2", {3, 4, 4}};
const ShapeCase weighted{{ContactKind::edge_edge, 1, true}, "rational,1", {2, 4, 4}};
const ShapeCase straight{{ContactKind::edge_edge, 1, false}, "degree,1", {2, 4, 3}};
const ShapeCase highest{{ContactKind::edge_edge, 8, true}, "rational,8", {9, 4, 4}};
const std::array all{cubic, rational, weighted, straight, highest};

/// The rows of numbered queries, as quarters or as decimals, odd queries labelled as collisions.
std::string numbered_text(const AnyShape& shape, std::size_t count, bool fractions, bool labels) {
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
    const auto source = open_dataset(path, {.kind = ContactKind::edge_edge});
    (void)read_all(*source);
  });
}

TEST(CurvedCsv, IsReadInEveryShapeAndFormatOfNumbers) {
  for (const ShapeCase& of : all) {
    for (const bool fractions : {false, true}) {
      for (const bool labels : {false, true}) {
        const std::string text = of.line + "\n" + numbered_text(of.shape, 3, fractions, labels);
        const TemporaryFolder folder;
        const auto source = open_dataset(folder.file("a_ee.csv", text));
        EXPECT_EQ(source->shape(), of.shape);
        const auto records = read_all(*source);
        expect_numbered(records, {0, 1, 2}, of.shape);
        for (const RecordedQuery& record : records) {
          EXPECT_EQ(record.collides, labels ? std::optional(record.index == 1) : std::nullopt);
        }
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
           {"rational,1\n1,2,3,0\n" + rows, "2:4: a weight must be positive"},
           {"rational,1\n1,2,3,-1\n" + rows, "2:4: a weight must be positive"},
           {"rational,2\n1,2,3\n", "2: 3 columns, expected 4, 5, 8 or 9" + lost},
           {"rational,2\n" + rows + "degree,2\n", "14: 2 columns, expected 4 as before" + lost}}) {
    EXPECT_EQ(strict_error(text), error);
  }
  for (const char* const word : {"degree\n1,2,3\n", "degrees,2\n"}) {
    EXPECT_TRUE(strict_error(word).ends_with(rest_is_left_out)) << word;
  }
}

TEST(Curved, AreReadBackAsTheyWereWritten) {
  for (const ShapeCase& of : all) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a_ee.csv", array = folder.path() / "a_ee.npy";
    CsvWriter writer(path);
    NpyWriter array_writer(array, of.shape);
    for (std::size_t i = 0; i < 600; ++i) {
      writer.write(numbered(of.shape, i), i % 2 == 1);
      array_writer.write(numbered(of.shape, i).numbers());
    }
    std::vector<double> infinite(of.shape.numbers_of_query(), HUGE_VAL);
    EXPECT_THROW(writer.write({of.shape, infinite}, true), std::invalid_argument);
    EXPECT_THROW(array_writer.write(infinite), std::invalid_argument);
    writer.close();
    array_writer.close();
    const std::string line = of.shape.is_straight() ? "" : of.line + "\n";
    EXPECT_TRUE(contents(path).starts_with(line + "0,1,1,4,1,2,"));
    for (const auto& file : {path, array}) {
      expect_numbered(read_all(*open_dataset(file)), indices_up_to(600), of.shape);
    }
    EXPECT_EQ(read_all(*open_dataset(path))[1].collides, std::optional(true));
    const std::string rows = csv_rows(numbered(of.shape, 0), std::nullopt);
    EXPECT_EQ(read_all(*open_dataset(folder.file("b_ee.csv", rows + rows))).size(), 2U);
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

TEST(CurvedNpy, SkipsAQueryWithAnInvalidNumberOrWeight) {
  struct Case {
    std::size_t place;  ///< in query 1
    double number;
    std::vector<std::uint64_t> extents;
    std::string fault;
  };
  const std::vector<std::uint64_t> lines{3, 8, 3}, curves{3, 2, 4, 4};
  for (const auto& [place, number, extents, fault] :
       std::vector<Case>{{0, std::nan(""), lines, "point 0, x: not finite"},
                         {13, HUGE_VAL, lines, "point 4, y: not finite"},
                         {23, -HUGE_VAL, lines, "point 7, z: not finite"},
                         {3, std::nan(""), curves, "point 0, weight: not positive and finite"},
                         {15, 0.0, curves, "point 3, weight: not positive and finite"},
                         {15, HUGE_VAL, curves, "point 3, weight: not positive and finite"}}) {
    std::vector<double> numbers(extents == lines ? 72 : 96, 1.0);
    numbers[numbers.size() / 3 + place] = number;
    const TemporaryFolder folder;
    const Survivors kept = read_survivors(
        folder.file("a_ee.npy", tests::array("<f8", extents, numbers)), folder.path());
    EXPECT_EQ(kept.messages, std::vector<std::string>{"a_ee.npy: query 1, " + fault});
    EXPECT_EQ(kept.records.size(), 2U);
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
