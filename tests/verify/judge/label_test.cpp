#include "verify/judge/label.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "verify/judge/ground_truth_cache.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/judge/terms.hpp"

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

constexpr Separation contact{.distance = 0.0, .norm = Norm::linf};
constexpr Separation contact_l2{.distance = -0.0, .norm = Norm::l2};
constexpr Separation one_linf{.distance = 1.0, .norm = Norm::linf};
constexpr Separation one_l2{.distance = 1.0, .norm = Norm::l2};
constexpr Separation two_linf{.distance = 2.0, .norm = Norm::linf};

// What follows from one separation about another is also shown in
// tests/transcripts/certify_separation.md.

TEST(Separation, OnlyWhatFollowsIsInferred) {
  EXPECT_TRUE(same_separation(contact, contact_l2));
  EXPECT_FALSE(same_separation(one_l2, one_linf));
  EXPECT_FALSE(same_separation(one_linf, two_linf));
  EXPECT_EQ(infer(one_l2, one_l2), Inference::all);
  EXPECT_EQ(infer(contact_l2, contact), Inference::all);
  EXPECT_EQ(infer(contact_l2, one_linf), Inference::collisions);
  EXPECT_EQ(infer(one_linf, two_linf), Inference::collisions);
  EXPECT_EQ(infer(one_l2, one_linf), Inference::collisions);
  EXPECT_EQ(infer(one_l2, two_linf), Inference::collisions);
  // Points within 1 of each other on every axis may be farther apart than 1.
  EXPECT_EQ(infer(one_linf, one_l2), Inference::nothing);
  EXPECT_EQ(infer(two_linf, one_linf), Inference::nothing);
  EXPECT_EQ(infer(one_linf, contact), Inference::nothing);
}

/// Vertices over a triangle that fall from height 1: through it, to half of it, and so on.
data::QueryGroup falling() {
  std::vector<Query> queries;
  for (const double end : {-1.0, 0.5, -3.0, 0.25}) {
    queries.push_back(tests::over_triangle(1, 1, 1, end).query);
  }
  return {"falling", ContactKind::vertex_face, std::move(queries)};
}

/// A stopped cache returns what it knows without the oracle.
TEST(GroundTruthCache, AsksTheOracleOnceAQueryAndSeparation) {
  using Positions = std::vector<std::size_t>;
  const data::QueryGroup group = falling();
  GroundTruthCache truths(group);
  const std::atomic<bool> stop = true;
  const auto known = [&](const Separation& separation, const Positions& positions) {
    return truths.of(separation, positions, &stop).size();
  };
  EXPECT_EQ(truths.of({}, Positions{0, 2}).size(), 2U);
  EXPECT_EQ(known({}, {0, 2, 1}), 2U);
  EXPECT_EQ(truths.of({}, Positions{0, 1, 2, 3}).size(), 4U);
  EXPECT_EQ(known({}, {3, 2, 1, 0}), 4U);
  EXPECT_EQ(known({.distance = 0.0, .norm = Norm::l2}, {3}), 1U)
      << "at distance 0 the norm does not matter";
  const Separation half{.distance = 0.5, .norm = Norm::linf};
  EXPECT_EQ(known(half, {3}), 0U);
  EXPECT_EQ(truths.of(half, Positions{3, 3}).size(), 2U);
  EXPECT_EQ(known(half, {3}), 1U);
  for (const auto& [separation, expected] : {std::pair(Separation{}, 2U),
                                             {Separation{.distance = 0.25, .norm = Norm::l2}, 3U},
                                             {half, 4U}}) {
    std::size_t collisions = 0;
    for (const GroundTruth& truth : truths.of(separation, Positions{0, 1, 2, 3})) {
      collisions += truth.collides ? 1U : 0U;
    }
    EXPECT_EQ(collisions, expected);
  }
  EXPECT_THROW((void)truths.of({}, Positions{4}), std::out_of_range);
}

// ---- Terms --------------------------------------------------------------------------------------

using fast::Terms;

/// A vertex that falls from that height onto a triangle.
base::AnyQuery falling_from(double height) {
  return {ContactKind::vertex_face, tests::over_triangle(1, 1, height, -2).query};
}

TEST(Terms, TheStartIsApartByMoreThanSeparationAndDistance) {
  const auto apart = [](double distance, double height, double separation) {
    return admits({.starts_apart = distance}, falling_from(height), {separation, Norm::l2});
  };
  EXPECT_FALSE(apart(0, 0, 0));
  EXPECT_TRUE(apart(0, 0x1p-1000, 0));
  EXPECT_FALSE(apart(0, 1, 1));
  EXPECT_TRUE(apart(0, 1, 0.5));
  EXPECT_FALSE(apart(0.5, 1, 0.5));
  EXPECT_TRUE(apart(0.25, 1, 0.5));
}

TEST(Terms, FloatCoordinatesAreRounded) {
  const Terms terms{.float_coordinates = true};
  const base::AnyQuery query = falling_from(0.1), asked = as_asked(terms, query);
  EXPECT_NE(asked, query);
  EXPECT_EQ(as_asked(terms, asked), asked);
  EXPECT_FALSE(admits(terms, query, {}));
  EXPECT_TRUE(admits(terms, asked, {}));
  const base::AnyQuery huge = as_asked(terms, falling_from(1e300));
  EXPECT_FALSE(is_finite(huge.numbers()));
  EXPECT_FALSE(admits(terms, huge, {}));
}

TEST(Terms, CurvesStartAtTheirFirstControlPointsAndAreAnsweredByDegree) {
  const Query line = falling_from(0.5).straight();
  std::vector<double> numbers(line.coordinates.begin(), line.coordinates.end());
  numbers.insert(numbers.end(), line.coordinates.begin() + 12, line.coordinates.end());
  const base::AnyQuery curve({.kind = ContactKind::vertex_face, .degree = 2}, numbers);
  EXPECT_FALSE(admits({}, curve, {}));
  EXPECT_FALSE(admits({.least_degree = 3, .most_degree = 8}, curve, {}));
  const Terms terms{.least_degree = 1, .most_degree = 2, .starts_apart = 0.25};
  EXPECT_TRUE(admits(terms, curve, {0.125, Norm::l2}));
  EXPECT_FALSE(admits(terms, curve, {0.25, Norm::l2}));
  EXPECT_TRUE(terms.answers(AnyShape{.degree = 1}));
  EXPECT_FALSE(terms.answers(AnyShape{.degree = 2, .is_rational = true}));
}

TEST(Terms, CellsStartWithAPositiveVolume) {
  const Terms terms{.contacts = {false, false}, .cells = {true, false}, .starts_apart = 0.0};
  const Query resting = tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0x1p-1000},
                                      {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1});
  Query flat = resting;
  flat.at(0, 3, 2) = 0.0;
  EXPECT_TRUE(admits(terms, {CellKind::tetrahedron, resting}, {}));
  EXPECT_FALSE(admits(terms, {CellKind::tetrahedron, flat}, {}));
  EXPECT_FALSE(admits(terms, {CellKind::plane_triangle, resting}, {}));
  EXPECT_FALSE(admits({}, {CellKind::tetrahedron, resting}, {}));
}

TEST(Terms, NameTheKindsWhereTheyAreNotBothAboutContact) {
  EXPECT_EQ(to_text({.cells = {true, false}}), "");
  EXPECT_EQ(to_text({.contacts = {true, false}}), ", vertex-face alone");
  const Terms of_cells{.contacts = {false, false}, .cells = {true, true}};
  EXPECT_EQ(to_text(of_cells), ", tetrahedron and plane-triangle alone");
  EXPECT_EQ(as_options(of_cells), " --answers-kinds tetrahedron --answers-kinds plane-triangle");
}

}  // namespace
}  // namespace touchstone::verify::judge::label_test
