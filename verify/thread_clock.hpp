#pragma once

/// \file
/// The clock that all times of solvers and of the oracle are taken with.

#include <ctime>

namespace touchstone::verify {

/// Processor time of the calling thread so far, in nanoseconds. A call takes some hundred of them.
[[nodiscard]] inline double thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

}  // namespace touchstone::verify
