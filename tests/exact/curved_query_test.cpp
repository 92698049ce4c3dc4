#include "touchstone/curved_query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/polynomials.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::curved_query_test {
namespace {

using tests::polynomial;
using tests::power;
using tests::Random;
using Point = std::array<double, 3>;

Kind kind_of(int round) { return round % 2 == 0 ? Kind::vertex_face : Kind::edge_edge; }

/// Divisible by all degrees and by 2^8: multiples of it have exact control points of any degree.
constexpr double unit = 840.0 * 256.0;

/// Small multiples of the unit: many contacts, at ends and sides, and common planes.
double small(Random& random, int most = 2) { return unit * random.between(-most, most); }

Query small_query(Random& random) {
  Query query{};
  for (double& x : query.coordinates) x = small(random);
  return query;
}

/// Distance 0 mostly, or one that small queries often have exactly.
Separation small_separation(Random& random) {
  if (random.between(0, 2) != 0) return {};
  return {.distance = unit * random.between(1, 2) / 2,
          .norm = random.coin() ? Norm::l2 : Norm::linf};
}

/// The polynomial q^n p(numerator / q) of degree n of p.
Polynomial composed(const Polynomial& p, const Polynomial& numerator, const Polynomial& q) {
  Polynomial sum;
  for (std::size_t i = 0; i <= p.degree(); ++i) {
    Polynomial term{p[i]};
    for (std::size_t k = 0; k < p.degree(); ++k) term = term * (k < i ? numerator : q);
    sum = sum + term;
  }
  return sum;
}

/// The curved query collides iff the straight one does, at a time that the rational function
/// numerator / denominator, increasing on [0,1], takes to that of the straight one.
void expect_reparametrized(const Decision& curved, const Decision& straight,
                           const Polynomial& numerator, const Polynomial& denominator) {
  ASSERT_EQ(curved.collides(), straight.collides());
  ASSERT_EQ(curved.contact.has_value(), straight.contact.has_value());
  if (!curved.collides()) return;
  EXPECT_TRUE(curved.toi->is_root_of(composed(straight.toi->polynomial(), numerator, denominator)));
  AlgebraicNumber toi = *curved.toi;
  toi.refine_to_level(60);
  const auto at = [&](const Rational& t) -> Rational {
    const auto value = [&](const Polynomial& p) {
      Rational sum = 0;
      for (std::size_t i = p.degree() + 1; i-- > 0;) sum = sum * t + p[i];
      return sum;
    };
    return value(numerator) / value(denominator);
  };
  const RationalInterval interval = toi.interval();
  EXPECT_LE(at(interval.lower), *straight.toi);
  EXPECT_GE(at(interval.upper), *straight.toi);
}

// ---- Straight lines as curves -------------------------------------------------------------------

/// The same lines, each as a curve of its own degree.
CurvedQuery elevated(Random& random, CurvedQuery lines, int greatest) {
  for (Trajectory& curve : lines) {
    const Point a = curve.control[0], b = curve.control[1];
    const int degree = random.between(1, greatest);
    curve.control.clear();
    for (int j = 0; j <= degree; ++j) {
      Point& point = curve.control.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = ((degree - j) * a[axis] + j * b[axis]) / degree;
      }
    }
    if (a == b && random.coin()) curve.control.resize(1);
  }
  return lines;
}

TEST(CurvedQuery, OtherTimesOnStraightLinesAreThoseOfTheSameContacts) {
  Random random(371);
  int collisions = 0;
  const Polynomial one = polynomial({1});
  for (int round = 0; round < 500; ++round) {
    const Kind kind = kind_of(round);
    const Query query = small_query(random);
    const Separation separation = small_separation(random);
    const Decision straight = decide(kind, query, separation);
    collisions += straight.collides() ? 1 : 0;
    const auto expect = [&](const CurvedQuery& curves, const Polynomial& numerator,
                            const Polynomial& denominator) {
      expect_reparametrized(decide(kind, curves, separation), straight, numerator, denominator);
    };
    const CurvedQuery lines = to_curved(query);
    expect(elevated(random, lines, separation.distance > 0 ? 4 : 8), polynomial({0, 1}), one);
    // a + (b − a) t^m
    const int m = random.between(2, 4);
    CurvedQuery late = lines;
    for (Trajectory& curve : late) {
      curve.control.insert(curve.control.begin(), static_cast<std::size_t>(m - 1),
                           Point(curve.control[0]));
    }
    expect(late, power(polynomial({0, 1}), m), one);
    // Weights 1 and w: the time is w t / (1 − t + w t).
    const int w = random.between(2, 7);
    CurvedQuery rational = lines;
    for (Trajectory& curve : rational) curve.weights = {0.5, 0.5 * w};
    expect(rational, polynomial({0, w}), polynomial({1, w - 1}));
  }
  EXPECT_GT(collisions, 100);
}

TEST(CurvedQuery, WeightsOfRestingPointsDoNotMatter) {
  Random random(373);
  for (int round = 0; round < 200; ++round) {
    const Kind kind = kind_of(round);
    Query query = small_query(random);
    const std::size_t bodies = kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t point = bodies; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        query.at(1, point, axis) = query.at(0, point, axis);
      }
    }
    CurvedQuery plain = to_curved(query), weighted = plain;
    for (std::size_t point = 0; point < bodies; ++point) {
      plain[point].weights = weighted[point].weights = {1.0, 3.0};
    }
    for (std::size_t point = bodies; point < moving_points; ++point) {
      weighted[point].weights = {2.0, static_cast<double>(point) + 4.0};
      if (random.coin()) {
        weighted[point].control.resize(1);
        weighted[point].weights = {7.0};
      }
    }
    const Separation separation = small_separation(random);
    const Decision expected = decide(kind, plain, separation);
    const Decision found = decide(kind, weighted, separation);
    ASSERT_EQ(found.collides(), expected.collides());
    EXPECT_TRUE(!found.collides() || *found.toi == *expected.toi);
  }
}

// ---- Certificates -------------------------------------------------------------------------------

/// Each point on a curve of its own degree, some of them rational.
CurvedQuery curved_query(Random& random, int greatest) {
  CurvedQuery query;
  for (Trajectory& curve : query) {
    const int degree = random.between(0, greatest);
    for (int j = 0; j <= degree; ++j) {
      curve.control.push_back({small(random), small(random), small(random)});
    }
    if (degree == 2 && random.coin()) curve.weights = {1.0, 1.0, 2.0};
  }
  return query;
}

/// Each query has a proof that the checker accepts; with the proof of another one it is accepted
/// only where the claim is true of it too.
TEST(CurvedQuery, HasAProofAndNoneOfWhatIsFalse) {
  Random random(378);
  std::array<int, 3> claims{};
  int rejected = 0, accepted = 0;
  for (int round = 0; round < 2000; ++round) {
    const Kind kind = kind_of(round);
    const CurvedQuery query = curved_query(random, round % 5 == 0 ? random.between(3, 4) : 2);
    const Separation separation = small_separation(random);
    const ProveOptions options{.collision_claim =
                                   random.coin() ? Claim::time_of_impact : Claim::collision};
    Certificate certificate = prove(kind, query, decide(kind, query, separation), options);
    ASSERT_EQ(tests::rejection(certificate), "") << certificate_stream(certificate);
    ++claims.at(static_cast<std::size_t>(certificate.claim));
    CurvedQuery other = query;
    const auto index = [&](std::size_t size) {
      return static_cast<std::size_t>(random.between(0, static_cast<int>(size) - 1));
    };
    Trajectory& curve = other.at(index(moving_points));
    curve.control.at(index(curve.control.size())).at(index(3)) += small(random, 1);
    if (!curve.weights.empty() && random.coin()) curve.weights[1] *= 2;
    certificate.query = other;
    if (!tests::rejection(certificate).empty()) {
      ++rejected;
      continue;
    }
    ++accepted;
    const Decision truth = decide(kind, other, separation);
    ASSERT_EQ(truth.collides(), certificate.claim != Claim::no_collision);
    if (certificate.claim != Claim::time_of_impact) continue;
    EXPECT_GE(*truth.toi, certificate.toi.lower);
    EXPECT_LE(*truth.toi, certificate.toi.upper);
  }
  for (const int count : claims) EXPECT_GT(count, 40);
  EXPECT_GT(accepted, 100);
  EXPECT_GT(rejected, 100);
}

// ---- Known truth --------------------------------------------------------------------------------

/// A vertex over a resting face in the plane z = 0, with these heights as control points.
CurvedQuery over_a_face(const std::vector<double>& heights) {
  CurvedQuery query;
  for (const double z : heights) query[0].control.push_back({1, 1, z});
  query[1].control = {{0, 0, 0}};
  query[2].control = {{4, 0, 0}};
  query[3].control = {{0, 4, 0}};
  return query;
}

/// Queries of an array are decided and proved as each by itself.
TEST(CurvedQuery, InAnArray) {
  Random random(377);
  for (const QueryShape& shape :
       {QueryShape{.degree = 1}, {.kind = Kind::edge_edge, .degree = 2}, {.is_rational = true}}) {
    std::vector<double> numbers(5 * shape.numbers_of_query());
    for (double& x : numbers) x = random.between(1, 9);
    const Queries queries(shape, numbers);
    const std::vector<Decision> decisions = decide(queries);
    const std::vector<Certificate> certificates = prove(queries, decisions);
    ASSERT_EQ(certificates.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      const CurvedQuery query = to_curved(queries, i);
      const Decision alone = decide(shape.kind, query);
      EXPECT_EQ(decisions[i].toi, alone.toi);
      const Certificate& proved = certificates[i];
      EXPECT_EQ(proved.query.index(), shape.is_straight() ? 0U : 1U);
      EXPECT_EQ(proved.subintervals.size(), prove(shape.kind, query, alone).subintervals.size());
    }
    EXPECT_THROW((void)prove(queries, std::span(decisions).first(4)), std::invalid_argument);
    numbers[3 * shape.numbers_of_query()] = std::nan("");
    EXPECT_TRUE(tests::message_of<std::domain_error>([&] {
                  (void)decide(queries);
                }).starts_with("query 3: "));
  }
}

TEST(CurvedQuery, AParabolaTouchesInItsVertex) {
  const auto parabola = [](double above) {  // (2t − 1)² + above
    return over_a_face({1 + above, -1 + above, 1 + above});
  };
  const Decision touching = decide(Kind::vertex_face, parabola(0));
  ASSERT_TRUE(touching.collides());
  EXPECT_EQ(*touching.toi, Rational(1, 2));
  const ContactParameters place = contact_parameters(touching, Rational(1, 1000));
  EXPECT_EQ(place.u.lower, Rational(1, 4));
  EXPECT_EQ(place.v.upper, Rational(1, 4));
  EXPECT_FALSE(decide(Kind::vertex_face, parabola(0x1p-50)).collides());
  const Decision below = decide(Kind::vertex_face, parabola(-0x1p-50));
  ASSERT_TRUE(below.collides());
  EXPECT_EQ(*below.toi, Rational(1, 2) - power_of_two(-26));
  for (const Norm norm : {Norm::l2, Norm::linf}) {
    const Decision near = decide(Kind::vertex_face, parabola(0.25), {0.25, norm});
    ASSERT_TRUE(near.collides());
    EXPECT_EQ(*near.toi, Rational(1, 2));
    EXPECT_FALSE(
        decide(Kind::vertex_face, parabola(0.25), {0x1.fffffffffffffp-3, norm}).collides());
  }
}

TEST(CurvedQuery, OfDoublesOfAnySizeIsDecided) {
  const double large = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  const Decision found = decide(Kind::vertex_face, over_a_face({large, -large, least}));
  ASSERT_TRUE(found.collides());
  EXPECT_LT(*found.toi, Rational(1));
  EXPECT_FALSE(decide(Kind::vertex_face, over_a_face({least, least, large})).collides());
}

TEST(CurvedQuery, ThatIsNotOneIsRefused) {
  const auto decide_with = [](const Trajectory& curve) {
    CurvedQuery query = over_a_face({1, 2, 3});
    query[0] = curve;
    static_cast<void>(decide(Kind::vertex_face, query));
  };
  const Point a{1, 1, 1};
  for (const Trajectory& curve :
       std::vector<Trajectory>{{{}}, {std::vector<Point>(10)}, {{a, a, a}, {1, 2}}}) {
    EXPECT_THROW(decide_with(curve), std::invalid_argument);
  }
  for (const double weight : {0.0, -1.0}) {
    EXPECT_THROW(decide_with({{a, a, a}, {1, weight, 1}}), std::domain_error);
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {infinity, -infinity, std::nan("")}) {
    EXPECT_THROW(decide_with({{a, {1, 1, x}, a}}), std::domain_error);
    EXPECT_THROW(decide_with({{a, a, a}, {1, x, 1}}), std::domain_error);
  }
  EXPECT_NO_THROW(decide_with({{a, a, a}, {1, 2, 1}}));
  EXPECT_THROW(
      static_cast<void>(decide(Kind::vertex_face, over_a_face({1, 2, 3}), {-1.0, Norm::l2})),
      std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::exact::curved_query_test
