/// \file
/// The certified solver with a minimum separation, in both norms, by hand and in batches.
/// (tests/fast/deciders_test.cpp compares it with the oracle, kernel_test.cpp its kernels with each
/// other.)

#include "fast/certified/stages/conservative_advancement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "fast/certified.hpp"
#include "fast/certified/kernel.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::conservative_advancement_test {
namespace {

using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array norms{Norm::linf, Norm::l2};

// ---- By hand ------------------------------------------------------------------------------------

TEST(Separated, ContactIsAtTheDistance) {
  // The height over the inside falls from 1 to −1, and is d at the time (1 − d)/2.
  for (const PosedQuery& posed : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    for (const Norm norm : norms) {
      for (const double distance : {0.5, 0.25, 0x1p-20, 0x1p-40}) {
        const CertifiedOptions options{.separation = {.distance = distance, .norm = norm}};
        const CertifiedResult result = fast::solve(posed.kind, posed.query, options);
        const double toi = (1.0 - distance) / 2.0;
        ASSERT_EQ(result.verdict, Verdict::yes) << distance;
        EXPECT_EQ(result.stage, Stage::bisection);
        EXPECT_LT(result.toi_lower, toi);
        EXPECT_GE(result.toi_upper, toi);
        EXPECT_LE(result.toi_upper - result.toi_lower, 1e-12);
        EXPECT_NEAR(result.u, 0.25, 1e-6);
      }
    }
  }
}

TEST(Separated, ContactAtTheDistanceCountsAndBeyondDoesNot) {
  for (const Norm norm : norms) {
    const auto verdict = [&](double height, double distance) {
      const PosedQuery posed = over_triangle(1, 1, height, height);
      return fast::solve(posed.kind, posed.query, {.separation = {distance, norm}}).verdict;
    };
    for (const double distance : {0.5, 1e-2, 1e-8, 1e-100}) {
      EXPECT_EQ(verdict(distance, distance), Verdict::yes);
      EXPECT_EQ(verdict(std::nextafter(distance, 2.0), distance), Verdict::no);
      EXPECT_EQ(verdict(-distance, distance), Verdict::yes);
    }
  }
}

TEST(Separated, NormsDifferBesideACorner) {
  // Primitives beside the triangle's corner (0,0) by 0.3 along x and 0.4 along z: 0.5 in L2, 0.4 in
  // L∞.
  const PosedQuery posed = over_triangle(-0.3, 0.0, 0.4, 0.4);
  const auto verdict = [&](double distance, Norm norm) {
    return fast::solve(posed.kind, posed.query, {.separation = {distance, norm}}).verdict;
  };
  EXPECT_EQ(verdict(0.45, Norm::linf), Verdict::yes);
  EXPECT_EQ(verdict(0.45, Norm::l2), Verdict::no);
  EXPECT_EQ(verdict(0.55, Norm::l2), Verdict::yes);
  EXPECT_EQ(verdict(0.39, Norm::linf), Verdict::no);
}

TEST(Separated, EveryStageIsReached) {
  std::array<std::size_t, stages> reached{};
  for (const Kind kind : kinds) {
    Random random(7);
    std::vector<Query> queries(3000);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      queries[i] = i % 10 == 0 ? tests::near_contact_query(random, kind)
                               : tests::full_significand_query(random);
    }
    std::vector<CertifiedResult> results(queries.size());
    for (const Norm norm : norms) {
      solve(kind, queries, results, {.separation = {.distance = 0.01, .norm = norm}});
      for (const CertifiedResult& result : results) {
        ++reached.at(static_cast<std::size_t>(result.stage));
      }
    }
  }
  for (std::size_t i = 0; i < stages; ++i) {
    EXPECT_GT(reached.at(i), 0U) << to_string(static_cast<Stage>(i));
  }
}

TEST(Separated, CoordinatesThatAreNotFiniteAreAnErrorOfTheirQueryAlone) {
  for (const Norm norm : norms) {
    for (std::size_t place = 0; place < 24; ++place) {
      std::vector<Query> queries(3, over_triangle(1, 1, 7, -1).query);
      queries[1].coordinates.at(place) = std::numeric_limits<double>::quiet_NaN();
      std::vector<CertifiedResult> results(3);
      solve(Kind::vertex_face, queries, results, {.separation = {.distance = 0.1, .norm = norm}});
      EXPECT_EQ(results[0].verdict, Verdict::yes);
      EXPECT_EQ(results[1].verdict, Verdict::error);
      EXPECT_EQ(results[2].verdict, Verdict::yes);
    }
  }
}

// ---- Batches ------------------------------------------------------------------------------------

/// A triangle, and points that fall on it from heights 1, 2, …, 12 to −1.
struct Rain {
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(15, 3), end = Eigen::MatrixXd::Zero(15, 3);
  std::vector<Face> faces{{0, 1, 2}};
  std::vector<IndexPair> pairs;

  Rain() {
    start.row(1) = end.row(1) = Eigen::RowVector3d(4, 0, 0);
    start.row(2) = end.row(2) = Eigen::RowVector3d(0, 4, 0);
    for (int i = 3; i < 15; ++i) {
      start.row(i) = Eigen::RowVector3d(1, 1, i - 2);
      end.row(i) = Eigen::RowVector3d(1, 1, -1);
      pairs.push_back({i, 0});
    }
  }
};

TEST(Separated, BatchesFindTheSameAndTheEarliest) {
  const Rain rain;
  const MovingVertices vertices(rain.start, rain.end);
  const Candidates candidates{
      .kind = Kind::vertex_face, .pairs = rain.pairs, .edges = {}, .faces = rain.faces};
  for (const Norm norm : norms) {
    for (const int threads : {1, 3}) {
      const CertifiedOptions options{.separation = {.distance = 0.5, .norm = norm},
                                     .max_threads = threads};
      std::vector<CertifiedResult> results(rain.pairs.size());
      solve(vertices, candidates, results, options);
      for (std::size_t i = 0; i < results.size(); ++i) {
        // The height falls from h = i+1 to ½.
        const auto height = static_cast<double>(i + 1);
        ASSERT_EQ(results[i].verdict, Verdict::yes);
        EXPECT_NEAR(results[i].toi_upper, (height - 0.5) / (height + 1.0), 1e-11);
      }
      EXPECT_EQ(collisions(vertices, candidates, options).size(), rain.pairs.size());
      const auto first = earliest(vertices, candidates, options);
      ASSERT_TRUE(first);
      EXPECT_EQ(first->toi_lower, results[0].toi_lower);
      EXPECT_EQ(first->toi_upper, results[0].toi_upper);
    }
  }
}

}  // namespace
}  // namespace touchstone::fast::conservative_advancement_test
