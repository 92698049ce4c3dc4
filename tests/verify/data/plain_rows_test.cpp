#include "verify/data/plain_rows.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "verify/io/coordinate_text.hpp"

namespace touchstone::verify::data::plain_rows_test {
namespace {

/// Eight rows "0,…,0" but for one coordinate, and what may stand behind them.
std::string rows_with(const std::string& coordinate, bool has_denominator, std::size_t place) {
  std::string text;
  for (std::size_t i = 0; i < 24; ++i) {
    text += i == place ? coordinate : has_denominator ? "0,1" : "0";
    text += i % 3 == 2 ? '\n' : ',';
  }
  return text;
}

enum class Path { plain, other };

/// Expects that the plain path, if it takes the number, gives what rational arithmetic gives.
Path expect_agreement(const std::string& numerator, const std::string& denominator, bool round,
                      std::size_t place = 13) {
  SCOPED_TRACE(numerator + " / " + denominator);
  const bool has_denominator = !denominator.empty();
  const std::string rows = rows_with(has_denominator ? numerator + ',' + denominator : numerator,
                                     has_denominator, place);
  const auto plain =
      read_plain_rows(rows + std::string(plain_rows_margin, '\n'), has_denominator ? 6 : 3, round);
  if (!plain) return Path::other;
  const io::ParsedCoordinate expected =
      io::parse_coordinate(numerator, has_denominator ? denominator : "1");
  const double value = plain->query.coordinates.at(place);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected.value));
  EXPECT_EQ(plain->rounded, expected.exact ? 0U : 1U);
  EXPECT_TRUE(expected.exact || round);
  EXPECT_EQ(plain->bytes, rows.size());
  return Path::plain;
}

std::string text_of(const exact::Integer& n) { return n.get_str(); }
exact::Integer power(unsigned long exponent) { return exact::Integer(1) << exponent; }

/// A double of any sign and exponent between two.
double random_double(std::mt19937_64& random, int least, int greatest) {
  const double fraction = std::ldexp(static_cast<double>(random() >> 11U), -53);
  const auto range = static_cast<std::uint64_t>(greatest - least + 1);
  const int exponent = least + static_cast<int>(random() % range);
  return std::ldexp(random() % 2 == 0 ? fraction : -fraction, exponent);
}

TEST(PlainRows, TakesFractionsOfAllOrdinaryDoubles) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = random_double(random, -900, 62);
    const exact::Rational exact(i % 2 == 0 ? x : static_cast<double>(static_cast<float>(x)));
    const Path path = expect_agreement(text_of(exact.get_num()), text_of(exact.get_den()), false,
                                       static_cast<std::size_t>(i) % 24);
    EXPECT_EQ(path, Path::plain) << x;
  }
}

TEST(PlainRows, TakesDecimalsOfUpTo19Digits) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20000; ++i) {
    const double x = random_double(random, -900, 20);
    for (const int digits : {1, 5, 9, 17}) {
      EXPECT_EQ(expect_agreement(fmt::format("{:.{}e}", x, digits), "", true), Path::plain) << x;
    }
    const double near_one = random_double(random, -10, 20);
    EXPECT_EQ(expect_agreement(fmt::format("{:.10f}", near_one), "", true), Path::plain);
    EXPECT_EQ(
        expect_agreement(fmt::format("{}", std::ldexp(std::round(near_one * 64), -6)), "", false),
        Path::plain);
  }
}

TEST(PlainRows, AgreesWithRationalArithmeticWhereItTakesWhatIsNotOrdinary) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const exact::Integer n(static_cast<long>(random() >> random() % 64));
    for (const std::string& denominator :
         {text_of(power(random() % 1200)), text_of(power(random() % 80) + (random() % 3)),
          std::string(1 + random() % 30, static_cast<char>('0' + random() % 10))}) {
      if (exact::Integer(denominator) == 0) continue;
      expect_agreement(text_of(n), denominator, i % 2 == 0);
      expect_agreement('-' + text_of(n * power(random() % 20)), denominator, i % 2 == 0);
    }
  }
  // clang-format off
  const std::vector<std::string> numbers{
      "0", "-0", "-0.0", "0e5", "00012", "3.", ".5", "1e19", "1e18", "1e22",
      "9999999999999999999", "9007199254740991", "9007199254740993", "18014398509481984",
      "9223372036854775808", "18446744073709551616", "1e-27", "7450580596923828125e-27", "1e-28",
      "0e-400", "1e-400", "4.9406564584124654e-324", "2.2250738585072014e-308",
      "1.7976931348623157e308", "1e308", "1e309",
      "0.000000000000000000000000000000000000000000001", "00000000000000000000000000000000001",
      "1234567812345678", "12345678", "123456781", "1.25e+2", "125E-2"};
  // clang-format on
  for (const std::string& number : numbers) {
    for (const char* denominator : {"", "1", "2", "1024", "1.0", "3"}) {
      for (const bool round : {false, true}) {
        if (number == "1e309") continue;  // beyond the doubles: an error of the other path
        expect_agreement(number, denominator, round);
      }
    }
  }
}

TEST(PlainRows, LeavesEverythingElse) {
  for (const std::string bad : {"", "+1", "1.5.0", "1e", "0x10", "1a", "\"1\"", "nan", "inf",
                                "1e99999", "1e309", "12345678901234567890", "\t1", "1:", "1/"}) {
    EXPECT_EQ(expect_agreement(bad, "", true), Path::other) << bad;
    EXPECT_EQ(expect_agreement(bad, "1", true), Path::other) << bad;
    if (!bad.empty()) {
      EXPECT_EQ(expect_agreement("1", bad, true), Path::other) << bad;
    }
  }
  for (const char* denominator : {"0", "3", "-1", "1.0", "18446744073709551617"}) {
    EXPECT_EQ(expect_agreement("1", denominator, true), Path::other) << denominator;
  }
  EXPECT_EQ(expect_agreement("1", text_of(power(1022)), false), Path::other);
  EXPECT_EQ(expect_agreement("0.1", "", false), Path::other);
  EXPECT_EQ(expect_agreement("0.1", "2", true), Path::other);
}

TEST(PlainRows, LeavesRowsThatAreNotWhole) {
  for (const std::string end : {"\n", "\r\n"}) {
    std::string text;
    for (int row = 0; row < 8; ++row) text += "1,1,-5,2,7,4,1" + end;
    const auto rows = read_plain_rows(text + std::string(plain_rows_margin + 1, ' '), 7, false);
    ASSERT_TRUE(rows.has_value());
    EXPECT_TRUE(rows->label.value());
    EXPECT_EQ(rows->bytes, text.size());
    EXPECT_EQ(rows->query.at(1, 3, 1), -2.5);
    // A cut at each place; only the one that is there is read.
    for (std::size_t length = 0; length < text.size() + plain_rows_margin; ++length) {
      const std::string cut = (text + std::string(plain_rows_margin, ' ')).substr(0, length);
      const std::vector<char> bytes(cut.begin(), cut.end());
      EXPECT_FALSE(read_plain_rows({bytes.data(), bytes.size()}, 7, false)) << length;
    }
    std::string spaced = text;
    for (std::size_t at = 0; (at = spaced.find(",1,", at)) != std::string::npos; at += 4) {
      spaced.insert(at + 1, "  ");
    }
    const auto with_spaces = read_plain_rows(spaced + std::string(64, ' '), 7, false);
    ASSERT_TRUE(with_spaces.has_value());
    EXPECT_EQ(with_spaces->query, rows->query);
    std::string differing = text + std::string(64, ' ');
    differing[differing.rfind('1')] = '0';
    EXPECT_FALSE(read_plain_rows(differing, 7, false));
    EXPECT_FALSE(read_plain_rows(text + std::string(64, ' '), 6, false));
    EXPECT_FALSE(read_plain_rows(text + std::string(64, ' '), 4, false));
  }
}

}  // namespace
}  // namespace touchstone::verify::data::plain_rows_test
