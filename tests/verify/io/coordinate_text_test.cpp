#include "verify/io/coordinate_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"
#include "touchstone/number.hpp"

namespace touchstone::verify::io::coordinate_text_test {
namespace {

using Limits = std::numeric_limits<double>;

std::string text_of(const exact::Integer& n) { return n.get_str(); }
exact::Integer power(unsigned long exponent) { return exact::Integer(1) << exponent; }

/// Expects the double by its definition: the nearest to the rational, and exact iff equal to it.
void expect_correct(const std::string& numerator, const std::string& denominator) {
  SCOPED_TRACE(numerator + " / " + denominator);
  const exact::Rational quotient =
      exact::rational_from_decimal(numerator) / exact::rational_from_decimal(denominator);
  const ParsedCoordinate parsed = parse_coordinate(numerator, denominator);
  EXPECT_EQ(parsed.value, exact::round_to_nearest(quotient));
  EXPECT_EQ(parsed.exact, exact::Rational(parsed.value) == quotient);
  EXPECT_FALSE(std::signbit(parsed.value) && parsed.value == 0.0);
}

/// "numerator: reason" or "denominator: reason".
std::string fault_of(std::string_view numerator, std::string_view denominator) {
  try {
    (void)parse_coordinate(numerator, denominator);
  } catch (const CoordinateError& error) {
    const bool at_numerator = error.part() == CoordinateError::Part::numerator;
    return (at_numerator ? "numerator: " : "denominator: ") + std::string(error.what());
  }
  return "no error";
}

/// Signs, leading zeros, fractions of any terms, decimals that are doubles and others, and both
/// ends of the range.
TEST(ParseCoordinate, IsTheNearestDouble) {
  const auto [largest, half_past] =
      std::pair{text_of(power(1024) - power(971)), text_of(power(1024) - power(970))};
  const auto [smallest, half] = std::pair{text_of(power(1074)), text_of(power(1075))};
  const std::string sevens = "3" + std::string(400, '7');
  std::istringstream fractions(
      "+3/+4 3/-4 -3/-4 007/002 9/12 1/3 0/7 -0/1 -0/-3 -0.0/1 -0e-9999/1 -0.75/1 +.5/1 3./1 "
      "1.5e3/1 15E-1/3 3/0.5 0.3/0.1 4.0e-1/6.4e0 0.1/1 -0.00058163201902061701/1 "
      "0.1000000000000000055511151231257827021181583404541015625/1 1.7976931348623158e308/1 "
      "1e-330/1 -1e-330/1 -2.5e-324/1 18446744073709551616/1 "
      "9223372036854775807/9223372036854775807 -9223372036854775808/9223372036854775808 "
      "9007199254740991/1 18014398509481982/1 18014398509481983/1 4503599627370495/" +
      smallest + " 1/" + smallest + " -1/" + smallest + " -1/" + half + " " + sevens + "/" +
      sevens + " " + largest + "/1 -" + largest + "/1 " + text_of(exact::Integer(half_past) - 1) +
      "/1");
  for (std::string fraction; fractions >> fraction;) {
    const std::size_t slash = fraction.find('/');
    expect_correct(fraction.substr(0, slash), fraction.substr(slash + 1));
  }
  for (const std::string& beyond : {half_past, text_of(-power(1024)), std::string("-1.8e308")}) {
    EXPECT_EQ(fault_of(beyond, "1"), "numerator: beyond the range of double");
  }
  EXPECT_EQ(fault_of("1", "1e-400"), "numerator: beyond the range of double");
}

TEST(ParseCoordinate, What17DigitsGiveBackIsTheDouble) {
  std::mt19937_64 random(9);
  for (const double x : data::test::random_query(random).coordinates) {
    EXPECT_EQ(parse_coordinate(fmt::format("{:.17g}", x), "1").value, x);
    EXPECT_EQ(parse_coordinate(fmt::format("{:.1100f}", x), "1").value, x);
    EXPECT_TRUE(parse_coordinate(fmt::format("{:.1100f}", x), "1").exact);
  }
}

TEST(ParseCoordinate, NamesWhatIsNoNumber) {
  for (const std::string bad : {"1e99999x", "0x10"}) {
    EXPECT_EQ(fault_of(bad, "1"), "numerator: not a number: \"" + bad + "\"");
  }
  EXPECT_EQ(fault_of(std::string_view("1\0", 2), "1"), "numerator: not a number: \"1?\"");
  for (const std::string bad :
       {"1e10001", "+1e999999999", "-1e-999999999", "0e99999", "1e99999999999999999999999"}) {
    EXPECT_EQ(fault_of(bad, "1"),
              "numerator: beyond the range, exponents up to 10000: \"" + bad + "\"");
    EXPECT_EQ(fault_of("1", bad),
              "denominator: beyond the range, exponents up to 10000: \"" + bad + "\"");
  }
  for (const std::string bad : {"nan", "-nan", "NaN", "inf", "-Inf", "+infinity"}) {
    EXPECT_EQ(fault_of(bad, "1"), "numerator: not a finite number: \"" + bad + "\"");
  }
}

TEST(IsNumeric, TellsWhatBeginsLikeANumberFromNames) {
  for (const char* numeric : {"0", "-1", "+.5", "1x", "1e", "--1", "nan", "+inf"}) {
    EXPECT_TRUE(is_numeric(numeric)) << numeric;
  }
  for (const char* other : {"", "-", "x", "x1", "e3", "_1", "#1", "nano", " 1"}) {
    EXPECT_FALSE(is_numeric(other)) << other;
  }
}

TEST(ParseCoordinate, RefusesZeroDenominators) {
  for (const std::string zero : {"0", "-0", "+0", "000", "0.0", "0e5"}) {
    EXPECT_EQ(fault_of("1", zero), "denominator: zero denominator");
    EXPECT_EQ(fault_of("0", zero), "denominator: zero denominator");
  }
}

TEST(ParseCoordinate, AgreesWithRationalArithmeticOnEveryPath) {
  std::mt19937_64 random(20210814);
  const auto signed_bits = [&](unsigned bits) {
    return exact::Integer(static_cast<long>(random()) >> (64U - bits));
  };
  for (int i = 0; i < 20000; ++i) {
    const auto bits = static_cast<unsigned>(2 + random() % 63);
    const exact::Integer n = signed_bits(bits), odd = abs(signed_bits(bits)) + 1;
    for (const auto& [numerator, denominator] :
         std::vector<std::pair<exact::Integer, exact::Integer>>{
             {n, power(random() % 64)},
             {n, power(random() % 1200)},
             {n * power(random() % 900), power(random() % 1200)},
             {n, odd},
             {n * odd * power(random() % 80), odd * power(random() % 80)}}) {
      expect_correct(text_of(numerator), text_of(denominator));
    }
  }
}

TEST(AppendCoordinate, WritesLowestTerms) {
  const auto text = [](double x) {
    std::string result;
    append_coordinate(result, x);
    return result;
  };
  EXPECT_EQ(text(0.0), "0,1");
  EXPECT_EQ(text(-0.0), "0,1");
  EXPECT_EQ(text(-0.75), "-3,4");
  EXPECT_EQ(text(6.0), "6,1");
  EXPECT_EQ(text(0x1p70), "1180591620717411303424,1");
  EXPECT_EQ(text(0.1), "3602879701896397,36028797018963968");
  EXPECT_EQ(text(Limits::denorm_min()), "1," + text_of(power(1074)));
  EXPECT_EQ(text(Limits::max()), text_of(power(1024) - power(971)) + ",1");
}

TEST(AppendCoordinate, RefusesWhatIsNotFinite) {
  std::string text = "kept";
  for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    EXPECT_THROW(append_coordinate(text, bad), std::invalid_argument);
  }
  EXPECT_EQ(text, "kept");
}

}  // namespace
}  // namespace touchstone::verify::io::coordinate_text_test
