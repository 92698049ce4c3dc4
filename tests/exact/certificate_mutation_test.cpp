#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/inverting_elements.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rows.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate.hpp"
#include "verify/generate/families.hpp"

// Certificates (touchstone/certificate.hpp) altered in every field: all that the checker
// accepts must be true, by the oracle's answer about the query.

namespace touchstone::exact::certificate_mutation_test {
namespace {

using tests::joined;
using tests::PosedQuery;
using tests::split;
using tests::written;
using Lines = std::vector<std::string>;

/// An altered certificate as the text of a stream, and the first word of the line that was altered.
struct Mutant {
  std::string field;
  std::string text;
};

/// What may follow the first words of a line, so many of them.
struct Rest {
  std::string_view line;
  std::size_t words;
  std::string rest;
};

const std::vector<Rest>& rests() {
  static const std::string corner = "{0|1|2|3|4}", axis = "{x|y|z}";
  static const std::vector<Rest> all{
      {"query", 1, "{vertex_face|edge_edge|tetrahedron}"},
      {"claim", 1, "{no_collision|collision|no_inversion|inversion}"},
      {"claim", 1, "{time_of_impact|time_of_inversion} {0 1|0 0|1 1|0 1/2}"},
      {"separation", 2, "{linf|l2}"},
      {"separate", 3, "vertex " + corner},
      {"separate", 3, "edge " + corner + " " + corner},
      {"separate", 3, "{face|axis x|axis y|axis z} {+|-}"},
      {"separate", 3, "cross " + axis + " " + corner + " " + corner},
      {"contact root", 4, "{-1 2|0 1|-1 0 2}"},
      {"at", 1, "{segment|edge} " + corner + " " + corner},
      {"at", 1, "triangle {0|1|2|3} {0|1|2|3} {1|3} " + axis},
      {"at", 1, "{face|axes|plane|vertex 0|vertex 1|vertex 2|vertex 3}"}};
  return all;
}

/// All the ways to alter one certificate.
class Mutations {
 public:
  Mutations(const Certificate& certificate, std::uint64_t seed)
      : random_(seed), certificate_(certificate) {
    std::string text;
    write(text, certificate);
    lines_ = split(text, "\n");
    lines_.pop_back();
  }

  std::vector<Mutant> all() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      words_ = split(lines_[i], " ");
      alter_words(i);
      alter_lines(i);
      alter_bytes(i);
    }
    return std::move(mutants_);
  }

 private:
  void add(const Lines& lines) {
    if (lines == lines_) return;
    mutants_.push_back({words_[0], std::string(certificates_header()) + joined(lines, "\n") + "\n" +
                                       certificates_closing_line(1)});
  }

  void replace(std::size_t line, const std::string& by) {
    Lines lines = lines_;
    lines[line] = by;
    add(lines);
  }

  void replace(std::size_t line, std::size_t word, const std::string& by) {
    Lines words = words_;
    words[word] = by;
    replace(line, joined(words, " "));
  }

  /// Other numbers than this one: doubles for a coordinate.
  std::vector<Rational> others_than(const Rational& value) {
    if (words_[0] == "point") {
      const auto& all = std::get<Query>(certificate_.query).coordinates;
      const double x = value.get_d();
      std::vector<Rational> result;
      for (const double by : {std::nextafter(x, HUGE_VAL), std::nextafter(x, -HUGE_VAL), -x, 0.0,
                              x + 1.0, 2.0 * x, all.at(random_.bits() % all.size())}) {
        if (std::isfinite(by)) result.emplace_back(by);
      }
      return result;
    }
    const Rational least = power_of_two(-1074), small = power_of_two(-53), part(1, 8);
    return {value + least,
            value - least,
            value + small,
            value - small,
            value / 2,
            value * 2,
            -value,
            0,
            1,
            value + part,
            value - part,
            value + 1,
            value - 1,
            (value + 1) / 2};
  }

  void alter_words(std::size_t line) {
    for (std::size_t i = 1; i < words_.size(); ++i) {
      const std::size_t digit = words_[i].find_first_of("0123456789");
      const bool is_number = digit == 0 || (digit == 1 && words_[i][0] == '-');
      if (is_number) {
        for (const Rational& by : others_than(tests::read_number(words_[i]))) {
          replace(line, i, written(by));
        }
      }
      if (i + 1 < words_.size()) {
        Lines swapped = words_;
        std::swap(swapped[i], swapped[i + 1]);
        replace(line, joined(swapped, " "));
      }
    }
    replace(line, lines_[line] + " 0");
    replace(line, lines_[line] + " 1");
    replace(line, lines_[line].substr(0, lines_[line].rfind(' ')));
    for (const auto& [begin, count, rest] : rests()) {
      if (!lines_[line].starts_with(begin)) continue;
      const Lines kept(words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(count));
      for (const std::string& other : tests::expanded(rest)) {
        replace(line, joined(kept, " ") + " " + other);
      }
    }
    const std::string lower = written(certificate_.toi.lower),
                      upper = written(certificate_.toi.upper);
    if (words_[0] == "claim") {
      for (const std::string& toi :
           {upper + " " + upper, lower + " " + lower, "0 " + lower, lower + " 1", upper + " 1"}) {
        replace(line, std::string("claim time_of_") +
                          (is_element(certificate_.kind) ? "inversion " : "impact ") + toi);
      }
    }
  }

  /// Drops, doubles and moves lines, also several at a time.
  void alter_lines(std::size_t line) {
    const auto at = static_cast<std::ptrdiff_t>(line);
    Lines dropped = lines_, doubled = lines_;
    dropped.erase(dropped.begin() + at);
    doubled.insert(doubled.begin() + at, lines_[line]);
    add(dropped);
    add(doubled);
    for (int repetition = 0; repetition < 3; ++repetition) {
      Lines lines = lines_;
      std::swap(lines[line], lines[random_.bits() % lines.size()]);
      add(lines);
    }
    if (words_[0] == "claim") {  // with and without the lines of the other claims
      for (const std::string claim : {"claim no_", "claim "}) {
        for (const char* const part : {"separate", "contact", "at "}) {
          Lines lines = lines_;
          lines[line] = claim + (is_element(certificate_.kind) ? "inversion" : "collision");
          std::erase_if(lines, [&](const std::string& l) { return l.starts_with(part); });
          add(lines);
          std::erase_if(lines, [&](const std::string& l) { return l.starts_with("at "); });
          add(lines);
        }
      }
    }
    if (words_[0] != "separate" || !lines_[line + 1].starts_with("separate")) return;
    // A subinterval's end moves together with the end of its neighbour.
    Lines next = split(lines_[line + 1], " ");
    const Rational end = tests::read_number(words_[2]);
    for (const Rational& by :
         {Rational(1, 64), Rational(-1, 64), Rational(1, 4), Rational(-1, 4)}) {
      Lines lines = lines_, words = words_;
      words[2] = next[1] = written(end + by);
      lines[line] = joined(words, " ");
      lines[line + 1] = joined(next, " ");
      add(lines);
    }
    words_[2] = next[2];
    dropped[line] = joined(words_, " ");
    add(dropped);
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
      replace(line, altered);
    }
  }

  tests::Random random_;
  Certificate certificate_;
  Lines lines_, words_;
  std::vector<Mutant> mutants_;
};

struct Counts {
  std::uint64_t rejected = 0;
  std::uint64_t accepted_and_true = 0;
};

class MutationTest : public ::testing::Test {
 protected:
  void judge(const Mutant& mutant) {
    ++judged_;
    const checker::Report report = tests::check_text(mutant.text);
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
    judge_all(tests::prove(posed, separation, options), stride);
  }
  void judge_all(const Certificate& certificate, unsigned stride) {
    ASSERT_EQ(tests::rejection(certificate), "") << certificate_stream(certificate);
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
  const std::uint64_t wanted = tests::is_soak() ? 200000U : tests::trials(8000U);
  const unsigned stride = tests::is_soak() ? 2 : 16;
  tests::Random random(23);
  const auto either_kind = [&] { return random.coin() ? Kind::vertex_face : Kind::edge_edge; };
  const ProveOptions collision{.collision_claim = Claim::collision},
      wide{.width = Rational(1, 100)};
  for (std::uint64_t index = 0; judged() < wanted; ++index) {
    for (const verify::generate::Family& family : verify::generate::families()) {
      const Kind kind = either_kind();
      if (!verify::generate::supports(family, kind)) continue;
      judge_all({kind, verify::generate::make_query(family, kind, 3, index).query}, {}, stride);
    }
    for (std::size_t i = 0; i < 2 * tests::all_families.size(); ++i) {
      const tests::Family family = tests::all_families.at(i % tests::all_families.size());
      const auto judge_with = [&](const ProveOptions& options, const Separation& separation) {
        judge_all(tests::random_query(random, either_kind(), family), options, stride, separation);
      };
      for (const ProveOptions& options : {ProveOptions{}, collision, wide}) judge_with(options, {});
      for (const Norm norm : {Norm::linf, Norm::l2}) {
        const Separation near{random.between(1, 4) / 4.0, norm};
        judge_with({}, near);
        judge_with({}, {0x1p-60, norm});
        judge_with(collision, near);
      }
      const Query element = tests::element_of_sort(random, static_cast<int>(i));
      for (const ProveOptions& options : {ProveOptions{}, collision, wide}) {
        judge_all({Kind::tetrahedron, element}, options, stride);
      }
    }
  }
  report();
}

}  // namespace
}  // namespace touchstone::exact::certificate_mutation_test
