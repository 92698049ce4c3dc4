#include "verify/io/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::io::json_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Json, HasWordsForInfiniteNumbersAndNullForMissingOnes) {
  EXPECT_EQ(number_to_json(0.1), 0.1);
  EXPECT_EQ(number_to_json(infinity), "Infinity");
  EXPECT_EQ(number_to_json(-infinity), "-Infinity");
  EXPECT_TRUE(number_to_json(nan).is_null());
  EXPECT_TRUE(number_to_json(std::nullopt).is_null());
}

TEST(Json, NumbersComeBack) {
  for (const double number : {0.1, -4.9e-324, infinity, -infinity}) {
    EXPECT_EQ(number_from_json(number_to_json(number)), number);
  }
  EXPECT_TRUE(std::isnan(number_from_json(number_to_json(nan))));
  EXPECT_THROW(static_cast<void>(number_from_json("infinite")), nlohmann::json::exception);
}

class JsonFile : public tests::FolderTest {
 protected:
  /// The error of reading a file with this text; empty if there is none.
  [[nodiscard]] std::string error_of(const std::string& text,
                                     std::size_t most_bytes = 1U << 20U) const {
    std::ofstream(path("a.json")) << text;
    const std::string error = data::test::error_of(
        folder(), [&] { static_cast<void>(read_json(path("a.json"), most_bytes)); });
    return error == "no DatasetError" ? "" : error;
  }
};

TEST_F(JsonFile, IsReadUpToADepthAndASize) {
  const auto nested = [](std::string_view opening, std::string_view closing, int depth) {
    std::string text = "1";
    for (int i = 0; i < depth; ++i) text = text + std::string(closing);
    for (int i = 0; i < depth; ++i) text.insert(0, opening);
    return text;
  };
  EXPECT_EQ(error_of(nested("[", "]", deepest_json)), "");
  EXPECT_EQ(error_of(nested("[", "]", deepest_json + 1)), "a.json: nested more than 100 deep");
  EXPECT_EQ(error_of(nested(R"({"a":)", "}", 20'000)), "a.json: nested more than 100 deep");
  EXPECT_EQ(error_of("[1, 2]", 5), "a.json: has more than 5 bytes");
  EXPECT_TRUE(error_of("[1, 2").starts_with("a.json: no JSON: "));
}

TEST_F(JsonFile, WithAKeyTwiceOrANumberBeyondTheRangeIsAnError) {
  EXPECT_EQ(error_of(R"({"a": 1, "b": {"a": 1, "c": [{"a": 1}, {"a": 2}]}})"), "");
  EXPECT_EQ(error_of(R"({"b": {"c": [{"a": 1, "a": 1}]}})"), "a.json: repeated key \"a\"");
  EXPECT_TRUE(error_of("[-1e999]").starts_with("a.json: a number beyond the range: "));
  EXPECT_EQ(error_of("\xEF\xBB\xBF{}"), "");
}

TEST(Json, DocumentsAreAscii) {
  EXPECT_EQ(json_document({{"a", "\u202e\x1b"}}), "{\n  \"a\": \"\\u202e\\u001b\"\n}\n");
  EXPECT_EQ(json_document("caf\xe9"), "\"caf\\ufffd\"\n");
}

}  // namespace
}  // namespace touchstone::verify::io::json_test
