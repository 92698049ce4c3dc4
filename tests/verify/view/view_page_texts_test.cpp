#include "verify/view/view_page_texts.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace touchstone::verify::view::view_page_texts_test {
namespace {

TEST(ViewTexts, NoneEndsTheElementThatItStandsIn) {
  for (const std::string_view text : {view_script(), view_style()}) {
    EXPECT_EQ(text.find("</script"), std::string_view::npos);
    EXPECT_EQ(text.find("</style"), std::string_view::npos);
    EXPECT_EQ(text.find("<!--"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace touchstone::verify::view::view_page_texts_test
