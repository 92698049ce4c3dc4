#include "fast/platform/arithmetic_check.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "touchstone/filters/strict_arithmetic.hpp"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::fast {
namespace {

/// A value that is opaque to the compiler.
double opaque(double x) {
  volatile double hidden = x;
  return hidden;
}

bool rounds_products_separately() {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: fused it is −ε², separate a multiple of 2^-53, in every mode.
  const double epsilon = opaque(0x1p-30);
  const double a = 1.0 + epsilon, b = 1.0 - epsilon, c = opaque(1.0);
  return a * b - c != -0x1p-60;
}

bool rounds_to_nearest_even() {
  const double half_ulp = opaque(0x1p-53), one = opaque(1.0);
  return one + half_ulp == one && one + 3 * half_ulp == 1.0 + 0x1p-51 && -one - half_ulp == -one &&
         -one - 3 * half_ulp == -1.0 - 0x1p-51;
}

bool keeps_subnormals() {
  const double smallest = opaque(std::numeric_limits<double>::denorm_min());
  const double least_normal = opaque(std::numeric_limits<double>::min());
  return smallest > 0.0 && smallest + smallest > smallest && least_normal / 2.0 > 0.0 &&
         (least_normal / 2.0) * 2.0 == least_normal;
}

}  // namespace

ArithmeticReport check_arithmetic() {
  return {.separate_rounding = rounds_products_separately(),
          .rounds_to_nearest = rounds_to_nearest_even(),
          .gradual_underflow = keeps_subnormals()};
}

void require_strict_arithmetic() {
  const ArithmeticReport report = check_arithmetic();
  std::string faults;
  if (!report.separate_rounding)
    faults += " products are contracted (compile with -ffp-contract=off);";
  if (!report.rounds_to_nearest) faults += " the rounding mode is not to nearest;";
  if (!report.gradual_underflow) faults += " subnormals are flushed to zero;";
  if (!faults.empty()) throw std::runtime_error("touchstone: arithmetic is not strict:" + faults);
}

void require_strict_environment() {
#ifdef __SSE2__
  static const bool build_is_strict = (require_strict_arithmetic(), true);
  // Rounding control, flush to zero, subnormals are zeros: all off by default.
  constexpr unsigned deviations = 0x6000U | 0x8000U | 0x0040U;
  if (build_is_strict && (_mm_getcsr() & deviations) == 0) return;
#endif
  require_strict_arithmetic();
}

}  // namespace touchstone::fast
