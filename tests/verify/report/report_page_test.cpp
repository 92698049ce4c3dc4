#include "verify/report/report_page.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <string_view>

#include "tests/support/measurements.hpp"
#include "verify/view/view_page.hpp"

namespace touchstone::verify::report::report_page_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Page, LoadsNothingAndHoldsNoMarkupOfNames) {
  Measurements measurements = tests::small_report();
  measurements.command = "</pre><b>\x1b";
  for (Measurement& measurement : measurements.all) measurement.group = "g</script>\u202e\n";
  std::string page = report_page(measurements);
  page.erase(page.find(d3_script()), d3_script().size());  // its comments have addresses
  EXPECT_TRUE(contains(page, R"("command":"\u003c/pre>\u003cb>\\x1b")"));
  EXPECT_TRUE(contains(page, R"("group":"g\u003c/script>\\xe2\\x80\\xae\\x0a")"));
  EXPECT_FALSE(contains(page, "g</script>"));
  EXPECT_FALSE(contains(page, "\u202e"));
  EXPECT_FALSE(
      std::regex_search(page, std::regex("https?:|<(link|img|iframe|object)|@import|src=|url\\(")));
}

TEST(Page, HasTextsThatEndNoElementAndTheNoticeOfD3) {
  EXPECT_TRUE(d3_script().starts_with("// https://d3js.org v")) << d3_script().substr(0, 80);
  EXPECT_NE(d3_script().find("Copyright"), std::string_view::npos);
  for (const std::string_view text : {d3_script(), report_script(), page_script(), page_style(),
                                      view::view_script(), view::view_style()}) {
    for (const std::string_view end : {"</script", "</style", "<!--"}) {
      EXPECT_EQ(text.find(end), std::string_view::npos) << end;
    }
  }
}

TEST(StabilityPage, HoldsNoMarkupOfNames) {
  const std::string page =
      stability_page(tests::map_of({0.0, 0.0}, "</script>&\"\xE9"), "</pre>\x1b");
  EXPECT_TRUE(contains(page, R"("\u003c/script>&\"\\xe9 (conservative): breaks its promise.")"));
  EXPECT_TRUE(contains(page, R"("command":"\u003c/pre>\\x1b")"));
  EXPECT_TRUE(contains(page, R"(["\u003c/script>&\"\\xe9","false negative 50 %"])"));
  EXPECT_FALSE(contains(page, "</script>&"));
}

TEST(ViewPage, HoldsItsQueriesAndTheScriptAndNoMarkupOfNames) {
  const std::string page = view::view_page({{{"label", "</script>"}}}, "touchstone view a<b");
  EXPECT_TRUE(contains(page, R"(id="queries">[{"label":"\u003c/script>"}]</script>)"));
  EXPECT_TRUE(contains(page, std::string(view::view_script())));
  EXPECT_TRUE(contains(page, "touchstone view a&lt;b"));
}

}  // namespace
}  // namespace touchstone::verify::report::report_page_test
