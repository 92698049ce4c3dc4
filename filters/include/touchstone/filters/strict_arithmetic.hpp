#pragma once

/// \file
/// The assumptions of error bounds about the arithmetic, checked at compile time: IEEE 754
/// binary64 and binary32, each operation rounded once to its own format, no value-changing
/// optimisation. Every file with a filtered expression includes this one.
///
/// Fast-math defines a macro, contraction (a·b+c with one rounding) does not;
/// fast/platform/arithmetic_check.hpp detects it at run time.

#include <cfloat>
#include <limits>

// The single flags too: GCC defines a macro for each of them, clang for finite-math and fast-math.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "touchstone: error bounds do not hold under -ffast-math or any of its value-changing parts"
#endif

static_assert(
    std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559,
    "touchstone: error bounds need IEEE 754 arithmetic with infinities, NaN and subnormals");
static_assert(FLT_EVAL_METHOD == 0,
              "touchstone: error bounds need every operation rounded to its own format");
