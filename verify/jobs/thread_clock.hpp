#pragma once

/// \file
/// Processor time: the clock for all times of solvers and of the oracle.

#include <ctime>

namespace touchstone::verify::jobs {

/// Processor time of the calling thread so far, in nanoseconds. A call takes some hundred
/// nanoseconds.
[[nodiscard]] inline double thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

/// Processor time of all threads of this process so far, in seconds.
[[nodiscard]] inline double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace touchstone::verify::jobs
