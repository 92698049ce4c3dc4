#include "verify/io/html.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace touchstone::verify::io::html_test {
namespace {

TEST(Html, ThePolicyLetsNothingBeLoaded) {
  const std::string page = html_beginning("A title", "p { margin: 0; }\n");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">\n"));
  EXPECT_NE(page.find("content=\"default-src 'none'; script-src 'unsafe-inline'; style-src "
                      "'unsafe-inline'; img-src data:\""),
            std::string::npos);
  EXPECT_NE(page.find("<title>A title</title>\n<style>\np { margin: 0; }\n</style>"),
            std::string::npos);
  EXPECT_TRUE(page.ends_with("<body>\n"));
}

TEST(Html, JsonDoesNotEndItsElement) {
  EXPECT_EQ(json_element("data", {{"name", "</script><b>"}}),
            "<script type=\"application/json\" id=\"data\">"
            "{\"name\":\"\\u003c/script>\\u003cb>\"}</script>\n");
  EXPECT_EQ(json_element("data", "\xff"),
            "<script type=\"application/json\" id=\"data\">\"\xef\xbf\xbd\"</script>\n");
}

TEST(Html, BytesInBase64) {
  const auto encoded = [](std::string_view text) {
    return base64(std::as_bytes(std::span(text.data(), text.size())));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("\xff\xfe\xfb"), "//77");
}

}  // namespace
}  // namespace touchstone::verify::io::html_test
