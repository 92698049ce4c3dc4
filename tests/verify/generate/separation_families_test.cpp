/// \file
/// The families about a separation (verify/generate/families.hpp) against the oracle for distances,
/// for all kinds, norms and magnitudes of d. The construction and the oracle share no argument.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::generate::separation_families_test {
namespace {

constexpr std::uint64_t seed = 20211;
constexpr std::uint64_t queries_a_stream = 24;
constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};
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
        for (const Kind kind : kinds) {
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

}  // namespace
}  // namespace touchstone::verify::generate::separation_families_test
