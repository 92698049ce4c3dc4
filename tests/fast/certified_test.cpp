/// \file
/// The certified solver by hand, in batches and as a method, at contact and at separations.
/// (deciders_test.cpp compares it with the oracle.)

#include "touchstone/certified.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "tests/support/certified.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace touchstone::fast::certified_test {
namespace {

using tests::fault;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

CertifiedResult solve(const PosedQuery& posed, const CertifiedOptions& options = {}) {
  return fast::solve(posed.kind, posed.query, options);
}

// ---- By hand ------------------------------------------------------------------------------------

/// Contact, and separations in both norms.
const std::vector<Separation> separations{{}, {0.01, Norm::linf}, {0.01, Norm::l2}};

void expect_within(const CertifiedResult& result, double toi) {
  ASSERT_EQ(result.verdict, Verdict::yes);
  EXPECT_LT(result.toi_lower, toi);
  EXPECT_GE(result.toi_upper, toi);
  EXPECT_LE(result.toi_upper - result.toi_lower, 1e-12);
}

TEST(Certified, FindsAnImpactAndItsPlace) {
  for (const PosedQuery& posed : {over_triangle(1, 2, 3, -1), over_edge(1, 2, 3, -1)}) {
    const CertifiedResult result = solve(posed);
    expect_within(result, 0.75);
    EXPECT_NEAR(result.u, 0.25, 1e-9);
    EXPECT_NEAR(result.v, 0.5, 1e-9);
  }
  // The height falls from 1 to −1, and is d at the time (1 − d)/2.
  for (const PosedQuery& posed : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      for (const double distance : {0.5, 0.25, 0x1p-20, 0x1p-40}) {
        const CertifiedResult result = solve(posed, {.separation = {distance, norm}});
        expect_within(result, (1.0 - distance) / 2.0);
        EXPECT_EQ(result.stage, Stage::bisection);
        EXPECT_NEAR(result.u, 0.25, 1e-6);
      }
    }
  }
}

TEST(Certified, EndsEachSortOfQueryInItsStage) {
  // Far above; beyond the slanted side; never crossing the plane of the triangle (always above it,
  // in a tilted frame); crossing it beside the triangle; in contact with an edge.
  EXPECT_EQ(solve(over_triangle(1, 1, 3, 1)).stage, Stage::axis);
  EXPECT_EQ(solve(over_triangle(3, 3, 1, -1)).stage, Stage::direction);
  EXPECT_EQ(solve(over_triangle(1, 1, 1, -1)).stage, Stage::bisection);
  EXPECT_EQ(solve(over_triangle(2, 2, 1, -1)).stage, Stage::exact);
  EXPECT_EQ(solve(over_triangle(2, 2, 1, -1)).verdict, Verdict::yes);
}

TEST(Certified, WhatCrossesThePlaneNearAnEdgeIsDecidedInFloatingPoint) {
  // A vertex that also moves along x, over the triangle (0,0,0), (1,0,0), (0,1,0): at t = 0.4 it is
  // in the plane, at this distance inside the edge x = 0.
  const auto beside_edge = [](double inside) {
    Query query{};
    for (std::size_t end = 0; end < 2; ++end) {
      const double t = static_cast<double>(end);
      query.at(end, 0, 0) = inside + (t - 0.4);
      query.at(end, 0, 1) = 0.25;
      query.at(end, 0, 2) = 0.4 - t;
      query.at(end, 2, 0) = 1.0;
      query.at(end, 3, 1) = 1.0;
    }
    return query;
  };
  for (const double inside : {0x1p-8, 0x1p-12, 0x1p-20, 0x1p-28}) {
    const Query colliding = beside_edge(inside), no_collision = beside_edge(-inside);
    EXPECT_EQ(fast::solve(Kind::vertex_face, colliding).stage, Stage::bisection) << inside;
    EXPECT_EQ(fast::solve(Kind::vertex_face, colliding).verdict, Verdict::yes) << inside;
    EXPECT_EQ(fast::solve(Kind::vertex_face, no_collision).stage, Stage::bisection) << inside;
    EXPECT_EQ(fast::solve(Kind::vertex_face, no_collision).verdict, Verdict::no) << inside;
    for (const Query& query : {colliding, no_collision}) {
      EXPECT_FALSE(fault(Kind::vertex_face, query, fast::solve(Kind::vertex_face, query)))
          << inside;
    }
  }
  EXPECT_EQ(fast::solve(Kind::vertex_face, beside_edge(0x1p-50)).stage, Stage::exact);
}

TEST(Certified, EveryStageIsReached) {
  std::array<std::size_t, stages> reached{}, separated{};
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    Random random(7);
    std::vector<Query> queries(3000);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      queries[i] = i % 10 == 0 ? tests::near_contact_query(random, kind)
                               : tests::full_significand_query(random);
    }
    std::vector<CertifiedResult> results(queries.size());
    for (const Separation& separation : separations) {
      solve(kind, queries, results, {.separation = separation});
      for (const CertifiedResult& result : results) {
        ++(separation == Separation{} ? reached : separated)
              .at(static_cast<std::size_t>(result.stage));
      }
    }
  }
  for (std::size_t i = 0; i < stages; ++i) {
    EXPECT_GT(reached.at(i), 0U) << to_string(static_cast<Stage>(i));
    EXPECT_GT(separated.at(i), 0U) << to_string(static_cast<Stage>(i));
  }
}

/// Contact at t_max counts, though the enclosure ends beyond it (certified.hpp).
TEST(Certified, TheUpperEndMayLieBeyondTMax) {
  const CertifiedResult result =
      solve(over_triangle(1, 1, 1, -1), {.toi_tolerance = 0.1, .t_max = 0.5});
  EXPECT_EQ(result.verdict, Verdict::yes);
  EXPECT_LT(result.toi_lower, 0.5);
  EXPECT_GT(result.toi_upper, 0.5);
  EXPECT_LE(result.toi_upper - result.toi_lower, 0.1 * result.toi_upper);
  const CertifiedResult at_end = solve(over_triangle(1, 1, 1, 0), {.toi_tolerance = 0.1});
  EXPECT_EQ(at_end.toi_upper, 1.0) << "but not beyond 1";
}

// ---- Errors -------------------------------------------------------------------------------------

TEST(Certified, CoordinatesThatAreNotFiniteAreAnErrorOfTheirQueryAlone) {
  for (const Separation& separation : separations) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
        for (std::size_t place = 0; place < 24; ++place) {
          // One query that any axis separates, and one that collides.
          for (const double height : {5.0, -1.0}) {
            std::vector<Query> queries(3, kind == Kind::vertex_face
                                              ? over_triangle(1, 1, 7, height).query
                                              : over_edge(1, 1, 7, height).query);
            queries[1].coordinates.at(place) = bad;
            std::vector<CertifiedResult> results(3);
            solve(kind, queries, results, {.separation = separation});
            EXPECT_EQ(results[1].verdict, Verdict::error) << bad << " at " << place;
            EXPECT_EQ(results[0].verdict, height < 0 ? Verdict::yes : Verdict::no);
            EXPECT_EQ(results[2].verdict, results[0].verdict);
          }
        }
      }
    }
  }
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void expect_same(std::span<const CertifiedResult> a, std::span<const CertifiedResult> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].verdict, b[i].verdict) << i;
    EXPECT_EQ(a[i].stage, b[i].stage) << i;
    EXPECT_TRUE(same(a[i].toi_lower, b[i].toi_lower) && same(a[i].toi_upper, b[i].toi_upper)) << i;
    EXPECT_TRUE(same(a[i].u, b[i].u) && same(a[i].v, b[i].v)) << i;
  }
}

// ---- Meshes -------------------------------------------------------------------------------------

TEST(Certified, IndexPairsGiveWhatTheirQueriesGive) {
  Random random(31);
  const tests::Scene scene = tests::soup(random, 40, 0.4);
  const MovingVertices vertices(scene.start, scene.end);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    std::vector<IndexPair> pairs;
    for (const tests::AllPairs all(scene); const auto& [of_kind, pair] : all.pairs()) {
      const PairKind wanted =
          kind == Kind::vertex_face ? PairKind::vertex_face : PairKind::edge_edge;
      if (of_kind == wanted) pairs.push_back(pair);
    }
    const Candidates candidates{
        .kind = kind, .pairs = pairs, .edges = scene.edges, .faces = scene.faces};
    std::vector<Query> queries;
    for (const IndexPair& pair : candidates.pairs) {
      queries.push_back(query_of(vertices, candidates, pair));
    }
    std::vector<CertifiedResult> of_queries(queries.size());
    for (const CertifiedKernel* const kernel : certified_kernels()) {
      for (std::size_t i = 0; i < 2 * separations.size(); ++i) {
        const UseKernels use({.certified = kernel});
        const CertifiedOptions options{.separation = separations[i / 2],
                                       .max_threads = i % 2 == 0 ? 1 : 4};
        solve(kind, queries, of_queries, options);
        const std::vector<Collision> all = collisions(vertices, candidates, options);
        std::vector<CertifiedResult> rebuilt(of_queries);
        std::size_t hits = 0;
        for (const CertifiedResult& result : of_queries)
          hits += result.verdict == Verdict::yes ? 1U : 0U;
        EXPECT_GT(hits, 5U);
        ASSERT_EQ(all.size(), hits);
        for (const Collision& collision : all) rebuilt.at(collision.candidate) = collision.result;
        expect_same(of_queries, rebuilt);
        EXPECT_TRUE(std::ranges::is_sorted(all, {}, &Collision::candidate));

        const std::vector<Collision> from_array = collisions(kind, queries, options);
        ASSERT_EQ(from_array.size(), all.size());
        for (std::size_t k = 0; k < all.size(); ++k) {
          EXPECT_EQ(from_array[k].candidate, all[k].candidate);
          expect_same(std::span(&from_array[k].result, 1), std::span(&all[k].result, 1));
        }
      }
    }
  }
}

// ---- As a method --------------------------------------------------------------------------------

TEST(CertifiedMethod, HeedsTMaxAndTheSeparation) {
  EXPECT_EQ(certified_method()->name(), "certified");
  EXPECT_EQ(certified_method()->promise(), Promise::exact);
  const Query query = over_triangle(1, 1, 1, -1).query;
  const Queries queries(Kind::vertex_face, {&query, 1});
  Answer answer;
  certified_method()->solve(queries, std::span(&answer, 1), {.t_max = 0.25});
  EXPECT_EQ(answer.verdict, Verdict::no);
  // Contact at a distance of 1/2 is at t = 1/4.
  certified_method()->solve(queries, std::span(&answer, 1),
                            {.separation = {.distance = 0.5, .norm = Norm::l2}, .t_max = 0.25});
  EXPECT_EQ(answer.verdict, Verdict::yes);
  EXPECT_LT(answer.toi_lower, 0.25);
  EXPECT_GE(answer.toi_upper, 0.25);
  EXPECT_LE(answer.toi_upper, 0.25 + 1e-12);
  for (const double bad : {-1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    certified_method()->solve(queries, std::span(&answer, 1), {.separation = {.distance = bad}});
    EXPECT_EQ(answer.verdict, Verdict::error) << bad;
  }
}

}  // namespace
}  // namespace touchstone::fast::certified_test
