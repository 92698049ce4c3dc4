/// \file
/// The answers of baselines after exceptions, and their rounding.

#include "verify/baselines/verdicts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cfenv>
#include <new>
#include <stdexcept>

#include "tests/support/verdict_scores.hpp"

namespace touchstone::baselines::verdicts_test {
namespace {

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
}

}  // namespace
}  // namespace touchstone::baselines::verdicts_test
