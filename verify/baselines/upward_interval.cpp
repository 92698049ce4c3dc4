#include "verify/baselines/upward_interval.hpp"

#include <cfenv>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::baselines {

// std::fesetround sets the old floating-point unit too, which costs more than a query.
#ifdef __SSE2__
UpwardRounding::UpwardRounding() : callers_(static_cast<int>(_MM_GET_ROUNDING_MODE())) {
  _MM_SET_ROUNDING_MODE(_MM_ROUND_UP);
}
UpwardRounding::~UpwardRounding() { _MM_SET_ROUNDING_MODE(static_cast<unsigned>(callers_)); }
#else
UpwardRounding::UpwardRounding() : callers_(std::fegetround()) { std::fesetround(FE_UPWARD); }
UpwardRounding::~UpwardRounding() { std::fesetround(callers_); }
#endif

}  // namespace touchstone::baselines
