#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate.hpp"
#include "verify/generate/families.hpp"

// Certificates (touchstone/certificate.hpp) altered in every field: all that the checker still
// accepts must be true, by the oracle's answer about the altered query.

namespace touchstone::exact::certificate_mutation_test {
namespace {

using tests::PosedQuery;
using Lines = std::vector<std::string>;

/// An altered certificate as the text of a stream, and the field that was altered.
struct Mutant {
  std::string field;
  std::string text;
};

std::string join(const Lines& lines) {
  std::string text(certificates_header());
  for (const std::string& line : lines) text += line + "\n";
  return text + certificates_closing_line(1);
}

Lines split(const std::string& text, char separator) {
  std::istringstream in(text);
  Lines parts;
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

std::string number(const Rational& value) {
  std::string text;
  write_number(text, value);
  return text;
}

/// All the ways to alter one certificate.
class Mutations {
 public:
  Mutations(const Certificate& certificate, std::uint64_t seed)
      : random_(seed), certificate_(certificate) {
    std::string text;
    write(text, certificate);
    lines_ = split(text, '\n');
  }

  std::vector<Mutant> all() {
    alter_points();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].starts_with("separation")) alter_separation(i);
      if (lines_[i].starts_with("claim")) alter_claim(i);
      if (lines_[i].starts_with("separate")) alter_subinterval(i);
      if (lines_[i].starts_with("contact time")) alter_numbers("time", i, 2, 3);
      if (lines_[i].starts_with("contact root")) alter_root(i);
      if (lines_[i].starts_with("at ")) alter_place(i);
      if (lines_[i].starts_with("query")) alter_kind(i);
      alter_order(i);
      alter_bytes(i);
    }
    return std::move(mutants_);
  }

 private:
  void add(const std::string& field, const Lines& lines) {
    if (lines != lines_) mutants_.push_back({field, join(lines)});
  }

  void replace(const std::string& field, std::size_t line, const std::string& by) {
    Lines lines = lines_;
    lines[line] = by;
    add(field, lines);
  }

  void alter_point(std::size_t coordinate, double value) {
    Certificate altered = certificate_;
    std::get<Query>(altered.query).coordinates.at(coordinate) = value;
    if (!std::isfinite(value)) return;
    std::string text;
    write(text, altered);
    add("point", split(text, '\n'));
  }

  void alter_points() {
    const auto& coordinates = std::get<Query>(certificate_.query).coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const double x = coordinates.at(i);
      const double other = coordinates.at((i + 1 + random_.bits() % 23U) % 24U);
      for (const double value : {std::nextafter(x, HUGE_VAL), std::nextafter(x, -HUGE_VAL), -x, 0.0,
                                 x + 1.0, 2.0 * x, other}) {
        alter_point(i, value);
      }
    }
  }

  /// Alters the words from number `first` to before `last`, each in several ways.
  void alter_numbers(const std::string& field, std::size_t line, std::size_t first,
                     std::size_t last) {
    const Lines words = split(lines_[line], ' ');
    for (std::size_t i = first; i < std::min(last, words.size()); ++i) {
      const Rational value = tests::read_number(words[i]);
      const Rational least = power_of_two(-1074), small = power_of_two(-53);
      for (const Rational& by :
           {Rational(value + least), Rational(value - least), Rational(value + small),
            Rational(value - small), Rational(value / 2), Rational(value * 2), Rational(-value),
            Rational(0), Rational(1), Rational(value + Rational(1, 8)),
            Rational(value - Rational(1, 8)), Rational((value + 1) / 2)}) {
        Lines altered = words;
        altered[i] = number(by);
        replace(field, line, words_to_line(altered));
      }
      if (i + 1 < words.size()) {
        Lines swapped = words;
        std::swap(swapped[i], swapped[i + 1]);
        replace(field, line, words_to_line(swapped));
      }
    }
  }

  static std::string words_to_line(const Lines& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
    return line;
  }

  void alter_claim(std::size_t line) {
    const std::string lower = number(certificate_.toi.lower),
                      upper = number(certificate_.toi.upper);
    for (const char* const claim : {"claim no_collision", "claim collision"}) {
      replace("claim", line, claim);
    }
    const std::vector<std::array<std::string, 2>> intervals{
        {"0", "1"},   {"0", "0"},   {upper, upper}, {lower, lower},
        {"0", lower}, {lower, "1"}, {upper, "1"}};
    for (const auto& [from, to] : intervals) {
      replace("claim", line, std::string("claim time_of_impact ").append(from + ' ').append(to));
    }
    alter_numbers("claim", line, 2, 4);
    // The claim with and without the lines of the other claims.
    for (const char* const claim : {"claim no_collision", "claim collision"}) {
      for (const char* const part : {"separate", "contact", "at "}) {
        Lines lines = lines_;
        lines[line] = claim;
        std::erase_if(lines, [&](const std::string& l) { return l.starts_with(part); });
        add("claim", lines);
        std::erase_if(lines, [&](const std::string& l) { return l.starts_with("at "); });
        add("claim", lines);
      }
    }
  }

  void alter_separation(std::size_t line) {
    alter_numbers("separation", line, 1, 2);
    const Lines words = split(lines_[line], ' ');
    for (const char* const norm : {"linf", "l2"}) {
      replace("norm", line, words_to_line({words[0], words[1], norm}));
    }
    replace("norm", line, words_to_line({words[0], words[1]}));
    const double distance = certificate_.separation.distance;
    for (const double by : {std::nextafter(distance, 0.0), std::nextafter(distance, HUGE_VAL)}) {
      replace("separation", line, words_to_line({words[0], number(Rational(by)), words[2]}));
    }
  }

  void alter_subinterval(std::size_t line) {
    alter_numbers("break point", line, 1, 3);
    const Lines words = split(lines_[line], ' ');
    const std::string times = "separate " + words[1] + " " + words[2] + " ";
    for (const std::string& feature : features()) replace("feature", line, times + feature);
    // The end moves together with the end of its neighbour.
    if (line + 1 < lines_.size() && lines_[line + 1].starts_with("separate")) {
      for (const Rational& by :
           {Rational(1, 64), Rational(-1, 64), Rational(1, 4), Rational(-1, 4)}) {
        Lines next = split(lines_[line + 1], ' '), altered = words;
        altered[2] = next[1] = number(tests::read_number(words[2]) + by);
        Lines lines = lines_;
        lines[line] = words_to_line(altered);
        lines[line + 1] = words_to_line(next);
        add("break point", lines);
      }
      Lines joined = words;
      joined[2] = split(lines_[line + 1], ' ')[2];
      Lines lines = lines_;
      lines[line] = words_to_line(joined);
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(line) + 1);
      add("break point", lines);
    }
  }

  static Lines features() {
    Lines result{"face +", "face -"};
    for (const char i : std::string("01234")) {
      result.push_back(std::string("vertex ") + i);
      for (const char j : std::string("0123")) {
        const std::string corners = std::string(1, i) + " " + j;
        result.push_back("edge " + corners);
        for (const char axis : std::string("xyz")) {
          result.push_back(std::string("cross ") + axis + " " + corners);
        }
      }
    }
    for (const char axis : std::string("xyz")) {
      for (const char sign : std::string("+-")) {
        result.push_back(std::string("axis ") + axis + " " + sign);
      }
    }
    return result;
  }

  void alter_root(std::size_t line) {
    const Lines words = split(lines_[line], ' ');
    alter_numbers("interval", line, 2, 4);
    for (std::size_t i = 4; i < words.size(); ++i) {
      const Integer value(words[i]);
      for (const Integer& by : {Integer(value + 1), Integer(value - 1), Integer(-value), Integer(0),
                                Integer(2 * value), Integer(value + 1000000)}) {
        Lines altered = words;
        altered[i] = by.get_str();
        replace("polynomial", line, words_to_line(altered));
      }
      Lines shorter = words;
      shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(i));
      replace("polynomial", line, words_to_line(shorter));
    }
    replace("polynomial", line, lines_[line] + " 0");
    replace("polynomial", line, lines_[line] + " 1");
    const std::string interval = words[0] + " " + words[1] + " " + words[2] + " " + words[3];
    replace("polynomial", line, interval + " -1 2");
    replace("polynomial", line, "contact time " + words[2]);
    replace("polynomial", line, "contact time " + words[3]);
  }

  void alter_place(std::size_t line) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const std::string two = std::to_string(i) + " " + std::to_string(j);
        replace("place", line, "at segment " + two);
        replace("place", line, "at edge " + two);
        const int k = random_.between(0, 3);
        for (const char axis : std::string("xyz")) {
          replace("place", line, "at triangle " + two + " " + std::to_string(k) + " " + axis);
        }
      }
    }
    for (const char* const other :
         {"at face", "at axes", "at vertex 0", "at vertex 1", "at vertex 2", "at vertex 3"}) {
      replace("place", line, other);
    }
    for (const char axis : std::string("xyz")) {
      std::string other = lines_[line];
      other.back() = axis;
      replace("place", line, other);
    }
  }

  void alter_kind(std::size_t line) {
    const bool is_vertex_face = certificate_.kind == Kind::vertex_face;
    replace("kind", line, is_vertex_face ? "query edge_edge" : "query vertex_face");
  }

  void alter_order(std::size_t line) {
    const auto at = lines_.begin() + static_cast<std::ptrdiff_t>(line);
    Lines lines = lines_;
    lines.erase(lines.begin() + (at - lines_.begin()));
    add("dropped line", lines);
    lines = lines_;
    lines.insert(lines.begin() + (at - lines_.begin()), *at);
    add("doubled line", lines);
    for (int repetition = 0; repetition < 3; ++repetition) {
      lines = lines_;
      std::swap(lines[line], lines[random_.bits() % lines.size()]);
      add("order", lines);
    }
  }

  void alter_bytes(std::size_t line) {
    static constexpr std::string_view bytes = "0123456789abcdefx.p+-/ \t\n#,\r\x80";
    for (int repetition = 0; repetition < 6; ++repetition) {
      std::string altered = lines_[line];
      const std::size_t at = random_.bits() % altered.size();
      const char byte = bytes[random_.bits() % bytes.size()];
      if (repetition % 3 == 0) altered[at] = byte;
      if (repetition % 3 == 1) altered.insert(at, 1, byte);
      if (repetition % 3 == 2) altered.erase(at, 1);
      replace("byte", line, altered);
    }
  }

  tests::Random random_;
  Certificate certificate_;
  Lines lines_;
  std::vector<Mutant> mutants_;
};

/// The stream of one certificate with an altered closing line, or cut in or before it.
Lines with_other_endings(const std::string& stream) {
  const std::string closing = certificates_closing_line(1);
  const std::string before = stream.substr(0, stream.size() - closing.size());
  Lines streams{before + closing + closing, closing + before, before + certificates_closing_line(0),
                before + certificates_closing_line(2)};
  for (std::size_t length = 0; length < closing.size(); ++length) {
    streams.push_back(before + closing.substr(0, length));
  }
  return streams;
}

struct Counts {
  std::uint64_t rejected = 0;
  std::uint64_t accepted_and_true = 0;
};

class MutationTest : public ::testing::Test {
 protected:
  void judge(const Mutant& mutant) {
    ++judged_;
    const checker::Report report = tests::check(mutant.text);
    Counts& counts = counts_[mutant.field];
    if (report.accepted() == 0) {
      EXPECT_GE(report.rejected, 1U) << mutant.text;
      ++counts.rejected;
      return;
    }
    ASSERT_EQ(report.accepted(), 1U) << mutant.text;
    const auto claim = tests::read_claim(mutant.text);
    // The oracle accepts only queries of doubles.
    if (!claim) return;
    ++counts.accepted_and_true;
    EXPECT_TRUE(tests::is_true(*claim)) << "wrongly accepted: " << mutant.text;
  }

  /// Judges about one of `stride` mutants of the certificate.
  void judge_all(const PosedQuery& posed, const ProveOptions& options, unsigned stride,
                 const Separation& separation = {}) {
    const Certificate certificate = tests::prove(posed, separation, options);
    ASSERT_EQ(tests::rejection(certificate), "") << posed;
    for (const std::string& stream : with_other_endings(certificate_stream(certificate))) {
      EXPECT_FALSE(tests::check(stream).all_accepted()) << stream;
    }
    for (const Mutant& mutant : Mutations(certificate, ++seed_).all()) {
      if (random_.bits() % stride == 0) judge(mutant);
    }
  }

  [[nodiscard]] std::uint64_t judged() const { return judged_; }

  void report() const {
    for (const auto& [field, counts] : counts_) {
      std::printf("%-14s rejected %8llu  accepted and true %8llu\n", field.c_str(),
                  static_cast<unsigned long long>(counts.rejected),
                  static_cast<unsigned long long>(counts.accepted_and_true));
      // A field without any rejected mutant would not be checked at all.
      EXPECT_GT(counts.rejected, 0U) << field;
    }
  }

 private:
  std::map<std::string, Counts> counts_;
  tests::Random random_{17};
  std::uint64_t judged_ = 0;
  std::uint64_t seed_ = 0;
};

TEST_F(MutationTest, WhatIsAcceptedIsTrue) {
  const std::uint64_t wanted = tests::is_soak() ? 100000U : tests::trials(5000U);
  const unsigned stride = tests::is_soak() ? 2 : 12;
  tests::Random random(23);
  for (std::uint64_t index = 0; judged() < wanted; ++index) {
    for (const verify::generate::Family& family : verify::generate::families()) {
      const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
      if (!verify::generate::supports(family, kind)) continue;
      judge_all({kind, verify::generate::make_query(family, kind, 3, index).query}, {}, stride);
    }
    for (const tests::Family family : tests::all_families) {
      const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
      judge_all(tests::random_query(random, kind, family), {}, stride);
      judge_all(tests::random_query(random, kind, family), {.collision_claim = Claim::collision},
                stride);
      judge_all(tests::random_query(random, kind, family), {.width = Rational(1, 100)}, stride);
    }
  }
  EXPECT_GE(judged(), wanted);
  report();
}

TEST_F(MutationTest, WhatIsAcceptedAtADistanceIsTrue) {
  const std::uint64_t wanted = tests::is_soak() ? 100000 : 3000;
  const unsigned stride = tests::is_soak() ? 2 : 20;
  tests::Random random(29);
  while (judged() < wanted) {
    for (const tests::Family family : tests::all_families) {
      for (const Norm norm : {Norm::linf, Norm::l2}) {
        const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
        const Separation near{random.between(1, 4) / 4.0, norm}, tiny{0x1p-60, norm};
        judge_all(tests::random_query(random, kind, family), {}, stride, near);
        judge_all(tests::random_query(random, kind, family), {}, stride, tiny);
        judge_all(tests::random_query(random, kind, family), {.collision_claim = Claim::collision},
                  stride, near);
      }
    }
  }
  report();
}

}  // namespace
}  // namespace touchstone::exact::certificate_mutation_test
