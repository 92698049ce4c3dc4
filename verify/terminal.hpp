#pragma once

/// \file
/// What a command does with a terminal and its user: show progress, and stop when asked.

#include <atomic>
#include <chrono>
#include <string>

namespace touchstone::verify {

/// A progress line on standard error: only on a terminal, only for what takes over a second,
/// redrawn at most ten times a second, gone when the object is.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;
  ~ProgressBar();

  /// \param fraction done so far, 0 to 1
  void update(double fraction);

  /// Takes the line away until the next update, for other output.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string title_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_draw_ = start_;
  bool drawn_ = false;
};

/// The line that a progress bar draws: title, bar of 30 characters, percentage, seconds left.
[[nodiscard]] std::string progress_line(const std::string& title, double fraction, double seconds);

/// Signals closer than this to the first one are the same interrupt: timeout(1) and some shells send
/// each to the process and to its group.
inline constexpr int same_interrupt_milliseconds = 200;

/// Turns true at the first interrupt or termination signal after this function was first called;
/// the next one (later than `same_interrupt_milliseconds`) ends the process at once, as if the
/// function had never been called.
[[nodiscard]] const std::atomic<bool>& interrupted();

}  // namespace touchstone::verify
