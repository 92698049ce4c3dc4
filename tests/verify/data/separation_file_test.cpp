#include "verify/data/separation_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "tests/support/folder_test.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data::separation_file_test {
namespace {

namespace fs = std::filesystem;

TEST(DistanceFromText, TakesWhatStrtodTakes) {
  EXPECT_EQ(distance_from_text("1e-8"), 1e-8);
  EXPECT_EQ(distance_from_text("0x1.8p-3"), 0.1875);
  EXPECT_EQ(distance_from_text("0.1"), 0.1);
  EXPECT_EQ(distance_from_text("5e-324"), std::numeric_limits<double>::denorm_min());
  for (const char* zero : {"0", "-0.0", "0x0p0", "0e7"}) {
    ASSERT_EQ(distance_from_text(zero), 0.0) << zero;
    EXPECT_FALSE(std::signbit(*distance_from_text(zero)));
  }
}

TEST(DistanceFromText, RefusesAllElse) {
  for (const char* bad : {"", " 1", "1 ", "x", "1e", "-1", "-1e-300", "nan", "inf", "1e999",
                          "1e-999", "0x1p-1080", "1,5", "1e-8m"}) {
    EXPECT_EQ(distance_from_text(bad), std::nullopt) << bad;
  }
}

class SeparationFile : public tests::FolderTest {
 protected:
  [[nodiscard]] fs::path write(const std::string& text) const {
    std::ofstream(path("separation.json"), std::ios::binary) << text;
    return path("separation.json");
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
  write_separation(folder(), {.distance = 0.5});
  EXPECT_EQ(recorded_separation(dataset).distance, 0.5);
  EXPECT_EQ(recorded_separation(folder() / "a.csv").distance, 0.5);
  write_separation(dataset.parent_path(), {.distance = 0.25});
  EXPECT_EQ(recorded_separation(dataset).distance, 0.25) << "the nearer one counts";
}

TEST_F(SeparationFile, UnknownAndRepeatedKeysAreErrors) {
  const auto error = [&](const std::string& text) -> std::string {
    try {
      (void)read_separation(write(text));
    } catch (const io::DatasetError& fault) {
      return fault.reason();
    }
    return "no error";
  };
  const std::string distance = R"("min_separation": "0.5")", norm = R"("norm": "l2")";
  EXPECT_EQ(error("{" + distance + ", " + norm + "}"), "no error");
  EXPECT_EQ(error("{" + distance + ", " + norm + ", " + R"("min_separation": "0.25")" + "}"),
            "repeated key \"min_separation\"");
  EXPECT_EQ(error("{" + norm + ", " + norm + ", " + distance + "}"), "repeated key \"norm\"");
  EXPECT_EQ(error("{" + distance + ", " + norm + R"(, "Norm": "linf"})"),
            "unknown key \"Norm\", expected min_separation and norm");
  EXPECT_EQ(error("{" + distance + ", " + norm + R"(, "": {}})"),
            "unknown key \"\", expected min_separation and norm");
  EXPECT_EQ(error("{\"" + std::string(3000, 'k') + "\": 1}"),
            "unknown key \"" + std::string(40, 'k') + "...\", expected min_separation and norm");
}

TEST_F(SeparationFile, MessagesAndFilesAreBounded) {
  const auto error = [&](const fs::path& file) -> std::string {
    try {
      (void)read_separation(file);
    } catch (const io::DatasetError& fault) {
      return fault.reason();
    }
    return "no error";
  };
  EXPECT_LE(error(write(R"({"min_separation": ")" + std::string(60000, 'x'))).size(), 1003U);
  EXPECT_LE(
      error(write(R"({"min_separation": "1", "norm": ")" + std::string(60000, 'x') + "\"}")).size(),
      1003U);
  EXPECT_EQ(error(write(std::string(65537, ' '))), "has more than 65536 bytes");
  EXPECT_EQ(error("/dev/zero"), "has more than 65536 bytes");
}

TEST_F(SeparationFile, AnInvalidOneIsAnErrorThatNamesTheFile) {
  for (const char* bad :
       {"", "[]", "{}", R"({"min_separation": 0.5, "norm": "l2"})", R"({"min_separation": "0.5"})",
        R"({"min_separation": "-1", "norm": "l2"})",
        R"({"min_separation": "0.5", "norm": "l3"})"}) {
    try {
      (void)read_separation(write(bad));
      ADD_FAILURE() << bad;
    } catch (const io::DatasetError& error) {
      EXPECT_EQ(error.path(), path("separation.json"));
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::data::separation_file_test
