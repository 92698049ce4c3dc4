#include "verify/data/ground_truth_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::ground_truth_files_test {
namespace {

namespace fs = std::filesystem;
using exact::Integer;
using exact::Rational;
using test::contents;
using test::error_of;
using test::TemporaryFolder;

/// The truths of queries 0 to count−1, separated by spaces, and the errors: "1", "0", a toi or "-".
template <class Reader>
std::string answers(const std::string& text, std::uint64_t count) {
  const TemporaryFolder folder;
  const auto path = folder.file("f", text);
  std::string result;
  const auto add_error = [&](const auto& action) {
    const std::string error = error_of(folder.path(), action);
    if (error != "no DatasetError") result += "[" + error + "] ";
  };
  add_error([&] {
    Reader reader(path);
    for (std::uint64_t i = 0; i < count; ++i) {
      add_error([&] {
        if constexpr (std::is_same_v<Reader, Labels>) {
          result += reader.at(i) ? "1 " : "0 ";
        } else {
          const auto toi = reader.at(i);
          result += (toi ? toi->get_str() : "-") + " ";
        }
      });
    }
    reader.end(count);
  });
  return result;
}

/// A text of labels or times, a number of queries, and their truths.
struct Row {
  std::string text;
  std::uint64_t count;
  std::string expected;
};

TEST(Labels, AreTheBooleansOfAnArrayOrOneErrorOfTheFile) {
  const std::string way_out = "; mend the file, or move it to read queries without labels] ";
  for (const auto& [text, count, expected] :
       std::vector<Row>{{"\r\n [\ttrue ,\n false, 1,0\n]\n ", 4, "1 0 1 0 "},
                        {"\xEF\xBB\xBF[ ]\n", 0, ""},
                        {"[true]", 2, "1 [f: no label for query 1: there are only 1] "},
                        {"[true,false]", 1, "1 [f: 2 labels, but 1 queries] "},
                        {"[true,\n null]", 2, "[f: label 1 is no boolean: \"null\"" + way_out},
                        {"[2]", 1, "[f: label 0 is no boolean: \"2\"" + way_out},
                        {"[\"x\"]", 1, "[f: label 0 is no boolean: \"\"x\"\"" + way_out},
                        {"{\"a\":true}", 1, "[f: expected a JSON array of booleans" + way_out}}) {
    EXPECT_EQ(answers<Labels>(text, count), expected);
  }
  for (const auto& [text, place] :
       std::vector<std::pair<std::string, std::string>>{{"", "line 1, column 1"},
                                                        {"[true,\nTrue]", "line 2, column 1"},
                                                        {"[true,]", "line 1, column 7"},
                                                        {"[true] x", "line 1, column 8"}}) {
    const std::string error = answers<Labels>(text, 1);
    EXPECT_TRUE(error.starts_with("[f: no JSON: parse error at " + place + ": ")) << error;
    EXPECT_TRUE(error.ends_with(way_out)) << error;
  }
}

TEST(ToiReader, GivesTheTimesAndTheErrorOfEachLine) {
  const std::string header = "query,toi\n", two = "expected two columns, query and toi] ",
                    no_header = "expected the header query,toi] ",
                    wrong_order = "query numbers do not ascend] ";
  const std::string long_line(io::LineReader::longest_line + 1, '1');
  for (const auto& [text, count, expected] : std::vector<Row>{
           {header + "0,2.5E-1\n2,1\n3,0.125\n", 5, "1/4 - 1 1/8 - "},
           {" query , toi \r\n 1 , 5e-1 \r\n\r\n", 2, "- 1/2 "},
           {header + "0,0.28759625816382751291552598569979602\n", 1,
            exact::rational_from_decimal("0.28759625816382751291552598569979602").get_str() + " "},
           {header + "0,1\n1,x\n2,\n3,0\n", 4,
            "1 [f:3:2: not a number: \"x\"] [f:4:2: not a number: \"\"] 0 "},
           {header + "0,1\n-1,1\n2,1\n", 3, "1 [f:3:1: not a query number: \"-1\"] 1 "},
           {header + "0,1\n0,1\n2,1\n", 3, "1 [f:3:1: " + wrong_order + "1 "},
           {header + "0,1\n1,1,1\n", 2, "1 [f:3: " + two},
           {header + "0,1\n\n2,1\n", 2,
            "1 [f:3: " + two +
                "[f:4:1: toi of query 2, but there are "
                "2 queries] "},
           {header + long_line, 2, "[f:2: line longer than 1 MiB] - "},
           {header + "0,1\n?\n", 1, "1 [f:3: " + two},
           {"", 1, "[f: " + no_header},
           {"0,1\n", 1, "[f:1: " + no_header},
           {"toi,query\n0,1\n", 1, "[f:1: " + no_header},
           {"query,toi,x\n0,1\n", 1, "[f:1: " + no_header}}) {
    EXPECT_EQ(answers<ToiReader>(text, count), expected);
  }
}

TEST(GroundTruthFiles, AreFoundBesideAndBelowTheFolderOfTheDatasetInOrder) {
  const TemporaryFolder folder;
  const auto dataset = folder.file("scene/queries/7vf.csv", "");
  const auto path_of_labels = [&] {
    return GroundTruthFiles(dataset).label_path().lexically_normal();
  };
  EXPECT_EQ(path_of_labels(), "");
  for (const std::string place :
       {"scene/queries/7vf_mma_bool.json", "scene/queries/mma_bool/7vf_mma_bool.json",
        "scene/mma_bool/7vf_mma_bool.json"}) {
    const auto path = folder.file(place, "[true]");
    EXPECT_EQ(path_of_labels(), path);
  }
  for (const std::string place :
       {"scene/queries/7vf_toi.csv", "scene/queries/toi/7vf_toi.csv", "scene/toi/7vf_toi.csv"}) {
    (void)folder.file(place, "query,toi\n0," + std::to_string(place.size()) + "\n");
    GroundTruthFiles companions(dataset);
    const RecordedTruth truth = companions.at(0);
    EXPECT_EQ(truth.collides, std::optional(true));
    EXPECT_EQ(truth.toi, std::optional(Rational(place.size())));
    EXPECT_NO_THROW(companions.end(1));
  }
}

// ---- Writing ------------------------------------------------------------------------------------

Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

TEST(ToDecimal, WritesAllDigitsOfDyadicNumbersAnd60OfOthers) {
  const Integer nines("3" + std::string(70, '0'), 10);
  for (const auto& [value, text] : std::vector<std::pair<Rational, std::string>>{
           {0, "0"},
           {1, "1E0"},
           {100, "1E2"},
           {ratio(-3, 1024), "-2.9296875E-3"},
           {Rational(0.1), "1.000000000000000055511151231257827021181583404541015625E-1"},
           {ratio(1, 3), "3." + std::string(59, '3') + "E-1"},
           {ratio(-200, 3), "-6." + std::string(58, '6') + "7E1"},
           {ratio(1, 5), "2E-1"},
           {ratio(nines - 1, nines), "1E0"},  // carries into a new digit
           {ratio(nines + 1, 3), "1E70"}}) {
    EXPECT_EQ(to_decimal(value), text);
  }
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const Rational value = Rational(Integer(static_cast<long>(random()))) *
                           exact::power_of_two(-static_cast<long>(random() % 1100));
    EXPECT_EQ(exact::rational_from_decimal(to_decimal(value)), value);
    const Rational third = abs(value) / 3;
    const Rational error = abs(exact::rational_from_decimal(to_decimal(third)) - third);
    EXPECT_LE(error, third * exact::rational_from_decimal("5E-60")) << value;
  }
}

TEST(ToiWriter, RefusesQueriesOutOfOrder) {
  const TemporaryFolder folder;
  ToiWriter writer(folder.path() / "a_toi.csv");
  writer.write(4, 1);
  EXPECT_THROW(writer.write(4, 1), std::invalid_argument);
  EXPECT_THROW(writer.write(3, 1), std::invalid_argument);
  writer.write(5, 1);
  writer.close();
  EXPECT_EQ(contents(folder.path() / "a_toi.csv"), "query,toi\n4,1E0\n5,1E0\n");
}

// ---- The file of a separation -------------------------------------------------------------------

class SeparationFile : public tests::FolderTest {
 protected:
  /// The error of reading a file with this text.
  [[nodiscard]] std::string error(const std::string& text) const {
    std::ofstream(path("separation.json"), std::ios::binary) << text;
    return test::error_of(folder(), [&] { (void)read_separation(path("separation.json")); });
  }
};

TEST_F(SeparationFile, GivesBackWhatWasWritten) {
  for (const double distance : {1e-2, 1e-100, 1.0 / 3.0, 0x1p1000}) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Separation separation{.distance = distance, .norm = norm};
      write_separation(folder(), separation);
      EXPECT_EQ(read_separation(path("separation.json")), separation);
    }
  }
  write_separation(folder(), {.distance = 0.75, .norm = Norm::l2});
  EXPECT_EQ(read("separation.json"), "{\"min_separation\": \"0x1.8p-1\", \"norm\": \"l2\"}\n");
}

TEST_F(SeparationFile, BelongsToTheFolderAndToThoseInIt) {
  const fs::path dataset = folder() / "vertex-face" / "a.csv";
  fs::create_directories(dataset.parent_path());
  EXPECT_EQ(recorded_separation(dataset), Separation{});
  write_separation(folder(), {.distance = 0.5, .norm = Norm::linf});
  EXPECT_EQ(recorded_separation(dataset).distance, 0.5);
  EXPECT_EQ(recorded_separation(folder() / "a.csv").distance, 0.5);
  write_separation(dataset.parent_path(), {.distance = 0.25, .norm = Norm::linf});
  EXPECT_EQ(recorded_separation(dataset).distance, 0.25) << "the nearer one counts";
}

TEST_F(SeparationFile, AnInvalidOneIsAnErrorOfBoundedLengthThatNamesTheFile) {
  const std::string distance = R"("min_separation": "0.5")", norm = R"("norm": "l2")";
  const std::string both = "{" + distance + ", " + norm;
  EXPECT_EQ(error(both + "}"), "no DatasetError");
  EXPECT_EQ(error(both + R"(, "min_separation": "0.25"})"),
            "separation.json: repeated key \"min_separation\"");
  EXPECT_EQ(error(both + R"(, "Norm": "linf"})"),
            "separation.json: expected min_separation and norm, and nothing else");
  for (const std::string& text :
       {std::string("[]"), std::string(65537, ' '), "{" + distance + "}",
        R"({"min_separation": 0.5, )" + norm + "}", R"({"min_separation": "-1", )" + norm + "}",
        "{" + distance + R"(, "norm": "l3"})",
        R"({"min_separation": "1", "norm": ")" + std::string(60000, 'x') + "\"}"}) {
    EXPECT_TRUE(error(text).starts_with("separation.json: ")) << text;
    EXPECT_LE(error(text).size(), 1100U);
  }
  EXPECT_EQ(test::error_of("", [] { (void)read_separation("/dev/zero"); }),
            "/dev/zero: has more than 65536 bytes");
}

}  // namespace
}  // namespace touchstone::verify::data::ground_truth_files_test
