#include "verify/io/output_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::io::output_file_test {
namespace {

using data::test::contents;
using data::test::error_of;
using data::test::TemporaryFolder;

TEST(OutputFile, HasItsNameAndAllItsBytesAfterClose) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "out.csv");
  std::string expected;
  for (int i = 0; i < 50000; ++i) {
    const std::string text = std::to_string(i) + "\n";
    file.write(text);
    expected += text;
  }
  const std::string large(300000, 'x');
  file.write(large);
  file.overwrite(2, "AB");
  file.write("end");
  file.close();
  expected.replace(2, 2, "AB");
  EXPECT_EQ(contents(folder.path() / "out.csv"), expected + large + "end");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.csv"});
}

TEST(OutputFile, LeavesTheOldFileUntilCloseAndNothingWithoutIt) {
  const TemporaryFolder folder;
  const auto path = folder.file("out.csv", "old");
  {
    OutputFile file(path);
    file.write("new");
    EXPECT_EQ(contents(path), "old");
    for (const std::string& name : folder.names()) {
      EXPECT_TRUE(name == "out.csv" || !name.ends_with(".csv")) << name;
    }
    EXPECT_EQ(folder.names().size(), 2U);
  }
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.csv"});
  OutputFile file(path);
  file.write("new");
  file.close();
  EXPECT_EQ(contents(path), "new");
}

TEST(OutputFile, LeavesThatOfAnotherProcessAlone) {
  const TemporaryFolder folder;
  // The number of no process.
  const std::string old = "out.csv.touchstone.partial-999999999";
  (void)folder.file(old, "x");
  OutputFile first(folder.path() / "out.csv"), second(folder.path() / "out.csv");
  second.write("second");
  second.close();
  first.write("first");
  first.close();
  EXPECT_EQ(contents(folder.path() / "out.csv"), "first");
  EXPECT_EQ(contents(folder.path() / old), "x");
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(OutputFile, NamesTheTargetWhereNoFileCanBeRenamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_EQ(error_of(folder.path(), [&] { OutputFile(folder.path() / "taken").close(); }),
            "taken: cannot write: Is a directory");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"taken"});
}

}  // namespace
}  // namespace touchstone::verify::io::output_file_test
