#include "verify/report/report_page_texts.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace touchstone::verify::report::report_page_texts_test {
namespace {

TEST(PageTexts, D3HasItsNotice) {
  EXPECT_TRUE(d3_script().starts_with("// https://d3js.org v")) << d3_script().substr(0, 80);
  EXPECT_NE(d3_script().find("Copyright"), std::string_view::npos);
}

TEST(PageTexts, NoneEndsTheElementThatItStandsIn) {
  for (const std::string_view text : {d3_script(), report_script(), page_script(), page_style()}) {
    EXPECT_EQ(text.find("</script"), std::string_view::npos);
    EXPECT_EQ(text.find("</style"), std::string_view::npos);
    EXPECT_EQ(text.find("<!--"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace touchstone::verify::report::report_page_texts_test
