/// \file
/// The checker's mathematics on the certificates of certificates.txt: every claim, feature and form
/// of contact is accepted where it is proved, and every rule rejects what breaks it.
/// (certificate_mutation_test.cpp forges and alters certificates against the oracle.)

#include "exact/checker/proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/rows.hpp"

namespace touchstone::checker::proof_test {
namespace {

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

}  // namespace
}  // namespace touchstone::checker::proof_test
