#include "verify/data/separation_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/folder_test.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data::separation_file_test {
namespace {

namespace fs = std::filesystem;

class SeparationFile : public tests::FolderTest {
 protected:
  [[nodiscard]] fs::path write(const std::string& text) const {
    std::ofstream(path("separation.json"), std::ios::binary) << text;
    return path("separation.json");
  }
  [[nodiscard]] static std::string reason(const fs::path& file) {
    try {
      (void)read_separation(file);
    } catch (const io::DatasetError& fault) {
      return fault.reason();
    }
    return "no error";
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
  const auto error = [&](const std::string& text) { return reason(write(text)); };
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
  const std::string many(60000, 'x');
  EXPECT_LE(reason(write(R"({"min_separation": ")" + many)).size(), 1003U);
  EXPECT_LE(reason(write(R"({"min_separation": "1", "norm": ")" + many + "\"}")).size(), 1003U);
  EXPECT_EQ(reason(write(std::string(65537, ' '))), "has more than 65536 bytes");
  EXPECT_EQ(reason("/dev/zero"), "has more than 65536 bytes");
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
