#pragma once

/// \file
/// A self-check of the compiled arithmetic and of the floating-point environment.
///
/// The bounds in filters/ assume operations that are rounded one by one, to nearest, with gradual
/// underflow. A build that contracts a·b+c into one rounding, or a caller that changes the rounding
/// mode or flushes subnormals, violates this without a compiler warning. A sum with a different
/// result detects each violation.

namespace touchstone::fast {

/// Properties of the arithmetic, in this library's object code and the calling thread's
/// floating-point environment.
struct ArithmeticReport {
  bool separate_rounding;  ///< a·b+c rounds twice
  bool rounds_to_nearest;  ///< ties to even, in both directions
  bool gradual_underflow;  ///< subnormal operands and results are kept

  /// True if filtered code may run.
  [[nodiscard]] bool is_strict() const {
    return separate_rounding && rounds_to_nearest && gradual_underflow;
  }
};

/// Runs the check: a few operations.
[[nodiscard]] ArithmeticReport check_arithmetic();

/// \throws std::runtime_error with the reason if the arithmetic is not strict.
void require_strict_arithmetic();

/// The same, cheap enough for every query on processors with a control register (x86): the build is
/// checked once, the state of the calling thread (rounding mode, flushing of subnormals) each time.
void require_strict_environment();

}  // namespace touchstone::fast
