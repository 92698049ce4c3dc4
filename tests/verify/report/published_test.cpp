#include "verify/report/published.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

namespace touchstone::verify::report::published_test {
namespace {

constexpr std::array<std::string_view, 2> datasets{"handcrafted", "simulation"};
constexpr std::array<Kind, 2> kinds{Kind::vertex_face, Kind::edge_edge};

TEST(Published, TableOneHasItsNineMethodsOnAllFourSets) {
  for (const std::string_view dataset : datasets) {
    for (const Kind kind : kinds) {
      for (const std::string_view method :
           {"irf", "uirf", "fprf", "tccd", "rp", "rrp", "bsc", "msrf", "tight_inclusion"}) {
        EXPECT_TRUE(published_field(dataset, kind, method).has_value()) << dataset << method;
      }
      EXPECT_FALSE(published_field(dataset, kind, "certified").has_value());
      EXPECT_FALSE(published_field(dataset, kind, "accd").has_value()) << "of a later year";
    }
  }
}

TEST(Published, NumbersAreAsPrinted) {
  const auto tccd = published_field("simulation", Kind::edge_edge, "tccd");
  ASSERT_TRUE(tccd.has_value());
  EXPECT_EQ(tccd->microseconds, "0.23");
  EXPECT_EQ(tccd->false_positives, "82277");
  EXPECT_EQ(tccd->false_negatives, "0");
  const auto msrf = published_separation("handcrafted", Kind::vertex_face, "msrf", 1e-30);
  ASSERT_TRUE(msrf.has_value());
  EXPECT_EQ(msrf->microseconds, "13.59");
  EXPECT_EQ(msrf->false_negatives, "141");
  EXPECT_EQ(published_size("handcrafted", Kind::edge_edge), "15K");
}

TEST(Published, WhatIsSimulatedHereStandsBesideTheSimulations) {
  EXPECT_EQ(published_size("own-simulation", Kind::edge_edge), "41M");
  EXPECT_EQ(published_field("own-simulation", Kind::edge_edge, "tccd")->false_positives, "82277");
  EXPECT_EQ(
      published_separation("own-simulation", Kind::vertex_face, "msrf", 1e-2)->false_negatives,
      published_separation("simulation", Kind::vertex_face, "msrf", 1e-2)->false_negatives);
  EXPECT_EQ(published_size("another", Kind::vertex_face), "");
}

TEST(Published, TablesOverTheSeparationHaveFiveDistances) {
  for (const std::string_view dataset : datasets) {
    for (const Kind kind : kinds) {
      for (const std::string_view method : {"msrf", "fprf", "tight_inclusion"}) {
        for (const double distance : {1e-2, 1e-8, 1e-16, 1e-30, 1e-100}) {
          EXPECT_TRUE(published_separation(dataset, kind, method, distance).has_value())
              << dataset << method << distance;
        }
        EXPECT_FALSE(published_separation(dataset, kind, method, 1.0).has_value());
      }
    }
  }
}

TEST(Published, OtherDataAreNotInIt) {
  EXPECT_EQ(published_size("patches", Kind::vertex_face), "");
  EXPECT_FALSE(published_field("patches", Kind::vertex_face, "rp").has_value());
}

}  // namespace
}  // namespace touchstone::verify::report::published_test
