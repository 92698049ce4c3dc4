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

namespace touchstone::reproduction_of_claim {

// certified: false_positive. The primitives do not collide.
constexpr Kind kind = Kind::edge_edge;
constexpr fast::MethodOptions options{
      .tolerance = 0x1.0c6f7a0b5ed8dp-20,  // 1e-06
      .max_checks = 1000000,
      .separation = {.distance = 0x1.70a3d70a3d70ap-4,  // 0.09
                     .norm = Norm::l2},
      .t_max = 0x1p+0,  // 1
};
constexpr Separation separation = options.separation;
constexpr fast::Promise promise = fast::Promise::exact;
constexpr bool collides = false;
constexpr Query query{{
      0x0p+0, 0x0p+0, 0x0p+0,  // ea0 at t=0: (0, 0, 0)
      0x1p+2, 0x0p+0, 0x0p+0,  // ea1 at t=0: (4, 0, 0)
      0x1p+0, -0x1p+0, -0x1p+0,  // eb0 at t=0: (1, -1, -1)
      0x1p+0, 0x1.8p+1, -0x1p+0,  // eb1 at t=0: (1, 3, -1)
      0x0p+0, 0x0p+0, 0x0p+0,  // ea0 at t=1: (0, 0, 0)
      0x1p+2, 0x0p+0, 0x0p+0,  // ea1 at t=1: (4, 0, 0)
      0x1p+0, -0x1p+0, -0x1.999999999999ap-4,  // eb0 at t=1: (1, -1, -0.1)
      0x1p+0, 0x1.8p+1, -0x1.999999999999ap-4,  // eb1 at t=1: (1, 3, -0.1)
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

TEST(Reproduction, certified_false_positive_of_claim) {
  expect_no_fault(verify::solvers::find_method("certified"));
}

}  // namespace touchstone::reproduction_of_claim
