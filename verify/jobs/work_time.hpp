#pragma once

/// \file
/// The duration of work, for all threads together.

#include <chrono>

#include "verify/jobs/thread_clock.hpp"

namespace touchstone::verify::jobs {

/// Seconds.
struct WorkTime {
  double wall = 0.0;       ///< from beginning to end
  double processor = 0.0;  ///< of all threads together

  WorkTime& operator+=(const WorkTime& other) {
    wall += other.wall;
    processor += other.processor;
    return *this;
  }
  friend WorkTime operator+(WorkTime a, const WorkTime& b) { return a += b; }
};

/// Runs the work and returns its duration.
template <class Work>
[[nodiscard]] WorkTime work_time_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const double processor_start = process_seconds();
  work();
  const double processor = process_seconds() - processor_start;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {.wall = wall.count(), .processor = processor};
}

}  // namespace touchstone::verify::jobs
