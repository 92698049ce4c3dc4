#include "touchstone/certificate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exact/certificate/separation_intervals.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/inverting_cells.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::exact::certificate_test {
namespace {

using tests::edge_edge;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::rejection;
using tests::vertex_face;

/// A vertex that moves past a triangle.
PosedQuery past(const std::array<double, 9>& face, const std::array<double, 3>& start,
                const std::array<double, 3>& end) {
  return vertex_face(tests::with_vertex(start[0], start[1], start[2], face),
                     tests::with_vertex(end[0], end[1], end[2], face));
}

// ---- By hand ------------------------------------------------------------------------------------

/// A query with its first contact.
struct Known {
  PosedQuery posed;
  Separation separation;
  Rational time;
  std::optional<ContactPlace> place;
};

TEST(Prove, KnowsTheTimeAndPlaceOfContact) {
  constexpr std::array<double, 9> needle{0, 0, 0, 4, 0, 0, 2, 0, 0};
  const PosedQuery falling = over_triangle(1, 1, 3, -1);
  const std::vector<Known> all{
      // t x = y with x = 4 − 3 t and y = 1: 3 t² − 4 t + 1 = 0 at 1/3 and 1.
      {tests::turning_triangle(8, 4, 1, 1), {}, Rational(1, 3), std::nullopt},
      // All points are one; on a triangle that is a segment.
      {{ContactKind::vertex_face, Query{}}, {}, 0, SegmentContact{{0, 1}}},
      {past(needle, {3, 0, 1}, {3, 0, -3}), {}, Rational(1, 4), SegmentContact{{0, 1}}},
      {falling, {1, Norm::l2}, Rational(1, 2), FaceContact{}},
      {falling, {1, Norm::linf}, Rational(1, 2), AxesContact{}},
      {over_triangle(-3, -4, 16, 8), {13, Norm::l2}, Rational(1, 2), VertexContact{0}},
      {over_triangle(2, -3, 8, 0), {5, Norm::l2}, Rational(1, 2), EdgeContact{{0, 1}}},
      {over_edge(1, 2, 1, -1), {1, Norm::l2}, 0, std::nullopt},
      {over_edge(1, 2, 1, -1), {1, Norm::linf}, 0, std::nullopt}};
  for (const auto& [posed, separation, time, place] : all) {
    const Certificate certificate = tests::prove(posed, separation);
    EXPECT_EQ(rejection(certificate), "") << posed;
    EXPECT_EQ(certificate.separation, separation);
    EXPECT_EQ(std::get<Rational>(certificate.contact.value().time), time) << posed;
    EXPECT_EQ(certificate.subintervals.size(), sgn(time) == 0 ? 0U : 1U) << posed;
    if (place) {
      EXPECT_EQ(certificate.contact->place, *place) << posed;
    }
  }
}

// ---- Options ------------------------------------------------------------------------------------

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
  const PosedQuery colliding = over_triangle(1, 1, 3, -1), apart = over_triangle(1, 1, 3, 1.5);
  for (const Separation& separation :
       {Separation{}, Separation{1, Norm::linf}, Separation{1, Norm::l2}}) {
    const Decision of_collision = decide(colliding.kind, colliding.query, separation),
                   of_no_collision = decide(apart.kind, apart.query, separation);
    EXPECT_EQ(rejection(tests::prove(apart, separation)), "");
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, of_no_collision)),
                 std::logic_error);
    EXPECT_THROW(static_cast<void>(prove(apart.kind, apart.query, of_collision)), std::logic_error);
    Decision bad = of_collision;
    bad.separation.distance = -1;
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, bad)),
                 std::invalid_argument);
    if (is_zero(separation)) continue;
    const Decision late{.separation = separation, .toi = AlgebraicNumber(Rational(3, 4))};
    EXPECT_THROW(static_cast<void>(prove(colliding.kind, colliding.query, late)), std::logic_error);
  }
  // A contact that is not the first.
  const PosedQuery through_twice = tests::turning_triangle(8, 4, 1, 1);
  Decision late = decide(through_twice.kind, through_twice.query);
  *late.toi = AlgebraicNumber(1);
  EXPECT_THROW(static_cast<void>(prove(through_twice.kind, through_twice.query, late)),
               std::logic_error);
}

// ---- Magnitudes and near misses -----------------------------------------------------------------

TEST(Prove, NearMissesHaveACertificate) {
  // A vertex passes a triangle that is a point, a segment or a face, at this distance.
  for (const double gap : {0x1p-50, 0x1p-200, 0x1p-500, 0x1p-1000}) {
    for (const std::array<double, 9>& face :
         {std::array<double, 9>{}, std::array<double, 9>{-3, 0, 0, 5, 0, 0, 1, 0, 0},
          std::array<double, 9>{0, 0, 0, 4, 0, 0, 0, -4, 0}}) {
      const PosedQuery posed = past(face, {-1, gap, -1}, {2, gap, 2});
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
  /// The query in contact, and at some distances if asked.
  void add(const PosedQuery& posed, bool is_at_distances) {
    add(posed, Separation{});
    if (!is_at_distances) return;
    const Norm norm = random_.coin() ? Norm::linf : Norm::l2;
    for (const double distance : {std::ldexp(random_.between(1, 7), random_.between(-100, -1)),
                                  random_.between(1, 7) / 4.0, random_.coin() ? 1e-30 : 1e-100}) {
      add(posed, {distance, norm});
    }
  }

  void expect_accepted(const std::string& name) const {
    const checker::Report report = tests::check_text(text_ + certificates_closing_line(queries()));
    EXPECT_EQ(report.time_of_impact, collisions_) << name;
    EXPECT_EQ(report.no_collision, misses_) << name;
    EXPECT_EQ(report.collision, 0U);
    for (const auto& rejected : report.rejections) ADD_FAILURE() << name << ": " << rejected.reason;
    EXPECT_TRUE(report.all_accepted());
  }

  [[nodiscard]] std::uint64_t queries() const { return collisions_ + misses_; }

 private:
  void add(const PosedQuery& posed, const Separation& separation) {
    const Decision verdict = decide(posed.kind, posed.query, separation);
    const Certificate certificate = prove(posed.kind, posed.query, verdict);
    ASSERT_EQ(certificate.claim == Claim::time_of_impact, verdict.collides());
    if (verdict.collides()) {
      ++collisions_;
      // Neighbouring doubles, of which the upper one may be the toi; or 0 twice.
      const auto& [lower, upper] = certificate.toi;
      ASSERT_EQ(upper, Rational(verdict.toi->enclosure().upper)) << posed;
      ASSERT_EQ(lower, Rational(std::nextafter(upper.get_d(), 0.0))) << posed;
      ASSERT_EQ(certificate.subintervals.empty(), upper == 0) << posed;
      ASSERT_TRUE(upper == 0 || certificate.subintervals.back().to == lower) << posed;
    } else {
      ++misses_;
      ASSERT_EQ(certificate.claim, Claim::no_collision);
    }
    write(text_, certificate);
  }

  std::string text_{certificates_header()};
  std::uint64_t collisions_ = 0;
  std::uint64_t misses_ = 0;
  tests::Random random_{6};
};

TEST(RoundTrips, OfFamiliesAreAccepted) {
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      RoundTrip trip;
      for (std::size_t i = 0; i < tests::soak_trials(20U, 50U); ++i) {
        // Distances that differ from the coordinates as much as these differ among themselves make
        // the numbers too long.
        trip.add({kind, verify::generate::make_query(family, kind, 7, i).query},
                 i % 10 == 0 && family.name != "extreme-range");
      }
      trip.expect_accepted(std::string(family.name));
    }
  }
}

TEST(RoundTrips, OfRandomQueriesAreAccepted) {
  tests::Random random(6);
  RoundTrip trip;
  for (std::size_t i = 0; i < tests::soak_trials(1000U, 50U); ++i) {
    const ContactKind kind = random.coin() ? ContactKind::vertex_face : ContactKind::edge_edge;
    trip.add(
        tests::random_query(random, kind, tests::all_families.at(i % tests::all_families.size())),
        i % 10 < 2);
    if (i % 16 != 0) continue;
    PosedQuery posed{kind, {}};
    for (double& x : posed.query.coordinates) x = random.finite_double();
    trip.add(posed, false);
  }
  // The whole range of doubles: over a triangle of the greatest width and across such an edge, from
  // the least height to the greatest and back; times far below the least double, tiny, or beside
  // one.
  constexpr double least = std::numeric_limits<double>::denorm_min(),
                   most = std::numeric_limits<double>::max();
  for (const double x : {-least, 0.0, least, 1.0, most}) {
    for (const auto& [z0, z1] :
         {std::pair(-least, most), {most, -least}, {most, -most}, {most, least}}) {
      trip.add(past({0, -most, 0, most, 0, 0, 0, most, 0}, {x, 0, z0}, {x, 0, z1}), false);
      trip.add(tests::edge_edge({0, 0, 0, most, 0, 0, x, -most, z0, x, least, z0},
                                {0, 0, 0, most, 0, 0, x, -most, z1, x, least, z1}),
               false);
    }
  }
  trip.add(over_triangle(1, 1, 0x1p-1024, -0x1p1000), false);
  for (const double y : {0x1p-200, 0x1p-600, 0x1p-1074}) {
    trip.add(tests::turning_triangle(2, 0, 2, y), false);
  }
  for (int i = 0; i < 200; ++i) {
    trip.add(tests::turning_triangle(2, 0, 2, std::ldexp(17 + 2 * (i % 8), -12 - i / 8)), false);
  }
  // t(ε(1−t) + t) = 1/4 at about 1/2 − ε/4; the sign of ε determines the side of the double.
  for (const double epsilon : {0x1p-100, 0x1p-601, -0x1p-100, -0x1p-601}) {
    trip.add(tests::turning_triangle(1, epsilon, 1, 0.25), false);
  }
  trip.expect_accepted("random");
}

TEST(RoundTrips, OfPublicDataAreAccepted) {
  const std::size_t stride = tests::is_soak() ? 1 : 10;
  RoundTrip trip;
  const auto add = [&](const auto& /*file*/, std::uint64_t index, ContactKind kind,
                       const Query& query) {
    if (index % stride == 0) trip.add({kind, query}, index % (10 * stride) == 0);
  };
  if (!tests::for_each_public_query(add)) GTEST_SKIP() << "public data missing";
  trip.expect_accepted("public data");
  EXPECT_GE(trip.queries(), 9891 / stride);
}

/// At the least width the interval holds one root of the conditions at most, so that the time is
/// proved: their coefficients are below 2^100, and products of two of degree 6 have roots at least
/// 2^-2000 apart [mahler1964].
TEST(Prove, KeepsToTheWidthAskedFor) {
  tests::Random random(12);
  const int count = tests::soak_trials(150, 200);
  int later = 0, no_collisions = 0;
  for (int i = 0; i < count; ++i) {
    const ContactKind kind = random.coin() ? ContactKind::vertex_face : ContactKind::edge_edge;
    PosedQuery posed = tests::random_query(
        random, kind, tests::all_families.at(static_cast<std::size_t>(random.between(0, 1))));
    // The first primitive moved away, as almost all would be near from the start.
    const auto axis = static_cast<std::size_t>(random.between(0, 2));
    const double shift = random.coin() ? random.between(2, 5) : 0;
    for (std::size_t point = 0; point < (kind == ContactKind::vertex_face ? 1U : 2U); ++point) {
      for (const std::size_t end : {0U, 1U}) posed.query.at(end, point, axis) += shift;
    }
    static constexpr std::array values{0.5, 1.0, 1.0, 2.0, 3.0, 1.25, 0x1p-10, 0.0};
    const double distance = values.at(static_cast<std::size_t>(random.between(0, 7)));
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Decision verdict = decide(kind, posed.query, {distance, norm});
      for (const Rational& width : {Rational(2), Rational(1, 1000), power_of_two(-2000)}) {
        const Certificate certificate = prove(kind, posed.query, verdict, {.width = width});
        ASSERT_EQ(rejection(certificate), "") << posed << ' ' << distance << to_string(norm);
        const auto& [lower, upper] = certificate.toi;
        EXPECT_LE(upper - lower, width);
        if (!verdict.collides() || *verdict.toi == Rational(0)) continue;
        EXPECT_TRUE(*verdict.toi > lower && *verdict.toi <= upper);
      }
      no_collisions += verdict.collides() ? 0 : 1;
      later += verdict.collides() && *verdict.toi > Rational(0) ? 1 : 0;
    }
  }
  EXPECT_GT(later, count / 8);
  EXPECT_GT(no_collisions, count / 8);
}

// ---- Inversions ---------------------------------------------------------------------------------

/// The certificate of a cell, which claims what the oracle says and is accepted.
template <class AnyQuery>
Certificate accepted(const AnyQuery& tetrahedron, const ProveOptions& options = {}) {
  const auto time = first_inversion(CellKind::tetrahedron, tetrahedron);
  const Certificate certificate =
      prove_inversion(CellKind::tetrahedron, tetrahedron, time, options);
  EXPECT_EQ(rejection(certificate), "") << certificate_stream(certificate);
  EXPECT_EQ(certificate.claim, time ? options.collision_claim : Claim::no_collision);
  EXPECT_EQ(certificate.contact.has_value(), time.has_value());
  if (certificate.claim == Claim::time_of_impact && !options.width) {
    // Neighbouring doubles, of which the upper one may be the time; or 0 twice.
    EXPECT_EQ(certificate.toi.upper, Rational(time->enclosure().upper));
    EXPECT_EQ(certificate.toi.lower, Rational(std::nextafter(certificate.toi.upper.get_d(), 0.0)));
  }
  return certificate;
}

/// Cells of all sorts, half of them degenerate; of products of factors the time is known.
TEST(ProveInversion, OfAllSortsOfCellsIsAccepted) {
  tests::Random random(8);
  std::array<int, 3> claims{};
  for (int round = 0; round < tests::soak_trials(2000, 50); ++round) {
    const Query cell = tests::cell_of_sort(random, round % tests::sorts_of_cells);
    ProveOptions options;
    if (round % 3 == 0) options.collision_claim = Claim::collision;
    if (round % 5 == 0) options.width = Rational(1, 1000);
    const Certificate certificate = accepted(cell, options);
    ++claims.at(static_cast<std::size_t>(certificate.claim));
  }
  for (const int count : claims) EXPECT_GT(count, tests::trials(200));
  for (int round = 0; round < tests::soak_trials(500, 20); ++round) {
    const tests::KnownInversion known =
        round % 2 == 0 ? tests::product_of_factors(random) : tests::triangle_of_factors(random);
    const Certificate certificate = accepted(known.tetrahedron);
    ASSERT_EQ(certificate.claim == Claim::time_of_impact, known.numerator >= 0);
    if (known.numerator >= 0) {
      EXPECT_EQ(std::get<Rational>(certificate.contact->time),
                Rational(known.numerator) / known.denominator);
    }
  }
}

/// On curves, too; with the proof of another cell one is accepted only where the claim is true
/// of it.
TEST(ProveInversion, OfCurvesIsAcceptedAndNoneOfWhatIsFalse) {
  tests::Random random(9);
  std::array<int, 3> claims{};
  int kept = 0, rejected = 0;
  for (int round = 0; round < tests::soak_trials(300, 20); ++round) {
    CurvedQuery cell;
    for (Trajectory& curve : cell) {
      const int degree = random.between(0, 3);
      for (int j = 0; j <= degree; ++j) {
        for (double& x : curve.control.emplace_back()) x = random.between(-3, 3);
        if (round % 2 == 0) curve.weights.push_back(random.between(1, 3));
      }
    }
    if (round % 3 == 0) cell = to_tetrahedron(CellKind::plane_triangle, cell);
    Certificate certificate = accepted(
        cell, {.collision_claim = round % 4 == 0 ? Claim::collision : Claim::time_of_impact});
    ++claims.at(static_cast<std::size_t>(certificate.claim));
    Trajectory& curve = cell.at(static_cast<std::size_t>(random.between(0, 3)));
    curve.control.back().at(static_cast<std::size_t>(random.between(0, 2))) +=
        random.coin() ? 1 : -1;
    certificate.query = cell;
    const bool is_kept = rejection(certificate).empty();
    ++(is_kept ? kept : rejected);
    if (!is_kept) continue;
    const auto truth = first_inversion(CellKind::tetrahedron, cell);
    ASSERT_EQ(truth.has_value(), certificate.claim != Claim::no_collision);
    if (certificate.claim != Claim::time_of_impact) continue;
    EXPECT_GE(*truth, certificate.toi.lower);
    EXPECT_LE(*truth, certificate.toi.upper);
  }
  for (const int count : claims) EXPECT_GT(count, tests::trials(20));
  EXPECT_GT(kept, tests::trials(20));
  EXPECT_GT(rejected, tests::trials(20));
}

/// The volume is (1 − 3t)² + h², too near to 0 at 1/3 for the checker's bisections.
TEST(ProveInversion, DividesWhatTheCheckerCannotSee) {
  for (const double h : {0x1p-10, 0x1p-60, 0x1p-200}) {
    const Query cell{{0, 0, 0, 1, h, 0, -h, 1, 0, 0, 0, 1, 0, 0, 0, -2, h, 0, -h, -2, 0, 0, 0, 1}};
    const Certificate certificate = accepted(cell);
    EXPECT_EQ(certificate.subintervals.size(), h < 0x1p-100 ? 3U : 1U);
  }
}

TEST(ProveInversion, CannotProveAWrongVerdict) {
  tests::Random random(10);
  for (int round = 0; round < tests::trials(100); ++round) {
    const Query cell = tests::product_of_factors(random).tetrahedron;
    std::optional<AlgebraicNumber> wrong;
    if (!first_inversion(CellKind::tetrahedron, cell)) wrong = AlgebraicNumber(Rational(1, 2));
    EXPECT_THROW(static_cast<void>(prove_inversion(CellKind::tetrahedron, cell, wrong)),
                 std::logic_error);
  }
}

// ---- Breaks between features --------------------------------------------------------------------

TEST(Separate, BreaksAtAShortNumberBetweenTwoFeatures) {
  // A path from above the triangle over its side x = 0 at 2/9, then down through its plane at 1/3.
  // The side separates from shortly before 2/9.
  const Certificate certificate =
      tests::prove(past({0, 0, 0, 4, 0, 0, 0, 4, 0}, {1, 1, 0.125}, {-3.5, 1, -0.25}));
  const Rational quarter(1, 4);
  EXPECT_EQ(
      certificate.subintervals,
      (std::vector<Subinterval>{{0, quarter, {.sort = Feature::Sort::positive_face}},
                                {quarter, 1, {.sort = Feature::Sort::edge, .i = 2, .j = 0}}}));
}

TEST(Separate, SaysSoWhereTheLimitsCannotBeKept) {
  // This takes half a minute, mostly for the isolation of roots so close together.
  if (!tests::is_soak()) {
    GTEST_SKIP() << "in the soak only";
  }
  // All corners are one point that moves from (−a,1,0) to (2a,1,0): it is nearest at 1/3.
  const Integer far = Integer(1) << 17000U;
  Motion motion{.kind = ContactKind::vertex_face, .points = {}, .corners = {}, .corner_count = 3};
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    motion.corners[i][0].c = {Integer(-far), Integer(2 * far)};
    motion.corners[i][1].c = {1, 1};
  }
  EXPECT_THROW(static_cast<void>(separate(motion, 1)), CertificateLimitError);
}

TEST(IsWithinLimit, CountsTheBitsOfBothParts) {
  const Integer most = (Integer(1) << number_limit) - 1;
  EXPECT_TRUE(is_within_limit(Rational(most)));
  EXPECT_TRUE(is_within_limit(Rational(Integer(-most), most - 1)));
  EXPECT_FALSE(is_within_limit(Rational(most + 1)));
  EXPECT_FALSE(is_within_limit(power_of_two(-static_cast<long>(number_limit))));
}

// ---- Text ---------------------------------------------------------------------------------------

TEST(Text, OfNumbersIsTheShortest) {
  const auto expect_as_printf = [](double x) {
    std::array<char, 64> buffer{};
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg)
    const int length = std::snprintf(buffer.data(), buffer.size(), "%a", x);
    std::string text;
    write_hexadecimal(text, x);
    ASSERT_EQ(text, std::string(buffer.data(), static_cast<std::size_t>(length)));
  };
  using Limits = std::numeric_limits<double>;
  for (const double x :
       {0.0, -0.0, 1.0, -1.5, 0.1, 1e300, Limits::max(), Limits::lowest(), Limits::min(),
        Limits::denorm_min(), -3 * Limits::denorm_min(), 0x1p-1023}) {
    expect_as_printf(x);
  }
  tests::Random random(1);
  for (int repetition = 0; repetition < 20000; ++repetition) {
    expect_as_printf(random.finite_double());
  }
  for (const auto& [x, text] :
       {std::pair(Rational(-7), "-7"),
        {Rational(1, 2), "1/2"},
        {Rational(1, 3), "1/3"},
        {Rational(0.1), "0x1.999999999999ap-4"},
        {power_of_two(-1074), "0x0.0000000000001p-1022"},
        {power_of_two(1023), "0x1p+1023"},
        // Too many bits for a double.
        {power_of_two(-60) + 1, "1152921504606846977/1152921504606846976"}}) {
    EXPECT_EQ(tests::written(x), text);
  }
}

TEST(Text, OfALabelIsOneLineWithinALimitCutBetweenCharacters) {
  EXPECT_EQ(label_text("a\nquery b\r\x7f"), "a?query b??");
  EXPECT_EQ(label_text(std::string(2000, 'x') + "end"), std::string(label_limit - 3, 'x') + "end");
  // Characters of two, three and four bytes.
  for (const std::string character : {"\u00e9", "\u20ac", "\U0001d11e"}) {
    std::string label;
    while (label.size() <= label_limit) label += character;
    for (const std::string end : {"", "a", "ab", "abc"}) {
      const std::string text = label_text(label + end);
      EXPECT_LE(text.size(), label_limit);
      EXPECT_GT(text.size() + character.size(), label_limit);
      EXPECT_EQ((text.size() - end.size()) % character.size(), 0U);
      EXPECT_TRUE(text.starts_with(character) && text.ends_with(end));
    }
  }
  EXPECT_EQ(label_text(std::string(2000, '\x80')).size(), label_limit - 3) << "no UTF-8";
}

}  // namespace
}  // namespace touchstone::exact::certificate_test
