#pragma once

/// \file
/// The scheduler directs the search to generators that bring new results.
///
/// Queries are classified by a *coverage key*: the stage at which the judge decided, the time of
/// impact, the distance of the answer from it, and so on. A query of a rare class is worth more
/// than one of a frequent class. The *scheduler* is a bandit: it draws arms (generators) with a
/// probability that grows with their reward per work, with the most weight on recent work. Every
/// arm keeps a small share, so that late rewards are found; arms with more important findings keep
/// a greater one.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"
#include "verify/fuzz/generators.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

/// The coverage key. That of two queries is the same if these agree: the shape; the stage and
/// verdict of the judge; the verdict of the answer; to a factor of 256 the time of impact, or its
/// distance from 1 if that is less; to a factor of 4 the distance of toi_lower below it, and the
/// tolerance of the answer; whether the contact is on the boundary of (u,v); the number of zero
/// coordinates, in steps of four; and to a factor of 2^256 the greatest coordinate. (Up to hash
/// collisions.)
/// \param query one
[[nodiscard]] std::uint64_t coverage_key(const Queries& query, const fast::CertifiedResult& judged,
                                         const fast::Answer& answer);

/// The number of occurrences of each coverage key.
class CoverageTable {
 public:
  CoverageTable();

  /// Counts a coverage key, and returns the number of earlier occurrences. Two keys may be confused
  /// (there are 2^16 hash slots).
  std::uint32_t add(std::uint64_t coverage_key);

 private:
  std::vector<std::uint32_t> counts_;
};

/// Chooses among arms. The same calls give the same choices everywhere.
class Scheduler {
 public:
  /// An arm for each generator, which has its relative share in the exploration. \pre not empty
  Scheduler(const std::vector<Generator>& generators, std::uint64_t seed);

  /// The arm to play next.
  [[nodiscard]] std::size_t choose();

  /// Records the reward and the work of an arm. \pre reward ≥ 0, work > 0
  void learn(std::size_t arm, double reward, double work);

 private:
  struct Arm {
    double explored = 0.0;  ///< the share of all draws for exploration
    double reward = 0.0;
    double work = 0.0;
  };

  [[nodiscard]] static double rate(const Arm& arm);

  generate::Random random_;
  std::vector<Arm> arms_;
};

}  // namespace touchstone::verify::fuzz
