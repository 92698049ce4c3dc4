#pragma once

/// \file
/// Time limits for a solver that hangs, and the queries that are skipped.
///
/// A solver that hangs at every query of a sort would spend a whole run on it. After three hangs at
/// queries of one sort, a job therefore skips the other queries of the sort; a search, whose
/// queries never end, asks every second one, after six hangs every fourth, and so on. There may be
/// many sorts: after three hangs at any queries the limit of a query falls to a tenth. Hangs are
/// counted, not seconds, so the same hangs give the same choice.

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

namespace touchstone::verify::solvers {

class HangLimits {
 public:
  static constexpr std::uint64_t several = 3;

  /// \param seconds that a query may take at first; 0: no limit, and nothing ever hangs
  explicit HangLimits(double seconds) : seconds_(seconds) {}

  /// Seconds that a query may take now.
  [[nodiscard]] double seconds() const {
    return hangs_ < several ? seconds_ : std::min(seconds_, std::max(least, seconds_ / 10.0));
  }

  [[nodiscard]] bool is_over(const std::string& sort) const {
    const auto known = sorts_.find(sort);
    return known != sorts_.end() && known->second.hangs >= several;
  }

  /// True if a search skips the next query of the sort. Counts the query.
  [[nodiscard]] bool leaves_out(const std::string& sort) {
    const auto known = sorts_.find(sort);
    if (known == sorts_.end()) return false;
    constexpr std::uint64_t most_doublings = 32;
    const std::uint64_t doublings = known->second.hangs / several;
    const std::uint64_t stride = std::uint64_t{1}
                                 << (doublings < most_doublings ? doublings : most_doublings);
    return known->second.queries++ % stride != 0;
  }

  /// Counts a hang at a query of the sort.
  void add(const std::string& sort) {
    ++hangs_;
    ++sorts_[sort].hangs;
  }

 private:
  /// The least limit: a busy machine may need as long.
  static constexpr double least = 0.01;

  struct Sort {
    std::uint64_t hangs = 0;
    std::uint64_t queries = 0;  ///< since the first hang
  };

  double seconds_;
  std::uint64_t hangs_ = 0;
  std::map<std::string, Sort> sorts_;
};

}  // namespace touchstone::verify::solvers
