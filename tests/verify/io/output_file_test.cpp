#include "verify/io/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::io::output_file_test {
namespace {

using data::test::contents;
using data::test::error_of;
using data::test::TemporaryFolder;

/// A limit of file sizes: writes beyond it fail as on a full disk during the life of this object.
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

TEST(OutputFile, OfAKilledRunIsRemovedByTheNextOneOfItsName) {
  const TemporaryFolder folder;
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFile file(folder.path() / "out.csv");
    static_cast<void>(::write(pipe[1], "x", 1));
    for (;;) ::pause();
  }
  char ready = 0;
  EXPECT_EQ(::read(pipe[0], &ready, 1), 1);
  const std::string left = "out.csv.touchstone.partial-" + std::to_string(child);
  EXPECT_EQ(folder.names(), std::vector{left});
  OutputFile(folder.path() / "out.csv").close();
  EXPECT_EQ(folder.names().size(), 2U) << "the other process writes still";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  (void)folder.file("out.csv.touchstone.partial-x", "");
  OutputFile(folder.path() / "other.csv").close();
  EXPECT_EQ(folder.names().size(), 4U) << "of another name";
  OutputFile(folder.path() / "out.csv").close();
  std::vector<std::string> names = folder.names();
  std::ranges::sort(names);
  EXPECT_EQ(names,
            (std::vector<std::string>{"other.csv", "out.csv", "out.csv.touchstone.partial-x"}));
  for (const int end : pipe) ::close(end);
}

TEST(OutputFile, GoesWhereASymbolicLinkPoints) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "below");
  std::filesystem::create_symlink("below/new", folder.path() / "link");
  OutputFile(folder.path() / "link").close();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "below/new"));
}

TEST(OutputFile, MayBeADeviceOrAPipe) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = contents(path); });
  OutputFile file(path);
  file.write("text");
  file.close();
  reader.join();
  EXPECT_EQ(read, "text");
  EXPECT_EQ(error_of("",
                     [] {
                       OutputFile full("/dev/full");
                       full.write("x");
                       full.close();
                     }),
            "/dev/full: cannot write: No space left on device");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"pipe"});
}

TEST(OutputFile, NamesTheTargetWhereNoFileCanBeMadeOrRenamed) {
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

TEST(OutputFile, AFullDiskIsAnErrorAndLeavesNothing) {
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
}  // namespace touchstone::verify::io::output_file_test
