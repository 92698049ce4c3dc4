#include "verify/io/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::io::output_file_test {
namespace {

using data::test::contents;
using data::test::error_of;
using data::test::TemporaryFolder;

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

/// The only file of the folder, which must be a temporary one.
std::string temporary_in(const TemporaryFolder& folder) {
  const std::vector<std::string> names = folder.names();
  EXPECT_EQ(names.size(), 1U);
  EXPECT_NE(names.at(0).find(".touchstone.partial-"), std::string::npos) << names.at(0);
  return names.at(0);
}

/// Begins to write a file in a child process, which is then killed.
void leave_partial(const std::filesystem::path& path) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFile file(path);
    file.write("half");
    static_cast<void>(::write(pipe[1], "x", 1));
    for (;;) ::pause();
  }
  char ready = 0;
  EXPECT_EQ(::read(pipe[0], &ready, 1), 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(OutputFile, the_next_one_in_the_folder_removes_what_killed_runs_left) {
  const TemporaryFolder folder;
  for (const std::string next : {"out.csv", "other.csv"}) {
    leave_partial(folder.path() / "out.csv");
    const std::string left = temporary_in(folder);
    OutputFile file(folder.path() / next);
    EXPECT_NE(temporary_in(folder), left) << "before it is complete";
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, what_others_are_writing_stays) {
  const TemporaryFolder folder;
  std::array<int, 2> ready{}, go_on{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  ASSERT_EQ(::pipe(go_on.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFile file(folder.path() / "first");
    file.write("first");
    static_cast<void>(::write(ready[1], "x", 1));
    char word = 0;
    static_cast<void>(::read(go_on[0], &word, 1));
    file.close();
    ::_exit(0);
  }
  char word = 0;
  ASSERT_EQ(::read(ready[0], &word, 1), 1);
  OutputFile second(folder.path() / "second"), third(folder.path() / "first");
  EXPECT_EQ(folder.names().size(), 3U);
  ASSERT_EQ(::write(go_on[1], "x", 1), 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(contents(folder.path() / "first"), "first");
  second.close();
  third.close();
  for (const int end : {ready[0], ready[1], go_on[0], go_on[1]}) ::close(end);
  std::vector<std::string> names = folder.names();
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"first", "second"}));
}

TEST(OutputFile, only_files_of_such_names_are_taken_for_what_a_run_left) {
  const TemporaryFolder folder;
  std::vector<std::string> others{"out.partial-1-0",
                                  "out.touchstone.partial-",
                                  "out.touchstone.partial-1",
                                  "out.touchstone.partial-1-",
                                  "out.touchstone.partial-x-0",
                                  "out.touchstone.partial-1-0.csv",
                                  "out.touchstone.partial-1-0-2"};
  for (const std::string& name : others) (void)folder.file(name, "");
  std::filesystem::create_directory(folder.path() / "folder.touchstone.partial-1-0");
  others.emplace_back("folder.touchstone.partial-1-0");
  const auto target = folder.file("precious", "");
  std::filesystem::create_symlink(target, folder.path() / "link.touchstone.partial-1-0");
  others.emplace_back("link.touchstone.partial-1-0");
  others.emplace_back("precious");
  (void)folder.file("out.touchstone.partial-1-0", "");
  OutputFile(folder.path() / "out").close();
  others.emplace_back("out");
  std::vector<std::string> names = folder.names();
  std::ranges::sort(names);
  std::ranges::sort(others);
  EXPECT_EQ(names, others);
}

TEST(OutputFile, a_name_may_be_as_long_as_the_system_allows) {
  const TemporaryFolder folder;
  std::string accents;
  while (accents.size() < 254) accents += "\xC3\xA9";
  for (const std::string& name : {std::string(255, 'n'), accents, "n" + accents.substr(2)}) {
    OutputFile file(folder.path() / name);
    const std::string temporary = temporary_in(folder);
    EXPECT_LE(temporary.size(), 255U);
    // No character is cut in two.
    const std::size_t cut = temporary.find(".touchstone");
    EXPECT_EQ(static_cast<unsigned char>(temporary[cut - 1]), name.back() == 'n' ? 'n' : 0xA9U);
    EXPECT_EQ((cut - (name.front() == 'n' ? 1U : 0U)) % (name.back() == 'n' ? 1 : 2), 0U);
    file.write("x");
    file.close();
    EXPECT_EQ(folder.names(), std::vector{name});
    std::filesystem::remove(folder.path() / name);
  }
  EXPECT_EQ(
      error_of("", [&] { OutputFile file(folder.path() / std::string(256, 'n')); }),
      (folder.path() / std::string(256, 'n')).string() + ": cannot write: File name too long");
  EXPECT_TRUE(folder.names().empty()) << "found before anything is written";
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
}  // namespace touchstone::verify::io::output_file_test
