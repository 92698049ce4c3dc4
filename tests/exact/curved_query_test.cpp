#include "touchstone/curved_query.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "tests/support/certificates.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::curved_query_test {
namespace {

using tests::Random;
using Point = std::array<double, 3>;

ContactKind kind_of(int round) {
  return round % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
}

/// Small numbers: many contacts, at ends and sides, and common planes.
double small(Random& random, int most = 2) { return random.between(-most, most); }

/// Distance 0 mostly, or one that small queries often have exactly.
Separation small_separation(Random& random) {
  if (random.between(0, 2) != 0) return {};
  return {.distance = 0.5 * random.between(1, 2), .norm = random.coin() ? Norm::l2 : Norm::linf};
}

// ---- Certificates -------------------------------------------------------------------------------

/// Each point on a curve of its own degree, some of them rational, with weights of their own.
CurvedQuery curved_query(Random& random, int greatest) {
  CurvedQuery query;
  for (Trajectory& curve : query) {
    const int degree = random.between(0, greatest);
    const bool is_rational = greatest <= 2 && random.between(0, 3) == 0;
    for (int j = 0; j <= degree; ++j) {
      curve.control.push_back({small(random), small(random), small(random)});
      if (is_rational) curve.weights.push_back(random.between(1, 3));
    }
  }
  return query;
}

/// Each query has a proof that the checker accepts; with the proof of another one it is accepted
/// only where the claim is true of it too.
TEST(CurvedQuery, HasAProofAndNoneOfWhatIsFalse) {
  Random random(378);
  std::array<int, 3> claims{};
  int rejected = 0, accepted = 0;
  for (int round = 0; round < 1500; ++round) {
    const ContactKind kind = kind_of(round);
    const bool is_high = round % 100 == 0;
    const CurvedQuery query = curved_query(random, is_high          ? 8
                                                   : round % 5 == 0 ? random.between(3, 4)
                                                                    : 2);
    const Separation separation = is_high ? Separation{} : small_separation(random);
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
    if (!curve.weights.empty() && random.coin()) curve.weights.back() *= 2;
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
  for (const QueryShape& shape : {QueryShape{.degree = 1},
                                  {.kind = ContactKind::edge_edge, .degree = 2},
                                  {.is_rational = true}}) {
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
  const Decision touching = decide(ContactKind::vertex_face, parabola(0));
  ASSERT_TRUE(touching.collides());
  EXPECT_EQ(*touching.toi, Rational(1, 2));
  const ContactParameters place = contact_parameters(touching, Rational(1, 1000));
  EXPECT_EQ(place.u.lower, Rational(1, 4));
  EXPECT_EQ(place.v.upper, Rational(1, 4));
  EXPECT_FALSE(decide(ContactKind::vertex_face, parabola(0x1p-50)).collides());
  const Decision below = decide(ContactKind::vertex_face, parabola(-0x1p-50));
  ASSERT_TRUE(below.collides());
  EXPECT_EQ(*below.toi, Rational(1, 2) - power_of_two(-26));
  for (const Norm norm : {Norm::l2, Norm::linf}) {
    const Decision near = decide(ContactKind::vertex_face, parabola(0.25), {0.25, norm});
    ASSERT_TRUE(near.collides());
    EXPECT_EQ(*near.toi, Rational(1, 2));
    EXPECT_FALSE(
        decide(ContactKind::vertex_face, parabola(0.25), {0x1.fffffffffffffp-3, norm}).collides());
  }
}

TEST(CurvedQuery, OfDoublesOfAnySizeIsDecided) {
  const double large = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  const Decision found = decide(ContactKind::vertex_face, over_a_face({large, -large, least}));
  ASSERT_TRUE(found.collides());
  EXPECT_LT(*found.toi, Rational(1));
  EXPECT_FALSE(decide(ContactKind::vertex_face, over_a_face({least, least, large})).collides());
}

// The height is (1 − t)² − 2t² over its weights: the time of impact has no factor of the points'.
TEST(CurvedQuery, TimesDoNotDependOnWeightsOfPoints) {
  CurvedQuery query = over_a_face({1, 0, -2});
  double weight = 0x1p-900;
  for (Trajectory& curve : query) {
    curve.control.resize(3, curve.control.back());
    curve.weights = {1, weight, 1};
    weight *= 0x1p600;
  }
  const Decision found = decide(ContactKind::vertex_face, query);
  ASSERT_TRUE(found.collides());
  EXPECT_EQ(found.toi->polynomial(), Polynomial(std::vector<Integer>{-1, 2, 1}));
}

TEST(CurvedQuery, ThatIsNotOneIsRefused) {
  const auto decide_with = [](const Trajectory& curve) {
    CurvedQuery query = over_a_face({1, 2, 3});
    query[0] = curve;
    static_cast<void>(decide(ContactKind::vertex_face, query));
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
      static_cast<void>(decide(ContactKind::vertex_face, over_a_face({1, 2, 3}), {-1.0, Norm::l2})),
      std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::exact::curved_query_test
