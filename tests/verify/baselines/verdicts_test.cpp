/// \file
/// The answers of baselines to bad input, and after exceptions.

#include "verify/baselines/verdicts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cfenv>
#include <limits>
#include <new>
#include <stdexcept>

#include "tests/support/queries.hpp"
#include "tests/support/verdict_scores.hpp"

namespace touchstone::baselines::verdicts_test {
namespace {

constexpr auto always = [](Kind, const Query&) { return true; };
constexpr auto never = [](Kind, const Query&) { return false; };

TEST(Verdicts, AreThoseOfTheFunction) {
  const Query query = tests::over_triangle(1, 1, 1, -1).query;
  EXPECT_EQ(verdict_of(Kind::vertex_face, query, always), fast::Verdict::yes);
  EXPECT_EQ(verdict_of(Kind::vertex_face, query, never), fast::Verdict::no);
  const auto is_edge_edge = [](Kind kind, const Query&) { return kind == Kind::edge_edge; };
  EXPECT_EQ(verdict_of(Kind::vertex_face, query, is_edge_edge), fast::Verdict::no);
  EXPECT_EQ(verdict_of(Kind::edge_edge, query, is_edge_edge), fast::Verdict::yes);
}

TEST(Verdicts, InfiniteOrNaNIsAnError) {
  for (std::size_t i = 0; i < 24; ++i) {
    for (const double bad : {std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(), fast::Answer::none}) {
      Query query = tests::over_triangle(1, 1, 1, -1).query;
      query.coordinates[i] = bad;
      EXPECT_EQ(verdict_of(Kind::vertex_face, query, always), fast::Verdict::error);
    }
  }
}

TEST(Verdicts, WhatIsThrownIsACollision) {
  const Query query{};
  EXPECT_EQ(verdict_of(Kind::vertex_face, query,
                       [](Kind, const Query&) -> bool { throw std::domain_error("inflection"); }),
            fast::Verdict::yes);
  EXPECT_EQ(verdict_of(Kind::vertex_face, query, [](Kind, const Query&) -> bool { throw 1; }),
            fast::Verdict::yes);
  EXPECT_THROW(
      static_cast<void>(verdict_of(Kind::vertex_face, query,
                                   [](Kind, const Query&) -> bool { throw std::bad_alloc(); })),
      std::bad_alloc);
}

TEST(Answers, AreGivenInOrderAndRoundedToNearest) {
  std::array<Query, 3> queries{};
  for (std::size_t i = 0; i < 3; ++i) queries[i].coordinates[0] = static_cast<double>(i);
  std::array<fast::Answer, 3> answers;
  std::fesetround(FE_UPWARD);
  bool is_to_nearest = true;
  answer_each(Kind::edge_edge, queries, answers, [&](Kind, const Query& query) {
    is_to_nearest = is_to_nearest && tests::one_and_a_little() == 1.0;
    return query.coordinates[0] == 1.0;
  });
  const double after = tests::one_and_a_little();
  std::fesetround(FE_TONEAREST);
  EXPECT_TRUE(is_to_nearest);
  EXPECT_GT(after, 1.0);
  EXPECT_EQ(answers[0].verdict, fast::Verdict::no);
  EXPECT_EQ(answers[1].verdict, fast::Verdict::yes);
  EXPECT_EQ(answers[2].verdict, fast::Verdict::no);
  for (const fast::Answer& answer : answers) {
    EXPECT_TRUE(std::isnan(answer.toi_lower) && std::isnan(answer.toi_upper));
    EXPECT_TRUE(std::isnan(answer.tolerance));
  }
}

}  // namespace
}  // namespace touchstone::baselines::verdicts_test
