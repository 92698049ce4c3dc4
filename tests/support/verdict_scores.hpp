#pragma once

/// \file
/// Additions to baselines.hpp for baselines with verdicts alone.

#include <cmath>
#include <cstdint>

#include "fast/method.hpp"
#include "tests/support/baselines.hpp"
#include "tests/support/queries.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::tests {

/// The method's verdict on one query.
[[nodiscard]] inline fast::Verdict verdict_of(const fast::Method& method, const PosedQuery& posed,
                                              const fast::MethodOptions& options = {}) {
  return answer_to(method, posed, options).verdict;
}

/// True for yes or undecided.
[[nodiscard]] inline bool says_yes(const fast::Method& method, const PosedQuery& posed) {
  const fast::Verdict verdict = verdict_of(method, posed);
  return verdict == fast::Verdict::yes || verdict == fast::Verdict::undecided;
}

[[nodiscard]] inline bool truly_collides(const PosedQuery& posed) {
  return exact::decide(posed.kind, posed.query).collides();
}

/// The score on `count` random queries of a family of tests/support/queries.hpp.
[[nodiscard]] inline Score score_on(const fast::Method& method, Kind kind, Family family,
                                    std::uint64_t seed, int count) {
  Random random(seed);
  Score score;
  for (int i = 0; i < count; ++i) {
    const PosedQuery posed = random_query(random, kind, family);
    score.count(truly_collides(posed), says_yes(method, posed));
  }
  return score;
}

/// 1 + 2^-60, rounded in the mode of this thread's SSE unit (which std::fegetround does not
/// report): 1 for to nearest and downward.
[[nodiscard]] inline double one_and_a_little() {
  volatile double one = 1.0, little = 0x1p-60;
  return one + little;
}

/// A query of full significands that collides, its contact at a random time and place.
[[nodiscard]] inline PosedQuery random_hit(Random& random, Kind kind) {
  for (;;) {
    const PosedQuery posed{kind, near_contact_query(random, kind)};
    if (truly_collides(posed)) return posed;
  }
}

/// The query with every coordinate times 2^exponent, which changes no answer but for rounding.
[[nodiscard]] inline PosedQuery scaled(PosedQuery posed, int exponent) {
  for (double& x : posed.query.coordinates) x = std::ldexp(x, exponent);
  return posed;
}

}  // namespace touchstone::tests
