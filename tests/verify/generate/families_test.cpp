/// \file
/// The names and shapes of the built-in families, and their bits. BuiltInSet.AgreesWithTheOracle of
/// certify_test.cpp compares their verdicts and times.

#include "verify/generate/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/trials.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::generate::families_test {
namespace {

using exact::Rational;

constexpr std::uint64_t seed = 20211;
constexpr std::uint64_t queries_a_family = tests::trials(120U);
constexpr std::array<ContactKind, 2> kinds{ContactKind::vertex_face, ContactKind::edge_edge};

template <class Function>
void for_each_family(Function&& function) {
  for (const Family& family : families()) {
    for (const ContactKind kind : kinds) {
      if (supports(family, kind)) function(family, kind);
    }
  }
}

template <class Function>
void for_each_query(std::uint64_t count, Function&& function) {
  for_each_family([&](const Family& family, ContactKind kind) {
    for (std::uint64_t index = 0; index < count; ++index) {
      SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)) + " " +
                   std::to_string(index));
      function(family, kind, make_query(family, kind, seed, index));
    }
  });
}

TEST(Families, RejectUnknownNamesAndKinds) {
  const Family unknown{"no-such-family", "", Verdicts::both};
  EXPECT_THROW((void)family_from_name("no-such-family"), std::invalid_argument);
  EXPECT_THROW((void)supports(unknown, ContactKind::edge_edge), std::invalid_argument);
  EXPECT_THROW((void)make_query(unknown, ContactKind::edge_edge, 1, 0), std::invalid_argument);
  const Family& triangles = family_from_name("needle-triangle");
  EXPECT_TRUE(supports(triangles, ContactKind::vertex_face));
  EXPECT_FALSE(supports(triangles, ContactKind::edge_edge));
  EXPECT_THROW((void)make_query(triangles, ContactKind::edge_edge, 1, 0), std::invalid_argument);
  EXPECT_THROW((void)open_family(triangles, ContactKind::edge_edge, 1, 1), std::invalid_argument);
}

TEST(Families, HaveNoQueryTwice) {
  for_each_family([&](const Family& family, ContactKind kind) {
    std::set<std::array<double, 24>> seen;
    for (std::uint64_t index = 1; index < 400; index += 2) {
      EXPECT_TRUE(seen.insert(make_query(family, kind, seed, index).query.coordinates).second)
          << family.name << ' ' << index;
    }
  });
}

/// FNV-1a over the bits of numbers, to notice a change of a generator or different bits on another
/// machine.
void digest(std::uint64_t& sum, double x) {
  sum = (sum ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3ULL;
}
constexpr std::uint64_t empty_digest = 0xcbf29ce484222325ULL;

TEST(Families, DrawTheSameBitsEverywhere) {
  std::uint64_t sum = empty_digest;
  for_each_query(120, [&](const Family&, ContactKind, const KnownQuery& known) {
    for (const double x : known.query.coordinates) digest(sum, x);
  });
  EXPECT_EQ(sum, 2340645805834162717ULL);
}

/// Of queries of few bits and of others.
TEST(Families, HaveThePromisedVerdicts) {
  for (const auto list : {families(), cell_families()}) {
    for (const Family& family : list) {
      for (const AnyKind kind : all_kinds) {
        if (!supports(family, kind)) continue;
        for (std::uint64_t parity = 0; parity < 2; ++parity) {
          std::size_t colliding = 0, apart = 0;
          for (std::uint64_t index = parity; index < 200; index += 2) {
            const KnownQuery known = make_query(family, kind, seed, index);
            ++(known.collides ? colliding : apart);
            EXPECT_TRUE(parity == 0 || uses_full_significands(known.query)) << family.name;
          }
          EXPECT_EQ(colliding > 0, family.verdicts != Verdicts::no_collisions) << family.name;
          EXPECT_EQ(apart > 0, family.verdicts != Verdicts::collisions) << family.name;
        }
      }
    }
  }
}

TEST(Families, KnowTheTimesOfNearlyAllCollisions) {
  const std::set<std::string_view> some_open{"interior-deforming", "tangential", "coplanar-instant",
                                             "scaled", "mixed-scales"};
  for_each_query(queries_a_family, [&](const Family& family, ContactKind, const KnownQuery& known) {
    EXPECT_TRUE(known.collides || !known.toi);
    EXPECT_TRUE(some_open.contains(family.name) || known.toi.has_value() == known.collides);
  });
}

TEST(Families, PrintedQueriesAreThoseOfThePaper) {
  const auto query_of = [](std::string_view name) {
    return make_query(family_from_name(name), ContactKind::vertex_face, seed, 0);
  };
  const KnownQuery hourglass = query_of("hourglass");
  EXPECT_EQ(hourglass.query, (Query{{0.1, 0.1, 0.1, 0, 0, 1, 1, 0, 1, 0, 1, 1,  //
                                     0.1, 0.1, 0.1, 0, 0, 0, 0, 1, 0, 1, 0, 0}}));
  EXPECT_EQ(hourglass.toi, Rational(1 - Rational(0.1)));

  const KnownQuery inflection = query_of("inflection");
  EXPECT_EQ(inflection.query, (Query{{1, 1, 0, 0, 0, 5,  2, 0, 2,  0, 1, 0,  //
                                      1, 1, 0, 0, 0, -1, 0, 0, -2, 0, 7, 0}}));
  EXPECT_FALSE(inflection.collides);

  const KnownQuery sliding = query_of("sliding-degenerate");
  EXPECT_EQ(sliding.query, (Query{{1, 0.5, 1, 0, 0.57, 1, 1, 0.57, 1, 1, 1.57, 1,  //
                                   1, 0.5, 1, 0, 0.28, 1, 1, 0.28, 1, 1, 1.28, 1}}));
  EXPECT_EQ(sliding.toi,
            Rational((Rational(0.57) - Rational(0.5)) / (Rational(0.57) - Rational(0.28))));
}

TEST(Families, ExtremeRangeReachesBothEndsOfTheDoubles) {
  double largest = 0, smallest = 1;
  std::size_t overflows = 0;
  for (std::uint64_t index = 0; index < 200; ++index) {
    const Query query =
        make_query(family_from_name("extreme-range"), ContactKind::edge_edge, seed, index).query;
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

TEST(CurvedFamilies, AreFoundByNameAndByDegree) {
  std::set<std::string_view> names;
  for (const auto list : {families(), separation_families(), curved_families(), cell_families()}) {
    for (const Family& family : list) {
      EXPECT_TRUE(names.insert(family.name).second) << family.name;
      EXPECT_EQ(family_from_name(family.name).reason, family.reason);
    }
  }
  for (const Family& family : curved_families()) {
    EXPECT_THROW((void)make_query(family, ContactKind::edge_edge, seed, 0), std::invalid_argument);
  }
  const auto count = [](const std::vector<std::string>& degrees) {
    return families({}, degrees).size();
  };
  EXPECT_EQ(count({"1"}), families().size() + cell_families().size());
  EXPECT_EQ(count({"2"}), 7U);
  EXPECT_EQ(count({"rational", "3"}), 9U);
  EXPECT_EQ(count({"1", "2", "3", "rational"}),
            families().size() + curved_families().size() + cell_families().size());
}

/// With the times of impact.
TEST(CurvedFamilies, DrawTheSameBitsEverywhere) {
  std::uint64_t sum = empty_digest;
  for (const Family& family : curved_families()) {
    for (const ContactKind kind : kinds) {
      SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)));
      const auto source = open_family(family, kind, seed, 120);
      EXPECT_EQ(source->name(), family.name);
      EXPECT_EQ(source->shape(), (AnyShape{kind, family.degree, family.is_rational}));
      std::uint64_t drawn = 0;
      while (const auto record = source->next()) {
        EXPECT_EQ(record->index, drawn++);
        EXPECT_EQ(record->collides, std::optional(family.verdicts == Verdicts::collisions));
        EXPECT_EQ(record->toi.has_value(), *record->collides);
        for (const double x : record->query.numbers()) digest(sum, x);
        digest(sum, record->toi ? record->toi->get_d() : -1.0);
      }
      EXPECT_EQ(drawn, 120U);
    }
  }
  EXPECT_EQ(sum, 10030151229226999845ULL);
}

// ---- About a separation -------------------------------------------------------------------------

// The construction and the oracle for distances share no argument.

constexpr std::uint64_t queries_a_stream = 24;
/// Among them both ends of the range.
constexpr std::array<double, 10> distances{1e-2, 1e-8, 1e-16, 1e-30,     1e-100,
                                           1.25, 5.0,  21.0,  0x1p-1000, 0x1p1000};

/// Any less distance matters: the collisions are fewer and later. The verdicts are those promised.
TEST(SeparationFamilies, AgreeWithTheOracle) {
  std::size_t changed = 0;
  for (const double distance : distances) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Separation separation{.distance = distance, .norm = norm},
          less{.distance = std::nextafter(distance, 0.0), .norm = norm};
      for (const Family& family : separation_families()) {
        for (const ContactKind kind : kinds) {
          std::set<bool> verdicts;
          std::size_t times = 0, collisions = 0;
          for (std::uint64_t index = 0; index < queries_a_stream; ++index) {
            SCOPED_TRACE(::testing::Message() << family.name << ' ' << to_string(kind) << ' '
                                              << index << ' ' << judge::to_text(separation));
            const KnownQuery known = make_query(family, kind, seed, index, separation);
            const exact::Decision verdict = exact::decide(kind, known.query, separation);
            ASSERT_EQ(verdict.collides(), known.collides);
            if (known.toi) {
              ASSERT_TRUE(*verdict.toi == *known.toi);
            }
            const exact::Decision nearer = exact::decide(kind, known.query, less);
            ASSERT_LE(nearer.collides(), known.collides);
            if (known.toi && *known.toi > 0 && nearer.collides()) {
              ASSERT_TRUE(*nearer.toi > *known.toi);
            }
            changed += nearer.collides() != known.collides ? 1U : 0U;
            verdicts.insert(known.collides);
            times += known.toi ? 1U : 0U;
            collisions += known.collides ? 1U : 0U;
          }
          EXPECT_EQ(verdicts.size(), family.verdicts == Verdicts::both ? 2U : 1U) << family.name;
          EXPECT_GE(5 * times, collisions) << "those of the rest are irrational";
        }
      }
    }
  }
  EXPECT_GT(changed, 200U);
}

TEST(SeparationFamilies, OddQueriesHaveFullSignificands) {
  for (const Family& family : separation_families()) {
    std::size_t full = 0;
    for (std::uint64_t index = 1; index < 40; index += 2) {
      const KnownQuery known = make_query(family, ContactKind::edge_edge, seed, index,
                                          {.distance = 1e-8, .norm = Norm::linf});
      full += uses_full_significands(known.query) ? 1U : 0U;
    }
    // Points and segments that only the distance places have the digits of its multiples.
    EXPECT_GE(full, 4U) << family.name;
  }
}

TEST(SeparationFamilies, TheyNeedASeparationThatTheyCanDouble) {
  const Family& family = separation_families().front();
  for (const double distance : {0.0, 0x1p-1001, 0x1p1001}) {
    const Separation separation{.distance = distance, .norm = Norm::linf};
    EXPECT_FALSE(has_separation_families(separation));
    EXPECT_EQ(families(separation).size(), families().size());
    EXPECT_THROW((void)make_query(family, ContactKind::vertex_face, seed, 0, separation),
                 std::invalid_argument);
    EXPECT_THROW((void)open_family(family, ContactKind::vertex_face, seed, 1, separation),
                 std::invalid_argument);
  }
  EXPECT_EQ(families({.distance = 1.0, .norm = Norm::linf}).size(),
            families().size() + separation_families().size());
}

}  // namespace
}  // namespace touchstone::verify::generate::families_test
