#pragma once

/// \file
/// A self-check of the arithmetic that fast code was compiled to and runs under.
///
/// The bounds in filters/ belong to operations rounded one by one, to nearest, with gradual
/// underflow. A build that contracts a·b+c into one rounding, or a caller that changed the rounding
/// mode or flushes subnormals, breaks them without a word from the compiler. Each is detected here
/// by a sum whose result differs.

namespace touchstone::fast {

/// What the arithmetic does, seen from this library's own object code and the calling thread's
/// floating-point environment.
struct ArithmeticReport {
  bool separate_rounding;  ///< a·b+c rounds twice
  bool rounds_to_nearest;  ///< ties to even, in both directions
  bool gradual_underflow;  ///< subnormal operands and results are kept

  /// May filtered code run?
  [[nodiscard]] bool is_strict() const {
    return separate_rounding && rounds_to_nearest && gradual_underflow;
  }
};

/// Runs the check: a few operations.
[[nodiscard]] ArithmeticReport check_arithmetic();

/// \throws std::runtime_error naming what is wrong, if the arithmetic is not strict.
void require_strict_arithmetic();

/// The same, cheap enough for every query where the processor's control register tells (x86): what
/// the build did is checked once, what the calling thread may have changed since (rounding mode,
/// flushing of subnormals) each time.
void require_strict_environment();

}  // namespace touchstone::fast
