/// \file
/// The oracle on elements: those whose volume is a known product of linear factors, at all
/// scales and places; and any elements beside Sturm's theorem, on the volume as a polynomial
/// through its values at some times, each from the positions of the points.

#include "touchstone/element.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/inverting_elements.hpp"
#include "tests/support/queries.hpp"
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

// ---- Sturm's theorem ----------------------------------------------------------------------------

/// Σ c_i s^i, without leading zeros; empty for zero.
using Coefficients = std::vector<Rational>;

void strip(Coefficients& p) {
  while (!p.empty() && sgn(p.back()) == 0) p.pop_back();
}

Coefficients remainder(Coefficients p, const Coefficients& q) {
  while (p.size() >= q.size()) {
    const Rational factor = p.back() / q.back();
    const std::size_t shift = p.size() - q.size();
    for (std::size_t i = 0; i < q.size(); ++i) p[shift + i] -= factor * q[i];
    p.pop_back();
    strip(p);
  }
  return p;
}

/// p, p' and the negated remainders.
std::vector<Coefficients> sturm_sequence(const Coefficients& p) {
  std::vector<Coefficients> sequence{p, {}};
  for (std::size_t i = 1; i < p.size(); ++i) sequence[1].push_back(p[i] * static_cast<long>(i));
  while (!sequence.back().empty()) {
    Coefficients next = remainder(sequence[sequence.size() - 2], sequence.back());
    for (Rational& c : next) c = -c;
    sequence.push_back(std::move(next));
  }
  sequence.pop_back();
  return sequence;
}

Rational value(const Coefficients& p, const Rational& x) {
  Rational sum = 0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * x + p[i];
  return sum;
}

/// The number of distinct roots in the open interval. \pre p is not 0 at the lower end.
int roots_between(const std::vector<Coefficients>& sequence, const Rational& lower,
                  const Rational& upper) {
  // Also for multiple roots, but not at them: there the upper end is moved below all others.
  const auto changes = [&](const Rational& x) {
    int count = 0, last = 0;
    for (const Coefficients& p : sequence) {
      const int sign = sgn(value(p, x));
      count += sign * last < 0 ? 1 : 0;
      last = sign != 0 ? sign : last;
    }
    return count;
  };
  Rational inside = upper;
  if (sgn(value(sequence[0], upper)) == 0) {
    // Cauchy's bound: the other roots of p(upper − y) are farther from 0 than this.
    Coefficients shifted{Rational(0)};
    for (std::size_t i = sequence[0].size(); i-- > 0;) {
      Coefficients next(shifted.size() + 1);
      for (std::size_t k = 0; k < shifted.size(); ++k) {
        next[k] += shifted[k] * upper;
        next[k + 1] -= shifted[k];
      }
      next[0] += sequence[0][i];
      shifted = std::move(next);
    }
    const auto first = std::ranges::find_if(shifted, [](const auto& c) { return sgn(c) != 0; });
    Rational greatest = abs(*first);
    for (auto c = first; c != shifted.end(); ++c) greatest = std::max(greatest, Rational(abs(*c)));
    inside = upper - abs(*first) / (4 * greatest);
    if (inside <= lower) return 0;
  }
  return changes(lower) - changes(inside);
}

/// The position of a point times its weight, and the weight.
std::array<Rational, 4> homogeneous(const Trajectory& curve, const Rational& t) {
  std::vector<std::array<Rational, 4>> row;
  for (std::size_t j = 0; j < curve.control.size(); ++j) {
    const Rational weight(curve.weights.empty() ? 1.0 : curve.weights[j]);
    row.push_back({weight, weight, weight, weight});
    for (std::size_t axis = 0; axis < 3; ++axis)
      row[j].at(axis) *= Rational(curve.control[j][axis]);
  }
  for (std::size_t left = row.size() - 1; left > 0; --left) {
    for (std::size_t j = 0; j < left; ++j) {
      for (std::size_t i = 0; i < 4; ++i) {
        row[j].at(i) = (1 - t) * row[j].at(i) + t * row[j + 1].at(i);
      }
    }
  }
  return row[0];
}

/// Six times the volume, times all weights: det(b − a, c − a, d − a) from the positions.
Rational weighted_volume(const CurvedQuery& tetrahedron, const Rational& t) {
  std::array<std::array<Rational, 3>, 3> edge;
  Rational weights = 1;
  const auto a = homogeneous(tetrahedron[0], t);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto x = homogeneous(tetrahedron.at(i + 1), t);
    for (std::size_t k = 0; k < 3; ++k) edge.at(i).at(k) = x.at(k) / x[3] - a.at(k) / a[3];
    weights *= x[3];
  }
  Rational sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t y = (k + 1) % 3, z = (k + 2) % 3;
    sum += edge[0].at(k) * (edge[1].at(y) * edge[2].at(z) - edge[1].at(z) * edge[2].at(y));
  }
  return sum * weights * a[3];
}

/// The polynomial in s through the values at s = 0, …, n, by Newton's forward differences.
Coefficients interpolated(std::vector<Rational> values) {
  Coefficients sum, product{Rational(1)};  // s (s−1) … (s−k+1) / k!
  const std::size_t count = values.size();
  for (std::size_t k = 0; k < count; ++k) {
    sum.resize(product.size());
    for (std::size_t i = 0; i < product.size(); ++i) sum[i] += values[0] * product[i];
    for (std::size_t i = 0; i + 1 < values.size(); ++i) values[i] = values[i + 1] - values[i];
    values.pop_back();
    Coefficients next(product.size() + 1);
    const Rational divisor(static_cast<long>(k + 1));
    for (std::size_t i = 0; i < product.size(); ++i) {
      next[i + 1] += product[i] / divisor;
      next[i] -= product[i] * Rational(static_cast<long>(k)) / divisor;
    }
    product = std::move(next);
  }
  strip(sum);
  return sum;
}

/// Compares a decision with the volume's roots by Sturm's theorem.
void expect_sturm_agrees(const CurvedQuery& tetrahedron, const Decision& decision) {
  std::size_t degree = 0;
  for (const Trajectory& curve : tetrahedron) degree += curve.degree();
  const Rational scale(static_cast<long>(std::max<std::size_t>(degree, 1)));
  std::vector<Rational> values;
  for (std::size_t i = 0; i <= degree; ++i) {
    values.push_back(weighted_volume(tetrahedron, Rational(static_cast<long>(i)) / scale));
  }
  const bool inverts_at_once = sgn(values.front()) <= 0;
  EXPECT_EQ(decision.collides() && *decision.toi == Rational(0), inverts_at_once);
  if (inverts_at_once) return;
  const Coefficients volume = interpolated(std::move(values));
  const auto sequence = sturm_sequence(volume);
  if (!decision.collides()) {
    EXPECT_EQ(roots_between(sequence, 0, scale), 0);
    EXPECT_GT(sgn(value(volume, scale)), 0);
    return;
  }
  // The interval isolates it from roots of its own polynomial; those of V may have to be parted.
  AlgebraicNumber time = *decision.toi;
  for (unsigned long level = 1; level < 256; level *= 2) {
    const auto [lower, upper] = time.interval();
    if (lower == upper || roots_between(sequence, lower * scale, upper * scale) == 1) break;
    time.refine_to_level(level);
  }
  const auto [lower, upper] = time.interval();
  EXPECT_EQ(roots_between(sequence, 0, lower * scale), 0);
  if (lower == upper) {
    EXPECT_EQ(sgn(value(volume, lower * scale)), 0);
  } else {
    EXPECT_NE(sgn(value(volume, lower * scale)), 0);
    EXPECT_EQ(roots_between(sequence, lower * scale, upper * scale), 1);
  }
}

TEST(Elements, AgreesWithSturmOnLines) {
  Random random(3);
  int roots = 0;
  for (int round = 0; round < trials(3000); ++round) {
    const auto family = tests::all_families.at(static_cast<std::size_t>(round) % 4);
    const Query query = tests::random_query(random, Kind::vertex_face, family).query;
    const Decision decision = decide(Kind::tetrahedron, query);
    const tests::PosedQuery posed{Kind::vertex_face, query};
    SCOPED_TRACE(testing::Message() << posed);
    expect_sturm_agrees(to_curved(query), decision);
    roots += decision.collides() && *decision.toi > Rational(0) ? 1 : 0;
  }
  EXPECT_GT(roots, trials(500));
}

TEST(Elements, AgreesWithSturmOnCurves) {
  Random random(4);
  int roots = 0;
  for (int round = 0; round < trials(300); ++round) {
    CurvedQuery curves;
    for (Trajectory& curve : curves) {
      const int degree = random.between(0, 3);
      for (int j = 0; j <= degree; ++j) {
        curve.control.push_back({static_cast<double>(random.between(-3, 3)),
                                 static_cast<double>(random.between(-3, 3)),
                                 static_cast<double>(random.between(-3, 3))});
        if (round % 2 == 0) curve.weights.push_back(random.between(1, 3));
      }
    }
    const Decision decision = decide(Kind::tetrahedron, curves);
    const tests::PosedCurves posed{Kind::vertex_face, curves};
    SCOPED_TRACE(testing::Message() << posed);
    expect_sturm_agrees(curves, decision);
    roots += decision.collides() && *decision.toi > Rational(0) ? 1 : 0;
  }
  EXPECT_GT(roots, trials(50));
}

// ---- Changes that keep the answer ---------------------------------------------------------------

/// An even permutation of the points keeps the volume, an odd one and a reflection negate it.
TEST(Elements, ChangesItsSignWithTheOrientation) {
  Random random(5);
  const auto permuted = [](const Query& query, const std::array<std::size_t, 4>& order) {
    Query result{};
    for (const std::size_t end : {0U, 1U}) {
      for (std::size_t i = 0; i < 12; ++i) {
        result.at(end, i / 3, i % 3) = query.at(end, order.at(i / 3), i % 3);
      }
    }
    return result;
  };
  for (int round = 0; round < trials(2000); ++round) {
    const auto family = tests::all_families.at(static_cast<std::size_t>(round) % 4);
    const Query query = tests::random_query(random, Kind::vertex_face, family).query;
    const auto toi_of = [](const Query& element) { return decide(Kind::tetrahedron, element).toi; };
    const auto toi = toi_of(query);
    for (const auto& order : {std::array<std::size_t, 4>{1, 2, 0, 3}, {3, 2, 1, 0}, {2, 0, 1, 3}}) {
      EXPECT_EQ(toi_of(permuted(query, order)), toi);
    }
    Query reflected = query;
    for (const std::size_t end : {0U, 1U}) {
      for (std::size_t i = 0; i < 4; ++i) reflected.at(end, i, 1) = -query.at(end, i, 1);
    }
    const auto negated = toi_of(permuted(query, {1, 0, 2, 3}));
    EXPECT_TRUE(toi == AlgebraicNumber(0) || negated == AlgebraicNumber(0));
    EXPECT_EQ(toi_of(reflected), negated);
  }
}

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
