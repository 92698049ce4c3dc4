#include "touchstone/certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "exact/distance/distance_oracle.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::exact::certificate_test {
namespace {

using tests::edge_edge;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::rejection;
using tests::vertex_face;

Rational time_of(const Certificate& certificate) {
  return std::get<Rational>(certificate.contact.value().time);
}

TriangleContact triangle_of(const Certificate& certificate) {
  return std::get<TriangleContact>(certificate.contact.value().place);
}

SegmentContact segment_of(const Certificate& certificate) {
  return std::get<SegmentContact>(certificate.contact.value().place);
}

// ---- By hand ------------------------------------------------------------------------------------

TEST(Prove, ACertificateOfNoCollisionHasSubintervalsAlone) {
  const Certificate certificate = tests::prove(over_triangle(1, 1, 3, 1));
  EXPECT_EQ(certificate.claim, Claim::no_collision);
  EXPECT_FALSE(certificate.contact);
  EXPECT_EQ(certificate.subintervals,
            (std::vector<Subinterval>{{0, 1, {.sort = Feature::Sort::positive_face}}}));
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, AToiThatIsADoubleEndsItsInterval) {
  for (const PosedQuery& posed : {over_triangle(1, 2, 3, -1), over_edge(1, 2, 3, -1)}) {
    const Certificate certificate = tests::prove(posed);
    EXPECT_EQ(certificate.claim, Claim::time_of_impact);
    EXPECT_EQ(certificate.toi.lower, Rational(std::nextafter(0.75, 0.0)));
    EXPECT_EQ(certificate.toi.upper, Rational(3, 4));
    ASSERT_EQ(certificate.subintervals.size(), 1U);
    EXPECT_EQ(certificate.subintervals.front().to, certificate.toi.lower);
    EXPECT_EQ(time_of(certificate), Rational(3, 4));
    EXPECT_EQ(triangle_of(certificate).axis, 2U);
    EXPECT_EQ(rejection(certificate), "");
  }
}

TEST(Prove, PowersOfTwoHaveANearPredecessor) {
  for (const double toi : {1.0, 0.5, 0.125}) {
    const Certificate certificate = tests::prove(over_triangle(1, 1, toi, toi - 1));
    EXPECT_EQ(certificate.toi.upper, Rational(toi));
    EXPECT_EQ(certificate.toi.lower, Rational(std::nextafter(toi, 0.0)));
    EXPECT_EQ(rejection(certificate), "");
  }
}

TEST(Prove, ARationalToiIsNamed) {
  const Certificate certificate = tests::prove(over_triangle(1, 1, 1, -2));
  EXPECT_EQ(time_of(certificate), Rational(1, 3));
  EXPECT_LT(certificate.toi.lower, Rational(1, 3));
  EXPECT_GT(certificate.toi.upper, Rational(1, 3));
  EXPECT_EQ(Rational(std::nextafter(certificate.toi.lower.get_d(), 1.0)), certificate.toi.upper);
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, ARationalRootOfAnIrreducibleLookingPolynomialIsNamedToo) {
  // t x = y with x = 4 − 3 t and y = 1: 3 t² − 4 t + 1 = 0 at 1/3 and 1.
  const PosedQuery posed = tests::turning_triangle(8, 4, 1, 1);
  const Certificate certificate = tests::prove(posed);
  EXPECT_EQ(time_of(certificate), Rational(1, 3));
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, AnIrrationalToiIsARootInTheClaimedInterval) {
  // t x = y with x = t, y = 1/2: 2 t² = 1.
  const Certificate certificate = tests::prove(tests::turning_triangle(4, 0, 1, 0.5));
  const auto& root = std::get<RootTime>(certificate.contact.value().time);
  EXPECT_EQ(root.polynomial, Polynomial(Integer(-1), Integer(0), Integer(2)));
  EXPECT_EQ(root.interval.lower, certificate.toi.lower);
  EXPECT_EQ(root.interval.upper, certificate.toi.upper);
  const double sqrt_half = std::sqrt(0.5);
  EXPECT_LE(std::abs(certificate.toi.lower.get_d() - sqrt_half), 0x1p-53);
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, WhatVanishesWithTheDeterminantIsDividedByTheSamePolynomial) {
  // The same at height 0: on the triangle's side, so that a weight is also 0 at the toi.
  PosedQuery posed = tests::turning_triangle(4, 0, 1, 0.5);
  posed.query.at(0, 0, 2) = posed.query.at(1, 0, 2) = 0.0;
  const Certificate certificate = tests::prove(posed);
  const auto& root = std::get<RootTime>(certificate.contact.value().time);
  EXPECT_EQ(root.polynomial, Polynomial(Integer(-1), Integer(0), Integer(2)));
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, ContactAtTheStartNeedsNoSubintervals) {
  const Certificate certificate = tests::prove(over_triangle(1, 1, 0, 1));
  EXPECT_EQ(certificate.claim, Claim::time_of_impact);
  EXPECT_EQ(certificate.toi.lower, 0);
  EXPECT_EQ(certificate.toi.upper, 0);
  EXPECT_TRUE(certificate.subintervals.empty());
  EXPECT_EQ(time_of(certificate), 0);
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, BetweenZeroAndTheLeastDoubleAPointIsAPiece) {
  // The toi 2^-1024/(2^-1024 + 2^1000) is far below the least double.
  const Certificate certificate = tests::prove(over_triangle(1, 1, 0x1p-1024, -0x1p1000));
  EXPECT_EQ(certificate.toi.lower, 0);
  EXPECT_EQ(certificate.toi.upper, power_of_two(-1074));
  ASSERT_EQ(certificate.subintervals.size(), 1U);
  EXPECT_EQ(certificate.subintervals.front().from, 0);
  EXPECT_EQ(certificate.subintervals.front().to, 0);
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, DegenerateContactsAreSegments) {
  // All points are one.
  const Certificate point = tests::prove({Kind::vertex_face, Query{}});
  EXPECT_EQ(segment_of(point), (SegmentContact{{0, 1}}));
  EXPECT_EQ(rejection(point), "");
  // A vertex falls on a triangle that is a segment.
  const std::array<double, 9> needle{0, 0, 0, 4, 0, 0, 2, 0, 0};
  const Certificate segment = tests::prove(
      vertex_face(tests::with_vertex(3, 0, 1, needle), tests::with_vertex(3, 0, -3, needle)));
  EXPECT_EQ(time_of(segment), Rational(1, 4));
  EXPECT_EQ(segment_of(segment), (SegmentContact{{0, 1}}));
  EXPECT_EQ(rejection(segment), "");
  // Collinear edges slide into each other.
  const Certificate edges = tests::prove(
      edge_edge({0, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 0}, {2, 0, 0, 3, 0, 0, 1, 0, 0, 2, 0, 0}));
  EXPECT_EQ(time_of(edges), Rational(1, 2));
  EXPECT_EQ(rejection(edges), "");
}

TEST(Prove, MotionInACommonPlane) {
  // A vertex enters the triangle's side x = 0 from the left; the determinant is always 0.
  const std::array<double, 9> face{0, 0, 0, 4, 0, 0, 0, 4, 0};
  const Certificate certificate = tests::prove(
      vertex_face(tests::with_vertex(-1, 1, 0, face), tests::with_vertex(2, 1, 0, face)));
  EXPECT_EQ(time_of(certificate), Rational(1, 3));
  EXPECT_EQ(certificate.subintervals.size(), 1U);
  EXPECT_EQ(rejection(certificate), "");
}

TEST(Prove, TheOtherHalfOfAParallelogramIsATriangleToo) {
  std::set<std::array<std::size_t, 3>> triangles;
  for (const double x : {1.0, 3.0}) {
    const Certificate certificate = tests::prove(over_edge(x, 4 - x, 1, -2));
    triangles.insert(triangle_of(certificate).corners);
    EXPECT_EQ(rejection(certificate), "");
    const Certificate other = tests::prove(over_edge(x, x, 1, -2));
    triangles.insert(triangle_of(other).corners);
    EXPECT_EQ(rejection(other), "");
  }
  for (const double x : {1.0, 3.0}) {
    for (const double y : {1.0, 3.0}) {
      const Certificate certificate = tests::prove(over_edge(x, y, 1, -2));
      triangles.insert(triangle_of(certificate).corners);
    }
  }
  EXPECT_EQ(triangles, (std::set<std::array<std::size_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

// ---- At a distance ------------------------------------------------------------------------------

TEST(Prove, AtADistanceItSaysSoAndProvesIt) {
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    const Certificate colliding = tests::prove(over_triangle(1, 1, 3, -1), Separation{1, norm});
    EXPECT_EQ(colliding.separation, (Separation{1, norm}));
    EXPECT_EQ(colliding.claim, Claim::time_of_impact);
    EXPECT_EQ(time_of(colliding), Rational(1, 2));
    EXPECT_EQ(rejection(colliding), "");
    const Certificate apart = tests::prove(over_triangle(1, 1, 3, 1.5), Separation{1, norm});
    EXPECT_EQ(apart.claim, Claim::no_collision);
    EXPECT_EQ(rejection(apart), "");
    const Certificate at_once = tests::prove(over_edge(1, 2, 1, -1), Separation{1, norm});
    EXPECT_EQ(at_once.toi.upper, 0);
    EXPECT_TRUE(at_once.subintervals.empty());
    EXPECT_EQ(rejection(at_once), "");
  }
}

TEST(Prove, EveryPlaceOfAContactAtADistance) {
  const auto place = [](const PosedQuery& posed, const Separation& separation) {
    const Certificate certificate = tests::prove(posed, separation);
    EXPECT_EQ(rejection(certificate), "");
    return certificate.contact.value().place;
  };
  EXPECT_EQ(place(over_triangle(-3, -4, 16, 8), {13, Norm::l2}), ContactPlace(VertexContact{0}));
  EXPECT_EQ(place(over_triangle(2, -3, 8, 0), {5, Norm::l2}), ContactPlace(EdgeContact{{0, 1}}));
  EXPECT_EQ(place(over_triangle(1, 1, 3, -1), {1, Norm::l2}), ContactPlace(FaceContact{}));
  EXPECT_EQ(place(over_triangle(1, 1, 3, -1), {1, Norm::linf}), ContactPlace(AxesContact{}));
}

TEST(Prove, WithoutADistanceTheTextIsAsWithoutASeparation) {
  for (const PosedQuery& posed : {over_triangle(1, 1, 3, -1), over_triangle(1, 1, 3, 1),
                                  tests::turning_triangle(4, 0, 1, 0.5), over_edge(7, 1, 3, -1)}) {
    const std::string plain = certificate_stream(tests::prove(posed));
    for (const Separation& zero : {Separation{0.0, Norm::l2}, Separation{-0.0, Norm::linf}}) {
      EXPECT_EQ(certificate_stream(tests::prove(posed, zero)), plain);
    }
  }
}

TEST(Prove, AtADistanceCannotProveAWrongVerdict) {
  const PosedQuery colliding = over_triangle(1, 1, 3, -1), apart = over_triangle(1, 1, 3, 1.5);
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    const Separation one{1, norm};
    const auto of_collision = decide(colliding.kind, colliding.query, one),
               of_no_collision = decide(apart.kind, apart.query, one);
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, of_no_collision)),
                 std::logic_error);
    EXPECT_THROW(static_cast<void>(prove(apart.kind, apart.query, of_collision)), std::logic_error);
    const Decision late{.separation = one, .toi = AlgebraicNumber(Rational(3, 4))};
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, late)), std::logic_error);
    Decision bad = of_collision;
    bad.separation.distance = -1;
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, bad)),
                 std::invalid_argument);
  }
}

// ---- Options ------------------------------------------------------------------------------------

TEST(Prove, ClaimsACollisionAloneIfAsked) {
  for (const PosedQuery& posed :
       {over_triangle(1, 1, 1, -2), tests::turning_triangle(4, 0, 1, 0.5)}) {
    const Certificate certificate = tests::prove(posed, {.collision_claim = Claim::collision});
    EXPECT_EQ(certificate.claim, Claim::collision);
    EXPECT_TRUE(certificate.subintervals.empty());
    EXPECT_TRUE(certificate.contact);
    EXPECT_EQ(rejection(certificate), "");
  }
}

TEST(Prove, KeepsToTheWidthAskedFor) {
  for (const PosedQuery& posed : {over_triangle(1, 1, 1, -2), over_triangle(1, 1, 1, -1),
                                  tests::turning_triangle(4, 0, 1, 0.5)}) {
    for (const Rational& width : {Rational(2), Rational(1, 1000), power_of_two(-500)}) {
      const Certificate certificate = tests::prove(posed, {.width = width});
      EXPECT_LE(certificate.toi.upper - certificate.toi.lower, width);
      const AlgebraicNumber toi = *decide(posed.kind, posed.query).toi;
      EXPECT_TRUE(toi > certificate.toi.lower && toi <= certificate.toi.upper);
      EXPECT_EQ(rejection(certificate), "");
    }
  }
}

TEST(Prove, RefusesWhatMakesNoSense) {
  const PosedQuery posed = over_triangle(1, 1, 1, -2);
  EXPECT_THROW(static_cast<void>(tests::prove(posed, {.width = 0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(tests::prove(posed, {.collision_claim = Claim::no_collision})),
               std::invalid_argument);
  Query bad = posed.query;
  bad.coordinates[5] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(prove(posed.kind, bad, Decision{})), std::domain_error);
}

TEST(Prove, CannotProveAWrongVerdict) {
  const PosedQuery colliding = over_triangle(1, 1, 1, -2), apart = over_triangle(1, 1, 3, 1);
  const Decision of_collision = decide(colliding.kind, colliding.query),
                 of_no_collision = decide(apart.kind, apart.query);
  EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, of_no_collision)),
               std::logic_error);
  EXPECT_THROW(static_cast<void>(prove(apart.kind, apart.query, of_collision)), std::logic_error);
  // A contact that is not the first.
  const PosedQuery through_twice = tests::turning_triangle(8, 4, 1, 1);
  Decision late = decide(through_twice.kind, through_twice.query);
  *late.toi = AlgebraicNumber(1);
  EXPECT_THROW(static_cast<void>(prove(through_twice.kind, through_twice.query, late)),
               std::logic_error);
}

// ---- Magnitudes and near misses -----------------------------------------------------------------

TEST(Prove, ScalesDoNotMatter) {
  for (const int exponent : {1000, -1000, -1060}) {
    for (PosedQuery posed : {over_triangle(1, 1, 1, -2), over_triangle(1, 1, 3, 1),
                             tests::turning_triangle(4, 0, 1, 0.5), over_edge(1, 1, 1, -2)}) {
      const Certificate unscaled = tests::prove(posed);
      for (double& x : posed.query.coordinates) x = std::ldexp(x, exponent);
      const Certificate scaled = tests::prove(posed);
      EXPECT_EQ(scaled.subintervals, unscaled.subintervals);
      EXPECT_EQ(scaled.toi.upper, unscaled.toi.upper);
      EXPECT_EQ(rejection(scaled), "");
    }
  }
}

TEST(Prove, AnyFiniteDoublesHaveACertificate) {
  tests::Random random(3);
  const int count = tests::is_soak() ? 3000 : tests::trials(60);
  for (int repetition = 0; repetition < count; ++repetition) {
    PosedQuery posed{random.coin() ? Kind::vertex_face : Kind::edge_edge, {}};
    for (double& x : posed.query.coordinates) x = random.finite_double();
    EXPECT_EQ(rejection(tests::prove(posed)), "") << posed;
  }
}

TEST(Prove, NearMissesHaveACertificate) {
  // A vertex passes a triangle that is a point, a segment or a face, at this distance.
  for (const double gap : {0x1p-50, 0x1p-200, 0x1p-500, 0x1p-1000}) {
    for (const std::array<double, 9>& face :
         {std::array<double, 9>{}, std::array<double, 9>{-3, 0, 0, 5, 0, 0, 1, 0, 0},
          std::array<double, 9>{0, 0, 0, 4, 0, 0, 0, -4, 0}}) {
      const PosedQuery posed =
          vertex_face(tests::with_vertex(-1, gap, -1, face), tests::with_vertex(2, gap, 2, face));
      const Certificate certificate = tests::prove(posed);
      EXPECT_EQ(certificate.claim, Claim::no_collision);
      EXPECT_EQ(rejection(certificate), "") << gap;
      EXPECT_LE(certificate.subintervals.size(), 5U);
    }
  }
}

// ---- Round trips --------------------------------------------------------------------------------

/// Certificates of many queries on their way to the checker, all in one stream.
class RoundTrip {
 public:
  void add(const PosedQuery& posed, const Separation& separation = {}) {
    const Decision verdict = decide(posed.kind, posed.query, separation);
    const Certificate certificate = prove(posed.kind, posed.query, verdict);
    ASSERT_EQ(certificate.claim == Claim::time_of_impact, verdict.collides());
    if (verdict.collides()) {
      ++collisions_;
      const AlgebraicNumber& toi = *verdict.toi;
      const auto& [lower, upper] = certificate.toi;
      ASSERT_TRUE((toi > lower && toi <= upper) || (toi == Rational(0) && upper == 0)) << posed;
      ASSERT_LE(round_up(lower), upper.get_d());
    } else {
      ++misses_;
      ASSERT_EQ(certificate.claim, Claim::no_collision);
    }
    write(text_, certificate);
  }

  void expect_accepted(const std::string& name) const {
    const checker::Report report = tests::check(text_ + certificates_closing_line(queries()));
    EXPECT_EQ(report.time_of_impact, collisions_) << name;
    EXPECT_EQ(report.no_collision, misses_) << name;
    EXPECT_EQ(report.collision, 0U);
    for (const auto& rejected : report.rejections) ADD_FAILURE() << name << ": " << rejected.reason;
    EXPECT_TRUE(report.all_accepted());
  }

  [[nodiscard]] std::uint64_t queries() const { return collisions_ + misses_; }

 private:
  std::string text_{certificates_header()};
  std::uint64_t collisions_ = 0;
  std::uint64_t misses_ = 0;
};

TEST(RoundTrip, AllFamiliesAreAccepted) {
  const std::uint64_t count = tests::is_soak() ? 1000U : tests::trials(20U);
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      RoundTrip trip;
      for (std::uint64_t i = 0; i < count; ++i) {
        trip.add({kind, verify::generate::make_query(family, kind, 7, i).query});
      }
      trip.expect_accepted(std::string(family.name));
    }
  }
}

TEST(RoundTrip, RandomQueriesAreAccepted) {
  tests::Random random(6);
  RoundTrip trip;
  const std::size_t count = tests::is_soak() ? 100000U : tests::trials(1000U);
  for (std::size_t i = 0; i < count; ++i) {
    const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
    trip.add(
        tests::random_query(random, kind, tests::all_families.at(i % tests::all_families.size())));
  }
  trip.expect_accepted("random");
}

TEST(RoundTrip, AllFamiliesAtADistanceAreAccepted) {
  const std::uint64_t count = tests::is_soak() ? 100 : 1;
  for (const verify::generate::Family& family : verify::generate::families()) {
    // Distances that differ from the coordinates as much as these differ among themselves make the
    // numbers too long.
    if (family.name == "extreme-range") continue;
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      RoundTrip trip;
      for (std::uint64_t i = 0; i < count; ++i) {
        const PosedQuery posed{kind, verify::generate::make_query(family, kind, 8, i).query};
        for (const Norm norm : {Norm::linf, Norm::l2}) {
          for (const double distance : {0.125, 1e-30}) trip.add(posed, {distance, norm});
          // The two oracles agree at distance 0.
          const Decision other = decide_distance(scale_uniformly(kind, posed.query, {0.0, norm}));
          const Decision verdict = decide(kind, posed.query);
          ASSERT_EQ(other.collides(), verdict.collides()) << family.name << posed;
          if (verdict.collides()) {
            ASSERT_TRUE(*other.toi == *verdict.toi) << family.name << posed;
          }
        }
      }
      trip.expect_accepted(std::string(family.name));
    }
  }
}

TEST(RoundTrip, RandomQueriesAtADistanceAreAccepted) {
  tests::Random random(9);
  RoundTrip trip;
  const std::size_t count = tests::is_soak() ? 30000 : 200;
  for (std::size_t i = 0; i < count; ++i) {
    const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
    const PosedQuery posed =
        tests::random_query(random, kind, tests::all_families.at(i % tests::all_families.size()));
    const double distance = std::ldexp(random.between(1, 7), random.between(-100, -1));
    trip.add(posed, {random.coin() ? distance : random.between(1, 7) / 4.0,
                     random.coin() ? Norm::linf : Norm::l2});
  }
  trip.expect_accepted("random at a distance");
}

TEST(RoundTrip, PublicDataAtADistanceAreAccepted) {
  const std::uint64_t stride = tests::is_soak() ? 1 : 140;
  const auto files = tests::public_datasets();
  if (files.empty()) GTEST_SKIP() << "public data missing";
  RoundTrip trip;
  for (const auto& file : files) {
    const auto source = verify::data::open_dataset(file);
    while (const auto record = source->next()) {
      if (record->index % stride != 0) continue;
      for (const Norm norm : {Norm::linf, Norm::l2}) {
        for (const double distance : {1e-2, 1e-16, 1e-100}) {
          trip.add({source->kind(), record->query}, {distance, norm});
        }
      }
    }
  }
  trip.expect_accepted("public data at a distance");
  EXPECT_GE(trip.queries(), 6 * 9891 / stride);
}

TEST(RoundTrip, PublicDataAreAccepted) {
  const std::uint64_t stride = tests::is_soak() ? 1 : 10;
  const auto files = tests::public_datasets();
  if (files.empty()) GTEST_SKIP() << "public data missing";
  std::uint64_t queries = 0;
  for (const auto& file : files) {
    RoundTrip trip;
    const auto source = verify::data::open_dataset(file);
    while (const auto record = source->next()) {
      if (record->index % stride == 0) trip.add({source->kind(), record->query});
    }
    trip.expect_accepted(file.string());
    queries += trip.queries();
  }
  EXPECT_GE(queries, 9891 / stride);
}

}  // namespace
}  // namespace touchstone::exact::certificate_test
