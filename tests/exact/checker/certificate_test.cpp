/// \file
/// The checker on one certificate: those of certificates.txt, where every claim, feature, form of
/// contact, word and number is accepted, and every rule rejects what breaks it with line and
/// reason; the limits; and curves. (verified_agreement.py alters certificates at random.)

#include "exact/checker/certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/rows.hpp"

namespace touchstone::checker::certificate_test {
namespace {

using namespace std::string_literals;
using tests::outcome;
using tests::split;
using Texts = std::vector<std::string>;

/// The character for each \xHH.
std::string unescaped(std::string text) {
  for (std::size_t at = 0; (at = text.find("\\x", at)) != std::string::npos; ++at) {
    text.replace(at, 4, 1, static_cast<char>(std::stoi(text.substr(at + 2, 2), nullptr, 16)));
  }
  return text;
}

/// The certificate of a row; `last` is the last row that is no alteration of another.
std::string certificate_of(const std::string& query, const std::string& row, std::string& last) {
  const tests::QueryRow points(query);
  Texts lines{"touchstone-certificates 2", "query " + points.kind};
  for (const std::string& point : points.points) lines.push_back("point " + point);
  const bool is_altered = row.starts_with("@");
  if (!is_altered) last = row;
  std::ranges::copy(split(last, "; "), std::back_inserter(lines));
  lines.emplace_back("end");
  if (is_altered) {
    const std::size_t space = row.find(' ');
    lines.at(std::stoul(row.substr(1, space)) - 1) =
        tests::replaced(unescaped(row.substr(space + 1)), "; ", "\n");
  }
  return tests::joined(lines, "\n") + "\n";
}

/// Each certificate of certificates.txt has the outcome that is written beside it.
TEST(List, HasTheOutcomesThatItSays) {
  std::ifstream file(tests::source_folder() + "/tests/exact/checker/certificates.txt");
  std::map<std::string, std::string> reasons;
  Texts queries;
  std::string last;
  bool is_after_row = false;
  std::size_t accepted = 0, refused = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      reasons[line.substr(0, equals)] = line.substr(equals + 3);
      continue;
    }
    const bool is_row = line.starts_with("  ");
    if (!is_row && is_after_row) queries.clear();
    is_after_row = is_row;
    if (!is_row) {
      for (std::string& query : tests::expanded(line)) queries.push_back(query);
      continue;
    }
    for (const std::string& query : queries) {
      for (const std::string& row : tests::expanded(line.substr(2))) {
        const Texts sides = split(row, " -> ");
        const std::string text = certificate_of(query, sides[0], last);
        std::string expected = split(split(text, "\nclaim ").back(), "\n")[0];
        expected = expected.substr(0, expected.find(' '));
        if (sides.size() == 2) {
          const Texts refusal = split(sides[1], ": ");
          const auto reason = reasons.find(refusal[1]);
          expected = reason == reasons.end() ? sides[1] : refusal[0] + ": " + reason->second;
        }
        ++(sides.size() == 2 ? refused : accepted);
        EXPECT_EQ(outcome(text), expected) << text;
      }
    }
  }
  EXPECT_GT(accepted, 100U);
  EXPECT_GT(refused, 200U);
}

// ---- Limits -------------------------------------------------------------------------------------

/// A certificate with every kind of line. Some, by their numbers, are written otherwise, or left
/// out for "".
std::string with(const std::map<std::size_t, std::string>& others) {
  std::vector<std::string> lines{"touchstone-certificates 2",
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
  for (const auto& [number, line] : others) lines.at(number - 1) = line;
  std::erase(lines, "");
  return tests::joined(lines, "\n") + "\n";
}

/// A line, and another so often that there are `count`.
std::string repeated(std::string line, const std::string& next, std::size_t count) {
  for (std::size_t n = 1; n < count; ++n) line += "\n" + next;
  return line;
}

/// The sample with one of the vertex's first coordinates, 1, written otherwise.
std::string one_as(const std::string& number) { return with({{4, "point 1 " + number + " 1"}}); }

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
  EXPECT_TRUE(outcome(with({{15, "contact root 1/4 3/4 -1 " + power_of_two(16384)}}))
                  .starts_with("15: more than 16384 bits in a number: '"));
}

TEST(Limit, OfNumbersTogether) {
  // A common denominator of 2^16383 − 1, 2^16383 + 1 and 17 has 32771 bits, 2^16383 for the last
  // number adds as many, and 2^power as many as it says.
  const auto coordinates = [](int power) {
    const mpz_class large = mpz_class(1) << 16'383U;
    return outcome(with({{4, "point 1/" + mpz_class(large - 1).get_str() + " 1/" +
                                 mpz_class(large + 1).get_str() + " 1"},
                         {7, "point 1/17 4 0"},
                         {6, "point 0x1p+" + std::to_string(power) + " 0 0"},
                         {10, "point 4 0x1p-16383 0"}}));
  };
  EXPECT_EQ(coordinates(16'382), "time_of_impact");
  EXPECT_EQ(coordinates(16'383), "12: numbers too large over their common denominator");
}

TEST(Limit, OfACommonDenominator) {
  const auto coordinates = [](std::size_t count) {
    std::map<std::size_t, std::string> lines;
    for (std::size_t n = 0; n < count; ++n) {
      // Pairwise without a common factor, since none divides their differences of 6 to 24.
      const mpz_class denominator =
          (mpz_class(1) << 16'300U) + std::array{1U, 7U, 13U, 19U, 31U}.at(n);
      lines[5 + n] = "point 0 0 1/" + denominator.get_str();
    }
    return outcome(with(lines));
  };
  EXPECT_NE(coordinates(4), "12: numbers too large over their common denominator");
  EXPECT_EQ(coordinates(5), "12: numbers too large over their common denominator");
}

TEST(Limit, OfALineAndOfALabel) {
  const auto comment = [](std::size_t bytes) {
    return outcome(with({{9, "#" + std::string(bytes - 1, 'x') + "\npoint 0 0 0"}}));
  };
  EXPECT_EQ(comment(65'535), "time_of_impact");
  EXPECT_EQ(comment(65'536), "time_of_impact");
  EXPECT_EQ(comment(65'537), "9: the line is too long");
  EXPECT_EQ(comment(1'000'000), "9: the line is too long");
  const auto label = [](std::size_t spaces) {
    return outcome(with({{3, "label" + std::string(spaces, ' ')}}));
  };
  EXPECT_EQ(label(0), "time_of_impact");
  EXPECT_EQ(label(1), "time_of_impact");
  EXPECT_EQ(label(1'025), "time_of_impact");
  EXPECT_EQ(label(1'026), "3: more than 1024 bytes in a label");
}

TEST(Limit, OfSubintervals) {
  const auto subintervals = [](std::size_t count) {
    return outcome(with(
        {{13, repeated("separate 0 1/4 face +", "separate 1/4 1/4 face +", count)}, {14, ""}}));
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
  const std::string point = "point 1 1 1\n", line = "point 1 1 1";
  for (const auto& [curve, expected] : std::vector<std::pair<std::string, std::string>>{
           {"curve 0\n" + point, "no_collision"},
           {"curve 2\n" + point + "point 1 1 -1/2\n" + point, "no_collision"},
           {"curve 2\n" + point + "point 1 1 -1\n" + point,
            "14: a polynomial is not positive at a point"},
           {"rational 1\npoint 1 1 1 2\npoint 1 1 1 1/3\n", "no_collision"},
           {"curve 1\n" + point, "5: expected 'point', found 'curve'"},
           {"curve 0\npoint 1 1 1 1\n", "4: the line has too many words"},
           {"rational 0\n" + point, "4: the line has too few words"},
           {"rational 0\npoint 1 1 1 0\n", "4: a weight that is not positive"},
           {"rational 0\npoint 1 1 1 -1\n", "4: a weight that is not positive"},
           {"curve 8\n" + repeated(line, line, 9) + "\n", "no_collision"},
           {"curve 9\n" + repeated(line, line, 10) + "\n", "3: a degree that is not 0 to 8"},
           {"curve -1\n", "3: a degree that is not 0 to 8"}}) {
    EXPECT_EQ(outcome(over_a_triangle(curve)), expected) << curve;
  }
}

TEST(Limit, OfADegree) {
  // det is 0 for all time, so any g divides it: t^n − 1/2 in [1/4,1].
  const auto degree = [](std::size_t n) {
    return outcome(with({{4, "point 1 1 0"},
                         {8, "point 1 1 0"},
                         {12, "claim collision"},
                         {13, ""},
                         {14, ""},
                         {15, "contact root 1/4 1 -1" +
                                  tests::replaced(std::string(n - 1, '0'), "0", " 0") + " 2"}}));
  };
  EXPECT_EQ(degree(1), "collision");
  EXPECT_EQ(degree(256), "collision");
  EXPECT_EQ(degree(257), "13: more than 257 coefficients in a polynomial");
}

/// 96,000 bits a coefficient: some 200 such subintervals are too much, though each is proved.
TEST(Limit, OfWork) {
  const std::string vertex = "point 0x1p-16000 0x1p-16000 0x1p+16000";
  const auto subintervals = [&](std::size_t count) {
    return outcome(with({{4, vertex},
                         {8, vertex},
                         {12, "claim no_collision"},
                         {13, repeated("separate 0 1 edge 0 1", "separate 1 1 edge 0 1", count)},
                         {14, ""},
                         {15, ""},
                         {16, ""}}));
  };
  EXPECT_EQ(subintervals(100), "no_collision");
  EXPECT_EQ(subintervals(300), "199: the proof takes too much work");
}

}  // namespace
}  // namespace touchstone::checker::certificate_test
