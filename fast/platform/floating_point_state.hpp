#pragma once

/// \file
/// The floating-point state that certified code runs under, whatever its caller runs under.

#include <cfenv>

namespace touchstone::fast {

/// While it lives, this thread rounds to nearest, keeps subnormals and traps nothing. Then the
/// caller's state is back: modes, masks and flags.
class StrictFloatingPoint {
 public:
  StrictFloatingPoint();
  ~StrictFloatingPoint();
  StrictFloatingPoint(const StrictFloatingPoint&) = delete;
  StrictFloatingPoint& operator=(const StrictFloatingPoint&) = delete;
  StrictFloatingPoint(StrictFloatingPoint&&) = delete;
  StrictFloatingPoint& operator=(StrictFloatingPoint&&) = delete;

 private:
#ifdef __SSE2__
  unsigned callers_;  ///< MXCSR, the register that SSE, AVX and AVX-512 use
#else
  std::fenv_t callers_;
#endif
};

}  // namespace touchstone::fast
