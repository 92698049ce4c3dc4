#pragma once

/// \file
/// Tests that run the program `touchstone` as its users do, in a separate folder.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"

namespace touchstone::tests {

struct Outcome {
  int status;  ///< minus the signal that ended the process
  std::string out;
  std::string err;
};

[[nodiscard]] inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Waits until the condition holds; false only if something hangs.
[[nodiscard]] inline bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 12'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// True if the process handles the signal itself. The tool does so before it opens its first file.
[[nodiscard]] inline bool handles(pid_t process, int signal) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> static_cast<unsigned>(signal - 1)) % 2 == 1;
  }
  return false;
}

class ToolTest : public FolderTest {
 protected:
  static constexpr int to_file = -1, closed = -2;

  /// Starts a program, the tool unless another is named, with its standard output in a file, at a
  /// descriptor, or closed.
  [[nodiscard]] pid_t start(std::vector<std::string> words, int output = to_file,
                            const std::string& program = touchstone_program()) const {
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
};

}  // namespace touchstone::tests
