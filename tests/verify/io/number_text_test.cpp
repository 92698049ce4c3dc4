/// \file
/// Texts of numbers: number_text.hpp and coordinate_text.hpp. The judge is rational arithmetic.

#include "verify/io/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "touchstone/number.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::io::number_text_test {
namespace {

using Limits = std::numeric_limits<double>;

std::string text_of(const exact::Integer& n) { return n.get_str(); }
exact::Integer power(unsigned long exponent) { return exact::Integer(1) << exponent; }

/// "numerator: reason" or "denominator: reason".
std::string fault_of(std::string_view numerator, std::string_view denominator = "1") {
  try {
    (void)parse_coordinate(numerator, denominator);
  } catch (const CoordinateError& error) {
    const bool at_numerator = error.part() == CoordinateError::Part::numerator;
    return (at_numerator ? "numerator: " : "denominator: ") + std::string(error.what());
  }
  return "no error";
}

/// Expects the nearest double to the quotient.
void expect_nearest(const std::string& numerator, const std::string& denominator = "1") {
  SCOPED_TRACE(numerator + " / " + denominator);
  const exact::Rational quotient =
      exact::rational_from_decimal(numerator) / exact::rational_from_decimal(denominator);
  const ParsedCoordinate parsed = parse_coordinate(numerator, denominator);
  EXPECT_EQ(parsed.value, exact::round_to_nearest(quotient));
  EXPECT_EQ(parsed.exact, exact::Rational(parsed.value) == quotient);
  EXPECT_FALSE(std::signbit(parsed.value) && parsed.value == 0.0);
}

/// Signs, leading zeros, fractions of any terms, decimals that are doubles and others, and both
/// ends of the range.
TEST(Coordinate, IsTheNearestDouble) {
  const std::string largest = text_of(power(1024) - power(971)),
                    half_past = text_of(power(1024) - power(970));
  const std::string smallest = text_of(power(1074)), half = text_of(power(1075));
  const std::string sevens = "3" + std::string(400, '7');
  std::istringstream fractions(
      "+3/+4 3/-4 -3/-4 007/002 9/12 0/7 -0/1 -0/-3 -0.0/1 -0e-9999/1 +.5/1 15E-1/3 3/0.5 0.3/0.1 "
      "4.0e-1/6.4e0 -0.00058163201902061701/1 "
      "0.1000000000000000055511151231257827021181583404541015625/1 1.7976931348623158e308/1 "
      "1e-330/1 -1e-330/1 -2.5e-324/1 9223372036854775807/9223372036854775807 "
      "-9223372036854775808/9223372036854775808 18014398509481982/1 18014398509481983/1 "
      "4503599627370495/" +
      smallest + " 1/" + smallest + " -1/" + smallest + " -1/" + half + " " + sevens + "/" +
      sevens + " " + largest + "/1 -" + largest + "/1 " + text_of(exact::Integer(half_past) - 1) +
      "/1");
  for (std::string fraction; fractions >> fraction;) {
    const std::size_t slash = fraction.find('/');
    expect_nearest(fraction.substr(0, slash), fraction.substr(slash + 1));
  }
  // clang-format off
  const std::vector<std::string> numbers{
      "0", "-0", "-0.0", "0e5", "00012", "3.", ".5", "1e19", "1e18", "1e22",
      "9999999999999999999", "9007199254740991", "9007199254740993", "18014398509481984",
      "9223372036854775808", "18446744073709551616", "1e-27", "7450580596923828125e-27", "1e-28",
      "0e-400", "1e-400", "4.9406564584124654e-324", "2.2250738585072014e-308",
      "1.7976931348623157e308", "1e308", "0.000000000000000000000000000000000000000000001",
      "00000000000000000000000000000000001", "1234567812345678", "12345678", "123456781", "1.25e+2",
      "125E-2"};
  // clang-format on
  for (const std::string& number : numbers) {
    for (const char* denominator : {"1", "2", "1024", "1.0", "3"}) {
      expect_nearest(number, denominator);
    }
  }
  for (const std::string& beyond : {half_past, text_of(-power(1024)), std::string("-1.8e308")}) {
    EXPECT_EQ(fault_of(beyond), "numerator: beyond the range of double");
  }
  EXPECT_EQ(fault_of("1", "1e-400"), "numerator: beyond the range of double");
}

TEST(Coordinate, IsTheNearestDoubleOfRandomFractions) {
  std::mt19937_64 random(20210814);
  for (int i = 0; i < 20000; ++i) {
    const auto signed_bits = [&](unsigned bits) {
      return exact::Integer(static_cast<long>(random()) >> (64U - bits));
    };
    const auto bits = static_cast<unsigned>(2 + random() % 63);
    const exact::Integer n = signed_bits(bits), odd = abs(signed_bits(bits)) + 1;
    for (const auto& [numerator, denominator] :
         std::vector<std::pair<exact::Integer, exact::Integer>>{
             {n, power(random() % 64)},
             {n, power(random() % 1200)},
             {n * power(random() % 900), power(random() % 1200)},
             {n, odd},
             {-n * power(random() % 20), power(random() % 80) + random() % 3},
             {n * odd * power(random() % 80), odd * power(random() % 80)}}) {
      expect_nearest(text_of(numerator), text_of(denominator));
    }
    const std::string digits(1 + random() % 30, static_cast<char>('1' + random() % 9));
    expect_nearest(text_of(n), digits);
  }
}

/// A text, its number, the parsers that take it (c coordinates, n numbers, u whole numbers of 64
/// bits, d distances; m: it is meant as a number), and why coordinates refuse it.
struct Text {
  std::string text;
  double number;
  std::string takers;
  std::string reason = "not a number";
};

TEST(NumberText, IsReadAlikeByAllParsersThatTakeIt) {
  const double nan = Limits::quiet_NaN(), infinity = Limits::infinity();
  const std::string beyond = "beyond the range, exponents up to 10000",
                    infinite = "not a finite number";
  std::vector<Text> texts{{"0.5", 0.5, "cndm"},
                          {"0.1", 0.1, "cndm"},
                          {"1e-8", 1e-8, "cndm"},
                          {"5e-324", Limits::denorm_min(), "cndm"},
                          {"0", 0.0, "cnudm"},
                          {"+18446744073709551615", 0x1p64, "cnudm"},
                          {"18446744073709551616", 0x1p64, "cndm"},
                          {"-0.0", 0.0, "cndm"},
                          {"0e7", 0.0, "cndm"},
                          {"-1.5e3", -1500.0, "cnm"},
                          {"-1e-300", -1e-300, "cnm"},
                          {"+1.5e-3", 1.5e-3, "cndm"},
                          {"0x1.8p-3", 0.1875, "dm"},
                          {"0x0p0", 0.0, "dm"},
                          {"nan", nan, "nm", infinite},
                          {"NaN", nan, "nm", infinite},
                          {"-inf", -infinity, "nm", infinite},
                          {"+infinity", infinity, "nm", infinite},
                          {"1e400", nan, "m", ""},
                          {"0x1p-1080", nan, "m"},
                          {"1e-999", 0.0, "cm"},
                          {"1e10001", nan, "m", beyond},
                          {"-1e-999999999", nan, "m", beyond},
                          {"1e99999999999999999999999", nan, "m", beyond},
                          {std::string("1\0", 2), nan, "m"},
                          {" 1", nan, ""}};
  for (const char* const malformed :
       {"--1", "+-1", "-+1", "++1", "1.5.0", "1e", "1e3.5", "1 2", "1,5", "1a", "1 ", "1e99999x"}) {
    texts.push_back({malformed, nan, "m"});
  }
  for (const char* const name : {"", "-", "+", ".", "e3", "one", "nano", "#1"}) {
    texts.push_back({name, nan, ""});
  }
  const auto coordinate = [](const std::string& text) {
    return fault_of(text) == "no error" ? std::optional(parse_coordinate(text, "1").value)
                                        : std::nullopt;
  };
  for (const auto& [text, number, takers, reason] : texts) {
    SCOPED_TRACE(text);
    const auto is_taken_by = [&takers = takers](char parser) {
      return takers.find(parser) != std::string::npos;
    };
    EXPECT_EQ(is_numeric(text), is_taken_by('m'));
    EXPECT_EQ(number_from_text<std::uint64_t>(text).has_value(), is_taken_by('u'));
    if (!is_taken_by('c') && !reason.empty()) {
      EXPECT_EQ(fault_of(text), "numerator: " + reason + ": " + quote(text));
      EXPECT_EQ(fault_of("1", text), "denominator: " + reason + ": " + quote(text));
    }
    const std::vector<std::pair<char, std::optional<double>>> readings{
        {'c', coordinate(text)},
        {'n', number_from_text<double>(text)},
        {'d', data::distance_from_text(text)}};
    for (const auto& [parser, value] : readings) {
      ASSERT_EQ(value.has_value(), is_taken_by(parser)) << parser;
      if (!value) continue;
      EXPECT_TRUE(*value == number || (std::isnan(*value) && std::isnan(number)));
      EXPECT_FALSE(*value == 0.0 && std::signbit(*value) && parser != 'n');
    }
  }
  for (const std::string zero : {"0", "-0", "0.0", "0e5"}) {
    EXPECT_EQ(fault_of("0", zero), "denominator: zero denominator");
  }
  EXPECT_EQ(number_from_text<float>("0.1"), 0.1F);
  EXPECT_FALSE(number_from_text<float>("1e39"));
  EXPECT_FALSE(number_from_text<std::uint8_t>("256"));
  EXPECT_EQ(number_from_text<std::int32_t>("-2147483648"),
            std::numeric_limits<std::int32_t>::min());
}

TEST(AppendCoordinate, WritesLowestTermsOfFiniteNumbers) {
  for (const auto& [x, expected] : std::vector<std::pair<double, std::string>>{
           {-0.0, "0,1"},
           {-0.75, "-3,4"},
           {6.0, "6,1"},
           {0x1p70, "1180591620717411303424,1"},
           {0.1, "3602879701896397,36028797018963968"},
           {Limits::denorm_min(), "1," + text_of(power(1074))},
           {Limits::max(), text_of(power(1024) - power(971)) + ",1"}}) {
    std::string text;
    append_coordinate(text, x);
    EXPECT_EQ(text, expected);
  }
  std::string text = "kept";
  for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    EXPECT_THROW(append_coordinate(text, bad), std::invalid_argument);
  }
  EXPECT_EQ(text, "kept");
}

}  // namespace
}  // namespace touchstone::verify::io::number_text_test
