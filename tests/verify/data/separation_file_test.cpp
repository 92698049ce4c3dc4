#include "verify/data/ground_truth_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::separation_file_test {
namespace {

namespace fs = std::filesystem;

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
  EXPECT_EQ(recorded_separation(dataset), (Separation{.distance = 0.0, .norm = Norm::linf}));
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
}  // namespace touchstone::verify::data::separation_file_test
