#pragma once

/// \file
/// The end of work: a deadline on a clock that a test can replace, or a stop from outside.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <utility>

namespace touchstone::verify::jobs {

/// True if the work must stop. Null: never.
[[nodiscard]] inline bool is_stopped(const std::atomic<bool>* stop) {
  return stop != nullptr && stop->load();
}

/// Seconds since some moment; never runs backwards.
using SecondsClock = std::function<double()>;

/// The system's clock.
[[nodiscard]] inline double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A moment of a clock, or no limit.
class Deadline {
 public:
  /// Never over.
  Deadline() = default;

  /// \param seconds from now, ≥ 0; infinite: no limit
  /// \pre the clock is not null.
  explicit Deadline(double seconds, SecondsClock clock = steady_seconds)
      : clock_(std::move(clock)), end_(clock_() + seconds) {}

  /// 0 once it is over, infinite if there is no limit.
  [[nodiscard]] double seconds_left() const { return std::max(0.0, end_ - clock_()); }
  [[nodiscard]] bool is_over() const { return !(seconds_left() > 0.0); }

  /// The earlier of this deadline and one this number of seconds from now.
  [[nodiscard]] Deadline at_most(double seconds) const {
    Deadline result = *this;
    result.end_ = std::min(end_, clock_() + seconds);
    return result;
  }

  /// The later of this deadline and one this number of seconds from now.
  [[nodiscard]] Deadline at_least(double seconds) const {
    Deadline result = *this;
    result.end_ = std::max(end_, clock_() + seconds);
    return result;
  }

 private:
  SecondsClock clock_ = steady_seconds;
  double end_ = std::numeric_limits<double>::infinity();
};

}  // namespace touchstone::verify::jobs
