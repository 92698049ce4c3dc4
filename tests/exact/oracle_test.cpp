/// \file
/// The oracle against known answers, and against a second way to decide contact at one time.
///
/// The second way uses no corners, normals or signs. For a fixed rational t, F(t,u,v) = 0 is three
/// linear equations in (u,v). Elimination leaves a point, a line or the whole plane, or shows that
/// there is no solution; the remainder is clipped against the domain. This must find contact at the
/// time of impact, and at no time before.

#include "touchstone/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <latch>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/contact_function.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rows.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/curved_query.hpp"

namespace touchstone::exact::oracle_test {
namespace {

using tests::Family;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;
using tests::random_query;
using tests::trials;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();

Rational ratio(long numerator, long denominator) {
  Rational result(numerator, denominator);
  result.canonicalize();
  return result;
}

Decision decide(const PosedQuery& posed) { return exact::decide(posed.kind, posed.query); }

// ------------------------------------------------------------------ contact at a fixed time

/// a u + b v + c: must be 0 (a row of F) or not negative (a side of the domain).
struct Affine {
  Rational a, b, c;

  [[nodiscard]] Rational at(const Rational& u, const Rational& v) const {
    return a * u + b * v + c;
  }
};

std::vector<Affine> domain_sides(ContactKind kind) {
  if (kind == ContactKind::vertex_face) return {{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};
  return {{1, 0, 0}, {-1, 0, 1}, {0, 1, 0}, {0, -1, 1}};
}

std::vector<Affine> contact_equations(const PosedQuery& posed, const Rational& t) {
  const auto value = [&](int u, int v) {
    return tests::contact_function<Rational>(posed.kind, posed.query, t, Rational(u), Rational(v));
  };
  const auto origin = value(0, 0), along_u = value(1, 0), along_v = value(0, 1);
  std::vector<Affine> rows;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows.push_back(
        {along_u.at(axis) - origin.at(axis), along_v.at(axis) - origin.at(axis), origin.at(axis)});
  }
  return rows;
}

bool all_zero(const std::vector<Affine>& rows, const Rational& u, const Rational& v) {
  return std::ranges::all_of(rows, [&](const Affine& row) { return sgn(row.at(u, v)) == 0; });
}

bool in_domain(ContactKind kind, const Rational& u, const Rational& v) {
  const std::vector<Affine> sides = domain_sides(kind);
  return std::ranges::all_of(sides, [&](const Affine& side) { return sgn(side.at(u, v)) >= 0; });
}

/// True if the line through (u,v) in direction (du,dv) meets the domain.
bool line_meets_domain(ContactKind kind, const Rational& u, const Rational& v, const Rational& du,
                       const Rational& dv) {
  std::optional<Rational> low, high;
  for (const Affine& side : domain_sides(kind)) {
    const Rational value = side.at(u, v), slope = side.a * du + side.b * dv;
    if (sgn(slope) == 0) {
      if (sgn(value) < 0) return false;
      continue;
    }
    const Rational crossing = -value / slope;
    if (sgn(slope) > 0 && (!low || crossing > *low)) low = crossing;
    if (sgn(slope) < 0 && (!high || crossing < *high)) high = crossing;
  }
  return *low <= *high;
}

/// True if the primitives are in contact at the time t.
bool touches_at(const PosedQuery& posed, const Rational& t) {
  const std::vector<Affine> rows = contact_equations(posed, t);
  for (std::size_t i = 0; i < 3; ++i) {
    const Affine &p = rows.at(i), &q = rows.at((i + 1) % 3);
    const Rational minor = p.a * q.b - q.a * p.b;
    if (sgn(minor) == 0) continue;
    const Rational u = (p.b * q.c - q.b * p.c) / minor, v = (q.a * p.c - p.a * q.c) / minor;
    return all_zero(rows, u, v) && in_domain(posed.kind, u, v);
  }
  for (const Affine& row : rows) {
    const Rational norm = row.a * row.a + row.b * row.b;
    if (sgn(norm) == 0) continue;
    const Rational u = -row.c * row.a / norm, v = -row.c * row.b / norm;
    return all_zero(rows, u, v) && line_meets_domain(posed.kind, u, v, -row.b, row.a);
  }
  return all_zero(rows, 0, 0);
}

// ------------------------------------------------------------------ what holds for every impact

Rational middle(const RationalInterval& x) { return (x.lower + x.upper) / 2; }

bool is_exact(const RationalInterval& x) { return x.lower == x.upper; }

Rational greatest_coordinate(const Query& query) {
  Rational result = 0;
  for (const double x : query.coordinates) result = std::max(result, Rational(std::abs(x)));
  return result;
}

/// Expects that (u,v) at the exact toi lies in the domain.
void expect_parameters_in_domain(ContactKind kind, const Decision& verdict) {
  AlgebraicNumber t = *verdict.toi;
  const auto& [u, v, denominator] = *verdict.contact;
  EXPECT_EQ(t.sign_of(denominator), 1);
  for (const Affine& side : domain_sides(kind)) {
    // The sides' coefficients are −1, 0 and 1.
    const Polynomial value = u * Polynomial(side.a.get_num()) + v * Polynomial(side.b.get_num()) +
                             denominator * Polynomial(side.c.get_num());
    EXPECT_GE(t.sign_of(value), 0);
  }
}

/// Expects F in the middle of the box of width 2^-bits to be zero if the box is a point, and
/// otherwise at most the width times a bound on the sum of F's derivatives (4M, 2M and 2M for
/// coordinates up to M, doubled because the box may reach out of the domain).
void expect_root_of_contact_function(const PosedQuery& posed, const Decision& verdict, long bits) {
  const Rational width = power_of_two(-bits);
  AlgebraicNumber t = *verdict.toi;
  t.refine(width);
  const RationalInterval time = t.interval();
  const auto [u, v] = contact_parameters(verdict, width);
  EXPECT_LE(Rational(time.upper - time.lower), width);
  EXPECT_LE(Rational(u.upper - u.lower), width);
  EXPECT_LE(Rational(v.upper - v.lower), width);

  const bool is_point = is_exact(time) && is_exact(u) && is_exact(v);
  const Rational bound =
      is_point ? Rational(0) : Rational(16 * greatest_coordinate(posed.query) * width);
  for (const Rational& component : tests::contact_function<Rational>(
           posed.kind, posed.query, middle(time), middle(u), middle(v))) {
    EXPECT_LE(Rational(abs(component)), bound);
  }
}

void expect_tight_enclosure(const AlgebraicNumber& toi) {
  const auto [lower, upper] = toi.enclosure();
  if (lower == upper) {
    EXPECT_TRUE(toi == Rational(lower));
  } else {
    EXPECT_EQ(std::nextafter(lower, infinity), upper);
    EXPECT_TRUE(toi > Rational(lower));
    EXPECT_TRUE(toi < Rational(upper));
  }
}

void check_contact(const PosedQuery& posed, const Decision& verdict) {
  ASSERT_TRUE(verdict.toi && verdict.contact);
  const AlgebraicNumber& toi = *verdict.toi;
  EXPECT_TRUE(toi >= Rational(0));
  EXPECT_TRUE(toi <= Rational(1));
  EXPECT_TRUE(toi.is_root_of(toi.polynomial()));
  expect_tight_enclosure(toi);
  expect_parameters_in_domain(posed.kind, verdict);
  for (const long bits : {10, 100, 300}) expect_root_of_contact_function(posed, verdict, bits);
  if (toi.rational()) {
    EXPECT_TRUE(touches_at(posed, *toi.rational()));
  }
}

/// Expects a collision at a rational time.
void expect_toi(const PosedQuery& posed, const Rational& toi) {
  SCOPED_TRACE(posed);
  const Decision verdict = decide(posed);
  ASSERT_TRUE(verdict.collides());
  EXPECT_TRUE(*verdict.toi == toi) << toi << " expected, near " << verdict.toi->enclosure().lower;
  EXPECT_TRUE(touches_at(posed, toi));
  check_contact(posed, verdict);
}

/// Expects a collision at a rational time with contact at a single point.
void expect_contact(const PosedQuery& posed, const Rational& toi, const Rational& u,
                    const Rational& v) {
  expect_toi(posed, toi);
  const Decision verdict = decide(posed);
  ASSERT_TRUE(verdict.collides());
  const Rational width = power_of_two(-200);
  const ContactParameters parameters = contact_parameters(verdict, width);
  const auto expect_encloses = [&](const RationalInterval& enclosure, const Rational& value) {
    EXPECT_LE(enclosure.lower, value);
    EXPECT_GE(enclosure.upper, value);
    EXPECT_LE(Rational(enclosure.upper - enclosure.lower), width);
    if (verdict.toi->rational()) {
      EXPECT_TRUE(is_exact(enclosure));
    }
  };
  expect_encloses(parameters.u, u);
  expect_encloses(parameters.v, v);
}

/// Expects a collision at the irrational root of `polynomial` that has this decimal value.
void expect_irrational_toi(const PosedQuery& posed, const Separation& separation,
                           const Polynomial& polynomial, std::string_view decimal) {
  SCOPED_TRACE(posed);
  const Decision verdict = exact::decide(posed.kind, posed.query, separation);
  ASSERT_TRUE(verdict.collides());
  const AlgebraicNumber& toi = *verdict.toi;
  EXPECT_FALSE(toi.rational());
  EXPECT_TRUE(toi.is_root_of(polynomial));
  const Rational value = rational_from_decimal(decimal), ulp = rational_from_decimal("1e-18");
  EXPECT_TRUE(toi > Rational(value - ulp));
  EXPECT_TRUE(toi < Rational(value + ulp));
  if (is_zero(separation)) check_contact(posed, verdict);
}

/// Expects the first time within a distance, later or never at the next double below it, and no
/// later at the next one above.
void expect_toi_at(const PosedQuery& posed, const Separation& separation, const Rational& toi) {
  const double distance = separation.distance;
  const auto toi_at = [&](double some) {
    return exact::decide(posed.kind, posed.query, {some, separation.norm}).toi;
  };
  const auto found = toi_at(distance), later = toi_at(std::nextafter(distance, 0.0)),
             earlier = toi_at(std::nextafter(distance, greatest));
  EXPECT_TRUE(found && *found == toi) << posed << ' ' << distance;
  EXPECT_TRUE(!later || *later > toi) << posed << ' ' << distance;
  EXPECT_TRUE(earlier && (*earlier < toi || *earlier == Rational(0))) << posed << ' ' << distance;
}

// ------------------------------------------------------------------ known answers

PosedQuery posed_of(const std::string& row) {
  const tests::QueryRow query(row);
  PosedQuery posed{kind_from_string(tests::replaced(query.kind, "_", "-")).contact(), {}};
  std::istringstream coordinates(tests::joined(query.points, " "));
  for (double& x : posed.query.coordinates) {
    std::string word;
    coordinates >> word;
    x = std::strtod(word.c_str(), nullptr);
  }
  return posed;
}

/// Expects what is written of a query: `none`, `root C… ~ VALUE`, the time, or the time and place.
void expect_as_written(const PosedQuery& posed, const Separation& separation,
                       const std::string& text) {
  const auto words = tests::split(text, " ");
  const auto number = [&](std::size_t i) { return tests::read_number(words.at(i)); };
  if (words[0] == "none") {
    EXPECT_FALSE(exact::decide(posed.kind, posed.query, separation).collides()) << posed;
  } else if (words[0] == "root") {
    std::vector<Integer> coefficients;
    for (std::size_t i = 1; words[i] != "~"; ++i) coefficients.emplace_back(words[i]);
    expect_irrational_toi(posed, separation, Polynomial(std::move(coefficients)), words.back());
  } else if (!is_zero(separation)) {
    expect_toi_at(posed, separation, number(0));
  } else if (words.size() == 1) {
    expect_toi(posed, number(0));
  } else {
    expect_contact(posed, number(0), number(1), number(2));
  }
}

/// The queries of contacts.txt.
TEST(Oracle, KnowsTheContactsOfTheList) {
  std::ifstream file(tests::source_folder() + "/tests/exact/contacts.txt");
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    for (const std::string& row : tests::expanded(line)) {
      ++rows;
      const auto sides = tests::split(row, " -> ");
      const auto asked = tests::split(sides.at(0), " at ");
      Separation separation;
      if (asked.size() == 2) {
        separation = {std::strtod(asked[1].c_str(), nullptr),
                      norm_from_string(tests::split(asked[1], " ").back())};
      }
      expect_as_written(posed_of(asked[0]), separation, sides.at(1));
    }
  }
  EXPECT_GT(rows, 120U);
}

// ------------------------------------------------------------------ the limits of doubles

TEST(Oracle, IsExactAtDistancesOfAnyMagnitude) {
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    // The height 3u − 4ut at distance u, the least double.
    expect_toi_at(over_triangle(1, 1, 3 * least, -least), {least, norm}, ratio(1, 2));
    expect_toi_at(over_triangle(1, 1, greatest, 0), {1, norm}, 1 - 1 / Rational(greatest));
    expect_toi_at(over_triangle(1, 1, 3, -1), {least, norm}, (3 - Rational(least)) / 4);
    const PosedQuery apart = over_triangle(1, 1, 3, 2 * least);
    EXPECT_FALSE(exact::decide(apart.kind, apart.query, {least, norm}).collides());
    EXPECT_TRUE(exact::decide(apart.kind, apart.query, {greatest, norm}).collides());
  }
}

TEST(Oracle, KnowsThePlaceOfContactAtDistanceZeroOnly) {
  const auto at = [](double z1, const Separation& separation) {
    const PosedQuery falling = over_triangle(1, 1, 2, z1);
    return exact::decide(falling.kind, falling.query, separation);
  };
  for (const double zero : {0.0, -0.0}) EXPECT_TRUE(at(0, {zero, Norm::l2}).contact);
  const Decision near = at(0, {1.0, Norm::l2}), none = at(1, {}), touching = at(-2, {});
  EXPECT_EQ(near.separation, (Separation{1.0, Norm::l2}));
  EXPECT_TRUE(near.collides() && !near.contact && !none.contact);
  for (const auto& [verdict, width] :
       {std::pair(near, 1), {none, 1}, {touching, 0}, {touching, -1}}) {
    EXPECT_THROW(static_cast<void>(contact_parameters(verdict, width)), std::invalid_argument);
  }
}

TEST(Oracle, RejectsEveryCoordinateThatIsNotFiniteAndDistancesBelowZero) {
  for (const PosedQuery& good : {over_triangle(1, 1, 1, -1), over_edge(1, 1, 1, -1)}) {
    ASSERT_TRUE(decide(good).collides());
    for (const double bad : {-1.0, -least, infinity, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_THROW(static_cast<void>(exact::decide(good.kind, good.query, {bad, Norm::l2})),
                   std::invalid_argument);
    }
    for (std::size_t i = 0; i < good.query.coordinates.size(); ++i) {
      for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
        PosedQuery query = good;
        query.query.coordinates.at(i) = bad;
        EXPECT_THROW(static_cast<void>(decide(query)), std::domain_error) << i << ' ' << bad;
        EXPECT_THROW(static_cast<void>(exact::decide(query.kind, query.query, {1, Norm::linf})),
                     std::domain_error);
      }
    }
  }
}

// ------------------------------------------------------------------ threads

/// All of a verdict as text.
std::string written(const Decision& verdict) {
  if (!verdict.collides()) return "none";
  const AlgebraicNumber& toi = *verdict.toi;
  const auto& [u, v, denominator] = *verdict.contact;
  std::ostringstream text;
  text << toi.polynomial() << ' ' << toi.interval().lower << ' ' << toi.interval().upper << ' '
       << toi.rational().has_value() << ' ' << toi.enclosure().lower << ' ' << u << ' ' << v << ' '
       << denominator;
  return text.str();
}

/// Threads decide the same queries at once, and copy the same verdicts, of which copies could share
/// parts.
/// With their proofs, which are about the vertex and the face.
TEST(Oracle, DecidesFacesThatHaveShrunkWhateverTheOtherPointsAre) {
  Random random(41);
  for (const QueryShape& shape : tests::shrunken_shapes()) {
    const tests::ShrunkenFaces drawn = tests::shrunken_faces(random, shape, 100);
    const Queries queries = drawn.queries(), faces = drawn.faces();
    for (const Separation& separation : {Separation{}, Separation{1.0, Norm::l2}}) {
      std::size_t count = 0;
      const std::vector<Decision> all = exact::decide(queries, separation);
      const std::vector<Certificate> proofs = prove(queries, all);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const Decision truth = exact::decide(faces, i, separation);
        const std::string text = certificate_stream(prove(faces, i, truth));
        const CurvedQuery curved = to_curved(queries, i);
        for (const Decision& one : {all[i], exact::decide(queries, i, separation),
                                    exact::decide(shape.kind, curved, separation)}) {
          ASSERT_EQ(one.collides(), truth.collides());
          if (!one.collides() || separation.distance > 0.0) continue;
          const auto [u, v] = contact_parameters(one, power_of_two(-60));
          const auto [expected_u, expected_v] = contact_parameters(truth, power_of_two(-60));
          ASSERT_TRUE(u.lower == expected_u.lower && u.upper == expected_u.upper);
          ASSERT_TRUE(v.lower == expected_v.lower && v.upper == expected_v.upper);
        }
        ASSERT_EQ(certificate_stream(proofs[i]), text);
        ASSERT_EQ(certificate_stream(prove(queries, i, all[i])), text);
        if (shape.is_straight()) {
          const Query& query = queries.straight()[i];
          const Decision one = exact::decide(shape.kind, query, separation);
          ASSERT_EQ(certificate_stream(prove(shape.kind, query, one)), text);
        }
        count += truth.collides() ? 1U : 0U;
      }
      EXPECT_GT(count, 4U);
      EXPECT_LT(count, queries.size() - 4);
    }
  }
}

TEST(Oracle, GivesTheSameAnswersInFourThreadsAsInOne) {
  Random random(7);
  std::vector<PosedQuery> queries;
  std::vector<Decision> originals;
  std::vector<std::string> expected;
  while (queries.size() < 2000) {
    const ContactKind kind = random.coin() ? ContactKind::vertex_face : ContactKind::edge_edge;
    queries.push_back(random_query(random, kind, tests::all_families.at(queries.size() % 4)));
    originals.push_back(decide(queries.back()));
    expected.push_back(written(originals.back()));
  }
  std::latch all_started(4);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      all_started.arrive_and_wait();
      for (std::size_t k = 0; k < queries.size(); ++k) {
        const std::vector<Decision> copies(20, originals[k]);
        EXPECT_EQ(written(decide(queries[k])), written(copies.back())) << queries[k];
      }
    });
  }
  threads.clear();
  for (std::size_t k = 0; k < queries.size(); ++k) EXPECT_EQ(written(originals[k]), expected[k]);
}

// ------------------------------------------------------------------ the second way to decide

/// A random time at which no query below is special.
Rational random_time(Random& random) { return ratio(random.between(1, 9972), 9973); }

struct Tally {
  int collisions = 0;
  int rational_collisions = 0;
  int touching_at_start = 0;
  int no_collisions = 0;
};

/// Expects no contact at those times k/60, and random times, that lie before the toi.
void expect_no_contact_before(const PosedQuery& posed, Random& random, const AlgebraicNumber* toi) {
  const auto check = [&](const Rational& t) {
    if (toi != nullptr && *toi <= t) return;
    EXPECT_FALSE(touches_at(posed, t)) << "contact at " << t;
  };
  for (long k = 0; k <= 60; ++k) check(ratio(k, 60));
  for (int i = 0; i < 5; ++i) check(random_time(random));
  if (toi == nullptr) return;
  AlgebraicNumber fine = *toi;
  fine.refine(power_of_two(-60));
  for (const long bits : {5, 20, 50}) {
    const Rational shortly_before = fine.interval().lower - power_of_two(-bits);
    if (sgn(shortly_before) >= 0) check(shortly_before);
  }
}

void compare_with_second_way(const PosedQuery& posed, Random& random, Tally& tally) {
  SCOPED_TRACE(posed);
  const Decision verdict = decide(posed);
  const AlgebraicNumber* toi = verdict.collides() ? &*verdict.toi : nullptr;
  expect_no_contact_before(posed, random, toi);
  if (toi == nullptr) {
    ++tally.no_collisions;
    return;
  }
  ++tally.collisions;
  tally.rational_collisions += toi->rational() ? 1 : 0;
  tally.touching_at_start += *toi == Rational(0) ? 1 : 0;
  EXPECT_EQ(*toi == Rational(0), touches_at(posed, 0));
  check_contact(posed, verdict);
}

void compare_family_with_second_way(Family family, int count, Tally& tally) {
  Random random(42 + static_cast<unsigned>(family));
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
    compare_with_second_way(random_query(random, kind, family), random, tally);
  }
}

TEST(Oracle, AgreesWithEliminationOnSmallIntegers) {
  Tally tally;
  compare_family_with_second_way(Family::tiny_integers, trials(2000), tally);
  compare_family_with_second_way(Family::small_integers, trials(2000), tally);
  EXPECT_GT(tally.collisions, trials(1000));
  EXPECT_GT(tally.no_collisions, trials(1000));
  EXPECT_GT(tally.rational_collisions, trials(500));
  EXPECT_GT(tally.touching_at_start, trials(200));
  EXPECT_GT(tally.collisions - tally.rational_collisions, trials(100));
}

TEST(Oracle, AgreesWithEliminationOnFullSignificands) {
  Tally tally;
  compare_family_with_second_way(Family::full_significands, trials(200), tally);
  compare_family_with_second_way(Family::near_contact, trials(200), tally);
  EXPECT_GT(tally.collisions, trials(40));
  EXPECT_GT(tally.no_collisions, trials(40));
}

}  // namespace
}  // namespace touchstone::exact::oracle_test
