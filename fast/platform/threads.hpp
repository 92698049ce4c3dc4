#pragma once

/// \file
/// Work in as many threads as are allowed.

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {

/// What work() returns, called in an arena of at most so many threads (0: all cores), strictly: it may
/// be in another thread than the caller's. Tasks that it makes have to see to that for themselves.
template <class Work>
auto with_threads(int max_threads, const Work& work) {
  // More threads than cores would not even be made.
  const int cores = oneapi::tbb::info::default_concurrency();
  oneapi::tbb::task_arena arena(max_threads == 0 ? cores : std::min(max_threads, cores));
  return arena.execute([&work] {
    const StrictFloatingPoint strict;
    return work();
  });
}

}  // namespace touchstone::fast
