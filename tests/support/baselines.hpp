#pragma once

/// \file
/// Common parts of the tests of the baselines: the printed queries that distinguish the
/// methods, random queries with a collision in the middle, and a count of wrong answers.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::tests {

/// A query printed in the appendices of [wang2021], by the name of its family: the hourglass, two
/// vertices of a sinking face exchange places (contact at 0.9, up to the rounding of 0.1, and at
/// 0.5 the face is degenerate); the inflection, coplanar twice, never in contact;
/// sliding-degenerate, motion in a plane (the vertex meets a corner of the face at 7/29, about).
[[nodiscard]] inline PosedQuery printed_query(std::string_view family) {
  const auto known = verify::generate::make_query(verify::generate::family_from_name(family),
                                                  ContactKind::vertex_face, 1, 0);
  return {ContactKind::vertex_face, known.query};
}

[[nodiscard]] inline fast::Answer answer_to(const fast::Method& method, const PosedQuery& posed,
                                            const fast::MethodOptions& options = {}) {
  fast::Answer answer;
  method.solve(Queries(posed.kind, {&posed.query, 1}), {&answer, 1}, options);
  return answer;
}

// ---- Answers to single queries ------------------------------------------------------------------

/// A verdict, from ≤ toi_lower < to, and the number of checks.
struct Said {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr std::uint32_t any_number = std::numeric_limits<std::uint32_t>::max();

  fast::Verdict verdict;
  double from = -infinity, to = infinity;
  std::uint32_t checks = any_number;
};

[[nodiscard]] inline Said yes_at(double toi, std::uint32_t checks = Said::any_number) {
  return {fast::Verdict::yes, toi, std::nextafter(toi, 2.0), checks};
}

struct SaidRow {
  const char* method;
  PosedQuery query;
  Said said;
  bool is_wrong = false;  ///< a yes without a collision, or a no to one
  fast::MethodOptions options = {};
};

[[nodiscard]] inline fast::MethodOptions within(double distance) {
  return {.separation = {.distance = distance, .norm = Norm::l2}};
}

/// The method says so, and the oracle says whether it is wrong.
inline void expect_said(const fast::Method& method, const SaidRow& row) {
  SCOPED_TRACE(::testing::Message() << row.method << ' ' << row.query);
  const fast::Answer answer = answer_to(method, row.query, row.options);
  EXPECT_EQ(answer.verdict, row.said.verdict);
  if (row.said.to != Said::infinity) {
    EXPECT_TRUE(row.said.from <= answer.toi_lower && answer.toi_lower < row.said.to)
        << answer.toi_lower;
  }
  EXPECT_TRUE(answer.verdict == fast::Verdict::yes || std::isnan(answer.toi_lower));
  if (row.said.checks != Said::any_number) {
    EXPECT_EQ(answer.checks, row.said.checks);
  }
  const bool collides =
      exact::decide(row.query.kind, row.query.query, row.options.separation).collides();
  EXPECT_EQ(answer.verdict == (collides ? fast::Verdict::no : fast::Verdict::yes), row.is_wrong);
}

enum class Movement { independent, translation };

/// Random points in (−1,1), except that at t=1/2 the vertex is in the middle of the face, or the
/// edges' middles meet: contact in the interior for any rounding. Points move independently, or
/// each primitive translates.
[[nodiscard]] inline PosedQuery centre_hit(Random& random, ContactKind kind, Movement motion) {
  Query query{};
  for (double& x : query.coordinates) x = random.uniform(-1.0, 1.0);
  const bool is_face = kind == ContactKind::vertex_face;
  if (motion == Movement::translation) {
    for (const std::size_t point : {is_face ? 2U : 3U, 3U}) {
      point_of(query, 1, point) = point_of(query, 1, point == 3 && !is_face ? 2 : 1) +
                                  (point_of(query, 0, point) - point_of(query, 0, is_face ? 1 : 2));
    }
  }
  const auto middle = [&](std::size_t point) -> Eigen::Vector3d {
    return (point_of(query, 0, point) + point_of(query, 1, point)) / 2.0;
  };
  if (is_face) {
    const Eigen::Vector3d aim = (middle(1) + middle(2) + middle(3)) / 3.0;
    point_of(query, 1, 0) = 2.0 * aim - point_of(query, 0, 0);
    return {kind, query};
  }
  const Eigen::Vector3d step = middle(2) + middle(3) - (middle(0) + middle(1));
  for (const std::size_t point : {0U, 1U}) point_of(query, 1, point) += step;
  return {kind, query};
}

/// The number of centre hits, of this many, that a method denies.
[[nodiscard]] inline int missed_centre_hits(const fast::Method& method, ContactKind kind,
                                            Movement motion, const fast::MethodOptions& options,
                                            int count) {
  Random random(11);
  int missed = 0;
  for (int i = 0; i < count; ++i) {
    const fast::Answer answer = answer_to(method, centre_hit(random, kind, motion), options);
    missed += answer.verdict == fast::Verdict::no ? 1 : 0;
  }
  return missed;
}

/// Wrong and correct answers of a method.
struct Score {
  int collisions = 0;       ///< queries that collide
  int no_collisions = 0;    ///< queries that do not
  int false_negatives = 0;  ///< no, but they collide
  int false_positives = 0;  ///< yes, but they do not collide
  int late = 0;             ///< toi_lower above the exact time of impact
  int denied = 0;           ///< no
  int errors = 0;

  /// Adds the answer of a method with verdicts alone.
  void count(bool collides, bool yes) {
    ++(collides ? collisions : no_collisions);
    false_negatives += collides && !yes ? 1 : 0;
    false_positives += !collides && yes ? 1 : 0;
  }

  void add(const exact::Decision& truth, const fast::Answer& answer) {
    (truth.collides() ? collisions : no_collisions) += 1;
    if (answer.verdict == fast::Verdict::error) ++errors;
    if (answer.verdict == fast::Verdict::no) {
      ++denied;
      false_negatives += truth.collides() ? 1 : 0;
    }
    if (answer.verdict != fast::Verdict::yes) return;
    if (!truth.collides()) ++false_positives;
    if (truth.collides() && answer.toi_lower <= 1.0 &&
        *truth.toi < exact::Rational(answer.toi_lower)) {
      ++late;
    }
  }
};

/// The score on the built-in set, with this number of queries of each family and kind.
[[nodiscard]] inline Score score_on_families(const fast::Method& method,
                                             const fast::MethodOptions& options,
                                             std::uint64_t count) {
  constexpr std::uint64_t seed = 5;
  Score score;
  for (const verify::generate::Family& family : verify::generate::families()) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t index = 0; index < count; ++index) {
        const Query query = verify::generate::make_query(family, kind, seed, index).query;
        score.add(exact::decide(kind, query), answer_to(method, {kind, query}, options));
      }
    }
  }
  return score;
}

/// The score on random queries, with this number of each family (queries.hpp) and kind.
[[nodiscard]] inline Score score_on_random(const fast::Method& method,
                                           const fast::MethodOptions& options, int count) {
  Random random(7);
  Score score;
  for (const Family family : all_families) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      for (int i = 0; i < count; ++i) {
        const PosedQuery posed = random_query(random, kind, family);
        score.add(exact::decide(kind, posed.query), answer_to(method, posed, options));
      }
    }
  }
  return score;
}

/// The score on public data below a folder, for every `stride`-th query of a kind; empty if the
/// data is missing.
[[nodiscard]] inline Score score_on_public_data(const fast::Method& method,
                                                const fast::MethodOptions& options,
                                                const std::string& folder, ContactKind kind,
                                                std::uint64_t stride) {
  Score score;
  for (const auto& file : public_datasets()) {
    if (file.string().find("/" + folder + "/") == std::string::npos) continue;
    const auto source = verify::data::open_dataset(file);
    if (source->kind() != kind) continue;
    while (const auto recorded = source->next()) {
      if (recorded->index % stride != 0) continue;
      const PosedQuery posed{kind, recorded->query.straight()};
      score.add(exact::decide(kind, posed.query), answer_to(method, posed, options));
    }
  }
  return score;
}

// ---- Baselines with verdicts alone --------------------------------------------------------------

/// True for yes or undecided.
[[nodiscard]] inline bool says_yes(const fast::Method& method, const PosedQuery& posed) {
  const fast::Verdict verdict = answer_to(method, posed).verdict;
  return verdict == fast::Verdict::yes || verdict == fast::Verdict::undecided;
}

[[nodiscard]] inline bool truly_collides(const PosedQuery& posed) {
  return exact::decide(posed.kind, posed.query).collides();
}

/// The score on `count` random queries of a family of tests/support/queries.hpp.
[[nodiscard]] inline Score score_on(const fast::Method& method, ContactKind kind, Family family,
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
[[nodiscard]] inline PosedQuery random_hit(Random& random, ContactKind kind) {
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
