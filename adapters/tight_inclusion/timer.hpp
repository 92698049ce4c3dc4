#pragma once

/// \file
/// The stopwatches of Tight-Inclusion's `tight_inclusion/timer.hpp`. The macro is empty, as in that
/// library unless it is configured with timers.

#include <chrono>

#define TIGHT_INCLUSION_SCOPED_TIMER(total_time)

namespace ticcd {

/// The time from start() to stop(), or to now if it is running.
class Timer {
 public:
  void start() {
    begin_ = Clock::now();
    runs_ = true;
  }

  void stop() {
    end_ = Clock::now();
    runs_ = false;
  }

  /// The time in seconds.
  [[nodiscard]] double getElapsedTime() const { return elapsed<std::ratio<1>>(); }
  [[nodiscard]] double getElapsedTimeInSec() const { return elapsed<std::ratio<1>>(); }
  [[nodiscard]] double getElapsedTimeInMilliSec() const { return elapsed<std::milli>(); }
  [[nodiscard]] double getElapsedTimeInMicroSec() const { return elapsed<std::micro>(); }

 private:
  using Clock = std::chrono::steady_clock;

  template <class Unit>
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double, Unit>((runs_ ? Clock::now() : end_) - begin_).count();
  }

  Clock::time_point begin_{}, end_{};
  bool runs_ = false;
};

/// Adds its lifetime to a sum, in microseconds.
class ScopedTimer {
 public:
  ScopedTimer() { start(); }
  explicit ScopedTimer(double& total_time) : total_time_(&total_time) { start(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;
  ScopedTimer(ScopedTimer&&) = delete;
  ScopedTimer& operator=(ScopedTimer&&) = delete;
  ~ScopedTimer() { stop(); }

  void start() {
    timer_.start();
    runs_ = true;
  }

  /// Adds the time since start(), once, here or at the end of life.
  void stop() {
    timer_.stop();
    if (runs_ && total_time_ != nullptr) *total_time_ += getElapsedTimeInMicroSec();
    runs_ = false;
  }

  [[nodiscard]] double getElapsedTimeInMicroSec() const {
    return timer_.getElapsedTimeInMicroSec();
  }
  [[nodiscard]] const Timer& timer() const { return timer_; }

 private:
  Timer timer_;
  double* total_time_ = nullptr;
  bool runs_ = false;
};

}  // namespace ticcd
