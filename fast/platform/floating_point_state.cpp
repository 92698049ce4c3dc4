#include "fast/platform/floating_point_state.hpp"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::fast {

// In a separate file, because the compiler cannot move arithmetic across a call of an unknown
// function.
#ifdef __SSE2__
namespace {
constexpr unsigned default_state = 0x1F80, flags = 0x3F;
}

// Writing the register takes longer than reading it, which a single query would notice.
StrictFloatingPoint::StrictFloatingPoint() : callers_(_mm_getcsr()) {
  if ((callers_ & ~flags) != default_state) _mm_setcsr(default_state);
}
StrictFloatingPoint::~StrictFloatingPoint() {
  if (_mm_getcsr() != callers_) _mm_setcsr(callers_);
}
#else
StrictFloatingPoint::StrictFloatingPoint() : callers_{} {
  std::fegetenv(&callers_);
  std::fesetenv(FE_DFL_ENV);
}
StrictFloatingPoint::~StrictFloatingPoint() { std::fesetenv(&callers_); }
#endif

}  // namespace touchstone::fast
