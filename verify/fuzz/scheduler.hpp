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

#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// The number of occurrences of each coverage key.
class CoverageTable {
 public:
  CoverageTable();

  /// Counts a coverage key, and returns the number of earlier occurrences. Two keys may be confused
  /// (there are 2^16 hash slots).
  std::uint32_t add(std::uint64_t coverage_key);

  /// The number of used slots: about the number of different coverage keys.
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::vector<std::uint32_t> counts_;
  std::size_t size_ = 0;
};

struct SchedulerOptions {
  /// The factor by which the weight of earlier results decreases with each unit of later work: half
  /// after 0.7 / this.
  double forgetting = 1e-4;
  /// The share of draws for exploration, 0 to 1, which is divided by the parts of the arms,
  /// independent of their rewards.
  double explored = 0.25;
};

/// Chooses among arms. The same calls give the same choices everywhere.
class Scheduler {
 public:
  /// \param parts the relative share of each arm in the exploration. \pre not empty, each > 0
  Scheduler(const std::vector<double>& parts, std::uint64_t seed,
            const SchedulerOptions& options = {});

  /// The arm to play next.
  [[nodiscard]] std::size_t choose();

  /// Records the reward and the work of an arm. \pre reward ≥ 0, work > 0
  void learn(std::size_t arm, double reward, double work);

  /// The probability that choose() returns that arm.
  [[nodiscard]] double share(std::size_t arm) const;

 private:
  struct Arm {
    double explored = 0.0;  ///< the share of all draws for exploration
    double reward = 0.0;
    double work = 0.0;
  };

  [[nodiscard]] static double rate(const Arm& arm);

  generate::Random random_;
  SchedulerOptions options_;
  std::vector<Arm> arms_;
};

}  // namespace touchstone::verify::fuzz
