#include "fast/platform/floating_point_state.hpp"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::fast {

// A separate file, because the compiler cannot move arithmetic across a call of an unknown
// function.
#ifdef __SSE2__
namespace {
constexpr unsigned default_state = 0x1F80;
#ifdef __MINGW32__
constexpr unsigned short default_x87 = 0x037F;
#endif
}  // namespace

StrictFloatingPoint::StrictFloatingPoint() : callers_(_mm_getcsr()) {
  _mm_setcsr(default_state);
#ifdef __MINGW32__
  __asm__ volatile("fnstcw %0" : "=m"(callers_x87_));
  __asm__ volatile("fldcw %0" : : "m"(default_x87));
#endif
}
StrictFloatingPoint::~StrictFloatingPoint() {
  _mm_setcsr(callers_);
#ifdef __MINGW32__
  __asm__ volatile("fldcw %0" : : "m"(callers_x87_));
#endif
}
#else
StrictFloatingPoint::StrictFloatingPoint() : callers_{} {
  std::fegetenv(&callers_);
  std::fesetenv(FE_DFL_ENV);
}
StrictFloatingPoint::~StrictFloatingPoint() { std::fesetenv(&callers_); }
#endif

}  // namespace touchstone::fast
