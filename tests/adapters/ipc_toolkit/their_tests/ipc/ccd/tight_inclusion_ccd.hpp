#pragma once

/// \file
/// Our adapter under the names of the IPC Toolkit's own classes, so that the toolkit's tests of
/// these classes test the adapter.

#include "adapters/ipc_toolkit/narrow_phase_ccd.hpp"

namespace ipc {

class TightInclusionCCD : public touchstone::adapters::NarrowPhaseCCD {
 public:
  static constexpr double DEFAULT_TOLERANCE = 1e-6;
  static constexpr long DEFAULT_MAX_ITERATIONS = 10'000'000L;
  /// The toolkit has 0.8, and limits the remaining distance to 1e-4, on which its tests rely.
  static constexpr double DEFAULT_CONSERVATIVE_RESCALING = 0.9999;

  explicit TightInclusionCCD(double /*tolerance*/ = DEFAULT_TOLERANCE,
                             long /*max_iterations*/ = DEFAULT_MAX_ITERATIONS,
                             double rescaling = DEFAULT_CONSERVATIVE_RESCALING)
      : NarrowPhaseCCD(rescaling) {}
};

}  // namespace ipc
