#pragma once

/// \file
/// Tests of pages in a browser: headless Chromium loads a page from a file, runs its scripts
/// and returns the resulting document.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/folder_test.hpp"

namespace touchstone::tests {

/// Skipped with a message without Chromium.
class BrowserTest : public FolderTest {
 protected:
  void SetUp() override {
    if (runs("command -v chromium >/dev/null 2>&1")) return;
    std::printf("MISSING chromium: no page was looked at (apt-get install chromium)\n");
    GTEST_SKIP() << "chromium is not installed";
  }

  /// The document after the script has run; the browser's messages go to "err". The time limit only
  /// ends a browser that hangs, because the browser's clock stops while a script runs.
  [[nodiscard]] std::string load(const std::string& page, int width = 1200) const {
    std::ofstream(path("page.html"), std::ios::binary) << page;
    // The proxy does not exist: every network access of the page is an error.
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

  /// The errors of the page's scripts and policy, without the driver's messages about its speed.
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
