/// \file
/// The checker's reading: what is a certificate, and of what is not one the line and the reason.
/// (The words and numbers of the format are rows of certificates.txt.)

#include "exact/checker/certificate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/checker_outcome.hpp"

namespace touchstone::checker::certificate_test {
namespace {

using namespace std::string_literals;
using tests::outcome;
using Lines = std::vector<std::string>;

/// A certificate with every kind of line; line n is element n−1.
const Lines& sample() {
  static const Lines lines{"touchstone-certificates 2",
                           "query vertex_face",
                           "label simulation/cloth.csv:17",
                           "point 1 1 1",
                           "point 0 0 0",
                           "point 4 0 0",
                           "point 0 4 0",
                           "point 1 1 -1",
                           "point 0 0 0",
                           "point 4 0 0",
                           "point 0 4 0",
                           "claim time_of_impact 1/4 3/4",
                           "separate 0 1/8 face +",
                           "separate 1/8 1/4 face +",
                           "contact root 1/4 3/4 -1 2",
                           "at triangle 0 1 2 z",
                           "end"};
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The sample with another line in the place of line `number`.
std::string with(std::size_t number, std::string_view line) {
  Lines lines = sample();
  lines.at(number - 1) = line;
  return joined(lines);
}

/// The sample with one of the vertex's first coordinates, 1, written otherwise.
std::string one_as(const std::string& number) { return with(4, "point 1 " + number + " 1"); }

TEST(Form, TheSampleIsAccepted) { EXPECT_EQ(outcome(joined(sample())), "time_of_impact"); }

/// 2^n in decimal.
std::string power_of_two(unsigned n) { return mpz_class(mpz_class(1) << n).get_str(); }

TEST(Limit, OfTheBitsOfANumber) {
  const std::string largest = mpz_class((mpz_class(1) << 16384U) - 1).get_str();
  const std::string fraction = largest + "/" + largest;
  const auto is_too_large = [](const std::string& number) {
    const std::string told = outcome(one_as(number));
    return told.starts_with("4: more than ") || told.starts_with("4: too large or small a power");
  };
  for (const std::string& number :
       {largest, "-" + largest, "1/" + largest, fraction, "0x1p+16383"s, "0x1.8p-16379"s,
        "0x1p-16383"s, "0x0p+16383"s, "0x" + std::string(4096, 'f') + "p+0",
        "0x" + std::string(4096, 'f') + "p-16383", "0x1." + std::string(4095, '0') + "p+0"}) {
    EXPECT_FALSE(is_too_large(number)) << number.substr(0, 20);
    EXPECT_EQ(outcome(one_as(number)).rfind("4:", 0), std::string::npos) << number.substr(0, 20);
  }
  for (const std::string& number :
       {power_of_two(16384), "-" + power_of_two(16384), "1/" + power_of_two(16384),
        std::string(4933, '0') + "1", "0x1p+16384"s, "0x2p+16383"s, "0x1p-16384"s, "0x1.8p-16380"s,
        "0x0p+16384"s, "0x0p-16384"s, "0x" + std::string(4097, '0') + "p+0",
        "0x1p+9999999999999999999999"s, "0x1p-9999999999999999999999"s, "0x1p+0000000"s,
        std::string(60000, '9')}) {
    EXPECT_TRUE(is_too_large(number)) << number.substr(0, 20);
  }
  EXPECT_TRUE(outcome(with(15, "contact root 1/4 3/4 -1 " + power_of_two(16384)))
                  .starts_with("15: more than 16384 bits in a number: '"));
}

TEST(Limit, OfNumbersTogether) {
  // A common denominator of 2^16383 − 1, 2^16383 + 1 and 17 has 32771 bits, 2^16383 for the last
  // number adds as many, and 2^power as many as it says.
  const auto coordinates = [](int power) {
    const mpz_class large = mpz_class(1) << 16'383U;
    Lines lines = sample();
    lines.at(3) =
        "point 1/" + mpz_class(large - 1).get_str() + " 1/" + mpz_class(large + 1).get_str() + " 1";
    lines.at(6) = "point 1/17 4 0";
    lines.at(5) = "point 0x1p+" + std::to_string(power) + " 0 0";
    lines.at(9) = "point 4 0x1p-16383 0";
    return outcome(joined(lines));
  };
  EXPECT_EQ(coordinates(16'382), "time_of_impact");
  EXPECT_EQ(coordinates(16'383), "12: numbers too large over their common denominator");
}

TEST(Limit, OfACommonDenominator) {
  const auto coordinates = [](std::size_t count) {
    Lines lines = sample();
    for (std::size_t n = 0; n < count; ++n) {
      // Pairwise without a common factor, since none divides their differences of 6 to 24.
      const mpz_class denominator =
          (mpz_class(1) << 16'300U) + std::array{1U, 7U, 13U, 19U, 31U}.at(n);
      lines.at(4 + n) = "point 0 0 1/" + denominator.get_str();
    }
    return outcome(joined(lines));
  };
  EXPECT_NE(coordinates(4), "12: numbers too large over their common denominator");
  EXPECT_EQ(coordinates(5), "12: numbers too large over their common denominator");
}

TEST(Limit, OfALine) {
  const auto comment = [](std::size_t bytes) {
    return with(9, "#" + std::string(bytes - 1, 'x') + "\npoint 0 0 0");
  };
  EXPECT_EQ(outcome(comment(65'535)), "time_of_impact");
  EXPECT_EQ(outcome(comment(65'536)), "time_of_impact");
  EXPECT_EQ(outcome(comment(65'537)), "9: the line is too long");
  EXPECT_EQ(outcome(comment(1'000'000)), "9: the line is too long");
}

TEST(Limit, OfALabel) {
  EXPECT_EQ(outcome(with(3, "label " + std::string(1'024, ' '))), "time_of_impact");
  EXPECT_EQ(outcome(with(3, "label " + std::string(1'025, ' '))),
            "3: more than 1024 bytes in a label");
  EXPECT_EQ(outcome(with(3, "label")), "time_of_impact");
  EXPECT_EQ(outcome(with(3, "label ")), "time_of_impact");
}

TEST(Limit, OfSubintervals) {
  const auto subintervals = [](std::size_t count) {
    std::string text = "separate 0 1/4 face +";
    for (std::size_t n = 1; n < count; ++n) text += "\nseparate 1/4 1/4 face +";
    Lines lines = sample();
    lines.erase(lines.begin() + 13);
    lines.at(12) = text;
    return outcome(joined(lines));
  };
  EXPECT_EQ(subintervals(4'096), "time_of_impact");
  EXPECT_EQ(subintervals(4'097), "4109: more than 4096 subintervals");
}

/// A vertex on a curve over a resting triangle; its first line is line 3.
std::string over_a_triangle(const std::string& curve) {
  return "touchstone-certificates 2\nquery vertex_face\n" + curve +
         "curve 0\npoint 0 0 0\ncurve 0\npoint 4 0 0\nrational 0\npoint 0 4 0 1/3\n"
         "claim no_collision\nseparate 0 1 face +\nend\n";
}

TEST(Form, OfACurve) {
  const std::string point = "point 1 1 1\n";
  EXPECT_EQ(outcome(over_a_triangle("curve 0\n" + point)), "no_collision");
  EXPECT_EQ(outcome(over_a_triangle("curve 2\n" + point + "point 1 1 -1/2\n" + point)),
            "no_collision");
  EXPECT_EQ(outcome(over_a_triangle("curve 2\n" + point + "point 1 1 -1\n" + point)),
            "14: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(over_a_triangle("rational 1\npoint 1 1 1 2\npoint 1 1 1 1/3\n")),
            "no_collision");
  EXPECT_EQ(outcome(over_a_triangle("curve 1\n" + point)), "5: expected 'point', found 'curve'");
  EXPECT_EQ(outcome(over_a_triangle("curve 0\npoint 1 1 1 1\n")), "4: the line has too many words");
  EXPECT_EQ(outcome(over_a_triangle("rational 0\n" + point)), "4: the line has too few words");
  for (const std::string_view weight : {"0", "-1"}) {
    EXPECT_EQ(outcome(over_a_triangle("rational 0\npoint 1 1 1 " + std::string(weight) + "\n")),
              "4: a weight that is not positive");
  }
  std::string longest = "curve 8\n", too_long = "curve 9\n" + point;
  for (int j = 0; j <= 8; ++j) {
    longest += point;
    too_long += point;
  }
  EXPECT_EQ(outcome(over_a_triangle(longest)), "no_collision");
  EXPECT_EQ(outcome(over_a_triangle(too_long)), "3: a degree that is not 0 to 8");
  EXPECT_EQ(outcome(over_a_triangle("curve -1\n")), "3: a degree that is not 0 to 8");
}

TEST(Limit, OfADegree) {
  // det is 0 for all time, so any g divides it: t^n − 1/2 in [1/4,1].
  const auto degree = [](std::size_t n) {
    Lines lines = sample();
    lines.at(3) = lines.at(7) = "point 1 1 0";
    lines.at(11) = "claim collision";
    lines.erase(lines.begin() + 12, lines.begin() + 14);
    lines.at(12) = "contact root 1/4 1 -1";
    for (std::size_t k = 1; k < n; ++k) lines.at(12) += " 0";
    lines.at(12) += " 2";
    return outcome(joined(lines));
  };
  EXPECT_EQ(degree(1), "collision");
  EXPECT_EQ(degree(256), "collision");
  EXPECT_EQ(degree(257), "13: more than 257 coefficients in a polynomial");
}

/// 96,000 bits a coefficient: some 200 such subintervals are too much, though each is proved.
TEST(Limit, OfWork) {
  const std::string vertex = "point 0x1p-16000 0x1p-16000 0x1p+16000";
  const auto subintervals = [&](std::size_t count) {
    Lines lines = sample();
    lines.at(3) = lines.at(7) = vertex;
    lines.at(11) = "claim no_collision";
    lines.erase(lines.begin() + 13, lines.begin() + 16);
    lines.at(12) = "separate 0 1 edge 0 1";
    for (std::size_t n = 1; n < count; ++n) lines.at(12) += "\nseparate 1 1 edge 0 1";
    return outcome(joined(lines));
  };
  EXPECT_EQ(subintervals(100), "no_collision");
  EXPECT_EQ(subintervals(300), "199: the proof takes too much work");
}

}  // namespace
}  // namespace touchstone::checker::certificate_test
