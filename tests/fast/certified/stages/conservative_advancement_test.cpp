/// \file
/// The certified solver with a minimum separation against the oracle, in both norms: on all that the
/// project can generate, on public data, at all magnitudes of coordinates and distances, and in
/// batches. (Its kernels among each other: kernel_test.cpp.)

#include "fast/certified/stages/conservative_advancement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "fast/certified.hpp"
#include "fast/certified/kernel.hpp"
#include "tests/support/certified.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast::conservative_advancement_test {
namespace {

using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array norms{Norm::linf, Norm::l2};
constexpr std::array<double, 5> distances{1e-2, 1e-8, 1e-16, 1e-30, 1e-100};

/// Fails unless each query's result is what the oracle says.
void expect_truth(Kind kind, const std::vector<Query>& queries, const CertifiedOptions& options) {
  std::vector<CertifiedResult> results(queries.size());
  solve(kind, queries, results, options);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto wrong = tests::fault(kind, queries[i], results[i], options);
    ASSERT_FALSE(wrong) << *wrong << " [" << name(results[i].stage) << "] at "
                        << options.separation.distance << " in "
                        << to_string(options.separation.norm) << ": "
                        << PosedQuery{kind, queries[i]};
  }
}

/// For all distances and both norms; a share of the queries for each.
void expect_truth_at_distances(Kind kind, const std::vector<Query>& queries) {
  const std::size_t parts = distances.size() * norms.size();
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<Query> share;
    for (std::size_t i = part; i < queries.size(); i += parts) share.push_back(queries[i]);
    expect_truth(kind, share,
                 {.separation = {.distance = distances.at(part / 2), .norm = norms.at(part % 2)}});
  }
}

// ---- By hand ------------------------------------------------------------------------------------

TEST(Separated, ContactIsAtTheDistance) {
  // From height 1 down to −1, over the inside: at height d at the time (1 − d)/2.
  for (const PosedQuery& posed : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    for (const Norm norm : norms) {
      for (const double distance : {0.5, 0.25, 0x1p-20, 0x1p-40}) {
        const CertifiedOptions options{.separation = {.distance = distance, .norm = norm}};
        const CertifiedResult result = certified(posed.kind, posed.query, options);
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

TEST(Separated, TouchingAtTheDistanceCountsAndBeyondDoesNot) {
  for (const Norm norm : norms) {
    const auto verdict = [&](double height, double distance) {
      const PosedQuery posed = over_triangle(1, 1, height, height);
      return certified(posed.kind, posed.query, {.separation = {distance, norm}}).verdict;
    };
    for (const double distance : {0.5, 1e-2, 1e-8, 1e-100}) {
      EXPECT_EQ(verdict(distance, distance), Verdict::yes);
      EXPECT_EQ(verdict(std::nextafter(distance, 2.0), distance), Verdict::no);
      EXPECT_EQ(verdict(-distance, distance), Verdict::yes);
    }
  }
}

TEST(Separated, NormsDifferBesideACorner) {
  // Beside the corner (0,0) of the triangle by 0.3 along x and 0.4 along z: 0.5 in L2, 0.4 in L∞.
  const PosedQuery posed = over_triangle(-0.3, 0.0, 0.4, 0.4);
  const auto verdict = [&](double distance, Norm norm) {
    return certified(posed.kind, posed.query, {.separation = {distance, norm}}).verdict;
  };
  EXPECT_EQ(verdict(0.45, Norm::linf), Verdict::yes);
  EXPECT_EQ(verdict(0.45, Norm::l2), Verdict::no);
  EXPECT_EQ(verdict(0.55, Norm::l2), Verdict::yes);
  EXPECT_EQ(verdict(0.39, Norm::linf), Verdict::no);
}

TEST(Separated, RefusesDistancesThatAreNone) {
  const PosedQuery posed = over_triangle(1, 1, 1, -1);
  using Limits = std::numeric_limits<double>;
  for (const double bad : {-1e-300, Limits::infinity(), Limits::quiet_NaN()}) {
    EXPECT_THROW(
        static_cast<void>(certified(posed.kind, posed.query, {.separation = {.distance = bad}})),
        std::invalid_argument);
  }
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
    EXPECT_GT(reached.at(i), 0U) << name(static_cast<Stage>(i));
  }
}

// ---- Against the oracle -------------------------------------------------------------------------

TEST(Separated, IsRightOnAllFamilies) {
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const Kind kind : kinds) {
      if (!verify::generate::supports(family, kind)) continue;
      SCOPED_TRACE(family.name);
      std::vector<Query> queries;
      for (std::uint64_t i = 0; i < 10; ++i) {
        queries.push_back(verify::generate::make_query(family, kind, 4, i).query);
      }
      expect_truth_at_distances(kind, queries);
    }
  }
}

TEST(Separated, IsRightOnRandomAndNearContactQueries) {
  const bool soak = std::getenv("TOUCHSTONE_SOAK") != nullptr;  // NOLINT(concurrency-mt-unsafe)
  for (const Kind kind : kinds) {
    Random random(11);
    for (int round = 0; round < (soak ? 1000 : 3); ++round) {
      std::vector<Query> queries(800);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        constexpr std::array families{tests::Family::tiny_integers, tests::Family::small_integers,
                                      tests::Family::full_significands,
                                      tests::Family::near_contact};
        queries[i] = tests::random_query(random, kind, families.at(i / 10 % families.size())).query;
      }
      expect_truth_at_distances(kind, queries);
    }
  }
}

TEST(Separated, IsRightForDistancesOfAllMagnitudes) {
  for (const Kind kind : kinds) {
    Random random(13);
    for (int i = 0; i < 150; ++i) {
      std::vector<Query> queries(2);
      queries[0] = tests::near_contact_query(random, kind);
      queries[1] = tests::full_significand_query(random);
      const int exponent = random.between(-3, 3) * 60;
      for (Query& query : queries) {
        for (double& x : query.coordinates) x = std::ldexp(x, exponent);
      }
      const double distance =
          std::ldexp(random.uniform(1.0, 2.0), exponent - random.between(0, 110));
      expect_truth(kind, queries,
                   {.separation = {.distance = distance, .norm = norms.at(i % 2 == 0 ? 0 : 1)}});
    }
  }
}

TEST(Separated, IsRightAtTheEndsOfTheRange) {
  using Limits = std::numeric_limits<double>;
  for (const Kind kind : kinds) {
    Random random(17);
    for (const int exponent : {-1074, -1030, -500, 98, 101, 500, 1018}) {
      std::vector<Query> queries(6);
      for (Query& query : queries) {
        query = tests::integer_query(random, 2);
        for (double& x : query.coordinates) x = std::ldexp(x, exponent);
      }
      for (const Norm norm : norms) {
        for (const double distance : {Limits::denorm_min(), std::ldexp(1.0, exponent),
                                      std::ldexp(1.0, exponent - 30), 1.0, Limits::max()}) {
          if (distance == 0.0) continue;
          expect_truth(kind, queries, {.separation = {.distance = distance, .norm = norm}});
        }
      }
    }
  }
}

TEST(Separated, IsRightFarFromTheOrigin) {
  for (const Kind kind : kinds) {
    Random random(19);
    std::vector<Query> queries(400);
    for (Query& query : queries) {
      query = tests::near_contact_query(random, kind);
      const double offset = std::ldexp(random.uniform(1.0, 2.0), random.between(0, 52));
      for (double& x : query.coordinates) x += offset;
    }
    expect_truth_at_distances(kind, queries);
  }
}

TEST(Separated, IsRightForEveryToleranceAndTMax) {
  for (const Kind kind : kinds) {
    Random random(23);
    std::vector<Query> queries(40);
    for (Query& query : queries) query = tests::near_contact_query(random, kind);
    for (const Norm norm : norms) {
      const Separation separation{.distance = 1e-3, .norm = norm};
      for (const double tolerance : {0.0, 1e-16, 1e-14, 1e-9, 0.25, 3.0}) {
        expect_truth(kind, queries, {.toi_tolerance = tolerance, .separation = separation});
      }
      for (const double t_max : {0.0, 0.125, 0.5, 0.9}) {
        expect_truth(kind, queries, {.t_max = t_max, .separation = separation});
      }
    }
  }
}

TEST(Separated, IsRightOnPublicData) {
  const auto files = tests::public_datasets();
  if (files.empty()) GTEST_SKIP() << "public data missing";
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const auto source = verify::data::open_dataset(file);
    std::vector<Query> queries;
    while (const auto recorded = source->next()) queries.push_back(recorded->query);
    expect_truth_at_distances(source->kind(), queries);
  }
}

// ---- Relations ----------------------------------------------------------------------------------

TEST(Separated, GreaterDistancesAreReachedEarlier) {
  for (const Kind kind : kinds) {
    Random random(29);
    std::vector<Query> queries(500);
    for (Query& query : queries) query = tests::near_contact_query(random, kind);
    for (const Norm norm : norms) {
      std::vector<CertifiedResult> nearer(queries.size()), farther(queries.size());
      solve(kind, queries, nearer);
      for (const double distance : {1e-100, 1e-16, 1e-12, 1e-8, 1e-4, 1e-2, 1.0}) {
        solve(kind, queries, farther, {.separation = {.distance = distance, .norm = norm}});
        for (std::size_t i = 0; i < queries.size(); ++i) {
          if (nearer[i].verdict != Verdict::yes) continue;
          ASSERT_EQ(farther[i].verdict, Verdict::yes) << distance;
          // Enclosures of times in this order.
          EXPECT_LE(farther[i].toi_lower, nearer[i].toi_upper) << distance;
        }
        nearer = farther;
      }
    }
  }
}

TEST(Separated, MovingAllByAPowerOfTwoChangesNothing) {
  for (const Kind kind : kinds) {
    Random random(31);
    std::vector<Query> queries(200), scaled(200);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      queries[i] = scaled[i] = tests::near_contact_query(random, kind);
      for (double& x : scaled[i].coordinates) x = std::ldexp(x, 40);
    }
    for (const Norm norm : norms) {
      std::vector<CertifiedResult> plain(queries.size()), large(queries.size());
      solve(kind, queries, plain, {.separation = {0x1p-10, norm}});
      solve(kind, scaled, large, {.separation = {0x1p30, norm}});
      for (std::size_t i = 0; i < queries.size(); ++i)
        EXPECT_EQ(plain[i].verdict, large[i].verdict);
    }
  }
}

TEST(Separated, TheRoundingModeDoesNotMatter) {
  Random random(37);
  std::vector<Query> queries(300);
  for (Query& query : queries) query = tests::near_contact_query(random, Kind::edge_edge);
  for (const Norm norm : norms) {
    const CertifiedOptions options{.separation = {.distance = 1e-3, .norm = norm}};
    std::vector<CertifiedResult> plain(queries.size()), other(queries.size());
    solve(Kind::edge_edge, queries, plain, options);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      solve(Kind::edge_edge, queries, other, options);
      std::fesetround(FE_TONEAREST);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_EQ(plain[i].verdict, other[i].verdict);
        if (plain[i].verdict != Verdict::yes) continue;
        EXPECT_EQ(plain[i].toi_lower, other[i].toi_lower);
        EXPECT_EQ(plain[i].toi_upper, other[i].toi_upper);
      }
    }
  }
}

TEST(Separated, WhatIsNoNumberIsAnErrorOfItsQueryAlone) {
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
        // From height h = i+1 to ½.
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
