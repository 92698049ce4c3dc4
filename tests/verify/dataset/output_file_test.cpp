#include "verify/dataset/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "tests/verify/dataset/dataset_fixture.hpp"

namespace touchstone::verify {
namespace {

using test::contents;
using test::error_of;
using test::TemporaryFolder;

/// Writing a file beyond this size fails as on a full disk while this object lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit lower{.rlim_cur = bytes, .rlim_max = limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &lower);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  FileSizeLimit(FileSizeLimit&&) = delete;
  FileSizeLimit& operator=(FileSizeLimit&&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit limit_{};
  void (*handler_)(int);
};

TEST(OutputFile, has_its_name_and_all_its_bytes_after_close) {
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

TEST(OutputFile, leaves_the_old_file_until_close_and_nothing_without_it) {
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

TEST(OutputFile, two_at_once_for_one_target_do_not_mix) {
  const TemporaryFolder folder;
  OutputFile first(folder.path() / "out"), second(folder.path() / "out");
  first.write("first");
  second.write("second");
  first.close();
  second.close();
  EXPECT_EQ(contents(folder.path() / "out"), "second");
}

TEST(OutputFile, names_the_target_where_no_file_can_be_made_or_renamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of(folder.path(), [&] { OutputFile file(folder.path() / "none" / "out"); }),
            "none/out: cannot write: No such file or directory");
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_EQ(error_of(folder.path(),
                     [&] {
                       OutputFile file(folder.path() / "taken");
                       file.close();
                     }),
            "taken: cannot write: Is a directory");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"taken"});
}

TEST(OutputFile, a_full_disk_is_an_error_and_leaves_nothing) {
  const TemporaryFolder folder;
  const FileSizeLimit limit(100000);
  const auto write_bytes = [&](std::size_t count) {
    return error_of(folder.path(), [&] {
      OutputFile file(folder.path() / "out");
      file.write(std::string(count, 'x'));
      file.close();
    });
  };
  EXPECT_EQ(write_bytes(100001), "out: cannot write: File too large");
  EXPECT_TRUE(folder.names().empty());
  EXPECT_EQ(write_bytes(100000), "no DatasetError");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
}

}  // namespace
}  // namespace touchstone::verify
