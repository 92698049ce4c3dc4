#pragma once

/// \file
/// The number of cores of a job.

#include <oneapi/tbb/info.h>

#include <algorithm>

namespace touchstone::verify::base {

/// The number of cores of an option, at most 1024; 0: all of them.
[[nodiscard]] inline int cores_for(unsigned threads) {
  constexpr unsigned most = 1024;
  return threads == 0 ? oneapi::tbb::info::default_concurrency()
                      : static_cast<int>(std::min(threads, most));
}

}  // namespace touchstone::verify::base
