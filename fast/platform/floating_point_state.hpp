#pragma once

/// \file
/// The floating-point state of certified code, independent of its caller's.

#include <cfenv>

namespace touchstone::fast {

/// During its lifetime this thread rounds to nearest, keeps subnormals and has no traps. The
/// destructor restores the caller's modes, masks and flags.
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
#ifdef __MINGW32__
  unsigned short callers_x87_;  ///< the control word of the x87, on which std::ldexp runs there
#endif
#else
  std::fenv_t callers_;
#endif
};

}  // namespace touchstone::fast
