/// \file
/// The checker's mathematics on the certificates of certificates.txt: every claim, feature and form
/// of contact is accepted where it is proved, and every rule rejects what breaks it. Then at
/// random, against the oracle.

#include "exact/checker/proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/contact/corner_motion.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/rows.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::checker::proof_test {
namespace {

using tests::outcome;
using tests::split;
using Texts = std::vector<std::string>;

// ---- The list -----------------------------------------------------------------------------------

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

// ---- At random, against the oracle --------------------------------------------------------------

/// Certificates whose every part is drawn at random from few small values, so that many prove their
/// claim, most do not, and nearly all cases are degenerate.
class RandomCertificate {
 public:
  explicit RandomCertificate(unsigned seed) : random_(seed) { draw_points(); }

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] const touchstone::Query& points() const { return points_; }
  /// The bounds of a time of impact, in eighths.
  [[nodiscard]] std::array<int, 2> bounds() const { return bounds_; }

  [[nodiscard]] std::string text() {
    std::string result = std::string(tests::certificate_header) + "query " +
                         (kind_ == Kind::vertex_face ? "vertex_face\n" : "edge_edge\n");
    for (std::size_t n = 0; n < 24; ++n) {
      if (n % 3 == 0) result += "point";
      result += " " + std::to_string(static_cast<int>(points_.coordinates.at(n)));
      if (n % 3 == 2) result += "\n";
    }
    const int claim = below(4);
    if (claim == 0) return result + "claim no_collision\n" + subintervals(8) + "end\n";
    if (claim == 1) return result + "claim collision\n" + contact(0, 8) + "end\n";
    bounds_ = {below(4), 0};
    bounds_[1] = bounds_[0] + 1 + below(8 - bounds_[0]);
    if (below(8) == 0) bounds_ = {0, 0};
    result += "claim time_of_impact " + eighths(bounds_[0]) + " " + eighths(bounds_[1]) + "\n";
    if (bounds_[1] > 0) result += subintervals(bounds_[0]);
    return result + contact(bounds_[0], bounds_[1]) + "end\n";
  }

 private:
  int below(int limit) { return std::uniform_int_distribution(0, limit - 1)(random_); }
  static std::string eighths(int n) { return std::to_string(n) + "/8"; }
  std::string corner() { return " " + std::to_string(below(kind_ == Kind::vertex_face ? 3 : 4)); }

  void draw_points() {
    kind_ = below(2) == 0 ? Kind::vertex_face : Kind::edge_edge;
    const int range = 2 + below(3);
    for (double& x : points_.coordinates) x = below(2 * range + 1) - range;
    for (std::size_t n = 0; n < 12; ++n) {
      if (below(3) != 0) points_.coordinates.at(12 + n) = points_.coordinates.at(n);
    }
    if (below(4) == 0) {
      for (std::size_t n = 2; n < 24; n += 3) points_.coordinates.at(n) = 0;
    }
  }

  std::string subintervals(int end) {
    std::string result;
    for (int from = 0; from < end || result.empty();) {
      const int to = below(2) == 0 ? end : from + below(end - from + 1);
      result += "separate " + eighths(from) + " " + eighths(to) + feature() + "\n";
      if (from == to && below(2) == 0) break;
      from = to;
    }
    return result;
  }

  std::string feature() {
    switch (below(3)) {
      case 0:
        return " vertex" + corner();
      case 1:
        return " edge" + corner() + corner();
      default:
        return below(2) == 0 ? " face +" : " face -";
    }
  }

  /// A polynomial of the query.
  exact::Polynomial polynomial() {
    const exact::Motion motion = exact::scale_to_integers(kind_, points_);
    const auto axis = static_cast<std::size_t>(below(3));
    const auto any = [&] {
      return static_cast<std::size_t>(below(static_cast<int>(motion.corner_count)));
    };
    switch (below(4)) {
      case 0:
        return exact::to_polynomial(exact::normal_component(motion, axis));
      case 1:
        return exact::to_polynomial(exact::cross_component(motion, any(), any(), axis));
      default:
        return exact::to_polynomial(exact::determinant(motion));
    }
  }

  /// An interval of eighths in [from, to]; if one is found, one at whose ends g has opposite signs.
  std::array<int, 2> interval(const exact::Polynomial& g, int from, int to) {
    std::array<int, 2> result{};
    for (int trial = 0; trial < 8; ++trial) {
      result[0] = from + below(to - from + 1);
      result[1] = result[0] + below(to - result[0] + 1);
      const auto sign = [&](int n) {
        return exact::AlgebraicNumber(exact::Rational(n, 8)).sign_of(g);
      };
      if (sign(result[0]) * sign(result[1]) < 0) break;
    }
    return result;
  }

  std::string contact(int from, int to) {
    std::string result = "contact time " + eighths(from + below(to - from + 1));
    const exact::Polynomial g = polynomial();
    if (g.degree() > 0 && below(3) != 0) {
      const auto [a, b] = interval(g, from, to);
      result = "contact root " + eighths(a) + " " + eighths(b);
      for (const exact::Integer& x : g.coefficients()) result += " " + x.get_str();
    }
    return result + "\n" + place() + "\n";
  }

  std::string place() {
    if (below(3) == 0) return "at segment" + corner() + corner();
    std::array<int, 4> order{0, 1, 2, 3};
    std::shuffle(order.begin(), order.begin() + (kind_ == Kind::vertex_face ? 3 : 4), random_);
    std::string result = "at triangle";
    for (const std::size_t n : {0U, 1U, 2U}) result += " " + std::to_string(order.at(n));
    return result + std::array{" x", " y", " z"}.at(static_cast<std::size_t>(below(3)));
  }

  std::mt19937 random_;
  Kind kind_ = Kind::vertex_face;
  touchstone::Query points_{};
  std::array<int, 2> bounds_{};
};

/// The sign of toi − n/8.
int compare(exact::AlgebraicNumber toi, int n) {
  return toi.sign_of(exact::Polynomial(exact::Integer(-n), exact::Integer(8)));
}

/// Is an accepted claim true?
bool is_true(const std::string& claim, const RandomCertificate& certificate) {
  const exact::Decision verdict = exact::decide(certificate.kind(), certificate.points());
  if (claim == "no_collision") return !verdict.collides();
  if (!verdict.collides() || claim == "collision") return verdict.collides();
  const auto [lower, upper] = certificate.bounds();
  if (upper == 0) return compare(*verdict.toi, 0) == 0;
  return compare(*verdict.toi, lower) > 0 && compare(*verdict.toi, upper) <= 0;
}

TEST(AtRandom, NoFalseClaimIsAccepted) {
  const unsigned trials = tests::is_soak() ? 2'000'000 : tests::trials(120'000U);
  std::map<std::string, int> accepted;
  for (unsigned seed = 0; seed < trials; ++seed) {
    RandomCertificate certificate(seed);
    const std::string text = certificate.text();
    const std::string result = outcome(text);
    if (result.find(':') != std::string::npos) {
      // Refuted, not misspelt.
      ASSERT_GT(std::stoi(result), 10) << text << result;
      ASSERT_EQ(result.find("expected"), std::string::npos) << text << result;
      continue;
    }
    ++accepted[result + (text.find("root") != std::string::npos ? " at a root" : "")];
    ASSERT_TRUE(is_true(result, certificate)) << text << result;
  }
  // As many as make a wrong rule show itself.
  for (const auto& [claim, least] :
       {std::pair("no_collision", 1'000), std::pair("collision", 200),
        std::pair("collision at a root", 50), std::pair("time_of_impact", 100),
        std::pair("time_of_impact at a root", 10)}) {
    EXPECT_GE(accepted[claim], tests::trials(least)) << claim;
    RecordProperty(claim, accepted[claim]);
  }
}

}  // namespace
}  // namespace touchstone::checker::proof_test
