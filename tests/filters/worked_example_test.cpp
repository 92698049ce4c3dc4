// The example of filters/README.md: its text is compiled, derived, proved and right.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/filters/support.hpp"
#include "tests/filters/worked_example.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"
#include "touchstone/derivation/shipped_bound.hpp"

namespace touchstone::filters::worked_example_test {
namespace {

using researcher::Orientation;

std::string read(const std::string& path) {
  return tests::read_file(tests::source_folder() + "/" + path);
}

/// The parts of a file between "// README: …" and the next such line or the end.
std::vector<std::string> shown_parts(const std::string& text) {
  static const std::string mark = "// README: ";
  std::vector<std::string> parts;
  for (std::size_t at = text.find(mark); at != std::string::npos;) {
    const std::size_t start = text.find('\n', at) + 1;
    const std::size_t end = text.find(mark + "end", start);
    if (end == std::string::npos) break;
    parts.push_back(text.substr(start, end - start));
    at = text.find(mark, end + mark.size());
  }
  return parts;
}

TEST(WorkedExample, IsTheTextOfTheReadme) {
  const std::string readme = read("filters/README.md");
  int shown = 0;
  for (const std::string name : {"worked_example.hpp", "worked_example_derive.cpp"}) {
    for (const std::string& part : shown_parts(read("tests/filters/" + name))) {
      EXPECT_NE(readme.find("```cpp\n" + part + "```\n"), std::string::npos) << part;
      ++shown;
    }
  }
  EXPECT_EQ(shown, 4);
}

TEST(WorkedExample, ShipsTheBoundThatIsDerived) {
  const std::string declaration = error_bound_declaration(record<Orientation>(), double_format);
  EXPECT_NE(read("tests/filters/worked_example.hpp").find(declaration), std::string::npos)
      << declaration;
}

TEST(WorkedExample, ItsFilterIsNeverWrongAndOftenSure) {
  std::mt19937_64 random(1);
  int sure = 0, unsure = 0;
  for (int i = 0; i < 20000; ++i) {
    // Three points near a line, at all magnitudes that the bound allows.
    const auto near = [&](int bits) { return static_cast<double>(random() >> (64 - bits)); };
    const double slope = near(10),
                 step = std::ldexp(near(50), -40 - static_cast<int>(random() % 30));
    const double a = near(20), b = near(20);
    std::array<double, 6> x{a, slope * a + step, b, slope * b, 0, 0};
    const int scale = static_cast<int>(random() % 1000) - 540;
    for (double& coordinate : x) coordinate = std::ldexp(coordinate, scale);
    const auto sign = researcher::orientation_sign(x);
    const Inputs inputs{{x.begin(), x.end()}, {}};
    (sign ? sure : unsure) += 1;
    if (!sign) continue;
    EXPECT_EQ(*sign, sgn(exact_value<Orientation>(inputs)));
  }
  EXPECT_GT(sure, 1000);
  EXPECT_GT(unsure, 100);
}

}  // namespace
}  // namespace touchstone::filters::worked_example_test
