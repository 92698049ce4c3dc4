#include "verify/data/ground_truth_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
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

/// The truths of queries 0 to count−1 and after them: "1", "0", a toi, "-" or the error.
template <class Reader>
std::vector<std::string> answers(const std::string& text, std::uint64_t count) {
  const TemporaryFolder folder;
  const auto path = folder.file("f", text);
  std::vector<std::string> result;
  const std::string opening = error_of(folder.path(), [&] {
    Reader reader(path);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string error = error_of(folder.path(), [&] {
        if constexpr (std::is_same_v<Reader, LabelReader>) {
          result.emplace_back(reader.at(i) ? "1" : "0");
        } else {
          const auto toi = reader.at(i);
          result.push_back(toi ? toi->get_str() : "-");
        }
      });
      if (error != "no DatasetError") result.push_back(error);
    }
    if (const auto fault = reader.beyond(count)) {
      result.push_back("behind " +
                       error_of(folder.path(), [&] { throw io::DatasetError(*fault); }));
    }
  });
  if (opening != "no DatasetError") result.push_back("opening " + opening);
  return result;
}

using Answers = std::vector<std::string>;

Answers labels(const std::string& text, std::uint64_t count) {
  return answers<LabelReader>(text, count);
}
Answers tois(const std::string& text, std::uint64_t count) {
  return answers<ToiReader>(text, count);
}

TEST(LabelReader, ReadsBooleansAndBitsWithAnyWhiteSpaceAndMoreThanItsBuffer) {
  EXPECT_EQ(labels("\r\n [\ttrue ,\n false, 1,0\n]\n ", 4), (Answers{"1", "0", "1", "0"}));
  EXPECT_EQ(labels("[ ]\n", 0), Answers{});
  std::string text = "[true";
  Answers expected{"1"};
  for (int i = 1; i < 20000; ++i) {
    text += i % 7 == 0 ? ",true" : ",false";
    expected.emplace_back(i % 7 == 0 ? "1" : "0");
  }
  EXPECT_EQ(labels(text + "]", 20000), expected);
}

TEST(LabelReader, AWordThatIsNoBooleanConcernsOneQuery) {
  EXPECT_EQ(labels("[true,\n null,2,True,-1,1.0,false]", 7),
            (Answers{"1", "f:2:2: not a boolean: \"null\"", "f:2:7: not a boolean: \"2\"",
                     "f:2:9: not a boolean: \"True\"", "f:2:14: not a boolean: \"-1\"",
                     "f:2:17: not a boolean: \"1.0\"", "0"}));
}

TEST(LabelReader, OtherJsonEndsItWithAPlace) {
  const std::string no_array = ": expected a JSON array of booleans",
                    no_boolean = ": expected true or false", no_end = ": expected ',' or ']'";
  for (const auto& [text, place] : std::vector<std::pair<std::string, std::string>>{
           {"{\"a\":true}", "1:1"}, {"", "1:1"}, {"\n true", "2:2"}}) {
    EXPECT_EQ(labels(text, 1), Answers{"opening f:" + place + no_array});
  }
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"[true,[false],true]", "1:7" + no_boolean},
           {"[true,\"false\",true]", "1:7" + no_boolean},
           {"[true,,true]", "1:7" + no_boolean},
           {"[true,]", "1:7" + no_boolean},
           {"[true true]", "1:7" + no_end},
           {"[true", "1:6" + no_end},
           {"[true," + std::string(100, 'x') + "]", "1:71" + no_boolean}}) {
    EXPECT_EQ(labels(text, 3), (Answers{"1", "f:" + error, "f:" + error}));
  }
  EXPECT_EQ(labels("[true", 1), (Answers{"1", "behind f:1:6" + no_end}));
  EXPECT_EQ(labels("[true] x", 1),
            (Answers{"1", "behind f:1:8: expected nothing after the array"}));
}

TEST(ToiReader, ReadsWhatIsThere) {
  EXPECT_EQ(tois("query,toi\n0,2.5E-1\n2,1\n3,0.125\n", 5), (Answers{"1/4", "-", "1", "1/8", "-"}));
  EXPECT_EQ(tois(" query , toi \r\n 1 , 5e-1 \r\n\r\n", 2), (Answers{"-", "1/2"}));
  EXPECT_EQ(
      tois("query,toi\n0,2.8759625816382751291552598569979602E-1\n", 1),
      Answers{exact::rational_from_decimal("0.28759625816382751291552598569979602").get_str()});
}

TEST(ToiReader, ABadDecimalConcernsOneQuery) {
  EXPECT_EQ(tois("query,toi\n0,1\n1,x\n2,\n3,0\n", 4),
            (Answers{"1", "f:3:2: not a number: \"x\"", "f:4:2: not a number: \"\"", "0"}));
}

TEST(ToiReader, OtherHeadersAreOpeningErrors) {
  EXPECT_EQ(tois("", 1), Answers{"opening f: expected the header query,toi"});
  for (const std::string header : {"0,1", "toi,query", "query", "query,toi,x", "\nquery,toi"}) {
    EXPECT_EQ(tois(header + "\n0,1\n", 1), Answers{"opening f:1: expected the header query,toi"});
  }
}

TEST(ToiReader, LinesOfNoKnownQueryEndItWithAPlace) {
  for (const auto& [line, reason] : std::vector<std::pair<std::string, std::string>>{
           {"-1,1", ":1: not a query number: \"-1\""},
           {"99999999999999999999,1", ":1: not a query number: \"99999999999999999999\""},
           {"0,1", ":1: query numbers do not ascend"},
           {"1", ": expected two columns, query and toi"},
           {"1,1,1", ": expected two columns, query and toi"},
           {"", ": expected two columns, query and toi"},
           {std::string(io::LineReader::longest_line + 1, '1'), ": line longer than 1 MiB"}}) {
    EXPECT_EQ(tois("query,toi\n0,1\n" + line + "\n9,1\n", 3),
              (Answers{"1", "f:3" + reason, "f:3" + reason}));
  }
}

TEST(ToiReader, ReportsWhatIsWrongBehindTheLastQuery) {
  EXPECT_EQ(tois("query,toi\n0,1\n2,1\n3,1\n", 2),
            (Answers{"1", "-", "behind f:3:1: toi of query 2, but there are 2 queries"}));
  EXPECT_EQ(tois("query,toi\n0,1\n?\n", 1),
            (Answers{"1", "behind f:3: expected two columns, query and toi"}));
  EXPECT_EQ(tois("query,toi\n0,1\n1,1\n0,1\n", 2),
            (Answers{"1", "1", "behind f:4:1: query numbers do not ascend"}));
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
    EXPECT_TRUE(companions.beyond(1).empty());
  }
}

TEST(GroundTruthFiles, OfOtherDatasetsDoNotCount) {
  const TemporaryFolder folder;
  const auto dataset = folder.file("queries/7vf.npy", "");
  (void)folder.file("mma_bool/17vf_mma_bool.json", "[true]");
  (void)folder.file("toi/8vf_toi.csv", "query,toi\n0,1\n");
  GroundTruthFiles companions(dataset);
  EXPECT_EQ(companions.at(0).collides, std::nullopt);
  EXPECT_EQ(companions.at(0).toi, std::nullopt);
}

// ---- Writing ------------------------------------------------------------------------------------

Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

TEST(ToDecimal, WritesAllDigitsOfDyadicNumbers) {
  EXPECT_EQ(to_decimal(0), "0");
  EXPECT_EQ(to_decimal(1), "1E0");
  EXPECT_EQ(to_decimal(100), "1E2");
  EXPECT_EQ(to_decimal(ratio(1, 4)), "2.5E-1");
  EXPECT_EQ(to_decimal(ratio(-3, 1024)), "-2.9296875E-3");
  EXPECT_EQ(to_decimal(Rational(0.1)),
            "1.000000000000000055511151231257827021181583404541015625E-1");
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const Rational value = Rational(Integer(static_cast<long>(random()))) *
                           exact::power_of_two(-static_cast<long>(random() % 1100));
    EXPECT_EQ(exact::rational_from_decimal(to_decimal(value)), value);
  }
}

TEST(ToDecimal, RoundsOtherNumbersToTheNearestOf60Digits) {
  EXPECT_EQ(to_decimal(ratio(1, 3)), "3." + std::string(59, '3') + "E-1");
  EXPECT_EQ(to_decimal(ratio(2, 3)), "6." + std::string(58, '6') + "7E-1");
  EXPECT_EQ(to_decimal(ratio(-200, 3)), "-6." + std::string(58, '6') + "7E1");
  EXPECT_EQ(to_decimal(ratio(1, 5)), "2E-1");
  const Integer nines("3" + std::string(70, '0'), 10);
  EXPECT_EQ(to_decimal(ratio(nines - 1, nines)), "1E0") << "carries into a new digit";
  EXPECT_EQ(to_decimal(ratio(nines + 1, 3)), "1E70");
}

TEST(ToDecimal, IsWithinHalfAUnitOfTheLastDigit) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Integer n = Integer(static_cast<unsigned long>(random())) + 1;
    const Integer d = 3 * Integer(static_cast<unsigned long>(random() >> (random() % 60))) + 3;
    const Rational value = ratio(n, d);
    const Rational relative = abs(exact::rational_from_decimal(to_decimal(value)) - value) / value;
    EXPECT_LE(relative, exact::rational_from_decimal("5E-60")) << value;
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
  const std::string both = "{" + distance + ", " + norm,
                    expected = ", expected min_separation and norm";
  EXPECT_EQ(error(both + "}"), "no DatasetError");
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {both + R"(, "min_separation": "0.25"})", R"(repeated key "min_separation")"},
           {"{" + norm + ", " + norm + ", " + distance + "}", R"(repeated key "norm")"},
           {both + R"(, "Norm": "linf"})", R"(unknown key "Norm")" + expected},
           {both + R"(, "": {}})", R"(unknown key "")" + expected},
           {"{\"" + std::string(3000, 'k') + "\": 1}",
            "unknown key \"" + std::string(40, 'k') + "...\"" + expected},
           {std::string(65537, ' '), "has more than 65536 bytes"}}) {
    EXPECT_EQ(error(text), "separation.json: " + reason);
  }
  for (const std::string& text :
       {std::string("[]"), "{" + distance + "}", R"({"min_separation": 0.5, )" + norm + "}",
        R"({"min_separation": "-1", )" + norm + "}", "{" + distance + R"(, "norm": "l3"})",
        R"({"min_separation": "1", "norm": ")" + std::string(60000, 'x') + "\"}"}) {
    EXPECT_TRUE(error(text).starts_with("separation.json: ")) << text;
    EXPECT_LE(error(text).size(), 1100U);
  }
  EXPECT_EQ(test::error_of("", [] { (void)read_separation("/dev/zero"); }),
            "/dev/zero: has more than 65536 bytes");
}

}  // namespace
}  // namespace touchstone::verify::data::ground_truth_files_test
