#pragma once

/// \file
/// How the tests of baselines count wrong answers: against the oracle, on the queries that the
/// published comparison prints, on random ones and on the public data.

#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string_view>

#include "exact/oracle.hpp"
#include "exact/query.hpp"
#include "fast/method.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "verify/families/families.hpp"

namespace touchstone::tests {

/// A query printed in the appendices of Wang et al. 2021, by the name of its family: "hourglass" (a
/// hit), "inflection" (a miss), "sliding-degenerate" (a hit).
[[nodiscard]] inline PosedQuery printed_query(std::string_view family) {
  const auto known = verify::make_query(verify::family_from_name(family), Kind::vertex_face, 1, 0);
  return {Kind::vertex_face, known.query};
}

/// The method's verdict on one query.
[[nodiscard]] inline fast::Verdict verdict_of(const fast::Method& method, const PosedQuery& posed,
                                              const fast::MethodOptions& options = {}) {
  std::array<fast::Answer, 1> answer;
  method.solve(posed.kind, {&posed.query, 1}, answer, options);
  return answer[0].verdict;
}

/// Does it say yes? (Or cannot say, which counts as yes.)
[[nodiscard]] inline bool says_yes(const fast::Method& method, const PosedQuery& posed) {
  const fast::Verdict verdict = verdict_of(method, posed);
  return verdict == fast::Verdict::yes || verdict == fast::Verdict::undecided;
}

[[nodiscard]] inline bool truly_collides(const PosedQuery& posed) {
  return exact::decide(posed.kind, posed.query).collides();
}

/// What there was and what was wrong.
struct Score {
  int hits = 0;
  int misses = 0;
  int false_negatives = 0;
  int false_positives = 0;

  void count(bool collides, bool yes) {
    ++(collides ? hits : misses);
    false_negatives += collides && !yes ? 1 : 0;
    false_positives += !collides && yes ? 1 : 0;
  }
  friend std::ostream& operator<<(std::ostream& out, const Score& score) {
    return out << score.hits << " hits with " << score.false_negatives << " FN, " << score.misses
               << " misses with " << score.false_positives << " FP";
  }
};

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

/// The score on the public handcrafted queries of a kind; nothing where they are missing.
[[nodiscard]] inline Score score_on_handcrafted(const fast::Method& method, Kind kind) {
  Score score;
  for (const auto& file : public_datasets()) {
    if (file.string().find("handcrafted") == std::string::npos) continue;
    const auto source = verify::open_dataset(file);
    if (source->kind() != kind) continue;
    while (const auto recorded = source->next()) {
      const PosedQuery posed{kind, recorded->query};
      score.count(truly_collides(posed), says_yes(method, posed));
    }
  }
  return score;
}

/// 1 + 2^-60, rounded in the mode that this thread's SSE unit has (which std::fegetround does not
/// tell): 1 to nearest and downward.
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
