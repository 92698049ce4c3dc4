#include "verify/judge/label.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/support/queries.hpp"

namespace touchstone::verify::judge::label_test {
namespace {

using exact::Rational;

/// The texts of the mismatches of a vertex that falls on a triangle, at 1/2 or never.
std::vector<std::string> judged(bool collides, const Label& label,
                                const LabelComparison& comparison) {
  const tests::PosedQuery posed = tests::over_triangle(1, 1, 1, collides ? -1 : 0.5);
  std::vector<std::string> texts;
  for (const Mismatch& mismatch :
       judge_label(7, label, exact::decide(posed.kind, posed.query), comparison)) {
    EXPECT_EQ(mismatch.index, 7U);
    texts.push_back(to_text(mismatch));
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(JudgeLabel, ComparesVerdictAndTime) {
  const LabelComparison full{.tolerance = Rational(1, 8)};
  EXPECT_EQ(judged(true, {}, full), Texts{});
  EXPECT_EQ(judged(true, {.collides = true, .toi = Rational(5, 8)}, full), Texts{});
  EXPECT_EQ(judged(true, {.collides = true, .toi = Rational(3, 8)}, full), Texts{});
  EXPECT_EQ(judged(true, {.collides = false, .toi = Rational(3, 4)}, full),
            (Texts{"recorded label: no collision, the truth is collision",
                   "recorded time of impact: 7.5E-1, the truth is 5E-1"}));
  EXPECT_EQ(judged(false, {.collides = true, .toi = Rational(1, 2)}, full),
            (Texts{"recorded label: collision, the truth is no collision",
                   "recorded time of impact: 5E-1, the truth is no collision"}));
}

/// A claim about a smaller separation: the query collides, no later.
TEST(JudgeLabel, ComparesWhatFollows) {
  const LabelComparison collisions{.inference = Inference::collisions, .tolerance = 0};
  EXPECT_EQ(judged(true, {.collides = true, .toi = Rational(1)}, collisions), Texts{});
  EXPECT_EQ(judged(true, {.toi = Rational(1, 4)}, collisions).size(), 1U) << "it is later";
  EXPECT_EQ(judged(true, {.collides = false}, collisions), Texts{});
  EXPECT_EQ(judged(false, {.collides = true}, collisions).size(), 1U);
  const LabelComparison nothing{.inference = Inference::nothing, .tolerance = 0};
  EXPECT_EQ(judged(false, {.collides = true, .toi = Rational(1)}, nothing), Texts{});
}

}  // namespace
}  // namespace touchstone::verify::judge::label_test
