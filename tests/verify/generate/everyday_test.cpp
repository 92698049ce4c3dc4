#include "verify/generate/everyday.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <tuple>

#include "tests/support/trials.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::generate::everyday_test {
namespace {

constexpr std::array<ContactKind, 2> both_kinds{ContactKind::vertex_face, ContactKind::edge_edge};

template <class Use>
void for_each_query(Query (*make)(ContactKind, Random&), int count, const Use& use) {
  Random random(1);
  for (int i = 0; i < count; ++i) {
    const ContactKind kind = both_kinds.at(static_cast<std::size_t>(i % 2));
    use(kind, make(kind, random));
  }
}

TEST(ShortestDecimal, IsTheUsualNotation) {
  struct Row {
    double x;
    Decimal decimal;
  };
  for (const auto& [x, decimal] :
       {Row{0.1, {1, 1, -1}},
        {0.25, {25, 2, -2}},
        {300.0, {3, 1, 2}},
        {0.1 + 0.2, {30000000000000004, 17, -17}},
        {std::numeric_limits<double>::denorm_min(), {5, 1, -324}},
        {std::numeric_limits<double>::max(), {17976931348623157, 17, 292}}}) {
    const auto [digits, count, exponent] = shortest_decimal(x);
    EXPECT_EQ(std::tuple(digits, count, exponent),
              std::tuple(decimal.digits, decimal.count, decimal.exponent));
    EXPECT_EQ(from_decimal(digits, exponent), x);
  }
}

TEST(EverydayContact, IsContactAlways) {
  int at_start = 0, at_end = 0, shared = 0, count = 0;
  for_each_query(everyday_contact, tests::trials(4000), [&](ContactKind kind, const Query& query) {
    const exact::Decision verdict = exact::decide(kind, query);
    ASSERT_TRUE(verdict.collides());
    ++count;
    const double toi = verdict.toi->enclosure().lower;
    at_start += toi == 0.0 ? 1 : 0;
    at_end += toi == 1.0 ? 1 : 0;
    const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
    for (std::size_t a = 0; a < second; ++a) {
      for (std::size_t b = second; b < moving_points; ++b) {
        shared += point_of(query, 0, a) == point_of(query, 0, b) &&
                          point_of(query, 1, a) == point_of(query, 1, b)
                      ? 1
                      : 0;
      }
    }
  });
  EXPECT_GT(at_start, count / 3);
  EXPECT_GT(at_end, count / 5);
  EXPECT_GT(shared, count / 16);
}

TEST(EverydayNearContact, MostlyDoesNotCollideByAUnit) {
  int no_collisions = 0;
  for_each_query(everyday_near_contact, tests::trials(1000),
                 [&](ContactKind kind, const Query& query) {
                   no_collisions += exact::decide(kind, query).collides() ? 0 : 1;
                 });
  EXPECT_GT(no_collisions, tests::trials(1000) / 5);
  EXPECT_LT(no_collisions, tests::trials(1000));
}

}  // namespace
}  // namespace touchstone::verify::generate::everyday_test
