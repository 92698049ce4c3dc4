/// \file
/// The oracle on elements whose volume is a known product of linear factors, at all scales and
/// places. (In certificate_test.cpp the checker accepts a proof of what it says of any others.)

#include "touchstone/element.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "tests/support/inverting_elements.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::element_test {
namespace {

using tests::Random;
using tests::trials;

// ---- By construction ----------------------------------------------------------------------------

/// Also on curves of degree 1.
void expect_truth(Kind kind, const Query& query, const tests::KnownInversion& known) {
  for (const Decision& decision : {decide(kind, query), decide(kind, to_curved(query))}) {
    ASSERT_EQ(decision.collides(), known.numerator >= 0);
    if (!decision.collides()) return;
    EXPECT_TRUE(*decision.toi == Rational(known.numerator, known.denominator));
  }
}

TEST(Elements, DecidesProductsOfFactors) {
  Random random(1);
  std::array<int, 3> starts{};
  int at_end = 0, free = 0;
  for (int round = 0; round < trials(20'000); ++round) {
    const tests::KnownInversion known = tests::product_of_factors(random);
    SCOPED_TRACE(round);
    expect_truth(Kind::tetrahedron, known.tetrahedron, known);
    ++starts.at(static_cast<std::size_t>(known.start + 1));
    at_end += known.numerator > 0 && known.numerator == known.denominator ? 1 : 0;
    free += known.numerator < 0 ? 1 : 0;
  }
  for (const int count : starts) EXPECT_GT(count, trials(500));
  EXPECT_GT(at_end, trials(200));
  EXPECT_GT(free, trials(1000));
}

TEST(Elements, DecidesTrianglesInThePlane) {
  Random random(2);
  for (int round = 0; round < trials(10'000); ++round) {
    const tests::KnownInversion known = tests::triangle_of_factors(random);
    SCOPED_TRACE(round);
    Query triangle = known.tetrahedron;
    expect_truth(Kind::tetrahedron, triangle, known);
    // The rest has no effect.
    for (const std::size_t end : {0U, 1U}) {
      for (const std::size_t axis : {0U, 1U, 2U}) {
        triangle.at(end, 3, axis) = std::numeric_limits<double>::infinity();
      }
      for (std::size_t point = 0; point < 3; ++point) triangle.at(end, point, 2) = random.uniform();
    }
    expect_truth(Kind::plane_triangle, triangle, known);
    EXPECT_EQ(to_tetrahedron(Kind::plane_triangle, triangle), known.tetrahedron);
  }
}

// ---- Refusals -----------------------------------------------------------------------------------

TEST(Elements, HaveNoSeparationAndTheProofsOfTetrahedra) {
  for (const Kind kind : {Kind::tetrahedron, Kind::plane_triangle}) {
    EXPECT_THROW(static_cast<void>(decide(kind, Query{}, {.distance = 1.0})),
                 std::invalid_argument);
    EXPECT_EQ(prove(kind, Query{}, decide(kind, Query{})).kind, Kind::tetrahedron);
  }
}

/// What is to be finite is.
TEST(Elements, RefusesNumbersThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Query query{};
    query.at(1, 3, 2) = bad;
    EXPECT_THROW(static_cast<void>(decide(Kind::tetrahedron, query)), std::domain_error);
    query.at(1, 2, 1) = bad;
    EXPECT_THROW(static_cast<void>(decide(Kind::plane_triangle, query)), std::domain_error);
  }
}

}  // namespace
}  // namespace touchstone::exact::element_test
