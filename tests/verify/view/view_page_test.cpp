#include "verify/view/view_page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace touchstone::verify::view::view_page_test {
namespace {

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(ViewPage, HoldsItsQueriesAndTheScript) {
  const std::string page = view_page({{{"label", "</script>"}}}, "touchstone view a<b");
  EXPECT_TRUE(contains(
      page,
      R"(<script type="application/json" id="queries">[{"label":"\u003c/script>"}]</script>)"));
  EXPECT_TRUE(contains(page, view_script()));
  EXPECT_TRUE(contains(page, view_style()));
  EXPECT_TRUE(contains(page, "touchstone view a&lt;b"));
  EXPECT_TRUE(contains(page, "default-src 'none'"));
}

TEST(ViewPage, NoTextEndsTheElementThatItStandsIn) {
  for (const std::string_view text : {view_script(), view_style()}) {
    for (const std::string_view end : {"</script", "</style", "<!--"}) {
      EXPECT_EQ(text.find(end), std::string_view::npos) << end;
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::view::view_page_test
