/// \file
/// Checks of the built-in families by rational arithmetic written here, not by an oracle: at chosen
/// rational times the hull of the corners contains zero or not, by the three sign rules for a
/// triangle. The times are random, just before the claimed time of impact, and all rational times
/// at which a coordinate of a corner vanishes, where degenerate contacts are. Families on curves
/// are checked by the oracle, in certify_test.cpp.

#include "verify/generate/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/contact_function.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/element.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::generate::families_test {
namespace {

using exact::Integer;
using exact::Rational;
using Vector = std::array<Integer, 3>;

constexpr std::uint64_t seed = 20211;
constexpr std::uint64_t queries_a_family = tests::trials(120U);
constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

template <class Function>
void for_each_family(Function&& function) {
  for (const Family& family : families()) {
    for (const Kind kind : kinds) {
      if (supports(family, kind)) function(family, kind);
    }
  }
}

template <class Function>
void for_each_query(std::uint64_t count, Function&& function) {
  for_each_family([&](const Family& family, Kind kind) {
    for (std::uint64_t index = 0; index < count; ++index) {
      SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)) + " " +
                   std::to_string(index));
      function(family, kind, index, make_query(family, kind, seed, index));
    }
  });
}

Vector cross(const Vector& a, const Vector& b) {
  Vector c;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    c.at(i) = a.at(j) * b.at(k) - a.at(k) * b.at(j);
  }
  return c;
}

Integer dot(const Vector& a, const Vector& b) { return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2]}; }

Vector minus(const Vector& a, const Vector& b) {
  return {Integer(a[0] - b[0]), Integer(a[1] - b[1]), Integer(a[2] - b[2])};
}

bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

bool segment_contains_zero(const Vector& a, const Vector& b) {
  return is_zero(cross(a, b)) && dot(a, b) <= 0;
}

bool triangle_contains_zero(const Vector& a, const Vector& b, const Vector& c) {
  const Vector normal = cross(minus(b, a), minus(c, a));
  if (is_zero(normal)) {
    return segment_contains_zero(a, b) || segment_contains_zero(b, c) ||
           segment_contains_zero(c, a);
  }
  if (dot(a, cross(b, c)) != 0) return false;
  std::size_t k = 0;
  while (normal.at(k) == 0) ++k;
  const auto turns_with = [&](const Vector& p, const Vector& q) {
    return sgn(cross(p, q).at(k)) * sgn(normal.at(k)) >= 0;
  };
  return turns_with(a, b) && turns_with(b, c) && turns_with(c, a);
}

bool hull_contains_zero(const std::vector<Vector>& w) {
  if (triangle_contains_zero(w[0], w[1], w[2])) return true;
  return w.size() == 4 && triangle_contains_zero(w[0], w[2], w[3]);
}

/// The corners of a query as integers, each axis times a power of two (which changes no answer).
class Corners {
 public:
  Corners(Kind kind, const Query& query) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // 2^1074 times a double is an integer; the common power is divided out.
      std::vector<Integer> values;
      Integer common = 0;
      for (std::size_t i = 0; i < query_points; ++i) {
        const Rational exact(query.coordinates.at(3 * i + axis));
        values.emplace_back(Integer((exact.get_num() << 1074) / exact.get_den()));
        common = gcd(common, values.back());
      }
      if (common == 0) common = 1;
      const auto difference = [&](std::size_t end, const Corner& corner) {
        return Integer((values.at(moving_points * end + corner.plus) -
                        values.at(moving_points * end + corner.minus)) /
                       common);
      };
      for (std::size_t i = 0; i < corners(kind).size(); ++i) {
        start_.resize(corners(kind).size());
        end_.resize(corners(kind).size());
        start_.at(i).at(axis) = difference(0, corners(kind)[i]);
        end_.at(i).at(axis) = difference(1, corners(kind)[i]);
      }
    }
  }

  /// Positive multiples of the corners at time t.
  [[nodiscard]] std::vector<Vector> at(const Rational& t) const {
    const Integer before = t.get_den() - t.get_num();
    std::vector<Vector> w(start_.size());
    for (std::size_t i = 0; i < w.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        w.at(i).at(axis) = before * start_.at(i).at(axis) + t.get_num() * end_.at(i).at(axis);
      }
    }
    return w;
  }

  [[nodiscard]] bool touch_at(const Rational& t) const { return hull_contains_zero(at(t)); }

  /// The times in [0,1] at which a coordinate of a corner, not zero for all t, vanishes.
  [[nodiscard]] std::vector<Rational> coordinate_roots() const {
    std::vector<Rational> roots;
    for (std::size_t i = 0; i < start_.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Integer& a = start_.at(i).at(axis);
        const Integer& b = end_.at(i).at(axis);
        if (a == b || sgn(a) * sgn(b) > 0) continue;
        Rational root(a, Integer(a - b));
        root.canonicalize();
        roots.push_back(root);
      }
    }
    return roots;
  }

 private:
  std::vector<Vector> start_;
  std::vector<Vector> end_;
};

std::vector<Rational> sixteenths() {
  std::vector<Rational> times;
  for (int i = 0; i <= 16; ++i) {
    times.emplace_back(i, 16);
    times.back().canonicalize();
  }
  return times;
}

/// Random times, sixteenths, and the roots of coordinates.
std::vector<Rational> probe_times(const Corners& corners_of_query, std::mt19937_64& random) {
  std::vector<Rational> times = corners_of_query.coordinate_roots();
  for (const Rational& t : sixteenths()) times.push_back(t);
  for (int i = 0; i < 100; ++i) {
    times.emplace_back(static_cast<unsigned long>(random() >> 11U), 1UL << 53U);
    times.back().canonicalize();
  }
  return times;
}

/// True if the projection of the corners along an axis contains zero.
bool projection_contains_zero(std::vector<Vector> w, std::size_t axis) {
  for (Vector& corner : w) corner.at(axis) = 0;
  return hull_contains_zero(w);
}

/// True if the projection along some axis contains zero at all sixteenths (so that the primitives
/// overlap there), and the determinant of three corners has both signs at sixteenths.
bool passes_through(const Corners& c) {
  std::array<bool, 3> overlaps{true, true, true};
  std::set<int> signs;
  for (const Rational& t : sixteenths()) {
    const std::vector<Vector> w = c.at(t);
    signs.insert(sgn(dot(w[0], cross(w[1], w.back()))));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      overlaps.at(axis) = overlaps.at(axis) && projection_contains_zero(w, axis);
    }
  }
  return signs.contains(1) && signs.contains(-1) && (overlaps[0] || overlaps[1] || overlaps[2]);
}

std::string check_open_toi(const Corners& c) {
  for (const Rational& t : c.coordinate_roots()) {
    if (c.touch_at(t)) return "";
  }
  for (const Rational& t : sixteenths()) {
    if (c.touch_at(t)) return "";
  }
  return passes_through(c) ? "" : "no sign of the claimed collision";
}

/// The fault of the claim, or nothing.
std::string check_claim(Kind kind, const KnownQuery& known, std::mt19937_64& random) {
  const Corners c(kind, known.query);
  if (known.collides && !known.toi) return check_open_toi(c);
  if (known.collides && (*known.toi < 0 || *known.toi > 1)) return "toi out of range";
  if (known.collides && !c.touch_at(*known.toi)) return "no contact at the toi";
  std::vector<Rational> times = probe_times(c, random);
  if (known.collides) {
    for (int k = 1; k <= 100; ++k) {
      times.emplace_back(*known.toi * (1 - exact::power_of_two(-k)));
      times.emplace_back(*known.toi * static_cast<unsigned long>(random() >> 11U) / (1UL << 53U));
    }
  }
  for (const Rational& t : times) {
    if (known.collides && t >= *known.toi) continue;
    if (c.touch_at(t)) return "contact at t = " + t.get_str();
  }
  return "";
}

int significand_bits(double x) {
  int exponent = 0;
  double fraction = std::frexp(std::abs(x), &exponent);
  int bits = 0;
  while (fraction != 0) {
    fraction = 2 * fraction - std::floor(2 * fraction);
    ++bits;
  }
  return bits;
}

TEST(Families, RejectUnknownNamesAndKinds) {
  const Family unknown{"no-such-family", "", Verdicts::both};
  EXPECT_THROW((void)family_from_name("no-such-family"), std::invalid_argument);
  EXPECT_THROW((void)supports(unknown, Kind::edge_edge), std::invalid_argument);
  EXPECT_THROW((void)make_query(unknown, Kind::edge_edge, 1, 0), std::invalid_argument);
  const Family& triangles = family_from_name("needle-triangle");
  EXPECT_TRUE(supports(triangles, Kind::vertex_face));
  EXPECT_FALSE(supports(triangles, Kind::edge_edge));
  EXPECT_THROW((void)make_query(triangles, Kind::edge_edge, 1, 0), std::invalid_argument);
  EXPECT_THROW((void)open_family(triangles, Kind::edge_edge, 1, 1), std::invalid_argument);
}

TEST(Families, HaveNoQueryTwice) {
  for_each_family([&](const Family& family, Kind kind) {
    std::set<std::array<double, 24>> seen;
    for (std::uint64_t index = 1; index < 400; index += 2) {
      EXPECT_TRUE(seen.insert(make_query(family, kind, seed, index).query.coordinates).second)
          << family.name << ' ' << index;
    }
  });
}

/// FNV-1a over the bits of the coordinates, to notice a change of a generator or different bits on
/// another machine.
TEST(Families, DrawTheSameBitsEverywhere) {
  std::uint64_t digest = 0xcbf29ce484222325ULL;
  for_each_query(120, [&](const Family&, Kind, std::uint64_t, const KnownQuery& known) {
    for (const double coordinate : known.query.coordinates) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      digest = (digest ^ bits) * 0x100000001b3ULL;
    }
  });
  EXPECT_EQ(digest, 2340645805834162717ULL);
}

TEST(Families, HaveThePromisedVerdicts) {
  for_each_family([&](const Family& family, Kind kind) {
    for (std::uint64_t parity = 0; parity < 2; ++parity) {
      std::size_t colliding = 0, apart = 0;
      for (std::uint64_t index = parity; index < 200; index += 2) {
        ++(make_query(family, kind, seed, index).collides ? colliding : apart);
      }
      EXPECT_EQ(colliding > 0, family.verdicts != Verdicts::no_collisions) << family.name;
      EXPECT_EQ(apart > 0, family.verdicts != Verdicts::collisions) << family.name;
    }
  });
}

TEST(Families, KnowTheToiOfNearlyAllCollisions) {
  const std::set<std::string_view> some_open{"interior-deforming", "tangential", "coplanar-instant",
                                             "scaled", "mixed-scales"};
  for_each_query(
      queries_a_family, [&](const Family& family, Kind, std::uint64_t, const KnownQuery& known) {
        EXPECT_TRUE(!known.toi || known.collides);
        EXPECT_TRUE(!known.contact || known.toi);
        EXPECT_TRUE(!known.separating_direction || !known.collides);
        EXPECT_TRUE(some_open.contains(family.name) || known.toi.has_value() == known.collides);
      });
}

TEST(Families, HaveFiniteCoordinates) {
  for_each_query(200, [](const Family&, Kind, std::uint64_t, const KnownQuery& known) {
    for (const double coordinate : known.query.coordinates) EXPECT_TRUE(std::isfinite(coordinate));
  });
}

TEST(Families, HaveFullSignificandsInHalfOfTheQueries) {
  for_each_query(
      tests::trials(1000), [](const Family&, Kind, std::uint64_t, const KnownQuery& known) {
        if (!known.full_significands) return;
        std::set<double> magnitudes;
        std::set<int> exponents;
        for (const double coordinate : known.query.coordinates) {
          if (coordinate == 0) continue;
          magnitudes.insert(std::abs(coordinate));
          exponents.insert(std::ilogb(coordinate));
        }
        const auto full = std::count_if(magnitudes.begin(), magnitudes.end(),
                                        [](double x) { return significand_bits(x) >= 45; });
        EXPECT_GT(2 * static_cast<std::size_t>(full), magnitudes.size());
        EXPECT_GE(exponents.size(), 2U);
      });
}

TEST(Families, HaveContactPointsThatAreRootsOfF) {
  std::size_t points = 0;
  for_each_query(
      queries_a_family, [&](const Family&, Kind kind, std::uint64_t, const KnownQuery& known) {
        if (!known.contact) return;
        const auto& [u, v] = *known.contact;
        const auto f = tests::contact_function<Rational>(kind, known.query, *known.toi, u, v);
        for (const Rational& component : f) EXPECT_EQ(component, 0);
        EXPECT_TRUE(u >= 0 && v >= 0);
        EXPECT_TRUE(kind == Kind::vertex_face ? u + v <= 1 : u <= 1 && v <= 1);
        ++points;
      });
  EXPECT_GT(points, tests::trials(800U));
}

TEST(Families, HaveSeparatingDirectionsThatSeparate) {
  std::size_t directions = 0;
  for_each_query(queries_a_family,
                 [&](const Family&, Kind kind, std::uint64_t, const KnownQuery& known) {
                   if (!known.separating_direction) return;
                   ++directions;
                   for (std::size_t end = 0; end < 2; ++end) {
                     for (const Corner& corner : corners(kind)) {
                       Rational value = 0;
                       for (std::size_t axis = 0; axis < 3; ++axis) {
                         value += Rational(known.separating_direction->at(axis)) *
                                  (Rational(known.query.at(end, corner.plus, axis)) -
                                   Rational(known.query.at(end, corner.minus, axis)));
                       }
                       EXPECT_GT(value, 0);
                     }
                   }
                 });
  EXPECT_GT(directions, tests::trials(200U));
}

TEST(Families, TellTheTruthAtRationalTimes) {
  std::mt19937_64 random(1);
  for_each_query(queries_a_family,
                 [&](const Family&, Kind kind, std::uint64_t, const KnownQuery& known) {
                   EXPECT_EQ(check_claim(kind, known, random), "");
                 });
}

TEST(Families, WouldBeCaughtWithAWrongClaim) {
  std::mt19937_64 random(2);
  std::size_t claims = 0;
  for_each_query(8, [&](const Family& family, Kind kind, std::uint64_t, const KnownQuery& known) {
    if (known.collides && known.toi) {
      KnownQuery late = known;
      late.toi = (*known.toi + 1) / 2;
      EXPECT_TRUE(*known.toi == 1 || !check_claim(kind, late, random).empty()) << family.name;
      if (*known.toi > 0) {
        KnownQuery early = known;
        early.toi = *known.toi * (1 - exact::power_of_two(-60));
        EXPECT_EQ(check_claim(kind, early, random), "no contact at the toi") << family.name;
      }
      ++claims;
    }
    if (!known.collides) {
      KnownQuery asserted = known;
      asserted.collides = true;
      asserted.toi = Rational(1, 2);
      EXPECT_EQ(check_claim(kind, asserted, random), "no contact at the toi");
      ++claims;
    }
  });
  EXPECT_GT(claims, 300U);
}

TEST(Families, PrintedQueriesAreThoseOfThePaper) {
  const auto query_of = [](std::string_view name) {
    return make_query(family_from_name(name), Kind::vertex_face, seed, 0);
  };
  const KnownQuery hourglass = query_of("hourglass");
  EXPECT_EQ(hourglass.query, (Query{{0.1, 0.1, 0.1, 0, 0, 1, 1, 0, 1, 0, 1, 1,  //
                                     0.1, 0.1, 0.1, 0, 0, 0, 0, 1, 0, 1, 0, 0}}));
  ASSERT_TRUE(hourglass.toi && hourglass.contact);
  EXPECT_EQ(*hourglass.toi, Rational(1 - Rational(0.1)));
  EXPECT_EQ((*hourglass.contact)[0], Rational(0.1));
  EXPECT_EQ((*hourglass.contact)[1], Rational(0.1));

  const KnownQuery inflection = query_of("inflection");
  EXPECT_EQ(inflection.query, (Query{{1, 1, 0, 0, 0, 5,  2, 0, 2,  0, 1, 0,  //
                                      1, 1, 0, 0, 0, -1, 0, 0, -2, 0, 7, 0}}));
  EXPECT_FALSE(inflection.collides);

  const KnownQuery sliding = query_of("sliding-degenerate");
  EXPECT_EQ(sliding.query, (Query{{1, 0.5, 1, 0, 0.57, 1, 1, 0.57, 1, 1, 1.57, 1,  //
                                   1, 0.5, 1, 0, 0.28, 1, 1, 0.28, 1, 1, 1.28, 1}}));
  ASSERT_TRUE(sliding.toi.has_value());
  EXPECT_EQ(*sliding.toi,
            Rational((Rational(0.57) - Rational(0.5)) / (Rational(0.57) - Rational(0.28))));
}

TEST(Families, IsolatedInstantsHaveAVanishingDeterminantAndOneInstant) {
  const Family& family = family_from_name("isolated-instant");
  for (const Kind kind : kinds) {
    for (std::uint64_t index = 0; index < queries_a_family; ++index) {
      const KnownQuery known = make_query(family, kind, seed, index);
      const Corners c(kind, known.query);
      for (const Rational& t : sixteenths()) {
        const std::vector<Vector> w = c.at(t);
        EXPECT_EQ(dot(w[0], cross(w[1], w.back())), 0);
        const bool is_instant = known.collides && t == *known.toi;
        EXPECT_EQ(c.touch_at(t), is_instant);
      }
      if (!known.collides) continue;
      for (int k = 1; k <= 60; ++k) {
        EXPECT_FALSE(c.touch_at(Rational(*known.toi + (1 - *known.toi) * exact::power_of_two(-k))));
      }
    }
  }
}

TEST(Families, ExtremeRangeReachesBothEndsOfTheDoubles) {
  double largest = 0, smallest = 1;
  std::size_t overflows = 0;
  for (std::uint64_t index = 0; index < 200; ++index) {
    const Query query =
        make_query(family_from_name("extreme-range"), Kind::edge_edge, seed, index).query;
    double above = 0, below = 0;
    for (const double coordinate : query.coordinates) {
      above = std::max(above, coordinate);
      below = std::min(below, coordinate);
      if (coordinate != 0) smallest = std::min(smallest, std::abs(coordinate));
    }
    largest = std::max({largest, above, -below});
    if (std::isinf(above - below)) ++overflows;
  }
  EXPECT_GT(largest, 1.7e308);
  EXPECT_EQ(smallest, 0x1p-1074);
  EXPECT_GT(overflows, tests::trials(100U));
}

// ---- On curves ----------------------------------------------------------------------------------

/// Calls use(family, record) for the first queries of every family on curves and kind.
template <class Use>
void for_each_curved_query(std::uint64_t count, const Use& use) {
  for (const Family& family : curved_families()) {
    for (const Kind kind : kinds) {
      SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)));
      const auto source = open_family(family, kind, seed, count);
      EXPECT_EQ(source->name(), family.name);
      EXPECT_EQ(source->shape(), (QueryShape{kind, family.degree, family.is_rational}));
      std::uint64_t drawn = 0;
      while (const auto record = source->next()) {
        EXPECT_EQ(record->index, drawn++);
        use(family, *record);
      }
      EXPECT_EQ(drawn, count);
    }
  }
}

TEST(CurvedFamilies, AreFoundByNameAndByDegree) {
  std::set<std::string_view> names;
  for (const auto list : {families(), separation_families(), curved_families()}) {
    for (const Family& family : list) {
      EXPECT_TRUE(names.insert(family.name).second) << family.name;
      EXPECT_EQ(family_from_name(family.name).reason, family.reason);
    }
  }
  for (const Family& family : curved_families()) {
    EXPECT_THROW((void)make_query(family, Kind::edge_edge, seed, 0), std::invalid_argument);
  }
  const auto count = [](const std::vector<std::string>& degrees) {
    return families({}, degrees).size();
  };
  EXPECT_EQ(count({"1"}), families().size());
  EXPECT_EQ(count({"2"}), 7U);
  EXPECT_EQ(count({"rational", "3"}), 9U);
  EXPECT_EQ(count({"1", "2", "3", "rational"}), families().size() + curved_families().size());
}

/// As Families.DrawTheSameBitsEverywhere, with the times of impact. The oracle confirms verdicts
/// and times in certify_test.cpp.
TEST(CurvedFamilies, DrawTheSameBitsEverywhere) {
  std::uint64_t digest = 0xcbf29ce484222325ULL;
  const auto add = [&](double x) {
    digest = (digest ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3ULL;
  };
  for_each_curved_query(120, [&](const Family& family, const data::RecordedQuery& record) {
    EXPECT_EQ(record.collides, std::optional(family.verdicts == Verdicts::collisions));
    EXPECT_EQ(record.toi.has_value(), *record.collides);
    for (const double x : record.query.numbers()) add(x);
    add(record.toi ? record.toi->get_d() : -1.0);
  });
  EXPECT_EQ(digest, 10030151229226999845ULL);
}

// ---- Elements -----------------------------------------------------------------------------------

/// Six times the volume of a tetrahedron at time t.
Rational volume_at(const Query& tetrahedron, const Rational& t) {
  std::array<std::array<Rational, 3>, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::size_t point) {
        return Rational((1 - t) * Rational(tetrahedron.at(0, point, axis)) +
                        t * Rational(tetrahedron.at(1, point, axis)));
      };
      e.at(i).at(axis) = at(i + 1) - at(0);
    }
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
         e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/// The claim of one query, at rational times, by the oracle, and by the certified solver.
void expect_true_claim(Kind kind, const KnownQuery& known) {
  const Query element = to_tetrahedron(kind, known.query);
  const exact::Decision truth = exact::decide(kind, known.query);
  ASSERT_EQ(known.collides, truth.collides());
  const fast::CertifiedResult certified = fast::solve(kind, known.query, {.toi_tolerance = 0.0});
  ASSERT_EQ(certified.verdict, known.collides ? fast::Verdict::yes : fast::Verdict::no);
  if (known.toi) {
    ASSERT_EQ(*truth.toi, *known.toi);
    EXPECT_TRUE(*known.toi == 0 ? volume_at(element, 0) <= 0 : volume_at(element, *known.toi) == 0);
    EXPECT_LE(*known.toi, Rational(certified.toi_upper));
    EXPECT_TRUE(*known.toi == 0 || *known.toi > Rational(certified.toi_lower));
  }
  if (known.collides && !(known.toi && *known.toi > 0)) return;
  const Rational end = known.toi.value_or(Rational(1));
  for (int k = 0; k < (known.toi ? 8 : 9); ++k) {
    EXPECT_GT(volume_at(element, end * Rational(k, 8)), 0) << k;
  }
}

TEST(ElementFamilies, ClaimTheFirstTimeWithoutVolume) {
  for (const Family& family : element_families()) {
    EXPECT_EQ(family_from_name(family.name).reason, family.reason);
    EXPECT_FALSE(supports(family, Kind::vertex_face));
    for (const Kind kind : {Kind::tetrahedron, Kind::plane_triangle}) {
      std::uint64_t collisions = 0, full = 0;
      constexpr std::uint64_t count = tests::trials(240U);
      for (std::uint64_t index = 0; index < count; ++index) {
        SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)) + " " +
                     std::to_string(index));
        const KnownQuery known = make_query(family, kind, seed, index);
        EXPECT_TRUE(is_finite(known.query));
        expect_true_claim(kind, known);
        collisions += known.collides ? 1U : 0U;
        full += known.full_significands ? 1U : 0U;
      }
      EXPECT_EQ(full, count / 2);
      EXPECT_GT(collisions, count / 8) << family.name;
      EXPECT_EQ(collisions == count, family.verdicts == Verdicts::collisions) << family.name;
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::generate::families_test
