#include "verify/data/query_group.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/memory_source.hpp"

namespace touchstone::verify::data::query_group_test {
namespace {

Query query_number(double number) {
  Query query{};
  query.coordinates[0] = number;
  return query;
}

/// Queries with these indices, each with its index as first coordinate.
std::vector<RecordedQuery> recorded(const std::vector<std::uint64_t>& indices) {
  std::vector<RecordedQuery> queries;
  queries.reserve(indices.size());
  for (const std::uint64_t index : indices) {
    queries.push_back(
        {{Kind::edge_edge, query_number(static_cast<double>(index))}, index, std::nullopt, {}});
  }
  return queries;
}

void read(QueryGroup& group, QuerySource& source) {
  group.read(
      source, [](double) {}, [] { return false; });
}

TEST(QueryGroup, KnowsWhereItsQueriesComeFrom) {
  tests::MemorySource first(Kind::edge_edge, recorded({0, 1, 4, 5}));
  tests::MemorySource second(Kind::edge_edge, recorded({0, 7}));
  QueryGroup group("both", Kind::edge_edge);
  read(group, first);
  read(group, second);
  EXPECT_EQ(group.name(), "both");
  EXPECT_EQ(group.kind(), Kind::edge_edge);
  ASSERT_EQ(group.queries().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const QueryPlace place = group.place_of(i);
    EXPECT_EQ(place.source, "memory");
    EXPECT_EQ(static_cast<double>(place.index), group.queries().row(i)[0]) << i;
  }
}

TEST(QueryGroup, RefusesAnotherKind) {
  tests::MemorySource source(Kind::edge_edge, recorded({0}));
  QueryGroup group("vertices", Kind::vertex_face);
  EXPECT_THROW(read(group, source), std::invalid_argument);
  EXPECT_TRUE(group.queries().empty());
}

TEST(QueryGroup, PassesErrorsOnAndKeepsWhatItHas) {
  tests::MemorySource source(Kind::vertex_face, recorded({0, 1, 2}));
  source.fail_at(2, "broken");
  QueryGroup group("broken", Kind::vertex_face);
  EXPECT_THROW(read(group, source), std::runtime_error);
  EXPECT_EQ(group.queries().size(), 2U);
}

TEST(QueryGroup, StopsReadingWhenAskedAndTellsHowFarItIs) {
  std::vector<std::uint64_t> indices(20'000);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
  tests::MemorySource source(Kind::vertex_face, recorded(indices));
  QueryGroup group("large", Kind::vertex_face);
  std::vector<double> told;
  group.read(
      source, [&](double fraction) { told.push_back(fraction); }, [&] { return told.size() == 2; });
  ASSERT_EQ(told.size(), 2U);
  EXPECT_LT(told[0], told[1]);
  EXPECT_EQ(static_cast<double>(group.queries().size()) / 20'000.0, told[1]);
}

TEST(QueryGroup, HasADigestOfItsQueriesInTheirOrder) {
  const Query zero{}, one{{1}};
  const auto digest = [](const std::vector<Query>& queries) {
    return QueryGroup("a", Kind::vertex_face, queries).digest();
  };
  // The digest of no data is the published offset basis of FNV-1a.
  EXPECT_EQ(digest({}), 0xcbf29ce484222325U);
  EXPECT_EQ(digest({zero, one}), digest({zero, one}));
  EXPECT_NE(digest({zero, one}), digest({one, zero}));
  EXPECT_NE(digest({zero}), digest({Query{{-0.0}}}));
  EXPECT_NE(digest({zero}), digest({zero, zero}));
}

}  // namespace
}  // namespace touchstone::verify::data::query_group_test
