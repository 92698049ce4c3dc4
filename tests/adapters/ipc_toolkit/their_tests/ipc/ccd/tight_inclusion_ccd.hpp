#pragma once

/// \file
/// Our adapter by the names of the IPC Toolkit's own classes, so that the toolkit's tests of these
/// test the adapter.

#include "adapters/ipc_toolkit/narrow_phase_ccd.hpp"

namespace ipc {

class TightInclusionCCD : public touchstone::adapters::NarrowPhaseCCD {
 public:
  static constexpr double DEFAULT_TOLERANCE = 1e-6;
  static constexpr long DEFAULT_MAX_ITERATIONS = 10'000'000L;
  /// The toolkit has 0.8, and a cap of 1e-4 for the distance that is left, which its tests count
  /// on.
  static constexpr double DEFAULT_CONSERVATIVE_RESCALING = 0.9999;

  explicit TightInclusionCCD(double /*tolerance*/ = DEFAULT_TOLERANCE,
                             long /*max_iterations*/ = DEFAULT_MAX_ITERATIONS,
                             double rescaling = DEFAULT_CONSERVATIVE_RESCALING)
      : NarrowPhaseCCD(rescaling) {}
};

}  // namespace ipc
