#pragma once

/// \file
/// The same adapter as in tight_inclusion_ccd.hpp.

#include "adapters/ipc_toolkit/narrow_phase_ccd.hpp"

namespace ipc {

class AdditiveCCD : public touchstone::adapters::NarrowPhaseCCD {
 public:
  static constexpr long DEFAULT_MAX_ITERATIONS = 10'000'000L;
  static constexpr long UNLIMITTED_ITERATIONS = -1;
  static constexpr double DEFAULT_CONSERVATIVE_RESCALING = 0.9;

  explicit AdditiveCCD(long /*max_iterations*/ = DEFAULT_MAX_ITERATIONS,
                       double rescaling = DEFAULT_CONSERVATIVE_RESCALING)
      : NarrowPhaseCCD(rescaling) {}
};

}  // namespace ipc
