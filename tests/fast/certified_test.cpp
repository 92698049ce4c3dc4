/// \file
/// The certified solver by hand, in batches and as a method, at contact and at separations.
/// (deciders_test.cpp compares it with the oracle.)

#include "touchstone/certified.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "fast/candidates.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "tests/support/certified_against_oracle.hpp"
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
    for (const double place : {inside, -inside}) {
      const Query query = beside_edge(place);
      const CertifiedResult result = fast::solve(Kind::vertex_face, query);
      EXPECT_EQ(result.stage, Stage::bisection) << place;
      EXPECT_EQ(result.verdict, place > 0.0 ? Verdict::yes : Verdict::no) << place;
      EXPECT_FALSE(fault(Kind::vertex_face, query, result)) << place;
    }
  }
  EXPECT_EQ(fast::solve(Kind::vertex_face, beside_edge(0x1p-50)).stage, Stage::exact);
}

TEST(Certified, EveryStageIsReached) {
  std::array<std::size_t, stage_count> reached{}, separated{};
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
  for (std::size_t i = 0; i < stage_count; ++i) {
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
            EXPECT_THROW((void)collisions(kind, queries, {.separation = separation}),
                         std::domain_error);
          }
        }
      }
    }
  }
}

auto numbers_of(const Collision& collision) {
  const CertifiedResult& x = collision.result;
  return std::tuple(collision.candidate, x.verdict, x.stage, x.toi_lower, x.toi_upper, x.u, x.v);
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
        std::vector<Collision> expected;
        for (std::size_t k = 0; k < of_queries.size(); ++k) {
          if (of_queries[k].verdict == Verdict::yes) expected.push_back({k, of_queries[k]});
        }
        EXPECT_GT(expected.size(), 5U);
        for (const auto& found :
             {collisions(vertices, candidates, options), collisions(kind, queries, options)}) {
          EXPECT_TRUE(std::ranges::equal(found, expected, {}, numbers_of, numbers_of));
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
  const auto answer_to = [&query](const MethodOptions& options) {
    Answer answer;
    certified_method()->solve({Kind::vertex_face, {&query, 1}}, std::span(&answer, 1), options);
    return answer;
  };
  EXPECT_EQ(answer_to({.t_max = 0.25}).verdict, Verdict::no);
  // Contact at a distance of 1/2 is at t = 1/4.
  const Answer near = answer_to({.separation = {.distance = 0.5, .norm = Norm::l2}, .t_max = 0.25});
  EXPECT_EQ(near.verdict, Verdict::yes);
  EXPECT_LT(near.toi_lower, 0.25);
  EXPECT_GE(near.toi_upper, 0.25);
  EXPECT_LE(near.toi_upper, 0.25 + 1e-12);
  for (const double bad : {-1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(answer_to({.separation = {.distance = bad}}).verdict, Verdict::error) << bad;
  }
}

}  // namespace
}  // namespace touchstone::fast::certified_test
