/// \file
/// The families about a separation (verify/generate/families.hpp) against the oracle for distances,
/// for all kinds, norms and magnitudes of d. The construction and the oracle share no argument.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::generate::separation_families_test {
namespace {

constexpr std::uint64_t seed = 20211;
constexpr std::uint64_t queries_a_family = 16;
constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
constexpr std::array<double, 8> distances{1e-2, 1e-8, 1e-16, 1e-30, 1e-100, 1.25, 5.0, 21.0};

/// Calls function(family, kind, separation) for all combinations.
template <class Function>
void for_each_stream(const Function& function) {
  for (const double distance : distances) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Separation separation{.distance = distance, .norm = norm};
      for (const Family& family : separation_families()) {
        for (const Kind kind : kinds) function(family, kind, separation);
      }
    }
  }
}

template <class Function>
void for_each_query(const Function& function) {
  for_each_stream([&](const Family& family, Kind kind, const Separation& separation) {
    for (std::uint64_t index = 0; index < queries_a_family; ++index) {
      SCOPED_TRACE(std::string(family.name) + " " + std::string(to_string(kind)) + " " +
                   std::to_string(index) + " " + judge::to_text(separation));
      function(kind, separation, make_query(family, kind, seed, index, separation));
    }
  });
}

TEST(SeparationFamilies, TheOracleAgreesWithTheConstruction) {
  for_each_query([](Kind kind, const Separation& separation, const KnownQuery& known) {
    const exact::Decision verdict = exact::decide(kind, known.query, separation);
    ASSERT_EQ(verdict.collides(), known.collides);
    if (known.toi) {
      ASSERT_TRUE(*verdict.toi == *known.toi);
    }
  });
}

TEST(SeparationFamilies, TheOracleSeesAnyOtherDistance) {
  // A check that the distance matters to the queries of the agreement above.
  std::size_t changed = 0;
  for_each_query([&](Kind kind, const Separation& separation, const KnownQuery& known) {
    const Separation less{.distance = std::nextafter(separation.distance, 0.0),
                          .norm = separation.norm};
    const exact::Decision verdict = exact::decide(kind, known.query, less);
    ASSERT_LE(verdict.collides(), known.collides);
    if (known.toi && *known.toi > 0 && verdict.collides()) {
      ASSERT_TRUE(*verdict.toi > *known.toi);
    }
    changed += verdict.collides() != known.collides ? 1U : 0U;
  });
  EXPECT_GT(changed, 200U);
}

TEST(SeparationFamilies, EveryFamilyHasTheVerdictsItSays) {
  for_each_stream([](const Family& family, Kind kind, const Separation& separation) {
    std::set<bool> verdicts;
    std::size_t times = 0, collisions = 0;
    for (std::uint64_t index = 0; index < 60; ++index) {
      const KnownQuery known = make_query(family, kind, seed, index, separation);
      verdicts.insert(known.collides);
      times += known.toi ? 1U : 0U;
      collisions += known.collides ? 1U : 0U;
    }
    SCOPED_TRACE(std::string(family.name) + " " + judge::to_text(separation));
    EXPECT_EQ(verdicts.size(), family.verdicts == Verdicts::both ? 2U : 1U);
    EXPECT_GE(5 * times, collisions) << "those of the rest are irrational";
  });
}

TEST(SeparationFamilies, OddQueriesHaveFullSignificands) {
  for (const Family& family : separation_families()) {
    std::size_t full = 0;
    for (std::uint64_t index = 0; index < 40; ++index) {
      const KnownQuery known =
          make_query(family, Kind::edge_edge, seed, index, {.distance = 1e-8, .norm = Norm::linf});
      EXPECT_LE(known.full_significands, index % 2 == 1);
      full += known.full_significands ? 1U : 0U;
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
    EXPECT_THROW((void)make_query(family, Kind::vertex_face, seed, 0, separation),
                 std::invalid_argument);
    EXPECT_THROW((void)open_family(family, Kind::vertex_face, seed, 1, separation),
                 std::invalid_argument);
  }
  EXPECT_EQ(families({.distance = 1.0, .norm = Norm::linf}).size(),
            families().size() + separation_families().size());
}

TEST(SeparationFamilies, TheyReachToBothEndsOfTheirDistances) {
  for (const double distance : {0x1p-1000, 0x1p1000}) {
    for (const Family& family : separation_families()) {
      for (const Kind kind : kinds) {
        for (const Norm norm : {Norm::linf, Norm::l2}) {
          for (std::uint64_t index = 0; index < 4; ++index) {
            const Separation separation{.distance = distance, .norm = norm};
            const KnownQuery known = make_query(family, kind, seed, index, separation);
            ASSERT_EQ(exact::decide(kind, known.query, separation).collides(), known.collides)
                << family.name << ' ' << distance;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::generate::separation_families_test
