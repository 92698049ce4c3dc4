#pragma once

/// \file
/// The terminal: output, progress and interrupts.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// Prints on standard output or standard error. Never throws: the reader of the output may have
/// closed it, and the files of the run are more important. After a failure of standard output,
/// nothing more is printed there.
void print(std::FILE* stream, std::string_view text);

/// Flushes the buffered output, as the last step of a program.
/// \throws std::runtime_error if standard output did not accept the whole output; a closed pipe (as
/// by head) is not an error.
void finish_printing();

/// Progress on standard error. On a terminal a line, only after a second, redrawn at most ten times
/// a second, removed with the object; elsewhere a line of its own every ten seconds.
class ProgressBar {
 public:
  /// \param title made printable (printable.hpp)
  explicit ProgressBar(std::string_view title);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;
  ~ProgressBar();

  /// \param fraction done so far, 0 to 1
  void update(double fraction);

  /// Removes the line until the next update, for other output.
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

/// Turns true at the first interrupt, termination or hangup signal after this function was first
/// called. A second interrupt, as of the keys, ends the process immediately; termination and hangup
/// do not, as timeout(1) and some shells send them both to the process and to its group. An ignored
/// hangup (as with nohup) stays ignored.
[[nodiscard]] const std::atomic<bool>& interrupted();

/// Thrown if an interrupt ends a wait for input, or work whose part is of no use.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// \throws Interrupted if interrupted() is true.
void throw_if_interrupted();

/// Waits until a read from the descriptor does not block: there is input, the end or an error.
/// \throws Interrupted if interrupted() is true or becomes so.
void wait_for_input(int descriptor);

}  // namespace touchstone::verify::io
