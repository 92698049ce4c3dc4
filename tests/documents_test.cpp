/// \file
/// Tests that the documents have the numbers of their data: `./run results --check`, which is
/// docs/documents.py.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/browser_test.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"

namespace touchstone::tests::documents_test {
namespace {

namespace fs = std::filesystem;

int run(const std::string& command) {
  const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): a test's own command
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Tests that are skipped, with a message, without Python or Chromium, which draws the picture.
class Documents : public BrowserTest {
 protected:
  void SetUp() override {
    BrowserTest::SetUp();
    if (run("command -v python3 >/dev/null") == 0) return;
    std::printf("MISSING python3: no document was checked (apt-get install python3)\n");
    GTEST_SKIP() << "python3 is not installed";
  }

  /// Checks the documents of a folder; writes the output to "out".
  [[nodiscard]] int check(const fs::path& root) const {
    return run("python3 '" + source_folder() + "/docs/documents.py' --check --tool '" +
               touchstone_program() + "' --root '" + root.string() + "' >'" + path("out") +
               "' 2>&1");
  }

  /// The folder with a copy of all documents and data.
  [[nodiscard]] fs::path copies() const {
    const fs::path source = source_folder();
    fs::copy(source / "docs", folder() / "docs", fs::copy_options::recursive);
    fs::copy(source / "README.md", folder() / "README.md");
    return folder();
  }

  /// Replaces the first digit after the last `mark` of a copy; returns its place, "NAME:LINE:".
  [[nodiscard]] std::string falsify(const std::string& name, const std::string& mark) const {
    std::string text = read(name);
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(text.rfind(mark) + mark.size());
    const auto digit =
        std::find_if(begin, text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    *digit = *digit == '1' ? '2' : '1';
    std::ofstream(path(name), std::ios::binary) << text;
    return name + ":" + std::to_string(1 + std::count(text.begin(), digit, '\n')) + ":";
  }
};

TEST_F(Documents, AgreeWithTheirData) { EXPECT_EQ(check(source_folder()), 0) << read("out"); }

TEST_F(Documents, ADifferenceIsNamedWithItsLine) {
  const fs::path root = copies();
  const std::string expected[] = {
      falsify("README.md", "(`cubic`) | "),
      falsify("docs/benchmarks.md", "| built-in set | "),
      falsify("docs/results.md", "| certified | "),
      falsify("docs/results.svg", "translate("),
  };
  EXPECT_EQ(check(root), 1);
  for (const std::string& line : expected) {
    EXPECT_NE(read("out").find(line), std::string::npos) << line << "\n" << read("out");
  }
}

/// The picture as a reader sees it: behind a name there may only be its point's own curve.
TEST_F(Documents, NamesInThePictureDoNotOverlap) {
  const std::string dom =
      load(read_file(fs::path(source_folder()) / "docs/results.svg") + R"(<p id="names"></p><script>
const boxes = Array.from(document.querySelectorAll("text.name"), (text) => [text.textContent, text.getBoundingClientRect()]);
const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top + 3 < b.bottom && b.top + 3 < a.bottom;
const found = boxes.flatMap(([a, one], i) =>
  boxes.slice(i + 1).filter(([, other]) => overlap(one, other)).map(([b]) => `${a} and ${b}`));
document.getElementById("names").textContent = `${boxes.length > 20}: ${found.join("; ")}.`;
</script>)");
  EXPECT_EQ(complaints(), "");
  EXPECT_NE(dom.find(">true: .<"), std::string::npos) << dom.substr(dom.find("<p id"));
}

}  // namespace
}  // namespace touchstone::tests::documents_test
