#include "verify/io/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "verify/data/ground_truth_files.hpp"
#include "verify/data/plain_rows.hpp"
#include "verify/io/coordinate_text.hpp"

namespace touchstone::verify::io::number_text_test {
namespace {

using Limits = std::numeric_limits<double>;

/// What a coordinate over 1 is, or why it is none.
struct Coordinate {
  std::optional<double> value;
  std::string fault;
};

Coordinate coordinate(const std::string& numerator, const std::string& denominator = "1") {
  try {
    return {.value = parse_coordinate(numerator, denominator).value, .fault = {}};
  } catch (const CoordinateError& error) {
    const bool at_numerator = error.part() == CoordinateError::Part::numerator;
    return {.value = {},
            .fault = (at_numerator ? "numerator: " : "denominator: ") + std::string(error.what())};
  }
}

/// The places of a text in eight rows of three numbers.
std::string rows_with(const std::string& text) {
  std::string rows = text + ",0,0\n";
  for (int row = 1; row < 8; ++row) rows += "0,0,0\n";
  return rows + std::string(data::plain_rows_margin, '\n');
}

/// A text, its number, and the parsers that take it: c coordinates, n numbers (number_from_text),
/// w words, d distances. The others refuse it.
struct Text {
  std::string text;
  double number;
  std::string takers;
};

TEST(NumberText, IsReadAlikeByAllParsersThatTakeIt) {
  const double nan = Limits::quiet_NaN();
  const std::vector<Text> texts{
      {"0.5", 0.5, "cnwd"},        {"0.1", 0.1, "cnwd"},
      {"1e-8", 1e-8, "cnwd"},      {"5e-324", Limits::denorm_min(), "cnwd"},
      {"0", 0.0, "cnwd"},          {"-0.0", 0.0, "cnwd"},
      {"0e7", 0.0, "cnwd"},        {"-1.5e3", -1500.0, "cnw"},
      {"-1e-300", -1e-300, "cnw"}, {"+1.5e-3", 1.5e-3, "cwd"},
      {"0x1.8p-3", 0.1875, "d"},   {"0x0p0", 0.0, "d"},
      {"nan", nan, "nw"},          {"-inf", -Limits::infinity(), "nw"},
      {"1e400", nan, ""},          {"0x1p-1080", nan, ""},
  };
  for (const auto& [text, number, takers] : texts) {
    const std::vector<std::pair<char, std::optional<double>>> readings{
        {'c', coordinate(text).value},
        {'n', number_from_text<double>(text)},
        {'w', parse_number<double>(text)},
        {'d', data::distance_from_text(text)}};
    for (const auto& [parser, value] : readings) {
      SCOPED_TRACE(text + " by " + parser);
      ASSERT_EQ(value.has_value(), takers.find(parser) != std::string::npos);
      if (!value) continue;
      EXPECT_TRUE(*value == number || (std::isnan(*value) && std::isnan(number)));
      EXPECT_FALSE(*value == 0.0 && std::signbit(*value) && (parser == 'c' || parser == 'd'));
    }
  }
  EXPECT_EQ(data::distance_from_text("1e-999"), std::nullopt) << "none but 0 is 0";
}

TEST(NumberText, ThatIsNoNumberIsRefusedByAll) {
  for (const std::string text : {"", "-", "+", ".", "--1", "+-1", "-+1", "++1", "1.5.0", "1e", "e3",
                                 "1e3.5", "1 2", "1,5", "a", "1a", "1x", "1 ", "one"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(coordinate(text).fault, "numerator: not a number: \"" + text + "\"");
    EXPECT_EQ(coordinate("1", text).fault, "denominator: not a number: \"" + text + "\"");
    EXPECT_FALSE(data::read_plain_rows(rows_with(text), 3, true));
    EXPECT_FALSE(number_from_text<double>(text));
    EXPECT_FALSE(parse_number<double>(text));
    EXPECT_FALSE(data::distance_from_text(text));
    EXPECT_FALSE(number_from_text<std::uint64_t>(text));
    EXPECT_FALSE(parse_number<std::int32_t>(text));
  }
}

TEST(NumberText, IsInTheRangeOfItsType) {
  EXPECT_EQ(number_from_text<std::uint64_t>("18446744073709551615"),
            std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(parse_number<std::int32_t>("-2147483648"), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(parse_number<std::uint8_t>("255"), std::uint8_t{255});
  EXPECT_EQ(parse_number<float>("0.1"), 0.1F);
  for (const char* text : {" 1", "+1", "1.5", "0x1", "18446744073709551616", "-1"}) {
    EXPECT_FALSE(number_from_text<std::uint64_t>(text)) << text;
  }
  EXPECT_FALSE(parse_number<std::int32_t>("2147483648"));
  EXPECT_FALSE(parse_number<std::uint8_t>("256"));
  EXPECT_FALSE(parse_number<float>("1e39"));
}

}  // namespace
}  // namespace touchstone::verify::io::number_text_test
