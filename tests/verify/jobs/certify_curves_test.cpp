#include "verify/jobs/certify_curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "verify/baselines/curved_methods.hpp"
#include "verify/generate/curved_families.hpp"

namespace touchstone::verify::jobs::certify_curves_test {
namespace {

/// The known truth of the families, the oracle, the certified solver and the checker's certificates
/// agree; what others miss is known.
TEST(CertifyCurves, FindsTheKnownTruthOfTheFamilies) {
  std::map<std::string, CurvedJudgement> others;
  for (const std::size_t degree : {std::size_t{2}, std::size_t{3}}) {
    for (const generate::CurvedFamily& family : generate::curved_families(degree, 3, 5)) {
      const CurvedResult result =
          certify_curves(family.kind, family.queries(),
                         {.threads = 1, .truth = family.toi, .judge_others = true, .prove = true});
      EXPECT_EQ(result.queries, 3U);
      const bool misses = family.name == "near_miss" || family.name == "rotation_miss";
      EXPECT_EQ(result.collide, misses ? 0U : 3U) << family.name;
      EXPECT_EQ(result.others.empty(), family.is_rational) << family.name;
      EXPECT_TRUE(result.wrong.empty()) << family.name;
      EXPECT_TRUE(result.against_truth.empty()) << family.name;
      EXPECT_EQ(result.certificates, 3U);
      for (const CurvedJudgement& other : result.others) {
        CurvedJudgement& sum = others[std::string(other.name)];
        sum.false_negatives += other.false_negatives;
        sum.false_positives += other.false_positives;
        sum.late += other.late;
      }
    }
  }
  ASSERT_EQ(others.size(), 5U);
  EXPECT_EQ(others["tight_inclusion"].false_negatives, 0U);
  EXPECT_EQ(others["tight_inclusion"].late, 0U);
  EXPECT_EQ(others["subdivision"].false_negatives, 0U);
  EXPECT_GT(others["sampling"].false_negatives, 0U);
  EXPECT_GT(others["sampling"].late, 0U);
  EXPECT_GT(others["advancement"].false_positives, 0U);
}

/// Rotations touch, or miss by as little as 2^-36 of the radius, and have the weights of a circle.
TEST(CertifyCurves, RotationsAreRationalAndOfDegreeTwo) {
  std::size_t rotations = 0;
  for (const generate::CurvedFamily& family : generate::curved_families(2, 40, 7)) {
    if (!family.is_rational) continue;
    ++rotations;
    const CurvedQueries queries = family.queries();
    ASSERT_EQ(queries.size(), 40U);
    ASSERT_EQ(family.toi.size(), 40U);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      for (const Trajectory& curve : queries.query(i)) {
        EXPECT_EQ(curve.weights, (std::vector<double>{1, 1, 2}));
      }
    }
    const CurvedResult result =
        certify_curves(family.kind, queries, {.threads = 1, .truth = family.toi});
    EXPECT_TRUE(result.wrong.empty()) << family.name;
    EXPECT_TRUE(result.against_truth.empty()) << family.name;
    EXPECT_EQ(result.collide, family.name == "rotation_touch" ? 40U : 0U);
  }
  EXPECT_EQ(rotations, 4U);
  for (const generate::CurvedFamily& family : generate::curved_families(3, 1, 7)) {
    EXPECT_FALSE(family.is_rational) << family.name;
  }
}

TEST(CertifyCurves, SaysWhatContradictsTheTruth) {
  generate::CurvedFamily family = generate::curved_families(2, 4, 6).front();
  family.toi[1] = std::nullopt;
  family.toi[2] = *family.toi[2] / 2;
  const CurvedResult result =
      certify_curves(family.kind, family.queries(), {.threads = 1, .truth = family.toi});
  EXPECT_EQ(result.against_truth, (std::vector<std::size_t>{1, 2}));
}

/// Both primitives bulge towards each other between their ends, by 3/8 each, and are 1/2 apart
/// there: chords come within the sum of the deviations, and not within the greater one.
TEST(CurvedMethods, WithTheLargestDeviationMissContacts) {
  std::vector<double> numbers;
  for (const double bulge : {0.0, 0.75, 0.0}) {
    for (const double x :
         {0.0, 0.0, 0.5 - bulge, -1.0, -1.0, bulge, 2.0, -1.0, bulge, -1.0, 2.0, bulge}) {
      numbers.push_back(x);
    }
  }
  const CurvedQueries queries{2, false, numbers};
  std::map<std::string, bool> finds;
  for (const baselines::CurvedMethod& method : baselines::curved_methods()) {
    finds[std::string(method.name)] = method.solve(Kind::vertex_face, queries, 0).has_value();
  }
  EXPECT_TRUE(finds["subdivision"]);
  EXPECT_FALSE(finds["subdivision_largest_deviation"]);
  EXPECT_EQ(certify_curves(Kind::vertex_face, queries, {.threads = 1}).collide, 1U);
}

}  // namespace
}  // namespace touchstone::verify::jobs::certify_curves_test
