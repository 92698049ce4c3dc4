#pragma once

/// \file
/// Work in a limited number of threads.

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {

/// Calls work() in an arena of at most this number of threads (0: all cores), under strict floating
/// point, and returns its result. It may run in another thread than the caller's. Its tasks have to
/// establish strict floating point themselves.
template <class Work>
auto with_threads(int max_threads, const Work& work) {
  // oneTBB would not start more threads than cores.
  const int cores = oneapi::tbb::info::default_concurrency();
  oneapi::tbb::task_arena arena(max_threads == 0 ? cores : std::min(max_threads, cores));
  return arena.execute([&work] {
    const StrictFloatingPoint strict;
    return work();
  });
}

}  // namespace touchstone::fast
