#pragma once

/// \file
/// How long a solver that hangs may take, and which queries it is asked still.
///
/// A solver that hangs at every query of a sort would spend a whole run on it. So after three hangs
/// a query may take a tenth of the limit, after thirty a hundredth, but not less than 10 ms. Of a
/// sort of queries of which three hang every second one is asked, after six every fourth, and so
/// on: hangs cost a time that grows with the logarithm of the number of queries. Hangs are counted,
/// not seconds, so the same hangs give the same choice.

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

namespace touchstone::verify::solvers {

class HangLimits {
 public:
  /// \param seconds that a query may take at first; 0: no limit, and nothing ever hangs
  explicit HangLimits(double seconds) : seconds_(seconds) {}

  /// Seconds that a query may take now.
  [[nodiscard]] double seconds() const {
    if (hangs_ < several) return seconds_;
    return std::min(seconds_, std::max(least, seconds_ / (hangs_ < many ? 10.0 : 100.0)));
  }

  /// Is every query of the sort asked?
  [[nodiscard]] bool asks_all(const std::string& sort) const {
    const auto known = sorts_.find(sort);
    return known == sorts_.end() || known->second.hangs < several;
  }

  /// Is the next query of the sort one that is left out? Counts it.
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

  [[nodiscard]] std::uint64_t hangs() const { return hangs_; }

 private:
  static constexpr std::uint64_t several = 3, many = 30;
  /// In less time a busy machine may not answer.
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
