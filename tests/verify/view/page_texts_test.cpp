#include "verify/view/page_texts.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"

namespace touchstone::verify::view::page_texts_test {
namespace {

TEST(ViewTexts, TheStyleByteForByte) {
  EXPECT_EQ(view_style(), tests::read_file(tests::source_folder() + "/verify/view/page/view.css"));
}

TEST(ViewTexts, TheScriptHoldsOurModulesAndThree) {
  EXPECT_GT(view_script().size(), 300'000U);
  EXPECT_NE(view_script().find("The primitives, and their traces"), std::string_view::npos);
  EXPECT_NE(view_script().find("WebGLRenderer"), std::string_view::npos);
}

TEST(ViewTexts, NoneEndsTheElementThatItStandsIn) {
  for (const std::string_view text : {view_script(), view_style()}) {
    EXPECT_EQ(text.find("</script"), std::string_view::npos);
    EXPECT_EQ(text.find("</style"), std::string_view::npos);
    EXPECT_EQ(text.find("<!--"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace touchstone::verify::view::page_texts_test
