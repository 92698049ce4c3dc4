#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"

// The tool after its user or its reader has gone, or without its input;
// and names from outside on a terminal (verify/io/terminal.hpp, verify/io/printable.hpp).

namespace touchstone::verify::cli::lost_terminal_test {
namespace {

namespace fs = std::filesystem;

/// A vertex that falls through a resting triangle.
std::string falling_vertex() {
  const std::string triangle = "0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  return "1,1,1,1,1,1\n" + triangle + "1,1,1,1,-3,1\n" + triangle;
}

struct Outcome {
  int status;  ///< minus the signal that ended the process
  std::string out;
  std::string err;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Waits until the condition holds; false only if something hangs.
bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 12'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// True if the process handles the signal itself. The tool does so before it opens its first file.
bool handles(pid_t process, int signal) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> static_cast<unsigned>(signal - 1)) % 2 == 1;
  }
  return false;
}

/// Runs the program `touchstone` as its users do, in a separate folder.
class TerminalTool : public tests::FolderTest {
 protected:
  static constexpr int to_file = -1, closed = -2;

  /// Starts a program, the tool unless another is named, with its standard output in a file, at a
  /// descriptor, or closed.
  [[nodiscard]] pid_t start(std::vector<std::string> words, int output = to_file,
                            const std::string& program = tests::touchstone_program()) const {
    words.insert(words.begin(), program);
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    static constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    if (output == to_file) {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, path("out").c_str(), flags, 0600);
    } else if (output == closed) {
      posix_spawn_file_actions_addclose(&actions, STDOUT_FILENO);
    } else {
      posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    }
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, path("err").c_str(), flags, 0600);
    pid_t process = 0;
    EXPECT_EQ(posix_spawn(&process, program.c_str(), &actions, nullptr, pointers.data(), environ),
              0);
    posix_spawn_file_actions_destroy(&actions);
    return process;
  }

  /// Waits for the end, with a limit in case of a hang.
  [[nodiscard]] Outcome finish(pid_t process) const {
    int status = 0;
    const auto has_ended = [&] { return waitpid(process, &status, WNOHANG) == process; };
    if (!comes_true(has_ended)) {
      ADD_FAILURE() << "the tool hangs";
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
    }
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, read("out"), read("err")};
  }

  [[nodiscard]] Outcome run(const std::vector<std::string>& words, int output = to_file) const {
    return finish(start(words, output));
  }

  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(read(name));
  }

  /// Runs the program, and interrupts it when it handles interrupts.
  [[nodiscard]] Outcome run_interrupted(const std::vector<std::string>& words) const {
    const pid_t process = start(words);
    EXPECT_TRUE(comes_true([&] { return handles(process, SIGINT); }));
    kill(process, SIGINT);
    return finish(process);
  }
};

// ---- Interrupts ---------------------------------------------------------------------------------

/// A sheet whose vertices are in places all over the cube of this size: nearly all pairs of its
/// primitives are candidates of the step between two sizes.
std::string sheet(double size) {
  constexpr int row = 61;
  std::string text;
  for (int i = 0; i < row * row; ++i) {
    text += "v";
    for (const int factor : {7919, 104'729, 1'299'709}) {
      text += " " + std::to_string(size * static_cast<double>(i * std::int64_t{factor} % 1009));
    }
    text += '\n';
  }
  for (int i = 1; i <= row * (row - 1); ++i) {
    if (i % row == 0) continue;
    text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + row) +
            '\n';
  }
  return text;
}

TEST_F(TerminalTool, EveryCommandEndsAtAnInterrupt) {
  const std::string out = path("result"), summary = path("summary.json");
  const std::string before = write("0.obj", sheet(0.01)), after = write("1.obj", sheet(-1.0));
  const std::vector<std::vector<std::string>> runs{
      {"certify", "--count", "100000000", "--json", summary},
      {"solve", "--count", "100000000", "--method", "certified", "--out", out, "--json", summary},
      {"prove", "--count", "100000000", "--prove", out, "--json", summary},
      {"generate", "--count", "100000000", "--out", path("families")},
      {"generate", "--patches", "1000", "--out", path("patches")},
      {"bench", "--count", "100000000"},
      {"fuzz", "--method", "certified", "--json", summary},
      {"certify", "--degree", "rational", "--count", "1000000", "--json", summary},
      // Searches that take minutes.
      {"step", before, after, "--all", "--no-intersections", "--csv", out},
      {"step", before, after, "--free", "--json", out},
      {"bench", "--step", before, after},
      {"view", "--step", before, after, "--out", out}};
  for (const std::vector<std::string>& words : runs) {
    EXPECT_EQ(run_interrupted(words).status, 130) << words[0] << " " << words.back();
    if (words.back() == summary) {
      EXPECT_EQ(json("summary.json").at("interrupted"), true) << words[0];
      fs::remove(summary);
    }
  }
}

TEST_F(TerminalTool, APipeIsReadToItsEndOrToAnInterrupt) {
  const std::string pipe = path("queries_vf.csv");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const int signal : {0, SIGINT, SIGTERM, SIGHUP}) {
    const pid_t process = start({"certify", pipe, "--json", path("result.json")});
    // The opening ends when the tool has opened the other end; from then on its reads block.
    std::ofstream writer(pipe);
    if (signal == 0) {
      writer << falling_vertex() << std::flush << falling_vertex();
      writer.close();
    } else {
      EXPECT_TRUE(comes_true([&] { return handles(process, signal); }));
      kill(process, signal);
    }
    const Outcome outcome = finish(process);
    EXPECT_EQ(outcome.status, signal == 0 ? 0 : 130) << outcome.err;
    EXPECT_EQ(json("result.json").at("queries"), signal == 0 ? 2 : 0) << outcome.err;
  }
}

// ---- Output without a reader --------------------------------------------------------------------

TEST_F(TerminalTool, AClosedStandardOutputEndsThePrintingOnly) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  ::close(pipe[0]);
  const int without_reader = pipe[1];
  // Findings are printed during the search.
  const Outcome fuzz =
      run({"fuzz", "--plugin", tests::plugin_library("box_overlap"), "--exact", "--queries", "3000",
           "--most-findings", "2", "--out", path("found.csv"), "--json", path("fuzz.json")},
          without_reader);
  EXPECT_EQ(fuzz.status, 1) << fuzz.err;
  EXPECT_EQ(json("fuzz.json").at("groups").size(), 2U);
  EXPECT_TRUE(std::ranges::any_of(fs::directory_iterator(folder()), [](const auto& entry) {
    return entry.path().filename().string().starts_with("found");
  }));
  const std::string data = write("a_vf.csv", falling_vertex());
  const Outcome certify = run({"certify", data, "--json", path("certify.json")}, without_reader);
  EXPECT_EQ(certify.status, 0) << certify.err;
  EXPECT_EQ(certify.err, "");
  EXPECT_EQ(json("certify.json").at("queries"), 1);
  EXPECT_EQ(run({"--help"}, without_reader).status, 0);
  ::close(without_reader);
}

/// Full, or closed: what is printed does not go into the first file that is opened.
TEST_F(TerminalTool, AStandardOutputThatTakesNothingIsAnErrorAfterTheFiles) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  const std::string data = write("a_vf.csv", falling_vertex());
  for (const int output : {full, closed}) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"certify", data, "--json", path("result.json")},
          {"generate", "--list"},
          {"--help"}}) {
      const Outcome outcome = run(words, output);
      EXPECT_EQ(outcome.status, 2) << words.front();
      EXPECT_TRUE(contains(outcome.err, "standard output: cannot be written: ")) << outcome.err;
    }
    EXPECT_EQ(json("result.json").at("queries"), 1);
  }
  ::close(full);
}

// ---- Names from outside -------------------------------------------------------------------------

/// True if the text is ASCII without control characters.
bool is_plain(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
}

TEST_F(TerminalTool, NamesOfFilesAreShownAndNotObeyed) {
  const std::string name =
      "vertex-face/\x1b[2Ja\ntotal 9\x07\u009b31m\u202eb\u2028,\"c\xe9|<b>\x7f.csv";
  const std::string shown =
      "\\x1b[2Ja\\x0atotal "
      "9\\x07\\xc2\\x9b31m\\xe2\\x80\\xaeb\\xe2\\x80\\xa8,\"c\\xe9|<b>\\x7f.csv";
  const std::string data = write(name, falling_vertex());
  const Outcome certify =
      run({"certify", data, "--truth", path("truth.csv"), "--json", path("result.json"), "--prove",
           path("proofs.cert"), "--method", "certified", "--table"});
  EXPECT_EQ(certify.status, 0) << certify.err;
  EXPECT_TRUE(contains(certify.out, shown)) << certify.out;
  EXPECT_FALSE(contains(certify.out, "\ntotal 9"));
  for (const char* part : {"\x1b", "\x07", "\u009b", "\u202e", "\u2028", "\xe9", "\x7f"}) {
    for (const std::string& text :
         {certify.out, read("truth.csv"), read("result.json"), read("proofs.cert")}) {
      EXPECT_FALSE(contains(text, part)) << text;
    }
  }
  EXPECT_TRUE(is_plain(read("result.json")));
  EXPECT_TRUE(contains(json("result.json").at("files")[0].at("file"), "\x1b[2Ja\ntotal 9"))
      << "to whoever parses it the name is itself";
  EXPECT_EQ(std::ranges::count(read("truth.csv"), '\n'), 2);
  const std::string mesh = write("\x1b\n,.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(
      contains(run({"step", mesh, mesh, "--csv", path("pairs.csv")}).out, "\\x1b\\x0a,.obj"));
  // The answers under the shown name are found again.
  EXPECT_EQ(run({"solve", data, "--method", "certified", "--out", path("answers.csv")}).status, 0);
  const Outcome judged = run({"certify", data, "--results", path("answers.csv")});
  EXPECT_EQ(judged.status, 0) << judged.err;
  EXPECT_EQ(judged.err, "");
}

TEST_F(TerminalTool, MessagesShowWhatTheyName) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"certify", path("missing\x1b[2J\nx\u202e_vf.csv")},
        {"certify", "--nonsense\x1b[2J\nx\u202e"},
        {"certify", "--kind", "\x1b[2J\nx\u202e"},
        {"fuzz", "--queries", "1", "--method", "\x1b[2J\nx\u202e"},
        {"certify", "--plugin", path("\x1b[2J\nx\u202e.so")},
        {"bench", "--from", path("\x1b[2J\nx\u202e.json"), "--page", path("page.html")}}) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2) << words.front();
    EXPECT_TRUE(is_plain(outcome.err)) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "\\x1b[2J\\x0ax\\xe2\\x80\\xae")) << outcome.err;
  }
}

}  // namespace
}  // namespace touchstone::verify::cli::lost_terminal_test
