#pragma once

/// \file
/// The assumptions of error bounds about the arithmetic, checked at compile time: IEEE 754
/// binary64 and binary32, each operation rounded once to its own format, no value-changing
/// optimisation. Every file with a filtered expression includes this one.
///
/// Fast-math defines a macro, contraction (a·b+c with one rounding) does not. Each source that
/// includes this file is therefore checked when the program starts, and a contracted one ends it.
/// (Sources of fast/ are not: they may be for processors other than this one, and
/// fast/platform/arithmetic_check.hpp checks them.)

#include <cfloat>
#include <cstdio>
#include <cstdlib>
#include <limits>

// Single flags count, too: GCC has a macro for each, clang for finite-math and fast-math.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) ||                         \
    defined(__NO_SIGNED_ZEROS__) || defined(_M_FP_FAST)
#error "touchstone: error bounds do not hold under -ffast-math or any of its value-changing parts"
#endif

static_assert(
    std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559,
    "touchstone: error bounds need IEEE 754 arithmetic with infinities, NaN and subnormals");
static_assert(FLT_EVAL_METHOD == 0,
              "touchstone: error bounds need every operation rounded to its own format");

#ifndef TOUCHSTONE_ARITHMETIC_CHECKED_ELSEWHERE
namespace touchstone::filters {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): the flags of each source matter

[[maybe_unused]] const bool products_round_before_sums = [] {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: fused it is −ε², separate a multiple of 2^-53, in every rounding
  // mode of the program that loads this.
  volatile double epsilon = 0x1p-30;
  const double a = 1.0 + epsilon, b = 1.0 - epsilon;
  if (a * b - 1.0 != -0x1p-60) return true;
  std::fputs(
      "touchstone: error bounds do not hold where products are contracted: compile every source "
      "that includes filters/ with -ffp-contract=off\n",
      stderr);
  std::abort();
}();

}  // namespace
}  // namespace touchstone::filters
#endif
