#pragma once

/// \file
/// Folders of tests for their files.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace touchstone::tests {

/// The bytes of a file; none if it cannot be read.
[[nodiscard]] inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A folder of the running test, removed with all its files at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static unsigned count = 0;
    const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("touchstone-") + info->test_suite_name() + "-" + info->name() +
                       "-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
    std::replace(name.begin(), name.end(), '/', '-');
    path_ = std::filesystem::path(::testing::TempDir()) / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Makes a file with this text, and its folders; returns its path.
  [[nodiscard]] std::filesystem::path file(const std::filesystem::path& name,
                                           std::string_view text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  /// The names in the folder itself.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

 private:
  std::filesystem::path path_;
};

/// Tests with a folder each.
class FolderTest : public ::testing::Test {
 protected:
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder() / name).string();
  }
  [[nodiscard]] std::string read(const std::string& name) const { return read_file(path(name)); }

 private:
  TemporaryFolder folder_;
};

}  // namespace touchstone::tests
