/// \file
/// The certified solver by hand and in batches, at contact and at separations.
/// (deciders_test.cpp compares it with the oracle.)

#include "touchstone/certified.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast::certified_test {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector3d;
using tests::fault;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;

constexpr double infinity = std::numeric_limits<double>::infinity();

CertifiedResult solve(const PosedQuery& posed, const CertifiedOptions& options = {}) {
  return fast::solve(posed.kind, posed.query, options);
}

// ---- By hand ------------------------------------------------------------------------------------

/// Contact, and separations in both norms.
const std::vector<Separation> separations{{}, {0.01, Norm::linf}, {0.01, Norm::l2}};

TEST(Certified, DecidesInFloatingPointUnlessItIsDegenerate) {
  // Far above; beyond the slanted side; never crossing the plane of the triangle (always above it,
  // in a tilted frame); crossing it beside the triangle; in contact with an edge.
  EXPECT_FALSE(solve(over_triangle(1, 1, 3, 1)).is_exact);
  EXPECT_FALSE(solve(over_triangle(3, 3, 1, -1)).is_exact);
  EXPECT_FALSE(solve(over_triangle(1, 1, 1, -1)).is_exact);
  EXPECT_TRUE(solve(over_triangle(2, 2, 1, -1)).is_exact);
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
      const CertifiedResult result = fast::solve(ContactKind::vertex_face, query);
      EXPECT_FALSE(result.is_exact) << place;
      EXPECT_EQ(result.verdict, place > 0.0 ? Verdict::yes : Verdict::no) << place;
      EXPECT_FALSE(fault(ContactKind::vertex_face, query, result)) << place;
    }
  }
  EXPECT_TRUE(fast::solve(ContactKind::vertex_face, beside_edge(0x1p-50)).is_exact);
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
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
        for (std::size_t place = 0; place < 24; ++place) {
          // One query that any axis separates, and one that collides.
          for (const double height : {5.0, -1.0}) {
            std::vector<Query> queries(3, kind == ContactKind::vertex_face
                                              ? over_triangle(1, 1, 7, height).query
                                              : over_edge(1, 1, 7, height).query);
            queries[1].coordinates.at(place) = bad;
            std::vector<CertifiedResult> results(3);
            fast::solve({kind, queries}, results, {.separation = separation});
            EXPECT_EQ(results[1].verdict, Verdict::error) << bad << " at " << place;
            EXPECT_EQ(results[0].verdict, height < 0 ? Verdict::yes : Verdict::no);
            EXPECT_EQ(results[2].verdict, results[0].verdict);
          }
        }
      }
    }
  }
}

using Bits = std::array<std::uint64_t, 4>;
std::tuple<Verdict, bool, Bits> bits_of(const CertifiedResult& x) {
  return {x.verdict, x.is_exact,
          std::bit_cast<Bits>(std::array{x.toi_lower, x.toi_upper, x.u, x.v})};
}
std::tuple<Verdict, std::int64_t, std::array<std::uint64_t, 2>> bits_of(
    const TightInclusionResult& x) {
  return {x.verdict, x.checks,
          std::bit_cast<std::array<std::uint64_t, 2>>(std::array{x.toi, x.tolerance})};
}

// ---- Points and edges ---------------------------------------------------------------------------

/// A point that passes an edge along z at a distance d on y; at 3 on x it meets it, at 5 it does
/// not.
TEST(PrimitivePairs, AreTheirDegenerateQueriesWithTheSameOptions) {
  for (const double d : {0.0, 1e-300, 0.5}) {
    for (const double x : {3.0, 5.0}) {
      const Vector3d p(x, d, 1), q(x, d, -1), a(0, 0, 0), b(4, 0, 0);
      for (const CertifiedOptions& options :
           {CertifiedOptions{},
            {.t_max = 0.25},
            {.separation = {.distance = 1.0, .norm = Norm::l2}}}) {
        const auto expect_same = [&](const CertifiedResult& found, const Vector3d& end, double u) {
          const CertifiedResult expected = solve_vertex_face(p, a, end, a, q, a, end, a, options);
          EXPECT_EQ(found.verdict, expected.verdict) << d << ' ' << x;
          if (found.verdict != Verdict::yes) return;
          EXPECT_EQ(found.toi_lower, expected.toi_lower);
          EXPECT_NEAR(found.u, u, 1e-9);
          EXPECT_EQ(found.v, 0.0);
        };
        expect_same(solve_vertex_edge(p, a, b, q, a, b, options), b, std::min(x / 4, 1.0));
        expect_same(solve_vertex_vertex(p, a, q, a, options), a, 0.0);
      }
    }
  }
}

/// The same bits as of a vertex and a face, alone, in batches, and on curves.
TEST(PrimitivePairs, AreFacesThatHaveShrunkWhateverTheOtherPointsAre) {
  tests::Random random(12);
  for (const QueryShape& shape : tests::shrunken_shapes()) {
    const tests::ShrunkenFaces drawn = tests::shrunken_faces(random, shape, 2000);
    const Queries queries = drawn.queries(), faces = drawn.faces();
    std::vector<CertifiedResult> results(queries.size()), expected(queries.size());
    std::vector<TightInclusionResult> boxes(queries.size()), boxes_of_faces(queries.size());
    for (const double distance : {0.0, 0.5}) {
      const CertifiedOptions options{.separation = {.distance = distance}};
      const TightInclusionOptions box_options{.max_checks = 1000,
                                              .separation = {.distance = distance}};
      fast::solve(queries, results, options);
      fast::solve(faces, expected, options);
      tight_inclusion(queries, boxes, box_options);
      tight_inclusion(faces, boxes_of_faces, box_options);
      std::size_t count = 0;
      for (std::size_t i = 0; i < queries.size(); ++i) {
        ASSERT_EQ(bits_of(results[i]), bits_of(expected[i]));
        ASSERT_EQ(bits_of(boxes[i]), bits_of(boxes_of_faces[i]));
        count += expected[i].verdict == Verdict::yes ? 1U : 0U;
        if (!shape.is_straight()) continue;
        const Query& query = queries.straight()[i];
        ASSERT_EQ(bits_of(fast::solve(shape.kind, query, options)), bits_of(expected[i]));
        ASSERT_EQ(bits_of(tight_inclusion(shape.kind, query, box_options)),
                  bits_of(boxes_of_faces[i]));
      }
      EXPECT_GT(count, 20U);
      EXPECT_LT(count, queries.size() - 20);
    }
    if (!shape.is_straight()) continue;
    std::vector<Distance> apart(queries.size()), apart_of_faces(queries.size());
    std::size_t kept = 0;
    for (const Norm norm : {Norm::l2, Norm::linf}) {
      distances(shape.kind, queries.straight(), 0.375, norm, apart);
      distances(ContactKind::vertex_face, faces.straight(), 0.375, norm, apart_of_faces);
      EXPECT_EQ(apart, apart_of_faces);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query &query = queries.straight()[i], &face = faces.straight()[i];
        ASSERT_EQ(distance(shape.kind, query, 0.375, norm), apart_of_faces[i]);
        const KeptDistance part{.part = 0.1, .norm = norm};
        const bool is_kept = keeps_distance(shape.kind, query, 0.5, part);
        ASSERT_EQ(is_kept, keeps_distance(ContactKind::vertex_face, face, 0.5, part));
        kept += is_kept ? 1U : 0U;
      }
    }
    EXPECT_GT(kept, 20U);
    EXPECT_LT(kept, 2 * queries.size() - 20);
  }
}

TEST(PrimitivePairs, MayBeGivenInAnyShape) {
  const std::vector<double> doubles{3, 0, 1, 3, 0, -1, 0, 0, 0, 4, 0, 0};
  const std::vector<float> floats(doubles.begin(), doubles.end());
  const CertifiedResult expected = solve_vertex_edge(&doubles[0], &doubles[6], &doubles[9],
                                                     &doubles[3], &doubles[6], &doubles[9]);
  ASSERT_EQ(expected.verdict, Verdict::yes);
  const auto expect_same = [&](const CertifiedResult& result) {
    EXPECT_EQ(result.toi_lower, expected.toi_lower);
    EXPECT_EQ(result.toi_upper, expected.toi_upper);
    EXPECT_EQ(result.u, expected.u);
  };
  expect_same(
      solve_vertex_edge(&floats[0], &floats[6], &floats[9], &floats[3], &floats[6], &floats[9]));
  const Eigen::Map<const Eigen::Matrix<float, 4, 3, Eigen::RowMajor>> rows(floats.data());
  expect_same(solve_vertex_edge(rows.row(0), rows.row(2), rows.row(3), rows.row(1), rows.row(2),
                                rows.row(3)));
  const Eigen::MatrixXd columns = rows.cast<double>().transpose();
  expect_same(solve_vertex_edge(columns.col(0), columns.col(2), columns.col(3), columns.col(1),
                                columns.col(2), columns.col(3)));
  const Eigen::VectorXd of_any_size = columns.col(0);
  expect_same(solve_vertex_edge(of_any_size, RowVector3d(0, 0, 0), Vector3d(4, 0, 0),
                                columns.col(1) + Vector3d::Zero(), &doubles[6], columns.col(3)));
  const double plain[3] = {3, 0, 1};  // NOLINT(modernize-avoid-c-arrays)
  expect_same(
      solve_vertex_edge(plain, &doubles[6], &doubles[9], &doubles[3], &doubles[6], &doubles[9]));
}

TEST(PrimitivePairs, RefuseAnythingElse) {
  const Vector3d o(0, 0, 0);
  EXPECT_THROW((void)solve_vertex_vertex(Eigen::VectorXd(2), o, o, o), std::invalid_argument);
  EXPECT_EQ(solve_vertex_vertex(Vector3d(std::nan(""), 0, 0), o, o, o).verdict, Verdict::error);
}

}  // namespace
}  // namespace touchstone::fast::certified_test
