#include "verify/cli/files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/folder_test.hpp"

namespace touchstone::verify::cli::files_test {
namespace {

namespace fs = std::filesystem;

class FilesTest : public tests::FolderTest {
 protected:
  /// The message of the error; empty if there is none.
  static std::string refusal(const std::function<void()>& action) {
    try {
      action();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(FilesTest, AFileHasOneRole) {
  const std::string a = path("a"), b = path("b");
  std::ofstream(a) << "older";
  fs::create_symlink(a, b);
  for (const std::string& other : {a, b, path("./a")}) {
    Files read, written, twice;
    read.add_input(a);
    EXPECT_EQ(refusal([&] { read.add_output(other); }), a + ": named for input and output");
    written.add_output(a);
    EXPECT_EQ(refusal([&] { written.add_input(other); }), other + ": named for input and output");
    twice.add_output(a);
    EXPECT_EQ(refusal([&] { twice.add_output(other); }), other + ": named for two outputs");
    EXPECT_EQ(refusal([&] { read.add_input(other); }), "") << "reading twice loses nothing";
  }
  EXPECT_EQ(read("a"), "older");
}

TEST_F(FilesTest, ADatasetHasFilesBesideIt) {
  fs::create_directories(folder() / "queries");
  fs::create_directories(folder() / "toi");
  const fs::path queries = folder() / "queries" / "1vf.csv",
                 times = folder() / "toi" / "1vf_toi.csv";
  std::ofstream(queries) << "1,1,1,1,1,1\n";
  std::ofstream(times) << "query,toi\n";
  Files files;
  files.add_dataset(queries);
  EXPECT_NE(refusal([&] { files.add_output(times); }), "");
}

TEST_F(FilesTest, AnOutputTakesItsNameWhenItIsComplete) {
  std::ofstream(path("a")) << "older";
  Files files;
  Output output(files, path("a"));
  output.write("newer");
  EXPECT_EQ(read("a"), "older");
  output.close();
  EXPECT_EQ(read("a"), "newer");
  EXPECT_FALSE(files.has_failed());
  EXPECT_EQ(files.summary_stream(), stdout);
}

TEST_F(FilesTest, AFailureIsKeptAndReportedOnce) {
  Files files;
  Output output(files, "/dev/full");
  ::testing::internal::CaptureStderr();
  const std::string block(1 << 20, 'x');
  output.write(block);
  output.write(block);
  output.close();
  const std::string errors = ::testing::internal::GetCapturedStderr();
  EXPECT_TRUE(output.failed());
  EXPECT_TRUE(files.has_failed());
  EXPECT_EQ(errors.find("/dev/full"), errors.rfind("/dev/full")) << errors;
}

TEST_F(FilesTest, ADashIsStandardOutput) {
  Files files;
  EXPECT_FALSE(Output(files, ""));
  EXPECT_TRUE(Output(files, "-"));
  EXPECT_EQ(files.summary_stream(), stderr);
  EXPECT_EQ(refusal([&] { Output(files, "/dev/stdout"); }), "/dev/stdout: named for two outputs");
}

}  // namespace
}  // namespace touchstone::verify::cli::files_test
