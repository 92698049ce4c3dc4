// Written by touchstone.
// clang-format off
#include <gtest/gtest.h>

#include <cmath>

#include "exact/oracle.hpp"
#include "exact/query.hpp"
#include "fast/method.hpp"
#include "verify/judge/claimed_distance.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judge.hpp"
#include "verify/solvers/plugin.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::reproduction_of_miss {

// tight_inclusion: false_negative. The primitives collide.
constexpr Kind kind = Kind::vertex_face;
constexpr fast::MethodOptions options{
      .tolerance = 0x1p-3,  // 0.125
      .max_checks = 77,
      .separation = {.distance = 0x0p+0,  // 0
                     .norm = Norm::linf},
      .t_max = 0x1p+0,  // 1
};
constexpr Separation separation = options.separation;
constexpr fast::Promise promise = fast::Promise::conservative;
constexpr bool collides = true;
constexpr Query query{{
      0x1p+0, 0x1p+0, 0x1p+0,  // v at t=0: (1, 1, 1)
      0x0p+0, 0x0p+0, 0x0p+0,  // f0 at t=0: (0, 0, 0)
      0x1p+2, 0x0p+0, 0x0p+0,  // f1 at t=0: (4, 0, 0)
      0x0p+0, 0x1p+2, 0x0p+0,  // f2 at t=0: (0, 4, 0)
      0x1p+0, 0x1p+0, -0x1p+1,  // v at t=1: (1, 1, -2)
      0x0p+0, 0x0p+0, 0x0p+0,  // f0 at t=1: (0, 0, 0)
      0x1p+2, 0x0p+0, 0x0p+0,  // f1 at t=1: (4, 0, 0)
      0x0p+0, 0x1p+2, 0x0p+0,  // f2 at t=1: (0, 4, 0)
}};

/// Asks the method and holds its answer against the oracle, and against what the method is held to.
void expect_no_fault(const fast::Method& method) {
  fast::Answer answer;
  method.solve(kind, {&query, 1}, {&answer, 1}, options);
  const exact::Verdict truth = exact::decide(kind, query, separation);
  EXPECT_EQ(truth.collides(), collides);
  verify::judge::Judgement judgement;
  judgement.add(verify::judge::truth_of(0, truth), answer);
  if (answer.verdict == fast::Verdict::yes) {
    const Separation near =
        verify::judge::claimed_distance(method.info().filter, kind, query, answer, separation);
    EXPECT_TRUE(!is_valid(near) || exact::decide(kind, query, near).collides());
  }
  for (const verify::judge::WrongAnswer& wrong : judgement.wrong_answers) {
    EXPECT_FALSE(verify::judge::breaks(wrong.fault, promise))
        << verify::judge::to_string(wrong.fault) << ": " << wrong.answer << ", but " << wrong.truth;
  }
}

TEST(Reproduction, tight_inclusion_false_negative_of_miss) {
  expect_no_fault(verify::solvers::find_method("tight_inclusion"));
}

}  // namespace touchstone::reproduction_of_miss
