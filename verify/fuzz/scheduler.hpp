#pragma once

/// \file
/// The scheduler directs the search to generators that bring new results.
///
/// Queries fall into sorts, told apart by a *coverage key*: at which stage the judge decided, where
/// the time of impact is, how far the answer is from it, and so on. A query of a sort that is rare
/// so far is worth more than one of many. The *scheduler* is a bandit: it draws arms (generators)
/// with a probability that grows with their worth by the work they took, most recent work counting
/// most, and leaves to every arm a small share, so that one that pays late is found; a greater one to
/// arms whose finds matter more.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// Number of times that each coverage key was seen.
class CoverageTable {
 public:
  CoverageTable();

  /// Counts a coverage key, and returns how often it was seen before. Two coverage keys may be taken for
  /// one (their hashes lie in 2^16 places).
  std::uint32_t add(std::uint64_t coverage_key);

  /// Places that are taken: about the number of different coverage keys.
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::vector<std::uint32_t> counts_;
  std::size_t size_ = 0;
};

struct SchedulerOptions {
  /// The factor by which the weight of earlier results decreases with each unit of later work: half after 0.7 /
  /// this.
  double forgetting = 1e-4;
  /// Share of the draws that goes to the arms by their parts of it, whatever they bring, 0 to 1.
  double explored = 0.25;
};

/// Chooses among arms. The same calls give the same choices everywhere.
class Scheduler {
 public:
  /// \param parts by arm: its part of what is explored, relative to the others'. \pre not empty, each > 0
  Scheduler(const std::vector<double>& parts, std::uint64_t seed,
            const SchedulerOptions& options = {});

  /// The arm to play next.
  [[nodiscard]] std::size_t choose();

  /// Notes what an arm brought and the work that it took. \pre reward ≥ 0, work > 0
  void learn(std::size_t arm, double reward, double work);

  /// The probability that choose() returns that arm.
  [[nodiscard]] double share(std::size_t arm) const;

 private:
  struct Arm {
    double explored = 0.0;  ///< the share of all draws that it has for nothing
    double reward = 0.0;
    double work = 0.0;
  };

  [[nodiscard]] static double rate(const Arm& arm);

  generate::Random random_;
  SchedulerOptions options_;
  std::vector<Arm> arms_;
};

}  // namespace touchstone::verify::fuzz
