/// \file
/// The oracle on cells whose volume is a known product of linear factors, at all scales and
/// places. (In certificate_test.cpp the checker accepts a proof of what it says of any others.)

#include "touchstone/cell.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "tests/support/inverting_cells.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"

namespace touchstone::exact::cell_test {
namespace {

using tests::Random;
using tests::trials;

// ---- By construction ----------------------------------------------------------------------------

/// Also on curves of degree 1.
void expect_truth(CellKind kind, const Query& query, const tests::KnownInversion& known) {
  for (const auto& time : {first_inversion(kind, query), first_inversion(kind, to_curved(query)),
                           first_inversion(Cells(kind, {&query, 1}), 0)}) {
    ASSERT_EQ(time.has_value(), known.numerator >= 0);
    if (!time) return;
    EXPECT_TRUE(*time == Rational(known.numerator, known.denominator));
  }
}

TEST(Cells, DecidesProductsOfFactors) {
  Random random(1);
  std::array<int, 3> starts{};
  int at_end = 0, free = 0;
  for (int round = 0; round < trials(20'000); ++round) {
    const tests::KnownInversion known = tests::product_of_factors(random);
    SCOPED_TRACE(round);
    expect_truth(CellKind::tetrahedron, known.tetrahedron, known);
    ++starts.at(static_cast<std::size_t>(known.start + 1));
    at_end += known.numerator > 0 && known.numerator == known.denominator ? 1 : 0;
    free += known.numerator < 0 ? 1 : 0;
  }
  for (const int count : starts) EXPECT_GT(count, trials(500));
  EXPECT_GT(at_end, trials(200));
  EXPECT_GT(free, trials(1000));
}

TEST(Cells, DecidesTrianglesInThePlane) {
  Random random(2);
  for (int round = 0; round < trials(10'000); ++round) {
    const tests::KnownInversion known = tests::triangle_of_factors(random);
    SCOPED_TRACE(round);
    Query triangle = known.tetrahedron;
    expect_truth(CellKind::tetrahedron, triangle, known);
    // The rest has no effect.
    for (const std::size_t end : {0U, 1U}) {
      for (const std::size_t axis : {0U, 1U, 2U}) {
        triangle.at(end, 3, axis) = std::numeric_limits<double>::infinity();
      }
      for (std::size_t point = 0; point < 3; ++point) triangle.at(end, point, 2) = random.uniform();
    }
    expect_truth(CellKind::plane_triangle, triangle, known);
    EXPECT_EQ(to_tetrahedron(CellKind::plane_triangle, triangle), known.tetrahedron);
  }
}

// ---- Refusals -----------------------------------------------------------------------------------

TEST(Cells, HaveNoSeparationAndTheProofsOfTetrahedra) {
  const Query flat{};
  for (const CellKind kind : cell_kinds) {
    EXPECT_THROW(
        static_cast<void>(verify::base::decide(AnyQueries(kind, {&flat, 1}), 0, {.distance = 1.0})),
        std::invalid_argument);
    EXPECT_EQ(prove_inversion(kind, flat, first_inversion(kind, flat)).kind, CellKind::tetrahedron);
  }
}

/// What is to be finite is.
TEST(Cells, RefusesNumbersThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Query query{};
    query.at(1, 3, 2) = bad;
    EXPECT_THROW(static_cast<void>(first_inversion(CellKind::tetrahedron, query)),
                 std::domain_error);
    query.at(1, 2, 1) = bad;
    EXPECT_THROW(static_cast<void>(first_inversion(CellKind::plane_triangle, query)),
                 std::domain_error);
  }
}

}  // namespace
}  // namespace touchstone::exact::cell_test
