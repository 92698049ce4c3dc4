/// \file
/// The certified solver by hand, in batches and as a method. (deciders_test.cpp compares it with
/// the oracle.)

#include "touchstone/certified.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "tests/support/certified.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

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

TEST(Certified, FindsAnImpactAndItsPlace) {
  for (const PosedQuery& posed : {over_triangle(1, 2, 3, -1), over_edge(1, 2, 3, -1)}) {
    const CertifiedResult result = solve(posed);
    ASSERT_EQ(result.verdict, Verdict::yes);
    EXPECT_LT(result.toi_lower, 0.75);
    EXPECT_GE(result.toi_upper, 0.75);
    EXPECT_LE(result.toi_upper - result.toi_lower, 1e-12);
    EXPECT_NEAR(result.u, 0.25, 1e-9);
    EXPECT_NEAR(result.v, 0.5, 1e-9);
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

TEST(Certified, EveryStageIsReachedAndNamed) {
  std::array<std::size_t, stages> reached{};
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    Random random(7);
    std::vector<Query> queries(3000);
    for (Query& query : queries) query = tests::full_significand_query(random);
    for (std::size_t i = 0; i < queries.size(); i += 10) {
      queries[i] = tests::near_contact_query(random, kind);
    }
    std::vector<CertifiedResult> results(queries.size());
    solve(kind, queries, results);
    for (const CertifiedResult& result : results)
      ++reached.at(static_cast<std::size_t>(result.stage));
  }
  for (std::size_t i = 0; i < stages; ++i) {
    EXPECT_GT(reached.at(i), 0U) << to_string(static_cast<Stage>(i));
  }
  EXPECT_EQ(to_string(Stage::axis), "axis");
  EXPECT_EQ(to_string(Stage::exact), "exact");
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
          solve(kind, queries, results);
          EXPECT_EQ(results[1].verdict, Verdict::error) << bad << " at " << place;
          EXPECT_EQ(results[0].verdict, height < 0 ? Verdict::yes : Verdict::no);
          EXPECT_EQ(results[2].verdict, results[0].verdict);
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

/// Two sheets of n×n vertices, the upper one falling through the lower, both wrinkled.
struct Sheets {
  Eigen::MatrixXd start, end;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<IndexPair> vertex_face, edge_edge;

  explicit Sheets(int n) : start(2 * n * n, 3), end(2 * n * n, 3) {
    Random random(31);
    for (int sheet = 0; sheet < 2; ++sheet) {
      for (int i = 0; i < n * n; ++i) {
        const int x = i % n, y = i / n;
        const Eigen::RowVector3d at(x + random.uniform(-0.2, 0.2), y + random.uniform(-0.2, 0.2),
                                    0.5 * sheet + random.uniform(-0.2, 0.2));
        start.row(sheet * n * n + i) = at;
        const double fall = sheet == 0 ? 0.0 : -1.0;
        end.row(sheet * n * n + i) = at + Eigen::RowVector3d(random.uniform(-0.2, 0.2), 0.0,
                                                             fall + random.uniform(-0.1, 0.1));
      }
      add_faces(n, sheet * n * n);
    }
    pair_up(n * n);
  }

  void add_faces(int n, int first) {
    for (int y = 0; y + 1 < n; ++y) {
      for (int x = 0; x + 1 < n; ++x) {
        const int i = first + y * n + x;
        faces.push_back({i, i + 1, i + n});
        faces.push_back({i + 1, i + n + 1, i + n});
        edges.push_back({i, i + 1});
        edges.push_back({i, i + n});
        edges.push_back({i + 1, i + n});
      }
    }
  }

  /// All pairs between the sheets.
  void pair_up(int vertices) {
    const auto face_count = static_cast<int>(faces.size()),
               edge_count = static_cast<int>(edges.size());
    for (int v = 0; v < 2 * vertices; ++v) {
      for (int f = 0; f < face_count; ++f) {
        if ((v < vertices) != (f < face_count / 2)) vertex_face.push_back({v, f});
      }
    }
    for (int a = 0; a < edge_count / 2; ++a) {
      for (int b = edge_count / 2; b < edge_count; ++b) edge_edge.push_back({a, b});
    }
  }

  [[nodiscard]] Candidates candidates(Kind kind) const {
    return {.kind = kind,
            .pairs = kind == Kind::vertex_face ? vertex_face : edge_edge,
            .edges = edges,
            .faces = faces};
  }
};

TEST(Certified, IndexPairsGiveWhatTheirQueriesGive) {
  const Sheets sheets(7);
  const MovingVertices vertices(sheets.start, sheets.end);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const Candidates candidates = sheets.candidates(kind);
    std::vector<Query> queries;
    for (const IndexPair& pair : candidates.pairs) {
      queries.push_back(query_of(vertices, candidates, pair));
    }
    std::vector<CertifiedResult> of_queries(queries.size());
    for (const CertifiedKernel* const kernel : certified_kernels()) {
      for (const int threads : {1, 4}) {
        const UseKernels use({.certified = kernel});
        const CertifiedOptions options{.max_threads = threads};
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
        for (std::size_t i = 0; i < all.size(); ++i) {
          EXPECT_EQ(from_array[i].candidate, all[i].candidate);
          expect_same(std::span(&from_array[i].result, 1), std::span(&all[i].result, 1));
        }
      }
    }
  }
}

TEST(Certified, RefusesInvalidCandidates) {
  const Sheets sheets(3);
  const MovingVertices vertices(sheets.start, sheets.end);
  Candidates candidates = sheets.candidates(Kind::vertex_face);
  for (const IndexPair& bad :
       std::initializer_list<IndexPair>{{-1, 0}, {18, 0}, {0, -1}, {0, 16}}) {
    candidates.pairs = std::span(&bad, 1);
    EXPECT_THROW(static_cast<void>(collisions(vertices, candidates)), std::out_of_range);
  }
}

// ---- As a method --------------------------------------------------------------------------------

TEST(CertifiedMethod, AnswersWhatTheSolverFinds) {
  const std::unique_ptr<Method> method = certified_method();
  EXPECT_EQ(method->name(), "certified");
  EXPECT_EQ(method->promise(), Promise::exact);
  Random random(29);
  std::vector<Query> queries(600);
  for (Query& query : queries) query = tests::near_contact_query(random, Kind::edge_edge);
  std::vector<CertifiedResult> results(queries.size());
  solve(Kind::edge_edge, queries, results);
  std::vector<Answer> answers(queries.size());
  method->solve(Kind::edge_edge, queries, answers, {});
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(answers[i].verdict, results[i].verdict);
    EXPECT_TRUE(same(answers[i].toi_lower, results[i].toi_lower));
    EXPECT_TRUE(same(answers[i].toi_upper, results[i].toi_upper));
    EXPECT_EQ(answers[i].checks, static_cast<std::uint32_t>(results[i].stage) + 1);
  }
}

TEST(CertifiedMethod, HeedsTMaxAndTheSeparation) {
  const Query query = over_triangle(1, 1, 1, -1).query;
  Answer answer;
  certified_method()->solve(Kind::vertex_face, std::span(&query, 1), std::span(&answer, 1),
                            {.t_max = 0.25});
  EXPECT_EQ(answer.verdict, Verdict::no);
  // Contact at a distance of 1/2 is at t = 1/4.
  certified_method()->solve(Kind::vertex_face, std::span(&query, 1), std::span(&answer, 1),
                            {.separation = {.distance = 0.5, .norm = Norm::l2}, .t_max = 0.25});
  EXPECT_EQ(answer.verdict, Verdict::yes);
  EXPECT_LT(answer.toi_lower, 0.25);
  EXPECT_GE(answer.toi_upper, 0.25);
  EXPECT_LE(answer.toi_upper, 0.25 + 1e-12);
  for (const double bad : {-1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    certified_method()->solve(Kind::vertex_face, std::span(&query, 1), std::span(&answer, 1),
                              {.separation = {.distance = bad}});
    EXPECT_EQ(answer.verdict, Verdict::error) << bad;
  }
}

}  // namespace
}  // namespace touchstone::fast::certified_test
