/// \file
/// The exact stage: what was once slow or wrong in it, and planted faults. (deciders_test.cpp
/// compares it with the oracle on all families.)

#include "fast/certified/exact/exact_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <tuple>
#include <vector>

#include "fast/certified/block.hpp"
#include "tests/faults/limb_products.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast::exact_stage_test {
namespace {

using tests::PosedQuery;

constexpr std::array<ContactKind, 2> kinds{ContactKind::vertex_face, ContactKind::edge_edge};
constexpr std::array<Norm, 2> norms{Norm::linf, Norm::l2};

/// A query at a separation, and the oracle's answer.
struct Asked {
  PosedQuery posed;
  Separation separation = {};
  exact::Decision truth = exact::decide(posed.kind, posed.query, separation);
};

// ---- Found by the fuzzer ------------------------------------------------------------------------

/// Queries whose determinant has a root at t=1/2 or 3/4, outside the domain, and another just
/// before it, nearer with each of these nudges.
std::vector<Asked> neighbouring_roots() {
  const Query edges{{0.0,    0.0,    -0.875, 0.125,  -1.125, 0.0,    -1.125, -2.375,
                     -0.875, 3.4375, 5.25,   2.375,  0.125,  0.0,    0.875,  0.0,
                     1.125,  0.0,    -1.0,   -1.125, -0.875, 3.4375, 5.25,   2.875}};
  const Query face{{-0.75,     0.0,       0.0,  -2.25,     0.046875, -2.25,    0.0, -0.1171875,
                    2.25,      0.0078125, 2.25, 0.0,       0.25,     -0.03125, 0.0, 0.75,
                    -0.046875, 0.75,      0.0,  0.0078125, -0.75,    0.0,      0.0, 0.0}};
  std::vector<Asked> result;
  for (int nudge = 1; nudge <= 64; ++nudge) {
    PosedQuery of_edges{ContactKind::edge_edge, edges}, of_face{ContactKind::vertex_face, face};
    of_edges.query.coordinates[23] -= nudge * 0x1p-48;
    of_face.query.coordinates[13] += nudge * 0x1p-48;
    result.push_back({of_edges});
    result.push_back({of_face});
  }
  return result;
}

/// A query whose first form has a root just before t=1; a later form is negative for a while before
/// that.
Asked dipping_query() {
  return {tests::edge_edge({0, 3, -3, -8, 7, 9, 0, 0, 0, 1, -1, -5},
                           {0x1.8000000002316p+0, -0x1.800000000694p+0, -0x1.c000000001764p+2,
                            -0x1.8000000000bb2p+3, 0x1.300000000074fp+3, 0x1.bfffffffff44ep+2, 0, 0,
                            0, 1, -0x1.400000000118bp+1, -0x1.7ffffffffe89cp+1}),
          {2.0, Norm::linf}};
}

/// The number of wrong answers.
std::ptrdiff_t wrong_answers(tests::DecideExactly& decide, const std::vector<Asked>& all,
                             double tolerance = 1e-12) {
  return std::ranges::count_if(all, [&](const Asked& asked) {
    const auto& [posed, separation, truth] = asked;
    const CertifiedOptions options{.toi_tolerance = tolerance, .separation = separation};
    const auto impact = decide(posed.kind, posed.query, separation, tolerance, 1.0);
    return tests::fault(posed.kind, truth, result_of(impact), options).has_value();
  });
}

TEST(ExactStage, SeparatesARootFromOneBesideItAndSeesADip) {
  std::vector<Asked> all = neighbouring_roots();
  EXPECT_GT(std::ranges::count_if(all, [](const Asked& one) { return one.truth.collides(); }), 64);
  all.push_back(dipping_query());
  for (const double tolerance : {0.0, 1e-12, 0.1, 1e300}) {
    EXPECT_EQ(wrong_answers(decide_exactly, all, tolerance), 0) << tolerance;
  }
}

// ---- Work ---------------------------------------------------------------------------------------

/// Queries whose roots are almost equal: tiny coordinates among those that nearly overflow make
/// roots that differ by parts of 2^-2000, 2^-4000 and so on. Each once took seconds or more.
struct Slow {
  PosedQuery posed;
  Separation separation;
  std::optional<double> toi_upper;  ///< from an earlier bisection in integers
};

std::vector<Slow> slow_queries() {
  constexpr double s = 0x1p-1074, l = 0x1p1022;
  return {
      {tests::vertex_face({s, -l, -l, -l, l, -s, -l, s, s, l, -s, -l},
                          {-l, s, -s, -s, -l, -s, -s, l, s, s, l, l}),
       {l, Norm::l2},
       0x1.9c3be0c5b2633p-2},
      {tests::edge_edge({-s, -l, s, l, -l, s, l, s, l, l, s, s},
                        {-s, l, l, -l, s, -s, -l, -s, s, -s, -s, s}),
       {0x1p-942, Norm::linf},
       0.5},
      {tests::vertex_face({0, -l, 0, -s, 0, s, 0, -l, -l, 0, 0, 0},
                          {-l, 0, 0, l, 0, 0, 0, 0, 0, 0, s, l}),
       {0x1p-496, Norm::l2},
       std::nullopt},
      {tests::edge_edge({0, 0, 0x1.ep977, 0x1.4p-1000, 0x1.ap949, 0, 0, 0, -0x1.8p-999, 0, 0, 0},
                        {0, 0, -0x1.ap-981, -0x1.ap988, -0x1p904, 0, 0, 0, 0, -0x1.8p-999,
                         -0x1.ap988, -0x1.ep1003}),
       {0x1.ep454, Norm::l2},
       1.0},
      {tests::edge_edge(
           {0, -2 * s, -1.5 * l, 1.875 * l, 0, -2 * s, 0, -2 * s, -2 * s, 0, 0, -1.125 * l},
           {l, 0, -2 * s, -s, 0, 0, -2 * s, 0, 0, -2 * s, l, 0}),
       {0x1.ap-903, Norm::l2},
       1.0},
      {tests::vertex_face({-l, -l, s, -s, l, s, l, l, -s, s, s, -l},
                          {-s, -s, l, l, s, -s, -s, s, s, l, l, l}),
       {0x1p-685, Norm::l2},
       std::nullopt},
      {tests::edge_edge({-1.375, 0, 0, 0, 0, 0, 0, 0, -1.625, 0, 1, 0},
                        {1.25, 0, 0, 0, 0, 0, 0, 0, 0, -1.5, -1.375, 0}),
       {0x1.8p-481, Norm::l2},
       1.0}};
}

TEST(ExactStage, RootsThatAreHardlyApartTakeFewSteps) {
  constexpr std::uint64_t most = 400'000'000;  // less than half a second
  for (const auto& [posed, separation, toi_upper] : slow_queries()) {
    const auto impact = decide_exactly(posed.kind, posed.query, separation, 0.0, 1.0);
    ASSERT_EQ(impact.has_value(), toi_upper.has_value()) << posed;
    if (impact) {
      EXPECT_EQ(impact->toi_upper, *toi_upper) << posed;
    }
    for (const auto& counting : tests::planted_faults().counting) {
      tests::limb_products = 0;
      static_cast<void>(counting.part(posed.kind, posed.query, separation, 0.0, 1.0));
      EXPECT_LE(tests::limb_products, most) << posed;
      EXPECT_GT(tests::limb_products, 0U);
    }
  }
}

// ---- Planted faults -----------------------------------------------------------------------------

/// Queries in contact of each family.
std::vector<Asked> of_families() {
  std::vector<Asked> result;
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const ContactKind kind : kinds) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t i = 0; i < 50; ++i) {
        result.push_back({{kind, verify::generate::make_query(family, kind, 5, i).query}});
      }
    }
  }
  return result;
}

/// Small integers, at tiny distances and with contact near the distance.
std::vector<Asked> of_integers() {
  tests::Random random(8);
  std::vector<Asked> result;
  for (int i = 0; i < 400; ++i) {
    const PosedQuery posed{kinds[random.bits() % 2], tests::integer_query(random, 3)};
    result.push_back({posed, {i % 4 == 0 ? 1e-40 : 0.8, norms[random.bits() % 2]}});
  }
  return result;
}

TEST(ExactStage, PlantedFaultsAreFoundAndNoOthers) {
  const std::vector<Asked> families = of_families(), integers = of_integers(),
                           neighbours = neighbouring_roots(), dip{dipping_query()};
  EXPECT_EQ(wrong_answers(decide_exactly, families), 0);
  EXPECT_EQ(wrong_answers(decide_exactly, integers), 0);
  for (const auto& fault : tests::planted_faults().exact_stage) {
    const bool is_separated = fault.separation.distance > 0.0;
    const auto found = wrong_answers(*fault.part, is_separated ? integers : families),
               once = wrong_answers(*fault.part, is_separated ? dip : neighbours);
    std::printf("%s: %td wrong answers, and %td to what the fuzzer found\n", fault.name.data(),
                found, once);
    EXPECT_TRUE(found > 0 || once > (is_separated ? 0 : 32)) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::exact_stage_test
