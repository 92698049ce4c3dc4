#pragma once

/// \file
/// Tests that look at pages in a real browser: headless Chromium loads one from a file, runs its scripts
/// and hands back what became of it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/folder_test.hpp"

namespace touchstone::tests {

/// Skipped, and said to be, without Chromium.
class BrowserTest : public FolderTest {
 protected:
  void SetUp() override {
    if (runs("command -v chromium >/dev/null 2>&1")) return;
    std::printf("MISSING chromium: no page was looked at (apt-get install chromium)\n");
    GTEST_SKIP() << "chromium is not installed";
  }

  /// The document after the script has run; what the browser says goes to "err". Its limit of time is only there to end a
  /// browser that hangs: the browser's own clock stands still while a script runs.
  [[nodiscard]] std::string load(const std::string& page, int width = 1200) const {
    std::ofstream(path("page.html"), std::ios::binary) << page;
    // The proxy leads nowhere: whatever the page asks of a network shows as an error.
    EXPECT_TRUE(
        runs("timeout 500 chromium --headless --no-sandbox --disable-gpu "
             "--use-angle=swiftshader --enable-unsafe-swiftshader --disable-dev-shm-usage "
             "--proxy-server=127.0.0.1:9 --enable-logging=stderr "
             "--window-size=" +
             std::to_string(width) + ",900 --virtual-time-budget=10000 --user-data-dir='" +
             path("profile") + "' --dump-dom 'file://" + path("page.html") + "' >'" + path("dom") +
             "' 2>'" + path("err") + "'"))
        << read("err");
    return read("dom");
  }

  /// What the page's scripts and policy complained of. The driver's remarks on its own speed are not theirs.
  [[nodiscard]] std::string complaints() const {
    std::ifstream file(path("err"));
    std::string found;
    for (std::string line; std::getline(file, line);) {
      if (line.find(":CONSOLE") == std::string::npos) continue;
      if (line.find("GL Driver Message (OpenGL, Performance") != std::string::npos) continue;
      found += line + "\n";
    }
    return found;
  }

 private:
  static bool runs(const std::string& command) {
    const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): a test's own command
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
};

}  // namespace touchstone::tests
