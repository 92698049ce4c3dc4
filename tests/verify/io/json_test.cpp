#include "verify/io/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace touchstone::verify::io::json_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Json, HasWordsForInfiniteNumbersAndNullForNone) {
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

TEST(Json, EmptyTextsAreNull) {
  EXPECT_EQ(text_or_null("a"), "a");
  EXPECT_TRUE(text_or_null("").is_null());
}

TEST(Json, DocumentsAreAscii) {
  EXPECT_EQ(json_document({{"a", "\u202e\x1b"}}), "{\n  \"a\": \"\\u202e\\u001b\"\n}\n");
  EXPECT_EQ(json_document("caf\xe9"), "\"caf\\ufffd\"\n");
}

}  // namespace
}  // namespace touchstone::verify::io::json_test
