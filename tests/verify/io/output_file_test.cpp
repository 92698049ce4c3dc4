#include "verify/io/output_file.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
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

/// Process 1 of a system of its own, on a machine of its own name, where the system lets the test
/// make it: writes the text to the file, between the letters that it sends and receives.
[[noreturn]] void write_as_another_machine(const std::filesystem::path& path,
                                           const std::string& text, int socket) {
  if (::unshare(CLONE_NEWPID | CLONE_NEWUTS) != 0) ::_exit(2);
  const pid_t first = ::fork();
  if (first == 0) {
    const std::string name = "machine-" + text.substr(0, 1);
    if (::getpid() != 1 || ::sethostname(name.data(), name.size()) != 0) ::_exit(2);
    char letter = 'w';
    OutputFile file(path);
    file.write(text);
    static_cast<void>(::write(socket, &letter, 1));
    static_cast<void>(::read(socket, &letter, 1));
    file.close();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(first, &status, 0);
  ::_exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
}

TEST(OutputFile, OfProcessesOfOneNumberOnTwoMachinesIsThatOfTheLastOne) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "out.csv";
  std::array<int, 2> a{}, b{};
  std::array<pid_t, 2> processes{};
  for (auto& [ends, text] : {std::pair{&a, std::string(200'000, 'a')}, {&b, std::string("b")}}) {
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends->data()), 0);
    const pid_t process = ::fork();
    if (process == 0) write_as_another_machine(path, text, (*ends)[1]);
    processes.at(ends == &a ? 0 : 1) = process;
    ::close((*ends)[1]);
  }
  char letter = 0;
  // Both write now.
  const bool are_there = ::read(a[0], &letter, 1) == 1 && ::read(b[0], &letter, 1) == 1;
  const auto let_go_on = [&](std::size_t i) {
    int status = 0;
    static_cast<void>(::send(i == 0 ? a[0] : b[0], &letter, 1, MSG_NOSIGNAL));
    ::waitpid(processes.at(i), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  if (!are_there) {
    EXPECT_EQ(let_go_on(0), 2);
    EXPECT_EQ(let_go_on(1), 2);
    GTEST_SKIP() << "LEFT OUT: the system gives this user no namespaces";
  }
  EXPECT_EQ(folder.names().size(), 2U);
  EXPECT_EQ(let_go_on(1), 0);
  EXPECT_EQ(contents(path), "b");
  EXPECT_EQ(let_go_on(0), 0);
  EXPECT_EQ(contents(path), std::string(200'000, 'a'));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.csv"});
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
